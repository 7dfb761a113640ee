#include <snug/geometry/exact_sign.h>

#include <array>

#include <snug/geometry/double_double.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// A sum of doubles without rounding, kept as parts that do not overlap, the smallest first.
class ExactSum {
 public:
  // Requires: at most 192 of them.
  void add(double x) {
    if (x == 0) return;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const auto [sum, rest] = exact_sum(x, parts_[i]);
      x = sum;
      if (rest != 0) parts_[kept++] = rest;
    }
    if (x != 0) parts_[kept++] = x;
    count_ = kept;
  }
  void add_product(DoubleDouble x, double y) {
    for (const double part : {x.low, x.high}) {
      const auto [high, low] = exact_product(part, y);
      add(low);
      add(high);
    }
  }
  [[nodiscard]] int sign() const { return count_ == 0 ? 0 : parts_[count_ - 1] > 0 ? 1 : -1; }

 private:
  std::array<double, 200> parts_;
  std::size_t count_ = 0;
};

// Calls use(x) for the parts of a difference that are not 0.
template <class Use>
void for_parts(const DoubleDouble& difference, const Use& use) {
  use(difference.high);
  if (difference.low != 0) use(difference.low);
}

using ExactRow = std::array<DoubleDouble, 3>;
ExactRow exact_row(const Point3& from, const Point3& to) {
  return {exact_sum(to.x, -from.x), exact_sum(to.y, -from.y), exact_sum(to.z, -from.z)};
}

int exact_orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  // Neighbours in a mesh have a corner in common.
  if (d == a || d == b || d == c) return 0;
  const ExactRow x = exact_row(a, b), y = exact_row(a, c), z = exact_row(a, d);
  ExactSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const bool odd : {false, true}) {
      const std::size_t j = (i + (odd ? 2 : 1)) % 3, k = 3 - i - j;
      for_parts(x[i], [&](double p) {
        for_parts(y[j], [&](double q) {
          const DoubleDouble product = exact_product(odd ? -p : p, q);
          for_parts(z[k], [&](double r) { sum.add_product(product, r); });
        });
      });
    }
  }
  return sum.sign();
}

int exact_orientation(const Point3& a, const Point3& b, const Point3& c, Projection to) {
  ExactSum sum;
  const auto add = [&](std::size_t i, std::size_t j, double sign) {
    for_parts(exact_sum(b[i], -a[i]), [&](double p) {
      for_parts(exact_sum(c[j], -a[j]), [&](double q) { sum.add_product({sign * p, 0}, q); });
    });
  };
  add(to.first, to.second, 1);
  add(to.second, to.first, -1);
  return sum.sign();
}

}  // namespace

// In doubles differences have one rounding, products of three two more, sums three: 9 roundings of the sum of all
// sizes of products at most, which itself has as few.
int orientation(const Point3& a, const Point3& b, const Point3& c, const Point3& d) {
  const Vector3 x = b - a, y = c - a, z = d - a;
  const double p0 = y.y * z.z, q0 = y.z * z.y, p1 = y.z * z.x, q1 = y.x * z.z, p2 = y.x * z.y, q2 = y.y * z.x;
  const double determinant = x.x * (p0 - q0) + x.y * (p1 - q1) + x.z * (p2 - q2);
  const double sizes = std::fabs(x.x) * (std::fabs(p0) + std::fabs(q0)) +
                       std::fabs(x.y) * (std::fabs(p1) + std::fabs(q1)) +
                       std::fabs(x.z) * (std::fabs(p2) + std::fabs(q2));
  const double doubt = 16 * unit_roundoff * sizes + 0x1p-1000;
  if (determinant > doubt) return 1;
  if (determinant < -doubt) return -1;
  return exact_orientation(a, b, c, d);
}

int orientation(const Point3& a, const Point3& b, const Point3& c, Projection to) {
  const auto [i, j] = to;
  const double p = (b[i] - a[i]) * (c[j] - a[j]), q = (b[j] - a[j]) * (c[i] - a[i]);
  const double doubt = 8 * unit_roundoff * (std::fabs(p) + std::fabs(q)) + 0x1p-1000;
  if (p - q > doubt) return 1;
  if (p - q < -doubt) return -1;
  return exact_orientation(a, b, c, to);
}

}  // namespace snug
