#include <snug/shape/lasting_rows.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/shape/control_values.h>
#include <snug/shape/matrix_power.h>

namespace snug {
namespace {

using Row = std::vector<double>;
using Matrix = std::vector<Row>;

// Exact entries have this many bits behind the point at most; whole rows are this large.
constexpr double grain = 0x1p12, largest_whole = 0x1p16;
constexpr int max_iterations = 3000, max_denominator = 400;
constexpr double settled = 1e-10;  // that rows change by from one iteration to the next one
// Eigenvalues that are nearer to each other count as equal.
constexpr double same = 1e-6;

Matrix dense(const Stencils& step, std::size_t size) {
  Matrix a(size, Row(size, 0.0));
  for (std::size_t r = 0; r < size; ++r) {
    const Stencils::Row row = step.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i) a[r][row.sources[i]] += row.weights[i];
  }
  return a;
}

Row times(const Row& w, const Matrix& a) {
  Row product(w.size(), 0.0);
  for (std::size_t r = 0; r < w.size(); ++r) {
    for (std::size_t c = 0; c < w.size(); ++c) product[c] += w[r] * a[r][c];
  }
  return product;
}
Row times(const Matrix& a, const Row& v) {
  Row product;
  for (const Row& row : a) product.push_back(std::inner_product(row.begin(), row.end(), v.begin(), 0.0));
  return product;
}

// Rows x with x M = 0, up to rounding, in echelon form.
Matrix left_null_space(const Matrix& m) {
  const std::size_t n = m.size();
  // Columns of M are equations.
  Matrix equations(n, Row(n));
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) equations[c][r] = m[r][c];
  }
  std::vector<std::size_t> pivots;
  std::size_t rank = 0;
  // The last points' weights come from those of the first ones.
  for (std::size_t k = n; k-- > 0 && rank < n;) {
    std::size_t best = rank;
    for (std::size_t e = rank; e < n; ++e) {
      if (std::fabs(equations[e][k]) > std::fabs(equations[best][k])) best = e;
    }
    if (std::fabs(equations[best][k]) < 1e-10) continue;
    std::swap(equations[rank], equations[best]);
    for (std::size_t e = 0; e < n; ++e) {
      const double factor = e == rank ? 0 : equations[e][k] / equations[rank][k];
      for (std::size_t c = 0; factor != 0 && c < n; ++c) equations[e][c] -= factor * equations[rank][c];
    }
    pivots.push_back(k);
    ++rank;
  }
  Matrix basis;
  for (std::size_t free = 0; free < n; ++free) {
    if (std::find(pivots.begin(), pivots.end(), free) != pivots.end()) continue;
    Row x(n, 0.0);
    x[free] = 1;
    for (std::size_t e = 0; e < rank; ++e) x[pivots[e]] = -equations[e][free] / equations[e][pivots[e]];
    basis.push_back(x);
  }
  return basis;
}

// The row times a whole number, if that is whole, up to rounding.
std::optional<Row> whole(const Row& x) {
  for (int d = 1; d <= max_denominator; ++d) {
    Row rounded;
    for (const double value : x) {
      const double by = d * value, near = std::round(by);
      if (std::fabs(by - near) > 1e-7 || std::fabs(near) > largest_whole) break;
      rounded.push_back(near);
    }
    if (rounded.size() == x.size()) return rounded;
  }
  return std::nullopt;
}

bool is_exact(const Matrix& a) {
  return std::all_of(a.begin(), a.end(), [](const Row& row) {
    return std::all_of(row.begin(), row.end(), [](double x) { return grain * x == std::round(grain * x); });
  });
}

