#include <oracle/hull_twin.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace oracle {

namespace {

// The sign of (x1 y2 - x2 y1) of two differences, of coordinates i and j.
int turn(const Point& a, const Point& b, const Point& c, std::size_t i, std::size_t j) {
  const auto exact = [](double x) { return mpq_class(x); };
  const mpq_class s = (exact(b[i]) - exact(a[i])) * (exact(c[j]) - exact(a[j])),
                  t = (exact(b[j]) - exact(a[j])) * (exact(c[i]) - exact(a[i]));
  return cmp(s, t);
}

int exact_side(const Point& a, const Point& b, const Point& c, const Point& d) {
  std::array<std::array<mpq_class, 3>, 3> m;
  const Point* const rows[] = {&b, &c, &d};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = mpq_class((*rows[i])[j]) - mpq_class(a[j]);
  const mpq_class det = m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
                        m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
                        m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  return sgn(det);
}

// The sign of det(b - a, c - a, d - a). In doubles it errs by less than 32 units of roundoff of the sum of all
// products of sizes: differences have one rounding, products two, sums three.
int side(const Point& a, const Point& b, const Point& c, const Point& d) {
  double m[3][3], size = 0;
  const Point* const rows[] = {&b, &c, &d};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = (*rows[i])[j] - a[j];
  double det = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const double p = m[1][(j + 1) % 3] * m[2][(j + 2) % 3], q = m[1][(j + 2) % 3] * m[2][(j + 1) % 3];
    det += m[0][j] * (p - q);
    size += std::fabs(m[0][j]) * (std::fabs(p) + std::fabs(q));
  }
  if (std::fabs(det) > 0x1p-48 * size && size > 1e-250) return det > 0 ? 1 : -1;
  return exact_side(a, b, c, d);
}

// Two coordinates in which a triangle keeps its area; nothing if it has none.
std::optional<std::pair<std::size_t, std::size_t>> plane_of(const Point& a, const Point& b, const Point& c) {
  for (std::size_t i = 0; i < 3; ++i)
    if (turn(a, b, c, i, (i + 1) % 3) != 0) return std::pair{i, (i + 1) % 3};
  return std::nullopt;
}

bool between(const Point& a, const Point& b, const Point& p, std::size_t i, std::size_t j) {
  return std::min(a[i], b[i]) <= p[i] && p[i] <= std::max(a[i], b[i]) && std::min(a[j], b[j]) <= p[j] &&
         p[j] <= std::max(a[j], b[j]);
}

bool segments_meet(const Point& a, const Point& b, const Point& c, const Point& d, std::size_t i,
                   std::size_t j) {
  const int ca = turn(a, b, c, i, j), da = turn(a, b, d, i, j), ac = turn(c, d, a, i, j),
            bc = turn(c, d, b, i, j);
  if (ca * da < 0 && ac * bc < 0) return true;
  return (ca == 0 && between(a, b, c, i, j)) || (da == 0 && between(a, b, d, i, j)) ||
         (ac == 0 && between(c, d, a, i, j)) || (bc == 0 && between(c, d, b, i, j));
}

bool apart(const Point& low_a, const Point& high_a, const Point& low_b, const Point& high_b) {
  for (std::size_t k = 0; k < 3; ++k)
    if (high_a[k] < low_b[k] || high_b[k] < low_a[k]) return true;
  return false;
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double to_segment(const Point& q, const Point& a, const Point& b) {
  const Point edge = minus(b, a), from = minus(q, a);
  const double square = dot(edge, edge), t = square > 0 ? std::clamp(dot(from, edge) / square, 0.0, 1.0) : 0;
  const Point off{from[0] - t * edge[0], from[1] - t * edge[1], from[2] - t * edge[2]};
  return std::sqrt(dot(off, off));
}

}  // namespace

HullTwin::HullTwin(std::vector<Point> points, std::vector<Triangle> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)) {
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    Box box{corner(t, 0), corner(t, 0)};
    for (std::size_t k = 1; k < 3; ++k) {
      for (std::size_t a = 0; a < 3; ++a) {
        box.lower[a] = std::min(box.lower[a], corner(t, k)[a]);
        box.upper[a] = std::max(box.upper[a], corner(t, k)[a]);
      }
    }
    boxes_.push_back(box);
  }
}

bool HullTwin::has_area(std::size_t t) const {
  return plane_of(corner(t, 0), corner(t, 1), corner(t, 2)).has_value();
}

bool HullTwin::meets(const Point& p, const Point& q, std::size_t t) const {
  const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
  const int above_p = side(a, b, c, p), above_q = side(a, b, c, q);
  if (above_p * above_q > 0) return false;
  if (above_p == 0 && above_q == 0) {
    const auto plane = plane_of(a, b, c);
    if (!plane) return segments_meet(p, q, a, b, 0, 1);  // never asked: such triangles are reported first
    const auto [i, j] = *plane;
    const int x = turn(a, b, p, i, j), y = turn(b, c, p, i, j), z = turn(c, a, p, i, j);
    if (!(std::min({x, y, z}) < 0 && std::max({x, y, z}) > 0)) return true;
    return segments_meet(p, q, a, b, i, j) || segments_meet(p, q, b, c, i, j) ||
           segments_meet(p, q, c, a, i, j);
  }
  const int x = side(p, q, a, b), y = side(p, q, b, c), z = side(p, q, c, a);
  return !(std::min({x, y, z}) < 0 && std::max({x, y, z}) > 0);
}

