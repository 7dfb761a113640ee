#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <snug/collide.h>
#include <snug/surface.h>

namespace snug {

/// A Precision, and what is compared.
struct DistanceOptions {
  std::optional<double> absolute{};  ///< as in Precision
  std::optional<double> relative{};  ///< as in Precision
  bool solid = false;  ///< compare the solids that closed surfaces bound: 0 apart where they meet
};

/// How far apart two surfaces are, in mesh units and world coordinates.
struct Distance {
  Interval distance;                     ///< contains the distance; [0, 0] if contact is proved
  WitnessPoints witness;                 ///< the two closest points found
  std::optional<std::size_t> contained;  ///< with `solid`: as in Collision
  Outcome outcome = Outcome::complete;
  SearchStats stats;
};

/// The distance of two placed limit surfaces.
///
/// Guarantee: `distance` contains the exact distance for the given doubles, whatever the outcome.
/// Budget:    1,000,000 splits; 200 bytes each.
/// Errors:    InputError: (value) for a precision that is negative or not finite; (unrepresentable) if a result does not fit a
///            double; (refused) if no face of a mesh has a limit surface, and with `solid` if a surface is not closed. Interrupted.
/// Cost:      about 170 microseconds at 0.1 % of the size (bench/results/bars.txt).
[[nodiscard]] SNUG_API Distance distance(const PlacedSurface& a, const PlacedSurface& b,
                                         const DistanceOptions& options = {}, const Run& run = {});
/// The same bits for many poses, in the same order.
[[nodiscard]] SNUG_API std::vector<Distance> distance(const Surface& a, const Surface& b,
                                                      std::span<const PosePair> poses,
                                                      const DistanceOptions& options = {},
                                                      const Run& run = {});

/// The limit point at `at`, which is set, or a point near it. Both are at most distance.upper away, whatever the outcome.
struct ClosestPoint : LimitPoint {
  Interval distance{};  ///< contains the exact distance
  Outcome outcome = Outcome::complete;
};

/// The point of a limit surface closest to a given point.
///
/// Guarantee: `distance` contains the exact distance, whatever the outcome. The result depends on the input alone.
/// Budget:    1,000,000 splits for each point; 200 bytes each.
/// Errors:    InputError: (value) for a point that is not finite or more than 10^12 sizes of the surface
///            away, and for a precision that is negative or not finite; (refused) if no face of the mesh has
///            a limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      2 to 4 microseconds at 0.1 % of the size, 10 at 0.01 %, 50 at 1e-9 (bench/results/bars.txt).
[[nodiscard]] SNUG_API ClosestPoint closest_point(const Surface& surface, const Point3& to,
                                                  const Precision& precision = {}, const Run& run = {});
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<ClosestPoint> closest_point(const Surface& surface,
                                                               std::span<const Point3> to,
                                                               const Precision& precision = {},
                                                               const Run& run = {});

/// Is a point inside the solid that a closed limit surface bounds? The solid is the surface and all points
/// that it winds around.
///
/// Guarantee: the answer is right. It is empty if this cannot be decided: on the surface and within rounding of it.
/// Errors:    InputError: (refused) for a surface that is not closed; (value) for a point that is not finite. Interrupted.
/// Cost:      a walk along a ray, some microseconds; more for points close to the surface.
/// Source:    derivations/contact.md.
[[nodiscard]] SNUG_API std::optional<bool> contains(const Surface& surface, const Point3& point,
                                                    const Run& run = {});
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<std::optional<bool>> contains(const Surface& surface,
                                                                 std::span<const Point3> points,
                                                                 const Run& run = {});

/// How far a point is from a closed limit surface, negative inside the solid that it bounds, in mesh units.
struct SignedDistance {
  Interval distance;  ///< contains it; contains 0 if inside and outside cannot be told apart
  ClosestPoint nearest;
  Outcome outcome = Outcome::complete;  ///< `complete` also if only the sign near 0 is open
};

/// The signed distance of a point. Its sign comes from the winding number, never from a normal.
///
/// Guarantee: `distance` contains it, whatever the outcome.
/// Budget, Errors, Cost: those of closest_point() and contains().
[[nodiscard]] SNUG_API SignedDistance signed_distance(const Surface& surface, const Point3& point,
                                                      const Precision& precision = {}, const Run& run = {});
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<SignedDistance> signed_distance(const Surface& surface,
                                                                   std::span<const Point3> points,
                                                                   const Precision& precision = {},
                                                                   const Run& run = {});

struct DeviationOptions {
  /// > 0, mesh units: largest width of the intervals. Default: 0.01 % of the surface's size.
  std::optional<double> absolute{};
  /// >= 0, mesh units: only decide which distances exceed this; stop as soon as all are decided.
  std::optional<double> threshold{};
  /// For a closed surface: also bound how far the candidate lies inside and outside its solid.
  bool solid = false;
};

/// The greatest distance from a point of one set to the other set, in mesh units: a one-sided Hausdorff
/// distance.
struct OneSidedDistance {
  Interval distance;  ///< contains the exact distance
  LimitPoint
      from;   ///< the farthest point found, at least the lower end away; `at` is set if its set is a surface
  Point3 to;  ///< a point of the other set near it
};

/// Are both distances of a deviation at most the threshold, or is one greater?
enum class DeviationVerdict : std::uint8_t { within, exceeds, undecided };
[[nodiscard]] SNUG_API const char* name_of(DeviationVerdict verdict);

/// How far a limit surface and a candidate meant to replace it deviate from each other.
struct Deviation {
  OneSidedDistance from_surface;    ///< from points of the surface to the candidate
  OneSidedDistance from_candidate;  ///< from points of the candidate to the surface
  /// With `solid`: from the candidate's points inside, and from those outside; 0 if there are none.
  std::optional<OneSidedDistance> inside{}, outside{};
  std::optional<DeviationVerdict> verdict{};  ///< with a threshold; proved unless undecided
  /// `complete` if each interval is as narrow as requested or, with a threshold, each comparison is decided.
  Outcome outcome = Outcome::complete;
};

/// The two one-sided Hausdorff distances between a limit surface and any triangles: in any order and
/// orientation, open, crossing each other, degenerate.
///
/// Guarantee: each interval contains the exact distance for the given doubles, whatever the outcome.
/// Budget:    50,000,000 parts compared in each direction; 100 bytes each at most, and 100 MB.
/// Errors:    InputError: (value) without triangles, for a corner that is not finite, a negative threshold, or a precision that is
///            not positive or below 2^-38 of the largest coordinate; (refused) if no face of the mesh has a limit surface, and with
///            `solid` if it is not closed; (unrepresentable) if a result does not fit a double. Interrupted.
/// Cost:      grows with triangles and patches, and with the square root of size over precision: see
///            bench/results/deviation.txt. 400 bytes a triangle.
/// Source:    derivations/deviation.md.
[[nodiscard]] SNUG_API Deviation deviation(const Surface& surface, std::span<const Triangle> candidate,
                                           const DeviationOptions& options = {}, const Run& run = {});

/// The same between two limit surfaces.
[[nodiscard]] SNUG_API Deviation deviation(const Surface& surface, const Surface& candidate,
                                           const DeviationOptions& options = {}, const Run& run = {});

}  // namespace snug
