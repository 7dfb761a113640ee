#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// Independent rows W that a step A takes to themselves, W A = L W, and all that lasts under A: of a largest eigenvalue below 1, and of the
/// next one.
struct LastingRows {
  std::vector<std::vector<double>> rows;
  double error = 0;     ///< upper bound of the sum of a row's errors
  Interval least;       ///< the smaller eigenvalue
  bool larger = false;  ///< a larger one, which has one row
  Interval ratio{1};    ///< of that to the smaller one
  std::vector<double>
      column;               ///< of the larger one: v, A v = l v, w v = 1 for its row w, which is the last one
  double column_error = 0;  ///< upper bound of what a number of it is off
  std::size_t links =
      0;  ///< of the smaller one (L - l)^2 = 0, and this is the rank of L - l: if it is not 0, these rows are a chain
};

/// Whether nothing else lasts is not proved here. None where eigenvalues are neither 1/2 or 1/4, exactly, nor simple.
/// Guarantee: there are such exact rows within the error.
/// Source:    derivations/self_contact.md, "Other rows".
[[nodiscard]] std::optional<LastingRows> find_lasting_rows(const Stencils& step, std::size_t size);

/// To rows of one eigenvalue adds that of the largest one, which is larger and simple. False where it is not proved to be.
[[nodiscard]] bool add_largest_row(const Stencils& step, std::size_t size, LastingRows& rows);

}  // namespace snug
