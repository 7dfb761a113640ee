#pragma once

#include <cstdint>

#include <snug/collide.h>

namespace snug::testing {

/// Options of a query that ends with its verdict: nothing is proved or measured beyond it.
[[nodiscard]] inline CollideOptions verdict_only(double tolerance = 0, double margin = 0,
                                                 std::uint64_t budget = 1'000'000) {
  return {
      .tolerance = tolerance, .margin = margin, .budget = budget, .prove_contact = false, .measure = false};
}

}  // namespace snug::testing
