(* Doo-Sabin and Midedge subdivision, whose owners are vertices. *)
From Coq Require Import Reals Lra List Arith Lia.
From Snug Require Import Points Vertices Mesh Polygons.
Import ListNotations.
Open Scope R_scope.

(* The new vertex in face f near its corner v. *)
Definition inside (v : vertex) (f : polygon) : vertex := Face (v :: f).

(* Each new face lies in a face, across an edge from u to w, or around a vertex. *)
Definition in_face (M : list polygon) (c : polygon) :=
  exists f, In f M /\ forall x, In x c -> exists v, In v f /\ x = inside v f.
Definition across_edge (M : list polygon) (c : polygon) :=
  exists u w, forall x, In x c -> exists v f, In f M /\ In u f /\ In w f /\ (v = u \/ v = w) /\ x = inside v f.
Definition around_vertex (M : list polygon) (c : polygon) :=
  exists v, forall x, In x c -> exists f, In f M /\ In v f /\ x = inside v f.

Definition new_face (M : list polygon) (c : polygon) :=
  (2 <= length c)%nat /\ (in_face M c \/ across_edge M c \/ around_vertex M c).

(* Vertices of new faces at the new vertex near v stem from faces at v. *)
Lemma new_face_near M c v f x : new_face M c -> In (inside v f) c -> In x c ->
  exists u g, x = inside u g /\ In g M /\ In u g /\ In v g.
