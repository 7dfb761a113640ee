#include <snug/search/feet.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/search/piece.h>
#include <support/direction.h>

namespace snug {
namespace {

using Corners = std::array<TriangleParameter, 3>;

// Of the largest bend: how far means of three points are from a quadratic, at most.
constexpr double between_feet = 0.5;

constexpr Corners whole_triangle{TriangleParameter{0, 0}, {1, 0}, {0, 1}};

std::array<Corners, 4> quarters(const Corners& of) {
  Corners m;
  for (std::size_t k = 0; k < 3; ++k) {
    const TriangleParameter a = of[k], b = of[(k + 1) % 3];
    m[k] = {(a.u + b.u) / 2, (a.v + b.v) / 2};
  }
  return {Corners{of[0], m[0], m[2]}, {m[0], of[1], m[1]}, {m[2], m[1], of[2]}, {m[1], m[2], m[0]}};
}

// The polar form at two parameters; relative to corner 0, so that little is lost.
Point3 blossom(const QuadraticTriangle& q, TriangleParameter s, TriangleParameter t) {
  const double ws = 1 - s.u - s.v, wt = 1 - t.u - t.v;
  const Point3 o = q.corners[0];
  return o + s.u * t.u * (q.corners[1] - o) + s.v * t.v * (q.corners[2] - o) +
         (ws * t.u + s.u * wt) * (q.middles[0] - o) + (s.u * t.v + s.v * t.u) * (q.middles[1] - o) +
         (s.v * wt + ws * t.v) * (q.middles[2] - o);
}

Point3 flat_point(const Triangle& t, TriangleParameter at) {
  return t[0] + at.u * (t[1] - t[0]) + at.v * (t[2] - t[0]);
}

Vector3 bend(const QuadraticTriangle& q, std::size_t k) {
  return (q.middles[k] - q.corners[k]) + (q.middles[k] - q.corners[(k + 1) % 3]);
}

double largest_bend(const QuadraticTriangle& q) {
  return std::sqrt(std::max({length_sq(bend(q, 0)), length_sq(bend(q, 1)), length_sq(bend(q, 2))}));
}

Point3 middle_of_side(const QuadraticTriangle& q, std::size_t k) {
  return q.middles[k] + 0.25 * ((q.corners[k] - q.middles[k]) + (q.corners[(k + 1) % 3] - q.middles[k]));
}

bool is_curved(const QuadraticTriangle& q) {
  return max_abs(bend(q, 0)) > 0x1p-50 || max_abs(bend(q, 1)) > 0x1p-50 || max_abs(bend(q, 2)) > 0x1p-50;
}

double clamped(double x) { return x > 0 ? std::min(x, 1.0) : 0; }

// The foot on a flat triangle [Ericson05, sec. 5.1.5], by the regions of its plane.
TriangleParameter foot_by_regions(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
  const Vector3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  const Vector3 bp = p - b;
  const double d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {d1 - d3 > 0 ? clamped(d1 / (d1 - d3)) : 0, 0};
  const Vector3 cp = p - c;
  const double d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 - d6 > 0 ? clamped(d2 / (d2 - d6)) : 0};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double sum = (d4 - d3) + (d5 - d6);
    const double t = sum > 0 ? clamped((d4 - d3) / sum) : 0;
    return {1 - t, t};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0)) return {0, 0};
  const double u = clamped(vb / sum);
  return {u, std::min(clamped(vc / sum), 1 - u)};
}

// The same where the triangle is narrow or without area: on each edge, and inside by the longest one and what is across it.
TriangleParameter narrow_foot(const Triangle& t, const Point3& p) {
  std::size_t first = 0;  // of the longest edge
  double longest = -1;
  std::array<double, 3> best{1, 0, 0};
  double least = INFINITY;
  const auto see = [&](const std::array<double, 3>& weights) {
    const double square = length_sq((t[0] - p) + weights[1] * (t[1] - t[0]) + weights[2] * (t[2] - t[0]));
    if (!(square < least)) return;
    least = square;
    best = weights;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vector3 edge = t[next] - t[k];
    const double square = length_sq(edge), share = square > 0 ? clamped(dot(edge, p - t[k]) / square) : 0;
    std::array<double, 3> weights{};
    weights[k] = 1 - share;
    weights[next] = share;
    see(weights);
    if (square > longest) {
      longest = square;
      first = k;
    }
  }
  const std::size_t next = (first + 1) % 3, third = (first + 2) % 3;
  const Vector3 along = normalized(t[next] - t[first]), to_third = t[third] - t[first],
                across = to_third - dot(to_third, along) * along;
  const double off = dot(p - t[first], across) / length_sq(across);
  const double share = dot((p - t[first]) - off * to_third, along) / std::sqrt(longest);
  if (off > 0 && share > 0 && off + share < 1) {
    std::array<double, 3> weights{};
    weights[first] = 1 - off - share;
    weights[next] = share;
    weights[third] = off;
    see(weights);
  }
  return {best[1], std::min(best[2], 1 - best[1])};
}

