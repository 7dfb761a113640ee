(* Catmull-Clark and bilinear subdivision of any mesh of polygons: with boundaries, creases, corners, fractions of sharpness,
   and where it is not manifold. *)
From Coq Require Import Reals Lra List Arith Lia.
From Snug Require Import Points Vertices Mesh Rules.
Import ListNotations.
Open Scope R_scope.

Definition polygon := list vertex.

(* Corner k, counted round. *)
Definition at_corner (f : polygon) (k : nat) := nth (k mod length f) f (Control 0).
Definition next (f : polygon) k := at_corner f (k + 1).
Definition previous (f : polygon) k := at_corner f (k + (length f - 1)).

(* The list whose item k is the first of l, and so on round. *)
Definition turned (k : nat) (l : list vertex) :=
  map (fun i => nth ((i + (length l - k)) mod length l) l (Control 0)) (seq 0 (length l)).

(* The child at corner k. In a quad it has the corner of its owner as corner k, else as corner 0. *)
Definition child (f : polygon) (k : nat) : polygon :=
  let v := at_corner f k in
  turned (if Nat.eqb (length f) 4 then k else 0)
    [Old v; edge v (next f k); Face f; edge (previous f k) v].

Definition polygon_parts (f : polygon) := map (child f) (seq 0 (length f)).

Definition polygon_corners (f : polygon) : list vertex := f.

Lemma at_corner_in f k : f <> [] -> In (at_corner f k) f.
Proof.
  intros N; apply nth_In, Nat.mod_upper_bound; intros H; apply N; destruct f; [reflexivity | discriminate].
Qed.

Lemma turned_in k l x : In x (turned k l) -> In x l.
Proof.
  intros H; apply in_map_iff in H as [i [<- I]]; apply in_seq in I.
  apply nth_In, Nat.mod_upper_bound; lia.
Qed.

Lemma child_shape f c : In c (polygon_parts f) -> f <> [] /\ exists v n p, In v f /\ In n f /\ In p f /\
  forall x, In x c -> In x [Old v; edge v n; Face f; edge p v].
Proof.
  intros C; apply in_map_iff in C as [k [<- K]]; apply in_seq in K.
  assert (N : f <> []) by (intros ->; simpl in K; lia).
  split; [exact N |]; exists (at_corner f k), (next f k), (previous f k); repeat split; try (apply at_corner_in, N).
  intros x X; exact (turned_in _ _ _ X).
Qed.

Lemma polygon_parents f c v x : In c (polygon_parts f) -> In v c -> In x (parents v) -> In x f.
Proof.
  intros C V X; apply child_shape in C as [_ [u [n [p [U [N [P H]]]]]]]; apply H in V.
  in_cases; subst v; try (apply parents_edge in X as [-> | ->]; assumption); simpl in X; in_cases; subst; auto.
Qed.

Lemma polygon_common f c v w : In c (polygon_parts f) -> In v c -> In w c ->
  exists x, In x (parents v) /\ In x (parents w).
Proof.
  intros C V W; apply child_shape in C as [_ [u [n [p [U [N [P H]]]]]]]; exists u; apply H in V; apply H in W.
  split; in_cases; subst; try (apply parents_edge); simpl; auto.
Qed.

Definition catmark_any : refinement :=
  refinement_with_rings polygon_corners polygon_parts polygon_parents polygon_common.
Definition bilinear_any : refinement := refinement_of_faces polygon_corners polygon_parts polygon_parents.

(* Weights of equal size for all corners of a face, which sum to a. *)
Definition spread (a : R) (f : polygon) : mask := map (fun v => (a / INR (length f), v)) f.

Lemma spread_nonnegative a f : 0 <= a -> nonnegative (spread a f).
Proof.
  intros A b x H; apply in_map_iff in H as [v [E V]]; injection E as <- <-.
  assert (0 < INR (length f)) by (apply lt_0_INR; destruct f; [destruct V | simpl; lia]).
  apply Rmult_le_pos; [exact A | apply Rlt_le, Rinv_0_lt_compat; assumption].
Qed.

Lemma total_equal {X} (b : R) (l : list X) : total (map (fun v => (b, v)) l) = INR (length l) * b.
Proof.
  induction l as [| x l IH]; [simpl; ring |].
  change (length (x :: l)) with (S (length l)); rewrite S_INR; simpl; rewrite IH; ring.
