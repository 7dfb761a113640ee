#pragma once

#include <snug/collide.h>

namespace snug::testing {

/// Options of a query that ends with its verdict: nothing is proved or measured beyond it.
[[nodiscard]] inline CollideOptions verdict_only(double tolerance = 0, double margin = 0) {
  return {.tolerance = tolerance, .margin = margin, .prove_contact = false, .measure = false};
}

}  // namespace snug::testing