// Of exact matrices: the rows that (A - l)^2 takes to 0. All numbers are whole ones, of at most 53 bits: no sum is rounded.
struct ExactRows {
  Matrix rows;
  std::size_t links = 0;
};
std::optional<ExactRows> exact_rows(const Matrix& a, double eigenvalue) {
  const std::size_t n = a.size();
  if (!is_exact(a)) return std::nullopt;
  Matrix less = a;
  for (std::size_t r = 0; r < n; ++r) {
    less[r][r] -= eigenvalue;
    for (double& x : less[r]) x *= grain;
  }
  Matrix square;
  for (const Row& row : less) square.push_back(times(row, less));
  for (Row& row : square) {
    for (double& x : row) x /= grain * grain;
  }
  ExactRows result;
  Matrix after;
  for (const Row& x : left_null_space(square)) {
    const std::optional<Row> row = whole(x);
    if (!row) return std::nullopt;
    const auto size = [](const Row& of) {
      double sum = 0;
      for (const double value : of) sum += std::fabs(value);
      return sum;
    };
    const Row once = times(*row, less);
    if (!(size(*row) * grain * 4 < 0x1p52) || !(size(once) * grain * 4 < 0x1p52)) return std::nullopt;
    for (const double value : times(once, less)) {
      if (value != 0) return std::nullopt;
    }
    result.rows.push_back(*row);
    if (size(once) != 0) after.push_back(once);
  }
  // At least as many as these are independent; more than one are taken for more.
  result.links = after.size();
  for (std::size_t k = 1; k < after.size(); ++k) {
    bool same_line = true;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < i; ++j)
        same_line = same_line && after[0][i] * after[k][j] == after[0][j] * after[k][i];
    }
    if (same_line) --result.links;
  }
  return result;
}

double norm(const Matrix& m) {
  double largest = 0;
  for (const Row& row : m) {
    double sum = 0;
    for (const double x : row) sum += std::fabs(x);
    largest = std::max(largest, sum);
  }
  return enlarged(largest * (1 + gamma_bound(m.size() + 1)));
}

// A row and an eigenvalue near an exact pair, all numbers at most `off` from it.
struct Pair {
  Row row, column;  // left and right
  double eigenvalue = 0, off = 0;
};

// w A - x w in one column, as if in twice as many digits: each product and each sum leaves what it is off, and these are added up.
double residual_at(const Row& w, double x, const Matrix& a, std::size_t column) {
  double sum = 0, rest = 0;
  const auto add = [&](double p, double q) {
    const double product = p * q, total = sum + product, part = total - sum;
    rest += std::fma(p, q, -product) + ((sum - (total - part)) + (product - part));
    sum = total;
  };
  for (std::size_t r = 0; r < w.size(); ++r) add(w[r], a[r][column]);
  add(-x, w[column]);
  return sum + rest;
}

// By Newton's step for w A = x w, w . c = 1, in all numbers (w, x): R is about the inverse of the derivative J there, the second
// derivative takes h to (-h_x h_w, 0). An exact pair is within r if |R F| + |1 - R J| r + |R| r^2 <= r.
bool verify(const Matrix& a, double a_error, Pair& pair) {
  const std::size_t n = a.size();
  // A step before, towards it.
  for (const bool last : {false, true}) {
    Matrix j(n + 1, Row(n + 1, 0.0));
    double square = 0, sum = 0;
    for (const double x : pair.row) {
      square += x * x;
      sum += std::fabs(x);
    }
    for (std::size_t c = 0; c < n; ++c) {
      for (std::size_t r = 0; r < n; ++r) j[c][r] = a[r][c] - (r == c ? pair.eigenvalue : 0);
      j[c][n] = -pair.row[c];
      j[n][c] = pair.row[c] / square;
    }
    const Matrix inverted = about_inverse(j);
    if (inverted.empty()) return false;
    Row residual;
    for (std::size_t c = 0; c < n; ++c) residual.push_back(residual_at(pair.row, pair.eigenvalue, a, c));
    residual.push_back(0);  // the normalisation is what the row has
    const Row step = times(inverted, residual);
    if (!last) {
      for (std::size_t c = 0; c < n; ++c) pair.row[c] -= step[c];
      pair.eigenvalue -= step[n];
      continue;
    }
    // Columns of A have sums of at most n.
    const double of_inverse = norm(inverted), of_derivative = norm(j), gamma = gamma_bound(n + 4);
    const auto count = static_cast<double>(n);
    const double residual_off =
        2 * (gamma * gamma * (sum + 1) * 4 + unit_roundoff * largest_of(residual)) + a_error * sum;
    const double first =
        enlarged(largest_of(step) + of_inverse * (gamma * largest_of(residual) + residual_off));
    Matrix product;
    for (const Row& row : inverted) product.push_back(times(row, j));
    for (std::size_t k = 0; k <= n; ++k) product[k][k] -= 1;
    const double slope =
        enlarged(norm(product) + of_inverse * (gamma * of_derivative * (count + 1) + count * a_error));
    pair.off = enlarged(4 * first);
    if (!(first + slope * pair.off + of_inverse * pair.off * pair.off <= pair.off) || !(pair.off < 1e-9))
      return false;
  }
  return true;
}