bool HullTwin::share_too_much(std::size_t s, std::size_t t) const {
  const Triangle &a = triangles_[s], &b = triangles_[t];
  std::vector<std::size_t> in_a, in_b;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (a[i] == b[j]) in_a.push_back(i), in_b.push_back(j);
    }
  }
  if (in_a.size() > 2) return true;
  if (in_a.size() == 2) {
    // On an edge: too much only if both lie in one plane, on the same side of it.
    const Point &v = corner(s, in_a[0]), &w = corner(s, in_a[1]), &x = corner(s, 3 - in_a[0] - in_a[1]),
                &y = corner(t, 3 - in_b[0] - in_b[1]);
    if (side(v, w, x, y) != 0) return false;
    const auto [i, j] = *plane_of(v, w, x);
    return turn(v, w, x, i, j) * turn(v, w, y, i, j) > 0;
  }
  if (in_a.size() == 1) {
    // A common point beside the vertex leads, away from it, to the far side of one of them.
    const std::size_t i = in_a[0], j = in_b[0];
    return meets(corner(s, (i + 1) % 3), corner(s, (i + 2) % 3), t) ||
           meets(corner(t, (j + 1) % 3), corner(t, (j + 2) % 3), s);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (meets(corner(s, k), corner(s, (k + 1) % 3), t) || meets(corner(t, k), corner(t, (k + 1) % 3), s))
      return true;
  }
  return false;
}

std::vector<std::pair<std::size_t, std::size_t>> HullTwin::contacts() const {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  std::vector<std::size_t> order;
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    has_area(t) ? order.push_back(t) : found.push_back({t, t});
  std::sort(order.begin(), order.end(),
            [&](std::size_t s, std::size_t t) { return boxes_[s].lower[0] < boxes_[t].lower[0]; });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Box& own = boxes_[order[i]];
    for (std::size_t j = i + 1; j < order.size() && boxes_[order[j]].lower[0] <= own.upper[0]; ++j) {
      const Box& other = boxes_[order[j]];
      if (apart(own.lower, own.upper, other.lower, other.upper)) continue;
      if (share_too_much(order[i], order[j])) found.push_back(std::minmax(order[i], order[j]));
    }
  }
  return found;
}

std::size_t HullTwin::open_edges() const {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const Triangle& t : triangles_) {
    for (std::size_t k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
  }
  return static_cast<std::size_t>(std::count_if(runs.begin(), runs.end(), [&](const auto& run) {
    const auto back = runs.find({run.first.second, run.first.first});
    return run.second != 1 || back == runs.end() || back->second != 1;
  }));
}

std::optional<std::size_t> HullTwin::met_by(const Point& p, const Point& q) const {
  Point low, high;
  for (std::size_t a = 0; a < 3; ++a) std::tie(low[a], high[a]) = std::minmax({p[a], q[a]});
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!apart(boxes_[t].lower, boxes_[t].upper, low, high) && meets(p, q, t)) return t;
  }
  return std::nullopt;
}

std::optional<std::pair<std::size_t, std::size_t>> HullTwin::met_by(const HullTwin& other) const {
  for (std::size_t s = 0; s < triangles_.size(); ++s) {
    for (std::size_t t = 0; t < other.triangles_.size(); ++t) {
      if (apart(boxes_[s].lower, boxes_[s].upper, other.boxes_[t].lower, other.boxes_[t].upper)) continue;
      for (std::size_t k = 0; k < 3; ++k) {
        if (meets(other.corner(t, k), other.corner(t, (k + 1) % 3), s) ||
            other.meets(corner(s, k), corner(s, (k + 1) % 3), t)) {
          return std::pair{s, t};
        }
      }
    }
  }
  return std::nullopt;
}

std::optional<int> HullTwin::winding(const Point& q) const {
  double reach = 0;
  for (const Point& p : points_) {
    for (std::size_t a = 0; a < 3; ++a) reach = std::max(reach, std::fabs(p[a] - q[a]));
  }
  for (int attempt = 1; attempt < 50; ++attempt) {
    const Point far{q[0] + 4 * reach, q[1] + 0.11 * attempt * reach, q[2] + (2 - 0.07 * attempt) * reach};
    int crossings = 0;
    bool certain = true;
    for (std::size_t t = 0; t < triangles_.size() && certain; ++t) {
      const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
      const int x = side(q, far, a, b), y = side(q, far, b, c), z = side(q, far, c, a);
      if (std::min({x, y, z}) < 0 && std::max({x, y, z}) > 0) continue;
      const int below = side(a, b, c, q), above = side(a, b, c, far);
      if (below * above > 0) continue;
      certain = x * y * z != 0 && below * above != 0;
      crossings += above;
    }
    if (certain) return crossings;
  }
  return std::nullopt;
}

double HullTwin::distance(const Point& q) const {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    double outside = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      outside = std::max({outside, boxes_[t].lower[a] - q[a], q[a] - boxes_[t].upper[a]});
    }
    if (outside >= least) continue;
    const Point &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    const Point normal = cross(minus(b, a), minus(c, a));
    const double square = dot(normal, normal);
    const bool over = square > 0 && dot(cross(minus(b, a), minus(q, a)), normal) >= 0 &&
                      dot(cross(minus(c, b), minus(q, b)), normal) >= 0 &&
                      dot(cross(minus(a, c), minus(q, c)), normal) >= 0;
    const double own = over ? std::fabs(dot(minus(q, a), normal)) / std::sqrt(square)
                            : std::min({to_segment(q, a, b), to_segment(q, b, c), to_segment(q, c, a)});
    least = std::min(least, own);
  }
  return least;
}

}  // namespace oracle
