(* Owners, their rings and children; limits; the trees of certificates. *)
From Coq Require Import Reals Lra List Arith.
From Snug Require Import Points Separation.
Import ListNotations.
Open Scope R_scope.

(* What a proof needs to know of subdivision: each point of the ring of a child is a mean of points of the ring of its
   owner. [good] holds of the owners that exist. *)
Record surface := {
  owner : Type;
  good : owner -> Prop;
  ring : owner -> list point;
  children : owner -> list owner;
  children_good : forall o c, good o -> In c (children o) -> good c;
  locality : forall o c, good o -> In c (children o) -> forall p, In p (ring c) -> hull (among (ring o)) p
}.

Section Hulls.
Variable S : surface.

(* [descends n o d]: d stems from o by n steps. *)
Inductive descends : nat -> owner S -> owner S -> Prop :=
| descends_self o : descends 0 o o
| descends_step n o c d : In c (children S o) -> descends n c d -> descends (Datatypes.S n) o d.

Theorem ring_of_descendant n o d :
  good S o -> descends n o d -> forall p, hull (among (ring S d)) p -> hull (among (ring S o)) p.
Proof.
  intros G D; induction D as [o | n o c d C D IH]; intros p Hp; [exact Hp |].
  apply hull_hull.
  apply (hull_mono (among (ring S c))).
  - intros q Hq; exact (locality S o c G C q Hq).
  - apply IH; [exact (children_good S o c G C) | exact Hp].
Qed.

(* The piece of an owner: the limits along lines of descendants. *)
Definition line (o : owner S) (path : nat -> owner S) :=
  path O = o /\ forall k, In (path (Datatypes.S k)) (children S (path k)).

Definition piece (o : owner S) (x : point) :=
  exists path s, line o path /\ (forall k, hull (among (ring S (path k))) (s k)) /\ tends_to s x.

Lemma line_descends o path k : line o path -> descends k o (path k).
Proof.
  revert o path; induction k as [| k IH]; intros o path [<- H]; [constructor |].
  apply (descends_step k _ (path 1%nat)); [apply H |].
  apply (IH (path 1%nat) (fun k => path (Datatypes.S k))); split; [reflexivity |].
  intro j; apply H.
Qed.

(* The hull property, of all levels and of limits. *)
Theorem points_above o w c :
  good S o -> above w c (among (ring S o)) -> forall n d, descends n o d -> above w c (among (ring S d)).
Proof.
  intros G A n d D x Hx.
  apply (above_hull w c _ A), (ring_of_descendant n o d G D), hull_in, Hx.
Qed.

Theorem limits_above o w c : good S o -> above w c (among (ring S o)) -> above w c (piece o).
Proof.
  intros G A x [path [s [L [Hs T]]]].
  apply (above_limit w c s x); [intro k | exact T].
  apply (above_hull w c _ A), (ring_of_descendant k o (path k) G (line_descends _ _ _ L)), Hs.
Qed.

Theorem limits_below o w c : good S o -> below w c (among (ring S o)) -> below w c (piece o).
Proof. rewrite !below_above; apply limits_above. Qed.

(* Covering: the piece of an owner is the union of the pieces of its children. *)
Theorem piece_children o x : piece o x -> exists c, In c (children S o) /\ piece c x.
Proof.
  intros [path [s [[E H] [Hs T]]]]; exists (path 1%nat); split.
  - rewrite <- E; apply H.
  - exists (fun k => path (Datatypes.S k)), (fun k => s (Datatypes.S k)); split; [split; auto |].
    split; [intro k; apply Hs |].
    intros eps He; destruct (T eps He) as [n Hn]; exists n; intros k Hk; apply Hn; auto.
Qed.

Theorem children_piece o c x : good S o -> In c (children S o) -> piece c x -> piece o x.
Proof.
  intros G C [path [s [[E H] [Hs T]]]].
  exists (fun k => match k with O => o | Datatypes.S j => path j end).
  exists (fun k => match k with O => s O | Datatypes.S j => s j end).
  split; [| split].
  - split; [reflexivity |]; intros [| k]; [rewrite E; exact C | apply H].
  - intros [| k]; [| apply Hs].
    apply (ring_of_descendant 1 o c G).
    + econstructor; [exact C | constructor].
    + rewrite <- E; apply Hs.
  - intros eps He; destruct (T eps He) as [n Hn]; exists (Datatypes.S n).
    intros [| k] Hk; [inversion Hk | apply Hn; auto using le_S_n].
Qed.

(* Sets of pieces, as certificates name them: lists of owners. *)
Definition pieces (l : list (owner S)) (x : point) := exists o, In o l /\ piece o x.

Definition rings (l : list (owner S)) : list point := flat_map (ring S) l.

Definition all_good (l : list (owner S)) := forall o, In o l -> good S o.

Definition finer (l : list (owner S)) := flat_map (children S) l.
Definition half (l : list (owner S)) := Nat.div2 (length l).
Definition first_half l := firstn (half l) l.
Definition second_half l := skipn (half l) l.

Lemma finer_good l : all_good l -> all_good (finer l).
Proof.
  intros G c Hc; apply in_flat_map in Hc as [o [Ho Hc]]; exact (children_good S o c (G o Ho) Hc).
