(* Points of R^3, weighted means, half-spaces, limits. *)
From Coq Require Import Reals Lra List.
Import ListNotations.
Open Scope R_scope.

Record point := pt { px : R; py : R; pz : R }.

Definition add (p q : point) := pt (px p + px q) (py p + py q) (pz p + pz q).
Definition sub (p q : point) := pt (px p - px q) (py p - py q) (pz p - pz q).
Definition scale (a : R) (p : point) := pt (a * px p) (a * py p) (a * pz p).
Definition origin := pt 0 0 0.
Definition dot (p q : point) := px p * px q + py p * py q + pz p * pz q.
Definition norm (p : point) := sqrt (dot p p).
Definition dist (p q : point) := norm (sub p q).

Lemma point_eq p q : px p = px q -> py p = py q -> pz p = pz q -> p = q.
Proof. destruct p, q; simpl; intros; subst; reflexivity. Qed.

Ltac by_coordinates := apply point_eq; simpl; ring.

Lemma dot_self p : 0 <= dot p p.
Proof. unfold dot; nra. Qed.

Lemma norm_nonneg p : 0 <= norm p.
Proof. apply sqrt_pos. Qed.

Lemma norm_squared p : norm p * norm p = dot p p.
Proof. apply sqrt_sqrt, dot_self. Qed.

Lemma dist_nonneg p q : 0 <= dist p q.
Proof. apply norm_nonneg. Qed.

Lemma dist_sym p q : dist p q = dist q p.
Proof. unfold dist, norm; f_equal; unfold dot, sub; simpl; ring. Qed.

Lemma dot_sub w p q : dot w (sub p q) = dot w p - dot w q.
Proof. unfold dot, sub; simpl; ring. Qed.

Lemma cauchy_schwarz_squared p q : dot p q * dot p q <= dot p p * dot q q.
Proof.
  destruct p as [a b c], q as [d e f]; unfold dot; simpl.
  pose proof (Rle_0_sqr (a * e - b * d)).
  pose proof (Rle_0_sqr (b * f - c * e)).
  pose proof (Rle_0_sqr (c * d - a * f)).
  unfold Rsqr in *; lra.
Qed.

Lemma cauchy_schwarz p q : dot p q <= norm p * norm q.
Proof.
  destruct (Rle_or_lt (dot p q) 0) as [H | H].
  - pose proof (Rmult_le_pos _ _ (norm_nonneg p) (norm_nonneg q)); lra.
  - unfold norm; rewrite <- sqrt_mult by apply dot_self.
    rewrite <- (sqrt_square (dot p q)) by lra.
    apply sqrt_le_1_alt, cauchy_schwarz_squared.
Qed.

(* Weighted means. [combine l] is the sum of the weights times the points. *)

Fixpoint total {X} (l : list (R * X)) : R :=
  match l with [] => 0 | (a, _) :: r => a + total r end.

Fixpoint combine (l : list (R * point)) : point :=
  match l with [] => origin | (a, p) :: r => add (scale a p) (combine r) end.

Definition nonnegative {X} (l : list (R * X)) := forall a x, In (a, x) l -> 0 <= a.

(* The convex hull of a set: all its finite means. *)
Definition hull (S : point -> Prop) (p : point) : Prop :=
  exists l, nonnegative l /\ (forall a q, In (a, q) l -> S q) /\ total l = 1 /\ p = combine l.

Definition among (l : list point) : point -> Prop := fun p => In p l.

Lemma total_app {X} (l r : list (R * X)) : total (l ++ r) = total l + total r.
Proof. induction l as [| [a p] l IH]; simpl; [| rewrite IH]; ring. Qed.

Lemma combine_app l r : combine (l ++ r) = add (combine l) (combine r).
Proof. induction l as [| [a p] l IH]; simpl; [| rewrite IH]; by_coordinates. Qed.

Definition times {X} (a : R) (l : list (R * X)) := map (fun t => (a * fst t, snd t)) l.

Lemma total_times {X} a (l : list (R * X)) : total (times a l) = a * total l.
Proof. induction l as [| [b p] l IH]; simpl; [| rewrite IH]; ring. Qed.

Lemma combine_times a l : combine (times a l) = scale a (combine l).
Proof. induction l as [| [b p] l IH]; simpl; [| rewrite IH]; by_coordinates. Qed.

Lemma hull_in (S : point -> Prop) p : S p -> hull S p.
Proof.
  intros H; exists [(1, p)]; repeat split.
  - intros a x [E | []]; injection E as <- <-; lra.
  - intros a x [E | []]; injection E as <- <-; exact H.
  - simpl; ring.
  - simpl; by_coordinates.
Qed.

Lemma hull_mono (S T : point -> Prop) p : (forall q, S q -> T q) -> hull S p -> hull T p.
Proof. intros H [l [A [B C]]]; exists l; split; [exact A |]; split; [eauto | exact C]. Qed.

Lemma flatten (S : point -> Prop) l :
  nonnegative l -> (forall a q, In (a, q) l -> hull S q) ->
  exists k, nonnegative k /\ (forall a q, In (a, q) k -> S q)
            /\ total k = total l /\ combine k = combine l.
