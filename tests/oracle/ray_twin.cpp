#include <oracle/ray_twin.h>

#include <oracle/dual_twin.h>
#include <oracle/exact_vector.h>
#include <oracle/polygon_twin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace oracle {

namespace {

using Id = std::uint32_t;
using namespace exact_vectors;
bool is_zero(const Vector& a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// Of a face with a corner that bends; that of a convex one.
Vector normal_of(const std::vector<Vector>& points, const std::vector<Id>& face) {
  const std::size_t n = face.size();
  for (std::size_t k = 0; k < n; ++k) {
    const Vector& p = points[face[k]];
    const Vector normal = cross(points[face[(k + 1) % n]] - p, points[face[(k + 2) % n]] - p);
    if (!is_zero(normal)) return normal;
  }
  return {};
}

double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double size(const Point& a) { return std::max({std::fabs(a[0]), std::fabs(a[1]), std::fabs(a[2])}); }

}  // namespace

FlatFaces::FlatFaces(const std::vector<Point>& points, std::vector<std::vector<Id>> faces)
    : faces_(std::move(faces)) {
  for (const Point& p : points) points_.push_back(exact(p));
  for (const auto& face : faces_) normals_.push_back(normal_of(points_, face));
}

std::vector<ExactHit> FlatFaces::hits(const Point& origin, const Point& direction) const {
  const Vector from = exact(origin), along = exact(direction);
  std::vector<ExactHit> list;
  for (Id f = 0; f < faces_.size(); ++f) {
    const auto& face = faces_[f];
    const Vector& normal = normals_[f];
    const mpq_class slope = dot(normal, along), height = dot(normal, points_[face[0]] - from);
    if (slope == 0) {
      if (height != 0) continue;
      for (std::size_t k = 0; k < face.size(); ++k) {
        // (from + t along - p) x edge = 0, by its part along the normal.
        const Vector &p = points_[face[k]], edge = points_[face[(k + 1) % face.size()]] - p;
        const mpq_class turn = dot(cross(along, edge), normal), square = dot(edge, edge);
        if (turn == 0) {
          if (is_zero(cross(p - from, along)))
            list.push_back({mpq_class(dot(p - from, along) / dot(along, along)), f, 0, true});
          continue;
        }
        const mpq_class t = dot(cross(p - from, edge), normal) / turn;
        const Vector at{mpq_class(from[0] + t * along[0]), mpq_class(from[1] + t * along[1]),
                        mpq_class(from[2] + t * along[2])};
        const mpq_class share = dot(at - p, edge);
        if (share >= 0 && share <= square) list.push_back({t, f, 0, true});
      }
      continue;
    }
    const mpq_class t = height / slope;
    const Vector at{mpq_class(from[0] + t * along[0]), mpq_class(from[1] + t * along[1]),
                    mpq_class(from[2] + t * along[2])};
    bool inside = true, border = false;
    for (std::size_t k = 0; k < face.size() && inside; ++k) {
      const Vector &p = points_[face[k]], &q = points_[face[(k + 1) % face.size()]];
      const int side = sgn(dot(cross(q - p, at - p), normal));
      inside = side >= 0;
      border = border || side == 0;
    }
    if (inside) list.push_back({t, f, sgn(slope), border});
  }
  std::sort(list.begin(), list.end(), [](const ExactHit& x, const ExactHit& y) { return x.t < y.t; });
  return list;
}

bool is_flat_and_convex(const std::vector<Point>& points, const std::vector<Id>& face) {
  std::vector<Vector> corners;
  std::vector<Id> ids;
  for (const Id v : face) {
    ids.push_back(static_cast<Id>(corners.size()));
    corners.push_back(exact(points[v]));
  }
  const Vector normal = normal_of(corners, ids);
  if (is_zero(normal)) return false;
  const std::size_t n = corners.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = 0; i < n; ++i) {
      if (dot(normal, corners[i] - corners[0]) != 0) return false;
      const Vector edge = corners[(k + 1) % n] - corners[k];
      const int side = sgn(dot(cross(edge, corners[i] - corners[k]), normal));
      const bool own = i == k || i == (k + 1) % n;
      if (own ? side != 0 : side <= 0) return false;
    }
  return true;
}

bool is_generic(const std::vector<ExactHit>& hits) {
  return std::none_of(hits.begin(), hits.end(), [](const ExactHit& hit) { return hit.border; });
}

