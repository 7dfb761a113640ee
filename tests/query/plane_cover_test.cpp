// Random triangles over random triangulations of a plane, with gaps, edges of one triangle alone, heights and overlaps: what is said to be
// covered is, by samples.

#include <snug/query/plane_cover.h>

#include <snug/geometry/point_triangle.h>
#include <snug/search/feet.h>
#include <support/direction.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace snug {
namespace {

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

// A grid of a square, its corners moved within it, each cell cut into two or four; through a frame.
struct Plane {
  Vector3 x, y, z;
  [[nodiscard]] Point3 at(double u, double v, double w) const { return Point3{} + u * x + v * y + w * z; }
};

std::vector<Triangle> grid(int n, double moved, double height, const Plane& plane, std::mt19937_64& random) {
  std::vector<Point3> points;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool border = i == 0 || j == 0 || i == n || j == n;
      const double by = border ? 0 : moved * 0.5 / n;
      points.push_back(plane.at(2.0 * i / n - 1 + by * unit(random), 2.0 * j / n - 1 + by * unit(random),
                                height * unit(random)));
    }
  }
  std::vector<Triangle> triangles;
  const auto p = [&](int i, int j) { return points[static_cast<std::size_t>(j * (n + 1) + i)]; };
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const Point3 a = p(i, j), b = p(i + 1, j), c = p(i + 1, j + 1), d = p(i, j + 1);
      if (random() % 2 == 0) {
        triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles.insert(triangles.end(), {{b, d, a}, {d, b, c}});
      }
    }
  }
  return triangles;
}

TEST(plane_cover, what_is_said_to_be_covered_is) {
  std::mt19937_64 random(1);
  int covered = 0, not_covered = 0, missed = 0;
  for (int trial = 0; trial < 120; ++trial) {
    // Axes, or any other frame.
    Plane plane{{0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 1}};
    if (trial % 2 == 0) {
      plane.x = 0.5 * normalized(Vector3{unit(random), unit(random), unit(random)});
      plane.z = normalized(cross(plane.x, Vector3{unit(random), unit(random), unit(random)}));
      plane.y = cross(plane.z, plane.x);
    }
    const double height = trial % 3 == 0 ? 1e-4 * std::exp2(-8 * (unit(random) + 1)) : 0;
    const int n = 1 + static_cast<int>(random() % 6);
    std::vector<Triangle> triangles = grid(n, random() % 2 == 0 ? 0.8 : 0.0, height, plane, random);
    const auto any = [&]() -> Triangle& { return triangles[random() % triangles.size()]; };
    const unsigned fault = trial % 4 == 1 ? 0 : static_cast<unsigned>(random() % 6);
    if (fault == 1) std::swap(any(), triangles.back()), triangles.pop_back();       // a gap
    if (fault == 2) any()[random() % 3] = plane.at(unit(random), unit(random), 0);  // a fold
    if (fault == 3) any()[random() % 3] = plane.at(0.3, 0.2, 0.5 * unit(random));   // a spike
    if (fault == 4) triangles.push_back({plane.at(-1, 0, 0), plane.at(1, 0.1, 0), plane.at(0, 1, 0)});
    if (fault == 5) triangles.resize(1 + triangles.size() / 2);
    std::vector<QuadraticTriangle> pieces;
    for (const Triangle& t : triangles) pieces.push_back(flat_quadratic(t));
    PieceSet set(std::move(pieces));
    set.prepare(1);
    const PlaneCover cover(set, 1e-4);
    for (int k = 0; k < 20; ++k) {
      const double size = std::exp2(-3 * std::fabs(unit(random))), u = unit(random), v = unit(random);
      Triangle t;
      // Some corners on the border and on corners of the grid.
      const bool on_corners = random() % 3 == 0;
      for (Point3& p : t) {
        double s = u + size * unit(random), r = v + size * unit(random);
        if (on_corners) s = std::round(0.5 * n * s) * 2 / n, r = std::round(0.5 * n * r) * 2 / n;
        p = plane.at(std::clamp(s, -1.0, 1.0), std::clamp(r, -1.0, 1.0), 0);
      }
      QuadraticTriangle piece = flat_quadratic(t);
      for (Point3& middle : piece.middles) middle = middle + (k % 4 == 0 ? 3e-5 * unit(random) : 0) * plane.z;
      const std::optional<double> bound = cover.distance_of(piece);
      double far = 0;
      constexpr int parts = 12;
      for (int i = 0; i <= parts; ++i) {
        for (int j = 0; i + j <= parts; ++j) {
          const Point3 p = point_of(piece, {i / 12.0, j / 12.0});
          double least = INFINITY;
          for (const Triangle& other : triangles)
            least = std::min(least, distance_between(p, other, 1).lower);
          far = std::max(far, least);
        }
      }
      EXPECT_LE(far, bound.value_or(INFINITY)) << "trial " << trial << ", fault " << fault;
      covered += bound ? 1 : 0;
      not_covered += far > 2e-4 ? 1 : 0;
      const double area = length(cross(t[1] - t[0], t[2] - t[0]));
      missed += !bound && fault == 0 && area > 1e-6 ? 1 : 0;
    }
  }
  std::printf("covered %d, not %d, missed %d\n", covered, not_covered, missed);
  EXPECT_GT(covered, 800);
  EXPECT_GT(not_covered, 150);
  EXPECT_LT(missed, covered / 16);
}

}  // namespace
}  // namespace snug
