#include <snug/query/moving_pair.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <snug/run.h>
#include <support/error.h>

namespace snug {
namespace {

// Larger ones leave no room for sums.
constexpr double largest_place = 0x1p1000;

[[noreturn]] void refuse_range() {
  throw InputError(InputProblem::unrepresentable,
                   "time of contact: places or velocities of control points do not fit doubles; scale the "
                   "meshes and the motion down");
}

// Around the place of a point by any pose within the errors of this one.
Box3 placed_box(const BoundedPose& pose, const Point3& p) {
  const auto number = [&](std::size_t k) {
    const double exact = pose.pose.numbers()[k], error = pose.error[k];
    return error == 0 ? Interval(exact) : Interval(rounded_down(exact - error), rounded_up(exact + error));
  };
  Box3 box;
  for (std::size_t i = 0; i < 3; ++i) {
    Interval sum = number(4 * i + 3);
    for (std::size_t j = 0; j < 3; ++j) sum = sum + number(4 * i + j) * Interval(p[j]);
    box.lower[i] = sum.lower;
    box.upper[i] = sum.upper;
    if (!(sum.lower > -largest_place && sum.upper < largest_place)) refuse_range();
  }
  return box;
}

}  // namespace

std::vector<Point3> points_between(std::span<const Point3> p, std::span<const Point3> q, double s) {
  std::vector<Point3> points(p.size());
  for (std::size_t v = 0; v < p.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) points[v][k] = (1 - s) * p[v][k] + s * q[v][k];
  }
  return points;
}

Deformation::Deformation(const SurfaceBvh& model, PieceCache& scratch, std::span<const Point3> end)
    : model_(model), scratch_(scratch), end_(end) {
  // Says what is wrong with the points.
  surface_.emplace(model.surface(), end);
  const std::span<const Point3> begin = model.surface().mesh().points;
  for (std::size_t v = 0; v < end.size(); ++v) {
    if (model.surface().topology().isolated(VertexId(v))) continue;
    largest_ = std::max({largest_, max_abs(begin[v] - Point3{}), max_abs(end[v] - Point3{})});
    std::array<Interval, 3> way;
    for (std::size_t k = 0; k < 3; ++k) way[k] = Interval(end[v][k]) - Interval(begin[v][k]);
    speed_ = std::max(speed_, length_up(way));
  }
  if (!(speed_ < largest_place)) refuse_range();
}

Deformation::Shape Deformation::at(double s) {
  if (s == 0) return {model_, scratch_, 0};
  if (s != time_) {
    surface_->move(points_between(model_.surface().mesh().points, end_, s));
    if (moved_) {
      moved_->refit(plan_);
      moved_scratch_->renew(*moved_);
    } else {
      moved_.emplace(*surface_, SurfaceBvhOptions{.method = model_.method()}, plan_);
      moved_scratch_.emplace(*moved_);
    }
    time_ = s;
  }
  // 1 - s, two products and a sum: less than 4 u of the larger point, and underflow of each.
  const double error =
      s == 1 ? 0 : enlarged(spatial_error(4 * unit_roundoff * largest_ + 4 * underflow_error));
  return {*moved_, *moved_scratch_, error};
}

MovingBody::MovingBody(const MovingBvh& moving) : moving_(moving) {
  if (!moving.end.empty()) {
    deformation_ = std::make_unique<Deformation>(moving.model, moving.scratch, moving.end);
  }
}

void MovingBody::enter_piece(std::size_t piece) {
  const Trajectory& motion = moving_.motion;
  if (motion.pieces().empty()) {
    piece_.emplace(motion.start());
  } else {
    piece_.emplace(motion.pieces()[piece]);
  }
}

// Points lie between those of both ends, and what bounds the velocity of the motion is convex.
double MovingBody::speed() {
  double result = piece_->speed(moving_.model);
  if (!deforms()) return result;
  if (result > 0) result = std::max(result, piece_->speed(deformation_->at(1).model));
  return enlarged(result + piece_->growth() * deformation_->speed());
}

std::optional<LinearPatches> MovingBody::linear_patches() const {
  // Of a motion that ends in a given pose the rotation may change a little.
  if (!piece_->straight() || (deforms() && !piece_->keeps_rotation())) return std::nullopt;
  const LimitSurface& surface = moving_.model.surface();
  const std::span<const Point3> begin = surface.mesh().points, end = deforms() ? moving_.end : begin;
  const BoundedPose first = piece_->at(0), last = piece_->at(1);
  std::vector<Box3> from(begin.size()), to(begin.size());
  for (std::size_t v = 0; v < begin.size(); ++v) {
    if (surface.topology().isolated(VertexId(v))) continue;
    from[v] = placed_box(first, begin[v]);
    to[v] = placed_box(last, end[v]);
  }
  return LinearPatches(surface, from, to);
}

MovingBody::Place MovingBody::at(double s) {
  const BoundedPose pose = piece_->at(s);
  if (!deforms()) return {{moving_.model, moving_.scratch, 0}, pose};
  return {deformation_->at(s), pose};
}

void require_same_duration(const MovingBvh& a, const MovingBvh& b) {
  const double ends_a = a.motion.duration(), ends_b = b.motion.duration();
  const bool deforms = !a.end.empty() || !b.end.empty();
  const double ends = std::max({ends_a, ends_b, deforms ? 1.0 : 0.0});
  require_value(
      (ends_a == ends || ends_a == 0) && (ends_b == ends || ends_b == 0) && (!deforms || ends == 1),
      "the motions last for different times; let one stay, or both last equally long, one unit of time where "
      "control points move");
}

}  // namespace snug