Proof.
  intros A B; induction l as [| [a q] l IH].
  - exists []; repeat split; intros ? ? [].
  - destruct IH as [k [K1 [K2 [K3 K4]]]].
    { intros b x Hx; apply (A b x); right; exact Hx. }
    { intros b x Hx; apply (B b x); right; exact Hx. }
    destruct (B a q (or_introl eq_refl)) as [j [J1 [J2 [J3 J4]]]].
    assert (Ha : 0 <= a) by (apply (A a q); left; reflexivity).
    exists (times a j ++ k); split; [| split; [| split]].
    + intros b x Hx; apply in_app_or in Hx as [Hx | Hx]; [| eapply K1; exact Hx].
      apply in_map_iff in Hx as [[c y] [E Hy]]; injection E as <- <-; simpl.
      apply Rmult_le_pos; [exact Ha | exact (J1 c y Hy)].
    + intros b x Hx; apply in_app_or in Hx as [Hx | Hx]; [| eapply K2; exact Hx].
      apply in_map_iff in Hx as [[c y] [E Hy]]; injection E as <- <-; exact (J2 c y Hy).
    + rewrite total_app, total_times, J3, K3; simpl; ring.
    + rewrite combine_app, combine_times, <- J4, K4; reflexivity.
Qed.

(* Means of means are means. *)
Lemma hull_hull (S : point -> Prop) p : hull (hull S) p -> hull S p.
Proof.
  intros [l [A [B [C D]]]]; destruct (flatten S l A B) as [k [K1 [K2 [K3 K4]]]].
  exists k; repeat split; auto; congruence.
Qed.

(* Half-spaces. A set lies [above w c] if w.x >= c on it, [below w c] if w.x <= c. *)

Definition above (w : point) (c : R) (S : point -> Prop) := forall x, S x -> c <= dot w x.
Definition below (w : point) (c : R) (S : point -> Prop) := forall x, S x -> dot w x <= c.

Lemma above_combine w c (l : list (R * point)) :
  nonnegative l -> (forall a q, In (a, q) l -> c <= dot w q) -> c * total l <= dot w (combine l).
Proof.
  induction l as [| [a p] l IH]; intros A B.
  - unfold dot; simpl; lra.
  - assert (H : c * total l <= dot w (combine l)).
    { apply IH; intros b x Hx; [apply (A b x) | apply (B b x)]; right; exact Hx. }
    pose proof (Rmult_le_compat_l a _ _ (A a p (or_introl eq_refl)) (B a p (or_introl eq_refl))).
    unfold dot in *; simpl in *; lra.
Qed.

Lemma above_hull w c S : above w c S -> above w c (hull S).
Proof.
  intros H x [l [A [B [C ->]]]].
  rewrite <- (Rmult_1_r c), <- C; apply above_combine; eauto.
Qed.

Definition opposite (w : point) := scale (-1) w.

Lemma dot_opposite w x : dot (opposite w) x = - dot w x.
Proof. unfold dot; simpl; ring. Qed.

Lemma below_above w c S : below w c S <-> above (opposite w) (- c) S.
Proof. split; intros H x Hx; specialize (H x Hx); rewrite dot_opposite in *; lra. Qed.

Lemma below_hull w c S : below w c S -> below w c (hull S).
Proof. rewrite !below_above; apply above_hull. Qed.

(* Limits. Half-spaces are closed, which is all that is needed of hulls. *)

Definition tends_to (s : nat -> point) (x : point) :=
  forall eps, 0 < eps -> exists n, forall k, (n <= k)%nat -> dist (s k) x < eps.

Lemma above_limit w c (s : nat -> point) x :
  (forall k, c <= dot w (s k)) -> tends_to s x -> c <= dot w x.
Proof.
  intros A L; destruct (Rle_or_lt c (dot w x)) as [H | H]; [exact H | exfalso].
  pose proof (norm_nonneg w) as N.
  destruct (L ((c - dot w x) / (norm w + 1))) as [n Hn].
  { apply Rdiv_lt_0_compat; lra. }
  specialize (Hn n (le_n n)); specialize (A n).
  pose proof (cauchy_schwarz w (sub (s n) x)) as CS; rewrite dot_sub in CS.
  change (norm (sub (s n) x)) with (dist (s n) x) in CS.
  pose proof (dist_nonneg (s n) x) as D.
  assert (E : (c - dot w x) / (norm w + 1) * (norm w + 1) = c - dot w x) by (field; lra).
  set (e := (c - dot w x) / (norm w + 1)) in *.
  nra.
Qed.

Lemma below_limit w c (s : nat -> point) x :
  (forall k, dot w (s k) <= c) -> tends_to s x -> dot w x <= c.
Proof.
  intros A L.
  assert (H : - c <= dot (opposite w) x).
  { apply (above_limit _ _ s); [| exact L].
    intro k; rewrite dot_opposite; specialize (A k); lra. }
  rewrite dot_opposite in H; lra.
Qed.

(* A finite set has a least value of a linear form. *)
Lemma least w (l : list point) : l <> [] -> exists q, In q l /\ above w (dot w q) (among l).
Proof.
  induction l as [| p l IH]; intros N; [contradiction |].
  destruct l as [| p' l'].
  - exists p; split; [left; reflexivity |]; intros x [<- | []]; lra.
  - destruct IH as [q [Hq Aq]]; [discriminate |].
    destruct (Rle_or_lt (dot w p) (dot w q)) as [H | H].
    + exists p; split; [left; reflexivity |].
      intros x [<- | Hx]; [lra |]; specialize (Aq x Hx); lra.
    + exists q; split; [right; exact Hq |].
      intros x [<- | Hx]; [lra |]; exact (Aq x Hx).
Qed.

Lemma greatest w (l : list point) : l <> [] -> exists q, In q l /\ below w (dot w q) (among l).
Proof.
  intros N; destruct (least (opposite w) l N) as [q [Hq Aq]]; exists q; split; [exact Hq |].
  rewrite below_above, <- dot_opposite; exact Aq.
Qed.
