#include <snug/search/pair_frames.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/surface/unscale.h>
#include <support/error.h>

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

Rows3 rows_of(const Motion& pose) { return {pose.row(0), pose.row(1), pose.row(2)}; }

// How a surface is placed, in units of which one mesh unit is `world` many.
PlacedFrame frame_of(const PlacedBvh& placed, PowerOfTwo world) {
  const Motion& pose = placed.pose;
  return {.rows = rows_of(pose),
          .scale = scale_to(world, placed.model.surface().scale()),
          .translation = world.apply(pose.offset()),
          .defect = pose.defect(),
          .deviation = placed.deviation > 0 ? enlarged(world.apply(placed.deviation)) : 0};
}

// A placed surface as a k-DOP, in units of which one mesh unit is `world` many; `scale` leads there.
struct Outline {
  const Dop26& dop;
  std::array<Vector3, 3> rows;
  double scale;
  Point3 centre;  // of the k-DOP, placed
  double size;    // of what was summed up for it

  Outline(const PlacedBvh& placed, double in_scale, PowerOfTwo world)
      : dop(placed.model.tree().dop()), rows(rows_of(placed.pose)), scale(in_scale) {
    const Vector3 local = scale * (dop.centre() - Point3{}), translation = world.apply(placed.pose.offset());
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

// A placed root box: axes and half sizes in mesh units.
struct PlacedRoot {
  std::array<Vector3, 3> axes;
  Vector3 half;
  Vector3 centre;
  double size;  // of what was summed up for the centre, and of the box

  explicit PlacedRoot(const PlacedBvh& placed) {
    const Obb& box = placed.model.box();
    const Rows3 rows = rows_of(placed.pose);
    for (std::size_t k = 0; k < 3; ++k) axes[k] = times(rows, box.axes[k]);
    half = box.half;
    centre = times(rows, box.centre - Point3{}) + placed.pose.offset();
    size = 4 * max_abs(box.centre - Point3{}) + max_abs(placed.pose.offset()) + half.x + half.y + half.z;
  }
};

// Fifteen axes; ends once one shows more than `enough`.
double gap_of_boxes(const PlacedRoot& a, const PlacedRoot& b, double defects, double enough) {
  const Vector3 between = b.centre - a.centre;
  const double doubt = enlarged((128 * unit_roundoff + 32 * defects) * (max_abs(between) + a.size + b.size)) +
                       16 * underflow_error;
  double along_a[3], along_b[3], cosine[3][3], size[3][3], widest = -INFINITY;
  const auto shows_enough = [&](double along, double far) {
    widest = std::max(widest, std::fabs(along) - far - doubt);
    return widest > enough;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    along_a[i] = dot(a.axes[i], between);
    double far = a.half[i];
    for (std::size_t j = 0; j < 3; ++j) {
      cosine[i][j] = dot(a.axes[i], b.axes[j]);
      size[i][j] = std::fabs(cosine[i][j]);
      far += b.half[j] * size[i][j];
    }
    if (shows_enough(along_a[i], far)) return widest;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    along_b[j] = dot(b.axes[j], between);
    const double far = b.half[j] + a.half.x * size[0][j] + a.half.y * size[1][j] + a.half.z * size[2][j];
    if (shows_enough(along_b[j], far)) return widest;
  }
  // Boxes that lie in each other along all of these are seldom apart along a cross product.
  if (enough < INFINITY && widest < -0.0625 * std::min(max_abs(a.half), max_abs(b.half))) return widest;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double far = a.half[i1] * size[i2][j] + a.half[i2] * size[i1][j] + b.half[j1] * size[i][j2] +
                         b.half[j2] * size[i][j1];
      if (shows_enough(along_a[i2] * cosine[i1][j] - along_a[i1] * cosine[i2][j], far)) return widest;
    }
  }
  return widest;
}

// No rod and no plate, for which the ball says little.
bool is_compact(const SurfaceBvh& model) {
  const Vector3& half = model.box().half;
  return std::min({half.x, half.y, half.z}) > 0.25 * model.ball().radius;
}

}  // namespace

double root_gap(const PlacedBvh& a, const PlacedBvh& b, double enough) {
  const Ball &ball_a = a.model.ball(), &ball_b = b.model.ball();
  const Vector3 centre_a = times(rows_of(a.pose), ball_a.centre - Point3{}),
                centre_b = times(rows_of(b.pose), ball_b.centre - Point3{});
  const Vector3 between = (b.pose.offset() - a.pose.offset()) + (centre_b - centre_a);
  const double apart = length(between), radii = ball_a.radius + ball_b.radius;
  const double defects = a.pose.defect() + b.pose.defect();
  // Beyond, there are no balls, or squares leave the range.
  if (!(apart < 0x1p500 && radii < 0x1p500)) return outer_gap(a, b);
  const double placed = apart + max_abs(a.pose.offset()) + max_abs(b.pose.offset());
  const double own = radii + max_abs(centre_a) + max_abs(centre_b);
  // Centres go where these doubles bring them; only radii grow by what motions lack of rigidity.
  // The last term: squares of what is shorter lose digits to the end of the range.
  const double doubt =
      enlarged(16 * unit_roundoff * placed + 64 * unit_roundoff * own + 8 * defects * radii) + 0x1p-500;
  const double gap = apart - radii - doubt;
  if (gap > enough) return gap;
  // Compact boxes of balls that lie in each other so far are seldom apart.
  const bool deep = gap < -0.75 * std::min(ball_a.radius, ball_b.radius);
  if (enough < INFINITY && deep && is_compact(a.model) && is_compact(b.model)) return gap;
  const double boxes = gap_of_boxes(PlacedRoot(a), PlacedRoot(b), defects, enough);
  return std::isfinite(boxes) ? boxes : -INFINITY;
}

PairFrames::PairFrames(const PlacedBvh& a, const PlacedBvh& b)
    : cache_{&a.scratch, &b.scratch},
      world_(joint_scale(a, b)),
      frame_{frame_of(a, world_), frame_of(b, world_)},
      seen_from_(RelativeFrame::both(frame_[0], frame_[1])) {
  require_value(&a.scratch != &b.scratch && &a.scratch.model() == &a.model && &b.scratch.model() == &b.model,
                "pair of models: each needs a scratch of its own, made for it");
  for (PieceCache* cache : cache_) cache->begin();
}

double PairFrames::length_down(double mesh_units) const {
  return world_.apply(mesh_units) * (1 - 2 * unit_roundoff) - underflow_error;
}

double PairFrames::length_up(double mesh_units) const {
  const double x = world_.apply(mesh_units);
  return world_.exact(mesh_units) ? x : x * (1 + 2 * unit_roundoff) + underflow_error;
}

void PairFrames::look_along(const Vector3& direction) {
  for (std::size_t s = 0; s < 2; ++s) {
    static_cast<void>(view(s));
    view_[s]->look_along(transposed_times(frame_[s].rows, s == 0 ? direction : -direction));
  }
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