Qed.

Lemma total_spread a f : f <> [] -> total (spread a f) = a.
Proof.
  intros N; unfold spread; rewrite total_equal; field; apply not_0_INR; destruct f; [contradiction | discriminate].
Qed.

Lemma in_spread a b x f : In (b, x) (spread a f) -> In x f.
Proof. intros H; apply in_map_iff in H as [v [E V]]; injection E as <- <-; exact V. Qed.

(* All corners of all faces, as faces and numbers. *)
Definition all_corners (M : list polygon) := flat_map (fun f => map (pair f) (seq 0 (length f))) M.

Definition corners_at M v :=
  filter (fun c => if vertex_dec (at_corner (fst c) (snd c)) v then true else false) (all_corners M).

Definition sides_of M e :=
  filter (fun c => if vertex_dec (edge (at_corner (fst c) (snd c)) (next (fst c) (snd c))) e then true else false)
    (all_corners M).

(* At a vertex of n faces: (n - 2)/n of it, 1/n of the mean of the ends of its edges, 1/n of the mean of its faces' means.
   Each end counts half in each of its two faces. *)
Definition smooth_vertex (M : list polygon) (v : vertex) : mask :=
  let n := INR (length (corners_at M v)) in
  ((n - 2) / n, v) ::
  flat_map (fun c => (1 / (2 * (n * n)), next (fst c) (snd c)) :: (1 / (2 * (n * n)), previous (fst c) (snd c))
    :: spread (1 / (n * n)) (fst c)) (corners_at M v).

(* At an edge: a share for the mean of each face, 1/4 or, with smooth triangles, up to 0.47; the rest for the ends. *)
Definition smooth_edge (M : list polygon) (share : R) (u v : vertex) : mask :=
  ((1 - 2 * share) / 2, u) :: ((1 - 2 * share) / 2, v) ::
  flat_map (fun c => spread share (fst c)) (sides_of M (Edge u v)).

Inductive catmark_smooth (M : list polygon) : vertex -> mask -> Prop :=
| at_vertex v : (2 <= length (corners_at M v))%nat -> catmark_smooth M (Old v) (smooth_vertex M v)
| at_edge u v share : length (sides_of M (Edge u v)) = 2%nat -> 0 <= share <= 1/2 ->
    catmark_smooth M (Edge u v) (smooth_edge M share u v)
| at_face f : f <> [] -> catmark_smooth M (Face f) (spread 1 f).

Lemma in_all_corners M f k : In (f, k) (all_corners M) -> In f M /\ f <> [].
Proof.
  intros H; apply in_flat_map in H as [g [G H]]; apply in_map_iff in H as [j [E J]]; injection E as -> ->.
  split; [exact G |]; apply in_seq in J; intros ->; simpl in J; lia.
Qed.

Lemma in_corners_at M v f k : In (f, k) (corners_at M v) -> In f M /\ f <> [] /\ at_corner f k = v.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_all_corners in H as [F N]; simpl in E.
  destruct (vertex_dec (at_corner f k) v); [auto | discriminate].
Qed.

Lemma in_sides_of M e f k : In (f, k) (sides_of M e) -> In f M /\ f <> [] /\ edge (at_corner f k) (next f k) = e.
Proof.
  intros H; apply filter_In in H as [H E]; apply in_all_corners in H as [F N]; simpl in E.
  destruct (vertex_dec (edge (at_corner f k) (next f k)) e); [auto | discriminate].
Qed.

Lemma total_flat_map {X Y} (h : X -> list (R * Y)) a l : (forall x, In x l -> total (h x) = a) ->
  total (flat_map h l) = INR (length l) * a.
Proof.
  induction l as [| x l IH]; intros H; [simpl; ring |].
  change (length (x :: l)) with (S (length l)); rewrite S_INR.
  simpl; rewrite total_app, (H x (or_introl eq_refl)), (IH (fun y Y => H y (or_intror Y))); ring.
Qed.

