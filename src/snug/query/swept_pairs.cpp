#include <snug/query/swept_pairs.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <support/direction.h>

namespace snug {
namespace {

constexpr std::size_t neither = 2;
// Directions that were normalized and turned are no longer than this.
constexpr double length_slack = 1 + 0x1p-20;
// Base triangles that are nearer for their size are taken in double precision.
constexpr double near_for_single = 0x1p-14;

double radius_of(const Obb& box) { return length(box.half) * length_slack; }

// Upper bound of dot(u, x) over the box, but for roundings.
double reach(const Obb& box, const Vector3& u) {
  double sum = dot(u, box.centre - Point3{});
  for (std::size_t k = 0; k < 3; ++k) sum += box.half[k] * std::fabs(dot(u, box.axes[k]));
  return sum;
}

Point3 point_on(const Triangle& t, Barycentric at) {
  return t[0] + (at.b * (t[1] - t[0]) + at.c * (t[2] - t[0]));
}

// From the first one to the second one, where they are nearest.
Vector3 way_between(const std::array<Triangle, 2>& placed) {
  const NearestTriangles near = nearest(placed[0], placed[1]);
  return point_on(placed[1], near.on_b) - point_on(placed[0], near.on_a);
}

double reach(const OffsetTriangle& triangle, const Vector3& u) {
  double most = -INFINITY;
  for (const Point3& corner : triangle.base) most = std::max(most, dot(u, corner - Point3{}));
  return most;
}

}  // namespace

struct SweptPairs::Step {
  const Sample &first, &middle, &last;
  [[nodiscard]] double half() const {
    return rounded_up(std::max(middle.time - first.time, last.time - middle.time));
  }
};

struct SweptPairs::Pair {
  Nodes nodes;
  std::array<Obb, 2> boxes{};
  std::array<Point3, 2> places{};  // their centres, at the middle
  SweptHeights heights{};
  std::array<OffsetTriangle, 2> triangles{};  // in double precision,
  bool exact = false;                         // if they are taken
  double widest = INFINITY;                   // about what gaps can be at the middle
  bool shown = false;                         // apart along some direction there
};

SweptPairs::SweptPairs(const SweptBody& a, const SweptBody& b, double margin, SearchStats& stats)
    : bodies_{a, b}, margin_(margin), stats_(stats) {
  int exponent = INT_MIN;
  for (const SweptBody& body : bodies_) {
    exponent = std::max(exponent, -body.model.surface().scale().exponent());
    closing_ += body.motion.closing_speed(body.model);
  }
  world_ = PowerOfTwo(-exponent);
  possible_ = world_.moderate();
  for (std::size_t s = 0; s < 2; ++s) {
    const PowerOfTwo own = bodies_[s].model.surface().scale();
    possible_ = possible_ && own.moderate() && (own.inverse() * world_).moderate() &&
                std::isfinite(bodies_[s].model.ball().radius);
    scales_[s] = (own.inverse() * world_).factor();
    motions_[s] = SweptMotion(bodies_[s].motion);
  }
}

SweptPairs::Sample SweptPairs::sample(double time) const {
  Sample result;
  result.time = time;
  std::array<Point3, 2> centres;
  double deviations = 0, radii = 0, roundings = 0;
  std::array<double, 2> turns{};
  for (std::size_t s = 0; s < 2; ++s) {
    const BoundedPose at = bodies_[s].motion.at(time);
    const Ball& ball = bodies_[s].model.ball();
    PlacedFrame& frame = result.frames[s];
    frame = {.rows = {at.pose.row(0), at.pose.row(1), at.pose.row(2)},
             .scale = scales_[s],
             .translation = world_.apply(at.pose.offset()),
             .defect = at.pose.defect()};
    deviations += at.deviation(enlarged(max_abs(ball.centre - Point3{}) + ball.radius));
    centres[s] = at.pose.apply(ball.centre);
    radii += ball.radius * length_slack + 0x1p-40 * length(centres[s] - Point3{});
    roundings += 8 * frame.largest_apply_error();
    double rows = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      rows = std::max(rows, at.error[4 * i] + at.error[4 * i + 1] + at.error[4 * i + 2]);
    }
    turns[s] = enlarged(spatial_error(rows) + bodies_[s].motion.closing_growth() + 16 * unit_roundoff);
  }
  // The difference of S(s) and M(s) counts twice: heights are of S(s), and M(s) is to be separated.
  const double doubt = enlarged(length_slack * (deviations + 2 * closing_));
  const double widest = enlarged(length(centres[1] - centres[0]) + radii);
  result.place_doubt = doubt;
  result.turn_doubt = turns;
  for (std::size_t f = 0; f < 3; ++f) {
    const double turned = f == neither ? 0 : turns[f] * widest;
    result.height_doubt[f] =
        enlarged(world_.apply(doubt + turned + length_slack * margin_) + roundings) + 8 * underflow_error;
  }
  return result;
}

