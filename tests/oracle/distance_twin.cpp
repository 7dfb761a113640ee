#include <oracle/distance_twin.h>
#include <oracle/loop_net.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <utility>
#include <vector>

namespace oracle {

namespace {

using detail::Net;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kDeepestPatch = 60;
constexpr std::uint32_t kNotSplit = 0;  // the first patch is a root, nobody's child

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }

Point placed(const Placement& m, const Point& p) {
  Point q{};
  for (std::size_t r = 0; r < 3; ++r)
    q[r] = m[4 * r] * p[0] + m[4 * r + 1] * p[1] + m[4 * r + 2] * p[2] + m[4 * r + 3];
  return q;
}

/// d . (R x + t) = (R^T d) . x + d . t
Point pulled_back(const Placement& m, const Point& d) {
  Point q{};
  for (std::size_t c = 0; c < 3; ++c) q[c] = m[c] * d[0] + m[4 + c] * d[1] + m[8 + c] * d[2];
  return q;
}

/// An upper bound of the spectral norm of R: the root of the largest absolute row sum of R^T R.
double stretch(const Placement& m) {
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < 3; ++j)
      sum += std::abs(m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j]);
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest) * (1 + 1e-14);
}

struct Patch {
  std::vector<Point> net;  // control points, the limit patch is in their hull
  Point centre;
  double radius;  // of a ball around the net
  std::array<Point, 3> corners;
  Net<double> around;  // emptied once split
  std::uint32_t first_child = kNotSplit;
  std::uint32_t level = 0;
};

Patch make_patch(Net<double> around, const std::array<Point, 3>& corners, std::uint32_t level) {
  Patch patch;
  patch.net = around.points;
  Point lower = patch.net[0], upper = patch.net[0];
  for (const Point& p : patch.net)
    for (std::size_t x = 0; x < 3; ++x) {
      lower[x] = std::min(lower[x], p[x]);
      upper[x] = std::max(upper[x], p[x]);
    }
  for (std::size_t x = 0; x < 3; ++x) patch.centre[x] = lower[x] + (upper[x] - lower[x]) / 2;
  patch.radius = 0;
  for (const Point& p : patch.net) patch.radius = std::max(patch.radius, length(p - patch.centre));
  patch.corners = corners;
  patch.around = std::move(around);
  patch.level = level;
  return patch;
}

}  // namespace

struct SurfaceTwin::Tree {
  std::vector<Patch> roots;          // one for each control face with a surface, never split themselves
  std::vector<std::uint32_t> faces;  // their faces
  std::vector<Patch> patches;        // starts with a copy of the roots
  std::size_t valence = 6;
  double largest = 0;
  detail::WeightTable<double> weights;

  /// A single point as a surface.
  explicit Tree(const Point& point) {
    Patch patch;
    patch.net = {point};
    patch.centre = point;
    patch.radius = 0;
    patch.corners = {point, point, point};
    patch.level = kDeepestPatch;
    roots.push_back(std::move(patch));
    faces.push_back(0);
    patches = roots;
    for (const double x : point) largest = std::max(largest, std::abs(x));
  }

