#include <snug/mesh/split_polygon.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numeric>

namespace snug {
namespace {

/// The sign of a sum of products, exactly: a list of doubles, none overlapping another, in rising order.
class ExactSum {
 public:
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  [[nodiscard]] int sign() const {
    for (std::size_t i = count_; i-- > 0;) {
      if (terms_[i] != 0) return terms_[i] > 0 ? 1 : -1;
    }
    return 0;
  }

 private:
  void add(double x) {
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = x + terms_[i];
      const double part = sum - x;
      terms_[i] = (x - (sum - part)) + (terms_[i] - part);
      x = sum;
    }
    terms_[count_++] = x;
  }

  std::array<double, 12> terms_{};
  std::size_t count_ = 0;
};

/// Is p in the closed triangle, but at none of its corners?
bool blocks(const PlanePoint& p, const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  if (p == a || p == b || p == c) return false;
  return side_of(a, b, p) >= 0 && side_of(b, c, p) >= 0 && side_of(c, a, p) >= 0;
}

}  // namespace

int side_of(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c) {
  const double left = (b[0] - a[0]) * (c[1] - a[1]), right = (b[1] - a[1]) * (c[0] - a[0]);
  const double area = left - right;
  // Differences and products have one rounding each.
  const double error = 0x1p-51 * (std::fabs(left) + std::fabs(right)) + DBL_MIN;
  if (std::fabs(area) > error) return area > 0 ? 1 : -1;
  ExactSum sum;
  sum.add_product(a[0], b[1]);
  sum.add_product(-a[1], b[0]);
  sum.add_product(b[0], c[1]);
  sum.add_product(-b[1], c[0]);
  sum.add_product(c[0], a[1]);
  sum.add_product(-c[1], a[0]);
  return sum.sign();
}

std::vector<PlanePoint> dropped_along(const Vector3& normal, std::span<const Point3> points) {
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k) {
    if (std::fabs(normal[k]) > std::fabs(normal[axis])) axis = k;
  }
  std::size_t first = (axis + 1) % 3, second = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(first, second);
  std::vector<PlanePoint> result;
  result.reserve(points.size());
  for (const Point3& p : points) result.push_back({p[first], p[second]});
  return result;
}

bool is_convex(std::span<const PlanePoint> polygon) {
  const std::size_t n = polygon.size();
  std::size_t reversals = 0;  // between edges that go up in the order of points and edges that go down
  int last = 0, first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const PlanePoint &a = polygon[i], &b = polygon[(i + 1) % n];
    if (side_of(a, b, polygon[(i + 2) % n]) < 0) return false;
    if (a == b) continue;
    const int direction = a < b ? 1 : -1;
    if (last != 0 && direction != last) ++reversals;
    if (first == 0) first = direction;
    last = direction;
  }
  if (first != last) ++reversals;
  return reversals == 2;
}

std::vector<std::array<std::uint32_t, 3>> triangles_of(std::span<const PlanePoint> polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0u);
  const auto is_ear = [&](std::size_t i) {
    const std::size_t n = left.size();
    const PlanePoint &a = polygon[left[(i + n - 1) % n]], &b = polygon[left[i]],
                     &c = polygon[left[(i + 1) % n]];
    if (side_of(a, b, c) <= 0) return false;
    return std::none_of(left.begin(), left.end(),
                        [&](std::uint32_t v) { return blocks(polygon[v], a, b, c); });
  };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t at = 0, passed = 0;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    at %= n;
    if (passed == n) return {};
    if (!is_ear(at)) {
      ++at;
      ++passed;
      continue;
    }
    triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    ++at;  // not the neighbour: fans of needles are avoided
    passed = 0;
  }
  return triangles;
}

}  // namespace snug
