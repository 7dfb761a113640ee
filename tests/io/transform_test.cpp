#include <snug/io/transform.h>

#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace snug::transform_test {
namespace {

/// As USD's documentation has it: matrices of row vectors, by rows, in long double.
using Number = long double;
using Rows = std::array<std::array<Number, 4>, 4>;

Rows identity() { return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}; }

Rows product(const Rows& a, const Rows& b) {
  Rows c{};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 4; ++k) c[i][j] += a[i][k] * b[k][j];
    }
  }
  return c;
}

Rows inverse(Rows a) {
  Rows b = identity();
  for (int column = 0; column < 4; ++column) {
    int pivot = column;
    for (int row = column; row < 4; ++row) {
      if (std::fabs(a[row][column]) > std::fabs(a[pivot][column])) pivot = row;
    }
    std::swap(a[pivot], a[column]);
    std::swap(b[pivot], b[column]);
    const Number head = a[column][column];
    for (int k = 0; k < 4; ++k) a[column][k] /= head, b[column][k] /= head;
    for (int row = 0; row < 4; ++row) {
      if (row == column) continue;
      const Number factor = a[row][column];
      for (int k = 0; k < 4; ++k) a[row][k] -= factor * a[column][k], b[row][k] -= factor * b[column][k];
    }
  }
  return b;
}

Number largest(const Rows& a) {
  Number size = 0;
  for (const auto& row : a) {
    for (const Number x : row) size = std::fmax(size, std::fabs(x));
  }
  return size;
}

/// About an axis through the origin, by Rodrigues' formula.
Rows turn(const std::array<Number, 3>& axis, Number degrees) {
  const Number angle = degrees * 3.141592653589793238462643383279502884L / 180, c = std::cos(angle),
               s = std::sin(angle);
  Rows m = identity();
  for (int i = 0; i < 3; ++i) {  // row i: where the unit vector i goes
    for (int j = 0; j < 3; ++j) {
      const Number cross = i == j ? 0 : ((j - i + 3) % 3 == 1 ? axis[3 - i - j] : -axis[3 - i - j]);
      m[i][j] = (i == j ? c : 0) + (1 - c) * axis[i] * axis[j] + s * cross;
    }
  }
  return m;
}

std::array<Number, 3> unit(int axis) {
  std::array<Number, 3> u{};
  u[axis] = 1;
  return u;
}

struct Case {
  std::string name;
  std::vector<double> numbers;
  Rows rows;
};

class Cases {
 public:
  double number() {
    constexpr std::array ends{0.0, 1.0, -1.0, 90.0, -180.0, 360.0, 45.0, 0.1, 1e-9, 30.0};
    if (random_() % 3 == 0) return ends[random_() % ends.size()];
    return std::uniform_real_distribution<double>(-400, 400)(random_);
  }

  Case draw() {
    static const std::vector<std::string> kinds{
        "translate", "scale",     "rotateX",   "rotateY", "rotateZ",   "rotateXYZ",  "rotateXZY", "rotateYXZ",
        "rotateYZX", "rotateZXY", "rotateZYX", "orient",  "transform", "translateY", "scaleZ"};
    const std::string kind = kinds[random_() % kinds.size()];
    Case c{kind, {}, identity()};
    const auto take = [&](std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) c.numbers.push_back(number());
    };
    if (kind == "translate" || kind == "translateY") {
      take(kind.size() == 9 ? 3 : 1);
      for (int k = 0; k < 3; ++k)
        c.rows[3][k] = c.numbers.size() == 3 ? c.numbers[k] : k == 1 ? c.numbers[0] : 0;
    } else if (kind == "scale" || kind == "scaleZ") {
      take(kind.size() == 5 ? 3 : 1);
      for (double& x : c.numbers) x = x == 0 ? 0.5 : x;
      for (int k = 0; k < 3; ++k)
        c.rows[k][k] = c.numbers.size() == 3 ? c.numbers[k] : k == 2 ? c.numbers[0] : 1;
    } else if (kind == "orient") {
      double norm_sq = 0;
      while (norm_sq < 0.01) {
        c.numbers.clear();
        take(4);
        norm_sq = 0;
        for (const double x : c.numbers) norm_sq += x * x;
      }
      for (double& x : c.numbers) x /= std::sqrt(norm_sq);
      Number imaginary = std::hypot(Number{c.numbers[1]}, Number{c.numbers[2]}, Number{c.numbers[3]});
      if (imaginary > 0) {
        const Number degrees =
            2 * std::atan2(imaginary, Number{c.numbers[0]}) * 180 / 3.141592653589793238462643383279502884L;
        c.rows =
            turn({c.numbers[1] / imaginary, c.numbers[2] / imaginary, c.numbers[3] / imaginary}, degrees);
      }
    } else if (kind == "transform") {
      for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
          const double x = j == 3 ? (i == 3 ? 1 : 0) : number() + (i == j ? 900 : 0);
          c.numbers.push_back(x);
          c.rows[i][j] = x;
        }
      }
    } else if (kind.size() == 7) {
      take(1);
      c.rows = turn(unit(kind[6] - 'X'), c.numbers[0]);
    } else {
      take(3);
      for (int k = 6; k < 9; ++k)
        c.rows = product(c.rows, turn(unit(kind[k] - 'X'), c.numbers[kind[k] - 'X']));
    }
    return c;
  }

 private:
  std::mt19937_64 random_{5};
};

