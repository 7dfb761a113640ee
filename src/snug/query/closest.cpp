#include <snug/query/closest.h>
#include <snug/search/workspace.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <snug/certificate/certify.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/search/point_batch.h>
#include <snug/search/precision.h>
#include <snug/search/winding.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/ordering.h>
#include <support/run.h>

namespace snug {
namespace {

// Bounds of gaps err by some hundred roundings of coordinates.
constexpr double point_noise = 0x1p-45;

// A query point in units of the surface.
struct QueryPoint {
  QueryPoint(const LimitSurface& surface, const Point3& point, const char* query) {
    if (!is_finite(point)) {
      throw InputError(InputProblem::value,
                       std::string(query) + ": a coordinate of the point is not finite; give three numbers");
    }
    const PowerOfTwo scale = surface.scale();
    at = scale.apply(point);
    // Scaling loses something only where the units are far from the point's own.
    error = scale.exact(point.x) && scale.exact(point.y) && scale.exact(point.z) ? 0 : 2 * underflow_error;
    // Squares of its distance, in sizes of the surface, stay well inside single precision.
    tame = max_abs(at - Point3{}) <= 0x1p40;
  }

  Point3 at;
  double error;  // upper bound, a coordinate
  bool tame;
};

class ClosestSearch {
 public:
  ClosestSearch(SurfaceWorkspace& workspace, const QueryPoint& to, const Precision& options, const Run& run)
      : workspace_(workspace),
        surface_(workspace.model().surface()),
        to_(to.at),
        point_error_(to.error),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::closest_point)),
        bounds_(surface_.scale().apply(*options.absolute) * (1 - 2 * unit_roundoff) - underflow_error,
                *options.relative, point_noise * (2 + max_abs(to_ - Point3{}))),
        coarse_(surface_.scale().apply(*options.absolute) > 0x1p-16 * (4 + max_abs(to_ - Point3{}))) {}

  ClosestPoint run() {
    workspace_.begin();
    make_room();
    add({workspace_.root(), 0});
    while (waiting_ > 0) {
      const NodeGap nearest = take_next();
      const double gap = static_cast<double>(nearest.gap);
      if (gap >= bounds_.prune_distance()) {
        bounds_.prune(gap);
      } else if (!visit(nearest.node, gap)) {
        bounds_.prune(gap);
        break;
      }
    }
    for (std::size_t i = 0; i < waiting_; ++i) bounds_.prune(static_cast<double>(open_[i].gap));
    return result();
  }

 private:
  // What waits: depth first, or the nearest of all first, which takes longer for each and has fewer pieces to split.
  void make_room() {
    if (open_.size() < waiting_ + WideNode::width) open_.resize(2 * (waiting_ + WideNode::width));
  }
  void add(const NodeGap& node) {
    open_[waiting_++] = node;
    if (!coarse_) ordering::push_heap(open_.data(), waiting_, farther);
  }
  NodeGap take_next() {
    if (!coarse_) ordering::pop_heap(open_.data(), waiting_, farther);
    return open_[--waiting_];
  }
  static bool farther(const NodeGap& x, const NodeGap& y) { return x.gap > y.gap; }

  // False when the budget ends.
  bool visit(const Node& node, double gap) {
    if (node.bounded()) {
      monitor_.checkpoint();
      const PieceBounds& record = SurfaceWorkspace::bounds_of(node);
      gap = std::max(gap, gap_of(node, record));
      const bool last = !SurfaceWorkspace::can_open(node);
      if (last && gap < bounds_.prune_distance()) {
        // Single precision is what is left of it.
        gap = std::max(gap, look_at(node, workspace_.piece(node).offset));
      }
      if (gap >= bounds_.prune_distance() || last) {
        bounds_.prune(gap);
        return true;
      }
    }
    if (splits_ >= max_splits_ || workspace_.full()) {
      budget_spent_ = splits_ >= max_splits_;
      return false;
    }
    splits_ += node.bounded();
    const SurfaceWorkspace::Opened opened = workspace_.open(node);
    WideNode::Distances gaps;
    const auto most = static_cast<float>(bounds_.prune_distance());
    const WideNode::Near near = opened.boxes->distances(to_, point_error_, most, gaps);
    bounds_.prune(static_cast<double>(near.others));
    const float parent = std::max(single_down(gap), 0.0F);
    if (near.places == 0) return true;
    make_room();
    auto nearest = static_cast<std::size_t>(std::countr_zero(near.places));
    for (std::uint32_t rest = near.places & (near.places - 1); rest != 0; rest &= rest - 1) {
      auto place = static_cast<std::size_t>(std::countr_zero(rest));
      if (gaps[place] < gaps[nearest]) std::swap(place, nearest);
      add({opened.child(place), std::max(gaps[place], parent)});
    }
    add({opened.child(nearest), std::max(gaps[nearest], parent)});
    return true;
  }

