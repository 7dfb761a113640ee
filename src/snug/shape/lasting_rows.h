#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <snug/geometry/interval.h>
#include <snug/scheme/stencils.h>

namespace snug {

/// A column v, A v = x v, w v = 1 for the row w of a simple eigenvalue x.
struct LastingColumn {
  std::vector<double> column;
  double error = 0;   ///< upper bound of what a number of it is off
  Interval ratio{1};  ///< of the eigenvalue to the smallest one that lasts
};

/// Independent rows W that a step A takes to themselves, W A = L W, and all that lasts under A: of a largest eigenvalue below 1, and of the
/// next one; at a spike of the two next ones.
struct LastingRows {
  std::vector<std::vector<double>>
      rows;          ///< those of the smallest eigenvalue, of the larger one, of the spike
  double error = 0;  ///< upper bound of the sum of a row's errors
  Interval least;    ///< the smallest eigenvalue
  std::optional<LastingColumn> larger, spike;  ///< of eigenvalues with one row
  std::size_t links =
      0;  ///< of the smallest one (L - l)^2 = 0, and this is the rank of L - l: if it is not 0, these rows are a chain
};

/// Whether nothing else lasts is not proved here. None where eigenvalues are neither 1/2 or 1/4, exactly, nor simple.
/// Guarantee: there are such exact rows within the error.
/// Source:    derivations/self_contact.md, "Other rows".
[[nodiscard]] std::optional<LastingRows> find_lasting_rows(const Stencils& step, std::size_t size,
                                                           bool spike = false);

/// To rows of one eigenvalue adds that of the largest one, which is larger and simple. None where it is not proved to be.
[[nodiscard]] std::optional<LastingColumn> add_largest_row(const Stencils& step, std::size_t size,
                                                           LastingRows& rows);

}  // namespace snug
