#include <experiments/eigenvalues.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include <support/contract.h>

namespace snug {
namespace {

using Complex = std::complex<double>;

// A dense matrix that is worked on in place.
class Work {
 public:
  explicit Work(const SquareMatrix& matrix)
      : size_(matrix.size), entries_(matrix.entries.begin(), matrix.entries.end()) {}

  Complex& at(std::size_t row, std::size_t column) { return entries_[row * size_ + column]; }
  [[nodiscard]] std::size_t size() const { return size_; }

  // Gauss's eliminations, the largest entry as pivot: zeros below the first subdiagonal.
  void to_hessenberg() {
    for (std::size_t k = 1; k + 1 < size_; ++k) {
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < size_; ++i) {
        if (std::abs(at(i, k - 1)) > std::abs(at(pivot, k - 1))) pivot = i;
      }
      if (at(pivot, k - 1) == 0.0) continue;
      for (std::size_t j = 0; j < size_; ++j) std::swap(at(pivot, j), at(k, j));
      for (std::size_t i = 0; i < size_; ++i) std::swap(at(i, pivot), at(i, k));
      for (std::size_t i = k + 1; i < size_; ++i) {
        const Complex factor = at(i, k - 1) / at(k, k - 1);
        if (factor == 0.0) continue;
        for (std::size_t j = 0; j < size_; ++j) at(i, j) -= factor * at(k, j);
        for (std::size_t j = 0; j < size_; ++j) at(j, k) += factor * at(j, i);
      }
    }
  }

  // One QR step on rows and columns `first` to `last`, with a shift.
  void step(std::size_t first, std::size_t last, const Complex& shift) {
    for (std::size_t i = first; i <= last; ++i) at(i, i) -= shift;
    std::vector<std::pair<Complex, Complex>> turns;  // cosine and sine of each
    for (std::size_t k = first; k < last; ++k) {
      const Complex a = at(k, k), b = at(k + 1, k);
      const double length = std::hypot(std::abs(a), std::abs(b));
      const Complex c = length == 0 ? 1.0 : a / length, s = length == 0 ? 0.0 : b / length;
      turns.emplace_back(c, s);
      for (std::size_t j = k; j <= last; ++j) {
        const Complex x = at(k, j), y = at(k + 1, j);
        at(k, j) = std::conj(c) * x + std::conj(s) * y;
        at(k + 1, j) = c * y - s * x;
      }
    }
    for (std::size_t k = first; k < last; ++k) {
      const auto& [c, s] = turns[k - first];
      for (std::size_t i = first; i <= std::min(k + 1, last); ++i) {
        const Complex x = at(i, k), y = at(i, k + 1);
        at(i, k) = x * c + y * s;
        at(i, k + 1) = y * std::conj(c) - x * std::conj(s);
      }
    }
    for (std::size_t i = first; i <= last; ++i) at(i, i) += shift;
  }

  // The eigenvalue of the 2 x 2 block that ends at `last` which is nearer to its last entry.
  Complex shift(std::size_t last) {
    const Complex a = at(last - 1, last - 1), d = at(last, last);
    const Complex half = (a - d) / 2.0,
                  root = std::sqrt(half * half + at(last - 1, last) * at(last, last - 1));
    const Complex one = d + half + root, two = d + half - root;
    return std::abs(one - d) < std::abs(two - d) ? one : two;
  }

 private:
  std::size_t size_;
  std::vector<Complex> entries_;
};

}  // namespace

std::vector<double> eigenvalue_sizes(const SquareMatrix& matrix) {
  SNUG_EXPECT(matrix.size >= 1 && matrix.entries.size() == matrix.size * matrix.size);
  Work work(matrix);
  work.to_hessenberg();
  double largest = 0;
  for (const double entry : matrix.entries) largest = std::max(largest, std::fabs(entry));
  const auto vanishes = [&](std::size_t i) {
    const double near = std::abs(work.at(i, i)) + std::abs(work.at(i - 1, i - 1));
    return std::abs(work.at(i, i - 1)) <= 1e-16 * (near + largest);
  };
  int steps = 0;
  for (std::size_t last = work.size() - 1; last > 0;) {
    if (vanishes(last)) {
      --last;
      steps = 0;
      continue;
    }
    std::size_t first = last - 1;
    while (first > 0 && !vanishes(first)) --first;
    SNUG_EXPECT(++steps < 300);
    // Now and then another shift, for those that go round in circles.
    work.step(first, last,
              steps % 10 == 0 ? work.at(last, last) + work.at(last, last - 1) : work.shift(last));
  }
  std::vector<double> sizes;
  for (std::size_t i = 0; i < work.size(); ++i) sizes.push_back(std::abs(work.at(i, i)));
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

SquareMatrix corner_matrix(Patch patch) {
  for (;;) {
    Patch piece = split(patch, 0);
    if (piece.kind == patch.kind && piece.first == patch.first) break;
    patch = std::move(piece);
  }
  const Stencils rows = patch.kind->children()[patch.to_kind(0)].stencils();
  SquareMatrix matrix{rows.row_count(), std::vector<double>(rows.row_count() * rows.row_count())};
  for (std::size_t r = 0; r < rows.row_count(); ++r) {
    const Stencils::Row row = rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      matrix.entries[r * matrix.size + row.sources[i]] += row.weights[i];
    }
  }
  return matrix;
}

}  // namespace snug
