(* Loop subdivision of closed meshes of triangles. *)
From Coq Require Import Reals Lra List Arith Lia.
From Snug Require Import Points Vertices Mesh Rules.
Import ListNotations.
Open Scope R_scope.

Inductive triangle := Triangle (a b c : vertex).

Definition tri_corners (f : triangle) := let '(Triangle a b c) := f in [a; b; c].
Definition tri_edges (f : triangle) := let '(Triangle a b c) := f in [edge a b; edge b c; edge c a].

(* The children at corners 0, 1, 2, which are their own corners 0, 1, 2, and the middle one. *)
Definition tri_parts (f : triangle) : list triangle :=
  let '(Triangle a b c) := f in
  [Triangle (Old a) (edge a b) (edge c a);
   Triangle (edge a b) (Old b) (edge b c);
   Triangle (edge c a) (edge b c) (Old c);
   Triangle (edge b c) (edge c a) (edge a b)].

(* Each corner with the two others; each edge with the corner opposite. *)
Definition tri_wedges (f : triangle) := let '(Triangle a b c) := f in [(a, b, c); (b, c, a); (c, a, b)].
Definition tri_sides (f : triangle) :=
  let '(Triangle a b c) := f in [(edge a b, c); (edge b c, a); (edge c a, b)].

Definition tri_wedges_at (M : list triangle) (v : vertex) :=
  filter (fun w => if vertex_dec (fst (fst w)) v then true else false) (flat_map tri_wedges M).

Definition tri_sides_at (M : list triangle) (e : vertex) :=
  filter (fun s => if vertex_dec (fst s) e then true else false) (flat_map tri_sides M).

Definition tri_valence M v := length (tri_wedges_at M v).

(* Closed: no triangle occurs twice or has a corner twice, no two have the same corners, and each edge is a side of two
   triangles. *)
Definition tris_closed (M : list triangle) :=
  NoDup M /\ (forall f, In f M -> NoDup (tri_corners f)) /\
  (forall f g, In f M -> In g M -> incl (tri_corners f) (tri_corners g) -> f = g) /\
  (forall e, In e (flat_map tri_edges M) -> count (flat_map tri_edges M) e = 2%nat).

Definition loop_weight (n : R) : R := 5/8 - (3 + 2 * cos (2 * PI / n)) * (3 + 2 * cos (2 * PI / n)) / 64.

