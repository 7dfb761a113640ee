(* Vertices of refined meshes, and how often they occur. *)
From Coq Require Import List Arith Lia.
Import ListNotations.

(* The name of a new vertex says what it replaces: a vertex, an edge, or a face, by its corners. *)
Inductive vertex :=
| Control (n : nat)
| Old (v : vertex)
| Edge (u v : vertex)
| Face (corners : list vertex).

Section Induction.
Variable P : vertex -> Prop.
Hypothesis control : forall n, P (Control n).
Hypothesis old : forall v, P v -> P (Old v).
Hypothesis both : forall u v, P u -> P v -> P (Edge u v).
Hypothesis all : forall l, Forall P l -> P (Face l).

Fixpoint vertex_induction (v : vertex) : P v :=
  match v with
  | Control n => control n
  | Old u => old u (vertex_induction u)
  | Edge u w => both u w (vertex_induction u) (vertex_induction w)
  | Face l => all l ((fix go (l : list vertex) : Forall P l :=
      match l with [] => Forall_nil P | u :: r => Forall_cons u (vertex_induction u) (go r) end) l)
  end.
End Induction.

(* Some order, so that edges have no direction: Edge u v is written with the lesser vertex first. *)
Definition then_by (c d : comparison) := match c with Eq => d | _ => c end.

Section Lists.
Context {X : Type}.
Variable by_item : X -> X -> comparison.
Fixpoint order_lists (k l : list X) : comparison :=
  match k, l with
  | [], [] => Eq
  | [], _ => Lt
  | _, [] => Gt
  | x :: k, y :: l => then_by (by_item x y) (order_lists k l)
  end.
End Lists.

Fixpoint order (u v : vertex) : comparison :=
  match u, v with
  | Control m, Control n => Nat.compare m n
  | Control _, _ => Lt
  | Old _, Control _ => Gt
  | Old a, Old b => order a b
  | Old _, _ => Lt
  | Edge a b, Edge c d => then_by (order a c) (order b d)
  | Edge _ _, Face _ => Lt
  | Edge _ _, _ => Gt
  | Face k, Face l => order_lists order k l
  | Face _, _ => Gt
  end.

Lemma then_by_eq c d : then_by c d = Eq -> c = Eq /\ d = Eq.
Proof. destruct c, d; simpl; intuition discriminate. Qed.

Lemma then_by_opp c d : then_by (CompOpp c) (CompOpp d) = CompOpp (then_by c d).
Proof. destruct c, d; reflexivity. Qed.

Lemma order_eq u : forall v, order u v = Eq -> u = v.
Proof.
  induction u as [m | u IH | a b IHa IHb | k IH] using vertex_induction; intros [n | v | e f | l];
    simpl; intros H; try discriminate.
  - apply Nat.compare_eq in H; congruence.
  - f_equal; auto.
  - apply then_by_eq in H as [H1 H2]; f_equal; auto.
  - f_equal; revert l H; induction IH as [| u k U _ IH]; intros [| v l] H; try discriminate; [reflexivity |].
    apply then_by_eq in H as [H1 H2]; f_equal; auto.
Qed.

Lemma order_opp u : forall v, order v u = CompOpp (order u v).
Proof.
  induction u as [m | u IH | a b IHa IHb | k IH] using vertex_induction; intros [n | v | e f | l];
    simpl; auto.
  - apply Nat.compare_antisym.
  - rewrite IHa, IHb; apply then_by_opp.
  - revert l; induction IH as [| u k U _ IH]; intros [| v l]; simpl; auto.
    rewrite U, IH; apply then_by_opp.
Qed.

Definition vertex_dec (u v : vertex) : {u = v} + {u <> v}.
Proof.
  destruct (order u v) eqn:E; [left; apply order_eq, E | right | right]; intros ->;
    pose proof (order_opp v v) as H; rewrite E in H; discriminate.
Defined.

Definition edge (u v : vertex) := match order u v with Gt => Edge v u | _ => Edge u v end.

Lemma edge_sym u v : edge u v = edge v u.
Proof.
  unfold edge; rewrite (order_opp u v); destruct (order u v) eqn:E; simpl; auto.
  apply order_eq in E; congruence.
Qed.

Lemma edge_shape u v : edge u v = Edge u v \/ edge u v = Edge v u.
Proof. unfold edge; destruct (order u v); auto. Qed.

