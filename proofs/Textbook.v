(* On closed meshes the masks of vertices are those of textbooks: masks here give each corner of a face half of the weight of
   the edges beside it, and each edge has two faces. *)
From Coq Require Import Reals Lra List Arith Lia Permutation.
From Snug Require Import Points Vertices Mesh Quads Triangles.
Import ListNotations.
Open Scope R_scope.

Fixpoint sum_of (l : list point) : point := match l with [] => origin | p :: r => add p (sum_of r) end.
Definition mean (l : list point) : point := scale (1 / INR (length l)) (sum_of l).

Lemma sum_of_app k l : sum_of (k ++ l) = add (sum_of k) (sum_of l).
Proof. induction k as [| p k IH]; simpl; [| rewrite IH]; by_coordinates. Qed.

Lemma sum_of_permutation k l : Permutation k l -> sum_of k = sum_of l.
Proof. induction 1 as [| x k l _ IH | x y l | k l j _ IH1 _ IH2]; simpl; try congruence; by_coordinates. Qed.

Lemma count_is_count_occ l v : count_occ vertex_dec l v = count l v.
Proof. induction l as [| u l IH]; simpl; [reflexivity |]; unfold one_if; destruct (vertex_dec u v); lia. Qed.

(* A list in which everything occurs twice. *)
Lemma twice l : (forall v, In v l -> count l v = 2%nat) ->
  Permutation l (nodup vertex_dec l ++ nodup vertex_dec l).
