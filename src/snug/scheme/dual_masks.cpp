#include <snug/scheme/dual_masks.h>

#include <algorithm>

#include <snug/base/contract.h>

namespace snug::dual {

std::vector<Interval> doo_sabin_mask(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  if (n == 4) return {0.5625, 0.1875, 0.0625, 0.1875};
  std::vector<Interval> mask;
  const Interval quarter_n = 4 * static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Interval cosine = cos_of_turn(static_cast<unsigned>(i), static_cast<unsigned>(n));
    mask.push_back((Interval(3) + Interval(2) * cosine) / quarter_n);
  }
  mask[0] = Interval(0.25) + Interval(5) / quarter_n;
  return mask;
}

std::vector<Interval> midedge_mask(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  std::vector<Interval> mask(n, 0.0);
  mask[0] = 0.5;
  mask[1] = mask[n - 1] = 0.25;
  return mask;
}

double doo_sabin_subdominant(std::size_t n) {
  // The first Fourier mode has 1/4 + 2 / (4n) n/2 = 1/2 for every n.
  SNUG_EXPECT(n >= 3);
  return 0.5;
}

double midedge_subdominant(std::size_t n) {
  // Modes 1 and n - 1; for n = 3 there are no others, and 1/4 is what remains.
  return 0.5 + 0.5 * cos_of_turn(1, static_cast<unsigned>(n)).middle();
}

}  // namespace snug::dual