Lemma edge_injective u v x y : edge u v = edge x y -> (u = x /\ v = y) \/ (u = y /\ v = x).
Proof.
  intros H; destruct (edge_shape u v) as [E | E], (edge_shape x y) as [F | F]; rewrite E, F in H;
    injection H; auto.
Qed.

Lemma edge_not_old u v x : edge u v <> Old x.
Proof. destruct (edge_shape u v) as [-> | ->]; discriminate. Qed.

Lemma edge_not_face u v l : edge u v <> Face l.
Proof. destruct (edge_shape u v) as [-> | ->]; discriminate. Qed.

(* The old vertices that a new one belongs to. *)
Definition parents (v : vertex) : list vertex :=
  match v with
  | Control _ => []
  | Old u => [u]
  | Edge u w => [u; w]
  | Face l => l
  end.

Lemma parents_edge u v x : In x (parents (edge u v)) <-> x = u \/ x = v.
Proof. destruct (edge_shape u v) as [-> | ->]; simpl; intuition auto. Qed.

(* How often an element occurs. *)
Definition one_if (u v : vertex) : nat := if vertex_dec u v then 1 else 0.

Fixpoint count (l : list vertex) (v : vertex) : nat :=
  match l with [] => 0 | u :: r => (one_if u v + count r v) end.

Lemma one_if_same v : one_if v v = 1.
Proof. unfold one_if; destruct (vertex_dec v v); congruence. Qed.

Lemma one_if_other u v : u <> v -> one_if u v = 0.
Proof. unfold one_if; destruct (vertex_dec u v); congruence. Qed.

Lemma count_app l r v : count (l ++ r) v = (count l v + count r v).
Proof. induction l as [| u l IH]; simpl; lia. Qed.

Lemma count_not_in l v : ~ In v l -> count l v = 0.
Proof.
  induction l as [| u l IH]; simpl; intros H; [reflexivity |].
  rewrite one_if_other, IH; intuition auto.
Qed.

Fixpoint sum {X} (h : X -> nat) (l : list X) : nat :=
  match l with [] => 0 | x :: r => (h x + sum h r) end.

Lemma count_flat_map {X} (h : X -> list vertex) l v : count (flat_map h l) v = sum (fun x => count (h x) v) l.
Proof. induction l as [| x l IH]; simpl; [reflexivity |]; rewrite count_app, IH; reflexivity. Qed.

Lemma sum_same {X} (g h : X -> nat) l : (forall x, In x l -> g x = h x) -> sum g l = sum h l.
Proof. induction l as [| x l IH]; simpl; intros H; [reflexivity |]; rewrite H, IH; auto. Qed.

Lemma sum_le {X} (g h : X -> nat) l : (forall x, In x l -> (g x <= h x)) -> (sum g l <= sum h l).
Proof.
  induction l as [| x l IH]; simpl; intros H; [lia |].
  pose proof (H x (or_introl eq_refl)); specialize (IH (fun y Hy => H y (or_intror Hy))); lia.
Qed.

Lemma sum_zero {X} (h : X -> nat) l : (forall x, In x l -> h x = 0) -> sum h l = 0.
Proof. induction l as [| x l IH]; simpl; intros H; [reflexivity |]; rewrite H, IH; auto. Qed.

Lemma sum_only {X} (h : X -> nat) l x :
  NoDup l -> In x l -> (forall y, In y l -> y <> x -> h y = 0) -> sum h l = h x.
Proof.
  induction l as [| y l IH]; intros N I H; [destruct I |].
  inversion N as [| ? ? Ny Nl]; subst; simpl; destruct I as [-> | I].
  - rewrite sum_zero; [lia |].
    intros z Hz; apply H; [right; exact Hz | intros ->; exact (Ny Hz)].
  - rewrite (H y), IH; auto.
    + intros z Hz; apply H; right; exact Hz.
    + left; reflexivity.
    + intros ->; exact (Ny I).
Qed.

Lemma NoDup_flat_map {X Y} (h : X -> list Y) l :
  NoDup l -> (forall x, In x l -> NoDup (h x)) ->
  (forall x y z, In x l -> In y l -> In z (h x) -> In z (h y) -> x = y) -> NoDup (flat_map h l).
