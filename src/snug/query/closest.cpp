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
#include <snug/patch/evaluate.h>
#include <snug/search/facet.h>
#include <snug/search/gap.h>
#include <snug/search/point_batch.h>
#include <snug/search/precision.h>
#include <snug/search/winding.h>
#include <snug/surface/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/error.h>
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
  ClosestSearch(PieceCache& cache, const QueryPoint& to, const Precision& options, const Run& run)
      : cache_(cache),
        to_(to),
        options_(options),
        monitor_(monitor_of(run)),
        max_splits_(run.max_splits.value_or(default_splits::closest_point)),
        coarse_(surface().scale().apply(*options.absolute) > 0x1p-16 * (4 + max_abs(to.at - Point3{}))) {}

  ClosestPoint run() {
    cache_.begin();
    // The nearest of all first takes longer for each, and has fewer pieces to split.
    waiting().start(coarse_ ? Order::last_first : Order::nearest_first, {cache_.root(), 0});
    search(waiting(), *this);
    for (const NodeGap& at : waiting().items()) bounds_.prune(static_cast<double>(at.gap));
    return result();
  }

  Verb look_at(const NodeGap& at) {
    gap_ = static_cast<double>(at.gap);
    if (gap_ >= bounds_.prune_distance()) return pruned();
    if (at.node.bounded()) {
      monitor_.checkpoint();
      if (at.node.kind == Node::Kind::patch) {
        const PatchId patch = cache_.name(at.node).patch;
        if (const std::optional<Facet> facet = facet_of(surface(), patch)) {
          look_at_facet(patch, *facet);
          return pruned();
        }
        accept_precision();
      }
      gap_ = std::max(gap_, gap_of(at.node, PieceCache::bounds_of(at.node)));
      if (gap_ >= bounds_.prune_distance()) return pruned();
      if (!PieceCache::can_open(at.node)) {
        // Single precision is what is left of it.
        const OffsetTriangle& offset = cache_.offset(at.node);
        gap_ = std::max(gap_, gap_of_triangle(at.node, offset));
        if (!points_are_elsewhere(at.node, offset.radius)) return pruned();
      }
    }
    if (splits_ < max_splits_ && !cache_.full()) return Verb::open;
    budget_spent_ = splits_ >= max_splits_;
    bounds_.prune(static_cast<double>(at.gap));
    return Verb::stop;
  }
  void open(const NodeGap& at) {
    splits_ += at.node.bounded();
    const PieceCache::Opened opened = cache_.open(at.node);
    WideNode::Distances gaps;
    const auto most = static_cast<float>(bounds_.prune_distance());
    const WideNode::Near near = opened.boxes->distances(to_.at, to_.error, most, gaps);
    bounds_.prune(static_cast<double>(near.others));
    const float parent = std::max(single_down(gap_), 0.0F);
    if (near.places == 0) return;
    auto nearest = static_cast<std::size_t>(std::countr_zero(near.places));
    for (std::uint32_t rest = near.places & (near.places - 1); rest != 0; rest &= rest - 1) {
      auto place = static_cast<std::size_t>(std::countr_zero(rest));
      if (gaps[place] < gaps[nearest]) std::swap(place, nearest);
      waiting().add({opened.child(place), std::max(gaps[place], parent)});
    }
    waiting().add({opened.child(nearest), std::max(gaps[nearest], parent)});
  }

 private:
  Verb pruned() {
    bounds_.prune(gap_);
    return Verb::drop;
  }

  // Facets are compared as exactly as rounding allows, since that costs no more; a patch that bends ends that.
  void accept_precision() {
    bounds_.accept(surface().scale().apply(*options_.absolute) * (1 - 2 * unit_roundoff) - underflow_error,
                   *options_.relative, point_noise * (2 + max_abs(to_.at - Point3{})));
  }

  // Of those that come as near, up to rounding, the one that faces the point is the answer.
  void look_at_facet(PatchId patch, const Facet& facet) {
    const double coordinates = std::max(facet.largest, max_abs(to_.at - Point3{})),
                 off = enlarged(facet.off + 2 * spatial_error(to_.error));
    const PointTriangleDistance found = distance_between(to_.at, facet.triangle, coordinates);
    gap_ = std::max(gap_, found.lower);
    bounds_.loosen(off);
    if (gap_ > bounds_.upper()) return;
    const Facing facing = snug::facing(to_.at, facet.triangle, found.foot);
    if (!(found.upper < closest_.least) && !facing.better_than(closest_.facing)) return;
    const TriangleParameter at = facet.place_of(found.foot);
    const BoundedPoint point = facet.point(at);
    const double upper = distance_at_most(point.position - to_.at, spatial_error(point.error + to_.error));
    bounds_.reduce_upper(upper);
    const PatchPlace place = surface().place(patch);
    closest_ = {point, upper, {place.owner, facet.corner, at.u, at.v}, gap_, facing};
  }

  // A lower bound of the distance of a piece: by its quadratic in single precision, which improves the upper one, too, unless
  // roundings are a notable part of the precision, as they are for points far away.
  double gap_of(const Node& node, const PieceBounds& record) {
    if (coarse_ && record.radius() < INFINITY) {
      const auto [lower, upper, at, rounding] = record.distance(to_.at - node.boxes->origin());
      if (8 * rounding <= bounds_.precision()) {
        const double doubt = enlarged(record.error() + 2 * spatial_error(to_.error) +
                                      4 * unit_roundoff * max_abs(to_.at - Point3{}));
        if (upper + doubt < bounds_.upper()) {
          bounds_.reduce_upper(upper + doubt);
          nearest_ = OnQuadratic{node, at};
        }
        return lower - doubt;
      }
    }
    return gap_of_triangle(node, {record.base(node.boxes->origin()), record.radius()});
  }

  // A lower bound of the distance of a piece; evaluates the limit point where its base triangle is nearest.
  double gap_of_triangle(const Node& node, const OffsetTriangle& offset) {
    const NearestTriangles near = nearest({to_.at, to_.at, to_.at}, offset.base);
    double gap = snug::gap_of(near, offset.radius, spatial_error(to_.error));
    if (near.certain_distance < bounds_.upper()) {
      take(node, clamped(near.on_b));
    }
    // A plane between the point and the quadratic, across the direction of the closest point so far.
    if (gap < bounds_.prune_distance()) {
      gap = std::max(gap, plane_gap(node, closest_.point.position - to_.at));
    }
    return gap;
  }

  // Is the nearest point of a flat piece not where its parameters say, as in a plane quad that is no parallelogram? Parts of it
  // come as near as wanted.
  bool points_are_elsewhere(const Node& node, double radius) {
    const double doubt = 16 * (radius + point_noise * (2 + max_abs(to_.at - Point3{})));
    return gap_ < bounds_.prune_distance() && bounds_.upper() - gap_ > doubt &&
           cache_.name(node).path.level() < PiecePath::max_level;
  }

  // The limit point at a parameter, if none as near is known.
  void take(const Node& node, TriangleParameter at) {
    const Patch& patch = cache_.patch(node);
    const BoundedPoint found = limit_point(patch, at).from(patch.origin);
    const double upper = distance_at_most(found.position - to_.at, spatial_error(found.error + to_.error));
    if (!(upper < closest_.distance)) return;
    bounds_.reduce_upper(upper);
    closest_ = {found, upper, place_of(surface(), cache_.name(node), at), upper};
  }

  // The point of the quadratic there.
  void take_near(const Node& node, TriangleParameter at) {
    const PieceBounds& record = PieceCache::bounds_of(node);
    const Point3 point = node.boxes->origin() + record.at(at);
    const double error = enlarged(record.error() + unit_roundoff * max_abs(point - Point3{}));
    closest_ = {{point, error}, bounds_.upper(), place_of(surface(), cache_.name(node), at), bounds_.upper()};
  }

  [[nodiscard]] double plane_gap(const Node& node, const Vector3& direction) {
    const Vector3 w = normalized(direction);
    if (w == Vector3{}) return 0;
    const PieceBounds& record = PieceCache::bounds_of(node);
    const Vector3 from = node.boxes->origin() - to_.at;
    const double taken = record.extent(-w) + enlarged(record.error_along(w)) - dot(w, from);
    return gap_of_planes(taken) - 16 * unit_roundoff * max_abs(from) - spatial_error(to_.error) -
           16 * underflow_error;
  }

  ClosestPoint result() {
    const PowerOfTwo back = surface().scale().inverse();
    const auto in_mesh_units = [&] {
      return Interval(unscaled_down(std::max(0.0, bounds_.lower()), back),
                      require_representable(unscaled_up(bounds_.upper(), back)));
    };
    if (nearest_ && bounds_.upper() < closest_.distance) {
      // A limit point may be nearer than what is known of it.
      if (options_.witness != WitnessKind::exact && near_enough(in_mesh_units(), options_)) {
        take_near(nearest_->node, nearest_->at);
      } else {
        take(nearest_->node, nearest_->at);
      }
    }
    Interval distance = in_mesh_units();
    // Of several facets that come as near up to rounding, the point is on one.
    distance.upper = std::max(distance.upper, require_representable(unscaled_up(closest_.distance, back)));
    const BoundedPoint closest = unscaled(closest_.point, back);
    return {{closest.position, closest.error, closest_.at},
            distance,
            outcome_of(near_enough(distance, options_), budget_spent_)};
  }

  [[nodiscard]] const LimitSurface& surface() const { return cache_.model().surface(); }
  [[nodiscard]] Frontier<NodeGap>& waiting() { return cache_.open_nodes(); }

  PieceCache& cache_;
  const QueryPoint& to_;
  const Precision& options_;
  const WorkMonitor& monitor_;
  std::uint64_t max_splits_;
  DistanceBounds bounds_{0, 0, 0};
  bool coarse_;     // far above the roundings of single precision
  double gap_ = 0;  // of the node at hand
  // Where a quadratic came nearest that is known to be nearer than the point.
  struct OnQuadratic {
    Node node;
    TriangleParameter at;
  };
  std::optional<OnQuadratic> nearest_;
  // The point of those that were evaluated.
  struct Found {
    BoundedPoint point;
    double distance = INFINITY;  // at most
    Place at{};
    double least = INFINITY;  // at least
    Facing facing{-INFINITY, 0};
  };
  Found closest_;
  std::uint64_t splits_ = 0;
  bool budget_spent_ = false;
};

}  // namespace

