#pragma once

#include <span>
#include <vector>

#include <snug/patch/kind_cache.h>
#include <snug/patch/piece_path.h>

namespace snug {

/// A limit patch, or a piece of one: its kind and its control points.
///
/// Points are kept relative to `origin`, an exact double point near the patch: rows sum to 1, so a patch far
/// from the coordinates' origin loses nothing. Corners are counted as in the control face (or the piece, see
/// scheme/refine.h): corner k of the patch is corner (k - first) mod 3 of the kind.
struct Patch {
  const Kind* kind = nullptr;
  std::uint8_t first = 0;
  PiecePath path;
  Point3 origin;
  std::vector<Vector3> points;  ///< kind->control_count() of them
  double error = 0;             ///< upper bound, a coordinate, of |points - exact control points|
  double largest = 0;           ///< largest |coordinate| of `points`

  [[nodiscard]] std::size_t to_kind(std::size_t corner) const { return (corner + 3 - first) % 3; }
};

/// The patch of some points of a mesh, which are named in the kind's order (Kind::control_vertices).
/// Requires:  finite points of at most about 2 (support/scaling.h).
[[nodiscard]] Patch make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                               std::span<const VertexId> which);
/// The same, written over `out`, which keeps its memory.
void make_patch(const Kind& kind, std::uint8_t first, std::span<const Point3> all,
                std::span<const VertexId> which, Patch& out);

/// Piece `child` of a patch after one step of subdivision, 0 to 3; of a polygon that is no patch itself
/// (KindKey) half a quad, as Kind::children() counts them, with the polygon's path.
/// Guarantee: `error` of the result covers the parent's, the rounding of this step and of the masks.
/// Cost:      one sparse product: 4 to 7 multiply-adds a control point and coordinate.
[[nodiscard]] Patch split(const Patch& patch, unsigned child);
/// The same, written over `piece`, which keeps its memory.
void split(const Patch& patch, unsigned child, Patch& piece);
/// All four pieces of a patch, the same ones, at less than half the cost: each new point is made once.
void split_into_four(const Patch& patch, std::span<Patch, 4> pieces);

}  // namespace snug
