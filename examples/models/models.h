#pragma once
// The example models; each make function returns a finished control mesh.

#include "triangle_mesh.h"

namespace models {

TriangleMesh make_star();
TriangleMesh make_pawn();
TriangleMesh make_ring();
TriangleMesh make_head();
TriangleMesh make_bust();
TriangleMesh make_demon();
TriangleMesh make_figure();

/// Texts of the OBJ files of the models of quads.
std::string bracket_text();
std::string pin_text();

}  // namespace models
