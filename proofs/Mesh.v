(* Rings, schemes on closed meshes, and the surfaces that they make. *)
From Coq Require Import Reals Lra List Arith.
From Snug Require Import Points Separation Subdivision Vertices.
Import ListNotations.
Open Scope R_scope.

(* Rings: all vertices of all faces that have a vertex in common with a face. *)
Section Rings.
Context {face : Type}.
Variable corners : face -> list vertex.

Definition is_in (v : vertex) (l : list vertex) : bool := if in_dec vertex_dec v l then true else false.

Definition meets (f g : face) : bool := existsb (fun v => is_in v (corners g)) (corners f).

Definition vertices_near (M : list face) (f : face) : list vertex := flat_map corners (filter (meets f) M).

Lemma meets_spec f g : meets f g = true <-> exists v, In v (corners f) /\ In v (corners g).
Proof.
  unfold meets, is_in; rewrite existsb_exists; split; intros [v [A B]]; exists v; split; auto;
    destruct (in_dec vertex_dec v (corners g)); congruence.
Qed.

Lemma near_spec M f u :
  In u (vertices_near M f) <->
  exists g x, In g M /\ In x (corners f) /\ In x (corners g) /\ In u (corners g).
Proof.
  unfold vertices_near; rewrite in_flat_map; split.
  - intros [g [G U]]; apply filter_In in G as [G T]; apply meets_spec in T as [x [A B]].
    exists g, x; auto.
  - intros [g [x [G [A [B U]]]]]; exists g; split; [| exact U].
    apply filter_In; split; [exact G |]; apply meets_spec; exists x; auto.
Qed.
End Rings.

Definition mask := list (R * vertex).

Definition is_mean (l : mask) := nonnegative l /\ total l = 1.

Definition apply_mask (position : vertex -> point) (l : mask) : point :=
  combine (map (fun t => (fst t, position (snd t))) l).

Lemma apply_mask_hull position l (S : vertex -> Prop) :
  is_mean l -> (forall a u, In (a, u) l -> S u) ->
  hull (fun p => exists u, S u /\ p = position u) (apply_mask position l).
Proof.
  intros [A B] H; exists (map (fun t => (fst t, position (snd t))) l); repeat split.
  - intros a x Hx; apply in_map_iff in Hx as [[b u] [E Hu]]; injection E as <- <-; exact (A b u Hu).
  - intros a x Hx; apply in_map_iff in Hx as [[b u] [E Hu]]; injection E as <- <-.
    exists u; split; [exact (H b u Hu) | reflexivity].
  - rewrite <- B; clear; induction l as [| [a u] l IH]; simpl; [reflexivity |]; rewrite IH; reflexivity.
Qed.

(* What subdivision makes, level by level: owners with their children and rings, and masks of new vertices. Masks of vertices
   in the ring of a child are means of vertices in the ring of its owner. *)
Record hierarchy := {
  part : Type;
  exists_at : nat -> part -> Prop;
  parts_at : nat -> part -> list part;
  near_at : nat -> part -> list vertex;
  masks_at : nat -> vertex -> mask;
  parts_exist : forall k o c, exists_at k o -> In c (parts_at k o) -> exists_at (S k) c;
  masks_near : forall k o c v, exists_at k o -> In c (parts_at k o) -> In v (near_at (S k) c) ->
    is_mean (masks_at k v) /\ forall a u, In (a, u) (masks_at k v) -> In u (near_at k o)
}.

Section Surface.
Variable H : hierarchy.
Variable position : vertex -> point.

Fixpoint place (k : nat) : vertex -> point :=
  match k with
  | O => position
  | S j => fun v => apply_mask (place j) (masks_at H j v)
  end.

Definition ring_points (o : nat * part H) := map (place (fst o)) (near_at H (fst o) (snd o)).
Definition existing (o : nat * part H) := exists_at H (fst o) (snd o).
Definition parts_of (o : nat * part H) := map (pair (S (fst o))) (parts_at H (fst o) (snd o)).

