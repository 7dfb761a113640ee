(* Bilinear and Catmull-Clark subdivision of closed meshes of quads. *)
From Coq Require Import Reals Lra List Arith Lia.
From Snug Require Import Points Vertices Mesh.
Import ListNotations.
Open Scope R_scope.

Inductive quad := Quad (a b c d : vertex).

Definition quad_corners (f : quad) := let '(Quad a b c d) := f in [a; b; c; d].
Definition quad_edges (f : quad) := let '(Quad a b c d) := f in [edge a b; edge b c; edge c d; edge d a].

(* The children at corners 0, 1, 2, 3; child k has corner k of its owner as corner k. *)
Definition quad_parts (f : quad) : list quad :=
  let '(Quad a b c d) := f in
  let m := Face [a; b; c; d] in
  [Quad (Old a) (edge a b) m (edge d a);
   Quad (edge a b) (Old b) (edge b c) m;
   Quad m (edge b c) (Old c) (edge c d);
   Quad (edge d a) m (edge c d) (Old d)].

(* Each corner with the corners next to it and the one opposite. *)
Definition quad_wedges (f : quad) :=
  let '(Quad a b c d) := f in [(a, b, d, c); (b, c, a, d); (c, d, b, a); (d, a, c, b)].

(* Each edge with the other two corners. *)
Definition quad_sides (f : quad) :=
  let '(Quad a b c d) := f in
  [(edge a b, c, d); (edge b c, d, a); (edge c d, a, b); (edge d a, b, c)].

Definition wedges_at (M : list quad) (v : vertex) :=
  filter (fun w => if vertex_dec (fst (fst (fst w))) v then true else false) (flat_map quad_wedges M).

Definition sides_at (M : list quad) (e : vertex) :=
  filter (fun s => if vertex_dec (fst (fst s)) e then true else false) (flat_map quad_sides M).

Definition valence M v := length (wedges_at M v).

(* Closed: no quad occurs twice or has a corner twice, and each edge is a side of two quads. *)
Definition quads_closed (M : list quad) :=
  NoDup M /\ (forall f, In f M -> NoDup (quad_corners f)) /\
  (forall e, In e (flat_map quad_edges M) -> count (flat_map quad_edges M) e = 2%nat).

(* Masks. *)
Definition bilinear_rule (M : list quad) (v : vertex) : mask :=
  match v with
  | Control _ => []
  | Old u => [(1, u)]
  | Edge u w => [(1/2, u); (1/2, w)]
  | Face [a; b; c; d] => [(1/4, a); (1/4, b); (1/4, c); (1/4, d)]
  | Face _ => []
  end.