Proof.
  induction l as [| x l IH]; intros N H D; simpl; [constructor |].
  inversion N as [| ? ? Nx Nl]; subst.
  assert (A : NoDup (h x)) by (apply H; left; reflexivity).
  assert (B : NoDup (flat_map h l)).
  { apply IH; auto; [intros; apply H; right; assumption |].
    intros a b c Ha Hb; apply D; right; assumption. }
  assert (E : forall z, In z (h x) -> ~ In z (flat_map h l)).
  { intros z Hz Hf; apply in_flat_map in Hf as [y [Hy Hzy]].
    assert (x = y) by (apply (D x y z); simpl; auto); subst; exact (Nx Hy). }
  clear -A B E; induction (h x) as [| z r IH]; simpl; [exact B |].
  inversion A as [| ? ? Nz Nr]; subst; constructor.
  - intros Hz; apply in_app_or in Hz as [Hz | Hz]; [exact (Nz Hz) |].
    exact (E z (or_introl eq_refl) Hz).
  - apply IH; [exact Nr |]; intros y Hy; apply E; right; exact Hy.
Qed.

Lemma flat_map_flat_map {X Y Z} (g : Y -> list Z) (h : X -> list Y) l :
  flat_map g (flat_map h l) = flat_map (fun x => flat_map g (h x)) l.
Proof. induction l as [| x l IH]; simpl; [reflexivity |]; rewrite flat_map_app, IH; reflexivity. Qed.

(* Halves of edges. *)
Definition half_edge (v e : vertex) := edge (Old v) e.
Lemma half_edge_injective v x y w p q :
  half_edge v (edge x y) = half_edge w (edge p q) -> v = w /\ edge x y = edge p q.
Proof.
  unfold half_edge; intros H; apply edge_injective in H as [[A B] | [A B]]; [injection A; auto |].
  symmetry in A; destruct (edge_not_old _ _ _ A).
Qed.

Lemma two_halves p q x y : p <> q -> x <> y ->
  (one_if (half_edge p (edge p q)) (half_edge x (edge x y))
   + one_if (half_edge q (edge p q)) (half_edge x (edge x y))) = one_if (edge p q) (edge x y).
Proof.
  intros N N'; unfold one_if at 3; destruct (vertex_dec (edge p q) (edge x y)) as [E | E].
  - rewrite E; apply edge_injective in E as [[<- <-] | [<- <-]].
    + rewrite one_if_same, one_if_other; [reflexivity |].
      intros H; apply half_edge_injective in H as [H _]; congruence.
    + rewrite one_if_other, one_if_same; [reflexivity |].
      intros H; apply half_edge_injective in H as [H _]; congruence.
  - rewrite !one_if_other; [reflexivity | |]; intros H; apply half_edge_injective in H as [_ H]; congruence.
Qed.

(* Tactics for finite cases. *)
Ltac in_cases :=
  repeat match goal with
  | H : In _ (_ :: _) |- _ => destruct H as [H | H]
  | H : In _ [] |- _ => destruct H
  | H : _ \/ _ |- _ => destruct H as [H | H]
  | H : False |- _ => destruct H
  end.

Ltac all_parents :=
  repeat match goal with H : context [parents (edge _ _)] |- _ => rewrite parents_edge in H end;
  simpl in *; in_cases; subst; auto 10.

Lemma edge_parents u v x y : edge u v = Edge x y -> forall z, In z [x; y] <-> z = u \/ z = v.
Proof. intros E z; rewrite <- (parents_edge u v z), E; reflexivity. Qed.

Ltac distinct :=
  repeat match goal with
  | H : NoDup (_ :: _) |- _ => inversion H; clear H; subst
  | H : NoDup [] |- _ => clear H
  | H : ~ In _ (_ :: _) |- _ => apply not_in_cons in H as [? H]
  | H : ~ In _ [] |- _ => clear H
  end.

Ltac edge_cases :=
  repeat match goal with
  | H : edge _ _ = edge _ _ |- _ => apply edge_injective in H as [[? ?] | [? ?]]
  | H : Old _ = edge _ _ |- _ => symmetry in H; exfalso; exact (edge_not_old _ _ _ H)
  | H : edge _ _ = Old _ |- _ => exfalso; exact (edge_not_old _ _ _ H)
  | H : Face _ = edge _ _ |- _ => symmetry in H; exfalso; exact (edge_not_face _ _ _ H)
  | H : edge _ _ = Face _ |- _ => exfalso; exact (edge_not_face _ _ _ H)
  | H : Old _ = Old _ |- _ => injection H as H
  | H : Face _ = Old _ |- _ => discriminate H
  | H : Old _ = Face _ |- _ => discriminate H
  end; try congruence.