Lemma parts_existing o c : existing o -> In c (parts_of o) -> existing c.
Proof.
  intros G C; apply in_map_iff in C as [d [<- C]]; exact (parts_exist H (fst o) (snd o) d G C).
Qed.

Lemma parts_local o c :
  existing o -> In c (parts_of o) -> forall p, In p (ring_points c) -> hull (among (ring_points o)) p.
Proof.
  destruct o as [k o]; intros G C p P.
  apply in_map_iff in C as [d [<- C]]; unfold ring_points, existing in *; simpl fst in *; simpl snd in *.
  apply in_map_iff in P as [v [<- V]]; destruct (masks_near H k o d v G C V) as [A B].
  apply (hull_mono (fun p => exists u, In u (near_at H k o) /\ p = place k u)).
  - intros q [u [U ->]]; apply in_map; exact U.
  - apply apply_mask_hull; [exact A | exact B].
Qed.

Definition surface_of : surface :=
  {| owner := nat * part H; good := existing; ring := ring_points; children := parts_of;
     children_good := parts_existing; locality := parts_local |}.

(* The limit surface of some owners at level 0: of all that have a surface, so that holes may be left out. *)
Variable shown : list (part H).

Definition limit_surface (x : point) := exists f, In f shown /\ piece surface_of (O, f) x.

Definition all_exist := forall f, In f shown -> exists_at H 0 f.

(* A certificate names all owners, in an order of its own. *)
Definition orders (l : list (owner surface_of)) := forall o, In o l <-> exists f, In f shown /\ o = (O, f).

Lemma orders_good l : all_exist -> orders l -> all_good surface_of l.
Proof. intros E K o O; apply K in O as [f [F ->]]; exact (E f F). Qed.

Lemma orders_cover l x : orders l -> limit_surface x -> pieces surface_of l x.
Proof. intros K [f [F X]]; exists (O, f); split; [apply K; eauto | exact X]. Qed.

Lemma in_own_order : orders (map (pair O) shown).
Proof. intros o; rewrite in_map_iff; split; intros [f [A B]]; eauto. Qed.

End Surface.

(* A tree that the checker accepts proves that the limit surfaces are more than m apart. *)
Theorem certificate_sound m (H K : hierarchy) p q F G t a b :
  all_exist H F -> all_exist K G -> orders H p F a -> orders K q G b ->
  accepted m (surface_of H p) (surface_of K q) t a b ->
  apart m (limit_surface H p F) (limit_surface K q G).
Proof.
  intros IA IB OA OB T x y X Y.
  exact (accepted_apart m _ _ t a b (orders_good _ _ _ a IA OA) (orders_good _ _ _ b IB OB) T x y
    (orders_cover _ _ _ a x OA X) (orders_cover _ _ _ b y OB Y)).
Qed.

(* How a scheme refines whose owners are faces: its faces, their children, and the ring of a face in a mesh. [fits M v l]
   says that the mask l of the new vertex v names old vertices only that are near enough. *)
Record refinement := {
  face : Type;
  corners : face -> list vertex;
  parts : face -> list face;
  near : list face -> face -> list vertex;
  fits : list face -> vertex -> mask -> Prop;
  near_existing : forall M f v, In f M -> In v (near M f) -> exists g, In g M /\ In v (corners g);
  fits_near : forall M f c v l a u, In f M -> In c (parts f) -> In v (near (flat_map parts M) c) ->
    fits M v l -> In (a, u) l -> In u (near M f)
}.

Section Faces.
Variable R : refinement.
Variable control : list (face R).

Fixpoint mesh (k : nat) : list (face R) :=
  match k with O => control | S j => flat_map (parts R) (mesh j) end.

(* Masks of the new vertices at each level: means, of vertices that are near enough. *)
Definition proper (masks : nat -> vertex -> mask) :=
  forall k c v, In c (mesh (S k)) -> In v (corners R c) -> is_mean (masks k v) /\ fits R (mesh k) v (masks k v).

Variable masks : nat -> vertex -> mask.
Hypothesis masks_proper : proper masks.

