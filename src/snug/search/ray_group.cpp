#include <snug/search/ray_group.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

using CrossingState = LinePieceCrossing::State;
using kernels::ray_width;

// More than what single precision leaves open of places across a ray.
constexpr double single_doubt = 0x1p-14;

// How far the ends of a ray's part are from those of another, the larger distance.
double apart(const NearPart& a, const Vector3& along_a, const NearPart& b, const Vector3& along_b) {
  const Vector3 middles = b.middle - a.middle, halves = b.half * along_b - a.half * along_a;
  return std::max(length(middles - halves), length(middles + halves));
}

// Of hits that may all be the nearest one, leaves that which ends first, at `end`.
void keep_nearest(const RayTask& task, double end, std::vector<FoundHit>& hits) {
  if (hits.empty()) return;
  double begin = INFINITY;
  for (const FoundHit& hit : hits) {
    if (hit.along.lower <= end) begin = std::min(begin, hit.along.lower);
  }
  const auto first = std::min_element(hits.begin(), hits.end(), [](const FoundHit& x, const FoundHit& y) {
    return x.along.upper < y.along.upper;
  });
  FoundHit nearest = *first;
  nearest.along.lower = begin;
  nearest.reached = task.is_located(nearest.along);
  for (const FoundHit& hit : hits) {
    if (hit.along.lower <= end && hit.side != nearest.side) nearest.side = 0;
  }
  hits.assign(1, nearest);
}

}  // namespace

void FoundHits::sort() {
  std::sort(hits.begin(), hits.end(),
            [](const FoundHit& x, const FoundHit& y) { return x.along.lower < y.along.lower; });
}

NearPart::NearPart(const RayTask& task, const Ball& ball) {
  const Vector3 from = ball.centre - task.origin;
  const double ahead = dot(task.along, from);
  far = max_abs(from);
  const double reach = 1.001 * ball.radius + 0x1p-40 * (1 + far);
  lower = std::max(task.outer.lower, ahead - reach);
  upper = std::min(task.outer.upper, ahead + reach);
  // Past the ball.
  if (length(from - ahead * task.along) > reach) lower = 0, upper = -1;
  if (!bounded() || empty()) return;
  half = (upper - lower) / 2;
  centre = lower + half;
  middle = task.origin + centre * task.along;
  rounding = 0x1p-48 * (1 + far);
}

float NearPart::from_middle(double place) const { return float_up(place - centre + rounding); }

RayGroup::RayGroup(PieceCache& cache, std::span<GroupedRay> rays, const WorkMonitor& monitor)
    : cache_(cache), rays_(rays), monitor_(monitor) {
  const auto set = [](kernels::SeenSegments& in, std::size_t lane, const GroupedRay& ray, double slack) {
    for (std::size_t k = 0; k < 3; ++k) in.direction[k][lane] = static_cast<float>(ray.task->along[k]);
    in.half[lane] = float_up(ray.near.half * (1 + 0x1p-20));
    in.slack[lane] = float_up(ray.near.rounding + slack + 0x1p-118);
  };
  const GroupedRay& middle = rays[rays.size() / 2];
  double wide = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const GroupedRay& ray = rays[i];
    set(segments_, i, ray, 0);
    for (std::size_t k = 0; k < 3; ++k) {
      places_.middle[k][i] = ray.near.middle[k];
      places_.direction[k][i] = ray.task->along[k];
    }
    set_limit(i);
    wide = std::max(
        wide, apart(middle.near, middle.task->along, ray.near, ray.task->along) + 16 * ray.near.rounding);
  }
  set(beam_, 0, middle, enlarged(wide));
}

void RayGroup::set_limit(std::size_t i) {
  const GroupedRay& ray = rays_[i];
  const bool answered = ray.task->query == RayQuery::any && !ray.found->hits.empty();
  const bool lost = ray.task->query == RayQuery::all && ray.failed < INFINITY;
  limits_[i] = answered || lost ? -INFINITY : ray.near.from_middle(std::min(ray.end, ray.failed));
}

void RayGroup::run() {
  NodeRays all{cache_.root(), -INFINITY, (1u << rays_.size()) - 1, {}};
  all.begins.fill(-INFINITY);
  Frontier<NodeRays>& frontier = cache_.open_rays();
  frontier.start(Order::nearest_first, all);
  search(frontier, *this);
  for (GroupedRay& ray : rays_) {
    if (!ray.decided()) ray.found->hits.clear();
    if (ray.task->query == RayQuery::nearest) keep_nearest(*ray.task, ray.end, ray.found->hits);
    ray.found->sort();
  }
}

