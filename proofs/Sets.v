(* The other sets of certificates: points, segments and rays. *)
From Coq Require Import Reals Lra List.
From Snug Require Import Points Separation Subdivision.
Import ListNotations.
Open Scope R_scope.

(* The hull of finitely many points, as one owner that is its own child. *)
Definition fixed (l : list point) : surface.
Proof.
  refine {| owner := unit; good := fun _ => True; ring := fun _ => l; children := fun o => [o] |}.
  - intros; exact I.
  - intros o c _ _ p Hp; apply hull_in, Hp.
Defined.

Lemma fixed_good l b : all_good (fixed l) b.
Proof. intros o _; exact I. Qed.

Lemma dist_same x : dist x x = 0.
Proof. unfold dist, norm; replace (dot (sub x x) (sub x x)) with 0 by (unfold dot; simpl; ring); apply sqrt_0. Qed.

Lemma fixed_piece l x : hull (among l) x -> pieces (fixed l) [tt] x.
Proof.
  intros H; exists tt; split; [left; reflexivity |].
  exists (fun _ => tt), (fun _ => x); split; [| split].
  - split; [reflexivity | intros k; left; reflexivity].
  - intros _; exact H.
  - intros eps He; exists O; intros k _; rewrite dist_same; exact He.
Qed.

Definition along (start d : point) (t : R) := add start (scale t d).

Definition segment (start d : point) (t0 t1 : R) (x : point) := exists t, t0 <= t <= t1 /\ x = along start d t.

Lemma segment_hull start d t0 t1 x :
  segment start d t0 t1 x -> hull (among [along start d t0; along start d t1]) x.
Proof.
  intros [t [[L U] ->]]; destruct (Req_dec t0 t1) as [E | E].
  { replace t with t0 by lra; apply hull_in; left; reflexivity. }
  exists [((t1 - t) / (t1 - t0), along start d t0); ((t - t0) / (t1 - t0), along start d t1)].
  assert (0 <= (t1 - t) / (t1 - t0)) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
  assert (0 <= (t - t0) / (t1 - t0)) by (apply Rmult_le_pos; [lra | apply Rlt_le, Rinv_0_lt_compat; lra]).
  repeat split.
  - intros a q [H1 | [H1 | []]]; injection H1 as <- <-; assumption.
  - intros a q [H1 | [H1 | []]]; injection H1 as <- <-; simpl; auto.
  - simpl; field; lra.
  - apply point_eq; simpl; field; lra.
Qed.

Theorem point_sound m A t a p :
  all_good A a -> accepted m A (fixed [p]) t a [tt] -> forall x, pieces A a x -> m < dist x p.
Proof.
  intros G H x Hx; apply (accepted_apart m A (fixed [p]) t a [tt] G (fixed_good _ _) H); [exact Hx |].
  apply fixed_piece, hull_in; left; reflexivity.
Qed.

Theorem segment_sound m A t a start d t0 t1 :
  all_good A a -> accepted m A (fixed [along start d t0; along start d t1]) t a [tt] ->
  apart m (pieces A a) (segment start d t0 t1).
Proof.
  intros G H x y Hx Hy.
  apply (accepted_apart m A (fixed [along start d t0; along start d t1]) t a [tt] G (fixed_good _ _) H x y Hx).
  apply fixed_piece, segment_hull, Hy.
Qed.

(* A ray with one end: the end counts, and no direction of a leaf leads back. *)
Definition ray (start d : point) (t0 : R) (x : point) := exists t, t0 <= t /\ x = along start d t.

Fixpoint not_back (d : point) (t : tree) : Prop :=
  match t with
  | Leaf w => 0 <= dot w d
  | HalveA f s | HalveB f s => not_back d f /\ not_back d s
  | FinerA r | FinerB r => not_back d r
  end.

Lemma dot_along w start d t : dot w (along start d t) = dot w start + t * dot w d.
Proof. unfold dot; simpl; ring. Qed.

Lemma accepted_segment m A start d t0 t1 t : t0 <= t1 -> not_back d t -> forall a b,
  accepted m A (fixed [along start d t0]) t a b ->
  accepted m A (fixed [along start d t0; along start d t1]) t a b.
Proof.
  intros L; induction t as [w | f IHf s IHs | f IHf s IHs | r IH | r IH]; simpl not_back; intros N a b H.
  - intros p q P Q; apply in_flat_map in Q as [o [O Q]].
    assert (K : m * norm w < dot w (along start d t0) - dot w p).
    { apply H; [exact P |]; apply in_flat_map; exists o; split; [exact O | left; reflexivity]. }
    destruct Q as [<- | [<- | []]]; [exact K |].
    rewrite dot_along in *; pose proof (Rmult_le_compat_r _ _ _ N L); lra.
  - destruct H; split; [apply IHf | apply IHs]; tauto.
  - destruct H; split; [apply IHf | apply IHs]; tauto.
  - apply IH; assumption.
  - exact (IH N a (finer (fixed [along start d t0]) b) H).
Qed.

Theorem ray_sound m A t a start d t0 :
  all_good A a -> accepted m A (fixed [along start d t0]) t a [tt] -> not_back d t ->
  apart m (pieces A a) (ray start d t0).
Proof.
  intros G H N x y Hx [s [L ->]].
  apply (segment_sound m A t a start d t0 s G (accepted_segment m A start d t0 s t L N a [tt] H) x); [exact Hx |].
  exists s; split; [lra | reflexivity].
Qed.

(* The sets may change places. *)
Fixpoint mirror (t : tree) : tree :=
  match t with
  | Leaf w => Leaf (opposite w)
  | HalveA f s => HalveB (mirror f) (mirror s)
  | HalveB f s => HalveA (mirror f) (mirror s)
  | FinerA r => FinerB (mirror r)
  | FinerB r => FinerA (mirror r)
  end.

Lemma norm_opposite w : norm (opposite w) = norm w.
Proof. unfold norm; f_equal; unfold dot; simpl; ring. Qed.

Theorem mirrored m A B t : forall a b, accepted m A B t a b -> accepted m B A (mirror t) b a.
Proof.
  induction t as [w | f IHf s IHs | f IHf s IHs | r IH | r IH]; simpl; intros a b H; auto.
  - intros q p Q P; rewrite norm_opposite, !dot_opposite; specialize (H p q P Q); lra.
  - destruct H; auto.
  - destruct H; auto.
Qed.