  explicit Tree(const TwinMesh& mesh) {
    const Net<double> net = detail::whole_net<double>(mesh);
    const auto limit = detail::limit_points(net, weights);
    std::vector<std::size_t> count(mesh.points.size(), 0);
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
      const Triangle& t = mesh.triangles[f];
      for (const std::uint32_t v : t) {
        valence = std::max(valence, ++count[v]);
        for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
      }
      if (!detail::has_surface(net, f)) continue;
      roots.push_back(make_patch(detail::neighbourhood(net, f), {limit[t[0]], limit[t[1]], limit[t[2]]}, 0));
      faces.push_back(f);
    }
    if (roots.empty()) throw std::invalid_argument("oracle: no face has a surface");
    patches = roots;
  }

  /// First of the four children.
  std::uint32_t split(std::uint32_t index) {
    if (patches[index].first_child != kNotSplit) return patches[index].first_child;
    const Net<double> fine = detail::refine(patches[index].around, weights);
    const auto limit = detail::limit_points(fine, weights);
    const auto first = static_cast<std::uint32_t>(patches.size());
    for (std::size_t k = 0; k < 4; ++k) {
      const Triangle& t = fine.triangles[k];
      patches.push_back(make_patch(detail::neighbourhood(fine, k), {limit[t[0]], limit[t[1]], limit[t[2]]},
                                   patches[index].level + 1));
    }
    patches[index].first_child = first;
    patches[index].around = {};
    return first;
  }

  void trim() {
    if (patches.size() > kLargestTree) patches = roots;
  }

  [[nodiscard]] double slack(const Placement& m) const {
    double size = 0;
    for (std::size_t r = 0; r < 3; ++r) {
      const double row = std::abs(m[4 * r]) + std::abs(m[4 * r + 1]) + std::abs(m[4 * r + 2]);
      size = std::max(size, row * largest + std::abs(m[4 * r + 3]));
    }
    return (62.0 * static_cast<double>(valence + 8) + 64) * 0x1p-52 * size;
  }
};

namespace {

/// Stops when the bounds are close enough, or when they have decided about `threshold`.
struct Goal {
  Precision precision;
  std::optional<double> threshold = {};

  [[nodiscard]] double margin(double upper) const {
    return std::max(precision.absolute, precision.relative * upper);
  }
  [[nodiscard]] bool reached(double lower, double upper) const {
    if (threshold && (upper <= *threshold || lower > *threshold)) return true;
    return upper - lower <= margin(upper);
  }
};

template <class Tree>
class GapSearch {
 public:
  GapSearch(Tree& a, const Placement& place_a, Tree& b, const Placement& place_b, const Goal& goal)
      : a_(a),
        b_(b),
        place_a_(place_a),
        place_b_(place_b),
        stretch_a_(stretch(place_a)),
        stretch_b_(stretch(place_b)),
        goal_(goal) {}

  TwinDistance run(const std::vector<std::uint32_t>& roots_a, const std::vector<std::uint32_t>& roots_b) {
    start(roots_a, roots_b);
    while (!open_.empty() && !goal_.reached(std::min(open_.top().lower, left_), upper_)) {
      const Pair pair = open_.top();
      if (pair.tight && !can_split(a_, pair.a) && !can_split(b_, pair.b))
        break;  // no other pair can raise the lower bound
      open_.pop();
      if (pair.tight)
        split(pair);
      else
        consider_closely(pair);
    }
    double lower = std::min(left_, upper_);
    if (!open_.empty()) lower = std::min(lower, open_.top().lower);
    return {lower, upper_, on_a_, on_b_};
  }

 private:
  struct Pair {
    double lower;
    double guess;  // distance of two points in the hulls or balls: among equal bounds the closest pair goes
                   // first
    std::uint32_t a, b;
    bool tight;  // lower is more than the gap of the balls
    bool operator<(const Pair& other) const {
      return lower != other.lower ? lower > other.lower : guess > other.guess;
    }
  };

  struct Placed {
    std::uint32_t index;
    Point centre;
    double radius;
    std::array<Point, 3> corners;
  };

  static Placed place(const Tree& tree, std::uint32_t index, const Placement& m, double grown) {
    const Patch& patch = tree.patches[index];
    return {index,
            placed(m, patch.centre),
            patch.radius * grown,
            {placed(m, patch.corners[0]), placed(m, patch.corners[1]), placed(m, patch.corners[2])}};
  }

  void start(const std::vector<std::uint32_t>& roots_a, const std::vector<std::uint32_t>& roots_b) {
    std::vector<Placed> as, bs;
    for (const std::uint32_t i : roots_a) as.push_back(place(a_, i, place_a_, stretch_a_));
    for (const std::uint32_t i : roots_b) bs.push_back(place(b_, i, place_b_, stretch_b_));
    for (const Placed& a : as)
      for (const Placed& b : bs) improve_upper(a.corners[0], b.corners[0]);
    for (const Placed& a : as)
      for (const Placed& b : bs) consider(a, b);
  }

