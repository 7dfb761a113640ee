#include <snug/bounds/linear_programme.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace snug::linear_programme_test {
namespace {

struct Points {
  std::vector<double> x, y, z;
  void add(double a, double b, double c) {
    x.push_back(a);
    y.push_back(b);
    z.push_back(c);
  }
  [[nodiscard]] Plane plane(double cx, double cy) const { return PlanesAbove(x, y, cx, cy).lowest(z); }
};

double largest_violation(const Points& points, const Plane& plane) {
  double worst = 0;
  for (std::size_t i = 0; i < points.x.size(); ++i)
    worst = std::max(worst, points.z[i] - plane(points.x[i], points.y[i]));
  return worst;
}

// By the definition: of all planes through three of the points that no point is above, the least at the
// centre.
double brute_force(const Points& p, double cx, double cy) {
  double best = INFINITY;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const double ux = p.x[j] - p.x[i], uy = p.y[j] - p.y[i], uz = p.z[j] - p.z[i];
        const double vx = p.x[k] - p.x[i], vy = p.y[k] - p.y[i], vz = p.z[k] - p.z[i];
        const double det = ux * vy - uy * vx;
        if (std::fabs(det) < 1e-9) continue;
        const double sx = (uz * vy - uy * vz) / det, sy = (ux * vz - uz * vx) / det;
        bool above = true;
        for (std::size_t m = 0; m < p.x.size() && above; ++m)
          above = p.z[m] <= p.z[i] + sx * (p.x[m] - p.x[i]) + sy * (p.y[m] - p.y[i]) + 1e-10;
        if (above) best = std::min(best, p.z[i] + sx * (cx - p.x[i]) + sy * (cy - p.y[i]));
      }
    }
  }
  return best;
}

TEST(planes_above, is_as_low_as_the_best_of_all_triples) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 600; ++trial) {
    Points points;
    points.add(0, 0, normal(random));  // the centre lies inside their hull
    points.add(1, 0, normal(random));
    points.add(0, 1, normal(random));
    const int count = trial % 18;
    for (int i = 0; i < count; ++i) {
      const bool lattice = trial % 3 == 0;  // ties, points on lines, equal places
      const double x = lattice ? std::round(4 * unit(random)) / 4 : unit(random);
      const double y = lattice ? std::round(4 * unit(random)) / 4 : unit(random);
      points.add(x, y, trial % 2 == 0 ? std::round(2 * normal(random)) / 2 : normal(random));
    }
    const Plane plane = points.plane(1.0 / 3, 1.0 / 3);
    EXPECT_NEAR(plane.at_centre, brute_force(points, 1.0 / 3, 1.0 / 3), 1e-9) << trial;
    EXPECT_LE(largest_violation(points, plane), 1e-9) << trial;
  }
}

TEST(planes_above, is_finite_and_above_whatever_the_points) {
  std::mt19937_64 random(32);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    Points points;
    const double x = unit(random), y = unit(random);
    for (int i = 0; i <= trial % 40; ++i) {
      const double t = unit(random), noise = 1e-16 * unit(random);
      switch (trial % 4) {
        case 0:  // one place
          points.add(x, y, t);
          break;
        case 1:  // nearly one place
          points.add(x + noise, y - noise, 1 + noise);
          break;
        case 2:  // a line
          points.add(t, 0.5 * t, t * t);
          break;
        default:  // a plane
          points.add(t, x * noise + unit(random), 0);
      }
    }
    const Plane plane = points.plane(1.0 / 3, 1.0 / 3);
    EXPECT_TRUE(std::isfinite(plane.at_centre + plane.slope_x + plane.slope_y)) << trial;
    EXPECT_LE(std::fabs(plane.slope_x) + std::fabs(plane.slope_y), 3 * 4096.0) << trial;
    EXPECT_LE(largest_violation(points, plane), 1e-9) << trial;
  }
}

TEST(planes_above, is_the_same_each_time) {
  Points points;
  std::mt19937_64 random(33);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 500; ++i) points.add(unit(random), unit(random), unit(random));
  const Plane one = points.plane(0.4, 0.4), two = points.plane(0.4, 0.4);
  EXPECT_EQ(one.at_centre, two.at_centre);
  EXPECT_EQ(one.slope_x, two.slope_x);
  EXPECT_EQ(one.slope_y, two.slope_y);
}

}  // namespace
}  // namespace snug::linear_programme_test