// The largest eigenvalue beside 1, and the next one; by iteration, without constants and what was found before.
std::optional<Pair> largest_pair(const Matrix& a, const std::vector<Pair>& before) {
  const std::size_t n = a.size();
  Pair pair;
  for (std::size_t i = 0; i < n; ++i) {
    pair.row.push_back(std::sin(1.0 + 3.0 * static_cast<double>(i * i)));
    pair.column.push_back(std::cos(2.0 + static_cast<double>(i * i)));
  }
  const auto dot = [](const Row& x, const Row& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0.0);
  };
  const auto remove = [](Row& x, double by, const Row& y) {
    for (std::size_t i = 0; i < x.size(); ++i) x[i] -= by * y[i];
  };
  const auto scale = [](Row& x) {
    const double size = largest_of(x);
    for (double& value : x) value /= size;
    return size;
  };
  // Newton's steps do the rest.
  const auto settles = [](const Row& x, const Row& last) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(std::fabs(x[i] - last[i]) <= settled)) return false;
    }
    return true;
  };
  // The row of the eigenvalue 1.
  Row limit(n, 1.0);
  for (int i = 0; i < max_iterations; ++i) {
    const Row last = limit;
    limit = times(limit, a);
    static_cast<void>(scale(limit));
    if (settles(limit, last)) break;
  }
  const Row ones(n, 1.0);
  for (int i = 0; i < max_iterations; ++i) {
    const Row last_row = pair.row, last_column = pair.column;
    remove(pair.row, dot(pair.row, ones) / dot(limit, ones), limit);
    remove(pair.column, dot(limit, pair.column) / dot(limit, ones), ones);
    for (const Pair& other : before) {
      const double both = dot(other.row, other.column);
      remove(pair.row, dot(pair.row, other.column) / both, other.row);
      remove(pair.column, dot(other.row, pair.column) / both, other.column);
    }
    pair.row = times(pair.row, a);
    pair.column = times(a, pair.column);
    if (!(scale(pair.row) > 1e-12) || !(scale(pair.column) > 1e-12)) return std::nullopt;
    if (settles(pair.row, last_row) && settles(pair.column, last_column)) break;
  }
  const double both = dot(pair.row, pair.column);
  if (!(std::fabs(both) > 1e-9)) return std::nullopt;
  pair.eigenvalue = dot(times(pair.row, a), pair.column) / both;
  return pair;
}

Interval around(const Pair& pair) {
  return {rounded_down(pair.eigenvalue - pair.off), rounded_up(pair.eigenvalue + pair.off)};
}

