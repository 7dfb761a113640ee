(* Rules of creases, corners, boundaries and fractions of sharpness, on any mesh. Which rule applies where is not asked: any
   choice of them, at each vertex and level, has the hull property. *)
From Coq Require Import Reals Lra List Arith.
From Snug Require Import Points Vertices Mesh.
Import ListNotations.
Open Scope R_scope.

Section Rules.
Context {face : Type}.
Variable corners : face -> list vertex.

(* The masks of the scheme inside of smooth regions. *)
Variable smooth : list face -> vertex -> mask -> Prop.

Definition share_a_face (M : list face) (u v : vertex) := exists f, In f M /\ In u (corners f) /\ In v (corners f).

Inductive by_rule (M : list face) : vertex -> mask -> Prop :=
| smooth_rule v l : smooth M v l -> by_rule M v l
| corner v : by_rule M (Old v) [(1, v)]
| crease u v w : share_a_face M v u -> share_a_face M v w -> by_rule M (Old v) [(1/8, u); (6/8, v); (1/8, w)]
| middle u v : by_rule M (Edge u v) [(1/2, u); (1/2, v)]
| blend v t k l : 0 <= t <= 1 -> by_rule M v k -> by_rule M v l -> by_rule M v (times t k ++ times (1 - t) l).

Hypothesis smooth_mean : forall M v l, smooth M v l -> is_mean l.
Hypothesis smooth_around : forall M v l, smooth M v l -> around corners M v l.

Lemma in_times {X} a t (x : X) l : In (a, x) (times t l) -> exists b, In (b, x) l /\ a = t * b.
Proof. intros H; apply in_map_iff in H as [[b y] [E H]]; injection E as <- <-; eauto. Qed.

Lemma blend_mean t k l : 0 <= t <= 1 -> is_mean k -> is_mean l -> is_mean (times t k ++ times (1 - t) l).
Proof.
  intros T [K1 K2] [L1 L2]; split.
  - intros a x H; apply in_app_or in H as [H | H]; apply in_times in H as [b [H ->]];
      apply Rmult_le_pos; try lra; [exact (K1 b x H) | exact (L1 b x H)].
  - rewrite total_app, !total_times, K2, L2; ring.
Qed.

Theorem by_rule_mean M v l : by_rule M v l -> is_mean l.
Proof.
  induction 1 as [v l H | v | u v w _ _ | u v | v t k l T _ IHk _ IHl]; eauto using blend_mean;
    (split; [intros a x H; in_cases; injection H as <- <-; lra | simpl; lra]).
Qed.

Theorem by_rule_around M v l : by_rule M v l -> around corners M v l.
Proof.
  induction 1 as [v l H | v | u v w [f [F [Fv Fu]]] [g [G [Gv Gw]]] | u v | v t k l T _ IHk _ IHl]; auto.
  - intros a x H; in_cases; injection H as <- <-; simpl; auto.
  - intros a x H; in_cases; injection H as <- <-; simpl; auto; right; [exists f | exists g];
      (split; [assumption |]; split; [intros z [<- | []]; assumption | assumption]).
  - intros a x H; in_cases; injection H as <- <-; simpl; auto.
  - intros a x H; apply in_app_or in H as [H | H]; apply in_times in H as [b [H _]]; eauto.
Qed.
End Rules.
