#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <gmpxx.h>

namespace snug {

/// An exact weight: a rational number plus rational multiples of 2 cos(2 pi i / n), by i. Masks of valence n are linear in
/// these.
struct Weight {
  mpq_class rational;
  std::vector<std::pair<std::uint32_t, mpq_class>> cosines;

  [[nodiscard]] bool is_rational() const { return cosines.empty(); }
};

/// p / q in lowest terms.
[[nodiscard]] inline mpq_class fraction(long p, long q) {
  mpq_class x(p, q);
  x.canonicalize();
  return x;
}

/// A control point of a refined net as a combination of points of the net: pairs of a point and its weight.
using WeightRow = std::vector<std::pair<std::uint32_t, Weight>>;

/// 2 cos(2 pi j / m) for a net of valence `order`: a rational number where it is one, else m divides the order.
[[nodiscard]] Weight twice_cosine(std::uint32_t j, std::uint32_t m, std::uint32_t order);

}  // namespace snug