TriangleParameter flat_foot(const Point3& a, const Point3& b, const Point3& c, const Point3& p) {
  const Vector3 ab = b - a, ac = c - a;
  const double longest = std::max({length_sq(ab), length_sq(ac), length_sq(c - b)});
  const bool narrow = !(length_sq(cross(ab, ac)) > 0x1p-20 * longest * longest);
  return narrow ? narrow_foot({a, b, c}, p) : foot_by_regions(a, b, c, p);
}

TriangleParameter into_triangle(double u, double v) {
  u = clamped(u);
  v = clamped(v);
  if (u + v > 1) {
    // Across the far edge.
    const double over = (u + v - 1) / 2;
    u = clamped(u - over);
    v = 1 - u;
  }
  return {u, v};
}

// Newton's method for |Q - p|^2 from a first parameter, projected into the triangle.
TriangleParameter curved_foot(const QuadraticTriangle& q, const Point3& p, TriangleParameter at) {
  const Point3 o = q.corners[0];
  const Vector3 l0 = q.middles[0] - o, l2 = q.middles[2] - o;
  const Vector3 uu = bend(q, 0), vv = bend(q, 2);
  // Q = o + 2 l0 u + 2 l2 v - uu u^2 + ... in the power basis.
  const Vector3 q_uu = -uu, q_vv = -vv;
  const Vector3 q_uv = (q.middles[1] - q.middles[0]) - l2;
  const Vector3 from = o - p;
  const auto rest = [&](TriangleParameter t) {
    return from + t.u * (2.0 * l0 + t.u * q_uu + 2 * t.v * q_uv) + t.v * (2.0 * l2 + t.v * q_vv);
  };
  TriangleParameter best = at;
  double least = length_sq(rest(at));
  for (int step = 0; step < 6; ++step) {
    const Vector3 r = rest(at);
    const Vector3 du = 2.0 * (l0 + at.u * q_uu + at.v * q_uv), dv = 2.0 * (l2 + at.u * q_uv + at.v * q_vv);
    const double gu = dot(r, du), gv = dot(r, dv);
    double a = dot(du, du) + 2 * dot(r, q_uu), b = dot(du, dv) + 2 * dot(r, q_uv),
           c = dot(dv, dv) + 2 * dot(r, q_vv);
    if (!(a > 0 && a * c > b * b)) {  // not convex here: Gauss-Newton
      a = dot(du, du);
      b = dot(du, dv);
      c = dot(dv, dv);
    }
    const double det = a * c - b * b;
    double su, sv;
    // On a border that the gradient presses against, along the border.
    const bool low_u = at.u <= 0 && gu > 0, low_v = at.v <= 0 && gv > 0,
               far = at.u + at.v >= 1 && gu + gv < 0;
    if (low_u + low_v + far >= 2) break;
    if (low_u) {
      su = 0;
      sv = c > 0 ? -gv / c : 0;
    } else if (low_v) {
      su = a > 0 ? -gu / a : 0;
      sv = 0;
    } else if (far) {
      const double along = a - 2 * b + c;
      su = along > 0 ? -(gu - gv) / along : 0;
      sv = -su;
    } else if (det > 0) {
      su = (b * gv - c * gu) / det;
      sv = (b * gu - a * gv) / det;
    } else {
      break;
    }
    const TriangleParameter next = into_triangle(at.u + su, at.v + sv);
    const double now = length_sq(rest(next));
    if (now < least) {
      best = next;
      least = now;
    }
    // The next step would be about the square of this one, and distances change by the square of that.
    if (std::fabs(next.u - at.u) + std::fabs(next.v - at.v) < 0x1p-22) break;
    at = next;
  }
  return best;
}

