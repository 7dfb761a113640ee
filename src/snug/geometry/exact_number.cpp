#include <snug/geometry/exact_number.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/geometry/rounding.h>

namespace snug {

// Zeros are left out, which leaves no two parts next to each other: the last one is more than a third of the sum.
void ExactNumber::add(double x) {
  if (x == 0) return;
  std::size_t kept = 0;
  for (const double part : parts_) {
    const auto [sum, rest] = exact_sum(x, part);
    x = sum;
    if (rest != 0) parts_[kept++] = rest;
  }
  parts_.resize(kept);
  if (x != 0) parts_.push_back(x);
}

DoubleDouble ExactNumber::about() const {
  DoubleDouble sum;
  for (const double part : parts_) sum = DoubleDouble{part, 0} + sum;
  return sum;
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
  ExactNumber sum = a;
  for (const double part : b.parts_) sum.add(part);
  return sum;
}

ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) {
  ExactNumber sum = a;
  for (const double part : b.parts_) sum.add(-part);
  return sum;
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
  ExactNumber sum;
  for (const double x : a.parts_) {
    for (const double y : b.parts_) {
      const DoubleDouble product = exact_product(x, y);
      sum.add(product.low);
      sum.add(product.high);
    }
  }
  return sum;
}

ExactPoint::ExactPoint(std::array<ExactNumber, 3> coordinates) : exact(std::move(coordinates)) {
  plain = true;
  for (std::size_t k = 0; k < 3; ++k) {
    about[k] = exact[k].about().high;
    if (exact[k].plain()) continue;
    plain = false;
    error = std::max(error, 2 * unit_roundoff * std::fabs(about[k]));
  }
  plain = plain && may_be_signed(about);
}

ExactPoint::ExactPoint(const Point3& p)
    : ExactPoint(std::array{ExactNumber(p.x), ExactNumber(p.y), ExactNumber(p.z)}) {}

ExactNumber determinant(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  std::array<std::array<ExactNumber, 3>, 3> m;
  for (std::size_t k = 0; k < 3; ++k) {
    m[0][k] = b.exact[k] - a.exact[k];
    m[1][k] = c.exact[k] - a.exact[k];
    m[2][k] = d.exact[k] - a.exact[k];
  }
  ExactNumber sum;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sum = sum + m[0][i] * (m[1][j] * m[2][k] - m[1][k] * m[2][j]);
  }
  return sum;
}

ExactNumber determinant(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, Projection to) {
  const auto [i, j] = to;
  return (b.exact[i] - a.exact[i]) * (c.exact[j] - a.exact[j]) -
         (b.exact[j] - a.exact[j]) * (c.exact[i] - a.exact[i]);
}

// A difference of rounded points is off by d = 2 e and a rounding; a product of n of them, each at most m, by n d m^(n - 1) and
// some roundings of m^n; there are six of three, and two of two.
int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, const ExactPoint& d) {
  if (a.plain && b.plain && c.plain && d.plain) return orientation(a.about, b.about, c.about, d.about);
  const Vector3 x = b.about - a.about, y = c.about - a.about, z = d.about - a.about;
  const double error = std::max({a.error, b.error, c.error, d.error}),
               largest = max_abs(x) + max_abs(y) + max_abs(z) + 4 * error;
  const double found = dot(x, cross(y, z)),
               doubt = 64 * (error + unit_roundoff * largest) * largest * largest + 0x1p-1000;
  if (found > doubt) return 1;
  if (found < -doubt) return -1;
  return determinant(a, b, c, d).sign();
}

int orientation(const ExactPoint& a, const ExactPoint& b, const ExactPoint& c, Projection to) {
  if (a.plain && b.plain && c.plain) return orientation(a.about, b.about, c.about, to);
  const Vector3 x = b.about - a.about, y = c.about - a.about;
  const auto [i, j] = to;
  const double error = std::max({a.error, b.error, c.error}), largest = max_abs(x) + max_abs(y) + 4 * error;
  const double found = x[i] * y[j] - x[j] * y[i],
               doubt = 32 * (error + unit_roundoff * largest) * largest + 0x1p-1000;
  if (found > doubt) return 1;
  if (found < -doubt) return -1;
  return determinant(a, b, c, to).sign();
}

}  // namespace snug
