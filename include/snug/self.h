#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// Does a surface meet itself?
enum class SelfVerdict : std::uint8_t {
  clear,         ///< proved: no two parameters have one point
  intersecting,  ///< proved: two pieces without a common corner cross each other
  near,  ///< proved: two places are within the tolerance, and farther apart than the radius along the surface
  undecided,  ///< none of these could be shown
};
[[nodiscard]] SNUG_API const char* name_of(SelfVerdict verdict);

struct SelfContactOptions {
  /// > 0, in mesh units: places at most this far apart are near each other. None: only those with one point.
  std::optional<double> tolerance{};
  /// Only places farther apart along the surface than this count as near; other components count, too. At least
  /// twice the tolerance. Below pi/2 times it a sphere of that diameter would be near itself. Default: 4
  /// tolerances.
  std::optional<double> radius{};
  std::uint64_t budget = 1'000'000;  ///< most stars and pairs of pieces looked at, about
  unsigned levels = 10;              ///< most levels below the coarsest one at which stars are looked at
  int threads = 0;                   ///< 0: all cores
};

/// Two places of a surface that meet or are near each other, or are not known not to.
struct SelfContactPair {
  SelfVerdict verdict = SelfVerdict::undecided;  ///< all but clear
  std::array<SurfaceParameter, 2> at;            ///< on the two pieces in question
  std::array<Point3, 2> points;                  ///< the limit points there, in double precision
  Interval distance;  ///< contains the distance of the two pieces; [0, 0] where they cross
};

/// The answer to "does this surface meet itself?"
struct SelfContact {
  SelfVerdict verdict = SelfVerdict::undecided;
  /// What the verdict rests on: the first places, at most max_pairs, in an order that depends on the surface
  /// alone. None where it is clear.
  std::vector<SelfContactPair> pairs;
  static constexpr std::size_t max_pairs = 100;
  std::uint64_t stars = 0;       ///< neighbourhoods of vertices looked at
  std::uint64_t pair_tests = 0;  ///< pairs of pieces looked at
  double radius = 0;             ///< what SelfContactOptions::radius was; 0 without a tolerance
  unsigned levels = 0;           ///< levels of subdivision that were needed
};

/// Does a limit surface meet itself?
///
/// Pieces without a common corner are proved to be apart, or to cross each other; those around a vertex are
/// proved to have no two parameters with one point, or all are split.
///
/// With a tolerance, `clear` also says that all points at most so far apart have a way along the surface of at
/// most the radius between them, and `near` that two of them have none.
///
/// Guarantee: `clear`, `intersecting` and `near` hold in exact arithmetic for the given doubles. Results do not
///            depend on threads. Places where the surface is no immersion (spikes, folded creases, collapsed patches,
///            vertices and edges that are not manifold) are `undecided`, never `clear`; so are darts, and smooth
///            vertices of boundaries and creases with many faces (docs/self_contact.md).
/// Errors:    InputError: (value) for more than 20 levels, a tolerance that is not positive and finite, and a
///            radius that is not finite, below twice the tolerance, or without one; (refused) if no face has a limit surface;
///            (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      about 1 to 4 ms a face (docs/self_contact.md). With a tolerance as much again, and in proportion to
///            the pieces that are near each other.
/// Source:    derivations/self_contact.md.
[[nodiscard]] SNUG_API SelfContact self_contact(const Surface& surface,
                                                const SelfContactOptions& options = {},
                                                const WorkMonitor& monitor = {});

}  // namespace snug
