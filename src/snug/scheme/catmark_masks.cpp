#include <snug/scheme/catmark_masks.h>

#include <cmath>

#include <snug/base/contract.h>

namespace snug::catmark {
namespace {

// p / q, exactly where q is a power of two.
Interval ratio(std::size_t p, std::size_t q) {
  const auto a = static_cast<double>(p), b = static_cast<double>(q);
  return (q & (q - 1)) == 0 ? Interval(a / b) : Interval(a) / Interval(b);
}

}  // namespace

StarMask vertex_mask(std::size_t n) {
  SNUG_EXPECT(n >= 2);
  return {ratio(4 * n - 7, 4 * n), ratio(3, 2 * n * n), ratio(1, 4 * n * n)};
}

CentreMask vertex_centre_mask(std::size_t n) {
  SNUG_EXPECT(n >= 2);
  return {ratio(n - 2, n), ratio(1, n * n), ratio(1, n * n)};
}

StarMask limit_mask(std::size_t n) {
  SNUG_EXPECT(n >= 2);
  return {ratio(n, n + 5), ratio(4, n * (n + 5)), ratio(1, n * (n + 5))};
}

Interval smooth_triangle_face() { return Interval(47) / Interval(100); }

double subdominant(std::size_t n) {
  const double c = cos_of_turn(1, static_cast<unsigned>(n)).middle();
  const double h = cos_of_turn(1, static_cast<unsigned>(2 * n)).middle();
  return (5 + c + h * std::sqrt(2 * (9 + c))) / 16;
}

}  // namespace snug::catmark