// Does a quadratic bend, or are its parameters uneven, by a good part of its size? Newton's method then depends on where it begins.
bool bends_much(const QuadraticTriangle& q) {
  double longest = 0, most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, length_sq(q.corners[(k + 1) % 3] - q.corners[k]));
    most = std::max(most, length_sq(bend(q, k)));
  }
  return most > 0x1p-6 * longest;
}

TriangleParameter between(const Corners& at, TriangleParameter t) {
  const double w = 1 - t.u - t.v;
  return into_triangle(w * at[0].u + t.u * at[1].u + t.v * at[2].u,
                       w * at[0].v + t.u * at[1].v + t.v * at[2].v);
}

// From the foot on the flat triangle of the corners.
TriangleParameter curved_foot_of(const QuadraticTriangle& q, const Point3& p, TriangleParameter first) {
  if (bends_much(q)) {
    Triangle middles;
    for (std::size_t k = 0; k < 3; ++k) middles[k] = middle_of_side(q, k);
    const std::array<Triangle, 4> flat{Triangle{q.corners[0], middles[0], middles[2]},
                                       {middles[0], q.corners[1], middles[1]},
                                       {middles[2], middles[1], q.corners[2]},
                                       {middles[1], middles[2], middles[0]}};
    const std::array<Corners, 4> places = quarters(whole_triangle);
    double least = distance(point_of(q, first), p);
    for (std::size_t i = 0; i < flat.size(); ++i) {
      const TriangleParameter at = between(places[i], flat_foot(flat[i][0], flat[i][1], flat[i][2], p));
      if (const double here = distance(point_of(q, at), p); here < least) {
        least = here;
        first = at;
      }
    }
  }
  return curved_foot(q, p, first);
}

TriangleParameter foot_of(const QuadraticTriangle& q, bool curved, const Point3& p) {
  const TriangleParameter first = flat_foot(q.corners[0], q.corners[1], q.corners[2], p);
  return curved ? curved_foot_of(q, p, first) : first;
}

// The hull of the points is at least this far from p: a plane across the direction to a point nearby.
double plane_distance(const QuadraticTriangle& q, const Point3& p, const Point3& near) {
  const Vector3 w = normalized(near - p);
  double least = INFINITY;
  for (const Point3& x : points_of(q)) least = std::min(least, dot(w, x - p));
  return least - distance_rounding;
}

// A ball that contains the set of a quadratic.
Ball ball_of(const QuadraticTriangle& q) {
  Vector3 sum;
  for (const Point3& x : q.corners) sum = sum + (x - Point3{});
  Ball ball{Point3{} + (1.0 / 3) * sum, 0};
  for (const Point3& x : points_of(q)) ball.radius = std::max(ball.radius, distance(x, ball.centre));
  ball.radius = enlarged(ball.radius + q.error) + distance_rounding;
  return ball;
}

// Are the sets on different sides of a plane across a direction?
bool apart(const QuadraticTriangle& a, const QuadraticTriangle& b, const Vector3& direction) {
  if (direction == Vector3{}) return false;
  const Extent x = extent_of(a, direction), y = extent_of(b, direction);
  return x.upper < y.lower || y.upper < x.lower;
}

}  // namespace

std::array<Point3, 6> points_of(const QuadraticTriangle& q) {
  return {q.corners[0], q.corners[1], q.corners[2], q.middles[0], q.middles[1], q.middles[2]};
}

Extent extent_of(const QuadraticTriangle& q, const Vector3& direction) {
  Extent extent;
  for (const Point3& p : points_of(q)) extent.add(dot(direction, p - Point3{}));
  const double reach =
      enlarged(error_along(direction, q.normal, q.error, q.normal_error)) + distance_rounding;
  return {extent.lower - reach, extent.upper + reach};
}

Point3 point_of(const QuadraticTriangle& q, TriangleParameter at) { return blossom(q, at, at); }

QuadraticTriangle restricted(const QuadraticTriangle& q, const std::array<TriangleParameter, 3>& corners) {
  QuadraticTriangle part;
  for (std::size_t k = 0; k < 3; ++k) {
    part.corners[k] = blossom(q, corners[k], corners[k]);
    part.middles[k] = blossom(q, corners[k], corners[(k + 1) % 3]);
  }
  part.error = q.error;
  return part;
}

