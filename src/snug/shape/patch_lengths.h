#pragma once

#include <array>

#include <snug/patch/patch.h>

namespace snug {

/// Upper bounds of distances along the surface within a patch. Ways may leave half a quad for the other half.
struct PatchLengths {
  std::array<double, 3> from_corner{};  ///< from this corner to any point
  std::array<double, 3> edge{};         ///< from corner k to k + 1
  double diameter = 0;                  ///< of any two points

  /// Between two different corners.
  [[nodiscard]] double between(std::size_t i, std::size_t k) const {
    return (i + 1) % 3 == k ? edge[i] : edge[k];
  }
};

/// Guarantee: upper bounds in exact arithmetic, maybe infinite.
/// Requires:  no polygon.
/// Cost:      a microsecond for a regular patch; some 25 splits at an extraordinary corner.
/// Source:    derivations/self_contact.md, "Lengths".
[[nodiscard]] PatchLengths patch_lengths(const Patch& patch);

}  // namespace snug
