(* A pose x -> R x + t moves the limit surface with its control points, whatever its twelve numbers are. *)
From Coq Require Import Reals Lra List Arith.
From Snug Require Import Points Separation Subdivision Vertices Mesh.
Import ListNotations.
Open Scope R_scope.

Record pose := { row_x : point; row_y : point; row_z : point; shift : point }.

Definition rotate (g : pose) (x : point) := pt (dot (row_x g) x) (dot (row_y g) x) (dot (row_z g) x).
Definition move (g : pose) (x : point) := add (rotate g x) (shift g).

Definition moved (g : pose) (l : list (R * point)) := map (fun t => (fst t, move g (snd t))) l.

Lemma combine_moved g l : combine (moved g l) = add (rotate g (combine l)) (scale (total l) (shift g)).
Proof.
  induction l as [| [a p] l IH]; simpl; [| rewrite IH]; apply point_eq; simpl; unfold dot; simpl; ring.
Qed.

Lemma total_moved g l : total (moved g l) = total l.
Proof. induction l as [| [a p] l IH]; simpl; [| rewrite IH]; reflexivity. Qed.

Lemma move_combine g l : total l = 1 -> move g (combine l) = combine (moved g l).
Proof. intros H; rewrite combine_moved, H; unfold move; apply point_eq; simpl; ring. Qed.

Lemma move_hull g l x : hull (among l) x -> hull (among (map (move g) l)) (move g x).
Proof.
  intros [k [A [B [C ->]]]]; exists (moved g k); repeat split.
  - intros a q H; apply in_map_iff in H as [[b p] [E H]]; injection E as <- <-; exact (A b p H).
  - intros a q H; apply in_map_iff in H as [[b p] [E H]]; injection E as <- <-; apply in_map; exact (B b p H).
  - rewrite total_moved; exact C.
  - apply move_combine, C.
Qed.

(* A pose is continuous. *)
Definition factor (g : pose) := norm (row_x g) + norm (row_y g) + norm (row_z g).

Lemma abs_dot p q : Rabs (dot p q) <= norm p * norm q.
Proof.
  apply Rabs_le; split; [| apply cauchy_schwarz].
  pose proof (cauchy_schwarz (opposite p) q) as H; rewrite dot_opposite in H.
  replace (norm (opposite p)) with (norm p) in H; [lra |].
  unfold norm; f_equal; unfold dot; simpl; ring.
Qed.

Lemma norm_le_sum p : norm p <= Rabs (px p) + Rabs (py p) + Rabs (pz p).
Proof.
  pose proof (Rabs_pos (px p)); pose proof (Rabs_pos (py p)); pose proof (Rabs_pos (pz p)).
  unfold norm; rewrite <- (sqrt_square (Rabs (px p) + Rabs (py p) + Rabs (pz p))) by lra.
  apply sqrt_le_1_alt; unfold dot.
  assert (E : forall x, x * x = Rabs x * Rabs x).
  { intros x; rewrite <- Rabs_mult, Rabs_pos_eq; [reflexivity | apply Rle_0_sqr]. }
  rewrite (E (px p)), (E (py p)), (E (pz p)); nra.
Qed.

Lemma move_dist g x y : dist (move g x) (move g y) <= factor g * dist x y.
Proof.
  unfold dist; replace (sub (move g x) (move g y)) with (rotate g (sub x y))
    by (apply point_eq; simpl; unfold dot; simpl; ring).
  eapply Rle_trans; [apply norm_le_sum |]; simpl.
  pose proof (abs_dot (row_x g) (sub x y)); pose proof (abs_dot (row_y g) (sub x y)).
  pose proof (abs_dot (row_z g) (sub x y)); unfold factor; lra.
Qed.

Lemma factor_nonneg g : 0 <= factor g.
Proof.
  unfold factor; pose proof (norm_nonneg (row_x g)); pose proof (norm_nonneg (row_y g)).
  pose proof (norm_nonneg (row_z g)); lra.
Qed.

