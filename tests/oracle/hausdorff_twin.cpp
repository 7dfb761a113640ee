#include <oracle/hausdorff_twin.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <queue>
#include <stdexcept>

namespace oracle {

namespace {

using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64);
using Vector = std::array<Real, 3>;
using Part = std::array<Vector, 3>;

constexpr int deepest = 100;

Vector minus(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Vector between(const Vector& a, const Vector& b, Real t) {
  return {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])};
}
Real length(const Vector& a) { return std::sqrt(dot(a, a)); }
bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

struct Bounds {
  Real lower, upper;
};

// A point of the triangle, the nearest up to rounding.
Vector nearest(const Vector& x, const Part& t) {
  Vector best = t[0];
  Real least = std::numeric_limits<Real>::infinity();
  const auto offer = [&](const Vector& y) {
    const Vector off = minus(x, y);
    const Real square = dot(off, off);
    if (square < least) least = square, best = y;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector &a = t[k], &b = t[(k + 1) % 3], along = minus(b, a);
    const Real square = dot(along, along);
    offer(square > 0 ? between(a, b, std::clamp(dot(minus(x, a), along) / square, Real{0}, Real{1})) : a);
  }
  const Vector u = minus(t[1], t[0]), v = minus(t[2], t[0]), n = cross(u, v), w = minus(x, t[0]);
  const Real square = dot(n, n);
  if (square > 0) {
    const Real s = dot(cross(w, v), n) / square, r = dot(cross(u, w), n) / square;
    if (s >= 0 && r >= 0 && s + r <= 1) {
      offer({t[0][0] + s * u[0] + r * v[0], t[0][1] + s * u[1] + r * v[1], t[0][2] + s * u[2] + r * v[2]});
    }
  }
  return best;
}

// All of the triangle is beyond the plane through the corner that is least far along x - y.
Bounds distance(const Vector& x, const Part& t) {
  const Vector away = minus(x, nearest(x, t));
  const Real upper = length(away);
  if (!(upper > 0)) return {0, 0};
  const Real least =
      std::min({dot(minus(x, t[0]), away), dot(minus(x, t[1]), away), dot(minus(x, t[2]), away)});
  return {std::max(Real{0}, least / upper), upper};
}

