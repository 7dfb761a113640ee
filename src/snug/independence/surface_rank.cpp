#include <snug/independence/surface_rank.h>

#include <algorithm>
#include <map>

namespace snug {
namespace {

using Row = std::vector<std::uint32_t>;
using SparseRow = ModularKernel::Entries;

// row -= factor * pivot, from a column on.
void reduce(const ModularField& field, std::uint32_t factor, const Row& pivot, std::size_t from, Row& row) {
  const std::uint64_t negative = field.prime - factor;
  for (std::size_t k = from; k < row.size(); ++k) {
    row[k] = static_cast<std::uint32_t>((row[k] + negative * pivot[k]) % field.prime);
  }
}

// The row space of the functionals of a kind. Rows stay as they were added, but for multiples of earlier ones.
class RowSpace {
 public:
  explicit RowSpace(std::size_t columns) : pivots_(columns, none) {}

  [[nodiscard]] bool full() const { return rows_.size() == pivots_.size(); }
  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }

  bool add(const ModularField& field, Row row) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (row[c] == 0) continue;
      if (pivots_[c] != none) {
        reduce(field, row[c], rows_[pivots_[c]], c, row);
        continue;
      }
      const std::uint32_t scale = field.inverse(row[c]);
      for (std::uint32_t& x : row) x = field.product(x, scale);
      pivots_[c] = rows_.size();
      rows_.push_back(std::move(row));
      return true;
    }
    return false;
  }

  // In reduced echelon form.
  [[nodiscard]] std::vector<SparseRow> reduced(const ModularField& field) const {
    std::vector<Row> rows = rows_;
    for (std::size_t c = pivots_.size(); c-- > 0;) {
      if (pivots_[c] == none) continue;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        if (r != pivots_[c] && rows[r][c] != 0) reduce(field, rows[r][c], rows[pivots_[c]], c, rows[r]);
      }
    }
    std::vector<SparseRow> result;
    for (const Row& row : rows) {
      SparseRow& entries = result.emplace_back();
      for (std::size_t c = 0; c < row.size(); ++c) {
        if (row[c] != 0) entries.emplace_back(static_cast<std::uint32_t>(c), row[c]);
      }
    }
    return result;
  }

 private:
  static constexpr std::size_t none = SIZE_MAX;
  std::vector<std::size_t> pivots_;  // the row of each column
  std::vector<Row> rows_;
};

// Functionals of the functions of all kinds, from regular ones up.
class Functionals {
 public:
  Functionals(const ExactSurface& surface, const ModularField& field) : surface_(surface), field_(field) {
    parents_.resize(surface.kinds.size());
    for (std::size_t k = 0; k < surface.kinds.size(); ++k) {
      spaces_.emplace_back(surface.kinds[k].control_count);
      for (const ExactKind::Child& child : surface.kinds[k].children) {
        parents_[child.kind].push_back({k, image(child), 0});
      }
    }
  }

  void run(const WorkMonitor& monitor) {
    for (std::size_t k = 0; k < spaces_.size(); ++k) {
      for (const auto& functional : surface_.kinds[k].functionals) {
        Row row(surface_.kinds[k].control_count, 0);
        for (const auto& [i, weight] : functional) {
          const std::uint32_t image = weight >= 0 ? static_cast<std::uint32_t>(weight)
                                                  : field_.prime - static_cast<std::uint32_t>(-weight);
          row[i] = field_.sum(row[i], image);
        }
        spaces_[k].add(field_, std::move(row));
      }
      waiting_.push_back(k);
    }
    while (!waiting_.empty()) {
      monitor.checkpoint();
      const std::size_t kind = waiting_.back();
      waiting_.pop_back();
      for (Parent& parent : parents_[kind]) pass_on(kind, parent);
    }
  }

  [[nodiscard]] std::vector<SparseRow> of(std::size_t kind) const { return spaces_[kind].reduced(field_); }

 private:
  struct Parent {
    std::size_t kind;
    std::vector<SparseRow> rows;
    std::size_t passed;  // functionals of the child
  };

  [[nodiscard]] std::vector<SparseRow> image(const ExactKind::Child& child) const {
    std::vector<SparseRow> rows;
    for (const WeightRow& row : child.rows) {
      SparseRow& entries = rows.emplace_back();
      for (const auto& [i, weight] : row) entries.emplace_back(i, field_.image(weight));
    }
    return rows;
  }

  void pass_on(std::size_t kind, Parent& parent) {
    bool more = false;
    RowSpace& space = spaces_[parent.kind];
    for (; parent.passed < spaces_[kind].rows().size() && !space.full(); ++parent.passed) {
      const Row& functional = spaces_[kind].rows()[parent.passed];
      Row row(surface_.kinds[parent.kind].control_count, 0);
      for (std::size_t i = 0; i < functional.size(); ++i) {
        if (functional[i] == 0) continue;
        for (const auto& [c, weight] : parent.rows[i]) {
          row[c] = field_.sum(row[c], field_.product(functional[i], weight));
        }
      }
      more = space.add(field_, std::move(row)) || more;
    }
    if (more) waiting_.push_back(parent.kind);
  }

  const ExactSurface& surface_;
  const ModularField& field_;
  std::vector<RowSpace> spaces_;
  std::vector<std::vector<Parent>> parents_;
  std::vector<std::size_t> waiting_;  // kinds with functionals that their parents may not know
};