Lemma faces_exist k f c : In f (mesh k) -> In c (parts R f) -> In c (mesh (S k)).
Proof. intros F C; apply in_flat_map; eauto. Qed.

Lemma masks_of_faces k f c v : In f (mesh k) -> In c (parts R f) -> In v (near R (mesh (S k)) c) ->
  is_mean (masks k v) /\ forall a u, In (a, u) (masks k v) -> In u (near R (mesh k) f).
Proof.
  intros F C V; destruct (near_existing R _ _ _ (faces_exist k f c F C) V) as [g [G W]].
  destruct (masks_proper k g v G W) as [A B]; split; [exact A |].
  intros a u U; exact (fits_near R _ _ _ _ _ _ _ F C V B U).
Qed.

Definition faces : hierarchy :=
  {| part := face R; exists_at := fun k f => In f (mesh k); parts_at := fun _ => parts R;
     near_at := fun k => near R (mesh k); masks_at := masks; parts_exist := faces_exist;
     masks_near := masks_of_faces |}.

End Faces.

(* The rings of faces that touch. A mask may name the new vertex's parents and vertices of faces that have all its parents.
   It is enough that the parents of a child's vertices are corners of its owner, and that two vertices of a child have a
   parent in common. *)
Section Local.
Context {face : Type}.
Variables (corners : face -> list vertex) (parts : face -> list face).

Hypothesis parents_are_corners : forall f c v x,
  In c (parts f) -> In v (corners c) -> In x (parents v) -> In x (corners f).
Hypothesis common_parent : forall f c v w,
  In c (parts f) -> In v (corners c) -> In w (corners c) -> exists x, In x (parents v) /\ In x (parents w).

Definition around (M : list face) (v : vertex) (l : mask) := forall a u, In (a, u) l ->
  In u (parents v) \/ exists g, In g M /\ incl (parents v) (corners g) /\ In u (corners g).

Lemma around_near M f c v l a u : In f M -> In c (parts f) -> In v (vertices_near corners (flat_map parts M) c) ->
  around M v l -> In (a, u) l -> In u (vertices_near corners M f).
Proof.
  intros F C V L U; apply near_spec in V as [d [y [D [Yc [Yd V]]]]].
  apply in_flat_map in D as [g [G D]].
  destruct (common_parent g d y v D Yd V) as [x [Xy Xv]].
  assert (Xf : In x (corners f)) by exact (parents_are_corners f c y x C Yc Xy).
  apply near_spec; destruct (L a u U) as [P | [h [H [I W]]]].
  - exists g, x; repeat split; auto.
    + exact (parents_are_corners g d y x D Yd Xy).
    + exact (parents_are_corners g d v u D V P).
  - exists h, x; repeat split; auto.
Qed.

Lemma near_exists M f v : In f M -> In v (vertices_near corners M f) -> exists g, In g M /\ In v (corners g).
Proof. intros _ H; apply near_spec in H as [g [x [G [_ [_ V]]]]]; exists g; auto. Qed.

Definition refinement_with_rings : refinement :=
  {| Mesh.face := face; Mesh.corners := corners; Mesh.parts := parts; near := vertices_near corners;
     fits := around; near_existing := near_exists; fits_near := around_near |}.

(* Where masks name parents only, the corners of a face are enough of a ring. *)
Definition of_parents (M : list face) (v : vertex) (l : mask) := forall a u, In (a, u) l -> In u (parents v).

Lemma of_parents_near M f c v l a u : In f M -> In c (parts f) -> In v (corners c) ->
  of_parents M v l -> In (a, u) l -> In u (corners f).
Proof. intros F C V L U; exact (parents_are_corners f c v u C V (L a u U)). Qed.

Lemma own_exists (M : list face) f v : In f M -> In v (corners f) -> exists g, In g M /\ In v (corners g).
Proof. eauto. Qed.

Definition refinement_of_faces : refinement :=
  {| Mesh.face := face; Mesh.corners := corners; Mesh.parts := parts; near := fun _ => corners;
     fits := of_parents; near_existing := own_exists; fits_near := of_parents_near |}.
End Local.
