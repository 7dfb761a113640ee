#include <oracle/facet_twin.h>

#include <oracle/exact_vector.h>

#include <algorithm>

namespace oracle {

namespace {

using namespace exact_vectors;
using Polygon = std::vector<Vector>;

const mpq_class zero = 0;

Vector between(const Vector& p, const Vector& q, const mpq_class& t) {
  return {mpq_class(p[0] + t * (q[0] - p[0])), mpq_class(p[1] + t * (q[1] - p[1])),
          mpq_class(p[2] + t * (q[2] - p[2]))};
}

struct ExactFacet {
  Polygon corners;
  Vector normal;

  ExactFacet(const std::vector<Point>& points, const Triangle& t) {
    for (const auto v : t) corners.push_back(exact(points[v]));
    normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
  }
  // Positive inside of side k.
  [[nodiscard]] mpq_class inside(const Vector& p, std::size_t k) const {
    return dot(cross(normal, corners[(k + 1) % 3] - corners[k]), p - corners[k]);
  }
  [[nodiscard]] bool strictly_inside(const Vector& p) const {
    return inside(p, 0) > 0 && inside(p, 1) > 0 && inside(p, 2) > 0;
  }
};

// The part of a convex polygon, which may be a segment or a point, where the height is not negative, or is zero.
template <class Height>
Polygon cut(const Polygon& polygon, const Height& height, bool only_zero) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const mpq_class at_p = height(p), at_q = height(q);
    if (at_p == 0 || (at_p > 0 && !only_zero)) kept.push_back(p);
    if (sgn(at_p) * sgn(at_q) < 0) kept.push_back(between(p, q, at_p / (at_p - at_q)));
  }
  Polygon distinct;
  for (const Vector& p : kept)
    if (std::find(distinct.begin(), distinct.end(), p) == distinct.end()) distinct.push_back(p);
  return distinct;
}

}  // namespace

bool has_area(const std::vector<Point>& points, const Triangle& t) {
  return ExactFacet(points, t).normal != Vector{zero, zero, zero};
}

FacetRelation relation_of(const std::vector<Point>& points, const Triangle& a, const Triangle& b) {
  const ExactFacet one(points, a), other(points, b);
  const Vector none{zero, zero, zero};
  Polygon common = cut(
      one.corners, [&](const Vector& p) -> mpq_class { return dot(other.normal, p - other.corners[0]); },
      true);
  for (std::size_t k = 0; k < 3; ++k)
    common = cut(
        common, [&](const Vector& p) { return other.inside(p, k); }, false);
  // Beside what both name?
  Polygon named;
  for (const auto v : a)
    if (std::find(b.begin(), b.end(), v) != b.end()) named.push_back(exact(points[v]));
  const bool contact = std::any_of(common.begin(), common.end(), [&](const Vector& p) {
    if (named.empty() || named.size() == 3) return true;
    return cross(named.back() - named[0], p - named[0]) != none || (named.size() == 1 && p != named[0]);
  });
  if (!contact) return FacetRelation::none;
  if (cross(one.normal, other.normal) == none) {
    for (std::size_t i = 2; i < common.size(); ++i)
      if (cross(common[1] - common[0], common[i] - common[0]) != none) return FacetRelation::overlapping;
    return FacetRelation::touching;
  }
  if (common.size() < 2) return FacetRelation::touching;
  const Vector middle = between(common[0], common[1], mpq_class(1, 2));
  return one.strictly_inside(middle) && other.strictly_inside(middle) ? FacetRelation::crossing
                                                                      : FacetRelation::touching;
}

}  // namespace oracle
