// Distances against extended precision, where the errors lie at their ends.

#include <snug/search/gap.h>

#include <gtest/gtest.h>
#include <support/direction.h>

#include <cmath>
#include <random>

namespace snug::gap_test {
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::uint64_t below(std::uint64_t n) { return random_() % n; }
  // Of sizes from the least doubles up, on axes or not.
  Vector3 vector(int least_exponent) {
    const double size = std::ldexp(
        1.0, static_cast<int>(below(static_cast<std::uint64_t>(2 - least_exponent))) + least_exponent);
    Vector3 v{size * (2 * unit() - 1), size * (2 * unit() - 1), size * (2 * unit() - 1)};
    if (below(4) == 0) v[below(3)] = 0;
    return v;
  }

 private:
  std::mt19937_64 random_;
};

long double exact_length(const std::array<long double, 3>& v) {
  const long double size = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (size == 0) return 0;
  long double sum = 0;
  for (const long double x : v) sum += x / size * (x / size);
  return size * std::sqrt(sum);
}

// The points are off by `errors` in sum, straight away from each other.
TEST(gap, points_are_no_farther_apart_than_is_said) {
  Draw draw(1);
  for (int trial = 0; trial < 200'000; ++trial) {
    const Point3 a = Point3{} + draw.vector(-40),
                 b = draw.below(3) == 0 ? a + draw.vector(-1060) : Point3{} + draw.vector(-40);
    const double errors =
        draw.below(3) == 0 ? 0 : std::ldexp(draw.unit(), -static_cast<int>(draw.below(1000)));
    std::array<long double, 3> between;
    for (std::size_t k = 0; k < 3; ++k)
      between[k] = static_cast<long double>(b[k]) - static_cast<long double>(a[k]);
    const long double apart = exact_length(between) + static_cast<long double>(errors);
    const double most = distance_at_most(b - a, errors);
    ASSERT_GE(static_cast<long double>(most), apart) << trial;
    ASSERT_LE(static_cast<long double>(most), apart * (1 + 0x1p-46L) + 0x1p-508L) << trial;
  }
}

// Balls around corners of triangles: those that face each other most nearly.
TEST(gap, sets_around_triangles_are_no_nearer_than_is_said) {
  Draw draw(2);
  int shown = 0;
  for (int trial = 0; trial < 50'000; ++trial) {
    Triangle a, b;
    const Vector3 away = draw.vector(-20);
    for (std::size_t k = 0; k < 3; ++k) {
      a[k] = Point3{} + draw.vector(-8);
      b[k] = Point3{} + away + draw.vector(-8);
    }
    const NearestTriangles near = nearest(a, b);
    const double radius_a = near.certain_distance * draw.unit(),
                 radius_b = near.certain_distance * draw.unit() / 2;
    const double gap = gap_of(near, radius_a, radius_b);
    shown += gap > 0;
    // Along the way between the nearest points, each ball takes its radius.
    const auto at = [](const Triangle& t, const Barycentric& p, std::size_t k) {
      const auto x = [&](std::size_t i) { return static_cast<long double>(t[i][k]); };
      return x(0) + static_cast<long double>(p.b) * (x(1) - x(0)) +
             static_cast<long double>(p.c) * (x(2) - x(0));
    };
    std::array<long double, 3> between;
    for (std::size_t k = 0; k < 3; ++k) between[k] = at(b, near.on_b, k) - at(a, near.on_a, k);
    const long double apart =
        exact_length(between) - (static_cast<long double>(radius_a) + static_cast<long double>(radius_b));
    ASSERT_LE(static_cast<long double>(gap), apart) << trial;
  }
  EXPECT_GT(shown, 10'000);
}

// Of one direction that is known, no less is taken than both radii.
TEST(gap, of_sets_is_rounded_down) {
  Draw draw(4);
  NearestTriangles near{};
  for (int trial = 0; trial < 100'000; ++trial) {
    near.certain_distance = draw.unit();
    const double a = draw.unit() * near.certain_distance, b = draw.unit() * (near.certain_distance - a);
    const long double exact = static_cast<long double>(near.certain_distance) -
                              (static_cast<long double>(a) + static_cast<long double>(b));
    const double gap = gap_of(near, a, b);
    ASSERT_LE(static_cast<long double>(gap), exact);
    ASSERT_GE(static_cast<long double>(gap),
              exact - 0x1p-41L * static_cast<long double>(near.certain_distance));
  }
}

// A direction that is too long makes a height too large by as much.
TEST(gap, of_planes_has_room_for_a_direction_that_is_rounded) {
  Draw draw(3);
  for (int trial = 0; trial < 50'000; ++trial) {
    const Vector3 w = normalized(draw.vector(-30));
    if (w == Vector3{}) continue;
    const Point3 low = Point3{} + draw.vector(-30), high = low + (0x1p-20 + draw.unit()) * w;
    long double height = 0, size = exact_length({w.x, w.y, w.z});
    for (std::size_t k = 0; k < 3; ++k)
      height += static_cast<long double>(w[k]) *
                (static_cast<long double>(high[k]) - static_cast<long double>(low[k]));
    const double gap = gap_of_planes(-static_cast<double>(height));
    EXPECT_GT(gap, 0);
    EXPECT_LE(static_cast<long double>(gap), height / size);
  }
}

}  // namespace
}  // namespace snug::gap_test
