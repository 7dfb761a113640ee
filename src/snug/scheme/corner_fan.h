#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>

namespace snug {

/// How many faces surround a corner of a patch.
///
/// The corner sees the faces around its vertex counter-clockwise from the patch's own face: `after` of them,
/// and `before` clockwise, if the fan is open; else it is closed and all others are counted in `after`. A fan ends at a
/// boundary, at a non-manifold edge, and at an infinitely sharp edge where the vertex is a corner or a crease: what lies
/// beyond does not matter. Dual schemes: the vertices of the face at the corner, beside the patch's own.
struct CornerFan {
  std::uint16_t before = 0, after = 5;
  bool closed = true;
  bool sharp = false;  ///< infinitely sharp corner: stays where it is
  bool odd = false;    ///< a dart, or a crease that runs through other sheets
  friend auto operator<=>(const CornerFan&, const CornerFan&) = default;
  [[nodiscard]] std::size_t faces() const { return std::size_t{1} + before + after; }
};

}  // namespace snug
