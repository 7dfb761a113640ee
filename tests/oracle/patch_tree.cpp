#include <oracle/patch_tree.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>

namespace oracle::detail {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kRoundoff = 0x1p-52;

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator*(double s, const Point& a) { return {s * a[0], s * a[1], s * a[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The 3 x 3 part alone.
struct Turn {
  std::array<Point, 3> row;
  double stretch;  // at least its spectral norm

  explicit Turn(const Placement& m) : row{Point{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}} {
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < 3; ++j)
        sum += std::abs(row[0][i] * row[0][j] + row[1][i] * row[1][j] + row[2][i] * row[2][j]);
      largest = std::max(largest, sum);
    }
    stretch = std::sqrt(largest) * (1 + 1e-14);
  }
  [[nodiscard]] Point apply(const Point& p) const { return {dot(row[0], p), dot(row[1], p), dot(row[2], p)}; }
  [[nodiscard]] Point pull_back(const Point& d) const {
    return d[0] * row[0] + d[1] * row[1] + d[2] * row[2];
  }
};

void check_placement(const Placement& m) {
  for (const double x : m)
    if (!std::isfinite(x)) throw std::invalid_argument("oracle: a placement is not finite");
}

void find_ball(const Point* hull, TreePatch& patch) {
  Point lower = hull[0], upper = hull[0];
  for (std::size_t i = 1; i < patch.hull_count; ++i)
    for (std::size_t x = 0; x < 3; ++x) {
      lower[x] = std::min(lower[x], hull[i][x]);
      upper[x] = std::max(upper[x], hull[i][x]);
    }
  for (std::size_t x = 0; x < 3; ++x) patch.centre[x] = lower[x] + (upper[x] - lower[x]) / 2;
  double largest = 0;
  for (std::size_t i = 0; i < patch.hull_count; ++i) {
    const Point r = hull[i] - patch.centre;
    largest = std::max(largest, dot(r, r));
  }
  patch.radius = std::sqrt(largest) * (1 + 1e-14);
}

Point normal(const std::vector<Point>& corners) {
  return corners.size() < 3 ? Point{} : cross(corners[1] - corners[0], corners[2] - corners[0]);
}

class ContactSearch {
 public:
  ContactSearch(PatchTree& a, const Placement& place_a, PatchTree& b, const Placement& place_b,
                const ContactGoal& goal)
      : a_(a),
        b_(b),
        turn_a_(place_a),
        turn_b_(place_b),
        origin_{place_a[3], place_a[7], place_a[11]},
        shift_{place_b[3] - place_a[3], place_b[7] - place_a[7], place_b[11] - place_a[11]},
        goal_(goal) {
    for (std::size_t x = 0; x < 3; ++x) shift_size_ = std::max(shift_size_, std::abs(shift_[x]));
    common_error_ =
        32 * kRoundoff * (turn_a_.stretch * a.largest + turn_b_.stretch * b.largest + shift_size_);
  }

  ContactBounds run(std::optional<std::uint32_t> face_a) {
    start(face_a);
    bool spent = false;
    while (!open_.empty() && !reached(std::min(open_.top().lower, left_))) {
      const Pair pair = open_.top();
      const bool can_a = a_.patches[pair.a].level < a_.deepest, can_b = b_.patches[pair.b].level < b_.deepest;
      if (pair.tight && !can_a && !can_b) break;  // no other pair can raise the lower bound
      if (++steps_ > goal_.effort) {
        spent = true;
        break;
      }
      open_.pop();
      if (good_enough(pair.lower))
        left_ = std::min(left_, pair.lower);
      else if (pair.tight)
        split(pair, can_a, can_b);
      else
        consider_closely(pair);
    }
    double lower = std::min(left_, upper_);
    if (!open_.empty()) lower = std::min(lower, open_.top().lower);
    return {std::max(lower, 0.0), upper_, on_a_ + origin_, on_b_ + origin_, spent};
  }

 private:
  struct Pair {
    double lower;
    double guess;  // distance of two points in the hulls: among equal bounds the closest pair goes first
    std::uint32_t a, b;
    bool tight;
    bool operator<(const Pair& other) const {
      return lower != other.lower ? lower > other.lower : guess > other.guess;
    }
  };
  struct Ball {
    std::uint32_t index;
    Point centre;
    double radius;
  };

  // In a frame turned like the world, with its origin where A's origin is.
  [[nodiscard]] Point placed_a(const Point& p) const { return turn_a_.apply(p); }
  [[nodiscard]] Point placed_b(const Point& p) const { return turn_b_.apply(p) + shift_; }
  [[nodiscard]] Ball ball_a(std::uint32_t i) const {
    return {i, placed_a(a_.patches[i].centre), a_.patches[i].radius * turn_a_.stretch};
  }
  [[nodiscard]] Ball ball_b(std::uint32_t i) const {
    return {i, placed_b(b_.patches[i].centre), b_.patches[i].radius * turn_b_.stretch};
  }
  [[nodiscard]] double error(std::uint32_t a, std::uint32_t b) const {
    return turn_a_.stretch * a_.error(a_.patches[a].level) + turn_b_.stretch * b_.error(b_.patches[b].level) +
           common_error_;
  }

  [[nodiscard]] double slackness() const {
    return std::max(goal_.precision.absolute, goal_.precision.relative * upper_);
  }
  [[nodiscard]] bool reached(double lower) const {
    if (goal_.threshold && (upper_ <= *goal_.threshold || lower > *goal_.threshold)) return true;
    return upper_ - lower <= slackness();
  }
  [[nodiscard]] bool good_enough(double lower) const {
    return (goal_.threshold && lower > *goal_.threshold) || lower >= upper_ - slackness();
  }

  void start(std::optional<std::uint32_t> face_a) {
    std::vector<Ball> as, bs;
    for (std::uint32_t i = 0; i < a_.root_count; ++i)
      if (!face_a || a_.patches[i].face == *face_a) as.push_back(ball_a(i));
    if (as.empty()) throw std::invalid_argument("oracle: the face has no surface");
    for (std::uint32_t i = 0; i < b_.root_count; ++i) bs.push_back(ball_b(i));
    // The nearest centres give a first pair of points.
    double nearest = kInfinity;
    std::pair<std::uint32_t, std::uint32_t> first;
    for (const Ball& a : as)
      for (const Ball& b : bs) {
        const Point d = b.centre - a.centre;
        if (const double found = dot(d, d); found < nearest) {
          nearest = found;
          first = {a.index, b.index};
        }
      }
    nearest_corners(first.first, first.second);
    for (const Ball& a : as)
      for (const Ball& b : bs) consider(a, b, 0, true);
  }

  void split(const Pair& pair, bool can_a, bool can_b) {
    const bool split_a = can_a && (!can_b || a_.patches[pair.a].radius * turn_a_.stretch >=
                                                 b_.patches[pair.b].radius * turn_b_.stretch);
    if (split_a) {
      const std::uint32_t first = a_.split(pair.a), count = a_.patches[pair.a].child_count;
      const Ball b = ball_b(pair.b);
      for (std::uint32_t k = 0; k < count; ++k) consider(ball_a(first + k), b, pair.lower, false);
    } else {
      const std::uint32_t first = b_.split(pair.b), count = b_.patches[pair.b].child_count;
      const Ball a = ball_a(pair.a);
      for (std::uint32_t k = 0; k < count; ++k) consider(a, ball_b(first + k), pair.lower, false);
    }
  }

  /// known: a lower bound of what the two are parts of.
  void consider(const Ball& a, const Ball& b, double known, bool lazily) {
    const Point d = b.centre - a.centre;
    const double between = length(d);
    const double balls = between * (1 - 1e-14) - a.radius - b.radius - error(a.index, b.index);
    const double lower = std::max(known, balls);
    if (good_enough(lower))
      left_ = std::min(left_, lower);
    else if (lower > 0 && !lazily)
      consider_closely({lower, between, a.index, b.index, false});
    else  // in its turn: where the surfaces meet, few of these get one
      open_.push({lower, between, a.index, b.index, false});
  }

  /// From the nearest corner of A to the nearest of B.
  Point nearest_corners(std::uint32_t a, std::uint32_t b) {
    const TreePatch &pa = a_.patches[a], &pb = b_.patches[b];
    std::vector<Point>&as = corners_[0], &bs = corners_[1];
    as.clear(), bs.clear();
    for (std::uint32_t k = 0; k < pa.corner_count; ++k) as.push_back(placed_a(a_.points[pa.corners + k]));
    for (std::uint32_t k = 0; k < pb.corner_count; ++k) bs.push_back(placed_b(b_.points[pb.corners + k]));
    double shortest = kInfinity;
    Point gap{}, on_a{}, on_b{};
    for (const Point& p : as)
      for (const Point& q : bs) {
        const Point between = q - p;
        if (const double d = dot(between, between); d < shortest) {
          shortest = d;
          gap = between;
          on_a = p;
          on_b = q;
        }
      }
    const double d = std::sqrt(shortest) * (1 + 1e-14) + error(a, b) + turn_a_.stretch * pa.corner_error +
                     turn_b_.stretch * pb.corner_error;
    if (d < upper_) {
      upper_ = d;
      on_a_ = on_a;
      on_b_ = on_b;
    }
    normals_ = {normal(as), normal(bs)};
    return gap;
  }

  struct Support {
    double gap;   // of the hulls along a direction
    Point point;  // of hull(b) - hull(a)
  };
  [[nodiscard]] Support support(std::uint32_t a, std::uint32_t b, const Point& direction) const {
    const Point in_a = turn_a_.pull_back(direction), in_b = turn_b_.pull_back(direction);
    const TreePatch &pa = a_.patches[a], &pb = b_.patches[b];
    const Point* hull_a = a_.points.data() + pa.hull;
    const Point* hull_b = b_.points.data() + pb.hull;
    std::size_t most = 0, least = 0;
    double max_a = -kInfinity, min_b = kInfinity;
    for (std::size_t i = 0; i < pa.hull_count; ++i)
      if (const double h = dot(in_a, hull_a[i]); h > max_a) {
        max_a = h;
        most = i;
      }
    for (std::size_t i = 0; i < pb.hull_count; ++i)
      if (const double h = dot(in_b, hull_b[i]); h < min_b) {
        min_b = h;
        least = i;
      }
    return {min_b - max_a + dot(direction, shift_), placed_b(hull_b[least]) - placed_a(hull_a[most])};
  }

  void consider_closely(Pair pair) {
    pair.tight = true;
    Point gap = nearest_corners(pair.a, pair.b);
    pair.guess = length(gap);
    const double error_here = error(pair.a, pair.b);
    const auto improve = [&](double found) {
      pair.lower = std::max(pair.lower, found * (1 - 1e-14) - error_here);
      return good_enough(pair.lower);
    };
    // Along the normals, then Gilbert's iteration from a point of hull(b) - hull(a) towards the one nearest
    // to 0.
    bool done = false;
    for (Point normal : normals_) {
      const double size = length(normal);
      if (!(size > 0) || done) continue;
      normal = (dot(normal, gap) < 0 ? -1 / size : 1 / size) * normal;
      done = improve(support(pair.a, pair.b, normal).gap);
    }
    constexpr int kSteps = 10;
    for (int step = 0; step < kSteps && !done; ++step) {
      const double size = length(gap);
      pair.guess = std::min(pair.guess, size);
      if (!(size > 0) || size <= pair.lower * (1 + 1e-15)) break;
      const Support found = support(pair.a, pair.b, (1 / size) * gap);
      done = improve(found.gap);
      const Point along = found.point - gap;
      const double squared = dot(along, along);
      if (!(squared > 0)) break;
      const double t = std::clamp(-dot(gap, along) / squared, 0.0, 1.0);
      if (t == 0) break;
      gap = gap + t * along;
    }
    if (good_enough(pair.lower))
      left_ = std::min(left_, pair.lower);
    else
      open_.push(pair);
  }

  PatchTree &a_, &b_;
  Turn turn_a_, turn_b_;
  Point origin_, shift_;
  double shift_size_ = 0, common_error_ = 0;
  ContactGoal goal_;
  std::priority_queue<Pair> open_;
  std::array<Point, 2> normals_{};
  std::array<std::vector<Point>, 2> corners_;  // of the two patches compared, placed
  double upper_ = kInfinity;
  double left_ = kInfinity;  // least bound of the pairs that need no split
  std::size_t steps_ = 0;
  Point on_a_{}, on_b_{};
};

}  // namespace

void PatchTree::append(TreePatch patch) {
  find_ball(points.data() + patch.hull, patch);
  patches.push_back(patch);
}

void PatchTree::trim(std::size_t max_patches, std::size_t max_points) {
  if (patches.size() <= max_patches && points.size() <= max_points) return;
  patches.resize(root_count);
  points.resize(root_points);
  for (TreePatch& patch : patches) patch.first_child = kNoPatch;
}

SegmentTree::SegmentTree(const Point& p, const Point& q) {
  points = {p, q};
  TreePatch patch;
  patch.hull_count = patch.corner_count = 2;
  append(patch);
  root_count = 1;
  root_points = 2;
  for (const Point& point : points)
    for (const double x : point) largest = std::max(largest, std::abs(x));
}

ContactBounds tree_bounds(PatchTree& a, const Placement& place_a, PatchTree& b, const Placement& place_b,
                          const ContactGoal& goal, std::optional<std::uint32_t> face_a) {
  check_placement(place_a);
  check_placement(place_b);
  return ContactSearch(a, place_a, b, place_b, goal).run(face_a);
}

ContactBounds tree_distance_to(PatchTree& tree, const Placement& placement, const Point& point,
                               const ContactGoal& goal, std::optional<std::uint32_t> face) {
  SegmentTree origin({0, 0, 0}, {0, 0, 0});
  Placement at = kUnmoved;
  for (std::size_t x = 0; x < 3; ++x) at[4 * x + 3] = point[x];
  return tree_bounds(tree, placement, origin, at, goal, face);
}

}  // namespace oracle::detail
