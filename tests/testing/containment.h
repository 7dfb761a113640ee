#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <oracle/quad.h>
#include <snug/bounds/enclosure.h>

/// Containment in extended precision, written anew: shares no arithmetic with bounds/. Long double is fast,
/// quadruple precision has the last word on slivers.
namespace snug::testing {

using oracle::Quad;

template <class Real>
using Coordinates = std::array<Real, 3>;
using Extended = Coordinates<long double>;

template <class Real = long double>
[[nodiscard]] Coordinates<Real> extended(const Point3& p) {
  return {p.x, p.y, p.z};
}
template <class Real>
[[nodiscard]] Coordinates<Real> minus(const Coordinates<Real>& a, const Coordinates<Real>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Real>
[[nodiscard]] Real inner(const Coordinates<Real>& a, const Coordinates<Real>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Square of the distance of a point to a triangle: the least over its edges and, where the foot is inside,
/// its plane.
template <class Real>
[[nodiscard]] Real distance_sq_to_triangle(const Coordinates<Real>& p, const Triangle& triangle) {
  const auto a = extended<Real>(triangle[0]), b = extended<Real>(triangle[1]),
             c = extended<Real>(triangle[2]);
  const auto rest = [](const Coordinates<Real>& r, Real s, const Coordinates<Real>& d, Real t,
                       const Coordinates<Real>& e) {
    const Coordinates<Real> x{r[0] - s * d[0] - t * e[0], r[1] - s * d[1] - t * e[1],
                              r[2] - s * d[2] - t * e[2]};
    return inner(x, x);
  };
  Real best = inner(minus(p, a), minus(p, a));
  const std::array<std::array<Coordinates<Real>, 2>, 3> edges{{{a, b}, {b, c}, {c, a}}};
  for (const auto& [s, e] : edges) {
    const auto d = minus(e, s), r = minus(p, s);
    const Real dd = inner(d, d);
    Real t = dd > 0 ? inner(r, d) / dd : Real(0);
    t = t < 0 ? Real(0) : t > 1 ? Real(1) : t;
    const Real found = rest(r, t, d, Real(0), d);
    if (found < best) best = found;
  }
  const auto e1 = minus(b, a), e2 = minus(c, a), r = minus(p, a);
  const Real g11 = inner(e1, e1), g12 = inner(e1, e2), g22 = inner(e2, e2), det = g11 * g22 - g12 * g12;
  if (det > 0) {
    const Real u = (g22 * inner(r, e1) - g12 * inner(r, e2)) / det;
    const Real v = (g11 * inner(r, e2) - g12 * inner(r, e1)) / det;
    if (u >= 0 && v >= 0 && u + v <= 1) {
      const Real found = rest(r, u, e1, v, e2);
      if (found < best) best = found;
    }
  }
  return best;
}

[[nodiscard]] inline long double distance_to_triangle(const Extended& p, const Triangle& triangle) {
  return std::sqrt(distance_sq_to_triangle(p, triangle));
}

/// Is a point within `radius` of the triangle? None is within a negative radius.
[[nodiscard]] inline bool within_radius(const Extended& p, const Triangle& triangle, long double radius) {
  if (!(radius >= 0)) return false;
  if (distance_sq_to_triangle(p, triangle) <= radius * radius) return true;
  const Coordinates<Quad> q{p[0], p[1], p[2]};
  return distance_sq_to_triangle(q, triangle) <= Quad(radius) * Quad(radius);
}

/// Are there l >= 0, sum 1, with sum l lower <= p <= sum l upper, each side eased by `slack`? Clips the
/// triangle of l.
template <class Real>
[[nodiscard]] bool clips_to_something(const Coordinates<Real>& p, const IntervalTriangle& triangle,
                                      Real slack) {
  std::vector<Coordinates<Real>> polygon{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      Coordinates<Real> g{};
      for (std::size_t k = 0; k < 3; ++k) {
        const Box3& box = triangle.corner[k];
        g[k] = side == 0 ? Real(box.lower[axis]) - p[axis] - slack : p[axis] - slack - Real(box.upper[axis]);
      }
      std::vector<Coordinates<Real>> kept;  // where inner(g, l) <= 0
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& u = polygon[i];
        const auto& v = polygon[(i + 1) % polygon.size()];
        const Real du = inner(g, u), dv = inner(g, v);
        if (du <= 0) kept.push_back(u);
        if ((du < 0 && dv > 0) || (du > 0 && dv < 0)) {
          const Real t = du / (du - dv);
          kept.push_back({u[0] + t * (v[0] - u[0]), u[1] + t * (v[1] - u[1]), u[2] + t * (v[2] - u[2])});
        }
      }
      polygon = std::move(kept);
      if (polygon.empty()) return false;
    }
  }
  return true;
}

[[nodiscard]] inline bool in_interval_triangle(const Extended& p, const IntervalTriangle& triangle,
                                               long double slack) {
  return clips_to_something(p, triangle, slack) ||
         clips_to_something<Quad>({p[0], p[1], p[2]}, triangle, Quad(slack));
}

}  // namespace snug::testing
