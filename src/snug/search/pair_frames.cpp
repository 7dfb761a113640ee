#include <snug/search/pair_frames.h>

#include <algorithm>
#include <cmath>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// The power of two that brings both placed surfaces, which are at most 2 in their own scales, to about 1.
PowerOfTwo joint_scale(const PlacedBvh& a, const PlacedBvh& b) {
  const int exponent = std::max(-a.model.surface().scale().exponent(), -b.model.surface().scale().exponent());
  const double t = std::max(max_abs(a.pose.offset()), max_abs(b.pose.offset()));
  const PowerOfTwo scale(-exponent);
  return scale.apply(t) < 2 ? scale : PowerOfTwo(-std::max(exponent, std::ilogb(t)));
}

// How a surface is placed, in units of which one mesh unit is `world` many.
PlacedFrame frame_of(const PlacedBvh& placed, PowerOfTwo world) {
  const Motion& pose = placed.pose;
  return {.rows = {pose.row(0), pose.row(1), pose.row(2)},
          .scale = (placed.model.surface().scale().inverse() * world).apply(1.0),
          .translation = world.apply(pose.offset()),
          .defect = pose.defect()};
}

// A placed surface as a k-DOP, in some units.
struct Outline {
  const Dop26& dop;
  PlacedFrame frame;
  Point3 centre;  // of the k-DOP, placed
  double size;    // of what was summed up for it

  Outline(const PlacedBvh& model, PowerOfTwo units)
      : dop(model.model.tree().dop()), frame(frame_of(model, units)) {
    const Vector3 local = frame.scale * (model.model.tree().box().centre - Point3{});
    centre = Point3{} + (times(frame.rows, local) + frame.translation);
    size = 2 * max_abs(local) + max_abs(frame.translation) + frame.scale * dop.radius();
  }
  // Upper bound, but for roundings, of dot(direction, x - centre) over the surface.
  [[nodiscard]] double reach(const Vector3& direction) const {
    return frame.scale * dop.reach(transposed_times(frame.rows, direction));
  }
};

// A lower bound of the distance along the line between the middles, in some units; not positive where none
// shows. NaN where numbers come near the ends of the range in these units.
double gap_between(const PlacedBvh& a, const PlacedBvh& b, PowerOfTwo units) {
  const Outline one(a, units), other(b, units);
  const Vector3 between = other.centre - one.centre;
  const double apart_sq = length_sq(between), apart = std::sqrt(apart_sq);
  // Far enough from the ends for squares and products of three.
  if (!(apart > 0x1p-300 && apart < 0x1p300)) return NAN;
  const double gap = (apart_sq - (one.reach(between) + other.reach(-between))) / apart;
  return gap - 32 * unit_roundoff * (apart + one.size + other.size);
}

}  // namespace

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
  static_cast<void>(view(0));
  view_[0]->look_along(transposed_times(frame_[0].rows, direction));
}

double outer_gap(const PlacedBvh& a, const PlacedBvh& b) {
  if (const double gap = gap_between(a, b, PowerOfTwo()); !std::isnan(gap)) return gap;
  const PowerOfTwo world = joint_scale(a, b);
  const double gap = gap_between(a, b, world);
  return gap > 0 ? unscaled_down(gap, world.inverse()) : -INFINITY;
}

}  // namespace snug
