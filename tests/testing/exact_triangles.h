#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

/// Triangles with small whole-numbered corners: what they have in common is decided without rounding.
namespace snug::testing {

using ExactPoint = std::array<std::int64_t, 3>;
using ExactTriangle = std::array<ExactPoint, 3>;

namespace exact {

[[nodiscard]] inline ExactPoint minus(const ExactPoint& a, const ExactPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline ExactPoint cross(const ExactPoint& a, const ExactPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline std::int64_t dot(const ExactPoint& a, const ExactPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline int sign(std::int64_t x) { return (x > 0) - (x < 0); }
[[nodiscard]] inline ExactPoint normal(const ExactTriangle& t) {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

/// On which side of the line through a and b, seen along n?
[[nodiscard]] inline int side(const ExactPoint& n, const ExactPoint& a, const ExactPoint& b,
                              const ExactPoint& p) {
  return sign(dot(n, cross(minus(b, a), minus(p, a))));
}
/// Of points in the plane of t.
[[nodiscard]] inline bool holds(const ExactTriangle& t, const ExactPoint& p) {
  const ExactPoint n = normal(t);
  return side(n, t[0], t[1], p) >= 0 && side(n, t[1], t[2], p) >= 0 && side(n, t[2], t[0], p) >= 0;
}
[[nodiscard]] inline bool between(const ExactPoint& a, const ExactPoint& b, const ExactPoint& p) {
  return dot(minus(a, p), minus(b, p)) <= 0;  // of points on one line
}
/// Of segments in a plane with normal n.
[[nodiscard]] inline bool segments_meet(const ExactPoint& n, const ExactPoint& a, const ExactPoint& b,
                                        const ExactPoint& c, const ExactPoint& d) {
  const int ca = side(n, a, b, c), da = side(n, a, b, d), ac = side(n, c, d, a), bc = side(n, c, d, b);
  if (ca * da < 0 && ac * bc < 0) return true;
  return (ca == 0 && between(a, b, c)) || (da == 0 && between(a, b, d)) || (ac == 0 && between(c, d, a)) ||
         (bc == 0 && between(c, d, b));
}

/// Does the segment meet the triangle; strictly: does it run through its inside from one side to the other?
[[nodiscard]] inline bool meets(const ExactPoint& p, const ExactPoint& q, const ExactTriangle& t,
                                bool strictly) {
  const ExactPoint n = normal(t);
  const int sp = sign(dot(n, minus(p, t[0]))), sq = sign(dot(n, minus(q, t[0])));
  if (sp == 0 && sq == 0) {
    if (strictly) return false;
    if (holds(t, p) || holds(t, q)) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (segments_meet(n, p, q, t[k], t[(k + 1) % 3])) return true;
    return false;
  }
  if (sp * sq > 0 || (strictly && sp * sq == 0)) return false;
  int least = 1, most = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const int s = sign(dot(minus(q, p), cross(minus(t[k], p), minus(t[(k + 1) % 3], p))));
    least = s < least ? s : least;
    most = s > most ? s : most;
  }
  return strictly ? least == most && least != 0 : !(least < 0 && most > 0);
}

}  // namespace exact

[[nodiscard]] inline bool has_area(const ExactTriangle& t) { return exact::normal(t) != ExactPoint{}; }

/// Requires: both have_area().
[[nodiscard]] inline bool have_common_point(const ExactTriangle& s, const ExactTriangle& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (exact::meets(s[k], s[(k + 1) % 3], t, false) || exact::meets(t[k], t[(k + 1) % 3], s, false))
      return true;
  return false;
}

/// Does an edge of one run through the inside of the other?
[[nodiscard]] inline bool pierce(const ExactTriangle& s, const ExactTriangle& t) {
  for (std::size_t k = 0; k < 3; ++k)
    if (exact::meets(s[k], s[(k + 1) % 3], t, true) || exact::meets(t[k], t[(k + 1) % 3], s, true))
      return true;
  return false;
}

/// To some units of the last place of a long double.
/// Requires: no common point.
[[nodiscard]] inline long double distance(const ExactTriangle& s, const ExactTriangle& t) {
  using namespace exact;
  long double least = std::numeric_limits<long double>::infinity();
  const auto consider = [&](std::int64_t over, std::int64_t under, bool squared) {
    const long double d = static_cast<long double>(over) / static_cast<long double>(under);
    least = std::fmin(least, squared ? std::sqrt(d)
                                     : std::fabs(static_cast<long double>(over)) /
                                           std::sqrt(static_cast<long double>(under)));
  };
  const auto point_to_segment = [&](const ExactPoint& p, const ExactPoint& a, const ExactPoint& b) {
    const ExactPoint d = minus(b, a), r = minus(p, a);
    const std::int64_t along = dot(r, d), whole = dot(d, d);
    if (along <= 0) return consider(dot(r, r), 1, true);
    if (along >= whole) return consider(dot(minus(p, b), minus(p, b)), 1, true);
    const ExactPoint c = cross(r, d);
    consider(dot(c, c), whole, true);
  };
  for (const auto& [x, y] : {std::pair{&s, &t}, std::pair{&t, &s}})
    for (const ExactPoint& p : *x) {
      const ExactPoint n = normal(*y);
      bool over = true;
      for (std::size_t k = 0; k < 3; ++k) {
        over = over && side(n, (*y)[k], (*y)[(k + 1) % 3], p) >= 0;
        point_to_segment(p, (*y)[k], (*y)[(k + 1) % 3]);
      }
      if (over) consider(dot(n, minus(p, (*y)[0])), dot(n, n), false);
    }
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const ExactPoint &a = s[i], &b = s[(i + 1) % 3], &c = t[j], &d = t[(j + 1) % 3];
      const ExactPoint n = cross(minus(b, a), minus(d, c));
      if (n == ExactPoint{}) continue;
      // Seen along n, do they cross?
      if (side(n, a, b, c) * side(n, a, b, d) < 0 && side(n, c, d, a) * side(n, c, d, b) < 0)
        consider(dot(n, minus(c, a)), dot(n, n), false);
    }
  return least;
}

}  // namespace snug::testing
