#pragma once

#include <snug/collide.h>

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
/// Errors:    InputError: (value) for a precision that is negative or not finite; (unrepresentable) if a
///            result does not fit a double; (refused) if no face of a mesh has a limit surface, and with
///            `solid` if a surface is not closed. Interrupted.
/// Cost:      about 200 microseconds at 0.1 % of the size (bench/results/distance.txt).
[[nodiscard]] SNUG_API Distance distance(const PlacedSurface& a, const PlacedSurface& b,
                                         const DistanceOptions& options = {}, const Run& run = {});
/// The same bits for many poses, in the same order.
[[nodiscard]] SNUG_API std::vector<Distance> distance(const Surface& a, const Surface& b,
                                                      std::span<const PosePair> poses,
                                                      const DistanceOptions& options = {},
                                                      const Run& run = {});

/// A limit point close to the closest one, in mesh units. It is at most distance.upper away, and `at` is set.
struct ClosestPoint : LimitPoint {
  Interval distance{};  ///< contains the exact distance
  Outcome outcome = Outcome::complete;
};

/// The point of a limit surface closest to a given point.
///
/// Guarantee: `distance` contains the exact distance, and some limit point is at most its upper end away,
///            whatever the outcome. The result depends on the input alone.
/// Budget:    1,000,000 splits for each point; 200 bytes each.
/// Errors:    InputError: (value) for a point that is not finite or more than 10^12 sizes of the surface
///            away, and for a precision that is negative or not finite; (refused) if no face of the mesh has
///            a limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      about 10 microseconds at 0.1 % of the size, about 100 at 1e-9 (bench/results/distance.txt).
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
/// Guarantee: the answer is right. It is empty if this cannot be decided: on the surface and within rounding
///            of it.
/// Errors:    InputError: (refused) for a surface that is not closed; (value) for a point that is not finite.
///            Interrupted.
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

}  // namespace snug
