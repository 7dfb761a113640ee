#include <utility>

#include <snug/evaluate.h>
#include <snug/front/workspace.h>
#include <snug/query/bound.h>
#include <snug/query/closest.h>
#include <snug/query/contacts.h>
#include <snug/query/deviation.h>
#include <snug/query/hull.h>
#include <snug/query/measure.h>
#include <snug/query/pairs.h>
#include <snug/query/ray.h>
#include <snug/query/self.h>
#include <snug/query/subdivide.h>
#include <snug/query/tessellate.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>

/// The public queries: from handles to trees and workspaces, and nothing else.
namespace snug {
namespace {

const LimitSurface& limit(const Surface& surface) { return surface.data()->limit(); }
const SurfaceBvh& bvh(const Surface& surface) { return surface.data()->bvh(); }

// Two placed surfaces with their trees and workspaces.
struct Placed {
  Placed(const PlacedSurface& in_a, const PlacedSurface& in_b, const Workspace::Pieces::Pair& pieces)
      : a{pieces.a.model(), pieces.a, in_a.pose()}, b{pieces.b.model(), pieces.b, in_b.pose()} {}
  Placed(const PlacedSurface& in_a, const PlacedSurface& in_b, Workspace& workspace)
      : Placed(in_a, in_b, workspace.pieces().of(in_a.surface(), in_b.surface())) {}
  PlacedBvh a, b;
};

}  // namespace

Collision collide(const PlacedSurface& a, const PlacedSurface& b, const CollideOptions& options,
                  const WorkMonitor& monitor, Workspace& workspace) {
  const Placed at(a, b, workspace);
  return collide(at.a, at.b, options, monitor);
}

std::vector<Collision> collide(const Surface& a, const Surface& b, std::span<const PosePair> poses,
                               const CollideOptions& options, int threads, const WorkMonitor& monitor) {
  return PairWorkspaces(bvh(a), bvh(b), threads).answers(collide, poses, options, monitor);
}

Penetration penetration(const PlacedSurface& a, const PlacedSurface& b, const PenetrationOptions& options,
                        const WorkMonitor& monitor, Workspace& workspace) {
  const Placed at(a, b, workspace);
  return penetration(at.a, at.b, options, monitor);
}

TimeOfContact time_of_contact(const Surface& a, const Trajectory& motion_a, const Surface& b,
                              const Trajectory& motion_b, const TimeOfContactOptions& options,
                              const WorkMonitor& monitor, Workspace& workspace) {
  return time_of_contact({a, {}, motion_a}, {b, {}, motion_b}, options, monitor, workspace);
}

TimeOfContact time_of_contact(const DeformingSurface& a, const DeformingSurface& b,
                              const TimeOfContactOptions& options, const WorkMonitor& monitor,
                              Workspace& workspace) {
  const Workspace::Pieces::Pair pieces = workspace.pieces().of(a.surface, b.surface);
  const MovingBvh moving_a{pieces.a.model(), pieces.a, a.motion, a.end},
      moving_b{pieces.b.model(), pieces.b, b.motion, b.end};
  return time_of_contact(moving_a, moving_b, options, monitor);
}

Distance distance(const PlacedSurface& a, const PlacedSurface& b, const DistanceOptions& options,
                  const WorkMonitor& monitor, Workspace& workspace) {
  const Placed at(a, b, workspace);
  return distance(at.a, at.b, options, monitor);
}

std::vector<Distance> distance(const Surface& a, const Surface& b, std::span<const PosePair> poses,
                               const DistanceOptions& options, int threads, const WorkMonitor& monitor) {
  return PairWorkspaces(bvh(a), bvh(b), threads).answers(distance, poses, options, monitor);
}

Contacts contacts(const PlacedSurface& a, const PlacedSurface& b, const ContactsOptions& options,
                  const WorkMonitor& monitor, Workspace& workspace) {
  const Placed at(a, b, workspace);
  return contacts(at.a, at.b, options, monitor);
}

ClosestPoint closest_point(const Surface& surface, const Point3& to, const ClosestOptions& options,
                           const WorkMonitor& monitor, Workspace& workspace) {
  return closest_point(workspace.pieces().of(surface), to, options, monitor);
}

std::vector<ClosestPoint> closest_points(const Surface& surface, std::span<const Point3> to,
                                         const ClosestOptions& options, int threads,
                                         const WorkMonitor& monitor) {
  return closest_points(bvh(surface), to, options, threads, monitor);
}

std::optional<bool> contains(const Surface& surface, const Point3& point, const WorkMonitor& monitor,
                             Workspace& workspace) {
  return contains(workspace.pieces().of(surface), point, monitor);
}

std::vector<std::optional<bool>> contains(const Surface& surface, std::span<const Point3> points, int threads,
                                          const WorkMonitor& monitor) {
  return contains(bvh(surface), points, threads, monitor);
}

SignedDistance signed_distance(const Surface& surface, const Point3& point, const ClosestOptions& options,
                               const WorkMonitor& monitor, Workspace& workspace) {
  return signed_distance(workspace.pieces().of(surface), point, options, monitor);
}

std::vector<SignedDistance> signed_distances(const Surface& surface, std::span<const Point3> points,
                                             const ClosestOptions& options, int threads,
                                             const WorkMonitor& monitor) {
  return signed_distances(bvh(surface), points, options, threads, monitor);
}

RayHits trace(const Surface& surface, const Ray& ray, const RayOptions& options, const WorkMonitor& monitor,
              Workspace& workspace) {
  return trace(workspace.pieces().of(surface), ray, options, monitor);
}

std::vector<RayHits> trace(const Surface& surface, std::span<const Ray> rays, const RayOptions& options,
                           int threads, const WorkMonitor& monitor) {
  return trace(bvh(surface), rays, options, threads, monitor);
}

Deviation deviation(const Surface& surface, std::span<const Triangle> candidate,
                    const DeviationOptions& options, const WorkMonitor& monitor) {
  return deviation(bvh(surface), candidate, options, monitor);
}

Deviation deviation(const Surface& surface, const Surface& candidate, const DeviationOptions& options,
                    const WorkMonitor& monitor) {
  return deviation(bvh(surface), bvh(candidate), options, monitor);
}

Hulls hulls(const Surface& surface, const HullOptions& options, const WorkMonitor& monitor) {
  return hulls(bvh(surface), options, monitor);
}

SurfacePoint evaluate(const Surface& surface, const SurfaceParameter& at) {
  return evaluate(limit(surface), at);
}

std::vector<SurfacePoint> evaluate(const Surface& surface, std::span<const SurfaceParameter> at,
                                   int threads) {
  return evaluate(limit(surface), at, threads);
}

double evaluate(const Surface& surface, std::span<const SurfaceParameter> at, const FloatPoints& out,
                int threads) {
  return evaluate(limit(surface), at, out, threads);
}

std::optional<SurfaceNormal> normal_at(const PlacedSurface& surface, const SurfaceParameter& at) {
  const LimitSurface& inside = limit(surface.surface());
  require_value(patch_at(inside, at).has_value(),
                "normal_at: the surface has no such face, corner or parameter; give one that it has");
  return normal_at(inside, at, surface.pose());
}

std::optional<double> limit_to_faces(const Surface& surface, int threads) {
  return limit_to_faces(limit(surface), threads);
}

Measures measure(const Surface& surface, const MeasureOptions& options, const WorkMonitor& monitor) {
  return measure(limit(surface), options, monitor);
}

SelfContact self_contact(const Surface& surface, const SelfContactOptions& options,
                         const WorkMonitor& monitor) {
  return self_contact(limit(surface), options, monitor);
}

ControlMesh subdivided(const Surface& surface, unsigned level, bool limit_positions,
                       const WorkMonitor& monitor) {
  return subdivide(surface.mesh(), limit(surface).options(), level, limit_positions, monitor);
}

Tessellation tessellate(const Surface& surface, const TessellateOptions& options,
                        const WorkMonitor& monitor) {
  return tessellate(limit(surface), options, monitor);
}

}  // namespace snug
