#include <snug/shape/corner_asymptotics.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// Steps after which a kind comes again, at most: one, but where faces around it are named in turns.
constexpr std::size_t max_period = 24;
// Largest matrices whose powers are taken for a smaller factor, or to find one at all.
constexpr std::size_t common_size = 80, largest_power = 600;

// By how much at most the extent of points in any direction grows when they are replaced by rows of them: for
// rows a and b it is half the sum of |a - b|.
double growth(double largest_sum, double overlap, double overlap_error) {
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

double growth_of(const Stencils& rows, std::span<const std::uint32_t> which, std::size_t columns) {
  Overlap overlap(columns);
  for (const std::uint32_t r : which) overlap.add(rows.row(r));
  return growth(rows.max_abs_sum(), overlap.sum(),
                2 * static_cast<double>(columns) * (rows.max_error() + gamma_bound(8)));
}

// Control points after some steps from those before.
class DenseRows {
 public:
  // None yet: each point by itself.
  explicit DenseRows(std::size_t size) : columns_(size) {}

  void step(const Stencils& rows, std::span<const std::uint32_t> which) {
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
  // Requires:  as many rows as columns.
  void square() {
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
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] double growth() const {
    if (matrix_.empty()) return 1;
    Overlap overlap(columns_);
    for (std::size_t begin = 0; begin < matrix_.size(); begin += columns_) {
      overlap.add(std::span(matrix_).subspan(begin, columns_));
    }
    return snug::growth(sum_, overlap.sum(), 2 * static_cast<double>(columns_) * error_);
  }

 private:
  // Adds a row, weighted.
  void add(double weight, std::size_t row, double* to) const {
    if (matrix_.empty()) {
      to[row] += weight;
      return;
    }
    const double* const from = matrix_.data() + row * columns_;
    for (std::size_t c = 0; c < columns_; ++c) to[c] += weight * from[c];
  }
  void multiplied(double sum, double error) {
    error_ = enlarged(error_ * (sum + error) + error * sum_ +
                      gamma_bound(columns_ + 2) * (sum + error) * (sum_ + error_));
    sum_ = enlarged(sum_ * sum);
  }

  std::size_t columns_;
  std::vector<double> matrix_;
  double sum_ = 1, error_ = 0;  // largest absolute sum of a row; of errors of its entries
};

// The least factor, by one period, two, four, ... at once, `other` being that of all that one period splits
// off. Factors grow by a power of extents' growth.
template <class Power>
double repeated(DenseRows period, double other, const Power& power) {
  constexpr unsigned enough = 8, most = 4096;
  double best = INFINITY;
  double sum = 1;  // of the factors' growths by 0, 1, ... times - 1 periods
  for (unsigned times = 1;; times *= 2) {
    const double growth = enlarged(power(period.growth()));
    if (growth < 1) best = std::min(best, enlarged(other * sum / (1 - growth)));
    const std::size_t limit = best == INFINITY ? largest_power : common_size;
    if (period.columns() > limit || times >= most || (best < INFINITY && times >= enough)) return best;
    sum *= 1 + growth;
    period.square();
  }
}

using Path = std::vector<std::size_t>;

// Children by which a kind comes again, if it does.
bool comes_again(const Kind& kind, const Kind& from, std::unordered_set<const Kind*>& seen, Path& path) {
  if (path.size() >= max_period) return false;
  for (std::size_t k = 0; k < 4; ++k) {
    const Kind& child = *from.step().pieces[k].kind;
    if (child.polynomial()) continue;
    path.push_back(k);
    if (&child == &kind) return true;
    if (seen.insert(&child).second && comes_again(kind, child, seen, path)) return true;
    path.pop_back();
  }
  return false;
}

}  // namespace

// Factors of a kind and of those that it splits into. Growths count squared for areas.
class CornerAsymptotics::FactorSearch {
 public:
  explicit FactorSearch(Measure measure) : measure_(measure) {}

  double find(const Kind& kind) {
    if (const auto it = known_.find(&kind); it != known_.end()) return it->second;
    if (const double* made = asymptotics_of(kind).factors_[measure_].made()) return *made;
    if (kind.polynomial()) {
      // Derivatives along u and v are averages of differences of lattice points.
      const double domain = kind.rules().triangular() ? 0.5 : 1;
      const double stretch = std::max(1.0, kind.lattice().ghosts.max_abs_sum());
      // Of two points u and v differ by at most 1.
      return known_[&kind] = enlarged(measure_ == areas ? domain * stretch * stretch : 2 * stretch);
    }
    if (!open_.insert(&kind).second) return INFINITY;
    const double factor = find_new(kind);
    open_.erase(&kind);
    if (factor < INFINITY) known_[&kind] = factor;
    return factor;
  }
  // Those of other kinds that were found along with it; finite ones do not depend on what was asked first.
  [[nodiscard]] const std::unordered_map<const Kind*, double>& known() const { return known_; }

 private:
  [[nodiscard]] double power(double growth) const { return measure_ == areas ? growth * growth : growth; }
  double find_new(const Kind& kind) {
    Path path;
    std::unordered_set<const Kind*> seen;
    const bool again = !kind.transient() && comes_again(kind, kind, seen, path);
    if (!again) path = {4};  // no child is left out
    DenseRows rows(kind.control_count());
    double factor = 0;
    const Kind* at = &kind;
    for (const std::size_t next : path) {
      const KindStep& step = at->step();
      const double growth = at == &kind ? 1 : rows.growth();
      for (std::size_t k = 0; k < 4; ++k) {
        if (k == next) continue;
        const KindStep::Piece& piece = step.pieces[k];
        const double grows = growth * growth_of(step.stencils, piece.control, at->control_count());
        factor += power(grows) * find(*piece.kind);
      }
      if (!again) return enlarged(factor);
      rows.step(step.stencils, step.pieces[next].control);
      at = step.pieces[next].kind;
    }
    return repeated(std::move(rows), enlarged(factor), [&](double growth) { return power(growth); });
  }

  Measure measure_;
  std::unordered_map<const Kind*, double> known_;
  std::unordered_set<const Kind*> open_;  // whose factors are being found
};

const CharacteristicMap* CornerAsymptotics::characteristic_map() const {
  const auto& map = map_.get([&] { return make_characteristic_map(kind_); });
  return map ? &*map : nullptr;
}

double CornerAsymptotics::factor(Measure measure) const {
  if (const double* made = factors_[measure].made()) return *made;
  // Outside of the lock, as kinds may need each other's.
  FactorSearch search(measure);
  const double found = search.find(kind_);
  for (const auto& [kind, factor] : search.known()) {
    static_cast<void>(asymptotics_of(*kind).factors_[measure].get([factor = factor] { return factor; }));
  }
  return factors_[measure].get([&] { return found; });
}

const CornerAsymptotics& asymptotics_of(const Kind& kind) {
  return *kind.asymptotics_.get([&] { return std::make_shared<const CornerAsymptotics>(kind); });
}

}  // namespace snug