  static bool can_split(const Tree& tree, std::uint32_t index) {
    return tree.patches[index].level < kDeepestPatch;
  }

  void split(const Pair& pair) {
    const bool split_a = can_split(a_, pair.a) &&
                         (!can_split(b_, pair.b) ||
                          a_.patches[pair.a].radius * stretch_a_ >= b_.patches[pair.b].radius * stretch_b_);
    if (split_a) {
      const std::uint32_t first = a_.split(pair.a);
      const Placed b = place(b_, pair.b, place_b_, stretch_b_);
      for (std::uint32_t k = 0; k < 4; ++k) consider(place(a_, first + k, place_a_, stretch_a_), b);
    } else {
      const std::uint32_t first = b_.split(pair.b);
      const Placed a = place(a_, pair.a, place_a_, stretch_a_);
      for (std::uint32_t k = 0; k < 4; ++k) consider(a, place(b_, first + k, place_b_, stretch_b_));
    }
  }

  void improve_upper(const Point& a, const Point& b) {
    const double d = length(b - a);
    if (d >= upper_) return;
    upper_ = d;
    on_a_ = a;
    on_b_ = b;
  }

  [[nodiscard]] bool good_enough(double lower) const { return lower >= upper_ - goal_.margin(upper_); }

  /// Opens the pair, or, if its bound is as close to the upper one as asked, keeps no more than that bound.
  void open(const Pair& pair) {
    if (good_enough(pair.lower))
      left_ = std::min(left_, pair.lower);
    else
      open_.push(pair);
  }

  void consider(const Placed& a, const Placed& b) {
    const double between = length(b.centre - a.centre), balls = between - a.radius - b.radius;
    if (good_enough(balls))
      left_ = std::min(left_, balls);
    else if (balls > 0)
      consider_closely({balls, between, a.index, b.index, false});
    else  // in its turn: where the surfaces meet, few of these get one
      open_.push({0, between, a.index, b.index, false});
  }

  void consider_closely(Pair pair) {
    pair.tight = true;
    const Placed a = place(a_, pair.a, place_a_, stretch_a_), b = place(b_, pair.b, place_b_, stretch_b_);
    Point gap{};
    double shortest = kInfinity;
    for (const Point& p : a.corners)
      for (const Point& q : b.corners) {
        const Point between = q - p;
        if (const double d = length(between); d < shortest) {
          shortest = d;
          gap = between;
        }
        improve_upper(p, q);
      }
    pair.guess = shortest;
    tighten(gap, pair);
    open(pair);
  }

  /// Gilbert's iteration for the point of hull(b) - hull(a) nearest to the origin, from a point `gap` of it.
  /// pair.lower is the best bound met, pair.guess the length of the last point.
  void tighten(Point gap, Pair& pair) const {
    constexpr int kSteps = 24;
    const auto &net_a = a_.patches[pair.a].net, &net_b = b_.patches[pair.b].net;
    for (int step = 0; step < kSteps; ++step) {
      const double size = length(gap);
      pair.guess = std::min(pair.guess, size);
      if (size == 0 || size <= pair.lower * (1 + 1e-6)) return;
      const Point direction{gap[0] / size, gap[1] / size, gap[2] / size};
      const Point in_a = pulled_back(place_a_, direction), in_b = pulled_back(place_b_, direction);
      std::size_t most = 0, least = 0;
      double max_a = -kInfinity, min_b = kInfinity;
      for (std::size_t i = 0; i < net_a.size(); ++i)
        if (const double h = dot(in_a, net_a[i]); h > max_a) {
          max_a = h;
          most = i;
        }
      for (std::size_t i = 0; i < net_b.size(); ++i)
        if (const double h = dot(in_b, net_b[i]); h < min_b) {
          min_b = h;
          least = i;
        }
      const Point shift{place_b_[3] - place_a_[3], place_b_[7] - place_a_[7], place_b_[11] - place_a_[11]};
      pair.lower = std::max(pair.lower, min_b - max_a + dot(direction, shift));
      if (good_enough(pair.lower)) return;
      const Point support = placed(place_b_, net_b[least]) - placed(place_a_, net_a[most]);
      const Point along = support - gap;
      const double squared = dot(along, along);
      if (squared == 0) return;
      const double t = std::clamp(-dot(gap, along) / squared, 0.0, 1.0);
      if (t == 0) return;
      for (std::size_t x = 0; x < 3; ++x) gap[x] += t * along[x];
    }
  }