RefinedRays::RefinedRays(const TaggedMesh& mesh, const WindingScheme& scheme, int levels) {
  const Rules* const rules = std::get_if<Rules>(&scheme);
  mesh_ = rules ? refine(mesh, *rules, levels) : WindingTwin(mesh, scheme, levels).mesh();
  std::vector<std::vector<Id>> faces_at(mesh_.points.size());
  std::map<std::pair<Id, Id>, std::pair<int, int>> runs;  // of faces along an edge, and against it
  for (Id f = 0; f < mesh_.polygons.size(); ++f) {
    const auto& polygon = mesh_.polygons[f];
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Id v = polygon[k], w = polygon[(k + 1) % polygon.size()];
      faces_at[v].push_back(f);
      auto& [forward, backward] = runs[std::minmax(v, w)];
      ++(v < w ? forward : backward);
    }
  }
  std::vector<char> no_surface(mesh_.polygons.size(), 0);
  for (const Id f : mesh_.holes) no_surface[f] = 1;
  if (rules && rules->boundary == Boundary::none) {
    for (const auto& [edge, count] : runs)
      if (count.first + count.second != 2)
        for (const Id v : {edge.first, edge.second})
          for (const Id f : faces_at[v]) no_surface[f] = 1;
  }
  const double infinity = std::numeric_limits<double>::infinity();
  const auto grow = [&](Box& box, Id v) {
    for (const Id f : faces_at[v]) {
      const auto& polygon = mesh_.polygons[f];
      box.open = box.open || no_surface[f];
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Id w = polygon[k];
        const auto& [forward, backward] = runs[std::minmax(w, polygon[(k + 1) % polygon.size()])];
        box.open = box.open || forward != 1 || backward != 1;
        for (std::size_t x = 0; x < 3; ++x) {
          const double slack = 1e-12 * size(mesh_.points[w]);
          box.lower[x] = std::min(box.lower[x], mesh_.points[w][x] - slack);
          box.upper[x] = std::max(box.upper[x], mesh_.points[w][x] + slack);
        }
      }
    }
  };
  const Box empty{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}, false};
  if (rules) {
    for (const auto& polygon : mesh_.polygons) {
      boxes_.push_back(empty);
      for (const Id v : polygon) grow(boxes_.back(), v);
    }
  } else {
    for (Id v = 0; v < mesh_.points.size(); ++v) {
      if (faces_at[v].empty()) continue;
      boxes_.push_back(empty);
      grow(boxes_.back(), v);
    }
  }
}

std::vector<RefinedRays::Range> RefinedRays::ranges(const Point& origin, const Point& direction) const {
  struct Part {
    double lower, upper;
    bool open;
  };
  std::vector<Part> parts;
  for (const Box& box : boxes_) {
    double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
    for (std::size_t x = 0; x < 3 && lower <= upper; ++x) {
      const double slack = 1e-14 * std::fabs(origin[x]);
      const double a = box.lower[x] - origin[x] - slack, b = box.upper[x] - origin[x] + slack;
      if (direction[x] == 0) {
        if (a > 0 || b < 0) upper = -std::numeric_limits<double>::infinity();
        continue;
      }
      double s = a / direction[x], t = b / direction[x];
      if (s > t) std::swap(s, t);
      lower = std::max(lower, s - 1e-14 * std::fabs(s));
      upper = std::min(upper, t + 1e-14 * std::fabs(t));
    }
    if (lower <= upper) parts.push_back({lower, upper, box.open});
  }
  std::sort(parts.begin(), parts.end(), [](const Part& x, const Part& y) { return x.lower < y.lower; });
  std::vector<Range> list;
  for (const Part& part : parts) {
    if (list.empty() || part.lower > list.back().upper) list.push_back({part.lower, part.upper});
    list.back().upper = std::max(list.back().upper, part.upper);
    if (part.open) list.back().crossings.reset();
  }
  if (list.empty()) return list;
  const double length = size(direction);
  for (const auto& polygon : mesh_.polygons) {
    for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
      std::array<Point, 3> p;
      double largest = 0;
      const std::array<Id, 3> ids{polygon[0], polygon[k], polygon[k + 1]};
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t x = 0; x < 3; ++x) {
          p[i][x] = mesh_.points[ids[i]][x] - origin[x];
          largest = std::max({largest, std::fabs(p[i][x]), std::fabs(mesh_.points[ids[i]][x])});
        }
      const double least = 1e-12 * length * largest * largest;
      std::array<double, 3> turn;
      for (std::size_t i = 0; i < 3; ++i) turn[i] = dot(direction, cross(p[i], p[(i + 1) % 3]));
      if (*std::max_element(turn.begin(), turn.end()) > least &&
          *std::min_element(turn.begin(), turn.end()) < -least)
        continue;
      const double square = dot(direction, direction);
      std::array<double, 3> at;
      for (std::size_t i = 0; i < 3; ++i) at[i] = dot(p[i], direction) / square;
      double lower = *std::min_element(at.begin(), at.end()), upper = *std::max_element(at.begin(), at.end());
      const bool certain =
          std::none_of(turn.begin(), turn.end(), [&](double x) { return std::fabs(x) <= least; });
      if (certain) {  // the place on the line is known up to a thousandth of the triangle
        const double whole = turn[0] + turn[1] + turn[2], width = 1e-3 * (upper - lower);
        lower = upper = (turn[1] * at[0] + turn[2] * at[1] + turn[0] * at[2]) / whole;
        lower -= width;
        upper += width;
      }
      Range* only = nullptr;
      std::size_t possible = 0;
      for (Range& range : list) {
        if (range.lower > upper || lower > range.upper) continue;
        only = &range;
        ++possible;
      }
      if (certain && possible == 1) {
        if (only->crossings) *only->crossings += turn[0] > 0 ? 1 : -1;
      } else {
        for (Range& range : list)
          if (!(range.lower > upper || lower > range.upper)) range.crossings.reset();
      }
    }
  }
  return list;
}

}  // namespace oracle