double SweptPairs::clear(double from, double to, double least, std::uint64_t budget,
                         const WorkMonitor& monitor) {
  until_ = from;
  shortest_ = least;
  budget_ = {budget, stats_.splits};
  monitor_ = &monitor;
  if (!possible_) return from;
  for (const SweptBody& body : bodies_) body.scratch.begin();
  clear(sample(from), sample(to), {{bodies_[0].scratch.root(), bodies_[1].scratch.root()}});
  return until_;
}

bool SweptPairs::clear(const Sample& first, const Sample& last, std::vector<Nodes> open_pairs) {
  const double time = first.time + (last.time - first.time) / 2;
  const Sample middle = sample(time);
  const Step step{first, middle, last};
  const bool shortest = last.time - first.time <= shortest_ || time <= first.time || time >= last.time;
  std::vector<Nodes> left;
  while (!open_pairs.empty()) {
    if (spent() >= budget_.most) return false;
    ++budget_.steps;
    monitor_->checkpoint();
    Pair pair = pair_of(open_pairs.back(), step);
    open_pairs.pop_back();
    if (apart(step, pair)) continue;
    if (const std::size_t side = side_to_open(step, pair); side != neither) {
      open(pair.nodes, side, open_pairs);
    } else if (shortest) {
      return false;
    } else {
      left.push_back(pair.nodes);
    }
  }
  if (left.empty()) {
    until_ = last.time;
    return true;
  }
  return clear(first, middle, left) && clear(middle, last, std::move(left));
}

SweptPairs::Pair SweptPairs::pair_of(const Nodes& nodes, const Step& step) {
  Pair pair{.nodes = nodes};
  ++(nodes[0].bounded() && nodes[1].bounded() ? stats_.triangle_tests : stats_.box_tests);
  for (std::size_t s = 0; s < 2; ++s) {
    pair.boxes[s] = nodes[s].boxes->box(nodes[s].place);
    const Obb& box = pair.boxes[s];
    const PowerOfTwo back = bodies_[s].model.surface().scale().inverse();
    pair.places[s] = step.middle.frames[s].apply(box.centre);
    pair.heights.motions[s] = &motions_[s];
    pair.heights.balls[s] = {back.apply(box.centre), back.apply(radius_of(box)) + step.middle.place_doubt};
    pair.heights.centres[s] = world_.inverse().apply(pair.places[s]);
    pair.heights.levers[s] = motions_[s].lever(pair.heights.balls[s]);
    if (motions_[s].is_chain())
      pair.heights.accelerations[s] = motions_[s].moved(pair.heights.balls[s]).acceleration;
  }
  pair.heights.time = step.middle.time;
  pair.heights.half_step = step.half();
  return pair;
}

// An upper bound of dot(w, x) over the set of a node, without the sample's doubt.
double SweptPairs::height(const Sample& at, const Pair& pair, std::size_t side, const Vector3& w) const {
  const PlacedFrame& frame = at.frames[side];
  const Node& node = pair.nodes[side];
  const Vector3 own = transposed_times(frame.rows, w);
  double most = reach(pair.boxes[side], own);
  if (node.bounded()) {
    const PieceBounds& record = PieceCache::bounds_of(node);
    const double of_record = dot(own, node.boxes->origin() - Point3{}) + record.extent(own) +
                             (1 + 2 * frame.defect) * length_slack * record.error();
    most = std::min(most, of_record);
  }
  if (pair.exact) {
    const OffsetTriangle& triangle = pair.triangles[side];
    most = std::min(most, reach(triangle, own) + (1 + 2 * frame.defect) * length_slack * triangle.radius);
  }
  return frame.scale * most + dot(w, frame.translation);
}

// Lower bound of what is between the nodes along w, but for the sample's doubt.
double SweptPairs::gap(const Sample& at, const Pair& pair, const Vector3& w) const {
  return -(height(at, pair, 0, w) + height(at, pair, 1, -w));
}

bool SweptPairs::kept_apart(const Step& step, const Pair& pair, const Vector3& w, std::size_t turns) const {
  const bool stays = turns == neither;
  const Vector3 own = stays ? w : transposed_times(step.middle.frames[turns].rows, w);
  const double doubt = stays ? 0 : step.middle.turn_doubt[turns], half = pair.heights.half_step;
  const double bending = stays ? pair.heights.bending(w, doubt) : pair.heights.bending(w, doubt, turns);
  const double bent = enlarged(world_.apply(enlarged(bending * half * half / 8))) + underflow_error;
  const auto is_apart = [&](const Sample& at) {
    const Vector3 then = stays ? w : times(at.frames[turns].rows, own);
    // Not a number is no gap.
    return gap(at, pair, then) * (1 - 0x1p-40) - at.height_doubt[turns] > bent;
  };
  return bent < pair.widest && is_apart(step.middle) && is_apart(step.first) && is_apart(step.last);
}