Proof.
  intros T; apply (Permutation_count_occ vertex_dec); intros v; rewrite count_occ_app.
  destruct (in_dec vertex_dec v l) as [I | I].
  - rewrite count_is_count_occ, (T v I).
    assert (E : count_occ vertex_dec (nodup vertex_dec l) v = 1%nat).
    { apply NoDup_count_occ'; [apply NoDup_nodup | apply nodup_In, I]. }
    lia.
  - assert (N : ~ In v (nodup vertex_dec l)) by (rewrite nodup_In; exact I).
    apply (count_occ_not_In vertex_dec) in I; apply (count_occ_not_In vertex_dec) in N; lia.
Qed.

Lemma one_if_edge p q v w : v <> w -> one_if (edge p q) (edge v w) =
  (if vertex_dec p v then one_if q w else if vertex_dec q v then one_if p w else 0)%nat.
Proof.
  intros N; unfold one_if; destruct (vertex_dec (edge p q) (edge v w)) as [E | E].
  - apply edge_injective in E as [[-> ->] | [-> ->]]; repeat destruct vertex_dec; congruence.
  - repeat destruct vertex_dec; subst; try congruence; exfalso; apply E; auto using edge_sym.
Qed.

(* The ends of the edges at a vertex, each from both faces. *)
Definition quad_ends M v := flat_map (fun '(_, n, p, _) => [n; p]) (wedges_at M v).
Definition tri_ends M v := flat_map (fun '(_, n, p) => [n; p]) (tri_wedges_at M v).

Lemma filter_flat_map {X Y} (g : Y -> bool) (h : X -> list Y) l :
  filter g (flat_map h l) = flat_map (fun x => filter g (h x)) l.
Proof. induction l as [| x l IH]; simpl; [reflexivity |]; rewrite filter_app, IH; reflexivity. Qed.

Lemma quad_ends_count M v w : (forall f, In f M -> NoDup (quad_corners f)) -> v <> w ->
  count (quad_ends M v) w = count (flat_map quad_edges M) (edge v w).
Proof.
  intros N VW; unfold quad_ends, wedges_at; rewrite filter_flat_map, flat_map_flat_map, !count_flat_map.
  apply sum_same; intros f F; specialize (N f F); destruct f as [a b c d]; simpl in N; distinct; simpl.
  rewrite !one_if_edge by exact VW.
  repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y); [try congruence; subst |] end;
    simpl; try congruence; lia.
Qed.

Lemma tri_ends_count M v w : (forall f, In f M -> NoDup (tri_corners f)) -> v <> w ->
  count (tri_ends M v) w = count (flat_map tri_edges M) (edge v w).
Proof.
  intros N VW; unfold tri_ends, tri_wedges_at; rewrite filter_flat_map, flat_map_flat_map, !count_flat_map.
  apply sum_same; intros f F; specialize (N f F); destruct f as [a b c]; simpl in N; distinct; simpl.
  rewrite !one_if_edge by exact VW.
  repeat match goal with |- context [vertex_dec ?x ?y] => destruct (vertex_dec x y); [try congruence; subst |] end;
    simpl; try congruence; lia.
Qed.

Lemma count_positive l v : In v l <-> (0 < count l v)%nat.
Proof. rewrite <- count_is_count_occ; apply count_occ_In. Qed.

Lemma quad_no_own_end M v : (forall f, In f M -> NoDup (quad_corners f)) ->
  ~ In v (quad_ends M v) /\ ~ In (edge v v) (flat_map quad_edges M).
Proof.
  intros N; split; intros H; apply in_flat_map in H as [f H].
  - destruct f as [[[x n] p] q]; destruct H as [W H]; apply in_wedges_at in W as [f [F [W E]]]; simpl in E; subst x.
    specialize (N f F); destruct f as [a b c d]; simpl in N, W; distinct; simpl in H.
    in_cases; injection W as ? ? ? ?; congruence.
  - destruct H as [F H]; specialize (N f F); destruct f as [a b c d]; simpl in N, H; distinct.
    in_cases; apply edge_injective in H as [[? ?] | [? ?]]; congruence.
Qed.

Lemma tri_no_own_end M v : (forall f, In f M -> NoDup (tri_corners f)) ->
  ~ In v (tri_ends M v) /\ ~ In (edge v v) (flat_map tri_edges M).
Proof.
  intros N; split; intros H; apply in_flat_map in H as [f H].
  - destruct f as [[x n] p]; destruct H as [W H]; apply in_tri_wedges_at in W as [f [F [W E]]]; simpl in E; subst x.
    specialize (N f F); destruct f as [a b c]; simpl in N, W; distinct; simpl in H.
    in_cases; injection W as ? ? ?; congruence.
  - destruct H as [F H]; specialize (N f F); destruct f as [a b c]; simpl in N, H; distinct.
    in_cases; apply edge_injective in H as [[? ?] | [? ?]]; congruence.
Qed.

(* [ends_at edges v l]: l lists the other ends of the edges at v, each once. *)
Definition ends_at (edges : list vertex) (v : vertex) (l : list vertex) :=
  NoDup l /\ forall w, In w l <-> In (edge v w) edges.

Lemma ends_of edges v l (position : vertex -> point) :
  (forall e, In e edges -> count edges e = 2%nat) -> ~ In v l -> ~ In (edge v v) edges ->
  (forall w, v <> w -> count l w = count edges (edge v w)) ->
  exists ends, ends_at edges v ends /\ length l = (2 * length ends)%nat /\
    sum_of (map position l) = scale 2 (sum_of (map position ends)).
Proof.
  intros T V E C; exists (nodup vertex_dec l).
  assert (I : forall w, In w l <-> In (edge v w) edges).
  { intros w; destruct (vertex_dec v w) as [<- | N]; [tauto |].
    rewrite !count_positive, (C w N); reflexivity. }
  assert (P : Permutation l (nodup vertex_dec l ++ nodup vertex_dec l)).
  { apply twice; intros w W; rewrite C; [apply T, I, W | intros ->; exact (V W)]. }
  split; [split; [apply NoDup_nodup | intros w; rewrite nodup_In; apply I] |]; split.
  - rewrite (Permutation_length P) at 1; rewrite app_length; lia.
  - rewrite (sum_of_permutation _ _ (Permutation_map position P)), map_app, sum_of_app; by_coordinates.
Qed.

(* Catmull-Clark: (n - 2)/n of the vertex, 1/n of the mean of the ends, 1/n of the mean of the means of the faces. *)
Theorem catmark_textbook M v f position :
  quads_closed M -> In f M -> In v (quad_corners f) ->
  exists ends, ends_at (flat_map quad_edges M) v ends /\ length ends = valence M v /\
  let n := INR (valence M v) in
  apply_mask position (catmark_rule M (Old v)) =
  add (scale ((n - 2) / n) (position v))
    (add (scale (1 / n) (mean (map position ends)))
         (scale (1 / n) (mean (map (fun '(x, y, z, t) => mean [position x; position y; position z; position t])
                                   (wedges_at M v))))).
Proof.
  intros K F V; pose proof K as [_ [N T]].
  destruct (quad_no_own_end M v N) as [O1 O2].
  destruct (ends_of _ v (quad_ends M v) position T O1 O2) as [ends [E [L S]]].
  { intros w W; apply quad_ends_count; assumption. }
  assert (B : length (quad_ends M v) = (2 * valence M v)%nat).
  { unfold quad_ends, valence; generalize (wedges_at M v) as l.
    induction l as [| [[[x y] z] t] l IH]; simpl; [reflexivity |]; rewrite IH; lia. }
  assert (Q : length ends = valence M v) by lia.
  exists ends; split; [exact E |]; split; [exact Q |]; intros n.
  assert (P : n <> 0).
  { apply not_0_INR; pose proof (valence_two M f v K F V); lia. }
  unfold mean at 1 2; rewrite !map_length, Q; fold (valence M v); fold n.
  (* Sums over wedges. *)
  set (far := sum_of (map (fun '(_, _, _, t) => position t) (wedges_at M v))).
  assert (A : forall a b, combine (map (fun t => (fst t, position (snd t)))
      (flat_map (fun '(_, y, z, t) => [(a, y); (a, z); (b, t)]) (wedges_at M v)))
    = add (scale a (sum_of (map position (quad_ends M v)))) (scale b far)).
  { intros a b; unfold quad_ends, far; generalize (wedges_at M v) as l.
    induction l as [| [[[x y] z] t] l IH]; simpl; [| rewrite IH]; by_coordinates. }
  assert (C : sum_of (map (fun '(x, y, z, t) => mean [position x; position y; position z; position t]) (wedges_at M v))
    = scale (1/4) (add (scale n (position v)) (add (sum_of (map position (quad_ends M v))) far))).
  { unfold quad_ends, far, n, valence.
    assert (H : forall w, In w (wedges_at M v) -> fst (fst (fst w)) = v).
    { intros w W; apply in_wedges_at in W as [g [_ [_ W]]]; exact W. }
    revert H; generalize (wedges_at M v) as l.
    induction l as [| [[[x y] z] t] l IH]; intros H; [simpl; apply point_eq; simpl; ring |].
    pose proof (H _ (or_introl eq_refl)) as X; simpl in X; subst x.
    change (length ((v, y, z, t) :: l)) with (Datatypes.S (length l)); rewrite S_INR.
    simpl map; simpl sum_of; rewrite IH by (intros w W; apply H; right; exact W).
    unfold mean; apply point_eq; simpl; field. }
  rewrite C; unfold apply_mask, catmark_rule; fold n; simpl map; simpl combine.
  rewrite A, S; apply point_eq; simpl; field; exact P.
Qed.

(* Loop: 1 - a of the vertex, a of the mean of the ends. *)
Theorem loop_textbook M v f position :
  tris_closed M -> In f M -> In v (tri_corners f) ->
  exists ends, ends_at (flat_map tri_edges M) v ends /\ length ends = tri_valence M v /\
  let a := loop_weight (INR (tri_valence M v)) in
  apply_mask position (loop_rule M (Old v)) =
  add (scale (1 - a) (position v)) (scale a (mean (map position ends))).
Proof.
  intros K F V; pose proof K as [_ [N [_ T]]].
  destruct (tri_no_own_end M v N) as [O1 O2].
  destruct (ends_of _ v (tri_ends M v) position T O1 O2) as [ends [E [L S]]].
  { intros w W; apply tri_ends_count; assumption. }
  assert (B : length (tri_ends M v) = (2 * tri_valence M v)%nat).
  { unfold tri_ends, tri_valence; generalize (tri_wedges_at M v) as l.
    induction l as [| [[x y] z] l IH]; simpl; [reflexivity |]; rewrite IH; lia. }
  assert (Q : length ends = tri_valence M v) by lia.
  exists ends; split; [exact E |]; split; [exact Q |]; intros a.
  unfold mean; rewrite map_length, Q; unfold apply_mask, loop_rule; fold a.
  set (n := INR (tri_valence M v)) in *.
  assert (P : n <> 0).
  { apply not_0_INR; pose proof (valence_one M f v F V); lia. }
  assert (A : forall b, combine (map (fun t => (fst t, position (snd t)))
      (flat_map (fun '(_, y, z) => [(b, y); (b, z)]) (tri_wedges_at M v)))
    = scale b (sum_of (map position (tri_ends M v)))).
  { intros b; unfold tri_ends; generalize (tri_wedges_at M v) as l.
    induction l as [| [[x y] z] l IH]; simpl; [| rewrite IH]; by_coordinates. }
  simpl map; simpl combine; rewrite A, S; apply point_eq; simpl; field; exact P.
Qed.
