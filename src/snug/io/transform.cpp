#include <snug/io/transform.h>

#include <cmath>
#include <optional>

namespace snug {
namespace {

using Matrix = std::array<std::array<Interval, 3>, 3>;
using Row = std::array<Interval, 3>;

bool finite(const Interval& a) { return std::isfinite(a.lower) && std::isfinite(a.upper); }
bool is_zero(const Interval& a) { return a == Interval(0); }

Interval product(const Interval& factor, const Interval& x) {
  if (factor == Interval(1)) return x;
  if (factor == Interval(-1)) return -x;
  if (x == Interval(1)) return factor;
  if (x == Interval(-1)) return -factor;
  return factor * x;
}

Interval sum(const Interval& a, const Interval& b) { return is_zero(a) ? b : is_zero(b) ? a : a + b; }

Interval dot(const Row& row, const Row& column) {
  Interval result(0);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!is_zero(row[k]) && !is_zero(column[k])) result = sum(result, product(row[k], column[k]));
  }
  return result;
}

Row column_of(const Matrix& m, std::size_t j) { return {m[0][j], m[1][j], m[2][j]}; }

Matrix transposed(const Matrix& m) { return {column_of(m, 0), column_of(m, 1), column_of(m, 2)}; }

Row operator*(const Matrix& m, const Row& x) { return {dot(m[0], x), dot(m[1], x), dot(m[2], x)}; }

Matrix operator*(const Matrix& a, const Matrix& b) {
  const Matrix columns = transposed(b);
  return transposed({a * columns[0], a * columns[1], a * columns[2]});
}

Interval minor(const Matrix& m, std::size_t i, std::size_t j) {
  const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  const Interval second = dot({m[i1][j2], 0, 0}, {m[i2][j1], 0, 0});
  return sum(dot({m[i1][j1], 0, 0}, {m[i2][j2], 0, 0}), -second);
}

Matrix turn(std::size_t axis, double degrees) {
  const auto [sine, cosine] = of_degrees(degrees);
  const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  Matrix m = AffineEnclosure().matrix;
  m[a][a] = m[b][b] = cosine;
  m[a][b] = -sine;
  m[b][a] = sine;
  return m;
}

// Three different letters of X, Y and Z.
bool is_order(std::string_view letters) {
  return letters.size() == 3 && letters.find('X') < 3 && letters.find('Y') < 3 && letters.find('Z') < 3;
}

std::size_t axis_of(char letter) { return static_cast<std::size_t>(letter - 'X'); }

// The axis that "translateX" and the like name.
std::optional<std::size_t> axis_behind(std::string_view kind, std::string_view front) {
  if (kind.size() != front.size() + 1 || !kind.starts_with(front)) return {};
  if (kind.back() < 'X' || kind.back() > 'Z') return {};
  return axis_of(kind.back());
}

TransformOperation translation(const Row& shift, bool inverse) {
  TransformOperation result;
  for (std::size_t k = 0; k < 3; ++k) result.map.shift[k] = inverse ? -shift[k] : shift[k];
  return result;
}

TransformOperation scale(const Row& factors, bool inverse) {
  TransformOperation result;
  for (std::size_t k = 0; k < 3; ++k) {
    if (inverse && is_zero(factors[k])) return {{}, "cannot be inverted: a factor is 0"};
    const bool is_unit = factors[k] == Interval(1) || factors[k] == Interval(-1);
    result.map.matrix[k][k] = inverse && !is_unit ? Interval(1) / factors[k] : factors[k];
  }
  return result;
}

TransformOperation rotation(const Matrix& m, bool inverse) {
  TransformOperation result;
  result.map.matrix = inverse ? transposed(m) : m;
  return result;
}

TransformOperation orientation(std::span<const double> q, bool inverse) {
  const Row v{q[1], q[2], q[3]};
  const Interval w = q[0], norm_sq = sum(product(w, w), dot(v, v));
  constexpr double slack = 0.01;
  if (!(std::fabs(middle(norm_sq) - 1) <= 2 * slack)) {
    return {{}, "is a quaternion of another length than 1: write w, x, y, z of a rotation"};
  }
  if (is_zero(dot(v, v))) return {};
  const Interval twice = Interval(2) / norm_sq;
  Matrix m = AffineEnclosure().matrix;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    m[i][i] = Interval(1) - twice * (v[j] * v[j] + v[k] * v[k]);
    m[i][j] = twice * (v[i] * v[j] - w * v[k]);
    m[j][i] = twice * (v[i] * v[j] + w * v[k]);
  }
  return rotation(m, inverse);
}