Verb RayGroup::look_at(const NodeRays& at) {
  left_ = 0;
  float latest = -INFINITY;
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    latest = std::max(latest, limits_[i]);
    if ((at.rays >> i & 1u) != 0 && at.begins[i] <= limits_[i]) left_ |= 1u << i;
  }
  if (at.gap > latest) return Verb::stop;
  if (left_ == 0) return Verb::drop;
  if (!at.node.bounded()) return Verb::open;
  const PieceBounds& record = PieceCache::bounds_of(at.node);
  kernels::place_segments(places_, at.node.boxes->origin(), segments_);
  const kernels::Meeting seen =
      kernels::segments_meeting({record.net(), float_up(record.error()), record.reach()}, segments_);
  left_ &= seen.near;
  const RayTask& task = *rays_.front().task;
  const double small_error = std::max(tube_share / 8 * task.precision, single_doubt),
               largest_error = task.query == RayQuery::any ? INFINITY : task.precision / 2;
  for (std::uint32_t rest = left_; rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::size_t>(std::countr_zero(rest));
    // Nothing is going to prove a hit, or one that is narrow enough: opened without a closer look.
    const double least = (seen.inside >> i & 1u) != 0 ? largest_error : small_error;
    if (!is_to_be_opened(at, i, record.error() > least)) left_ &= ~(1u << i);
  }
  return left_ == 0 ? Verb::drop : Verb::open;
}

// Looks at a piece with one of the rays.
bool RayGroup::is_to_be_opened(const NodeRays& at, std::size_t i, bool in_vain) {
  GroupedRay& ray = rays_[i];
  const RayTask& task = *ray.task;
  monitor_.checkpoint();
  const PieceBounds& record = PieceCache::bounds_of(at.node);
  if (in_vain && ray.splits < quick_splits(task) && PieceCache::can_open(at.node)) {
    ++ray.splits;
    return true;
  }
  if (!ray.frame) ray.frame.emplace(task.origin, task.along);
  const SeenPiece piece(*ray.frame, record, at.node.boxes->origin());
  LinePieceCrossing crossing = piece.crossing({}, 0, task.precision);
  if (crossing.state == CrossingState::none) return false;
  // Its boxes begin there: so it makes no difference which of two pieces is seen first.
  crossing.along.lower =
      std::max(crossing.along.lower, ray.near.centre + static_cast<double>(at.begins[i]) - ray.near.rounding);
  if (crossing.along.lower > ray.end || crossing.along.upper < task.outer.lower) return false;
  const bool hit = crossing.state == CrossingState::one && task.within(crossing.along);
  const auto guard = [&](bool open) {
    set_limit(i);
    return open;
  };
  if (hit) {
    const bool narrow = task.is_located(crossing.along);
    if (narrow || task.query == RayQuery::any) {
      ray.found->hits.push_back(
          {crossing.along, true, narrow, crossing.side, cache_.name(at.node), crossing.at});
    }
    if (task.query == RayQuery::nearest) ray.end = std::min(ray.end, crossing.along.upper);
    if (narrow || task.query == RayQuery::any) return guard(false);
  }
  const double off = crossing.limited_by_errors ? piece.error() : piece.width();
  const bool small = !hit && off <= tube_share / 8 * task.precision;
  if (small || !cache_.can_open_further(at.node) || ray.splits >= quick_splits(task)) {
    ray.failed = std::min(ray.failed, crossing.along.lower);
    return guard(false);
  }
  ++ray.splits;
  return guard(true);
}

void RayGroup::open(const NodeRays& at) {
  const PieceCache::Opened opened = cache_.open(at.node);
  const WideNode& boxes = *opened.boxes;
  kernels::place_segments(places_, boxes.origin(), segments_);
  Frontier<NodeRays>& frontier = cache_.open_rays();
  NodeRays child{};
  std::array<float, kernels::node_width> begins;
  if (std::has_single_bit(left_)) {
    const auto i = static_cast<std::size_t>(std::countr_zero(left_));
    std::uint32_t met = kernels::boxes_met(boxes, segments_, i, begins);
    for (; met != 0; met &= met - 1) {
      const auto c = static_cast<std::size_t>(std::countr_zero(met));
      child.gap = child.begins[i] = std::max(at.begins[i], begins[c]);
      if (child.gap > limits_[i]) continue;
      child.node = opened.child(c);
      child.rays = left_;
      frontier.add(child);
    }
    return;
  }
  const std::size_t middle = rays_.size() / 2;
  for (std::size_t k = 0; k < 3; ++k) beam_.middle[k][0] = segments_.middle[k][middle];
  std::uint32_t near = kernels::boxes_met(boxes, beam_, 0, begins);
  for (; near != 0; near &= near - 1) {
    const auto c = static_cast<std::size_t>(std::countr_zero(near));
    child.rays = kernels::segments_meeting(boxes, c, segments_, child.begins) & left_;
    child.gap = INFINITY;
    for (std::uint32_t rest = child.rays; rest != 0; rest &= rest - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(rest));
      child.begins[i] = std::max(at.begins[i], child.begins[i]);
      if (child.begins[i] > limits_[i])
        child.rays &= ~(1u << i);
      else
        child.gap = std::min(child.gap, child.begins[i]);
    }
    if (child.rays == 0) continue;
    child.node = opened.child(c);
    frontier.add(child);
  }
}

bool lie_close(const GroupedRay& a, const GroupedRay& b, double distance) {
  return apart(a.near, a.task->along, b.near, b.task->along) <= distance;
}

}  // namespace snug
