#pragma once

#include <algorithm>
#include <vector>

#include <oracle/exact_vector.h>

/// What plane convex polygons have in common, in rational arithmetic.
namespace oracle::plane_facets {

using namespace exact_vectors;
using Polygon = std::vector<Vector>;

[[nodiscard]] inline Vector normal_of(const Polygon& polygon) {
  return cross(polygon[1] - polygon[0], polygon[2] - polygon[0]);
}

/// Cuts a polygon, or what is left of one, to where f >= 0.
template <class F>
[[nodiscard]] Polygon cut(const Polygon& polygon, const F& f) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class of_p = f(p), of_q = f(q);
    if (of_p >= 0) kept.push_back(p);
    if (of_p * of_q < 0) {
      const mpq_class share = of_p / (of_p - of_q);
      Vector x;
      for (std::size_t k = 0; k < 3; ++k) x[k] = p[k] + share * (q[k] - p[k]);
      kept.push_back(x);
    }
  }
  return kept;
}

/// The corners of it, in any order: b cut to the plane of a, and to the inside of each of its edges.
/// Requires:  a has an area.
[[nodiscard]] inline Polygon common_corners(const Polygon& a, const Polygon& b) {
  const Vector n = normal_of(a);
  Polygon rest = cut(b, [&](const Vector& x) { return dot(n, x - a[0]); });
  rest = cut(rest, [&](const Vector& x) { return mpq_class(-dot(n, x - a[0])); });
  for (std::size_t i = 0; i < a.size() && !rest.empty(); ++i) {
    const Vector inward = cross(n, a[(i + 1) % a.size()] - a[i]);
    rest = cut(rest, [&](const Vector& x) { return dot(inward, x - a[i]); });
  }
  std::sort(rest.begin(), rest.end());
  rest.erase(std::unique(rest.begin(), rest.end()), rest.end());
  // Those between two others are none.
  const auto between_others = [&](const Vector& x) {
    for (const Vector& p : rest) {
      for (const Vector& q : rest) {
        if (p != x && q != x && cross(p - x, q - x) == Vector{} && dot(p - x, q - x) < 0) return true;
      }
    }
    return false;
  };
  Polygon extreme;
  std::copy_if(rest.begin(), rest.end(), std::back_inserter(extreme),
               [&](const Vector& x) { return !between_others(x); });
  return extreme;
}

}  // namespace oracle::plane_facets