QuadraticTriangle flat_quadratic(const Triangle& triangle) {
  QuadraticTriangle q{triangle, {}, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    q.middles[k] = triangle[k] + 0.5 * (triangle[(k + 1) % 3] - triangle[k]);
  }
  return q;
}

QuadraticFoot foot_on(const PieceSet& set, std::uint32_t piece, const Point3& p, double least) {
  QuadraticFoot foot;
  foot.piece = piece;
  const QuadraticTriangle* const q = set.kept(piece);
  const Triangle t = q != nullptr ? q->corners : set.facet(piece);
  foot.at = flat_foot(t[0], t[1], t[2], p);
  foot.point = flat_point(t, foot.at);
  if (q != nullptr && is_curved(*q)) {
    if (plane_distance(*q, p, foot.point) > least) return foot;
    foot.at = curved_foot_of(*q, p, foot.at);
    foot.point = point_of(*q, foot.at);
  }
  foot.distance = distance(foot.point, p);
  return foot;
}

QuadraticFoot foot_at(const PieceSet& set, std::uint32_t piece, TriangleParameter at, const Point3& p) {
  const QuadraticTriangle* const q = set.kept(piece);
  const Point3 point = q != nullptr && is_curved(*q)
                           ? point_of(*q, at)
                           : flat_point(q != nullptr ? q->corners : set.facet(piece), at);
  return {piece, at, point, distance(point, p)};
}

QuadraticFoot foot_beside(const PieceSet& set, const QuadraticFoot& foot, const Point3& p) {
  const QuadraticTriangle& q = set[foot.piece];
  QuadraticFoot beside = foot;
  if (is_curved(q)) {
    beside.at = curved_foot(q, p, foot.at);
    beside.point = point_of(q, beside.at);
  }
  beside.distance = distance(beside.point, p);
  return beside;
}

QuadraticTriangle below(const PieceSet& set, const std::array<QuadraticFoot, 3>& feet) {
  const QuadraticTriangle* const q = set.kept(feet[0].piece);
  QuadraticTriangle part{{feet[0].point, feet[1].point, feet[2].point}, {}, set.error(feet[0].piece)};
  const bool curved = q != nullptr && is_curved(*q);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    part.middles[k] = curved ? blossom(*q, feet[k].at, feet[next].at)
                             : part.corners[k] + 0.5 * (part.corners[next] - part.corners[k]);
  }
  return part;
}

QuadraticFoot nearest_foot(const PieceSet& set, const Point3& p, const QuadraticFoot& hint) {
  QuadraticFoot best = hint;
  if (hint.distance != INFINITY) best = foot_on(set, hint.piece, p);
  set.visit_near(p, best.distance, [&](std::uint32_t piece) {
    if (const QuadraticFoot foot = foot_on(set, piece, p, best.distance); foot.distance < best.distance)
      best = foot;
    return false;
  });
  return best;
}

double farthest_from(const PieceSet& set, const QuadraticFoot& foot, const Triangle& triangle, double most) {
  const QuadraticTriangle& q = set[foot.piece];
  const double bent = largest_bend(q);
  double longest = 0, far = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    longest = std::max(longest, distance(q.corners[k], q.corners[(k + 1) % 3]));
  }
  // Most triangles are farther across than the piece.
  for (const Point3& p : triangle) {
    if (distance(p, foot.point) > most + longest + bent) return INFINITY;
  }
  for (const Point3& p : triangle) {
    far = std::max(far, distance(p, point_of(q, flat_foot(q.corners[0], q.corners[1], q.corners[2], p))));
    if (far > most) return INFINITY;
  }
  return enlarged(far + between_feet * bent + q.error) + distance_rounding;
}