Lemma move_tends g s x : tends_to s x -> tends_to (fun k => move g (s k)) (move g x).
Proof.
  intros T eps He; pose proof (factor_nonneg g) as F.
  destruct (T (eps / (factor g + 1))) as [n Hn]; [apply Rdiv_lt_0_compat; lra |].
  exists n; intros k Hk; specialize (Hn k Hk); pose proof (move_dist g (s k) x) as M.
  pose proof (dist_nonneg (s k) x).
  assert (E : eps / (factor g + 1) * (factor g + 1) = eps) by (field; lra).
  set (e := eps / (factor g + 1)) in *; nra.
Qed.

Section Moved.
Variables (H : hierarchy) (position : vertex -> point) (g : pose).

Definition moved_position v := move g (position v).

Lemma moved_mask k v : (forall a u, In (a, u) (masks_at H k v) ->
    place H moved_position k u = move g (place H position k u)) -> is_mean (masks_at H k v) ->
  place H moved_position (S k) v = move g (place H position (S k) v).
Proof.
  intros L [_ T]; simpl; unfold apply_mask; rewrite move_combine.
  - unfold moved; rewrite map_map; f_equal; apply map_ext_in; intros [a u] U; simpl; f_equal; exact (L a u U).
  - rewrite <- T; generalize (masks_at H k v) as l; clear.
    induction l as [| [a u] l IH]; simpl; [reflexivity |]; rewrite IH; reflexivity.
Qed.

(* Along a line of descendants. *)
Lemma ring_moved path : exists_at H (fst (path O)) (snd (path O)) -> fst (path O) = O ->
  (forall k, In (path (S k)) (parts_of H (path k))) ->
  forall k, existing H (path k) /\ fst (path k) = k /\
    forall v, In v (near_at H k (snd (path k))) -> place H moved_position k v = move g (place H position k v).
Proof.
  intros E Z L; induction k as [| k [IE [IZ IV]]]; [repeat split; auto |].
  pose proof (parts_existing H _ _ IE (L k)) as E'.
  specialize (L k); unfold existing in *; destruct (path k) as [j o], (path (S k)) as [i c].
  simpl fst in *; simpl snd in *; subst j.
  apply in_map_iff in L as [d [D L]]; injection D as <- <-; simpl in L.
  split; [exact E' |]; split; [reflexivity |]; intros v V.
  destruct (masks_near H k o d v IE L V) as [M N]; apply moved_mask; [| exact M].
  intros a u U; exact (IV u (N a u U)).
Qed.

Theorem limit_moved F x : all_exist H F ->
  limit_surface H position F x -> limit_surface H moved_position F (move g x).
Proof.
  intros I [f [Ff [path [s [[E L] [Hs T]]]]]]; exists f; split; [exact Ff |].
  exists path, (fun k => move g (s k)); split; [split; [exact E | exact L] |]; split.
  - intros k; specialize (Hs k).
    destruct (ring_moved path) with (k := k) as [_ [Z V]]; [rewrite E; exact (I f Ff) | rewrite E; reflexivity | exact L |].
    simpl in *; unfold ring_points in *; rewrite Z in *.
    rewrite (map_ext_in _ _ _ V), <- map_map; apply move_hull, Hs.
  - apply move_tends, T.
Qed.
End Moved.

(* Two placed surfaces. *)
Theorem placed_sound m (H K : hierarchy) p q g h F G t a b :
  all_exist H F -> all_exist K G ->
  orders H (moved_position p g) F a -> orders K (moved_position q h) G b ->
  accepted m (surface_of H (moved_position p g)) (surface_of K (moved_position q h)) t a b ->
  forall x y, limit_surface H p F x -> limit_surface K q G y -> m < dist (move g x) (move h y).
Proof.
  intros IA IB OA OB T x y X Y.
  exact (certificate_sound m H K _ _ F G t a b IA IB OA OB T _ _
    (limit_moved H p g F x IA X) (limit_moved K q h G y IB Y)).
Qed.
