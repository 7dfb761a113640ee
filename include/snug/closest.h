#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// How narrow the interval of a distance must become, as in DistanceOptions.
struct ClosestOptions {
  std::optional<double> absolute{};  ///< >= 0, mesh units
  std::optional<double> relative{};  ///< >= 0
  std::uint64_t budget = 1'000'000;  ///< most splits for each point; memory: 200 bytes each
};

/// A limit point close to the closest one, in mesh units.
struct ClosestPoint {
  Interval distance;     ///< contains the exact distance; `point` is at most its upper end away
  bool reached = false;  ///< is it as narrow as requested?
  Point3 point;
  double point_error = 0;  ///< upper bound, per coordinate, of |point - limit point at `at`|
  SurfaceParameter at;     ///< where it lies on the surface, rounded to doubles
};

/// The point of a limit surface closest to a given point.
///
/// Guarantee: `distance` contains the exact distance, and some limit point is at most its upper end away,
///            whether the precision is reached or not. The result depends on the input alone.
/// Errors:    InputError: (value) for a point that is not finite or more than 10^12 sizes of the surface
///            away, and for a precision that is negative or not finite; (refused) if no face of the mesh has
///            a limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      about 10 microseconds at 0.1 % of the size, about 100 at 1e-9 (bench/results/distance.txt).
[[nodiscard]] SNUG_API ClosestPoint closest_point(const Surface& surface, const Point3& to,
                                                  const ClosestOptions& options = {},
                                                  const WorkMonitor& monitor = {},
                                                  Workspace& workspace = Workspace::of_this_thread());
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<ClosestPoint> closest_points(const Surface& surface,
                                                                std::span<const Point3> to,
                                                                const ClosestOptions& options = {},
                                                                int threads = 0,
                                                                const WorkMonitor& monitor = {});

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
                                                    const WorkMonitor& monitor = {},
                                                    Workspace& workspace = Workspace::of_this_thread());
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<std::optional<bool>> contains(const Surface& surface,
                                                                 std::span<const Point3> points,
                                                                 int threads = 0,
                                                                 const WorkMonitor& monitor = {});

/// How far a point is from a closed limit surface, negative inside the solid that it bounds, in mesh units.
struct SignedDistance {
  Interval distance;     ///< contains it; contains 0 if inside and outside cannot be told apart
  bool reached = false;  ///< is it as narrow as requested, and the sign proved?
  ClosestPoint nearest;
};

/// The signed distance of a point. Its sign comes from the winding number, never from a normal.
///
/// Guarantee: `distance` contains it, whether the precision is reached or not.
/// Errors, Cost: those of closest_point() and contains().
[[nodiscard]] SNUG_API SignedDistance signed_distance(const Surface& surface, const Point3& point,
                                                      const ClosestOptions& options = {},
                                                      const WorkMonitor& monitor = {},
                                                      Workspace& workspace = Workspace::of_this_thread());
/// The same for many points, in the same order.
[[nodiscard]] SNUG_API std::vector<SignedDistance> signed_distances(const Surface& surface,
                                                                    std::span<const Point3> points,
                                                                    const ClosestOptions& options = {},
                                                                    int threads = 0,
                                                                    const WorkMonitor& monitor = {});

}  // namespace snug