namespace {

// Splits of quadratics after which a bound is taken as it is.
constexpr int max_splits = 20'000;

// A lower bound of the distance of p to one piece, as far as it is less than `least`.
double certain_distance_of(const QuadraticTriangle& q, std::uint32_t piece, const Point3& p, double gap,
                           double least, int& splits, QuadraticFoot& foot) {
  const bool curved = is_curved(q);
  struct Open {
    QuadraticTriangle part;
    Corners at;
  };
  std::vector<Open> open{{q, whole_triangle}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const TriangleParameter near = foot_of(next.part, curved, p);
    const Point3 point = point_of(next.part, near);
    if (const double here = distance(point, p); here < foot.distance) {
      foot = {piece, between(next.at, near), point, here};
    }
    const double lower = plane_distance(next.part, p, point);
    if (!curved || lower >= foot.distance - gap || lower - q.error >= least || splits >= max_splits) {
      least = std::min(least, lower - q.error - distance_rounding);
      continue;
    }
    ++splits;
    for (const Corners& quarter : quarters(next.at)) open.push_back({restricted(q, quarter), quarter});
  }
  return least;
}

}  // namespace

double certain_distance(const PieceSet& set, const Point3& p, double gap, QuadraticFoot& foot) {
  double least = INFINITY;
  int splits = 0;
  set.visit_near(p, least, [&](std::uint32_t piece) {
    if (const QuadraticFoot own = foot_on(set, piece, p, foot.distance); own.distance < foot.distance)
      foot = own;
    least = certain_distance_of(set[piece], piece, p, gap, least, splits, foot);
    return false;
  });
  return std::max(0.0, least);
}

namespace {

// May the sets of two quadratics meet? The second one is split until it is as small
// as the first, and flat.
bool may_meet(const QuadraticTriangle& part, const Ball& ball, const std::array<Vector3, 2>& across,
              const QuadraticTriangle& q, double flat) {
  const Ball other = ball_of(q);
  const double between = distance(ball.centre, other.centre);
  if (between > enlarged(ball.radius + other.radius) + distance_rounding) return false;
  if (apart(part, q, across[0]) || apart(part, q, across[1]) || apart(part, q, unit_normal(q.corners)))
    return false;
  // Along the shortest way between the triangles of their corners.
  const NearestTriangles near = nearest(part.corners, q.corners);
  const auto at = [](const Triangle& t, const Barycentric& p) {
    return t[0] + p.b * (t[1] - t[0]) + p.c * (t[2] - t[0]);
  };
  if (apart(part, q, normalized(at(q.corners, near.on_b) - at(part.corners, near.on_a)))) return false;
  const bool small = other.radius <= std::max(ball.radius, 2 * q.error + 4 * distance_rounding);
  const double bent = std::max({max_abs(bend(q, 0)), max_abs(bend(q, 1)), max_abs(bend(q, 2))});
  if (small && bent <= flat) return true;
  for (const Corners& quarter : quarters(whole_triangle)) {
    if (may_meet(part, ball, across, restricted(q, quarter), flat)) return true;
  }
  return false;
}

}  // namespace

Obb slim_box(const QuadraticTriangle& q) {
  const Vector3 along = longest_edge(q.corners), across = normalized(cross(unit_normal(q.corners), along));
  return fit_box(orthonormal_axes(along, across), [&](const Vector3& axis) { return extent_of(q, axis); });
}

bool may_meet(const PieceSet& set, const QuadraticTriangle& part, double flat) {
  const Ball ball = ball_of(part);
  // Across the plane and, in it, across the longest edge, where most of what is in the ball around a narrow part lies.
  const Vector3 normal = unit_normal(part.corners);
  const std::array<Vector3, 2> across{normal, normalized(cross(normal, longest_edge(part.corners)))};
  return set.visit_near(slim_box(part), [&](std::uint32_t piece) {
    return may_meet(part, ball, across, set[piece], std::max(flat, 4 * distance_rounding));
  });
}

namespace {

void for_each_within(const PieceSet& set, const Ball& ball, const std::function<void(std::uint32_t)>& visit) {
  double reach = ball.radius;
  set.visit_near(ball.centre, reach, [&](std::uint32_t piece) {
    visit(piece);
    return false;
  });
}

}  // namespace

void mark_near(const PieceSet& set, const QuadraticTriangle& part, double reach,
               std::span<std::uint8_t> marks) {
  const Ball ball = ball_of(part);
  for_each_within(set, {ball.centre, enlarged(ball.radius + reach) + distance_rounding},
                  [&](std::uint32_t piece) { marks[piece] = 1; });
}

void for_each_near(const PieceSet& set, const QuadraticTriangle& part,
                   const std::function<void(std::uint32_t)>& visit) {
  for_each_within(set, ball_of(part), visit);
}

}  // namespace snug
