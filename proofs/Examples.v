(* Tests of the definitions: meshes that are closed, that are not, masks at known valences, and a certificate. *)
From Coq Require Import Reals Lra List Arith Lia.
From Snug Require Import Points Separation Subdivision Vertices Mesh Quads Triangles Polygons.
Import ListNotations.
Open Scope R_scope.

Definition quad_of a b c d := Quad (Control a) (Control b) (Control c) (Control d).
Definition triangle_of a b c := Triangle (Control a) (Control b) (Control c).

(* Corner i of the cube has bits 0, 1, 2 of i as x, y, z. *)
Definition cube : list quad :=
  [quad_of 0 2 3 1; quad_of 4 5 7 6; quad_of 0 1 5 4; quad_of 2 6 7 3; quad_of 0 4 6 2; quad_of 1 3 7 5].

Definition tetrahedron : list triangle :=
  [triangle_of 0 1 2; triangle_of 0 3 1; triangle_of 1 3 2; triangle_of 2 3 0].

Lemma cube_closed : quads_closed cube.
Proof.
  split; [| split].
  - repeat constructor; simpl; intros H; in_cases; discriminate.
  - intros f F; simpl in F; in_cases; subst; repeat constructor; simpl; intros H; in_cases; discriminate.
  - intros e E; simpl in E; in_cases; subst; reflexivity.
Qed.

Lemma tetrahedron_closed : tris_closed tetrahedron.
Proof.
  split; [| split; [| split]].
  - repeat constructor; simpl; intros H; in_cases; discriminate.
  - intros f F; simpl in F; in_cases; subst; repeat constructor; simpl; intros H; in_cases; discriminate.
  - intros f g F G I; simpl in F, G; in_cases; subst; try reflexivity; exfalso;
      pose proof (I _ (or_introl eq_refl)) as I1; pose proof (I _ (or_intror (or_introl eq_refl))) as I2;
      pose proof (I _ (or_intror (or_intror (or_introl eq_refl)))) as I3; simpl in I1, I2, I3; clear I;
      in_cases; discriminate.
  - intros e E; simpl in E; in_cases; subst; reflexivity.
Qed.

Lemma cube_with_a_hole : ~ quads_closed (tl cube).
Proof. intros [_ [_ T]]; specialize (T (Edge (Control 0) (Control 2))); simpl in T; discriminate T; auto 20. Qed.

(* Two steps make 96 quads and 64 triangles; vertices keep their valence, those of edges and faces get theirs. *)
Example cube_twice : length (mesh catmark cube 2) = 96%nat.
Proof. vm_compute; reflexivity. Qed.

Example tetrahedron_twice : length (mesh loop tetrahedron 2) = 64%nat.
Proof. vm_compute; reflexivity. Qed.

Example cube_valences :
  (valence (mesh catmark cube 2) (Old (Old (Control 0))),
   valence (mesh catmark cube 2) (Old (Edge (Control 0) (Control 2))),
   valence (mesh catmark cube 1) (Face [Control 0; Control 2; Control 3; Control 1])) = (3, 4, 4)%nat.
Proof. vm_compute; reflexivity. Qed.

Example tetrahedron_valences :
  (tri_valence (mesh loop tetrahedron 2) (Old (Old (Control 0))),
   tri_valence (mesh loop tetrahedron 2) (Old (Edge (Control 0) (Control 1)))) = (3, 6)%nat.
Proof. vm_compute; reflexivity. Qed.

(* Children of polygons with four corners are those of quads. *)
Example same_children a b c d : polygon_parts [a; b; c; d] = map quad_corners (quad_parts (Quad a b c d)).
Proof. reflexivity. Qed.

Example pentagon_child a b c d e :
  nth 2 (polygon_parts [a; b; c; d; e]) [] = [Old c; edge c d; Face [a; b; c; d; e]; edge b c].
Proof. reflexivity. Qed.

(* A face of a cube meets itself and the four beside it. *)
Example cube_ring : length (filter (meets quad_corners (quad_of 0 2 3 1)) cube) = 5%nat.
Proof. vm_compute; reflexivity. Qed.