  Tree &a_, &b_;
  const Placement &place_a_, &place_b_;
  double stretch_a_, stretch_b_;
  Goal goal_;
  std::priority_queue<Pair> open_;
  double upper_ = kInfinity;
  double left_ = kInfinity;  // least bound of the pairs that need no split
  Point on_a_{}, on_b_{};
};

template <class Tree>
std::vector<std::uint32_t> roots_of(const Tree& tree, std::optional<std::uint32_t> face) {
  std::vector<std::uint32_t> roots;
  for (std::uint32_t i = 0; i < tree.faces.size(); ++i)
    if (!face || tree.faces[i] == *face) roots.push_back(i);
  if (roots.empty()) throw std::invalid_argument("oracle: the face has no surface");
  return roots;
}

void check_placement(const Placement& m) {
  for (const double x : m)
    if (!std::isfinite(x)) throw std::invalid_argument("oracle: a placement is not finite");
}

/// The bounds without what rounding can hide.
template <class Tree>
TwinDistance search(Tree& a, const Placement& place_a, Tree& b, const Placement& place_b, const Goal& goal,
                    std::optional<std::uint32_t> face) {
  check_placement(place_a);
  check_placement(place_b);
  a.trim();
  b.trim();
  return GapSearch<Tree>(a, place_a, b, place_b, goal).run(roots_of(a, face), roots_of(b, {}));
}

TwinDistance widened(TwinDistance found, double slack) {
  found.lower = std::max(0.0, found.lower - slack);
  found.upper += slack;
  return found;
}

}  // namespace

SurfaceTwin::SurfaceTwin(const TwinMesh& mesh) : tree_(std::make_unique<Tree>(mesh)) {}
SurfaceTwin::~SurfaceTwin() = default;
SurfaceTwin::SurfaceTwin(SurfaceTwin&&) noexcept = default;
SurfaceTwin& SurfaceTwin::operator=(SurfaceTwin&&) noexcept = default;

PointDistance SurfaceTwin::distance_to(const Placement& placement, const Point& point,
                                       const Precision& precision, std::optional<std::uint32_t> face) {
  Tree single(point);
  const TwinDistance found = widened(search(*tree_, placement, single, kUnmoved, Goal{precision}, face),
                                     tree_->slack(placement) + single.slack(kUnmoved));
  return {found.lower, found.upper, found.on_a};
}

bool SurfaceTwin::on_surface(const Placement& placement, const Point& point, double tolerance,
                             std::optional<std::uint32_t> face) {
  Tree single(point);
  const double slack = tree_->slack(placement) + single.slack(kUnmoved);
  const double threshold = tolerance - slack;
  return search(*tree_, placement, single, kUnmoved, Goal{{slack, 0}, threshold}, face).upper <= threshold;
}

double SurfaceTwin::slack(const Placement& placement) const { return tree_->slack(placement); }

DistanceTwin::DistanceTwin(const TwinMesh& a, const TwinMesh& b) : a_(a), b_(b) {}

TwinDistance DistanceTwin::query(const Placement& place_a, const Placement& place_b,
                                 const Precision& precision) {
  return widened(search(*a_.tree_, place_a, *b_.tree_, place_b, Goal{precision}, {}),
                 a_.slack(place_a) + b_.slack(place_b));
}

TwinDistance brute_distance(const TwinMesh& a, const Placement& place_a, const TwinMesh& b,
                            const Placement& place_b, double precision) {
  return DistanceTwin(a, b).query(place_a, place_b, {precision});
}

bool on_surface(const TwinMesh& mesh, const Placement& placement, const Point& point, double tolerance,
                std::optional<std::uint32_t> face) {
  return SurfaceTwin(mesh).on_surface(placement, point, tolerance, face);
}

}  // namespace oracle
