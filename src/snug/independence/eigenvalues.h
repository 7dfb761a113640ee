#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <gmpxx.h>

#include <snug/independence/control_net.h>

namespace snug {

/// A rational eigenvalue, how often it is a root, and its eigenvectors: control points 1 to K, a basis.
struct RationalEigenvalue {
  mpq_class value;
  std::uint32_t algebraic = 0;
  std::vector<std::vector<mpq_class>> span;

  [[nodiscard]] std::size_t geometric() const { return span.size(); }
};

/// Facts about the eigenvalues of A', the step to the part of a piece that keeps its corner.
struct CornerEigenvalues {
  /// Is the characteristic polynomial the one whose roots the dissertation lists? Exact.
  bool as_stated = false;
  /// Of 3/8 and the powers of 1/2 from 1 to 1/64 those that are several times roots, largest first.
  std::vector<RationalEigenvalue> repeated;
};

/// The eigenvalues of the step at a corner of valence n >= 3, by exact arithmetic.
///
/// Requires:  Loop, or Catmull-Clark without the older rule.
/// Cost:      a characteristic polynomial of K by K; a second for n = 100.
/// Source:    [Wu05, sec. 3.4 and 3.6].
[[nodiscard]] CornerEigenvalues corner_eigenvalues(const ExactScheme& scheme, std::uint32_t n);

}  // namespace snug
