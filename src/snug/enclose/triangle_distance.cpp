#include <snug/enclose/triangle_distance.h>

#include <algorithm>
#include <cmath>

#include <snug/base/rounding.h>

namespace snug {
namespace {

using Corners = std::array<Vector3, 3>;

double clamped(double t) { return t > 0 ? std::min(t, 1.0) : 0.0; }  // a NaN becomes 0

struct Best {
  double distance_sq = INFINITY;
  Barycentric on_a, on_b;
};

Barycentric on_edge(std::size_t edge, double t) {
  switch (edge) {
    case 0:
      return {t, 0};
    case 1:
      return {1 - t, t};
    default:
      return {0, 1 - t};
  }
}

Vector3 at(const Corners& c, Barycentric p) { return c[0] + p.b * (c[1] - c[0]) + p.c * (c[2] - c[0]); }

void try_pair(const Corners& a, Barycentric on_a, const Corners& b, Barycentric on_b, Best& best) {
  const double distance_sq = length_sq(at(b, on_b) - at(a, on_a));
  if (distance_sq < best.distance_sq) best = {distance_sq, on_a, on_b};
}

// Nearest parameters of the segments p + s d and q + t e.
void nearest_on_segments(Vector3 p, Vector3 d, Vector3 q, Vector3 e, double& s, double& t) {
  const Vector3 r = p - q;
  const double dd = length_sq(d), ee = length_sq(e), de = dot(d, e), dr = dot(d, r), er = dot(e, r);
  const double denominator = dd * ee - de * de;
  s = denominator > 0 ? clamped((de * er - dr * ee) / denominator) : 0;
  t = ee > 0 ? (de * s + er) / ee : 0;
  if (!(t >= 0 && t <= 1)) {
    t = clamped(t);
    s = dd > 0 ? clamped((de * t - dr) / dd) : 0;
  }
}

// Where an edge of `a` passes through the inside of `b`.
bool pierces(const Corners& a, const Corners& b, std::size_t edge, double& t, Barycentric& on_b) {
  const Vector3 p = a[edge], d = a[(edge + 1) % 3] - p;
  const Vector3 e1 = b[1] - b[0], e2 = b[2] - b[0];
  const Vector3 h = cross(d, e2);
  const double det = dot(e1, h);
  if (det == 0) return false;
  const Vector3 s = p - b[0];
  const Vector3 q = cross(s, e1);
  on_b = {dot(s, h) / det, dot(d, q) / det};
  t = dot(e2, q) / det;
  return t >= 0 && t <= 1 && on_b.b >= 0 && on_b.c >= 0 && on_b.b + on_b.c <= 1;
}

// Does a plane of one of them have the other one on one side? Then no edge pierces anything.
bool apart_by_planes(const Corners& a, const Corners& b) {
  const auto one_side = [](const Corners& plane, const Corners& other) {
    const Vector3 normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
    const double x = dot(normal, other[0] - plane[0]), y = dot(normal, other[1] - plane[0]),
                 z = dot(normal, other[2] - plane[0]);
    return (x > 0 && y > 0 && z > 0) || (x < 0 && y < 0 && z < 0);
  };
  return one_side(a, b) || one_side(b, a);
}

Best search(const Corners& a, const Corners& b) {
  Best best;
  const bool apart = apart_by_planes(a, b);
  for (std::size_t i = 0; i < 3 && !apart; ++i) {
    double t = 0;
    Barycentric inside;
    if (pierces(a, b, i, t, inside)) return {0, on_edge(i, t), inside};
    if (pierces(b, a, i, t, inside)) return {0, inside, on_edge(i, t)};
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double s = 0, t = 0;
      nearest_on_segments(a[i], a[(i + 1) % 3] - a[i], b[j], b[(j + 1) % 3] - b[j], s, t);
      try_pair(a, on_edge(i, s), b, on_edge(j, t), best);
    }
  }
  constexpr Barycentric corner[3] = {{0, 0}, {1, 0}, {0, 1}};
  const TriangleFoot on_a(a[0], a[1], a[2]), on_b(b[0], b[1], b[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    try_pair(a, corner[k], b, on_b(a[k]), best);
    try_pair(a, on_a(b[k]), b, corner[k], best);
  }
  return best;
}

// Lower bound of the distance along the direction w.
double supporting_gap(const Corners& a, const Corners& b, Vector3 w) {
  const double size =
      std::sqrt(length_sq(w) + 8 * underflow_error);  // where squares underflow, w gets shorter
  if (!(size > 0) || !std::isfinite(1 / size)) return 0;
  w = (1 / size) * w;
  double highest_a = -INFINITY, lowest_b = INFINITY, reach = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    highest_a = std::max(highest_a, dot(w, a[k]));
    lowest_b = std::min(lowest_b, dot(w, b[k]));
    reach = std::max({reach, max_abs(a[k]), max_abs(b[k])});
  }
  // |w| <= 1 + 6 u; two dot products of sum |w_i| |x_i| <= 2 reach and a difference.
  const double gap =
      (lowest_b - highest_a) * (1 - 16 * unit_roundoff) - 24 * unit_roundoff * reach - 16 * underflow_error;
  return std::isfinite(gap) ? std::max(0.0, gap) : 0.0;
}

}  // namespace

NearestTriangles nearest(const Triangle& first, const Triangle& second) {
  // Relative to one corner: triangles far from the coordinates' origin lose nothing. Each difference errs by
  // half a unit in its last place; the gap is lowered for it below.
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  const Best best = search(a, b);
  double gap = 0;
  if (best.distance_sq > 0) gap = supporting_gap(a, b, at(b, best.on_b) - at(a, best.on_a));
  double reach = 0;
  for (std::size_t k = 0; k < 3; ++k) reach = std::max({reach, max_abs(a[k]), max_abs(b[k])});
  return {best.on_a, best.on_b, std::max(0.0, gap - 4 * unit_roundoff * reach)};
}

std::optional<PairOfPoints> middle_of_contact(const Triangle& first, const Triangle& second) {
  const Point3 origin = first[0];
  const Corners a{Vector3{}, first[1] - origin, first[2] - origin};
  const Corners b{second[0] - origin, second[1] - origin, second[2] - origin};
  PairOfPoints sum;
  int count = 0;
  const auto add = [&](Barycentric on_a, Barycentric on_b) {
    sum.on_a = {sum.on_a.b + on_a.b, sum.on_a.c + on_a.c};
    sum.on_b = {sum.on_b.b + on_b.b, sum.on_b.c + on_b.c};
    ++count;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    double t = 0;
    Barycentric inside;
    if (pierces(a, b, i, t, inside)) add(on_edge(i, t), inside);
    if (pierces(b, a, i, t, inside)) add(inside, on_edge(i, t));
  }
  if (count == 0) return std::nullopt;
  const double share = 1.0 / count;
  return PairOfPoints{{share * sum.on_a.b, share * sum.on_a.c}, {share * sum.on_b.b, share * sum.on_b.c}};
}

}  // namespace snug
