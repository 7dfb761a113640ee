#pragma once

#include <memory>
#include <span>
#include <vector>

#include <snug/scheme/stencils.h>
#include <support/point.h>

namespace snug::command {

/// The least of |A x - b|^2 + weight |S x|^2, over x, for sparse rows A and S: in each coordinate alone.
class LeastSquares {
 public:
  /// S has no rows where weight is 0.
  LeastSquares(std::size_t unknowns, const Stencils& a, const Stencils& s, double weight);
  ~LeastSquares();

  /// The numerical rank: singular values below 3e-7 of the largest, about, count as 0.
  [[nodiscard]] std::size_t rank() const { return rank_; }
  /// Unknowns in no row of A.
  [[nodiscard]] std::vector<std::size_t> unseen() const;
  /// Where there are several, the shortest x.
  /// Requires:  b: one a row of A.
  [[nodiscard]] std::vector<Vector3> solve(std::span<const Vector3> b) const;

 private:
  struct Matrices;
  std::unique_ptr<Matrices> matrices_;
  std::size_t rank_;
};

}  // namespace snug::command
