#include <snug/shape/matrix_power.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

double largest_sum(const std::vector<double>& matrix, std::size_t size) {
  double largest = 0;
  for (std::size_t r = 0; r < size; ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < size; ++c) sum += std::fabs(matrix[r * size + c]);
    largest = std::max(largest, sum);
  }
  return enlarged(largest * (1 + gamma_bound(size)));
}

}  // namespace

double growth_of_rows(const std::vector<double>& matrix, std::size_t size) {
  double widest = 0;
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double sum = 0;
      for (std::size_t c = 0; c < size; ++c) {
        sum += std::fabs(matrix[a * size + c] - matrix[b * size + c]);
      }
      widest = std::max(widest, sum);
    }
  }
  return enlarged(0.5 * widest);
}

std::vector<std::vector<double>> about_inverse(std::vector<std::vector<double>> m) {
  const std::size_t n = m.size();
  std::vector<std::vector<double>> result(n, std::vector<double>(n, 0.0));
  for (std::size_t k = 0; k < n; ++k) result[k][k] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = k;
    for (std::size_t r = k; r < n; ++r) {
      if (std::fabs(m[r][k]) > std::fabs(m[best][k])) best = r;
    }
    if (!(std::fabs(m[best][k]) > 1e-12)) return {};
    std::swap(m[k], m[best]);
    std::swap(result[k], result[best]);
    const double pivot = 1 / m[k][k];
    for (std::size_t c = 0; c < n; ++c) {
      m[k][c] *= pivot;
      result[k][c] *= pivot;
    }
    for (std::size_t r = 0; r < n; ++r) {
      const double factor = r == k ? 0 : m[r][k];
      for (std::size_t c = 0; factor != 0 && c < n; ++c) {
        m[r][c] -= factor * m[k][c];
        result[r][c] -= factor * result[k][c];
      }
    }
  }
  return result;
}

MatrixPower::MatrixPower(const Stencils& rows, std::size_t columns)
    : size(columns), matrix(columns * columns, 0.0), sum(rows.max_abs_sum()) {
  for (std::size_t r = 0; r < size; ++r) {
    const Stencils::Row row = rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) matrix[r * size + row.sources[i]] += row.weights[i];
  }
  error = enlarged(rows.max_error() + gamma_bound(8) * sum);
}

void MatrixPower::remove(const Stencils::Row& row) {
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t i = 0; i < row.sources.size(); ++i) matrix[r * size + row.sources[i]] -= row.weights[i];
  }
  error = enlarged(error + gamma_bound(4) * (sum + row.abs_sum));
  sum = largest_sum(matrix, size);
}

void MatrixPower::square() {
  std::vector<double> product(size * size, 0.0);
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t k = 0; k < size; ++k) {
      const double weight = matrix[r * size + k];
      if (weight == 0) continue;
      for (std::size_t c = 0; c < size; ++c) product[r * size + c] += weight * matrix[k * size + c];
    }
  }
  error = enlarged(error * (2 * sum + error) + gamma_bound(size + 2) * sum * sum);
  sum = largest_sum(product, size);
  matrix = std::move(product);
}

}  // namespace snug
