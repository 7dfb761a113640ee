#include <snug/bounds/flat_table.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug::kernels {
namespace {

double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

// Of the limits of the corners of a kind: the value at corner 0, and the differences of the others.
void set_linear(const Kind& kind, std::vector<TableColumn>& columns) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = kind.corner_limits().row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      std::array<double, 3>& linear = columns[row.sources[i]].linear;
      linear[k] += row.weights[i];
      if (k == 0) linear[1] -= row.weights[i], linear[2] -= row.weights[i];
    }
  }
}

}  // namespace

FlatTable flatten(const BoundTable& table, const Kind& kind, std::vector<TableColumn>& memory) {
  const std::size_t count = table.control_count(), first = table.first_bounded();
  SNUG_EXPECT(first == 0 || first == 3);
  memory.clear();
  std::array<double, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) gain[k] = reach(table.triangle[k]);
  for (std::size_t i = first; i < count; ++i) {
    TableColumn column{table.layout[i][0], table.layout[i][1], {}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = table.lower[i - first][k], high = table.upper[i - first][k];
      const double most = std::max(std::fabs(low), std::fabs(high));
      column.middle[k] = 0.5 * (low + high);
      column.half[k] = enlarged(0.5 * (high - low) + 2 * unit_roundoff * most);
      gain[k] += reach(table.layout[i]) * (most + column.half[k]);
    }
    memory.push_back(column);
  }
  if (first == 0) set_linear(kind, memory);
  const double most = enlarged(*std::max_element(gain.begin(), gain.end()));
  const double terms = 12 * unit_roundoff + gamma_bound(count + 4);
  return {memory,
          first,
          table.triangle,
          enlarged(2 * most * terms),
          enlarged((16 * most + 8 * static_cast<double>(count)) * underflow_error),
          2 * most};
}

FlatTable flatten(const TipTable& table, const Kind& kind, std::vector<TableColumn>& memory) {
  memory.clear();
  for (const TipTable::Column& c : table.columns()) {
    memory.push_back(
        {c.u, c.v, {}, {c.middle[0], c.middle[1], c.middle[2]}, {c.half[0], c.half[1], c.half[2]}});
  }
  if (table.first_bounded() == 0) set_linear(kind, memory);
  return {memory,
          table.first_bounded(),
          table.triangle(),
          table.error_of_largest(),
          table.error_at_least(),
          table.error_of_points()};
}

}  // namespace snug::kernels
