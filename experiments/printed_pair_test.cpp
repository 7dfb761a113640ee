#include <experiments/printed_pair_test.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <support/names.h>

namespace snug {
namespace {

// --- the printed test ---

Vector3 unit(Vector3 v) { return (1 / length(v)) * v; }
Vector3 unit_normal(const Triangle& t) { return unit(cross(t[1] - t[0], t[2] - t[0])); }

std::size_t largest_axis(Vector3 v) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::fabs(v[k]) > std::fabs(v[axis])) axis = k;
  }
  return axis;
}

using Distances = std::array<double, 3>;

// Signed distances of the corners of t to the plane through `on` with unit normal n; below `snap` they count
// as zero.
Distances snapped_distances(const Triangle& t, Point3 on, Vector3 n, double snap) {
  Distances d;
  for (std::size_t k = 0; k < 3; ++k) {
    d[k] = dot(n, t[k] - on);
    if (std::fabs(d[k]) < snap) d[k] = 0;
  }
  return d;
}

bool same_sign(double x, double y) { return (x > 0 && y > 0) || (x < 0 && y < 0); }
bool on_one_side(const Distances& d) { return same_sign(d[0], d[1]) && same_sign(d[0], d[2]); }
bool in_the_plane(const Distances& d) { return d[0] == 0 && d[1] == 0 && d[2] == 0; }

// The corner that the plane cuts off from the other two, in the paper's order of cases.
std::size_t lone_corner(const Distances& d) {
  if (same_sign(d[0], d[1])) return 2;
  if (same_sign(d[0], d[2])) return 1;
  if (same_sign(d[1], d[2]) || d[0] != 0) return 0;
  return d[1] != 0 ? 1 : 2;
}

struct Crossing {
  double lower, upper;
};

// Where t crosses the plane its distances d belong to, as an interval of the coordinate `axis`.
Crossing crossing(const Triangle& t, const Distances& d, std::size_t axis) {
  const std::size_t lone = lone_corner(d);
  const auto end = [&](std::size_t other) {
    return t[lone][axis] + (t[other][axis] - t[lone][axis]) * (d[lone] / (d[lone] - d[other]));
  };
  const double p = end((lone + 1) % 3), q = end((lone + 2) % 3);
  return {std::min(p, q), std::max(p, q)};
}

struct Flat {
  double x, y;
};
using FlatTriangle = std::array<Flat, 3>;

// Twice the signed area of p, q, r.
double turn(Flat p, Flat q, Flat r) { return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x); }

bool segments_cross(Flat p, Flat q, Flat r, Flat s) {
  return turn(p, q, r) * turn(p, q, s) <= 0 && turn(r, s, p) * turn(r, s, q) <= 0 &&
         (turn(p, q, r) != 0 || turn(p, q, s) != 0);
}

bool contains(const FlatTriangle& t, Flat p) {
  const Distances side{turn(t[0], t[1], p), turn(t[1], t[2], p), turn(t[2], t[0], p)};
  return on_one_side(side);
}

bool flat_triangles_meet(const FlatTriangle& a, const FlatTriangle& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (segments_cross(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3])) return true;
    }
  }
  return contains(b, a[0]) || contains(a, b[0]);
}

FlatTriangle flattened(const Triangle& t, std::size_t dropped_axis) {
  FlatTriangle flat;
  for (std::size_t k = 0; k < 3; ++k) flat[k] = {t[k][(dropped_axis + 1) % 3], t[k][(dropped_axis + 2) % 3]};
  return flat;
}

// --- random pairs ---

// In [0, 1). The standard's distributions differ from library to library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }
double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * uniform(random);
}

