#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <snug/independence/weight.h>

namespace snug {

/// A field with a prime number of elements and a root of unity of exactly this order in it: weights have images there, by
/// 2 cos(2 pi i / order) -> root^i + root^-i. A matrix of weights has at least the rank of its image.
struct ModularField {
  std::uint32_t prime = 0, order = 0, root = 0;
  std::vector<std::uint32_t> twice_cosines;  ///< by i

  [[nodiscard]] std::uint32_t product(std::uint64_t a, std::uint64_t b) const {
    return static_cast<std::uint32_t>(a * b % prime);
  }
  [[nodiscard]] std::uint32_t sum(std::uint64_t a, std::uint64_t b) const {
    return static_cast<std::uint32_t>((a + b) % prime);
  }
  [[nodiscard]] std::uint32_t inverse(std::uint32_t a) const;
  /// Requires:  a denominator that the prime does not divide.
  [[nodiscard]] std::uint32_t image(const Weight& w) const;
};

/// The field of the least suitable prime above this number, shown prime by trial division. Small ones are more often unlucky:
/// ranks are lower there.
///
/// Requires:  `above` at most 2^30, or the prime of a field that came of such.
[[nodiscard]] ModularField modular_field(std::uint32_t order, std::uint32_t above = std::uint32_t{1} << 30);

/// The rank of rows that come one by one.
class ModularRank {
 public:
  ModularRank(const ModularField& field, std::size_t columns)
      : field_(field), columns_(columns), by_pivot_(columns) {}

  /// Does this row add to the rank?
  bool add(std::vector<std::uint32_t> row);
  [[nodiscard]] std::uint32_t rank() const { return rank_; }

 private:
  const ModularField& field_;
  std::size_t columns_;
  std::vector<std::vector<std::uint32_t>> by_pivot_;  // 1 at the pivot; empty for none
  std::uint32_t rank_ = 0;
};

}  // namespace snug
