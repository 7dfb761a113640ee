#include "least_squares.h"

#include <algorithm>

#include <support/error.h>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace snug::command {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Factors = Eigen::SimplicialLDLT<Matrix>;
using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

Matrix matrix_of(const Stencils& rows, std::size_t unknowns) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t r = 0; r < rows.row_count(); ++r) {
    const Stencils::Row row = rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      entries.emplace_back(static_cast<int>(r), static_cast<int>(row.sources[i]), row.weights[i]);
    }
  }
  Matrix matrix(static_cast<Eigen::Index>(rows.row_count()), static_cast<Eigen::Index>(unknowns));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace

struct LeastSquares::Matrices {
  Matrix a, normal;  // normal: A'A + weight S'S
  double norm = 0;   // of it, at least

  [[nodiscard]] Matrix shifted(double by) const {
    Matrix result = normal;
    for (Eigen::Index i = 0; i < result.rows(); ++i) result.coeffRef(i, i) += by;
    return result;
  }
  // Sylvester: as many eigenvalues above a shift as positive pivots.
  [[nodiscard]] std::size_t rank() const {
    constexpr double share = 1e-13;
    for (const double factor : {1.0, 1.1, 1.2, 1.4, 1.7, 2.0}) {
      const Factors factors(shifted(-factor * share * norm));
      if (factors.info() != Eigen::Success) continue;  // a pivot of exactly 0
      return static_cast<std::size_t>((factors.vectorD().array() > 0).count());
    }
    throw InputError(InputProblem::refused,
                     "fit: the numerical rank could not be computed; give --smooth WEIGHT");
  }
  // Takes away what inverse iteration finds of the kernel in x.
  void remove_kernel(Columns& x) const {
    const double shift = 1e-12 * norm;
    const Factors factors(shifted(shift));
    for (int twice = 0; twice < 2; ++twice) {
      Columns part = x;
      for (int i = 0; i < 3; ++i) part = shift * factors.solve(part).eval();
      x -= part;
    }
  }
};

LeastSquares::LeastSquares(std::size_t unknowns, const Stencils& a, const Stencils& s, double weight)
    : matrices_(std::make_unique<Matrices>()) {
  matrices_->a = matrix_of(a, unknowns);
  matrices_->normal = matrices_->a.transpose() * matrices_->a;
  if (weight > 0) {
    const Matrix smooth = matrix_of(s, unknowns);
    matrices_->normal += weight * Matrix(smooth.transpose() * smooth);
  }
  for (Eigen::Index c = 0; c < matrices_->normal.cols(); ++c) {
    matrices_->norm = std::max(matrices_->norm, matrices_->normal.col(c).cwiseAbs().sum());
  }
  rank_ = matrices_->rank();
}

LeastSquares::~LeastSquares() = default;

std::vector<std::size_t> LeastSquares::unseen() const {
  std::vector<std::size_t> result;
  for (Eigen::Index c = 0; c < matrices_->a.cols(); ++c) {
    if (matrices_->a.col(c).nonZeros() == 0) result.push_back(static_cast<std::size_t>(c));
  }
  return result;
}

// Residuals are of A itself: refining the solution makes good what the square of its condition takes. Where the matrix is
// singular this is Tikhonov's method iterated: from 0, it stays in the matrix's range, but for rounding, and ends at the shortest
// x.
std::vector<Vector3> LeastSquares::solve(std::span<const Vector3> b) const {
  const Matrix &a = matrices_->a, &normal = matrices_->normal;
  Columns right(a.rows(), 3), x = Columns::Zero(a.cols(), 3);
  for (Eigen::Index r = 0; r < right.rows(); ++r) {
    for (Eigen::Index c = 0; c < 3; ++c) {
      right(r, c) = b[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
    }
  }
  const Matrix smooth = normal - Matrix(a.transpose() * a);
  const bool regular = rank_ == static_cast<std::size_t>(a.cols());
  const Factors factors(matrices_->shifted(regular ? 0 : 1e-10 * matrices_->norm));
  for (int i = 0; i < 100; ++i) {
    const Columns residual = a.transpose() * (right - a * x) - smooth * x;
    const Columns step = factors.solve(residual);
    x += step;
    if (step.cwiseAbs().maxCoeff() <= 1e-15 * x.cwiseAbs().maxCoeff()) break;
  }
  if (!regular) matrices_->remove_kernel(x);
  std::vector<Vector3> result;
  for (Eigen::Index r = 0; r < x.rows(); ++r) result.push_back({x(r, 0), x(r, 1), x(r, 2)});
  return result;
}

}  // namespace snug::command
