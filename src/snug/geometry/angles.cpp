#include <snug/geometry/angles.h>

#include <array>
#include <cmath>
#include <cstddef>

#include <snug/geometry/double_double.h>

namespace snug {
namespace {

// A quarter of a turn, in three parts.
constexpr std::array<double, 3> quarter_turn{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54,
                                             -0x1.f1976b7ed8fbcp-110};

// 1 / (n (n + 1)).
constexpr auto inverses = [] {
  std::array<DoubleDouble, 29> list;
  for (int n = 1; n < 29; ++n)
    list[static_cast<std::size_t>(n)] = DoubleDouble{1, 0} / DoubleDouble{1.0 * n * (n + 1), 0};
  return list;
}();

// 1 - r^2 / (first (first + 1)) (1 - r^2 / ((first + 2) (first + 3)) (...)), until 2^-104 is left for |r| <= pi / 4.
DoubleDouble series(DoubleDouble square, std::size_t first) {
  DoubleDouble sum{1, 0};
  for (std::size_t n = first + 28; n > first;) sum = DoubleDouble{1, 0} - square * inverses[n -= 2] * sum;
  return sum;
}

struct Turned {
  DoubleDouble sine, cosine;
};

Turned exact_turn(double radians) {
  const double turns = std::nearbyint(radians / quarter_turn[0]);
  DoubleDouble rest{radians, 0};
  for (const double part : quarter_turn) rest = rest - exact_product(turns, part);
  const DoubleDouble square = rest * rest, sine = rest * series(square, 2), cosine = series(square, 1);
  switch (static_cast<long>(turns) & 3) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace

NearestTurn nearest_turn(double radians) {
  if (std::fabs(radians) < 0x1p-27) return {radians, 1};  // the next terms are less than half a unit
  if (!(std::fabs(radians) <= 1e9)) return {std::sin(radians), std::cos(radians)};
  const auto [sine, cosine] = exact_turn(radians);
  return {sine.high, cosine.high};
}

// One step of Newton's from the C library's angle, whose last bit does not matter then.
double angle_of(double y, double x) {
  const double near = std::atan2(y, x);
  if (std::fabs(near) < 0x1p-400) return near;  // whose products would vanish
  const auto [sine, cosine] = exact_turn(near);
  const DoubleDouble across = DoubleDouble{y, 0} * cosine - DoubleDouble{x, 0} * sine;
  return near + across.high / (x * cosine.high + y * sine.high);
}

}  // namespace snug