bool SweptPairs::apart_along(const Step& step, Pair& pair, const Vector3& direction, std::size_t of) const {
  if (direction == Vector3{}) return false;
  const Vector3 w = dot(direction, pair.places[1] - pair.places[0]) < 0 ? -direction : direction;
  if (pair.widest == INFINITY) {
    if (!(gap(step.middle, pair, w) > 0)) return false;
    pair.shown = true;
  }
  // Nothing is derived for a direction that turns while one surface is moved by a chain.
  const bool chains = motions_[0].is_chain() || motions_[1].is_chain();
  const auto turns = [&](std::size_t side) { return motions_[side].turns() && !chains; };
  if (of != neither) return kept_apart(step, pair, w, turns(of) ? of : neither);
  return kept_apart(step, pair, w, neither) || (turns(0) && kept_apart(step, pair, w, 0)) ||
         (turns(1) && kept_apart(step, pair, w, 1));
}

bool SweptPairs::apart(const Step& step, Pair& pair) {
  if (pair.nodes[0].bounded() && pair.nodes[1].bounded()) {
    return apart_by_triangles(step, pair) || apart_in_double(step, pair);
  }
  std::array<Axes, 2> axes;
  for (std::size_t s = 0; s < 2; ++s) {
    for (std::size_t k = 0; k < 3; ++k) {
      axes[s][k] = times(step.middle.frames[s].rows, pair.boxes[s].axes[k]);
      if (apart_along(step, pair, axes[s][k], s)) return true;
    }
  }
  if (apart_along(step, pair, normalized(pair.places[1] - pair.places[0]), neither)) return true;
  for (std::size_t i = 0; i < 3 && !pair.shown; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector3 across = cross(axes[0][i], axes[1][j]);
      if (length(across) > 0x1p-10 && apart_along(step, pair, normalized(across), neither)) return true;
    }
  }
  return false;
}

// Along the line between the nearest points of their base triangles.
bool SweptPairs::apart_by_triangles(const Step& step, Pair& pair) {
  double radii = 0;
  std::array<Triangle, 2> placed;
  for (std::size_t s = 0; s < 2; ++s) {
    const Node& node = pair.nodes[s];
    const PieceBounds& record = PieceCache::bounds_of(node);
    placed[s] = record.base(node.boxes->origin());
    for (Point3& corner : placed[s]) corner = step.middle.frames[s].apply(corner);
    radii += scales_[s] * record.radius();
  }
  const Vector3 between = way_between(placed);
  pair.widest = length(between) + radii;
  return apart_along(step, pair, normalized(between), neither);
}

// The same, and along the triangles' normals, for flat ones that are nearer than single precision resolves.
bool SweptPairs::apart_in_double(const Step& step, Pair& pair) {
  double size = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const Node& node = pair.nodes[s];
    if (PieceCache::can_open(node)) return false;
    size = std::max(size, scales_[s] * static_cast<double>(node.size()));
  }
  if (pair.widest > near_for_single * size) return false;
  std::array<Triangle, 2> placed;
  for (std::size_t s = 0; s < 2; ++s) {
    pair.triangles[s] = bodies_[s].scratch.offset(pair.nodes[s]);
    for (std::size_t k = 0; k < 3; ++k) {
      placed[s][k] = step.middle.frames[s].apply(pair.triangles[s].base[k]);
    }
  }
  pair.exact = true;
  const Vector3 between = way_between(placed);
  pair.widest = length(between);
  return apart_along(step, pair, unit_normal(placed[0]), 0) ||
         apart_along(step, pair, unit_normal(placed[1]), 1) ||
         apart_along(step, pair, normalized(between), neither);
}

// The larger one, if it is large for how far the nodes move against each other.
std::size_t SweptPairs::side_to_open(const Step& step, const Pair& pair) const {
  std::size_t side = neither;
  double size = 0, speed = length(motions_[1].velocity() - motions_[0].velocity());
  for (std::size_t s = 0; s < 2; ++s) {
    const Node& node = pair.nodes[s];
    speed += pair.heights.levers[s];
    if (!PieceCache::can_open(node) || (node.bounded() && bodies_[s].scratch.full())) continue;
    const double own = scales_[s] * static_cast<double>(node.size());
    if (side == neither || own > size) side = s;
    size = std::max(size, own);
  }
  return size >= world_.apply(step.half() * speed) ? side : neither;
}

void SweptPairs::open(const Nodes& nodes, std::size_t side, std::vector<Nodes>& out) {
  stats_.splits += nodes[side].bounded();
  const PieceCache::Opened opened = bodies_[side].scratch.open(nodes[side]);
  for (std::size_t place = 0; place < opened.count(); ++place) {
    out.push_back(nodes);
    out.back()[side] = opened.child(place);
  }
}

}  // namespace snug
