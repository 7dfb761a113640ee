(* What the main theorems rest on: compare assumptions.txt. *)
From Snug Require Import Points Separation Subdivision Sets Mesh Poses Rules Quads Triangles Textbook Polygons Dual Examples.

Definition main_theorems :=
  (leaf_rule, separation_sound, ring_of_descendant, limits_above, piece_children, children_piece,
   accepted_apart, point_sound, segment_sound, ray_sound, certificate_sound, placed_sound,
   quads_closed_refine, bilinear_proper, catmark_proper, tris_closed_refine, loop_proper,
   bilinear_any_proper, catmark_any_proper, flat_proper, loop_any_proper, doo_sabin, midedge, catmark_textbook, loop_textbook, cubes_apart, bilinear_corner).

Print Assumptions main_theorems.
