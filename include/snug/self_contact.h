#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/collide.h>

namespace snug {

/// Does a surface meet itself?
enum class SelfVerdict : std::uint8_t {
  clear,         ///< proved: no two parameters have the same limit point
  intersecting,  ///< proved: two pieces without a common corner cross each other
  near,  ///< proved: two points are at most `within` apart, but farther apart than the radius along the surface
  undecided,  ///< none of these could be shown
};
[[nodiscard]] SNUG_API const char* name_of(SelfVerdict verdict);

struct SelfContactOptions {
  /// > 0, in mesh units: points at most this far apart are near each other. Default: only contact is tested.
  std::optional<double> within{};
  /// Only points farther apart along the surface than this count as near; points of different components always
  /// do. At least twice `within`; if it is below pi/2 times that, a sphere of diameter `within` is near itself.
  /// Default: 4 times `within`.
  std::optional<double> radius{};
  unsigned levels = 10;  ///< most levels below the coarsest one at which stars are tested
};

/// Two places of a surface that meet, are near each other, or could not be proved apart.
struct SelfContactPair {
  SelfVerdict verdict = SelfVerdict::undecided;  ///< all but clear
  WitnessPoints points;                          ///< on the two pieces in question; `at` is set
  Interval distance;  ///< contains the distance of the two pieces; [0, 0] where they cross
};

/// The answer to "does this surface meet itself?"
struct SelfContact {
  SelfVerdict verdict = SelfVerdict::undecided;
  /// The places that the verdict rests on: the first max_pairs at most, in an order that depends only on the
  /// surface. None if the verdict is clear.
  std::vector<SelfContactPair> pairs;
  static constexpr std::size_t max_pairs = 100;
  std::uint64_t stars = 0;              ///< neighbourhoods of vertices tested
  std::uint64_t pair_tests = 0;         ///< pairs of pieces tested
  double radius = 0;                    ///< the radius that was used; 0 without `within`
  unsigned levels = 0;                  ///< levels of subdivision that were needed
  Outcome outcome = Outcome::complete;  ///< `complete` unless `undecided`; `at_rounding` also at `levels`
};

/// Does a limit surface meet itself?
///
/// Pieces without a common corner are proved apart or proved to cross. The pieces around a vertex are together proved
/// not to meet except along shared edges, or are split.
///
/// With `within`, `clear` also proves that any two points so close are joined by a path on the surface no longer than
/// the radius, and `near` that two of them are not joined by such a path.
///
/// Guarantee: `clear`, `intersecting` and `near` hold in exact arithmetic for the given doubles. Places where the surface is not an immersion (spikes, folded creases, collapsed
///            patches, vertices and edges that are not manifold) are `undecided`, never `clear`; so are darts, and
///            smooth vertices of boundaries and creases with many faces (docs/self_contact.md).
/// Budget:    1,000,000 stars and pairs of pieces tested, about; 100 bytes each.
/// Errors:    InputError: (value) for more than 20 levels, for `within` not positive and finite, and for a radius that
///            is not finite, is below twice `within`, or is given without it; (refused) if
///            no face has a limit surface; (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      about 1 to 4 ms per face (docs/self_contact.md). With `within` the same time again, plus time in
///            proportion to the pieces that are near each other.
/// Source:    derivations/self_contact.md.
[[nodiscard]] SNUG_API SelfContact self_contact(const Surface& surface,
                                                const SelfContactOptions& options = {}, const Run& run = {});

}  // namespace snug
