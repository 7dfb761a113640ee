#include <oracle/curve_twin.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace oracle::curve_twin_test {
namespace {

TEST(curve_twin, polynomials_and_plain_subdivision_agree) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::size_t compared = 0;
  for (int trial = 0; trial < 60; ++trial) {
    TwinPolyline polyline;
    polyline.closed = trial % 2 == 0;
    const int n = 1 + trial % 7 + (polyline.closed ? 0 : 1);
    for (int i = 0; i < n; ++i)
      polyline.points.push_back({coordinate(random), coordinate(random), coordinate(random)});
    for (const int degree : {2, 3}) {
      for (const int levels : {0, 1, 2, 5}) {
        for (const CurveSample& s : subdivided_curve(polyline, degree, levels)) {
          const CurveSample other = curve_at(polyline, degree, s.edge, s.t);
          for (std::size_t x = 0; x < 3; ++x) {
            ASSERT_LE(std::abs(s.position[x] - other.position[x]), s.error + other.error)
                << "degree " << degree << ", level " << levels << ", edge " << s.edge << " at " << s.t;
          }
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 15'000u);
}

TEST(curve_twin, of_degree_2_is_straight_before_the_middle_of_an_open_end) {
  const TwinPolyline polyline{{{0, 0, 0}, {4, 2, 0}, {5, -3, 1}}, false};
  for (const double t : {0.0, 0.125, 0.5}) {
    const CurveSample s = curve_at(polyline, 2, 0, t);
    EXPECT_EQ(s.position, (Point{4 * t, 2 * t, 0}));
  }
}

}  // namespace
}  // namespace oracle::curve_twin_test
