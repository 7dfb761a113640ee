#pragma once

#include <span>

#include <snug/collide.h>
#include <snug/distance.h>
#include <snug/ray.h>
#include <snug/scene.h>

/// Proofs of answers, into run.certificate, if that is given. An answer is a hint for its proof, and nothing else. Those of scenes
/// are declared in scene.h.
namespace snug {

void certify(const Run& run, const PlacedSurface& a, const PlacedSurface& b, const CollideOptions& options,
             const Collision& answer);
void certify(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
             const CollideOptions& options, std::span<const Collision> answers);

void certify(const Run& run, const PlacedSurface& a, const PlacedSurface& b, const DistanceOptions& options,
             const Distance& answer);
void certify(const Run& run, const Surface& a, const Surface& b, std::span<const PosePair> poses,
             const DistanceOptions& options, std::span<const Distance> answers);

void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const ClosestPoint> answers);
void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const SignedDistance> answers);
void certify(const Run& run, const Surface& surface, std::span<const Point3> points,
             std::span<const std::optional<bool>> answers);

void certify(const Run& run, const Surface& surface, std::span<const Ray> rays, RayQuery query,
             std::span<const RayHits> answers);

}  // namespace snug