Qed.

Lemma halves l o : In o l <-> In o (first_half l) \/ In o (second_half l).
Proof. rewrite <- in_app_iff; unfold first_half, second_half; rewrite firstn_skipn; reflexivity. Qed.

Lemma first_half_good l : all_good l -> all_good (first_half l).
Proof. intros G o Ho; apply G, halves; auto. Qed.

Lemma second_half_good l : all_good l -> all_good (second_half l).
Proof. intros G o Ho; apply G, halves; auto. Qed.

Lemma pieces_finer l x : pieces l x -> pieces (finer l) x.
Proof.
  intros [o [Ho Hx]]; destruct (piece_children o x Hx) as [c [Hc Hcx]].
  exists c; split; [apply in_flat_map; exists o; auto | exact Hcx].
Qed.

Lemma pieces_halves l x : pieces l x -> pieces (first_half l) x \/ pieces (second_half l) x.
Proof. intros [o [Ho Hx]]; apply halves in Ho as [Ho | Ho]; [left | right]; exists o; auto. Qed.

Lemma pieces_above l w c : all_good l -> above w c (among (rings l)) -> above w c (pieces l).
Proof.
  intros G A x [o [Ho Hx]]; apply (limits_above o w c (G o Ho)); [| exact Hx].
  intros p Hp; apply A, in_flat_map; exists o; auto.
Qed.

Lemma pieces_below l w c : all_good l -> below w c (among (rings l)) -> below w c (pieces l).
Proof. rewrite !below_above; apply pieces_above. Qed.

(* Lists that name no point name nothing. *)
Lemma no_rings l : all_good l -> rings l = [] -> forall x, ~ pieces l x.
Proof.
  intros G E x [o [Ho [path [s [L [Hs _]]]]]].
  apply (hull_nil (s O)); rewrite <- E.
  apply (hull_mono (among (ring S (path O)))); [| apply Hs].
  destruct L as [-> _]; intros p Hp; apply in_flat_map; exists o; auto.
Qed.

Definition lists : kind := {| name := list (owner S); points := pieces |}.

End Hulls.

(* Trees, as certificates write them: A and B halve, a and b make finer, a direction is a leaf. *)
Inductive tree :=
| Leaf (w : point)
| HalveA (first second : tree)
| HalveB (first second : tree)
| FinerA (rest : tree)
| FinerB (rest : tree).

Section Trees.
Variables (m : R) (A B : surface).

(* The checker accepts the tree. *)
Fixpoint accepted (t : tree) (a : list (owner A)) (b : list (owner B)) : Prop :=
  match t with
  | Leaf w => leaf_condition m w (among (rings A a)) (among (rings B b))
  | HalveA f s => accepted f (first_half A a) b /\ accepted s (second_half A a) b
  | HalveB f s => accepted f a (first_half B b) /\ accepted s a (second_half B b)
  | FinerA r => accepted r (finer A a) b
  | FinerB r => accepted r a (finer B b)
  end.

Lemma accepted_separation t : forall a b,
  all_good A a -> all_good B b -> accepted t a b -> separation m (lists A) (lists B) a b.
Proof.
  induction t as [w | f IHf s IHs | f IHf s IHs | r IH | r IH]; simpl; intros a b GA GB H.
  - destruct (rings A a) as [| p P] eqn:EA.
    { apply nothing; left; intros x Hx; destruct (no_rings A a GA EA x Hx). }
    destruct (rings B b) as [| q Q] eqn:EB.
    { apply nothing; right; intros x Hx; destruct (no_rings B b GB EB x Hx). }
    destruct (leaf_slab m w (p :: P) (q :: Q)) as [c [d [C [D G]]]]; try easy.
    apply (leaf m (lists A) (lists B) a b w c d); [| | exact G].
    + apply pieces_below; [exact GA | rewrite EA; exact C].
    + apply pieces_above; [exact GB | rewrite EB; exact D].
  - apply divide_first with (parts := [first_half A a; second_half A a]).
    + intros x Hx; destruct (pieces_halves A a x Hx); eexists; simpl; eauto.
    + intros c [<- | [<- | []]]; [apply IHf | apply IHs]; auto using first_half_good, second_half_good; tauto.
  - apply divide_second with (parts := [first_half B b; second_half B b]).
    + intros x Hx; destruct (pieces_halves B b x Hx); eexists; simpl; eauto.
    + intros c [<- | [<- | []]]; [apply IHf | apply IHs]; auto using first_half_good, second_half_good; tauto.
  - apply divide_first with (parts := [finer A a]).
    + intros x Hx; exists (finer A a); split; [left; reflexivity | apply pieces_finer, Hx].
    + intros c [<- | []]; apply IH; auto using finer_good.
  - apply divide_second with (parts := [finer B b]).
    + intros x Hx; exists (finer B b); split; [left; reflexivity | apply pieces_finer, Hx].
    + intros c [<- | []]; apply IH; auto using finer_good.
Qed.

Theorem accepted_apart t a b :
  all_good A a -> all_good B b -> accepted t a b -> apart m (pieces A a) (pieces B b).
Proof.
  intros GA GB H; exact (separation_sound m (lists A) (lists B) a b (accepted_separation t a b GA GB H)).
Qed.

End Trees.
