#include <snug/shape/dense_rows.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// By how much at most the extent of points in any direction grows when they are replaced by rows of them: for
// rows a and b it is half the sum of |a - b|.
double growth_by(double largest_sum, double overlap, double overlap_error) {
  return std::max(0.0, enlarged(largest_sum * (1 + gamma_bound(4096)) - overlap + overlap_error));
}

// The common part of all rows, a column at a time.
class Overlap {
 public:
  explicit Overlap(std::size_t columns) : min_(columns, INFINITY), row_(columns, 0.0) {}
  void add(std::span<const double> row) {
    for (std::size_t c = 0; c < row.size(); ++c) min_[c] = std::min(min_[c], row[c]);
  }
  void add(const Stencils::Row& row) {
    std::fill(row_.begin(), row_.end(), 0.0);
    for (std::size_t i = 0; i < row.sources.size(); ++i) row_[row.sources[i]] += row.weights[i];
    add(row_);
  }
  [[nodiscard]] double sum() const {
    double sum = 0;
    for (const double least : min_) sum += std::max(0.0, least);
    return sum;
  }

 private:
  std::vector<double> min_, row_;
};

}  // namespace

double growth_of(const Stencils& rows, std::span<const std::uint32_t> which, std::size_t columns) {
  Overlap overlap(columns);
  for (const std::uint32_t r : which) overlap.add(rows.row(r));
  return growth_by(rows.max_abs_sum(), overlap.sum(),
                   2 * static_cast<double>(columns) * (rows.max_error() + gamma_bound(8)));
}

void DenseRows::step(const Stencils& rows, std::span<const std::uint32_t> which) {
  std::vector<double> product(which.size() * columns_, 0.0);
  for (std::size_t r = 0; r < which.size(); ++r) {
    const Stencils::Row row = rows.row(which[r]);
    double* const to = product.data() + r * columns_;
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      add(row.weights[i], row.sources[i], to);
    }
  }
  multiplied(rows.max_abs_sum(), rows.max_error() + gamma_bound(8));
  matrix_ = std::move(product);
}

void DenseRows::square() {
  std::vector<double> product(columns_ * columns_, 0.0);
  for (std::size_t r = 0; r < columns_; ++r) {
    for (std::size_t k = 0; k < columns_; ++k) {
      const double weight = matrix_[r * columns_ + k];
      if (weight != 0) add(weight, k, product.data() + r * columns_);
    }
  }
  multiplied(sum_, error_);
  matrix_ = std::move(product);
}

double DenseRows::growth() const {
  if (matrix_.empty()) return 1;
  Overlap overlap(columns_);
  for (std::size_t begin = 0; begin < matrix_.size(); begin += columns_) {
    overlap.add(std::span(matrix_).subspan(begin, columns_));
  }
  return growth_by(sum_, overlap.sum(), 2 * static_cast<double>(columns_) * error_);
}

// Adds a row, weighted.
void DenseRows::add(double weight, std::size_t row, double* to) const {
  if (matrix_.empty()) {
    to[row] += weight;
    return;
  }
  const double* const from = matrix_.data() + row * columns_;
  for (std::size_t c = 0; c < columns_; ++c) to[c] += weight * from[c];
}

void DenseRows::multiplied(double sum, double error) {
  error_ = enlarged(error_ * (sum + error) + error * sum_ +
                    gamma_bound(columns_ + 2) * (sum + error) * (sum_ + error_));
  sum_ = enlarged(sum_ * sum);
}

}  // namespace snug
