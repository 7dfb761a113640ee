#pragma once

#include <cstddef>
#include <vector>

#include <snug/patch/patch.h>

namespace snug {

/// A square matrix, row after row.
struct SquareMatrix {
  std::size_t size = 0;
  std::vector<double> entries;
};

/// Sizes of all eigenvalues, largest first.
///
/// Errors:    SNUG_EXPECT if the iteration does not end; it is not known to happen.
/// Tightness: some 1e-13 of the largest; with m eigenvalues that lack eigenvectors its m-th root.
/// Cost:      the third power of the size.
/// Source:    reduction to Hessenberg's form, then QR steps with Wilkinson's shift, in complex numbers.
[[nodiscard]] std::vector<double> eigenvalue_sizes(const SquareMatrix& matrix);

/// The matrix of the step at corner 0, after as many splits as what decays needs: from the control points of
/// the piece that keeps the corner to those of the next one.
[[nodiscard]] SquareMatrix corner_matrix(Patch patch);

}  // namespace snug
