#include <snug/scheme/loop_masks.h>

#include <snug/base/contract.h>

namespace snug::loop {
namespace {

// The share of the ring. Exact where the cosine is rational.
Interval ring_share(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  if (n == 3) return 0.5625;
  if (n == 4) return 0.484375;
  if (n == 6) return 0.375;
  const Interval f = Interval(3) + Interval(2) * cos_of_turn(1, static_cast<unsigned>(n));
  return Interval(0.625) - f * f * Interval(0x1p-6);
}

}  // namespace

RingMask vertex_mask(std::size_t n) {
  const Interval a = ring_share(n);
  if (n == 3) return {0.4375, 0.1875};
  if (n == 4) return {0.515625, 0.12109375};
  if (n == 6) return {0.625, 0.0625};
  return {Interval(1) - a, a / Interval(static_cast<double>(n))};
}

RingMask limit_mask(std::size_t n) {
  const Interval third = Interval(1) + Interval(8) * ring_share(n) / Interval(3);
  const Interval w = n == 6 ? Interval(0.5) : Interval(1) / third;
  return {w, (Interval(1) - w) / Interval(static_cast<double>(n))};
}

RingMask curve_limit_mask() { return {Interval(2) / Interval(3), Interval(1) / Interval(6)}; }

double subdominant(std::size_t n) { return 0.375 + 0.25 * cos_of_turn(1, static_cast<unsigned>(n)).middle(); }

double subdominant_across_boundary(std::size_t faces) {
  return 0.375 + 0.25 * cos_of_turn(1, static_cast<unsigned>(2 * faces)).middle();
}

}  // namespace snug::loop
