#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <snug/search/answers.h>
#include <snug/search/workspace.h>

namespace snug {

enum class Verdict : std::uint8_t {
  separated,     ///< proved: the limit surfaces are farther apart than the margin
  within,        ///< two witness points on the limit surfaces are at most margin + tolerance apart
  intersecting,  ///< proved: the limit surfaces have a point in common, or as solids one holds some of the other
  undecided,     ///< none of these within the budget, or above the noise of rounding
};
[[nodiscard]] const char* name_of(Verdict verdict);

struct CollideOptions {
  double tolerance = 0;              ///< >= 0, mesh units; 0: nothing but proofs of contact and of separation
  double margin = 0;                 ///< >= 0, mesh units
  std::uint64_t budget = 1'000'000;  ///< most pieces opened
  bool prove_contact = false;        ///< where surfaces are within, try to prove that they intersect
  bool solid = false;                ///< closed surfaces bound solids: one inside of the other intersects it
  /// Where surfaces are separated, measure until `lower` is at least half of `upper`, with witnesses: some ten microseconds
  /// more. Without, `lower` is what the search came across: within a factor of 2 in the median where surfaces are far apart,
  /// of 100 where they are near.
  bool measure = false;
};

/// Answer to "do these surfaces touch?", in mesh units and world coordinates.
struct Collision {
  Verdict verdict = Verdict::undecided;
  double lower = 0;                              ///< proved lower bound of the distance
  std::optional<double> upper;                   ///< proved upper bound, where a pair of points was evaluated
  std::optional<std::array<Point3, 2>> witness;  ///< two points as near as were found, on A and on B
  /// Upper bound, a coordinate, of how far a witness is from the limit point it stands for.
  double witness_error = 0;
  WitnessPlaces at;  ///< where the witnesses lie, within the rounding of place_of(); see normal_at()
  /// With `solid`, where no crossing was proved: 0 where a point of A's surface lies in the solid of B, 1 the other way round.
  /// Both witnesses are then that point.
  std::optional<std::size_t> inner;
  SearchStats stats;
};

/// Do two placed limit surfaces touch?
///
/// Both trees are opened from their roots on, deepest overlap first. A pair of pieces is (a) dropped once sets around them
/// are farther apart than the margin; (b) a witness if the limit points at the nearest parameters of its base triangles are
/// near enough, or a proof that one crosses the other; (c) else its larger piece is split, below half the tolerance too.
///
/// Guarantee: `separated` means distance > margin, `within` distance <= margin + tolerance, `intersecting` distance = 0 (or
///            solids with a common point), all in exact arithmetic for these very doubles; lower and upper bound the distance of
///            the surfaces, with `solid` that of the solids. Where several verdicts are true the choice depends on the input alone, not on threads or
///            earlier queries.
/// Errors:    InputError (value) for a tolerance or margin that is negative or not finite, and scratches that are not of
///            their models; (unrepresentable) if a result does not fit a double; (refused) with `solid` if a surface is
///            not closed, wherever it is; Interrupted.
/// Cost:      some 100 ns for surfaces far apart, microseconds in contact (bench/results/collide.txt).
/// Source:    [Wu05, sec. 5.1]; differs: the printed pair test is not sound, see derivations/leaf_rule.md.
[[nodiscard]] Collision collide(const PlacedBvh& a, const PlacedBvh& b, const CollideOptions& options,
                                const WorkMonitor& monitor = {});

}  // namespace snug