Definition loop_rule (M : list triangle) (v : vertex) : mask :=
  match v with
  | Control _ => []
  | Old u =>
      let n := INR (tri_valence M u) in
      let a := loop_weight n in
      (1 - a, u) :: flat_map (fun '(_, next, previous) => [(a / (2 * n), next); (a / (2 * n), previous)])
        (tri_wedges_at M u)
  | Edge u w => (3/8, u) :: (3/8, w) :: map (fun '(_, c) => (1/8, c)) (tri_sides_at M v)
  | Face _ => []
  end.

(* Parents. *)
Lemma tri_parents f c v x :
  In c (tri_parts f) -> In v (tri_corners c) -> In x (parents v) -> In x (tri_corners f).
Proof. destruct f as [a b c0]; intros C V X; simpl in C; in_cases; subst; simpl in V; in_cases; subst; all_parents. Qed.

Lemma tri_common f c v w :
  In c (tri_parts f) -> In v (tri_corners c) -> In w (tri_corners c) ->
  exists x, In x (parents v) /\ In x (parents w).
Proof.
  destruct f as [a b c0]; intros C V W; simpl in C; in_cases; subst; simpl in V, W; in_cases; subst;
    first [ exists a; rewrite ?parents_edge; simpl; split; auto; fail
          | exists b; rewrite ?parents_edge; simpl; split; auto; fail
          | exists c0; rewrite ?parents_edge; simpl; split; auto; fail ].
Qed.

Lemma in_tri_wedges_at M v w : In w (tri_wedges_at M v) ->
  exists g, In g M /\ In w (tri_wedges g) /\ fst (fst w) = v.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_flat_map in H as [g [G W]].
  exists g; destruct (vertex_dec (fst (fst w)) v); [auto | discriminate].
Qed.

Lemma in_tri_sides_at M e s : In s (tri_sides_at M e) -> exists g, In g M /\ In s (tri_sides g) /\ fst s = e.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_flat_map in H as [g [G W]].
  exists g; destruct (vertex_dec (fst s) e); [auto | discriminate].
Qed.

Lemma loop_support M v a u : In (a, u) (loop_rule M v) ->
  In u (parents v) \/ exists g, In g M /\ incl (parents v) (tri_corners g) /\ In u (tri_corners g).
Proof.
  destruct v as [n | v | x y | l]; simpl; intros H.
  - destruct H.
  - destruct H as [E | H]; [left; injection E as <- <-; auto | right].
    apply in_flat_map in H as [[[w next] previous] [W H]].
    apply in_tri_wedges_at in W as [g [G [W E]]]; simpl in E; subst w.
    exists g; split; [exact G |].
    destruct g as [e f g]; simpl in W; in_cases; injection W as <- <- <-;
      simpl in H; in_cases; injection H as <- <-;
      (split; [intros z [<- | []] |]; simpl; auto 10).
  - destruct H as [E | [E | H]]; [left; injection E as <- <-; auto | left; injection E as <- <-; auto | right].
    apply in_map_iff in H as [[k c] [E W]]; injection E as <- <-.
    apply in_tri_sides_at in W as [g [G [W E]]]; simpl in E; subst k.
    exists g; split; [exact G |].
    destruct g as [e f g]; simpl in W; in_cases; injection W as W <-;
      (split; [intros z Z; apply (edge_parents _ _ _ _ W z) in Z as [-> | ->] |]; simpl; auto 10).
  - destruct H.
Qed.

(* A step keeps a mesh closed. *)
Lemma child_covers f c x : In c (tri_parts f) -> In x (tri_corners f) ->
  exists v, In v (tri_corners c) /\ In x (parents v).
Proof.
  destruct f as [p q r]; intros C X; simpl in C; in_cases; subst; simpl in X; in_cases; subst;
    match goal with |- exists v, In v (tri_corners (Triangle ?i ?j ?k)) /\ _ =>
      first [ exists i; rewrite ?parents_edge; split; simpl; auto; fail
            | exists j; rewrite ?parents_edge; split; simpl; auto; fail
            | exists k; rewrite ?parents_edge; split; simpl; auto; fail ]
    end.
Qed.

Lemma siblings f c d : NoDup (tri_corners f) -> In c (tri_parts f) -> In d (tri_parts f) ->
  incl (tri_corners c) (tri_corners d) -> c = d.
Proof.
  destruct f as [p q r]; simpl; intros N C D I; distinct.
  in_cases; subst; try reflexivity; exfalso; simpl in I;
    pose proof (I _ (or_introl eq_refl)) as I1;
    pose proof (I _ (or_intror (or_introl eq_refl))) as I2;
    pose proof (I _ (or_intror (or_intror (or_introl eq_refl)))) as I3; simpl in I1, I2, I3; clear I;
    in_cases; edge_cases.
Qed.

Lemma owner_of_child M f g c d : tris_closed M -> In f M -> In g M -> In c (tri_parts f) -> In d (tri_parts g) ->
  incl (tri_corners c) (tri_corners d) -> f = g.
Proof.
  intros [_ [_ [U _]]] F G C D I; apply U; auto; intros x X.
  destruct (child_covers f c x C X) as [v [V P]]; exact (tri_parents g d v x D (I v V) P).
Qed.

Lemma tri_child_corners f c : NoDup (tri_corners f) -> In c (tri_parts f) -> NoDup (tri_corners c).
Proof.
  destruct f as [p q r]; simpl; intros N C; distinct.
  in_cases; subst; simpl; repeat constructor; simpl; intros H'; in_cases; edge_cases.
Qed.

Lemma tri_children_distinct f : NoDup (tri_corners f) -> NoDup (tri_parts f).
Proof.
  destruct f as [p q r]; simpl; intros N; distinct.
  repeat constructor; simpl; intros H'; in_cases; try injection H' as ? ? ?; edge_cases.
Qed.

Definition inner (f : triangle) :=
  let '(Triangle a b c) := f in
  [edge (edge a b) (edge b c); edge (edge b c) (edge c a); edge (edge c a) (edge a b)].

Lemma tri_children_edges f e :
  count (flat_map tri_edges (tri_parts f)) e =
  let '(Triangle a b c) := f in
  (count [half_edge a (edge a b); half_edge b (edge a b); half_edge b (edge b c); half_edge c (edge b c);
          half_edge c (edge c a); half_edge a (edge c a)] e
   + 2 * count (inner f) e)%nat.
Proof.
  destruct f as [a b c]; unfold half_edge; simpl.
  rewrite (edge_sym (edge a b) (Old b)), (edge_sym (edge b c) (Old c)), (edge_sym (edge c a) (Old a)),
    (edge_sym (edge a b) (edge c a)), (edge_sym (edge b c) (edge a b)), (edge_sym (edge c a) (edge b c)).
  lia.
Qed.

Lemma half_edge_inner v x y p q r s : half_edge v (edge x y) <> edge (edge p q) (edge r s).
Proof.
  unfold half_edge; intros H; apply edge_injective in H as [[H _] | [H _]]; symmetry in H;
    exact (edge_not_old _ _ _ H).
Qed.

Lemma tri_count_half_edge f x y : NoDup (tri_corners f) -> x <> y ->
  count (flat_map tri_edges (tri_parts f)) (half_edge x (edge x y)) = count (tri_edges f) (edge x y).
Proof.
  intros N XY; rewrite tri_children_edges; destruct f as [a b c]; simpl in N; distinct.
  pose proof (two_halves a b x y ltac:(congruence) XY); pose proof (two_halves b c x y ltac:(congruence) XY).
  pose proof (two_halves c a x y ltac:(congruence) XY).
  set (h := half_edge x (edge x y)) in *.
  assert (Z : forall p q r s, one_if (edge (edge p q) (edge r s)) h = 0%nat).
  { intros p q r s; apply one_if_other; intros E; symmetry in E; exact (half_edge_inner _ _ _ _ _ _ _ E). }
  simpl; rewrite !Z; lia.
Qed.

Lemma inner_once f e : NoDup (tri_corners f) -> In e (inner f) -> count (inner f) e = 1%nat.
Proof.
  destruct f as [a b c]; simpl; intros N E; distinct.
  in_cases; subst; rewrite one_if_same; repeat rewrite one_if_other; try reflexivity;
    intros H'; edge_cases; edge_cases.
Qed.

Lemma tri_count_inner f e : In e (inner f) \/ (exists g, In e (inner g)) ->
  count (flat_map tri_edges (tri_parts f)) e = (2 * count (inner f) e)%nat.
Proof.
  intros H; assert (K : exists g, In e (inner g)) by (destruct H; eauto); clear H.
  destruct K as [[a' b' c'] K]; rewrite tri_children_edges; destruct f as [a b c].
  assert (Z : forall v p q, one_if (half_edge v (edge p q)) e = 0%nat).
  { intros v p q; apply one_if_other; simpl in K; in_cases; subst e; apply half_edge_inner. }
  simpl count at 1; rewrite !Z; reflexivity.
Qed.

Lemma inner_parents f e p x : In e (inner f) -> In p (parents e) -> In x (parents p) -> In x (tri_corners f).
Proof.
  destruct f as [a b c]; simpl; intros E P X; in_cases; subst e; apply parents_edge in P as [-> | ->];
    apply parents_edge in X as [-> | ->]; auto.
Qed.

Lemma inner_covers f e x : In e (inner f) -> In x (tri_corners f) ->
  exists p, In p (parents e) /\ In x (parents p).
Proof.
  destruct f as [a b c]; simpl; intros E X; in_cases; subst e; subst x;
    first [ exists (edge a b); rewrite !parents_edge; auto; fail
          | exists (edge b c); rewrite !parents_edge; auto; fail
          | exists (edge c a); rewrite !parents_edge; auto; fail ].
Qed.

Lemma inner_owner M f g e : tris_closed M -> In f M -> In g M -> In e (inner f) -> In e (inner g) -> f = g.
Proof.
  intros [_ [_ [U _]]] F G E E'; apply U; auto; intros x X.
  destruct (inner_covers f e x E X) as [p [P Q]]; exact (inner_parents g e p x E' P Q).
Qed.

Lemma tri_child_edge f c e : NoDup (tri_corners f) -> In c (tri_parts f) -> In e (tri_edges c) ->
  (exists x y, x <> y /\ e = half_edge x (edge x y) /\ In (edge x y) (tri_edges f)) \/ In e (inner f).
Proof.
  intros N C E.
  assert (P : In e (flat_map tri_edges (tri_parts f))) by (apply in_flat_map; exists c; auto).
  destruct f as [p q r]; simpl in N, P; unfold half_edge; distinct; clear C E.
  in_cases; subst e;
    first
    [ right; simpl; auto; fail
    | right; rewrite edge_sym; simpl; auto; fail
    | left; match goal with |- context [edge (Old ?v) (edge ?x ?y)] =>
        first [ exists x, y; split; [congruence |]; split; [reflexivity | simpl; auto; fail]
              | exists y, x; rewrite (edge_sym y x); split; [congruence |]; split; [reflexivity | simpl; auto; fail] ]
      end
    | left; match goal with |- context [edge (edge ?x ?y) (Old ?v)] =>
        first [ exists x, y; split; [congruence |]; split; [apply edge_sym | simpl; auto; fail]
              | exists y, x; rewrite (edge_sym y x); split; [congruence |]; split; [apply edge_sym | simpl; auto; fail] ]
      end ].
Qed.

Theorem tris_closed_refine M : tris_closed M -> tris_closed (flat_map tri_parts M).
Proof.
  intros K; pose proof K as [D [N [U T]]]; split; [| split; [| split]].
  - apply NoDup_flat_map; auto using tri_children_distinct.
    intros f g c F G C C'; apply (owner_of_child M f g c c K F G C C'), incl_refl.
  - intros c C; apply in_flat_map in C as [f [F C]]; exact (tri_child_corners f c (N f F) C).
  - intros c d C C' I; apply in_flat_map in C as [f [F C]]; apply in_flat_map in C' as [g [G C']].
    assert (f = g) by exact (owner_of_child M f g c d K F G C C' I); subst g.
    exact (siblings f c d (N f F) C C' I).
  - intros e E; apply in_flat_map in E as [c [C E]]; apply in_flat_map in C as [f [F C]].
    rewrite flat_map_flat_map, count_flat_map.
    destruct (tri_child_edge f c e (N f F) C E) as [[x [y [XY [-> I]]]] | I].
    + rewrite (sum_same _ (fun g => count (tri_edges g) (edge x y))).
      * rewrite <- count_flat_map; apply T, in_flat_map; exists f; auto.
      * intros g G; apply tri_count_half_edge; auto.
    + rewrite (sum_only _ M f D F).
      * rewrite tri_count_inner, inner_once; auto.
      * intros g G GF; rewrite tri_count_inner by eauto.
        rewrite count_not_in; [reflexivity |].
        intros I'; exact (GF (inner_owner M g f e K G F I' I)).
Qed.

(* Counts of sides and of valences. *)
Lemma tri_sides_count M e : length (tri_sides_at M e) = count (flat_map tri_edges M) e.
Proof.
  unfold tri_sides_at; induction M as [| [a b c] M IH]; [reflexivity |].
  simpl; unfold one_if;
    repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y) end; simpl; lia.
Qed.

Lemma tri_valence_sum M v : tri_valence M v = sum (fun f => count (tri_corners f) v) M.
Proof.
  unfold tri_valence, tri_wedges_at; induction M as [| [a b c] M IH]; [reflexivity |].
  simpl; unfold one_if in *;
    repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y) end; simpl; lia.
Qed.

Lemma valence_one M f v : In f M -> In v (tri_corners f) -> (1 <= tri_valence M v)%nat.
Proof.
  intros F V; rewrite tri_valence_sum.
  induction M as [| g M IH]; [destruct F |]; simpl; destruct F as [-> | F]; [| specialize (IH F); lia].
  destruct f as [a b c]; simpl in *; in_cases; subst; rewrite one_if_same; lia.
Qed.

(* The masks are means. *)
Lemma total_tri_wedges (p : R) l :
  total (flat_map (fun '(_, next, previous) => [(p, next); (p, previous)]) (l : list (vertex * vertex * vertex)))
  = INR (length l) * (2 * p).
Proof.
  induction l as [| [[w x] y] l IH]; [simpl; ring |].
  change (length ((w, x, y) :: l)) with (S (length l)); rewrite S_INR.
  simpl; rewrite IH; ring.
Qed.

Lemma total_tri_sides (p : R) l :
  total (map (fun '(_, c) => (p, c)) (l : list (vertex * vertex))) = INR (length l) * p.
Proof.
  induction l as [| [w x] l IH]; [simpl; ring |].
  change (length ((w, x) :: l)) with (S (length l)); rewrite S_INR.
  simpl; rewrite IH; ring.
Qed.

Lemma loop_weight_bounds n : 15/64 <= loop_weight n <= 39/64.
Proof.
  unfold loop_weight; pose proof (COS_bound (2 * PI / n)) as [L U].
  set (c := cos (2 * PI / n)) in *; nra.
Qed.

Lemma loop_weights n : 1 <= n -> 0 <= 1 - loop_weight n /\ 0 <= loop_weight n / (2 * n)
  /\ 1 - loop_weight n + n * (2 * (loop_weight n / (2 * n))) = 1.
Proof.
  intros N; pose proof (loop_weight_bounds n) as [L U]; repeat split.
  - lra.
  - apply Rlt_le, Rdiv_lt_0_compat; lra.
  - field; lra.
Qed.

Lemma tri_edge_exists M c x y : In c (flat_map tri_parts M) -> In (Edge x y) (tri_corners c) ->
  In (Edge x y) (flat_map tri_edges M).
Proof.
  intros C V; apply in_flat_map in C as [f [F C]]; apply in_flat_map; exists f; split; [exact F |].
  destruct f as [p q r]; simpl in C; in_cases; subst; simpl in V; in_cases; try discriminate; simpl; auto.
Qed.

(* Only vertices and edges make new vertices. *)
Lemma tri_new_vertex M c v : In c (flat_map tri_parts M) -> In v (tri_corners c) ->
  (exists f u, In f M /\ In u (tri_corners f) /\ v = Old u) \/ (exists x y, v = Edge x y).
Proof.
  intros C V; apply in_flat_map in C as [f [F C]].
  destruct f as [p q r]; simpl in C; in_cases; subst; simpl in V; in_cases; subst;
    first [ left; do 2 eexists; split; [exact F |]; split; [| reflexivity]; simpl; auto; fail
          | right; match goal with |- context [edge ?x ?y] => destruct (edge_shape x y) as [-> | ->]; eauto end ].
Qed.

Theorem loop_mean M c v :
  tris_closed M -> In c (flat_map tri_parts M) -> In v (tri_corners c) -> is_mean (loop_rule M v).
Proof.
  intros K C V; destruct (tri_new_vertex M c v C V) as [[f [u [F [U ->]]]] | [x [y ->]]]; unfold loop_rule.
  - pose proof (le_INR _ _ (valence_one M f u F U)) as N; change (INR 1) with 1 in N.
    destruct (loop_weights _ N) as [W1 [W2 W3]]; split.
    + intros a x [E | H]; [injection E as <- <-; exact W1 |].
      apply in_flat_map in H as [[[w e] f'] [_ H]]; in_cases; injection H as <- <-; assumption.
    + cbn [total]; rewrite total_tri_wedges; exact W3.
  - split.
    + intros a z [E | [E | H]]; [injection E as <- <-; lra | injection E as <- <-; lra |].
      apply in_map_iff in H as [[w e] [E _]]; injection E as <- <-; lra.
    + cbn [total]; rewrite total_tri_sides, tri_sides_count.
      destruct K as [_ [_ [_ T]]]; rewrite (T _ (tri_edge_exists M c x y C V)); simpl; lra.
Qed.

Definition loop : refinement := refinement_with_rings tri_corners tri_parts tri_parents tri_common.

Lemma loop_closed M k : tris_closed M -> tris_closed (mesh loop M k).
Proof. intros K; induction k as [| k IH]; [exact K | apply tris_closed_refine, IH]. Qed.

Theorem loop_proper M : tris_closed M -> proper loop M (fun k => loop_rule (mesh loop M k)).
Proof.
  intros K k c v C V; split; [exact (loop_mean _ c v (loop_closed M k K) C V) |].
  intros a u; apply loop_support.
Qed.

(* The same on any mesh of triangles, with boundaries, creases, corners and fractions of sharpness. *)
Inductive loop_smooth (M : list triangle) : vertex -> mask -> Prop :=
| at_vertex v : (1 <= tri_valence M v)%nat -> loop_smooth M (Old v) (loop_rule M (Old v))
| at_edge u v : length (tri_sides_at M (Edge u v)) = 2%nat -> loop_smooth M (Edge u v) (loop_rule M (Edge u v)).

Lemma loop_smooth_mean M v l : loop_smooth M v l -> is_mean l.
Proof.
  intros [u N | u w N]; unfold loop_rule.
  - pose proof (le_INR _ _ N) as L; change (INR 1) with 1 in L.
    destruct (loop_weights _ L) as [W1 [W2 W3]]; split.
    + intros a x [E | H]; [injection E as <- <-; exact W1 |].
      apply in_flat_map in H as [[[w e] f'] [_ H]]; in_cases; injection H as <- <-; assumption.
    + cbn [total]; rewrite total_tri_wedges; exact W3.
  - split.
    + intros a z [E | [E | H]]; [injection E as <- <-; lra | injection E as <- <-; lra |].
      apply in_map_iff in H as [[x e] [E _]]; injection E as <- <-; lra.
    + cbn [total]; rewrite total_tri_sides, N; simpl; lra.
Qed.

Lemma loop_smooth_around M v l : loop_smooth M v l -> around tri_corners M v l.
Proof. intros [u _ | u w _] a x; apply loop_support. Qed.

Theorem loop_any_proper M masks :
  (forall k c v, In c (mesh loop M (S k)) -> In v (tri_corners c) ->
     by_rule tri_corners loop_smooth (mesh loop M k) v (masks k v)) ->
  proper loop M masks.
Proof.
  intros H k c v C V; specialize (H k c v C V); split.
  - exact (by_rule_mean tri_corners loop_smooth loop_smooth_mean _ _ _ H).
  - exact (by_rule_around tri_corners loop_smooth loop_smooth_around _ _ _ H).
Qed.

(* Flat triangles. *)
Definition flat : refinement := refinement_of_faces tri_corners tri_parts tri_parents.

Definition flat_mask (v : vertex) : mask :=
  match v with
  | Old u => [(1, u)]
  | Edge u w => [(1/2, u); (1/2, w)]
  | _ => []
  end.

Theorem flat_proper M : proper flat M (fun _ => flat_mask).
Proof.
  intros k c v C V; split.
  - destruct (tri_new_vertex _ c v C V) as [[f [u [F [U ->]]]] | [x [y ->]]];
      (split; [intros a z H; simpl in H; in_cases; injection H as <- <-; lra | simpl; lra]).
  - intros a u H; destruct v; simpl in H; in_cases; injection H as <- <-; simpl; auto.
Qed.
