#include <snug/shape/moment_kernel.h>

#include <gtest/gtest.h>
#include <testing/instruction_sets.h>

#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <random>
#include <utility>

namespace snug::moment_kernel_test {
namespace {

using kernels::moment_lanes;
using kernels::MomentParts;
using Point = std::array<long double, 3>;

// The point of one lane at a parameter, by De Casteljau's weights, and its derivatives by differences of weights.
struct Part {
  Domain domain;
  std::size_t degree;
  const MomentParts& parts;
  std::size_t lane;

  static long double power(long double x, std::size_t n) { return n == 0 ? 1 : x * power(x, n - 1); }
  static long double choose(std::size_t n, std::size_t k) {
    return k == 0 ? 1 : choose(n - 1, k - 1) * static_cast<long double>(n) / static_cast<long double>(k);
  }
  template <class Visit>
  void each(const Visit& visit) const {
    std::size_t k = 0;
    for (std::size_t j = 0; j <= degree; ++j) {
      for (std::size_t i = 0; i + (domain == Domain::triangle ? j : 0) <= degree; ++i) visit(i, j, k++);
    }
  }
  // The basis function (i, j), whatever its degree.
  [[nodiscard]] long double basis(std::size_t n, std::size_t m, std::size_t i, std::size_t j, long double u,
                                  long double v) const {
    if (domain == Domain::triangle) {
      if (i + j > n) return 0;
      return choose(n, j) * choose(n - j, i) * power(u, i) * power(v, j) * power(1 - u - v, n - i - j);
    }
    if (i > n || j > m) return 0;
    return choose(n, i) * choose(m, j) * power(u, i) * power(1 - u, n - i) * power(v, j) *
           power(1 - v, m - j);
  }
  // The point from the origin of moments, and both derivatives.
  [[nodiscard]] std::array<Point, 3> at(long double u, long double v) const {
    std::array<Point, 3> result{};
    const std::size_t n = degree;
    const bool triangle = domain == Domain::triangle;
    each([&](std::size_t i, std::size_t j, std::size_t k) {
      const auto lower = [&](std::size_t a, std::size_t b, bool by_u) {
        return triangle ? basis(n - 1, n - 1, a, b, u, v) : basis(n - by_u, n - !by_u, a, b, u, v);
      };
      const long double at_u = (i > 0 ? lower(i - 1, j, true) : 0) - lower(i, j, true);
      const long double at_v = (j > 0 ? lower(i, j - 1, false) : 0) - lower(i, j, false);
      const std::array<long double, 3> weights{basis(n, n, i, j, u, v), static_cast<long double>(n) * at_u,
                                               static_cast<long double>(n) * at_v};
      for (std::size_t d = 0; d < 3; ++d) {
        for (std::size_t a = 0; a < 3; ++a) result[d][a] += weights[d] * parts.points[a][k][lane];
      }
    });
    for (std::size_t a = 0; a < 3; ++a) result[0][a] += parts.origin[a][lane];
    return result;
  }
  [[nodiscard]] Point normal(long double u, long double v) const {
    const auto [x, by_u, by_v] = at(u, v);
    Point result;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3, m = (k + 2) % 3;
      result[k] = by_u[l] * by_v[m] - by_u[m] * by_v[l];
    }
    return result;
  }
  // The same by the coefficients that came out, which are scaled.
  [[nodiscard]] Point normal_of(const MomentParts& found, long double u, long double v) const {
    const bool triangle = domain == Domain::triangle;
    const std::size_t n = triangle ? 2 * degree - 2 : 2 * degree - 1;
    Point result{};
    std::size_t k = 0;
    for (std::size_t j = 0; j <= n; ++j) {
      for (std::size_t i = 0; i + (triangle ? j : 0) <= n; ++i, ++k) {
        const long double powers =
            triangle ? power(u, i) * power(v, j) * power(1 - u - v, n - i - j)
                     : power(u, i) * power(1 - u, n - i) * power(v, j) * power(1 - v, n - j);
        for (std::size_t a = 0; a < 3; ++a) result[a] += powers * found.normal[a][k][lane];
      }
    }
    return result;
  }
  // By a rule of so many points a direction that is exact for these polynomials.
  [[nodiscard]] std::array<long double, 10> moments() const {
    constexpr std::size_t n = 12;
    std::array<long double, n> nodes, weights;
    for (std::size_t k = 0; k < n; ++k) {
      long double x = std::cos(3.14159265358979323846L * (k + 0.75L) / (n + 0.5L)), slope = 1;
      for (int step = 0; step < 60; ++step) {
        long double p = 1, before = 0;
        for (std::size_t m = 1; m <= n; ++m) {
          const long double next = ((2 * m - 1) * x * p - (m - 1) * before) / m;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1);
        x -= p / slope;
      }
      nodes[k] = (1 + x) / 2;
      weights[k] = 1 / ((1 - x * x) * slope * slope);
    }
    std::array<long double, 10> sum{};
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) {
        const bool triangle = domain == Domain::triangle;
        const long double u = nodes[a], v = triangle ? (1 - u) * nodes[b] : nodes[b];
        const long double weight = weights[a] * weights[b] * (triangle ? 1 - u : 1);
        const Point x = at(u, v)[0], n_here = normal(u, v);
        long double q = 0;
        for (std::size_t k = 0; k < 3; ++k) q += x[k] * n_here[k];
        q *= weight;
        sum[0] += q;
        for (std::size_t k = 0; k < 3; ++k) {
          sum[1 + k] += x[k] * q;
          sum[4 + k] += x[k] * x[k] * q;
          sum[7 + k] += x[k] * x[(k + 1) % 3] * q;
        }
      }
    }
    return sum;
  }
};

