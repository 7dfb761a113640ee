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

// From the units of a surface.
double scale_to(PowerOfTwo world, PowerOfTwo own) { return (own.inverse() * world).apply(1.0); }

// How a surface is placed, in units of which one mesh unit is `world` many.
PlacedFrame frame_of(const PlacedBvh& placed, PowerOfTwo world) {
  const Motion& pose = placed.pose;
  return {.rows = {pose.row(0), pose.row(1), pose.row(2)},
          .scale = scale_to(world, placed.model.surface().scale()),
          .translation = world.apply(pose.offset()),
          .defect = pose.defect()};
}

// A placed surface as a k-DOP, in units of which one mesh unit is `world` many; `scale` leads there.
struct Outline {
  const Dop26& dop;
  std::array<Vector3, 3> rows;
  double scale;
  Point3 centre;  // of the k-DOP, placed
  double size;    // of what was summed up for it

  Outline(const PlacedBvh& placed, double in_scale, PowerOfTwo world)
      : dop(placed.model.tree().dop()),
        rows{placed.pose.row(0), placed.pose.row(1), placed.pose.row(2)},
        scale(in_scale) {
    const Vector3 local = scale * (placed.model.tree().box().centre - Point3{}),
                  translation = world.apply(placed.pose.offset());
    centre = Point3{} + (times(rows, local) + translation);
    size = 2 * max_abs(local) + max_abs(translation) + scale * dop.radius();
  }
  // Upper bound, but for roundings, of dot(direction, x - centre) over the surface.
  [[nodiscard]] double reach(const Vector3& direction) const {
    return scale * dop.reach(transposed_times(rows, direction));
  }
};

// A lower bound of the distance along the line between the middles, in their units; not positive where none
// shows. NaN where numbers come near the ends of the range in these units.
double gap_between(const Outline& one, const Outline& other) {
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
  const PowerOfTwo scale_a = a.model.surface().scale(), scale_b = b.model.surface().scale();
  if (scale_a.moderate() && scale_b.moderate()) {
    const double gap = gap_between({a, scale_a.inverse_factor(), {}}, {b, scale_b.inverse_factor(), {}});
    if (!std::isnan(gap)) return gap;
  }
  const PowerOfTwo world = joint_scale(a, b);
  const double gap = gap_between({a, scale_to(world, scale_a), world}, {b, scale_to(world, scale_b), world});
  return gap > 0 ? unscaled_down(gap, world.inverse()) : -INFINITY;
}

}  // namespace snug