// Elimination of sparse rows; a row of one entry first, whose column then is gone.
class SparseElimination {
 public:
  SparseElimination(const ModularField& field, std::size_t columns)
      : field_(field), zero_(columns, false), pivots_(columns) {}

  void add(SparseRow row) { rows_.push_back(std::move(row)); }

  ModularKernel run(const WorkMonitor& monitor) {
    remove_zero_columns();
    std::sort(rows_.begin(), rows_.end(), [](const SparseRow& a, const SparseRow& b) {
      return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    rows_.erase(std::unique(rows_.begin(), rows_.end()), rows_.end());
    Row work(zero_.size(), 0);
    for (const SparseRow& row : rows_) {
      monitor.checkpoint();
      eliminate(row, work);
    }
    return kernel(monitor);
  }

 private:
  void remove_zero_columns() {
    for (bool found = true; found;) {
      found = false;
      for (SparseRow& row : rows_) {
        std::erase_if(row, [&](const auto& entry) { return zero_[entry.first]; });
        if (row.size() != 1) continue;
        zero_[row.front().first] = found = true;
        row.clear();
      }
      std::erase_if(rows_, [](const SparseRow& row) { return row.empty(); });
    }
  }

  void subtract(std::uint32_t factor, const SparseRow& row, Row& work) const {
    const std::uint64_t negative = field_.prime - factor;
    for (const auto& [c, x] : row)
      work[c] = static_cast<std::uint32_t>((work[c] + negative * x) % field_.prime);
  }

  // Leaves `work` 0.
  void eliminate(const SparseRow& row, Row& work) {
    for (const auto& [c, x] : row) work[c] = x;
    std::size_t c = row.front().first, end = row.back().first + std::size_t{1};
    for (; c < end; ++c) {
      if (work[c] == 0) continue;
      if (pivots_[c].empty()) break;
      end = std::max(end, pivots_[c].back().first + std::size_t{1});
      subtract(work[c], pivots_[c], work);
    }
    if (c == end) return;
    const std::uint32_t scale = field_.inverse(work[c]);
    SparseRow& pivot = pivots_[c];
    for (std::size_t k = c; k < end; ++k) {
      if (work[k] == 0) continue;
      pivot.emplace_back(static_cast<std::uint32_t>(k), field_.product(work[k], scale));
      work[k] = 0;
    }
  }

  ModularKernel kernel(const WorkMonitor& monitor) {
    ModularKernel result;
    std::vector<std::uint32_t> place(zero_.size(), 0);  // of a free column
    for (std::uint32_t c = 0; c < zero_.size(); ++c) {
      if (zero_[c] || !pivots_[c].empty()) {
        ++result.rank;
      } else {
        place[c] = static_cast<std::uint32_t>(result.free_columns.size());
        result.free_columns.push_back(c);
      }
    }
    for (const std::uint32_t c : result.free_columns) result.vectors.push_back({{c, 1}});
    Row work(zero_.size(), 0);
    for (std::size_t c = zero_.size(); c-- > 0;) {
      if (pivots_[c].empty()) continue;
      monitor.checkpoint();
      std::size_t end = 0;
      for (const auto& [k, x] : pivots_[c]) {
        work[k] = x;
        end = std::max(end, k + std::size_t{1});
      }
      SparseRow left{{static_cast<std::uint32_t>(c), 1}};
      for (std::size_t k = c + 1; k < end; ++k) {
        if (work[k] == 0 || pivots_[k].empty()) continue;
        end = std::max(end, pivots_[k].back().first + std::size_t{1});
        subtract(work[k], pivots_[k], work);  // which holds free columns alone beside its own
      }
      for (std::size_t k = c + 1; k < end; ++k) {
        if (work[k] == 0) continue;
        left.emplace_back(static_cast<std::uint32_t>(k), work[k]);
        result.vectors[place[k]].emplace_back(static_cast<std::uint32_t>(c), field_.prime - work[k]);
        work[k] = 0;
      }
      work[c] = 0;
      pivots_[c] = std::move(left);
    }
    for (SparseRow& vector : result.vectors) std::sort(vector.begin(), vector.end());
    return result;
  }

  const ModularField& field_;
  std::vector<bool> zero_;
  std::vector<SparseRow> pivots_;  // by column, 1 there
  std::vector<SparseRow> rows_;
};

}  // namespace

ModularKernel modular_kernel(const ExactSurface& surface, std::size_t columns, const ModularField& field,
                             const WorkMonitor& monitor) {
  Functionals functionals(surface, field);
  functionals.run(monitor);
  std::map<std::uint32_t, std::vector<SparseRow>> reduced;  // by kind
  SparseElimination elimination(field, columns);
  for (const ExactSurface::Patch& patch : surface.patches) {
    monitor.checkpoint();
    const auto [it, added] = reduced.try_emplace(patch.kind);
    if (added) it->second = functionals.of(patch.kind);
    for (const SparseRow& functional : it->second) {
      std::map<std::uint32_t, std::uint32_t> row;
      for (const auto& [i, x] : functional) {
        if (patch.control[i] == no_column) continue;
        std::uint32_t& sum = row[patch.control[i]];
        sum = field.sum(sum, x);
      }
      std::erase_if(row, [](const auto& entry) { return entry.second == 0; });
      if (!row.empty()) elimination.add({row.begin(), row.end()});
    }
  }
  return elimination.run(monitor);
}

}  // namespace snug