(* Loop's weights of the ring, 9/16 at valence 3 and 3/8 at valence 6. *)
Example loop_three : loop_weight 3 = 9/16.
Proof.
  unfold loop_weight; replace (2 * PI / 3) with (2 * (PI / 3)) by lra.
  rewrite cos_2PI3; lra.
Qed.

Example loop_six : loop_weight 6 = 3/8.
Proof.
  unfold loop_weight; replace (2 * PI / 6) with (PI / 3) by lra.
  rewrite cos_PI3; lra.
Qed.

(* A vertex of valence 4 gets 9/16, 3/32 of each edge's other end (in two wedges), 1/64 of each corner across. *)
Example catmark_four : 1 - 7 / (4 * 4) = 9/16 /\ 2 * (3 / (4 * (4 * 4))) = 3/32 /\ 1 / (4 * (4 * 4)) = 1/64.
Proof. repeat split; lra. Qed.

(* Unit cubes, 2 apart, and a certificate that their Catmull-Clark surfaces are more than 1 apart. *)
Definition bit (i : nat) : R := if Nat.odd i then 1 else 0.

Definition cube_at (x : R) (v : vertex) : point :=
  match v with
  | Control i => pt (x + bit i) (bit (Nat.div2 i)) (bit (Nat.div2 (Nat.div2 i)))
  | _ => origin
  end.

Definition cube_masks k := catmark_rule (mesh catmark cube k).
Definition cube_proper : proper catmark cube cube_masks := catmark_proper cube cube_closed.
Definition cubes : hierarchy := faces catmark cube cube_masks cube_proper.
Definition cube_surface x := surface_of cubes (cube_at x).
Definition cube_limit x := limit_surface cubes (cube_at x) cube.

Definition clearance := let east := pt 1 0 0 in HalveA (Leaf east) (HalveB (Leaf east) (Leaf east)).

Lemma cube_rings x l : (forall o, In o l -> exists f, In f cube /\ o = (O, f)) ->
  forall p, In p (rings (cube_surface x) l) -> x <= px p <= x + 1.
Proof.
  intros H p P; apply in_flat_map in P as [o [O P]]; destruct (H o O) as [f [F ->]].
  simpl in P; apply in_map_iff in P as [v [<- V]]; simpl in V |- *.
  destruct (near_existing catmark cube f v F V) as [g [G W]].
  simpl in G; in_cases; subst; simpl in W; in_cases; subst; unfold cube_at, bit; simpl; lra.
Qed.

Lemma part_of_own_order (l : list (nat * quad)) : incl l (map (pair O) cube) ->
  forall o, In o l -> exists f, In f cube /\ o = (O, f).
Proof. intros I o O; apply I, in_map_iff in O as [f [<- F]]; eauto. Qed.

Lemma leaf_east k l : incl k (map (pair O) cube) -> incl l (map (pair O) cube) ->
  leaf_condition 1 (pt 1 0 0) (among (rings (cube_surface 0) k)) (among (rings (cube_surface 3) l)).
Proof.
  intros K L p q P Q.
  pose proof (cube_rings 0 k (part_of_own_order k K) p P).
  pose proof (cube_rings 3 l (part_of_own_order l L) q Q).
  unfold norm; replace (dot (pt 1 0 0) (pt 1 0 0)) with 1 by (unfold dot; simpl; ring).
  rewrite sqrt_1; unfold dot; simpl; lra.
Qed.

Example cubes_apart :
  apart 1 (cube_limit 0) (cube_limit 3).
Proof.
  apply (certificate_sound 1 cubes cubes (cube_at 0) (cube_at 3) cube cube clearance
    (map (pair O) cube) (map (pair O) cube)); try (intros f F; exact F); try apply in_own_order.
  assert (F : forall l : list (nat * quad), incl (firstn (Nat.div2 (length l)) l) l).
  { intros l o O; rewrite <- (firstn_skipn (Nat.div2 (length l)) l); apply in_or_app; left; exact O. }
  assert (G : forall l : list (nat * quad), incl (skipn (Nat.div2 (length l)) l) l).
  { intros l o O; rewrite <- (firstn_skipn (Nat.div2 (length l)) l); apply in_or_app; right; exact O. }
  split; [| split]; apply leaf_east; try apply incl_refl; try apply F; apply G.
Qed.

(* Limit surfaces are not empty: a bilinear one holds its control points. *)
Fixpoint old_often (k : nat) (v : vertex) := match k with O => v | S j => Old (old_often j v) end.
Fixpoint corner_child (k : nat) (f : quad) := match k with O => f | S j => nth 0 (quad_parts (corner_child j f)) f end.

Lemma corner_child_shape k f : exists b c d, corner_child k f = Quad (old_often k (hd (Control 0) (quad_corners f))) b c d.
Proof.
  induction k as [| k [b [c [d E]]]]; [destruct f as [a b c d]; simpl; eauto |].
  simpl corner_child; rewrite E; simpl; eauto.
Qed.

Example bilinear_corner M (K : quads_closed M) position a b c d : In (Quad a b c d) M ->
  limit_surface (faces bilinear M _ (bilinear_proper M K)) position M (position a).
Proof.
  intros F; exists (Quad a b c d); split; [exact F |].
  exists (fun k => (k, corner_child k (Quad a b c d))), (fun _ => position a).
  assert (P : forall k, place (faces bilinear M _ (bilinear_proper M K)) position k (old_often k a) = position a).
  { induction k as [| k IH]; [reflexivity |]; simpl in *; unfold apply_mask; simpl; rewrite IH.
    apply point_eq; simpl; ring. }
  split; [split; [reflexivity |] |]; [| split].
  - intros k; apply in_map_iff; exists (corner_child (S k) (Quad a b c d)); split; [reflexivity |]; simpl.
    destruct (corner_child_shape k (Quad a b c d)) as [x [y [z ->]]]; simpl; auto.
  - intros k; apply hull_in; simpl; unfold ring_points; simpl.
    destruct (corner_child_shape k (Quad a b c d)) as [x [y [z ->]]]; simpl; left; apply P.
  - intros eps H; exists O; intros k _; unfold dist, norm.
    replace (dot (sub (position a) (position a)) (sub (position a) (position a))) with 0 by (unfold dot; simpl; ring).
    rewrite sqrt_0; exact H.
Qed.
