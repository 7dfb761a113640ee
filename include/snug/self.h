#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// Does a surface meet itself?
enum class SelfVerdict : std::uint8_t {
  clear,         ///< proved: no two parameters have the same limit point
  intersecting,  ///< proved: two pieces without a common corner cross each other
  near,  ///< proved: two points are within the tolerance, but farther apart than the radius along the surface
  undecided,  ///< none of these could be shown
};
[[nodiscard]] SNUG_API const char* name_of(SelfVerdict verdict);

struct SelfContactOptions {
  /// > 0, in mesh units: points at most this far apart are near each other. Default: only contact is tested.
  std::optional<double> tolerance{};
  /// Only points farther apart along the surface than this count as near; points of different components always
  /// do. At least twice the tolerance; if it is below pi/2 times the tolerance, a sphere whose diameter is the
  /// tolerance is near itself. Default: 4 times the tolerance.
  std::optional<double> radius{};
  std::uint64_t budget = 1'000'000;  ///< most stars and pairs of pieces tested, about; memory: 100 bytes each
  unsigned levels = 10;              ///< most levels below the coarsest one at which stars are tested
  int threads = 0;                   ///< 0: all cores
};

/// Two places of a surface that meet, are near each other, or could not be proved apart.
struct SelfContactPair {
  SelfVerdict verdict = SelfVerdict::undecided;  ///< all but clear
  std::array<SurfaceParameter, 2> at;            ///< on the two pieces in question
  std::array<Point3, 2> points;                  ///< the limit points there, in double precision
  Interval distance;  ///< contains the distance of the two pieces; [0, 0] where they cross
};

/// The answer to "does this surface meet itself?"
struct SelfContact {
  SelfVerdict verdict = SelfVerdict::undecided;
  /// The places that the verdict rests on: the first max_pairs at most, in an order that depends only on the
  /// surface. None if the verdict is clear.
  std::vector<SelfContactPair> pairs;
  static constexpr std::size_t max_pairs = 100;
  std::uint64_t stars = 0;       ///< neighbourhoods of vertices tested
  std::uint64_t pair_tests = 0;  ///< pairs of pieces tested
  double radius = 0;             ///< the radius that was used; 0 without a tolerance
  unsigned levels = 0;           ///< levels of subdivision that were needed
};

/// Does a limit surface meet itself?
///
/// Pieces without a common corner are proved apart or proved to cross. The pieces around a vertex are together proved
/// not to meet except along shared edges, or are split.
///
/// With a tolerance, `clear` also proves that any two points within it are joined by a path on the surface no longer
/// than the radius, and `near` that two points within it are not joined by such a path.
///
/// Guarantee: `clear`, `intersecting` and `near` hold in exact arithmetic for the given doubles. Places where the surface is not an immersion (spikes, folded creases, collapsed
///            patches, vertices and edges that are not manifold) are `undecided`, never `clear`; so are darts, and
///            smooth vertices of boundaries and creases with many faces (docs/self_contact.md).
/// Errors:    InputError: (value) for more than 20 levels, for a tolerance that is not positive and finite, and for a
///            radius that is not finite, is below twice the tolerance, or is given without a tolerance; (refused) if
///            no face has a limit surface; (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      about 1 to 4 ms per face (docs/self_contact.md). With a tolerance the same time again, plus time in
///            proportion to the pieces that are near each other.
/// Source:    derivations/self_contact.md.
[[nodiscard]] SNUG_API SelfContact self_contact(const Surface& surface,
                                                const SelfContactOptions& options = {},
                                                const WorkMonitor& monitor = {});

}  // namespace snug
