#include <snug/bounds/flat_table.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug::kernels {
namespace {

double reach(const LayoutPoint& u) { return 1 + std::fabs(u[0]) + std::fabs(u[1]); }

// Of the limits of the corners of a kind: the value at corner 0, and the differences of the others.
template <class T>
void set_linear(const Kind& kind, std::vector<TableColumn<T>>& columns) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = kind.corner_limits().row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      std::array<T, 3>& linear = columns[row.sources[i]].linear;
      const auto weight = static_cast<T>(row.weights[i]);
      linear[k] += weight;
      if (k == 0) linear[1] -= weight, linear[2] -= weight;
    }
  }
}

// A number T that is no less, with what a plane of at most `most` may lose when its middle becomes one.
template <class T>
T covering(double half, double most) {
  const double wide = enlarged(half + 2 * roundoff_of<T> * most) + underflow_of<T>;
  if constexpr (sizeof(T) == sizeof(double)) return wide;
  return float_up(wide);
}

// `most`: of the sum of sizes of planes, times the reach of control points, by corners.
template <class T>
FlatTable<T> with_errors(std::span<const TableColumn<T>> columns, std::size_t first,
                         const std::array<LayoutPoint, 3>& triangle, double most) {
  FlatTable<T> flat{columns, first, {}, 0, 0, 0, enlarged(2 * most)};
  for (std::size_t k = 0; k < 3; ++k) {
    flat.triangle[k] = {static_cast<T>(triangle[k][0]), static_cast<T>(triangle[k][1])};
  }
  const std::size_t count = columns.size() + first;
  flat.error_of_largest = enlarged(24 * most * roundoff_of<T>);
  flat.error_of_offset = enlarged(2 * most * gamma_bound<T>(count + 4));
  flat.error_at_least = enlarged((16 * most + 8 * static_cast<double>(count)) * underflow_of<T>);
  return flat;
}

}  // namespace

FlatTable<double> flatten(const BoundTable& table, const Kind& kind,
                          std::vector<TableColumn<double>>& memory) {
  const std::size_t count = table.control_count(), first = table.first_bounded();
  SNUG_EXPECT(first == 0 || first == 3);
  memory.clear();
  std::array<double, 3> gain;
  for (std::size_t k = 0; k < 3; ++k) gain[k] = reach(table.triangle[k]);
  for (std::size_t i = first; i < count; ++i) {
    TableColumn<double> column{table.layout[i][0], table.layout[i][1], {}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const double low = table.lower[i - first][k], high = table.upper[i - first][k];
      const double most = std::max(std::fabs(low), std::fabs(high));
      column.middle[k] = 0.5 * (low + high);
      column.half[k] = covering<double>(0.5 * (high - low), most);
      gain[k] += reach(table.layout[i]) * (most + column.half[k]);
    }
    memory.push_back(column);
  }
  if (first == 0) set_linear(kind, memory);
  return with_errors<double>(memory, first, table.triangle,
                             enlarged(*std::max_element(gain.begin(), gain.end())));
}

template <class T>
FlatTable<T> flatten(const TipTable& table, const Kind& kind, std::vector<TableColumn<T>>& memory) {
  memory.clear();
  for (const TipTable::Column& c : table.columns()) {
    TableColumn<T> column{static_cast<T>(c.u), static_cast<T>(c.v), {}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      column.middle[k] = static_cast<T>(c.middle[k]);
      column.half[k] = covering<T>(c.half[k], std::fabs(c.middle[k]));
    }
    memory.push_back(column);
  }
  if (table.first_bounded() == 0) set_linear(kind, memory);
  return with_errors<T>(memory, table.first_bounded(), table.triangle(), table.error_of_points() / 2);
}

template FlatTable<float> flatten(const TipTable&, const Kind&, std::vector<TableColumn<float>>&);
template FlatTable<double> flatten(const TipTable&, const Kind&, std::vector<TableColumn<double>>&);

}  // namespace snug::kernels