TransformOperation matrix_operation(std::span<const double> rows, bool inverse) {
  TransformOperation result;
  if (rows[3] != 0 || rows[7] != 0 || rows[11] != 0 || rows[15] != 1) {
    return {{}, "is a perspective map: write one whose numbers beside the images are 0 0 0 1"};
  }
  Matrix& m = result.map.matrix;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] = rows[4 * j + i];
    result.map.shift[i] = rows[12 + i];
  }
  if (!inverse) return result;
  AffineEnclosure inverted;  // its matrix: first the adjugate
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) inverted.matrix[i][j] = minor(m, j, i);
  }
  const Interval det = inverted.is_finite() ? dot(m[0], column_of(inverted.matrix, 0)) : Interval(0);
  if (!finite(det) || det.contains(0))
    return {{}, "cannot be inverted: its matrix is singular, or nearly so"};
  for (Row& row : inverted.matrix) {
    for (Interval& entry : row) entry = entry / det;
  }
  const Row back = inverted.matrix * result.map.shift;
  inverted.shift = {-back[0], -back[1], -back[2]};
  return {inverted, {}};
}

TransformOperation operation(std::string_view kind, std::span<const double> n, bool inverse) {
  const auto needs = [&](std::size_t count) { return n.size() == count; };
  const auto wrong_count = [&](const char* count) {
    return TransformOperation{{}, "has " + std::to_string(n.size()) + " numbers, not " + count};
  };
  const auto three = [](double x, double y, double z) { return Row{x, y, z}; };
  if (kind == "translate" || kind == "scale") {
    if (!needs(3)) return wrong_count("three");
    return kind == "scale" ? scale(three(n[0], n[1], n[2]), inverse)
                           : translation(three(n[0], n[1], n[2]), inverse);
  }
  if (kind == "orient") return needs(4) ? orientation(n, inverse) : wrong_count("the four of a quaternion");
  if (kind == "transform") return needs(16) ? matrix_operation(n, inverse) : wrong_count("sixteen");
  if (kind.starts_with("rotate") && is_order(kind.substr(6))) {
    if (!needs(3)) return wrong_count("three");
    Matrix m = AffineEnclosure().matrix;
    for (const char letter : kind.substr(6)) m = turn(axis_of(letter), n[axis_of(letter)]) * m;
    return rotation(m, inverse);
  }
  for (const std::string_view front : {"translate", "scale", "rotate"}) {
    const auto axis = axis_behind(kind, front);
    if (!axis) continue;
    if (!needs(1)) return wrong_count("one");
    if (front == "rotate") return rotation(turn(*axis, n[0]), inverse);
    Row all = front == "scale" ? three(1, 1, 1) : three(0, 0, 0);
    all[*axis] = n[0];
    return front == "scale" ? scale(all, inverse) : translation(all, inverse);
  }
  return {{}, "is an operation that snug does not know"};
}

}  // namespace

std::array<Interval, 3> AffineEnclosure::operator()(const Point3& point) const {
  Row result = matrix * Row{point.x, point.y, point.z};
  for (std::size_t i = 0; i < 3; ++i) result[i] = sum(result[i], shift[i]);
  return result;
}

AffineEnclosure AffineEnclosure::after(const AffineEnclosure& inner) const {
  AffineEnclosure result{matrix * inner.matrix, matrix * inner.shift};
  for (std::size_t i = 0; i < 3; ++i) result.shift[i] = sum(result.shift[i], shift[i]);
  return result;
}

int AffineEnclosure::handedness() const {
  Matrix scaled = matrix;  // each row by a power of two: nothing overflows, little underflows
  for (Row& row : scaled) {
    double largest = 0;
    for (const Interval& entry : row) {
      largest = std::fmax(largest, std::fmax(std::fabs(entry.lower), std::fabs(entry.upper)));
    }
    if (largest == 0) return 0;
    const int exponent = std::ilogb(largest);
    for (Interval& entry : row) {
      // Exact but for what underflows.
      entry = {rounded_down(std::scalbn(entry.lower, -exponent)),
               rounded_up(std::scalbn(entry.upper, -exponent))};
    }
  }
  const Interval det = dot(scaled[0], {minor(scaled, 0, 0), minor(scaled, 0, 1), minor(scaled, 0, 2)});
  return det.lower > 0 ? 1 : det.upper < 0 ? -1 : 0;
}

bool AffineEnclosure::is_finite() const {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!finite(shift[i])) return false;
    for (const Interval& entry : matrix[i]) {
      if (!finite(entry)) return false;
    }
  }
  return true;
}

TransformOperation transform_operation(std::string_view kind, std::span<const double> numbers, bool inverse) {
  TransformOperation result = operation(kind, numbers, inverse);
  if (result.fault.empty() && !result.map.is_finite()) result.fault = "is beyond the range of doubles";
  return result;
}

}  // namespace snug