Proof.
  intros [_ [[g [G H]] | [[p [q H]] | [p H]]]] V X.
  - destruct (H _ V) as [v' [V' E]], (H _ X) as [u [U ->]]; injection E as -> ->; exists u, g; auto.
  - destruct (H _ V) as [v' [f' [F [P [Q [E' E]]]]]], (H _ X) as [u [g [G [P' [Q' [E'' ->]]]]]]; injection E as -> ->.
    exists u, g; repeat split; auto; [destruct E'' as [-> | ->] | destruct E' as [-> | ->]]; assumption.
  - destruct (H _ V) as [f' [F [P E]]], (H _ X) as [g [G [Q ->]]]; injection E as -> ->; exists p, g; auto.
Qed.

Fixpoint number_of (v : vertex) (f : polygon) : nat :=
  match f with [] => O | u :: r => if vertex_dec u v then O else S (number_of v r) end.

Lemma number_of_less v f : In v f -> (number_of v f < length f)%nat.
Proof.
  induction f as [| u f IH]; simpl; intros H; [destruct H |].
  destruct (vertex_dec u v); [lia |]; destruct H as [H | H]; [contradiction |]; specialize (IH H); lia.
Qed.

Section Dual.
(* The mask of the new vertex at corner i of a face. *)
Variable mask_in : polygon -> nat -> mask.
Hypothesis mask_mean : forall f i, (2 <= length f)%nat -> (i < length f)%nat -> is_mean (mask_in f i).
Hypothesis mask_own : forall f i a u, (2 <= length f)%nat -> In (a, u) (mask_in f i) -> In u f.

(* Meshes, each of new faces of the one before, and the order of the faces around a vertex. *)
Variable meshes : nat -> list polygon.
Hypothesis first_faces : forall c, In c (meshes 0) -> (2 <= length c)%nat.
Hypothesis steps : forall k c, In c (meshes (S k)) -> new_face (meshes k) c.
Variable faces_around : nat -> vertex -> list polygon.
Hypothesis faces_around_spec : forall k v f, In f (faces_around k v) -> In f (meshes k) /\ In v f.

Lemma two_corners k c : In c (meshes k) -> (2 <= length c)%nat.
Proof. destruct k; intros C; [exact (first_faces c C) | apply (steps k c C)]. Qed.

Definition dual_near k (v : vertex) := flat_map (fun f => f) (filter (is_in v) (meshes k)).
Definition dual_parts k v := map (inside v) (faces_around k v).
Definition dual_masks (k : nat) (v : vertex) : mask :=
  match v with Face (u :: f) => mask_in f (number_of u f) | _ => [] end.

Lemma dual_near_spec k v x : In x (dual_near k v) <-> exists f, In f (meshes k) /\ In v f /\ In x f.
Proof.
  unfold dual_near; rewrite in_flat_map; split; intros [f H]; exists f; rewrite filter_In in *;
    unfold is_in in *; destruct (in_dec vertex_dec v f); intuition congruence.
Qed.

Lemma dual_masks_near k v c x : True -> In c (dual_parts k v) -> In x (dual_near (S k) c) ->
  is_mean (dual_masks k x) /\ forall a u, In (a, u) (dual_masks k x) -> In u (dual_near k v).
Proof.
  intros _ C X; apply in_map_iff in C as [f [<- C]].
  apply dual_near_spec in X as [d [D [V X]]].
  destruct (new_face_near _ _ _ _ _ (steps k d D) V X) as [u [g [-> [G [U W]]]]]; simpl; split.
  - apply mask_mean; [exact (two_corners k g G) | exact (number_of_less u g U)].
  - intros a w M; apply dual_near_spec; exists g; repeat split; auto.
    exact (mask_own g _ a w (two_corners k g G) M).
Qed.

Definition dual : hierarchy :=
  {| part := vertex; exists_at := fun _ _ => True; parts_at := dual_parts; near_at := dual_near;
     masks_at := dual_masks; parts_exist := fun _ _ _ _ _ => I; masks_near := dual_masks_near |}.
End Dual.

(* Sums. *)
Fixpoint sum_below (h : nat -> R) (n : nat) : R := match n with O => 0 | S m => sum_below h m + h m end.

Lemma total_seq {X} (h : nat -> R) (y : nat -> X) n :
  total (map (fun j => (h j, y j)) (seq 0 n)) = sum_below h n.
Proof.
  induction n as [| n IH]; [reflexivity |].
  rewrite seq_S, map_app, total_app, IH; simpl; ring.
Qed.

Lemma sum_below_add g h n : sum_below (fun j => g j + h j) n = sum_below g n + sum_below h n.
Proof. induction n as [| n IH]; simpl; [| rewrite IH]; ring. Qed.

Lemma sum_below_times a h n : sum_below (fun j => a * h j) n = a * sum_below h n.
Proof. induction n as [| n IH]; simpl; [| rewrite IH]; ring. Qed.

Lemma sum_below_same g h n : (forall j, g j = h j) -> sum_below g n = sum_below h n.
Proof. intros E; induction n as [| n IH]; simpl; [reflexivity | rewrite IH, E; reflexivity]. Qed.

Lemma sum_below_constant a n : sum_below (fun _ => a) n = INR n * a.
Proof. induction n as [| n IH]; [simpl; ring |]; rewrite S_INR; simpl; rewrite IH; ring. Qed.

Lemma sum_below_one a i n : (i < n)%nat -> sum_below (fun j => if Nat.eqb i j then a else 0) n = a.
Proof.
  assert (Z : forall m, (m <= i)%nat -> sum_below (fun j => if Nat.eqb i j then a else 0) m = 0).
  { induction m as [| m IH]; intros L; simpl; [reflexivity |].
    rewrite IH by lia; destruct (Nat.eqb_spec i m); [lia | ring]. }
  induction n as [| n IH]; intros L; [lia |]; simpl.
  destruct (Nat.eqb_spec i n) as [-> | N]; [rewrite Z by lia; ring | rewrite IH by lia; ring].
Qed.

Lemma sum_cosines theta a n :
  2 * sin (theta / 2) * sum_below (fun j => cos (theta * (INR j - a))) n
  = sin (theta * (INR n - a) - theta / 2) - sin (theta * (0 - a) - theta / 2).
Proof.
  induction n as [| n IH]; [simpl; ring |].
  simpl sum_below; rewrite Rmult_plus_distr_l, IH, S_INR.
  replace (theta * (INR n + 1 - a) - theta / 2) with (theta * (INR n - a) + theta / 2) by field.
  rewrite sin_plus, sin_minus; ring.
Qed.

Lemma cosines_of_a_turn i n : (2 <= n)%nat -> sum_below (fun j => cos (2 * PI / INR n * (INR j - INR i))) n = 0.
Proof.
  intros N; pose proof (le_INR _ _ N) as L; change (INR 2) with (1 + 1) in L; pose proof PI_RGT_0 as P.
  assert (S : 0 < sin (2 * PI / INR n / 2)).
  { replace (2 * PI / INR n / 2) with (PI / INR n) by (field; lra).
    assert (PI / INR n * INR n = PI) by (field; lra).
    assert (0 < PI / INR n) by (apply Rdiv_lt_0_compat; lra).
    apply sin_gt_0; nra. }
  pose proof (sum_cosines (2 * PI / INR n) (INR i) n) as H.
  replace (2 * PI / INR n * (INR n - INR i) - 2 * PI / INR n / 2)
    with (2 * PI / INR n * (0 - INR i) - 2 * PI / INR n / 2 + 2 * PI) in H by (field; lra).
  rewrite sin_plus, sin_2PI, cos_2PI in H.
  apply Rmult_eq_reg_l with (2 * sin (2 * PI / INR n / 2)); lra.
Qed.

(* Doo-Sabin: 1/4 + 5/(4n) of the corner itself, (3 + 2 cos(2 pi d/n))/(4n) of the corner d further round. *)
Definition doo_sabin_weight (n i j : nat) : R :=
  (if Nat.eqb i j then 1/4 else 0) + (3 + 2 * cos (2 * PI / INR n * (INR j - INR i))) / (4 * INR n).

Definition doo_sabin_mask (f : polygon) (i : nat) : mask :=
  map (fun j => (doo_sabin_weight (length f) i j, nth j f (Control 0))) (seq 0 (length f)).

Lemma doo_sabin_mean f i : (2 <= length f)%nat -> (i < length f)%nat -> is_mean (doo_sabin_mask f i).
Proof.
  intros N L; pose proof (le_INR _ _ N) as B; change (INR 2) with (1 + 1) in B; split.
  - intros a x H; apply in_map_iff in H as [j [E _]]; injection E as <- ?; unfold doo_sabin_weight.
    pose proof (COS_bound (2 * PI / INR (length f) * (INR j - INR i))) as [C _].
    assert (0 <= (3 + 2 * cos (2 * PI / INR (length f) * (INR j - INR i))) / (4 * INR (length f))).
    { apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]. }
    destruct (Nat.eqb i j); lra.
  - unfold doo_sabin_mask; rewrite (total_seq (doo_sabin_weight (length f) i)); unfold doo_sabin_weight.
    set (n := length f) in *; rewrite sum_below_add, sum_below_one by exact L.
    rewrite (sum_below_same _ (fun j => 3 / (4 * INR n) + 2 / (4 * INR n) * cos (2 * PI / INR n * (INR j - INR i))))
      by (intros j; field; lra).
    rewrite sum_below_add, sum_below_times, sum_below_constant, cosines_of_a_turn by exact N; field; lra.
Qed.

Lemma doo_sabin_own f i a u : (2 <= length f)%nat -> In (a, u) (doo_sabin_mask f i) -> In u f.
Proof.
  intros N H; apply in_map_iff in H as [j [E J]]; injection E as ? <-; apply in_seq in J; apply nth_In; lia.
Qed.

Example doo_sabin_own_weight n i : INR n <> 0 -> doo_sabin_weight n i i = 1/4 + 5 / (4 * INR n).
Proof.
  intros N; unfold doo_sabin_weight; rewrite Nat.eqb_refl.
  replace (2 * PI / INR n * (INR i - INR i)) with 0 by ring; rewrite cos_0; field; exact N.
Qed.

(* Midedge: half of the corner itself, a quarter of each neighbour. *)
Definition midedge_mask (f : polygon) (i : nat) : mask := [(1/2, at_corner f i); (1/4, next f i); (1/4, previous f i)].

Lemma midedge_mean f i : (2 <= length f)%nat -> (i < length f)%nat -> is_mean (midedge_mask f i).
Proof. intros _ _; split; [intros a x H; unfold midedge_mask in H; in_cases; injection H as <- <-; lra | simpl; lra]. Qed.

Lemma midedge_own f i a u : (2 <= length f)%nat -> In (a, u) (midedge_mask f i) -> In u f.
Proof.
  intros N H; assert (f <> []) by (intros ->; simpl in N; lia).
  unfold midedge_mask in H; in_cases; injection H as ? <-; apply at_corner_in; assumption.
Qed.

Definition doo_sabin := dual doo_sabin_mask doo_sabin_mean doo_sabin_own.
Definition midedge := dual midedge_mask midedge_mean midedge_own.