// How often triangles wind around a point.
Real turns(const Vector& x, const std::vector<Part>& set) {
  Real sum = 0;
  for (const Part& t : set) {
    const Vector a = minus(t[0], x), b = minus(t[1], x), c = minus(t[2], x);
    const Real la = length(a), lb = length(b), lc = length(c);
    sum += std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (2 * std::numbers::pi_v<long double>);
}

struct Node {
  Part corners{};
  int level = 0;
  Real upper = std::numeric_limits<Real>::infinity();
  Real apart = 0;  // of all points of the part from `to`, at least
  std::array<Real, 3> lower{};
  bool on_side = false;  // all of it
  std::vector<std::uint32_t> near{};
  std::uint32_t best = 0;
  friend bool operator<(const Node& a, const Node& b) { return a.upper < b.upper; }
};

class FarthestSearch {
 public:
  FarthestSearch(const std::vector<Corners>& from, const std::vector<Corners>& to, const HausdorffGoal& goal)
      : goal_(goal) {
    if (from.empty() || to.empty()) throw std::invalid_argument("a distance of no triangles");
    origin_ = {to[0][0][0], to[0][0][1], to[0][0][2]};
    for (const Corners& t : to) to_.push_back(moved(t));
    for (const Corners& t : from) from_.push_back(moved(t));
    slack_ = std::ldexp(extent_, -52);
  }

  HausdorffBounds run() {
    std::vector<std::uint32_t> all(to_.size());
    for (std::uint32_t b = 0; b < all.size(); ++b) all[b] = b;
    for (const Part& t : from_) {
      Node node;
      node.corners = t;
      node.near = all;
      add(std::move(node));
    }
    std::size_t splits = 0;
    Real stuck = 0;
    const Real precision = std::max(goal_.precision, slack_);
    while (!queue_.empty() && queue_.top().upper > lower_ + precision && splits < goal_.effort) {
      const Node node = queue_.top();
      queue_.pop();
      if (node.level >= deepest) {
        stuck = std::max(stuck, node.upper);
        continue;
      }
      split(node);
      ++splits;
    }
    HausdorffBounds bounds;
    bounds.spent = splits >= goal_.effort || stuck > lower_ + precision;
    Real upper = std::max(lower_, stuck);
    if (!queue_.empty()) upper = std::max(upper, queue_.top().upper);
    bounds.lower = std::max(Real{0}, lower_ - slack_);
    // Nothing there: 0, and exactly so.
    bounds.upper = upper > 0 || goal_.side == Side::any ? upper + slack_ : 0;
    for (std::size_t x = 0; x < 3; ++x) bounds.farthest[x] = static_cast<double>(farthest_[x] + origin_[x]);
    return bounds;
  }

 private:
  Part moved(const Corners& t) {
    Part part;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t x = 0; x < 3; ++x) {
        part[k][x] = static_cast<Real>(t[k][x]) - origin_[x];
        extent_ = std::max(extent_, std::fabs(part[k][x]));
      }
    return part;
  }

  // Far enough from `to` to be told, and there?
  bool on_side(const Vector& x, Real apart) const {
    if (!(apart > Real{1e-7L} * extent_)) return false;
    const Real sum = turns(x, to_), whole = std::round(sum);
    if (std::fabs(sum - whole) > Real{1e-6L}) throw std::invalid_argument("the triangles are not closed");
    return (whole != 0) == (goal_.side == Side::inside);
  }

  // Bounds a part, and keeps it unless it cannot hold the farthest point.
  void add(Node node) {
    const Part& t = node.corners;
    std::array<Real, 3> reach{};
    for (std::size_t k = 0; k < 3; ++k) {
      reach[k] = std::max(length(minus(t[k], t[(k + 1) % 3])), length(minus(t[k], t[(k + 2) % 3])));
    }
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    node.lower.fill(infinity);
    node.apart = infinity;
    Real lowest = infinity;
    std::vector<Real> apart(node.near.size(), 0);
    for (std::size_t i = 0; i < node.near.size(); ++i) {
      Real most = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const Bounds d = distance(t[k], to_[node.near[i]]);
        most = std::max(most, d.upper);
        node.lower[k] = std::min(node.lower[k], d.lower);
        apart[i] = std::max(apart[i], d.lower - reach[k]);
      }
      node.apart = std::min(node.apart, apart[i]);
      if (most < lowest) lowest = most, node.best = node.near[i];
    }
    node.upper = std::min(node.upper, lowest);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < node.near.size(); ++i) {
      if (apart[i] <= lowest + slack_) node.near[kept++] = node.near[i];
    }
    node.near.resize(kept);
    if (goal_.side != Side::any && !node.on_side && node.apart > Real{1e-7L} * extent_) {
      if (!on_side(t[0], node.apart)) return;
      node.on_side = true;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (node.lower[k] > lower_ &&
          (goal_.side == Side::any || node.on_side || on_side(t[k], node.lower[k]))) {
        lower_ = node.lower[k];
        farthest_ = t[k];
      }
    }
    if (node.upper > lower_) queue_.push(std::move(node));
  }

  void child(const Node& of, const Vector& a, const Vector& b, const Vector& c) {
    Node node;
    node.corners = {a, b, c};
    node.level = of.level + 1;
    node.upper = of.upper;
    node.on_side = of.on_side;
    node.near = of.near;
    add(std::move(node));
  }

  void split(const Node& node) {
    if (node.level % 2 == 0 && cut(node)) return;
    const Part& t = node.corners;
    std::size_t longest = 0;
    Real most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const Real side = length(minus(t[(k + 1) % 3], t[k]));
      if (side > most) most = side, longest = k;
    }
    const Vector &a = t[longest], &b = t[(longest + 1) % 3], &c = t[(longest + 2) % 3];
    const Vector middle = between(a, b, 0.5L);
    child(node, a, middle, c);
    child(node, middle, b, c);
  }

  // Along the plane through an edge of the best triangle and its normal, if that runs through the part.
  bool cut(const Node& node) {
    const Part &t = node.corners, &b = to_[node.best];
    const Vector normal = cross(minus(b[1], b[0]), minus(b[2], b[0]));
    if (is_zero(normal)) return false;
    Real deepest_cut = 0;
    std::array<Real, 3> heights{};
    for (std::size_t e = 0; e < 3; ++e) {
      Vector across = cross(normal, minus(b[(e + 1) % 3], b[e]));
      const Real size = length(across);
      if (!(size > 0)) continue;
      std::array<Real, 3> s{};
      for (std::size_t k = 0; k < 3; ++k) s[k] = dot(minus(t[k], b[e]), across) / size;
      const Real depth = std::min(std::max({s[0], s[1], s[2]}), -std::min({s[0], s[1], s[2]}));
      if (depth > deepest_cut) deepest_cut = depth, heights = s;
    }
    const Real most = std::max({std::fabs(heights[0]), std::fabs(heights[1]), std::fabs(heights[2])});
    if (!(deepest_cut > Real{1e-9L} * most) || !(deepest_cut > slack_)) return false;
    // One corner is on a side of its own.
    std::size_t alone = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      if ((heights[k] > 0) != (heights[(k + 1) % 3] > 0) && (heights[k] > 0) != (heights[(k + 2) % 3] > 0)) {
        alone = k;
      }
    }
    const std::size_t j = (alone + 1) % 3, l = (alone + 2) % 3;
    const auto at = [&](std::size_t k) {
      return between(t[alone], t[k],
                     std::clamp(heights[alone] / (heights[alone] - heights[k]), Real{0}, Real{1}));
    };
    const Vector p = at(j), q = at(l);
    child(node, t[alone], p, q);
    child(node, p, t[j], t[l]);
    child(node, p, t[l], q);
    return true;
  }

  HausdorffGoal goal_;
  Vector origin_{};
  Real extent_ = 0, slack_ = 0;
  std::vector<Part> from_, to_;
  std::priority_queue<Node> queue_;
  Real lower_ = 0;
  Vector farthest_{};
};

}  // namespace

HausdorffBounds one_sided_hausdorff(const std::vector<Corners>& from, const std::vector<Corners>& to,
                                    const HausdorffGoal& goal) {
  return FarthestSearch(from, to, goal).run();
}

HausdorffBounds distance_to_triangles(const Point& point, const std::vector<Corners>& to) {
  HausdorffGoal whole;
  whole.effort = 0;
  return one_sided_hausdorff({{point, point, point}}, to, whole);
}

}  // namespace oracle