Definition catmark_rule (M : list quad) (v : vertex) : mask :=
  match v with
  | Control _ => []
  | Old u =>
      let n := INR (valence M u) in
      (1 - 7 / (4 * n), u) ::
      flat_map (fun '(_, next, previous, far) =>
        [(3 / (4 * (n * n)), next); (3 / (4 * (n * n)), previous); (1 / (4 * (n * n)), far)]) (wedges_at M u)
  | Edge u w => (3/8, u) :: (3/8, w) :: flat_map (fun '(_, c, d) => [(1/16, c); (1/16, d)]) (sides_at M v)
  | Face [a; b; c; d] => [(1/4, a); (1/4, b); (1/4, c); (1/4, d)]
  | Face _ => []
  end.

(* Parents. *)
Lemma quad_parents f c v x :
  In c (quad_parts f) -> In v (quad_corners c) -> In x (parents v) -> In x (quad_corners f).
Proof. destruct f as [a b c0 d]; intros C V X; simpl in C; in_cases; subst; simpl in V; in_cases; subst; all_parents. Qed.

(* The child at a corner: the corner is a parent of all its vertices. *)
Lemma quad_child f c : In c (quad_parts f) ->
  exists x, In x (quad_corners f) /\ forall v, In v (quad_corners c) -> In x (parents v).
Proof.
  destruct f as [a b c0 d]; intros C; simpl in C; in_cases; subst;
    [exists a | exists b | exists c0 | exists d]; (split; [simpl; auto |]);
    intros v V; simpl in V; in_cases; subst; rewrite ?parents_edge; simpl; auto.
Qed.

Lemma quad_common f c v w :
  In c (quad_parts f) -> In v (quad_corners c) -> In w (quad_corners c) ->
  exists x, In x (parents v) /\ In x (parents w).
Proof. intros C V W; destruct (quad_child f c C) as [x [_ H]]; exists x; auto. Qed.

Lemma in_wedges_at M v w : In w (wedges_at M v) ->
  exists g, In g M /\ In w (quad_wedges g) /\ fst (fst (fst w)) = v.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_flat_map in H as [g [G W]].
  exists g; destruct (vertex_dec (fst (fst (fst w))) v); [auto | discriminate].
Qed.

Lemma in_sides_at M e s : In s (sides_at M e) ->
  exists g, In g M /\ In s (quad_sides g) /\ fst (fst s) = e.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_flat_map in H as [g [G W]].
  exists g; destruct (vertex_dec (fst (fst s)) e); [auto | discriminate].
Qed.

Lemma catmark_support M v a u : In (a, u) (catmark_rule M v) ->
  In u (parents v) \/ exists g, In g M /\ incl (parents v) (quad_corners g) /\ In u (quad_corners g).
Proof.
  destruct v as [n | v | x y | l]; simpl; intros H.
  - destruct H.
  - destruct H as [E | H]; [left; injection E as <- <-; auto | right].
    apply in_flat_map in H as [[[[w next] previous] far] [W H]].
    apply in_wedges_at in W as [g [G [W E]]]; simpl in E; subst w.
    exists g; split; [exact G |].
    destruct g as [e f g h]; simpl in W; in_cases; injection W as <- <- <- <-;
      simpl in H; in_cases; injection H as <- <-;
      (split; [intros z [<- | []] |]; simpl; auto 10).
  - destruct H as [E | [E | H]]; [left; injection E as <- <-; auto | left; injection E as <- <-; auto | right].
    apply in_flat_map in H as [[[k c] d] [W H]].
    apply in_sides_at in W as [g [G [W E]]]; simpl in E; subst k.
    exists g; split; [exact G |].
    destruct g as [e f g h]; simpl in W; in_cases; injection W as W <- <-;
      simpl in H; in_cases; injection H as <- <-;
      (split; [intros z Z; apply (edge_parents _ _ _ _ W z) in Z as [-> | ->] |]; simpl; auto 10).
  - destruct l as [| p [| q [| r [| s [| ]]]]]; in_cases; injection H as <- <-; left; simpl; auto.
Qed.

Lemma bilinear_support M v a u : In (a, u) (bilinear_rule M v) -> In u (parents v).
Proof.
  destruct v as [n | v | x y | [| p [| q [| r [| s [| ]]]]]]; simpl; intros H; in_cases; injection H as <- <-; auto 10.
Qed.

(* A step keeps a mesh closed. *)
Definition middle (f : quad) := let '(Quad a b c d) := f in Face [a; b; c; d].

Lemma middle_injective f g : middle f = middle g -> f = g.
Proof. destruct f, g; simpl; intros H; injection H; congruence. Qed.

Lemma middle_of_child f c : In c (quad_parts f) -> In (middle f) (quad_corners c).
Proof. destruct f; simpl; intros C; in_cases; subst; simpl; auto. Qed.

Lemma middle_only f c m : In c (quad_parts f) -> In m (quad_corners c) ->
  (exists g, m = middle g) -> m = middle f.
Proof.
  destruct f as [a b c0 d]; simpl; intros C V [[p q r s] ->]; simpl in *.
  in_cases; subst; simpl in V; in_cases; try discriminate; auto;
    exfalso; eapply edge_not_face; eassumption.
Qed.

Lemma child_of_one f g c : In c (quad_parts f) -> In c (quad_parts g) -> f = g.
Proof.
  intros F G; apply middle_injective.
  apply (middle_only g c (middle f) G (middle_of_child f c F)); exists f; reflexivity.
Qed.

Lemma child_corners f c : NoDup (quad_corners f) -> In c (quad_parts f) -> NoDup (quad_corners c).
Proof.
  destruct f as [p q r s]; simpl; intros N C; distinct.
  in_cases; subst; simpl; repeat constructor; simpl; intros H'; in_cases; edge_cases.
Qed.

Lemma children_distinct f : NoDup (quad_corners f) -> NoDup (quad_parts f).
Proof.
  destruct f as [p q r s]; simpl; intros N; distinct.
  repeat constructor; simpl; intros H'; in_cases; try injection H' as ? ? ? ?; edge_cases.
Qed.

Definition spoke (e m : vertex) := edge e m.

Lemma half_edge_spoke v x y e a b c d : half_edge v (edge x y) <> spoke e (Face [a; b; c; d]).
Proof.
  unfold half_edge, spoke; intros H; apply edge_injective in H as [[_ H] | [H _]]; [| discriminate].
  exact (edge_not_face _ _ _ H).
Qed.

Lemma spoke_injective x y p q a b c d a' b' c' d' :
  spoke (edge x y) (Face [a; b; c; d]) = spoke (edge p q) (Face [a'; b'; c'; d']) ->
  edge x y = edge p q /\ Face [a; b; c; d] = Face [a'; b'; c'; d'].
Proof.
  unfold spoke; intros H; apply edge_injective in H as [[A B] | [A B]]; [auto |].
  destruct (edge_not_face _ _ _ A).
Qed.

(* The edges of the children: halves of edges, and edges from the middle. *)
Lemma children_edges f e : 
  count (flat_map quad_edges (quad_parts f)) e =
  let '(Quad a b c d) := f in let m := Face [a; b; c; d] in
  (count [half_edge a (edge a b); half_edge b (edge a b); half_edge b (edge b c); half_edge c (edge b c);
          half_edge c (edge c d); half_edge d (edge c d); half_edge d (edge d a); half_edge a (edge d a)] e
   + 2 * count [spoke (edge a b) m; spoke (edge b c) m; spoke (edge c d) m; spoke (edge d a) m] e)%nat.
Proof.
  destruct f as [a b c d]; unfold half_edge, spoke; simpl.
  rewrite (edge_sym (edge d a) (Old a)), (edge_sym (edge a b) (Old b)), (edge_sym (edge b c) (Old c)),
    (edge_sym (edge c d) (Old d)), !(edge_sym (Face [a; b; c; d])).
  lia.
Qed.

Lemma count_half_edge f x y : NoDup (quad_corners f) -> x <> y ->
  count (flat_map quad_edges (quad_parts f)) (half_edge x (edge x y)) = count (quad_edges f) (edge x y).
Proof.
  intros N XY; rewrite children_edges; destruct f as [a b c d]; simpl in N; distinct.
  pose proof (two_halves a b x y ltac:(congruence) XY); pose proof (two_halves b c x y ltac:(congruence) XY).
  pose proof (two_halves c d x y ltac:(congruence) XY); pose proof (two_halves d a x y ltac:(congruence) XY).
  set (h := half_edge x (edge x y)) in *.
  assert (Z : forall p q, one_if (spoke (edge p q) (Face [a; b; c; d])) h = 0%nat).
  { intros p q; apply one_if_other; intros E; symmetry in E; exact (half_edge_spoke _ _ _ _ _ _ _ _ E). }
  simpl; rewrite !Z; lia.
Qed.

Lemma count_spoke f g x y : NoDup (quad_corners f) ->
  count (flat_map quad_edges (quad_parts f)) (spoke (edge x y) (middle g)) =
  if vertex_dec (middle f) (middle g) then (2 * count (quad_edges f) (edge x y))%nat else 0%nat.
Proof.
  intros N; rewrite children_edges; destruct f as [a b c d], g as [a' b' c' d']; simpl middle.
  set (h := spoke (edge x y) (Face [a'; b'; c'; d'])).
  assert (Z : forall v p q, one_if (half_edge v (edge p q)) h = 0%nat).
  { intros v p q; apply one_if_other, half_edge_spoke. }
  cbv zeta; simpl count; rewrite !Z.
  destruct (vertex_dec (Face [a; b; c; d]) (Face [a'; b'; c'; d'])) as [E | E].
  - assert (O : forall p q, one_if (spoke (edge p q) (Face [a; b; c; d])) h = one_if (edge p q) (edge x y)).
    { intros p q; unfold h; rewrite <- E; unfold one_if at 2.
      destruct (vertex_dec (edge p q) (edge x y)) as [-> | D]; [apply one_if_same |].
      apply one_if_other; intros H; apply spoke_injective in H as [H _]; congruence. }
    rewrite !O; simpl; lia.
  - assert (O : forall p q, one_if (spoke (edge p q) (Face [a; b; c; d])) h = 0%nat).
    { intros p q; apply one_if_other; intros H; apply spoke_injective in H as [_ H]; congruence. }
    rewrite !O; reflexivity.
Qed.

Lemma edges_once f e : NoDup (quad_corners f) -> In e (quad_edges f) -> count (quad_edges f) e = 1%nat.
Proof.
  destruct f as [a b c d]; simpl; intros N E; distinct.
  in_cases; subst; rewrite one_if_same; repeat rewrite one_if_other; try reflexivity;
    intros H'; edge_cases.
Qed.

Lemma child_edge f c e : NoDup (quad_corners f) -> In c (quad_parts f) -> In e (quad_edges c) ->
  (exists x y, x <> y /\ e = half_edge x (edge x y) /\ In (edge x y) (quad_edges f)) \/
  (exists x y, e = spoke (edge x y) (middle f) /\ In (edge x y) (quad_edges f)).
Proof.
  intros N C E.
  assert (P : In e (flat_map quad_edges (quad_parts f))) by (apply in_flat_map; exists c; auto).
  destruct f as [p q r s]; simpl in N, P; unfold half_edge, spoke, middle; distinct; clear C E.
  assert (HE : forall x y z : vertex, edge (edge x y) z = edge z (edge x y)) by (intros; apply edge_sym).
  in_cases; subst e;
    first
    [ right; do 2 eexists; split; [first [reflexivity | apply edge_sym] | simpl; auto; fail]
    | left; match goal with |- context [edge (Old ?v) (edge ?x ?y)] =>
        first [ exists x, y; split; [congruence |]; split; [reflexivity | simpl; auto; fail]
              | exists y, x; rewrite (edge_sym y x); split; [congruence |]; split; [reflexivity | simpl; auto; fail] ]
      end
    | left; match goal with |- context [edge (edge ?x ?y) (Old ?v)] =>
        first [ exists x, y; split; [congruence |]; split; [apply edge_sym | simpl; auto; fail]
              | exists y, x; rewrite (edge_sym y x); split; [congruence |]; split; [apply edge_sym | simpl; auto; fail] ]
      end ].
Qed.

Theorem quads_closed_refine M : quads_closed M -> quads_closed (flat_map quad_parts M).
Proof.
  intros [D [N T]]; split; [| split].
  - apply NoDup_flat_map; auto using children_distinct.
    intros f g c _ _; apply child_of_one.
  - intros c C; apply in_flat_map in C as [f [F C]]; exact (child_corners f c (N f F) C).
  - intros e E; apply in_flat_map in E as [c [C E]]; apply in_flat_map in C as [f [F C]].
    rewrite flat_map_flat_map, count_flat_map.
    destruct (child_edge f c e (N f F) C E) as [[x [y [XY [-> I]]]] | [x [y [-> I]]]].
    + rewrite (sum_same _ (fun g => count (quad_edges g) (edge x y))).
      * rewrite <- count_flat_map; apply T, in_flat_map; exists f; auto.
      * intros g G; apply count_half_edge; auto.
    + rewrite (sum_only _ M f D F).
      * rewrite count_spoke by auto; destruct (vertex_dec (middle f) (middle f)); [| congruence].
        rewrite edges_once; auto.
      * intros g G GF; rewrite count_spoke by auto.
        destruct (vertex_dec (middle g) (middle f)) as [E' | E']; [| reflexivity].
        destruct (GF (middle_injective g f E')).
Qed.

(* Counts of sides and of valences. *)
Lemma sides_count M e : length (sides_at M e) = count (flat_map quad_edges M) e.
Proof.
  unfold sides_at; induction M as [| [a b c d] M IH]; [reflexivity |].
  simpl; unfold one_if;
    repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y) end; simpl; lia.
Qed.

Lemma valence_sum M v : valence M v = sum (fun f => count (quad_corners f) v) M.
Proof.
  unfold valence, wedges_at; induction M as [| [a b c d] M IH]; [reflexivity |].
  simpl; unfold one_if in *;
    repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y) end; simpl; lia.
Qed.

Lemma edges_at_corner f x y : NoDup (quad_corners f) ->
  (count (quad_edges f) (edge x y) <= count (quad_corners f) x)%nat.
Proof.
  intros N; destruct (in_dec vertex_dec (edge x y) (quad_edges f)) as [I | I].
  - rewrite edges_once by auto; destruct f as [a b c d]; simpl in *; in_cases;
      apply edge_injective in I as [[<- <-] | [<- <-]]; rewrite one_if_same; lia.
  - rewrite count_not_in by exact I; lia.
Qed.

Lemma valence_two M f v : quads_closed M -> In f M -> In v (quad_corners f) -> (2 <= valence M v)%nat.
Proof.
  intros [D [N T]] F V.
  assert (E : exists y, In (edge v y) (quad_edges f)).
  { destruct f as [a b c d]; simpl in V; in_cases; subst; eexists; simpl; eauto. }
  destruct E as [y E].
  rewrite valence_sum, <- (T (edge v y)) by (apply in_flat_map; exists f; auto).
  rewrite count_flat_map; apply sum_le; intros g G; apply edges_at_corner; auto.
Qed.

(* The masks are means. *)
Lemma total_wedges (p q : R) l :
  total (flat_map (fun '(_, next, previous, far) => [(p, next); (p, previous); (q, far)])
    (l : list (vertex * vertex * vertex * vertex))) = INR (length l) * (2 * p + q).
Proof.
  induction l as [| [[[w x] y] z] l IH]; [simpl; ring |].
  change (length ((w, x, y, z) :: l)) with (S (length l)); rewrite S_INR.
  simpl; rewrite IH; ring.
Qed.

Lemma total_sides (p : R) l :
  total (flat_map (fun '(_, c, d) => [(p, c); (p, d)]) (l : list (vertex * vertex * vertex)))
  = INR (length l) * (2 * p).
Proof.
  induction l as [| [[w x] y] l IH]; [simpl; ring |].
  change (length ((w, x, y) :: l)) with (S (length l)); rewrite S_INR.
  simpl; rewrite IH; ring.
Qed.

(* The weight of the vertex is at least 0 at valences of at least 2, and the weights sum to 1. *)
Lemma catmark_weights n : 2 <= n -> 0 <= 1 - 7 / (4 * n) /\ 0 <= 3 / (4 * (n * n)) /\ 0 <= 1 / (4 * (n * n))
  /\ 1 - 7 / (4 * n) + n * (2 * (3 / (4 * (n * n))) + 1 / (4 * (n * n))) = 1.
Proof.
  intros N; assert (0 < n * n) by nra.
  assert (7 / (4 * n) <= 1) by (apply Rmult_le_reg_r with (4 * n); [lra |]; field_simplify; lra).
  repeat split.
  - lra.
  - apply Rlt_le, Rdiv_lt_0_compat; lra.
  - apply Rlt_le, Rdiv_lt_0_compat; lra.
  - field; lra.
Qed.

Lemma quad_vertex_exists M c v x : In c (flat_map quad_parts M) -> In v (quad_corners c) -> In x (parents v) ->
  exists f, In f M /\ In x (quad_corners f).
Proof.
  intros C V X; apply in_flat_map in C as [f [F C]]; exists f; split; [exact F |].
  exact (quad_parents f c v x C V X).
Qed.

Lemma quad_edge_exists M c x y : In c (flat_map quad_parts M) -> In (Edge x y) (quad_corners c) ->
  In (Edge x y) (flat_map quad_edges M).
Proof.
  intros C V; apply in_flat_map in C as [f [F C]]; apply in_flat_map; exists f; split; [exact F |].
  destruct f as [p q r s]; simpl in C; in_cases; subst; simpl in V; in_cases; try discriminate; simpl; auto.
Qed.

Lemma no_control M c n : In c (flat_map quad_parts M) -> In (Control n) (quad_corners c) -> False.
Proof.
  intros C V; apply in_flat_map in C as [f [F C]].
  destruct (quad_child f c C) as [x [_ H]]; exact (H _ V).
Qed.

Lemma quad_face_exists M c l : In c (flat_map quad_parts M) -> In (Face l) (quad_corners c) ->
  exists p q r s, l = [p; q; r; s].
Proof.
  intros C V; apply in_flat_map in C as [f [F C]].
  assert (H : Face l = middle f \/ exists x y, Face l = edge x y).
  { destruct f as [p q r s]; simpl in C; in_cases; subst; simpl in V; in_cases; try discriminate; eauto. }
  destruct H as [H | [x [y H]]]; [| symmetry in H; destruct (edge_not_face _ _ _ H)].
  destruct f as [p q r s]; injection H as ->; eauto.
Qed.

Ltac weights H := in_cases; injection H as <- <-; lra.

Theorem catmark_mean M c v :
  quads_closed M -> In c (flat_map quad_parts M) -> In v (quad_corners c) -> is_mean (catmark_rule M v).
Proof.
  intros K C V; destruct v as [n | u | x y | l]; unfold catmark_rule.
  - destruct (no_control M c n C V).
  - destruct (quad_vertex_exists M c (Old u) u C V (or_introl eq_refl)) as [f [F U]].
    pose proof (le_INR _ _ (valence_two M f u K F U)) as N.
    change (INR 2) with (1 + 1) in N; replace (1 + 1) with 2 in N by ring.
    destruct (catmark_weights _ N) as [W1 [W2 [W3 W4]]]; split.
    + intros a x [E | H]; [injection E as <- <-; exact W1 |].
      apply in_flat_map in H as [[[[w e] f'] g] [_ H]]; in_cases; injection H as <- <-; assumption.
    + cbn [total]; rewrite total_wedges; exact W4.
  - split.
    + intros a z [E | [E | H]]; [injection E as <- <-; lra | injection E as <- <-; lra |].
      apply in_flat_map in H as [[[w e] f'] [_ H]]; weights H.
    + cbn [total]; rewrite total_sides, sides_count.
      destruct K as [_ [_ T]]; rewrite (T _ (quad_edge_exists M c x y C V)); simpl; lra.
  - destruct (quad_face_exists M c l C V) as [p [q [r [s ->]]]].
    split; [intros a x H; weights H | simpl; lra].
Qed.

Theorem bilinear_mean M c v :
  quads_closed M -> In c (flat_map quad_parts M) -> In v (quad_corners c) -> is_mean (bilinear_rule M v).
Proof.
  intros K C V; destruct v as [n | u | x y | l]; unfold bilinear_rule;
    try (split; [intros a z H; weights H | simpl; lra]).
  - destruct (no_control M c n C V).
  - destruct (quad_face_exists M c l C V) as [p [q [r [s ->]]]].
    split; [intros a z H; weights H | simpl; lra].
Qed.

(* Both schemes on closed meshes. *)
Definition catmark : refinement := refinement_with_rings quad_corners quad_parts quad_parents quad_common.
Definition bilinear : refinement := refinement_of_faces quad_corners quad_parts quad_parents.

Lemma catmark_closed M k : quads_closed M -> quads_closed (mesh catmark M k).
Proof. intros K; induction k as [| k IH]; [exact K | apply quads_closed_refine, IH]. Qed.

Theorem catmark_proper M : quads_closed M -> proper catmark M (fun k => catmark_rule (mesh catmark M k)).
Proof.
  intros K k c v C V; split; [exact (catmark_mean _ c v (catmark_closed M k K) C V) |].
  intros a u; apply catmark_support.
Qed.

Theorem bilinear_proper M : quads_closed M -> proper bilinear M (fun k => bilinear_rule (mesh bilinear M k)).
Proof.
  intros K k c v C V; split; [exact (bilinear_mean _ c v (catmark_closed M k K) C V) |].
  intros a u; apply bilinear_support.
Qed.