Lemma catmark_smooth_mean M v l : catmark_smooth M v l -> is_mean l.
Proof.
  intros [u N | u w s N [S0 S1] | f N].
  - unfold smooth_vertex; pose proof (le_INR _ _ N) as L; change (INR 2) with (1 + 1) in L.
    set (n := INR (length (corners_at M u))) in *.
    assert (NN : 0 < n * n) by nra.
    assert (E1 : 0 <= 1 / (2 * (n * n))) by (apply Rlt_le, Rdiv_lt_0_compat; lra).
    assert (E2 : 0 <= 1 / (n * n)) by (apply Rlt_le, Rdiv_lt_0_compat; lra).
    split.
    + intros a x [H | H].
      { injection H as <- <-; apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]. }
      apply in_flat_map in H as [[f k] [_ [H | [H | H]]]];
        [injection H as <- <-; exact E1 | injection H as <- <-; exact E1 | exact (spread_nonnegative _ _ E2 a x H)].
    + cbn [total]; rewrite (total_flat_map _ (2 / (n * n))).
      * fold n; field; lra.
      * intros [f k] H'; apply in_corners_at in H' as [_ [F _]]; cbn [total fst]; rewrite (total_spread _ _ F); field; lra.
  - split.
    + intros a x [H | [H | H]]; try (injection H as <- <-; lra).
      apply in_flat_map in H as [[f k] [_ H]]; exact (spread_nonnegative _ _ S0 a x H).
    + unfold smooth_edge; cbn [total]; rewrite (total_flat_map _ s).
      * rewrite N; simpl; field.
      * intros [f k] H; apply in_sides_of in H as [_ [F _]]; apply total_spread, F.
  - split; [apply spread_nonnegative; lra | apply total_spread, N].
Qed.

Lemma catmark_smooth_around M v l : catmark_smooth M v l -> around polygon_corners M v l.
Proof.
  intros [u N | u w s N _ | f N] a x H.
  - destruct H as [H | H]; [left; injection H as <- <-; simpl; auto | right].
    apply in_flat_map in H as [[f k] [C H]]; apply in_corners_at in C as [F [N' <-]].
    exists f; split; [exact F |]; split; [intros z [<- | []]; apply at_corner_in, N' |].
    simpl in H; destruct H as [H | [H | H]];
      [injection H as <- <-; apply at_corner_in, N' | injection H as <- <-; apply at_corner_in, N' |
       exact (in_spread _ _ _ _ H)].
  - destruct H as [H | [H | H]]; try (left; injection H as <- <-; simpl; auto; fail); right.
    apply in_flat_map in H as [[f k] [C H]]; apply in_sides_of in C as [F [N' E]].
    exists f; split; [exact F |]; split; [| exact (in_spread _ _ _ _ H)].
    intros z Z; apply (edge_parents _ _ _ _ E z) in Z as [-> | ->]; apply at_corner_in, N'.
  - left; exact (in_spread _ _ _ _ H).
Qed.

(* Any choice of rules is proper. *)
Theorem catmark_any_proper M masks :
  (forall k c v, In c (mesh catmark_any M (S k)) -> In v c ->
     by_rule polygon_corners catmark_smooth (mesh catmark_any M k) v (masks k v)) ->
  proper catmark_any M masks.
Proof.
  intros H k c v C V; specialize (H k c v C V); split.
  - exact (by_rule_mean polygon_corners catmark_smooth catmark_smooth_mean _ _ _ H).
  - exact (by_rule_around polygon_corners catmark_smooth catmark_smooth_around _ _ _ H).
Qed.

(* The bilinear scheme has one rule. *)
Definition bilinear_mask (v : vertex) : mask :=
  match v with
  | Control _ => []
  | Old u => [(1, u)]
  | Edge u w => [(1/2, u); (1/2, w)]
  | Face f => spread 1 f
  end.

Theorem bilinear_any_proper M : proper bilinear_any M (fun _ => bilinear_mask).
Proof.
  intros k c v C V; split.
  - apply in_flat_map in C as [f [F C]]; apply child_shape in C as [N [u [n [p [_ [_ [_ H]]]]]]].
    apply H in V; in_cases; subst v;
      try (match goal with |- context [edge ?x ?y] => destruct (edge_shape x y) as [-> | ->] end);
      try (split; [intros a x X; simpl in X; in_cases; injection X as <- <-; lra | simpl; lra]).
    split; [apply spread_nonnegative; lra | apply total_spread, N].
  - intros a u H; destruct v; simpl in H; in_cases; try (injection H as <- <-); simpl; auto.
    exact (in_spread _ _ _ _ H).
Qed.
