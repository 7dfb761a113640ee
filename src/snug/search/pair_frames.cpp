#include <snug/search/pair_frames.h>

#include <algorithm>
#include <cmath>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>

namespace snug {

PowerOfTwo joint_scale(const PlacedBvh& a, const PlacedBvh& b) {
  // Surfaces are at most 2 in their own scales.
  const int exponent = std::max(-a.model.surface().scale().exponent(), -b.model.surface().scale().exponent());
  const double t = std::max(max_abs(a.pose.offset()), max_abs(b.pose.offset()));
  const PowerOfTwo scale(-exponent);
  return scale.apply(t) < 2 ? scale : PowerOfTwo(-std::max(exponent, std::ilogb(t)));
}

PlacedFrame frame_of(const PlacedBvh& placed, PowerOfTwo world) {
  const Motion& pose = placed.pose;
  return {.rows = {pose.row(0), pose.row(1), pose.row(2)},
          .scale = (placed.model.surface().scale().inverse() * world).apply(1.0),
          .translation = world.apply(pose.offset()),
          .defect = pose.defect()};
}

PairFrames::PairFrames(const PlacedBvh& a, const PlacedBvh& b)
    : workspace_{&a.scratch, &b.scratch},
      world_(joint_scale(a, b)),
      frame_{frame_of(a, world_), frame_of(b, world_)} {
  require_value(&a.scratch != &b.scratch && &a.scratch.model() == &a.model && &b.scratch.model() == &b.model,
                "pair of models: each needs a scratch of its own, made for it");
  for (SurfaceWorkspace* workspace : workspace_) workspace->begin();
}

double PairFrames::length_down(double mesh_units) const {
  return world_.apply(mesh_units) * (1 - 2 * unit_roundoff) - underflow_error;
}

double PairFrames::length_up(double mesh_units) const {
  const double x = world_.apply(mesh_units);
  return world_.exact(mesh_units) ? x : x * (1 + 2 * unit_roundoff) + underflow_error;
}

void PairFrames::look_along(const Vector3& direction) {
  const std::array<Vector3, 3>& rows = frame_[0].rows;
  static_cast<void>(view(0));
  view_[0].look_along(direction.x * rows[0] + direction.y * rows[1] + direction.z * rows[2]);
}

}  // namespace snug
