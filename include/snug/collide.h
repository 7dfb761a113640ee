#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface.h>

namespace snug {

enum class Verdict : std::uint8_t {
  separated,     ///< proved: the limit surfaces are farther apart than the margin
  within,        ///< two witness points on the limit surfaces are at most margin + tolerance apart
  intersecting,  ///< proved: the limit surfaces, or the solids they bound, have a point in common
  undecided,     ///< none of these could be shown within the budget or the precision of doubles
};
[[nodiscard]] SNUG_API const char* name_of(Verdict verdict);

struct CollideOptions {
  /// >= 0, mesh units: slack in which contact need not be decided. With 0 only proofs of contact or separation count.
  /// Default: 0.1 % of the larger surface's size.
  std::optional<double> tolerance{};
  double margin = 0;                         ///< >= 0, mesh units
  WitnessKind witness = WitnessKind::exact;  ///< no verdict depends on it
  /// Before `within`, try hard to prove `intersecting`, which by default is tried only where it costs no more than the verdict.
  bool prove_contact = false;
  bool solid = false;  ///< compare the solids that closed surfaces bound: one inside the other intersects it
  /// Separated: bring the ends of `distance` to within a factor of 2, with witnesses, for ten microseconds more.
  bool measure = false;
};

/// The work that a query did.
struct SearchStats {
  std::uint64_t box_tests = 0;       ///< pairs of BVH nodes compared
  std::uint64_t triangle_tests = 0;  ///< pairs of base triangles compared
  std::uint64_t evaluations = 0;     ///< pairs of limit points evaluated
  std::uint64_t splits = 0;          ///< pieces split or taken from the cache already split
};

/// Points of A and of B; LimitPoint::at is empty where a point is known to lie on the other surface only.
using WitnessPoints = std::array<LimitPoint, 2>;

/// The answer to "do these surfaces touch?", in mesh units and world coordinates.
struct Collision {
  Verdict verdict = Verdict::undecided;
  /// Contains the distance. The upper end is infinite if no pair of points was near enough to matter.
  Interval distance{0, std::numeric_limits<double>::infinity()};
  std::optional<WitnessPoints> witness;  ///< the two closest points found
  /// Set with `solid` if no crossing was proved but a point of a surface inside the other solid: 0 if it is a
  /// point of A's surface, 1 if of B's. Both witnesses are then that point.
  std::optional<std::size_t> contained;
  Outcome outcome = Outcome::complete;  ///< `complete` unless the verdict is `undecided`
  SearchStats stats;
};

/// Do two placed limit surfaces touch?
///
/// Guarantee: `separated` means distance > margin, `within` distance <= margin + tolerance, `intersecting`
///            distance = 0 (or solids with a common point), all in exact arithmetic for the given doubles.
///            `distance` contains the distance of the surfaces, with `solid` that of the solids. If several
///            verdicts are true, which one is returned depends on the input alone.
/// Budget:    1,000,000 splits; 200 bytes each.
/// Errors:    InputError: (value) for a tolerance or margin that is negative or not finite; (unrepresentable)
///            if a result does not fit a double; (refused) if no face of a mesh has a limit surface, and with
///            `solid` if a surface is not closed. Interrupted.
/// Cost:      about 100 ns for surfaces far apart, microseconds in contact (bench/results/collide.txt).
/// Source:    [Wu05, sec. 5.1]; differs: the printed pair test is not sound, see derivations/leaf_rule.md.
[[nodiscard]] SNUG_API Collision collide(const PlacedSurface& a, const PlacedSurface& b,
                                         const CollideOptions& options = {}, const Run& run = {});
/// The same bits for many poses, in the same order.
[[nodiscard]] SNUG_API std::vector<Collision> collide(const Surface& a, const Surface& b,
                                                      std::span<const PosePair> poses,
                                                      const CollideOptions& options = {},
                                                      const Run& run = {});

struct PenetrationOptions {
  /// >= 0; the search ends once the width of `depth` is at most this fraction of its upper end.
  double relative = 0.05;
};

/// How deeply two solids penetrate: the least length of a translation of B that separates them.
struct Penetration {
  /// Proved: no translation shorter than the lower end separates them. `translation`, added to B's pose in
  /// double precision, does, and is at most as long as the upper end.
  Interval depth;
  Vector3 translation;  ///< to be added to B's pose; zero if the solids are separated as they are
  /// `complete` if `depth` is as narrow as requested, or 2^-28 of the larger size.
  Outcome outcome = Outcome::complete;
};

/// Bounds of the penetration depth of two closed, placed surfaces.
///
/// Guarantee: `depth` contains the depth, and with `translation` added to B's pose the solids are separated. The
///            upper end is that of a local minimum, which may be far from the depth where parts interlock.
/// Budget:    20,000 splits for each collision query of the search; 200 bytes each.
/// Errors:    InputError: (refused) for a surface that is not closed, (value) for a precision that is negative or
///            not finite, (unrepresentable) if no separating translation fits a double. Interrupted.
/// Cost:      about a hundred collision and closest-point queries, some thousands where the precision is missed.
/// Source:    derivations/contact.md, "How deep".
[[nodiscard]] SNUG_API Penetration penetration(const PlacedSurface& a, const PlacedSurface& b,
                                               const PenetrationOptions& options = {}, const Run& run = {});

}  // namespace snug
