#pragma once

#include <array>
#include <cstdint>
#include <random>

#include <snug/bounds/enclosure.h>

namespace snug {

/// The dissertation's test of two offset triangles, exactly as printed. NOT a bound: kept as an experiment;
/// no query may call it.
///
/// Moeller's interval overlap test of the base triangles, in which the epsilon below which a signed distance
/// to a plane counts as zero is a.radius + b.radius + epsilon. Corners of one triangle all on one side of the
/// other's plane: separated. All on the plane: edges against edges and corners against triangles, projected
/// along an axis. Else the triangles' intervals on the planes' common line are compared.
///
/// Guarantee: none. Neither the projected triangles nor the intervals get any tolerance, so offset triangles
///            that overlap are often called separated: two examples in derivations/leaf_rule.md.
/// Requires:  finite corners, triangles with an area.
/// Source:    [Wu05, sec. 5.1.1] on [Moeller97]; differs from the latter: normals of length 1, since the
///            epsilon is a length.
[[nodiscard]] bool printed_test_says_separated(const OffsetTriangle& a, const OffsetTriangle& b,
                                               double epsilon);

/// Rule (a) of collide(), for comparison.
///
/// Guarantee: true only if the two offset triangles are farther apart than `margin`, rounding included.
/// Requires:  finite corners of at most about 4.
/// Source:    derivations/leaf_rule.md.
[[nodiscard]] bool certainly_separated(const OffsetTriangle& a, const OffsetTriangle& b, double margin);

/// How two triangles that nearly touch may lie.
enum class PairFamily : std::uint8_t {
  general,          ///< both drawn independently, withdrawn from each other in any direction
  side_by_side,     ///< in one plane, give or take an eighth of the tolerance, and withdrawn within it
  one_above_other,  ///< parallel, give or take the tolerance, and withdrawn within 20 degrees of the normal
};
inline constexpr std::array all_pair_families{PairFamily::general, PairFamily::side_by_side,
                                              PairFamily::one_above_other};
[[nodiscard]] const char* name_of(PairFamily family);

/// A pair of leaves that must not be called separated.
struct NearPair {
  OffsetTriangle a, b;
  double epsilon = 0;
  [[nodiscard]] double tolerance() const { return a.radius + b.radius + epsilon; }
};

/// Draws a pair whose base triangles have a distance in (0, tolerance()].
///
/// The triangles have edges of about 1 and are no needles; epsilon lies in [2^-9, 2^-3); both radii are below
/// epsilon/2, as the dissertation has them at its leaves; triangles that meet are withdrawn until their
/// distance is what was drawn, uniformly, from (0, tolerance()].
///
/// Guarantee: nearest() certifies a distance > 0, and two points of the triangles are at most tolerance()
///            apart. The same pairs for the same state of `random`, with any standard library.
/// Cost:      about 25 microseconds.
[[nodiscard]] NearPair near_pair(PairFamily family, std::mt19937_64& random);

}  // namespace snug