  // A lower bound of the distance of a piece: by its quadratic in single precision, which improves the upper one, too, unless
  // roundings are a notable part of the precision, as they are for points far away.
  double gap_of(const Node& node, const PieceBounds& record) {
    if (coarse_ && record.radius() < INFINITY) {
      const auto [lower, upper, at, rounding] = record.distance(to_ - node.boxes->origin());
      if (8 * rounding <= bounds_.precision()) {
        const double doubt = enlarged(record.error() + 2 * spatial_error(point_error_) +
                                      4 * unit_roundoff * max_abs(to_ - Point3{}));
        if (upper + doubt < bounds_.upper()) {
          bounds_.reduce_upper(upper + doubt);
          nearest_ = OnQuadratic{node, at};
        }
        return lower - doubt;
      }
    }
    return look_at(node, {record.base(node.boxes->origin()), record.radius()});
  }

  // A lower bound of the distance of a piece; evaluates the limit point where its base triangle is nearest.
  double look_at(const Node& node, const OffsetTriangle& offset) {
    const NearestTriangles near = nearest({to_, to_, to_}, offset.base);
    double gap = rounded_down(near.certain_distance - enlarged(offset.radius + spatial_error(point_error_)));
    if (near.certain_distance < bounds_.upper()) {
      take(node, clamped(near.on_b));
    }
    // A plane between the point and the quadratic, across the direction of the closest point so far.
    if (gap < bounds_.prune_distance()) gap = std::max(gap, plane_gap(node, closest_.position - to_));
    return gap;
  }

  // The limit point at a parameter, if none as near is known.
  void take(const Node& node, TriangleParameter at) {
    const Patch& patch = workspace_.patch(node);
    const BoundedPoint found = limit_point(patch, at).from(patch.origin);
    const Vector3 between = found.position - to_;
    // Not enlarged(): of a point far away that would be more than all else.
    const double upper = (std::sqrt(length_sq(between) + 8 * underflow_error) +
                          spatial_error(found.error + point_error_) + 8 * unit_roundoff * max_abs(between)) *
                         (1 + 16 * unit_roundoff);
    if (!(upper < closest_distance_)) return;
    closest_distance_ = upper;
    bounds_.reduce_upper(upper);
    closest_ = found;
    at_ = place_of(surface_, workspace_.root_of(node), to_face(patch.path, at));
  }

  [[nodiscard]] double plane_gap(const Node& node, const Vector3& direction) {
    const Vector3 w = normalized(direction);
    if (w == Vector3{}) return 0;
    const PieceBounds& record = SurfaceWorkspace::bounds_of(node);
    const Vector3 from = node.boxes->origin() - to_;
    const double gap = dot(w, from) - record.extent(-w) - enlarged(record.error());
    // |w| is 1 up to 5 roundings.
    return gap * (1 - 16 * unit_roundoff) - 16 * unit_roundoff * max_abs(from) - spatial_error(point_error_) -
           16 * underflow_error;
  }

  ClosestPoint result() {
    if (nearest_ && bounds_.upper() < closest_distance_) take(nearest_->node, nearest_->at);
    const PowerOfTwo back = surface_.scale().inverse();
    const Interval distance{unscaled_down(std::max(0.0, bounds_.lower()), back),
                            require_representable(unscaled_up(bounds_.upper(), back))};
    const BoundedPoint closest = unscaled(closest_, back);
    return {{closest.position, closest.error, at_},
            distance,
            outcome_of(near_enough(distance, options_), budget_spent_)};
  }