ClosestPoint closest_point(PieceCache& cache, const Point3& to, const Precision& options, const Run& run) {
  const LimitSurface& surface = cache.model().surface();
  const QueryPoint asked(surface, to, "closest");
  const Precision wanted = with_precision(options, surface.size());
  require_value(asked.tame,
                "closest: a point is more than 10^12 sizes of the surface away; give closer points");
  return ClosestSearch(cache, asked, wanted, run).run();
}

std::optional<bool> contains(PieceCache& cache, const Point3& point, const Run& run) {
  const SurfaceBvh& model = cache.model();
  const QueryPoint asked(model.surface(), point, "contains");
  static_cast<void>(model.solid());
  cache.begin();
  if (!asked.tame) return false;
  const std::optional<int> number =
      winding_number(cache, asked.at, spatial_error(asked.error), monitor_of(run));
  return number ? std::optional(*number != 0) : std::nullopt;
}

SignedDistance signed_distance(PieceCache& cache, const Point3& point, const Precision& options,
                               const Run& run) {
  const SurfaceBvh& model = cache.model();
  static_cast<void>(model.solid());
  SignedDistance answer;
  answer.nearest = closest_point(cache, point, options, run);
  const ClosestPoint& nearest = answer.nearest;
  const std::optional<bool> inside = contains(cache, point, run);
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
  for_each_point(surface, to, run, [&](PieceCache& cache, std::size_t i) {
    results[i] = closest_point(cache, to[i], options, run);
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
  for_each_point(surface, points, run,
                 [&](PieceCache& cache, std::size_t i) { results[i] = contains(cache, points[i], run); });
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
  for_each_point(surface, points, run, [&](PieceCache& cache, std::size_t i) {
    results[i] = signed_distance(cache, points[i], options, run);
  });
  certify(run, surface, points, results);
  return results;
}

}  // namespace snug
