#pragma once

#include <array>
#include <vector>

#include <snug/patch/evaluate.h>
#include <snug/search/piece_cache.h>
#include <snug/surface/level_complex.h>
#include <snug/surface/limit_surface.h>

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

/// Is a vertex of a closed fan, sharp by itself, with smooth edges, the mean of its edges' other ends, and of its faces' opposite corners?
/// A smooth vertex would stay there, too.
[[nodiscard]] bool is_balanced(const LimitSurface& surface, const LevelStar& fan);

/// Of two root patches at a vertex that stays in place: is one behind a plane through it, or in it, and the other one in front, but for the
/// vertex? Planes through control points are tried.
[[nodiscard]] bool are_parted_by_facet(const LimitSurface& surface, const LevelStar::Sector& a,
                                       const LevelStar::Sector& b);

}  // namespace snug