std::optional<LastingColumn> add_row(const Matrix& a, double error, Pair first, LastingRows& result) {
  const std::size_t size = a.size();
  if (!verify(a, error, first)) return std::nullopt;
  // From the right: the rows of what is turned over.
  Matrix turned(size, Row(size));
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t c = 0; c < size; ++c) turned[c][r] = a[r][c];
  }
  Pair right = first;
  right.row = first.column;
  if (!verify(turned, error, right)) return std::nullopt;
  LastingColumn own;
  double seen = 0, sum = 0;
  for (std::size_t i = 0; i < size; ++i) {
    seen += first.row[i] * right.row[i];
    sum += std::fabs(first.row[i]) + std::fabs(right.row[i]);
  }
  for (const double x : right.row) own.column.push_back(x / seen);
  const double seen_off =
      enlarged((first.off + right.off + gamma_bound(size + 2) * largest_of(first.row)) * sum);
  if (!(seen_off < 0x1p-20 * std::fabs(seen))) return std::nullopt;
  own.error = enlarged(right.off / std::fabs(seen) +
                       (2 * seen_off / std::fabs(seen) + gamma_bound(3)) * largest_of(own.column));
  own.ratio = around(first) / result.least;
  result.rows.push_back(first.row);
  result.error = std::max(result.error, enlarged(static_cast<double>(size) * first.off));
  return own;
}

// Of entries that are not exact.
double entry_error(const Stencils& step, const Matrix& a) {
  return is_exact(a) ? 0 : step.max_error() + gamma_bound(2);
}

// All that lasts beside some pairs.
std::optional<LastingRows> find_rows_beside(const Matrix& a, double error, std::vector<Pair> before) {
  const std::optional<Pair> found = largest_pair(a, before);
  if (!found) return std::nullopt;
  const Pair& first = *found;
  before.push_back(first);
  LastingRows result;
  const auto count = static_cast<double>(a.size());
  std::optional<Pair> second;
  for (const double eigenvalue : {0.5, 0.25}) {
    if (first.eigenvalue < eigenvalue - same) continue;
    std::optional<ExactRows> exact = exact_rows(a, eigenvalue);
    if (!exact) break;
    // Chained rows show themselves to iterations only slowly.
    const double most = eigenvalue + (exact->links > 0 ? 0.01 : same);
    const bool alone = first.eigenvalue < most;
    if (exact->rows.size() < (alone ? 2 : 1)) continue;
    if (!alone) {
      if (!second) second = largest_pair(a, before);
      if (second && second->eigenvalue > most) break;
    }
    result.rows = std::move(exact->rows);
    result.least = Interval(eigenvalue);
    result.links = exact->links;
    if (!alone && !(result.larger = add_row(a, error, first, result))) return std::nullopt;
    return result;
  }
  if (!second) second = largest_pair(a, before);
  if (!second || second->eigenvalue > first.eigenvalue - same || !verify(a, error, *second))
    return std::nullopt;
  result.rows = {second->row};
  result.error = enlarged(count * second->off);
  result.least = around(*second);
  if (!(result.least.lower > 0) || !(result.larger = add_row(a, error, first, result))) return std::nullopt;
  return result;
}

}  // namespace

std::optional<LastingRows> find_lasting_rows(const Stencils& step, std::size_t size, bool spike) {
  const Matrix a = dense(step, size);
  const double error = entry_error(step, a);
  if (!spike) return find_rows_beside(a, error, {});
  const std::optional<Pair> first = largest_pair(a, {});
  if (!first) return std::nullopt;
  std::optional<LastingRows> result = find_rows_beside(a, error, {*first});
  if (!result || !(result->spike = add_row(a, error, *first, *result))) return std::nullopt;
  return result;
}

std::optional<LastingColumn> add_largest_row(const Stencils& step, std::size_t size, LastingRows& rows) {
  const Matrix a = dense(step, size);
  const std::optional<Pair> first = largest_pair(a, {});
  if (!first || !(first->eigenvalue > rows.least.upper + same)) return std::nullopt;
  return add_row(a, entry_error(step, a), *first, rows);
}

}  // namespace snug
