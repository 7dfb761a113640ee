#pragma once

#include <array>
#include <vector>

#include <snug/patch/evaluate.h>
#include <snug/search/piece_cache.h>
#include <snug/surface/limit_surface.h>
#include <snug/surface/piece_name.h>

/// Contacts of a surface with itself that stand in its control points, exactly.
/// Source:    derivations/self_contact.md, "In control points".
namespace snug {

/// Two places of a surface, by pieces.
struct PieceContact {
  std::array<PieceName, 2> pieces;
  std::array<TriangleParameter, 2> at;
};

/// Corners of faces that are different vertices with the same limit point: of sharp corners the same control point, of smooth ones of
/// borders and creases the same three. Each with the first one there.
[[nodiscard]] std::vector<PieceContact> coincident_vertices(const LimitSurface& surface);

/// Of surfaces whose control points are all in one plane: for the first such patch, a piece that is turned over, and one that is not. Then
/// the patch meets itself, wherever. Empty if there is none, or only smaller pieces.
/// Cost:      that of comparing control points, in space; a cone of normals for each patch, in a plane.
[[nodiscard]] std::vector<PieceContact> flat_folds(const SurfaceBvh& model);

}  // namespace snug
