#include <snug/patch/tip_area.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// Steps from a patch to one that repeats itself: sharpness may decay that long, and more.
constexpr unsigned max_depth = 64;
// Largest matrices whose powers are taken for a smaller factor, or to find one at all.
constexpr std::size_t common_size = 80, largest_size = 600;

// By how much at most the extent of points in any direction grows when they are replaced by rows of them: for
// rows a and b it is half the sum of |a - b|.
double growth(double largest_sum, double overlap, double overlap_error) {
  return std::max(0.0, enlarged(largest_sum * (1 + gamma_bound(4096)) - overlap + overlap_error));
}

// What all rows have in common, a column at a time.
class Overlap {
 public:
  explicit Overlap(std::size_t columns) : least_(columns, INFINITY), row_(columns, 0.0) {}
  void add(std::span<const double> row) {
    for (std::size_t c = 0; c < row.size(); ++c) least_[c] = std::min(least_[c], row[c]);
  }
  void add(const Stencils::Row& row) {
    std::fill(row_.begin(), row_.end(), 0.0);
    for (std::size_t i = 0; i < row.sources.size(); ++i) row_[row.sources[i]] += row.weights[i];
    add(row_);
  }
  [[nodiscard]] double sum() const {
    double sum = 0;
    for (const double least : least_) sum += std::max(0.0, least);
    return sum;
  }

 private:
  std::vector<double> least_, row_;
};

double growth_of(const Stencils& rows, std::span<const std::uint32_t> which, std::size_t columns) {
  Overlap overlap(columns);
  double error = 0;
  for (const std::uint32_t r : which) {
    overlap.add(rows.row(r));
    error += rows.row(r).error;
  }
  return growth(rows.max_abs_sum(), overlap.sum(),
                static_cast<double>(columns) * (rows.max_error() + gamma_bound(8)) + error);
}

// Of a patch whose child is of its own kind: the least factor by 1, 2, 4, ... steps at once, `other` being
// that of all that one step splits off.
class Repeated {
 public:
  Repeated(const Stencils& rows, std::span<const std::uint32_t> which, std::size_t size)
      : size_(size), sum_(std::max(1.0, rows.max_abs_sum())), error_(rows.max_error() + gamma_bound(8)) {
    matrix_.assign(size * size, 0.0);
    for (std::size_t r = 0; r < size; ++r) {
      const Stencils::Row row = rows.row(which[r]);
      for (std::size_t i = 0; i < row.sources.size(); ++i) {
        matrix_[r * size + row.sources[i]] += row.weights[i];
      }
    }
  }
  [[nodiscard]] double factor(double other) {
    double best = INFINITY, reach = rate();
    double sum = 1;  // of squared growths of 0, 1, ... steps - 1 steps
    for (unsigned steps = 1;; steps *= 2) {
      const double reach_sq = enlarged(reach * reach);
      if (reach_sq < 1) best = std::min(best, enlarged(other * sum / (1 - reach_sq)));
      const std::size_t limit = best == INFINITY ? largest_size : common_size;
      if (size_ > limit || steps >= most_steps || (best < INFINITY && steps >= enough_steps)) return best;
      sum *= 1 + reach_sq;
      square();
      reach = rate();
    }
  }

 private:
  static constexpr unsigned enough_steps = 8, most_steps = 4096;

  [[nodiscard]] double rate() const {
    Overlap overlap(size_);
    for (std::size_t r = 0; r < size_; ++r) overlap.add(std::span(matrix_).subspan(r * size_, size_));
    return growth(sum_, overlap.sum(), 2 * static_cast<double>(size_) * error_);
  }
  void square() {
    std::vector<double> product(size_ * size_, 0.0);
    for (std::size_t r = 0; r < size_; ++r) {
      for (std::size_t k = 0; k < size_; ++k) {
        const double weight = matrix_[r * size_ + k];
        if (weight == 0) continue;
        for (std::size_t c = 0; c < size_; ++c) product[r * size_ + c] += weight * matrix_[k * size_ + c];
      }
    }
    matrix_ = std::move(product);
    error_ = enlarged(error_ * (2 * sum_ + error_) + gamma_bound(size_ + 2) * sum_ * sum_);
    sum_ = enlarged(sum_ * sum_);
  }

  std::size_t size_;
  std::vector<double> matrix_;
  double sum_;    // largest absolute sum of a row
  double error_;  // of the entries of a row, in sum
};

}  // namespace

double TipAreas::factor(const Kind& kind) { return find(kind, 0); }

double TipAreas::find(const Kind& kind, unsigned depth) {
  if (const auto it = known_.find(&kind); it != known_.end()) return it->second;
  const double domain = kind.rules().triangular() ? 0.5 : 1;
  if (kind.polynomial()) {
    // Derivatives along u and v are averages of differences of lattice points.
    const double stretch = std::max(1.0, kind.lattice().ghosts.max_abs_sum());
    return known_[&kind] = enlarged(domain * stretch * stretch);
  }
  if (depth >= max_depth) return INFINITY;
  const KindStep& step = kind.step();
  double other = 0;
  const KindStep::Piece* again = nullptr;
  bool repeated = false;
  for (const KindStep::Piece& piece : step.pieces) {
    if (piece.kind == &kind) {
      repeated = again != nullptr;
      again = &piece;
      continue;
    }
    const double grows = growth_of(step.stencils, piece.control, kind.control_count());
    other += grows * grows * find(*piece.kind, depth + 1);
  }
  double factor = enlarged(other);
  if (repeated) {
    factor = INFINITY;
  } else if (again != nullptr) {
    factor = Repeated(step.stencils, again->control, kind.control_count()).factor(factor);
  }
  return known_[&kind] = factor;
}

}  // namespace snug
