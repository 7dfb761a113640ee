#include <oracle/polyhedron_twin.h>

#include <oracle/exact_vector.h>

#include <algorithm>
#include <stdexcept>

namespace oracle {

namespace {

using namespace exact_vectors;

mpq_class to_segment(const Vector& q, const Vector& a, const Vector& b) {
  const Vector edge = b - a, from = q - a;
  const mpq_class square = dot(edge, edge);
  mpq_class t = square == 0 ? mpq_class(0) : mpq_class(dot(from, edge) / square);
  t = std::clamp(t, mpq_class(0), mpq_class(1));
  const Vector off{mpq_class(from[0] - t * edge[0]), mpq_class(from[1] - t * edge[1]),
                   mpq_class(from[2] - t * edge[2])};
  return dot(off, off);
}

mpq_class to_triangle(const Vector& q, const std::array<Vector, 3>& t) {
  const Vector normal = cross(t[1] - t[0], t[2] - t[0]);
  const mpq_class square = dot(normal, normal);
  bool above = square != 0;
  for (std::size_t k = 0; k < 3 && above; ++k) {
    above = dot(cross(t[(k + 1) % 3] - t[k], q - t[k]), normal) >= 0;
  }
  if (above) {
    const mpq_class height = dot(q - t[0], normal);
    return height * height / square;
  }
  return std::min({to_segment(q, t[0], t[1]), to_segment(q, t[1], t[2]), to_segment(q, t[2], t[0])});
}

int sign(const mpq_class& x) { return sgn(x); }

}  // namespace

PolyhedronTwin::PolyhedronTwin(const std::vector<Point>& points, const std::vector<Triangle>& triangles) {
  for (const Triangle& t : triangles) {
    triangles_.push_back({exact(points[t[0]]), exact(points[t[1]]), exact(points[t[2]])});
  }
}

mpq_class PolyhedronTwin::squared_distance(const Point& q) const {
  const Vector at = exact(q);
  mpq_class least = to_triangle(at, triangles_[0]);
  for (const auto& t : triangles_) least = std::min(least, to_triangle(at, t));
  return least;
}

std::optional<int> PolyhedronTwin::winding(const Point& q) const {
  if (squared_distance(q) == 0) return std::nullopt;
  const Vector at = exact(q);
  for (int attempt = 1; attempt < 100; ++attempt) {
    const Vector ray{mpq_class(1 + 7 * attempt), mpq_class(101 - 3 * attempt),
                     mpq_class(37 + attempt * attempt)};
    int crossings = 0;
    bool certain = true;
    for (const auto& t : triangles_) {
      const Vector normal = cross(t[1] - t[0], t[2] - t[0]);
      if (dot(normal, normal) == 0) continue;  // without area: what crosses it crosses edges of others
      const Vector a = t[0] - at, b = t[1] - at, c = t[2] - at;
      const int x = sign(dot(ray, cross(a, b))), y = sign(dot(ray, cross(b, c))),
                z = sign(dot(ray, cross(c, a)));
      if (std::max({x, y, z}) > 0 && std::min({x, y, z}) < 0) continue;
      if (x == 0 || y == 0 || z == 0) {
        certain = false;
        break;
      }
      if (sign(dot(a, cross(b, c))) == x) crossings += x;
    }
    if (certain) return crossings;
  }
  throw std::logic_error("no ray misses all edges");
}

}  // namespace oracle