TEST(moment_kernel, holds_the_integrals_of_every_degree_and_is_the_same_on_every_instruction_set) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const testing::EachInstructionSet sets;
  for (const Domain domain : {Domain::triangle, Domain::square}) {
    for (const std::size_t degree : domain == Domain::triangle ? std::array<std::size_t, 3>{1, 2, 4}
                                                               : std::array<std::size_t, 3>{1, 2, 3}) {
      for (std::size_t count = 1; count <= moment_lanes; ++count) {
        const auto given = std::make_unique<MomentParts>();
        const auto fill = [&](MomentParts::Lanes& lanes, double size) {
          for (double& x : lanes) x = size * unit();
        };
        for (auto& axis : given->points) {
          for (auto& lanes : axis) fill(lanes, count % 2 == 0 ? 1 : 1e-3);
        }
        for (auto& lanes : given->origin) fill(lanes, 2);
        // Points and origins that are off by as much as is said, or by nothing.
        const double size = count % 2 == 0 ? 1 : 1e-3, off_point = count % 3 == 0 ? 0 : 1e-7 * size,
                     off_origin = count % 4 == 0 ? 0 : 1e-7;
        std::fill(given->point_error, given->point_error + moment_lanes, off_point);
        std::fill(given->origin_error, given->origin_error + moment_lanes, off_origin);
        const auto meant = std::make_unique<MomentParts>(*given);
        const auto move = [&](MomentParts::Lanes& lanes, double by) {
          for (double& x : lanes) x += (random() % 2 == 0 ? 0.999 : -0.999) * by;
        };
        for (auto& axis : meant->points) {
          for (auto& lanes : axis) move(lanes, off_point);
        }
        for (auto& lanes : meant->origin) move(lanes, off_origin);
        std::optional<MomentParts> first;
        sets.run([&](const char* name) {
          MomentParts found = *given;
          kernels::integrate(domain, degree, count, found);
          if (!first) first = found;
          for (std::size_t lane = 0; lane < count; ++lane) {
            for (std::size_t m = 0; m < 10; ++m) {
              EXPECT_EQ(found.value[m][lane], first->value[m][lane]) << name;
              EXPECT_EQ(found.error[m][lane], first->error[m][lane]) << name;
            }
            EXPECT_EQ(found.normal_error[lane], first->normal_error[lane]) << name;
            EXPECT_EQ(found.largest_normal[lane], first->largest_normal[lane]) << name;
          }
        });
        for (std::size_t lane = 0; lane < count; ++lane) {
          const Part part{domain, degree, *meant, lane};
          const auto exact = part.moments();
          for (std::size_t m = 0; m < 10; ++m) {
            const double value = first->value[m][lane], error = first->error[m][lane];
            const auto off = static_cast<double>(std::fabs(static_cast<long double>(value) - exact[m]));
            EXPECT_LE(off, error + 1e-16 * std::fabs(value)) << degree << ' ' << m;
            EXPECT_LE(error, 1e-9 + 2e4 * (off_point + off_origin)) << degree << ' ' << m;
          }
          for (const auto& [u, v] : {std::pair{0.0L, 0.0L}, {0.2L, 0.3L}, {0.5L, 0.5L}, {0.1L, 0.85L}}) {
            const Point exact_normal = part.normal(u, v), normal = part.normal_of(*first, u, v);
            for (std::size_t a = 0; a < 3; ++a) {
              EXPECT_LE(std::fabs(normal[a] - exact_normal[a]), first->normal_error[lane]) << degree;
              EXPECT_LE(std::fabs(exact_normal[a]), first->largest_normal[lane]) << degree;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace snug::moment_kernel_test
