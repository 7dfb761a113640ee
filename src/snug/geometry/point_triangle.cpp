#include <snug/geometry/point_triangle.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <snug/geometry/double_double.h>
#include <snug/geometry/rounding.h>
#include <support/direction.h>

namespace snug {
namespace {

// One rounding of a number, relative to it: more than that of double-doubles, whose products may underflow.
template <class Number>
constexpr double roundoff = std::is_same_v<Number, double> ? unit_roundoff : 0x1p-98;

double rounded(double x) { return x; }
double rounded(DoubleDouble x) { return x.high; }
template <class Number>
Number number(double x) {
  if constexpr (std::is_same_v<Number, double>) {
    return x;
  } else {
    return {x, 0};
  }
}
template <class Number>
double length_of(const Vector3Of<Number>& v) {
  return std::sqrt(rounded(dot(v, v)));
}

// Weights as doubles that are a point of the triangle; those on its far edge stay there.
Barycentric inside(double b, double c, bool on_far_edge) {
  b = std::clamp(b, 0.0, 1.0);
  c = std::clamp(c, 0.0, 1.0);
  const DoubleDouble sum = exact_sum(b, c);
  if (!on_far_edge && (sum.high < 1 || (sum.high == 1 && sum.low <= 0))) return {b, c};
  return b >= c ? Barycentric{b, 1 - b} : Barycentric{1 - c, c};  // exact: the larger one is at least 1/2
}

template <class Number>
struct Seen {
  explicit Seen(const Point3& point, const Triangle& triangle)
      : edge_b(difference<Number>(triangle[0], triangle[1])),
        edge_c(difference<Number>(triangle[0], triangle[2])) {
    for (std::size_t k = 0; k < 3; ++k) from[k] = difference<Number>(triangle[k], point);
  }

  // The foot on the plane, if inside, or the nearest of three points on the edges. Sets `normal` to a direction across that face,
  // edge or corner.
  Barycentric foot(Vector3Of<Number>& normal) const {
    const Vector3Of<Number> n = cross(edge_b, edge_c);
    const Number size = dot(n, n);
    if (rounded(size) > 0x1p-780) {  // of smaller ones the edges are all that matters
      const Number b = dot(cross(from[0], edge_c), n) / size, c = dot(cross(edge_b, from[0]), n) / size;
      const Number a = number<Number>(1) - b - c;
      if (rounded(a) > 0 && rounded(b) > 0 && rounded(c) > 0) {
        normal = rounded(dot(n, from[0])) < 0 ? number<Number>(-1) * n : n;
        return inside(rounded(b), rounded(c), false);
      }
    }
    std::array<Number, 3> share;
    double least = INFINITY;
    std::size_t nearest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector3Of<Number> edge = from[k] - from[(k + 1) % 3];
      const Number square = dot(edge, edge);
      share[k] = rounded(square) > 0 ? dot(from[k], edge) / square : number<Number>(0);
      if (!(rounded(share[k]) > 0)) share[k] = number<Number>(0);
      if (!(rounded(share[k]) < 1)) share[k] = number<Number>(1);
      const Vector3Of<Number> rest = from[k] - share[k] * edge;
      const double distance = rounded(dot(rest, rest));
      if (!(distance < least)) continue;
      least = distance;
      nearest = k;
      normal = rest;
    }
    const double on = rounded(share[nearest]);
    if (nearest == 0) return inside(on, 0, false);
    if (nearest == 1) return inside(1 - on, on, true);
    return inside(0, on == 1 ? 0 : rounded(number<Number>(1) - share[2]), false);
  }

  PointTriangleDistance distance() const {
    Vector3Of<Number> normal{};
    PointTriangleDistance result{0, 0, foot(normal)};
    const Vector3Of<Number> rest =
        from[0] - number<Number>(result.foot.b) * edge_b - number<Number>(result.foot.c) * edge_c;
    double size = 0;
    std::array<double, 3> reach;
    for (std::size_t k = 0; k < 3; ++k) {
      reach[k] = length_of(from[k]);
      size = std::max(size, reach[k]);
    }
    constexpr double tiny = 0x1p-400;  // what underflows is below that by far
    result.upper = length_of(rest) * (1 + 8 * unit_roundoff) + 20 * roundoff<Number> * size + tiny;
    const double norm = length_of(normal);
    if (!(norm > tiny)) return result;
    double lower = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      lower = std::min(lower, rounded(dot(normal, from[k])) / norm - 6 * roundoff<Number> * reach[k]);
    }
    result.lower = std::max(0.0, lower * (1 - 16 * unit_roundoff) - tiny);
    return result;
  }

  std::array<Vector3Of<Number>, 3> from;  // the corners, to the point
  Vector3Of<Number> edge_b, edge_c;
};

}  // namespace

PointTriangleDistance distance_between(const Point3& point, const Triangle& triangle, double size) {
  const PointTriangleDistance found = Seen<double>(point, triangle).distance();
  if (found.upper - found.lower <= 64 * unit_roundoff * (found.upper + size)) return found;
  return Seen<DoubleDouble>(point, triangle).distance();
}

Facing facing(const Point3& point, const Triangle& triangle, Barycentric foot) {
  const Vector3 edge_b = triangle[1] - triangle[0], edge_c = triangle[2] - triangle[0];
  const Vector3 way = normalized(point - triangle[0] - foot.b * edge_b - foot.c * edge_c);
  Facing result;
  result.cosine = std::fabs(dot(normalized(cross(edge_b, edge_c)), way));
  const std::size_t corner = foot.b == 1 ? 1 : foot.c == 1 ? 2 : foot.b == 0 && foot.c == 0 ? 0 : 3;
  if (corner == 3) return result;
  const Point3& at = triangle[corner];
  result.steepness = std::min(0.0, std::max(dot(normalized(triangle[(corner + 1) % 3] - at), way),
                                            dot(normalized(triangle[(corner + 2) % 3] - at), way)));
  return result;
}

}  // namespace snug