/// Slack: the errors of long double in numbers of this size.
void expect_holds(const Interval& range, Number exact, Number size, const std::string& what) {
  const Number slack = 1e-17L * size;
  EXPECT_LE(range.lower, exact + slack) << what;
  EXPECT_GE(range.upper, exact - slack) << what;
  EXPECT_LE(range.upper - range.lower, 1e-13L * size) << what;
}

TEST(transform, operations_enclose_those_of_the_documentation_alone_inverted_and_in_pairs) {
  Cases cases;
  for (int trial = 0; trial < 4000; ++trial) {
    const Case outer = cases.draw(), inner = cases.draw();
    const bool invert_outer = trial % 2, invert_inner = trial / 2 % 2;
    const TransformOperation a = transform_operation(outer.name, outer.numbers, invert_outer),
                             b = transform_operation(inner.name, inner.numbers, invert_inner);
    ASSERT_EQ(a.fault, "") << outer.name;
    ASSERT_EQ(b.fault, "") << inner.name;
    const Point3 point{cases.number(), cases.number(), cases.number()};
    const std::string what = outer.name + " after " + inner.name;
    // A point is a row to the left of its matrices: the first to act stands first.
    const Rows first = invert_inner ? inverse(inner.rows) : inner.rows,
               second = invert_outer ? inverse(outer.rows) : outer.rows, rows = product(first, second);
    const Number size = 500 * (1 + largest(inner.rows)) * (1 + largest(outer.rows)) * (1 + largest(first)) *
                        (1 + largest(second));
    const std::array<Interval, 3> image = a.map.after(b.map)(point);
    for (int j = 0; j < 3; ++j) {
      const Number exact = point.x * rows[0][j] + point.y * rows[1][j] + point.z * rows[2][j] + rows[3][j];
      expect_holds(image[j], exact, size, what);
    }
  }
}

TEST(transform, quarter_turns_and_mirrors_are_exact) {
  const std::array<double, 3> angles{90, -270, 180};
  const AffineEnclosure map = transform_operation("rotateXYZ", angles, false).map;
  const std::array<Interval, 3> image = map({0.1, 0.2, 0.3});
  for (const Interval& x : image) EXPECT_EQ(x.lower, x.upper);
  EXPECT_EQ(map.handedness(), 1);
  EXPECT_EQ(transform_operation("scale", std::array{1e-200, -1e-200, 1e-200}, false).map.handedness(), -1);
  EXPECT_EQ(transform_operation("scale", std::array{1e200, 1e200, 1e200}, false).map.handedness(), 1);
  EXPECT_EQ(transform_operation("scale", std::array{0.0, 1.0, 1.0}, false).map.handedness(), 0);
}

TEST(transform, says_what_is_wrong) {
  const auto fault = [](const char* name, const std::vector<double>& numbers, bool inverse = false) {
    return transform_operation(name, numbers, inverse).fault;
  };
  EXPECT_EQ(fault("translate", {1, 2}), "has 2 numbers, not three");
  EXPECT_EQ(fault("rotateX", {1, 2}), "has 2 numbers, not one");
  EXPECT_EQ(fault("orient", {1, 2, 3}), "has 3 numbers, not the four of a quaternion");
  EXPECT_EQ(fault("orient", {1, 1, 0, 0}),
            "is a quaternion of another length than 1: write w, x, y, z of a rotation");
  EXPECT_EQ(fault("orient", {0, 0, 0, 0}),
            "is a quaternion of another length than 1: write w, x, y, z of a rotation");
  EXPECT_EQ(fault("transform", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
            "is a perspective map: write one whose numbers beside the images are 0 0 0 1");
  EXPECT_EQ(fault("transform", {1, 2, 3, 0, 2, 4, 6, 0, 0, 0, 1, 0, 0, 0, 0, 1}, true),
            "cannot be inverted: its matrix is singular, or nearly so");
  EXPECT_EQ(fault("transform", {1e308, 1e308, 0, 0, 1e308, -1e308, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, true),
            "cannot be inverted: its matrix is singular, or nearly so");
  EXPECT_EQ(fault("scale", {0, 1, 1}, true), "cannot be inverted: a factor is 0");
  EXPECT_EQ(fault("scale", {1e-320, 1, 1}, true), "is beyond the range of doubles");
  EXPECT_EQ(fault("rotateXXY", {0, 1, 1}), "is an operation that snug does not know");
  EXPECT_EQ(fault("translateW", {0}), "is an operation that snug does not know");
  EXPECT_EQ(fault("", {}), "is an operation that snug does not know");
}

}  // namespace
}  // namespace snug::transform_test