Vector3 any_direction(std::mt19937_64& random) {
  for (;;) {
    const Vector3 v{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const double size_sq = length_sq(v);
    if (size_sq <= 1 && size_sq > 0.01) return unit(v);
  }
}

// Orthogonal to the unit vector n.
Vector3 direction_across(Vector3 n, std::mt19937_64& random) {
  for (;;) {
    const Vector3 v = any_direction(random);
    const Vector3 across = v - dot(v, n) * n;
    if (length_sq(across) > 0.01) return unit(across);
  }
}

bool is_needle(const Triangle& t) {
  const double longest_sq =
      std::max({length_sq(t[1] - t[0]), length_sq(t[2] - t[1]), length_sq(t[0] - t[2])});
  return longest_sq < 0.25 || length(cross(t[1] - t[0], t[2] - t[0])) < 0.25 * longest_sq;
}

// Corners in a box with axes u, v, w and half edges 1/2, 1/2 and `height`.
Triangle any_triangle(Vector3 u, Vector3 v, Vector3 w, double height, std::mt19937_64& random) {
  Triangle t;
  do {
    for (Point3& p : t) {
      p = Point3{} + uniform(random, -0.5, 0.5) * u + uniform(random, -0.5, 0.5) * v +
          uniform(random, -height, height) * w;
    }
  } while (is_needle(t));
  return t;
}

Barycentric any_barycentric(std::mt19937_64& random) {
  const double b = uniform(random), c = uniform(random);
  return b + c <= 1 ? Barycentric{b, c} : Barycentric{1 - b, 1 - c};
}

Point3 at(const Triangle& t, Barycentric p) { return t[0] + (p.b * (t[1] - t[0]) + p.c * (t[2] - t[0])); }

Triangle moved(const Triangle& t, Vector3 by) { return {t[0] + by, t[1] + by, t[2] + by}; }

double found_distance(const Triangle& a, const Triangle& b, const NearestTriangles& near) {
  return distance(at(a, near.on_a), at(b, near.on_b));
}

// Moves b, which meets a, along `direction` until they are `target` apart. The distance grows on the way: it
// is convex.
Triangle withdrawn(const Triangle& a, const Triangle& b, Vector3 direction, double target) {
  double low = 0, high = 4;
  for (int step = 0; step < 40; ++step) {
    const double middle = 0.5 * (low + high);
    const Triangle there = moved(b, middle * direction);
    (found_distance(a, there, nearest(a, there)) < target ? low : high) = middle;
  }
  return moved(b, high * direction);
}

}  // namespace

bool printed_test_says_separated(const OffsetTriangle& a, const OffsetTriangle& b, double epsilon) {
  const double snap = a.radius + b.radius + epsilon;
  const Vector3 normal_a = unit_normal(a.base), normal_b = unit_normal(b.base);
  const Distances of_b = snapped_distances(b.base, a.base[0], normal_a, snap);
  if (on_one_side(of_b)) return true;
  const Distances of_a = snapped_distances(a.base, b.base[0], normal_b, snap);
  if (on_one_side(of_a)) return true;
  if (in_the_plane(of_a) || in_the_plane(of_b)) {
    const std::size_t axis = largest_axis(normal_a);
    return !flat_triangles_meet(flattened(a.base, axis), flattened(b.base, axis));
  }
  const std::size_t axis = largest_axis(cross(normal_a, normal_b));
  const Crossing on_a = crossing(a.base, of_a, axis), on_b = crossing(b.base, of_b, axis);
  return on_a.upper < on_b.lower || on_b.upper < on_a.lower;
}

bool certainly_separated(const OffsetTriangle& a, const OffsetTriangle& b, double margin) {
  return rounded_down(nearest(a.base, b.base).certain_distance - enlarged(a.radius + b.radius)) > margin;
}

constexpr auto pair_family_names =
    std::to_array<Named<PairFamily>>({{"general", PairFamily::general},
                                      {"side-by-side", PairFamily::side_by_side},
                                      {"one-above-other", PairFamily::one_above_other}});

const char* name_of(PairFamily family) { return name_in(pair_family_names, family); }

NearPair near_pair(PairFamily family, std::mt19937_64& random) {
  constexpr Vector3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  for (;;) {
    NearPair pair;
    pair.epsilon = std::ldexp(1 + uniform(random), -4 - static_cast<int>(random() % 6));
    pair.a.radius = uniform(random, 0, 0.5 * pair.epsilon);
    pair.b.radius = uniform(random, 0, 0.5 * pair.epsilon);
    const double tolerance = pair.tolerance(), target = tolerance * (1 - uniform(random));
    pair.a.base = any_triangle(x, y, z, 0.5, random);
    const Vector3 normal = unit_normal(pair.a.base);
    Vector3 direction = any_direction(random);
    if (family == PairFamily::general) {
      pair.b.base = any_triangle(x, y, z, 0.5, random);
    } else {
      const Vector3 u = direction_across(normal, random);
      const double height = family == PairFamily::side_by_side ? 0.125 * tolerance : tolerance;
      pair.b.base = any_triangle(u, cross(normal, u), normal, height, random);
      direction = direction_across(normal, random);
      if (family == PairFamily::one_above_other) {
        direction = unit(normal + uniform(random, 0, 0.364) * direction);  // tan 20 degrees
      }
    }
    const Point3 meeting = at(pair.a.base, any_barycentric(random));
    const Triangle touching = moved(pair.b.base, meeting - at(pair.b.base, any_barycentric(random)));
    pair.b.base = withdrawn(pair.a.base, touching, direction, target);
    const NearestTriangles near = nearest(pair.a.base, pair.b.base);
    // The points found carry a few roundings of coordinates below 4.
    const double upper = found_distance(pair.a.base, pair.b.base, near) + 1e-14;
    if (near.certain_distance > 0 && upper <= tolerance) return pair;
  }
}

}  // namespace snug
