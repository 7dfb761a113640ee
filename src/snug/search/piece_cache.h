#pragma once

#include <array>
#include <deque>
#include <memory>
#include <ranges>
#include <vector>

#include <snug/bounds/enclosure.h>
#include <snug/bvh/obb.h>
#include <snug/surface.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A piece in a PieceCache.
using PieceId = Id<struct PieceTag>;

/// A piece of a limit surface with its offset triangle, in scaled units.
struct Piece {
  PatchId root;
  Patch patch;
  OffsetTriangle offset;
  PieceId first_child;  ///< of four in a row; invalid while the piece is whole
};

/// A piece made from a patch: its offset triangle is fitted to hull rows, in `scratch`, or comes from tables.
[[nodiscard]] Piece make_piece(BoundsCache& library, PatchId root, Patch patch, HullPoints& scratch,
                               BoundMethod method = BoundMethod::rows);

/// Limit points, as a triangle: exact ones are within `error`, a length, of its corners.
struct LimitTriangle {
  Triangle corners;
  double error;
};
/// The corners of a patch.
[[nodiscard]] LimitTriangle limit_triangle(const Patch& patch);

/// The normal of a triangle, of length 1 up to a few roundings; zero if it has none.
[[nodiscard]] Vector3 unit_normal(const Triangle& triangle);

/// Bounds of dot(unit_normal(piece.offset.base), x - piece.offset.base[0]) over the piece, rounding included:
/// narrower than its radius, which must cover what bulges sideways too.
struct Heights {
  double lower, upper;
};

/// Bounds of dot(direction, x - from) over a patch known by points whose hull holds it.
[[nodiscard]] Extent extent_of(const HullPoints& hull, const Vector3& direction, const Point3& from = {});
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

/// Patches of one surface, split lazily and in place. Scratch memory of a query: one a thread.
///
/// Guarantee: what it returns depends on the surface alone, not on the order of calls.
/// Cost:      a piece about 1 KB; a split four small products and fits. Memory grows with what was touched; a
///            query that splits counts its own steps against its budget.
class PieceCache {
 public:
  /// Requires:  the surface outlives it.
  explicit PieceCache(const LimitSurface& surface, BoundMethod method = BoundMethod::rows);

  [[nodiscard]] const LimitSurface& surface() const { return surface_; }
  /// A whole patch.
  /// Requires:  surface().has_patch(patch).
  [[nodiscard]] PieceId root(PatchId patch);
  [[nodiscard]] const Piece& operator[](PieceId id) const { return pieces_[id.index()]; }
  [[nodiscard]] const Heights& heights(PieceId id) const { return around_[id.index()].heights; }
  /// A box around the piece, along its base triangle and normal, or the coordinate axes where it has none.
  [[nodiscard]] const Obb& box(PieceId id) const { return around_[id.index()].box; }
  /// Points whose hull holds the piece closely, kept once they are made.
  [[nodiscard]] const HullPoints& hull(PieceId id);
  /// First of the four children, making them if need be.
  /// Requires:  below the last level, PiecePath::max_level; so does child_of().
  [[nodiscard]] PieceId split(PieceId id);
  /// A child of a piece that is not kept, here or elsewhere.
  [[nodiscard]] Piece child_of(const Piece& piece, unsigned child);
  /// False at the last level, and where rounding alone makes up the radius: children would be no smaller.
  [[nodiscard]] bool can_split(PieceId id) const;

  /// Pieces made so far.
  [[nodiscard]] std::size_t size() const { return pieces_.size(); }
  [[nodiscard]] std::size_t bytes() const { return bytes_ + roots_.capacity() * sizeof(PieceId); }
  /// Forgets all pieces.
  void clear();

 private:
  // What is known of a piece once it is kept.
  struct Around {
    Heights heights;
    Obb box;
  };
  PieceId add(PatchId root, Patch patch);

  const LimitSurface& surface_;
  BoundMethod method_;
  std::vector<PieceId> roots_;
  std::deque<Piece> pieces_;
  // Beside the pieces, not in them: distances are found 4 % faster.
  std::vector<Around> around_;
  std::vector<std::uint32_t> hull_places_;  // in hulls_, from 1 on; 0 where there is none
  std::deque<HullPoints> hulls_;
  std::size_t bytes_ = 0;  // of pieces
  HullPoints scratch_;
};

}  // namespace snug