  SurfaceWorkspace& workspace_;
  const LimitSurface& surface_;
  Point3 to_;
  double point_error_;
  const Precision& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  DistanceBounds bounds_;
  bool coarse_;                                        // far above the roundings of single precision
  std::vector<NodeGap>& open_ = workspace_.waiting();  // the first of them wait
  std::size_t waiting_ = 0;
  // Where a quadratic came nearest that is known to be nearer than the point.
  struct OnQuadratic {
    Node node;
    TriangleParameter at;
  };
  std::optional<OnQuadratic> nearest_;
  BoundedPoint closest_;
  double closest_distance_ = INFINITY;
  Place at_{};
  std::uint64_t splits_ = 0;
  bool budget_spent_ = false;
};

}  // namespace

ClosestPoint closest_point(SurfaceWorkspace& workspace, const Point3& to, const Precision& options,
                           const Run& run) {
  const LimitSurface& surface = workspace.model().surface();
  const QueryPoint asked(surface, to, "closest");
  const Precision wanted = with_precision(options, surface.size());
  require_value(asked.tame,
                "closest: a point is more than 10^12 sizes of the surface away; give closer points");
  return ClosestSearch(workspace, asked, wanted, run).run();
}

std::optional<bool> contains(SurfaceWorkspace& workspace, const Point3& point, const Run& run) {
  const SurfaceBvh& model = workspace.model();
  const QueryPoint asked(model.surface(), point, "contains");
  static_cast<void>(model.solid());
  workspace.begin();
  if (!asked.tame) return false;
  const std::optional<int> number =
      winding_number(workspace, asked.at, spatial_error(asked.error), monitor_of(run));
  return number ? std::optional(*number != 0) : std::nullopt;
}

SignedDistance signed_distance(SurfaceWorkspace& workspace, const Point3& point, const Precision& options,
                               const Run& run) {
  const SurfaceBvh& model = workspace.model();
  static_cast<void>(model.solid());
  SignedDistance answer;
  answer.nearest = closest_point(workspace, point, options, run);
  const ClosestPoint& nearest = answer.nearest;
  const std::optional<bool> inside = contains(workspace, point, run);
  answer.distance = {inside == false ? nearest.distance.lower : -nearest.distance.upper,
                     inside == true ? -nearest.distance.lower : nearest.distance.upper};
  const bool narrow =
      inside.has_value() || near_enough(answer.distance, with_precision(options, model.surface().size()));
  answer.outcome = worse(nearest.outcome, outcome_of(narrow, false));
  return answer;
}

ClosestPoint closest_point(const Surface& surface, const Point3& to, const Precision& options,
                           const Run& run) {
  const ClosestPoint found = closest_point(workspace_of(run).pieces().of(surface), to, options, run);
  certify(run, surface, {&to, 1}, {&found, 1});
  return found;
}

std::vector<ClosestPoint> closest_point(const Surface& surface, std::span<const Point3> to,
                                        const Precision& options, const Run& run) {
  std::vector<ClosestPoint> results(to.size());
  for_each_point(surface, to, run, [&](SurfaceWorkspace& workspace, std::size_t i) {
    results[i] = closest_point(workspace, to[i], options, run);
  });
  certify(run, surface, to, results);
  return results;
}

std::optional<bool> contains(const Surface& surface, const Point3& point, const Run& run) {
  const std::optional<bool> inside = contains(workspace_of(run).pieces().of(surface), point, run);
  certify(run, surface, {&point, 1}, {&inside, 1});
  return inside;
}

std::vector<std::optional<bool>> contains(const Surface& surface, std::span<const Point3> points,
                                          const Run& run) {
  static_cast<void>(surface.data()->bvh().solid());
  std::vector<std::optional<bool>> results(points.size());
  for_each_point(surface, points, run, [&](SurfaceWorkspace& workspace, std::size_t i) {
    results[i] = contains(workspace, points[i], run);
  });
  certify(run, surface, points, results);
  return results;
}

SignedDistance signed_distance(const Surface& surface, const Point3& point, const Precision& options,
                               const Run& run) {
  const SignedDistance found = signed_distance(workspace_of(run).pieces().of(surface), point, options, run);
  certify(run, surface, {&point, 1}, {&found, 1});
  return found;
}

std::vector<SignedDistance> signed_distance(const Surface& surface, std::span<const Point3> points,
                                            const Precision& options, const Run& run) {
  static_cast<void>(surface.data()->bvh().solid());
  std::vector<SignedDistance> results(points.size());
  for_each_point(surface, points, run, [&](SurfaceWorkspace& workspace, std::size_t i) {
    results[i] = signed_distance(workspace, points[i], options, run);
  });
  certify(run, surface, points, results);
  return results;
}

}  // namespace snug
