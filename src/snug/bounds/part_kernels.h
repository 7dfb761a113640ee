#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/patch/patch.h>

namespace snug {

/// Rows that kernels read of the kind of a part of a patch: a polynomial, or a tip, the piece at one extraordinary corner, whose kind
/// comes again at every level.
struct PartRows {
  const Kind* kind;
  const BoundingRows* rows;  ///< without a split; none of a tip
  const LevelStep* step;     ///< of a tip
  const QuadraticRows* quadratic;

  /// None of planes, and of kinds that are neither. `unsplit`: the part is the patch itself.
  /// Requires:  it is used before this thread asks the library for rows of other kinds.
  [[nodiscard]] static std::optional<PartRows> of(BoundsCache& library, const Kind& kind, bool unsplit);
  [[nodiscard]] bool tip() const { return !kind->polynomial(); }
};

/// Limits of the corners of a part, and its own quadratic: corners, middles of the edges 01, 12, 20. Relative to the patch's
/// origin, in the part's order of corners.
struct PartShape {
  std::array<Vector3, 3> corners;
  std::array<Vector3, 6> quadratic;
};

/// The frame of a patch's base triangle, as kernels made it (bounds/planar_triangle-inl.h), what parts of the patch are compared
/// with in it, and what of the patch's answer does not depend on its parts.
struct PatchFrame {
  Vector3 a;                                      ///< corner 0
  Vector3 t1, t2, n;                              ///< rows of the frame
  double l0, l1, l2, xc, yc, d1x, d1y, d2x, d2y;  ///< the triangle in its plane
  double axis_x, axis_y, middle;  ///< the longest edge's direction; height of the base above the corners
  Vector3 direction;              ///< across the quadratic, of length 1; or zero
  std::array<std::array<Vector3, 6>, 4> quadratic;  ///< over each part
  double longest, deviation, amplify, stretch;      ///< of the triangle
  double quadratic_size;                            ///< largest |coordinate| of the quadratic
  bool good;                                        ///< no needle, and finite
};

/// Bounds of a part in its patch's frame: of its points, and apart from them of what is left of it at an extraordinary corner.
struct PartBounds {
  struct Reach {
    /// Heights along the longest edge, across it and along the normal.
    std::array<double, 3> lower{INFINITY, INFINITY, INFINITY}, upper{-INFINITY, -INFINITY, -INFINITY};
    /// The largest distance from the base, that from the quadratic, parameter by parameter, and that along its direction.
    double base = 0, quadratic = 0, along = 0;
    void add(const Reach& other);
  };
  Reach points, tip;
  double error, size;  ///< what coordinates of points are off by, and what none of them exceeds
  double doubt = 0;    ///< how much of the distance from the base may be rounding, beside what `error` says
};

/// Where a tip ended, in its patch's frame: its net, the quadratic over it, and what coordinates of the net are off by.
struct TipState {
  std::vector<Vector3> net;
  std::array<Vector3, 6> quadratic;
  double error;
};
inline constexpr unsigned deepest_part_tip = 12;

/// Patches in vectors, a part or a patch a lane. Answers do not depend on what is in other lanes.
namespace kernels {

void shape_parts(const PartRows& rows, std::span<const Patch* const> parts, std::span<PartShape* const> out);

/// Frames of patches with four parts each, as split() makes them, or of such as are their own only part.
void make_frames(std::span<const PartShape> parts, std::size_t parts_of_each, std::span<PatchFrame> out);

/// A part in the frame of its patch, number `child` of it.
struct PlacedPart {
  const Patch* patch;
  const PatchFrame* frame;
  std::uint8_t child;
  TipState* tip;
};
/// Tips go from a level to another; unless the first is 0, where a call ended that began with them, `out` what it said.
/// Requires:  0 <= first < last <= deepest_part_tip.
/// Source:    derivations/quadratics.md, "Many patches at once".
struct TipLevels {
  unsigned first, last;
};
void bound_parts(const PartRows& rows, std::span<const PlacedPart> parts, TipLevels levels,
                 std::span<PartBounds* const> out);

}  // namespace kernels
}  // namespace snug
