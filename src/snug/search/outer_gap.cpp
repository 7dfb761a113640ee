#include <snug/search/outer_gap.h>

#include <array>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/search/pair_frames.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// A placed surface as a k-DOP, in some units: `to_units` leads there from its own.
struct Outline {
  const Dop26& dop;
  std::array<Vector3, 3> rows;
  double to_units;
  Point3 centre;  // of the k-DOP, placed
  double size;    // of what was summed up for it

  Outline(const PlacedBvh& model, PowerOfTwo units)
      : dop(model.model.tree().dop()),
        rows{model.pose.row(0), model.pose.row(1), model.pose.row(2)},
        to_units((model.model.surface().scale().inverse() * units).apply(1.0)) {
    const Vector3 local = to_units * (model.model.tree().box().centre - Point3{});
    const Vector3 translation = units.apply(model.pose.offset());
    centre =
        Point3{} + (Vector3{dot(rows[0], local), dot(rows[1], local), dot(rows[2], local)} + translation);
    size = 2 * max_abs(local) + max_abs(translation) + to_units * dop.radius();
  }
  // Upper bound, but for roundings, of dot(direction, x - centre) over the surface.
  [[nodiscard]] double reach(const Vector3& direction) const {
    return to_units * dop.reach(direction.x * rows[0] + direction.y * rows[1] + direction.z * rows[2]);
  }
};

// Far enough from the ends of the range for squares and products of three.
bool tame(double x) { return x > 0x1p-300 && x < 0x1p300; }

// A lower bound of the distance along the line between the middles, in some units; not positive where none shows. NaN where
// numbers come near the ends of the range in these units.
double gap_between(const PlacedBvh& a, const PlacedBvh& b, PowerOfTwo units) {
  const Outline one(a, units), other(b, units);
  const Vector3 between = other.centre - one.centre;
  const double apart_sq = length_sq(between), apart = std::sqrt(apart_sq);
  if (!tame(apart)) return NAN;
  const double gap = (apart_sq - (one.reach(between) + other.reach(-between))) / apart;
  return gap - 32 * unit_roundoff * (apart + one.size + other.size);
}

}  // namespace

double outer_gap(const PlacedBvh& a, const PlacedBvh& b) {
  if (const double gap = gap_between(a, b, PowerOfTwo()); !std::isnan(gap)) return gap;
  const PowerOfTwo world = joint_scale(a, b);
  const double gap = gap_between(a, b, world);
  return gap > 0 ? unscaled_down(gap, world.inverse()) : -INFINITY;
}

}  // namespace snug
