(* The leaf rule, and trees of it. *)
From Coq Require Import Reals Lra List.
From Snug Require Import Points.
Import ListNotations.
Open Scope R_scope.

Definition apart (m : R) (S T : point -> Prop) := forall x y, S x -> T y -> m < dist x y.

(* Two sets on the two sides of a slab are apart by more than its width. *)
Theorem slab_rule m w a b (S T : point -> Prop) :
  below w a S -> above w b T -> m * norm w < b - a -> apart m S T.
Proof.
  intros A B G x y Hx Hy; specialize (A x Hx); specialize (B y Hy).
  pose proof (cauchy_schwarz w (sub y x)) as CS; rewrite dot_sub in CS.
  change (norm (sub y x)) with (dist y x) in CS; rewrite dist_sym in CS.
  pose proof (norm_nonneg w) as N.
  destruct (Rlt_or_le m (dist x y)) as [H | H]; [exact H | exfalso].
  pose proof (Rmult_le_compat_l (norm w) _ _ N H); lra.
Qed.

(* The condition of a leaf: of two finite sets of points it makes a slab. *)
Definition leaf_condition (m : R) (w : point) (P Q : point -> Prop) :=
  forall p q, P p -> Q q -> m * norm w < dot w q - dot w p.

Lemma leaf_slab m w P Q : P <> [] -> Q <> [] -> leaf_condition m w (among P) (among Q) ->
  exists a b, below w a (among P) /\ above w b (among Q) /\ m * norm w < b - a.
Proof.
  intros NP NQ H.
  destruct (greatest w P NP) as [p [Hp A]], (least w Q NQ) as [q [Hq B]].
  exists (dot w p), (dot w q); repeat split; auto; apply H; assumption.
Qed.

(* The hull of no point is empty. *)
Lemma hull_nil x : ~ hull (among []) x.
Proof.
  intros [[| [a q] l] [A [B [C D]]]]; simpl in C; [lra |].
  exact (B a q (or_introl eq_refl)).
Qed.

Theorem leaf_rule m w P Q :
  leaf_condition m w (among P) (among Q) -> apart m (hull (among P)) (hull (among Q)).
Proof.
  intros H.
  destruct P as [| p P]; [intros x y Hx; destruct (hull_nil x Hx) |].
  destruct Q as [| q Q]; [intros x y _ Hy; destruct (hull_nil y Hy) |].
  destruct (leaf_slab m w (p :: P) (q :: Q)) as [a [b [A [B G]]]]; try easy.
  apply (slab_rule m w a b); auto using above_hull, below_hull.
Qed.

(* A kind of piece sets: names of sets of points. [covered s l] says that the sets named in l cover that of s. *)
Record kind := { name : Type; points : name -> point -> Prop }.

Definition covered (K : kind) (s : name K) (l : list (name K)) :=
  forall x, points K s x -> exists t, In t l /\ points K t x.

Inductive separation (m : R) (K L : kind) : name K -> name L -> Prop :=
| leaf s t w a b :
    below w a (points K s) -> above w b (points L t) -> m * norm w < b - a -> separation m K L s t
| nothing s t : covered K s [] \/ covered L t [] -> separation m K L s t
| divide_first s t parts :
    covered K s parts -> (forall c, In c parts -> separation m K L c t) -> separation m K L s t
| divide_second s t parts :
    covered L t parts -> (forall c, In c parts -> separation m K L s c) -> separation m K L s t.

Theorem separation_sound m K L s t : separation m K L s t -> apart m (points K s) (points L t).
Proof.
  induction 1 as [s t w a b A B G | s t [C | C] | s t parts C _ IH | s t parts C _ IH]; intros x y Hx Hy.
  - exact (slab_rule m w a b _ _ A B G x y Hx Hy).
  - destruct (C x Hx) as [? [[] _]].
  - destruct (C y Hy) as [? [[] _]].
  - destruct (C x Hx) as [c [Hc Hcx]]; exact (IH c Hc x y Hcx Hy).
  - destruct (C y Hy) as [c [Hc Hcy]]; exact (IH c Hc x y Hx Hcy).
Qed.

(* The leaf as certificates have it: sets that lie in the hulls of finitely many points. *)
Theorem leaf_of_hulls m K L s t w P Q :
  (forall x, points K s x -> hull (among P) x) -> (forall y, points L t y -> hull (among Q) y) ->
  leaf_condition m w (among P) (among Q) -> separation m K L s t.
Proof.
  intros HP HQ H.
  destruct P as [| p P]; [apply nothing; left; intros x Hx; destruct (hull_nil x (HP x Hx)) |].
  destruct Q as [| q Q]; [apply nothing; right; intros x Hx; destruct (hull_nil x (HQ x Hx)) |].
  destruct (leaf_slab m w (p :: P) (q :: Q)) as [a [b [A [B G]]]]; try easy.
  apply (leaf m K L s t w a b); [| | exact G].
  - intros x Hx; apply (below_hull w a _ A), HP, Hx.
  - intros x Hx; apply (above_hull w b _ B), HQ, Hx.
Qed.
