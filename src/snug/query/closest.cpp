#include <snug/query/closest.h>

#include <algorithm>
#include <cmath>

#include <snug/base/error.h>
#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>
#include <snug/search/point_batch.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// Squares of the distance, in sizes of the surface, stay well inside single precision.
constexpr double farthest_point = 0x1p40;
// Bounds of gaps err by some hundred roundings of coordinates.
constexpr double noise = 0x1p-45;

struct Candidate {
  Node node;
  float gap;
};

bool farther(const Candidate& x, const Candidate& y) { return x.gap > y.gap; }

class Query {
 public:
  Query(SurfaceWorkspace& scratch, const Point3& to, const ClosestOptions& options,
        const WorkMonitor& monitor)
      : scratch_(scratch),
        surface_(scratch.model().surface()),
        to_(surface_.scale().apply(to)),
        options_(options),
        monitor_(monitor),
        bounds_(surface_.scale().apply(options.absolute) * (1 - 2 * unit_roundoff) - underflow_error,
                options.relative, noise * (2 + max_abs(to_ - Point3{}))) {
    if (!(max_abs(to_ - Point3{}) <= farthest_point)) {
      throw InputError(InputProblem::value,
                       "closest: a point is more than 10^12 sizes of the surface away; give nearer points");
    }
    // Scaling a point to units of the surface loses something only where these are far from its own.
    point_error_ =
        surface_.scale().exact(to.x) && surface_.scale().exact(to.y) && surface_.scale().exact(to.z)
            ? 0
            : 2 * underflow_error;
  }

  ClosestPoint run() {
    scratch_.begin();
    thread_local std::vector<Candidate> heap;
    heap.assign(1, {scratch_.root(), 0});
    while (!heap.empty()) {
      std::pop_heap(heap.begin(), heap.end(), farther);
      const Candidate candidate = heap.back();
      heap.pop_back();
      const double gap = static_cast<double>(candidate.gap);
      if (gap >= bounds_.enough() || !visit(candidate, heap)) {
        bounds_.settle(gap);
        break;
      }
    }
    return result();
  }

 private:
  // False when the budget ends.
  bool visit(const Candidate& candidate, std::vector<Candidate>& heap) {
    const Node node = candidate.node;
    double gap = static_cast<double>(candidate.gap);
    if (node.piece) {
      monitor_.checkpoint();
      gap = std::max(gap, look_at(scratch_.piece(node)));
      if (gap >= bounds_.enough() || !scratch_.can_open(node)) {
        bounds_.settle(gap);
        return true;
      }
    }
    if (splits_ >= options_.budget || scratch_.full()) return false;
    splits_ += node.piece;
    const SurfaceWorkspace::Opened opened = scratch_.open(node);
    const Blocks& blocks = scratch_.blocks(opened.piece);
    Blocks::Distances found;
    blocks.distances(opened.block, to_, point_error_, found);
    for (std::size_t i = 0; i < blocks.count(opened.block); ++i) {
      const float least = std::max({found[i], single_down(gap), 0.0F});
      if (static_cast<double>(least) >= bounds_.enough()) {
        bounds_.settle(static_cast<double>(least));
        continue;
      }
      heap.push_back({{opened.block, static_cast<std::uint8_t>(i), opened.piece}, least});
      std::push_heap(heap.begin(), heap.end(), farther);
    }
    return true;
  }

  // A lower bound of the distance of a piece; evaluates the limit point where its base triangle is nearest.
  double look_at(PieceId id) {
    const Piece& piece = scratch_.pieces()[id];
    const NearestTriangles near = nearest({to_, to_, to_}, piece.offset.base);
    double gap =
        rounded_down(near.certain_distance - enlarged(piece.offset.radius + spatial_error(point_error_)));
    if (near.certain_distance < bounds_.upper()) {
      const TriangleParameter at = clamped(near.on_b);
      const LimitPoint limit = limit_point(piece.patch, at);
      const Point3 point = piece.patch.origin + limit.relative;
      const double error = limit.error + unit_roundoff * max_abs(point - Point3{});
      const Vector3 between = point - to_;
      // Not enlarged(): of a point far away that would be more than all else.
      const double upper = (std::sqrt(length_sq(between) + 8 * underflow_error) +
                            spatial_error(error + point_error_) + 8 * unit_roundoff * max_abs(between)) *
                           (1 + 16 * unit_roundoff);
      if (upper < bounds_.upper()) {
        bounds_.found(upper);
        point_ = point;
        error_ = error;
        at_ = place_of(surface_, piece.root, to_face(piece.patch.path, at));
      }
    }
    // A plane between the point and the piece's hull, across the direction of the closest point so far.
    if (gap < bounds_.enough()) gap = std::max(gap, plane_gap(id, point_ - to_));
    return gap;
  }

  [[nodiscard]] double plane_gap(PieceId id, const Vector3& direction) {
    const Vector3 w = normalized(direction);
    if (w == Vector3{}) return 0;
    const HullPoints& hull = scratch_.pieces().hull(id);
    const Slab slab = outer_slab(hull, w);
    const Vector3 from = hull.origin - to_;
    const double reach = max_abs(from) + hull.largest;
    return (slab.lower + dot(w, from)) * (1 - 16 * unit_roundoff) - 32 * unit_roundoff * reach -
           spatial_error(point_error_) - 16 * underflow_error;
  }

  ClosestPoint result() const {
    const PowerOfTwo back = surface_.scale().inverse();
    ClosestPoint answer;
    answer.lower = unscaled_down(std::max(0.0, bounds_.lower()), back);
    answer.upper = require_representable(unscaled_up(bounds_.upper(), back));
    answer.reached = near_enough(answer.lower, answer.upper, options_);
    answer.point = require_representable(back.apply(point_));
    answer.point_error = unscaled_up(enlarged(error_), back) + underflow_error;
    answer.at = at_;
    return answer;
  }

  SurfaceWorkspace& scratch_;
  const LimitSurface& surface_;
  Point3 to_;
  const ClosestOptions& options_;
  const WorkMonitor& monitor_;
  DistanceBounds bounds_;
  double point_error_ = 0;
  Point3 point_;
  double error_ = 0;
  SurfaceParameter at_{};
  std::uint64_t splits_ = 0;
};

}  // namespace

ClosestPoint closest_point(SurfaceWorkspace& scratch, const Point3& to, const ClosestOptions& options,
                           const WorkMonitor& monitor) {
  if (!is_finite(to)) {
    throw InputError(InputProblem::value,
                     "closest: a coordinate of the point is not finite; give three numbers");
  }
  require_precision(options);
  return Query(scratch, to, options, monitor).run();
}

std::vector<ClosestPoint> closest_points(const SurfaceBvh& model, std::span<const Point3> to,
                                         const ClosestOptions& options, int threads,
                                         const WorkMonitor& monitor) {
  std::vector<ClosestPoint> results(to.size());
  for_each_point(model, to, threads, monitor, [&](SurfaceWorkspace& scratch, std::size_t i) {
    results[i] = closest_point(scratch, to[i], options, monitor);
  });
  return results;
}

}  // namespace snug
