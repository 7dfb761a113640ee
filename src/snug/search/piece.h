#pragma once

#include <array>
#include <ranges>

#include <snug/bounds/enclosure.h>
#include <snug/bvh/obb.h>
#include <snug/surface.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// False at the last level, and where rounding alone makes up the radius: pieces would be no smaller.
[[nodiscard]] inline bool can_split(const Patch& patch, const OffsetTriangle& offset) {
  return patch.path.level() < PiecePath::max_level && offset.radius > 2 * offset.rounding;
}

/// A piece of a limit surface with its offset triangle, in scaled units.
struct Piece {
  PatchId root;
  Patch patch;
  OffsetTriangle offset;

  [[nodiscard]] bool can_split() const { return snug::can_split(patch, offset); }
};

/// The offset triangle of a patch: fitted to bounding rows, which are left in `scratch`, or from tables.
[[nodiscard]] OffsetTriangle offset_of(BoundsCache& library, const Patch& patch, BoundingPoints& scratch,
                                       BoundMethod method);
/// A piece made from a patch.
[[nodiscard]] Piece make_piece(BoundsCache& library, PatchId root, Patch patch, BoundingPoints& scratch,
                               BoundMethod method = BoundMethod::rows);
/// One of the four children of a piece.
/// Requires:  below the last level, PiecePath::max_level.
[[nodiscard]] Piece child_of(BoundsCache& library, const Piece& piece, unsigned child,
                             BoundingPoints& scratch, BoundMethod method = BoundMethod::rows);

/// Limit points, as a triangle: exact ones are within `error`, a length, of its corners.
struct LimitTriangle {
  Triangle corners;
  double error;
};
/// The corners of a patch.
[[nodiscard]] LimitTriangle limit_triangle(const Patch& patch);

/// An edge that no other is much longer than, by their largest coordinates: k if it runs from corner k to the next; the edge.
[[nodiscard]] std::size_t longest_side(const Triangle& triangle);
[[nodiscard]] Vector3 longest_edge(const Triangle& triangle);
/// The normal of a triangle, of length 1 up to a few roundings; zero if it has none.
[[nodiscard]] Vector3 unit_normal(const Triangle& triangle);

/// Bounds of dot(unit_normal(piece.offset.base), x - piece.offset.base[0]) over the piece, rounding included:
/// narrower than its radius, which must cover what bulges sideways too.
struct Heights {
  double lower, upper;
};
/// From the points that the piece was fitted to; infinite where they are not finite.
[[nodiscard]] Heights heights_of(const Piece& piece, const BoundingPoints& points);
/// From the offset triangle alone.
[[nodiscard]] Heights heights_of(const OffsetTriangle& offset);

/// Bounds of dot(direction, x - from) over a patch known by points whose hull holds it.
[[nodiscard]] Extent extent_of(const BoundingPoints& hull, const Vector3& direction, const Point3& from = {});
/// Bounds of dot(direction, x) over an offset triangle.
[[nodiscard]] Extent extent_of(const OffsetTriangle& triangle, const Vector3& direction);

/// A box with given axes around hulls, or around offset triangles.
template <std::ranges::range Sets>
[[nodiscard]] Obb box_around(const std::array<Vector3, 3>& axes, const Sets& sets) {
  return fit_box(axes, [&](const Vector3& axis) {
    Extent all;
    for (const auto& set : sets) all.add(extent_of(set, axis));
    return all;
  });
}
/// A box around a piece, along its base triangle and normal, or the coordinate axes where it has none; by the
/// points that the offset triangle was fitted to, or from tables by itself.
[[nodiscard]] Obb box_around(const OffsetTriangle& offset, const BoundingPoints& points, BoundMethod method);

}  // namespace snug
