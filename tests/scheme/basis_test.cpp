#include <snug/scheme/basis.h>

#include <gtest/gtest.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/rules.h>

#include <cmath>
#include <random>
#include <vector>

namespace snug::basis_test {
namespace {

// The functions of a regular patch by its Bezier rows, in 64 bits.
class BezierTwin {
 public:
  explicit BezierTwin(const SchemeRules& rules)
      : rules_(rules),
        fans_(4, CornerFan{0, static_cast<std::uint16_t>(rules.regular_valence - 1), true, false, false}),
        ring_(rules.ring({fans_.data(), rules.corners})),
        form_(rules.bezier(ring_, {fans_.data(), rules.corners})) {}

  // Values and derivatives along the triangle's u and v, by control points.
  [[nodiscard]] std::array<std::vector<long double>, 3> operator()(long double u, long double v) const {
    std::array<std::vector<long double>, 3> sums;
    for (auto& sum : sums) sum.assign(ring_.vertex_count(), 0);
    const long double w = 1 - u - v;
    // A triangle in two parts, as Midedge's: the derivatives of (u, 2 v) or (u, v - w).
    const bool second = form_.parts == 2 && v > w;
    std::array<long double, 3> at{w, u, v};
    if (form_.parts == 2) at = second ? std::array{2 * w, u, v - w} : std::array{w - v, u, 2 * v};
    const std::size_t d = form_.degree, count = bezier_count(d);
    for (std::size_t j = 0; j <= d; ++j) {
      for (std::size_t i = 0; i + j <= d; ++i) {
        const std::size_t place = bezier_index(d, i, j), k = d - i - j;
        const long double factor = multinomial(d, place);
        const auto power = [](long double x, std::size_t n) { return std::pow(x, static_cast<int>(n)); };
        const auto monomial = [&](std::size_t a, std::size_t b, std::size_t c) {
          return factor * power(at[0], a) * power(at[1], b) * power(at[2], c);
        };
        const auto lower = [](std::size_t n) { return n > 0 ? n - 1 : 0; };
        const long double by_w = static_cast<long double>(k) * monomial(lower(k), i, j),
                          by_u = static_cast<long double>(i) * monomial(k, lower(i), j),
                          by_v = static_cast<long double>(j) * monomial(k, i, lower(j));
        std::array<long double, 3> value{monomial(k, i, j), by_u - by_w, by_v - by_w};
        if (form_.parts == 2) {
          value[1] = second ? -2 * by_w + by_u + by_v : by_u - by_w;
          value[2] = second ? 2 * (by_v - by_w) : 2 * (by_v - by_w);
        }
        const Stencils::Row row = form_.rows.row((second ? count : 0) + place);
        for (std::size_t s = 0; s < row.sources.size(); ++s) {
          for (std::size_t x = 0; x < 3; ++x) sums[x][row.sources[s]] += row.weights[s] * value[x];
        }
      }
    }
    return sums;
  }
  [[nodiscard]] std::vector<std::size_t> lattice() const {
    std::vector<std::size_t> places;
    for (const Combination& c : rules_.lattice(ring_, {fans_.data(), rules_.corners})) {
      places.push_back(static_cast<std::size_t>(std::find(c.begin(), c.end(), 1) - c.begin()));
    }
    return places;
  }

 private:
  const SchemeRules& rules_;
  std::vector<CornerFan> fans_;
  Topology ring_;
  BezierRows form_;
};

template <std::size_t degree>
void tensor(double u, double v, BasisFunctions& out) {
  const Splines<degree> x = splines<degree>(u), y = splines<degree>(v);
  for (std::size_t i = 0; i <= degree; ++i) {
    for (std::size_t j = 0; j <= degree; ++j) {
      const std::size_t place = i + (degree + 1) * j;
      out.value[place] = x.value[i] * y.value[j];
      out.along_u[place] = x.slope[i] * y.value[j];
      out.along_v[place] = x.value[i] * y.slope[j];
    }
  }
}

BasisFunctions functions(RegularBasis basis, double u, double v) {
  BasisFunctions out{};
  const double w = 1 - u - v;
  switch (basis) {
    case RegularBasis::linear:
      basis_functions<RegularBasis::linear, true>(w, u, v, out);
      break;
    case RegularBasis::box_spline:
      basis_functions<RegularBasis::box_spline, true>(w, u, v, out);
      break;
    case RegularBasis::zwart_powell:
      basis_functions<RegularBasis::zwart_powell, true>(w, u, v, out);
      break;
    case RegularBasis::bilinear:
      tensor<1>(u, v, out);
      break;
    case RegularBasis::biquadratic:
      tensor<2>(u, v, out);
      break;
    case RegularBasis::bicubic:
      tensor<3>(u, v, out);
      break;
  }
  return out;
}

// Inside, on edges, at corners, and near them.
double random_coordinate(std::mt19937_64& random) {
  const double x = static_cast<double>(random() >> 11) * 0x1p-53;
  switch (random() % 8) {
    case 0:
      return 0;
    case 1:
      return 1;
    case 2:
      return 0.5;
    case 3:
      return std::ldexp(x, -static_cast<int>(random() % 60));
    case 4:
      return 1 - std::ldexp(x, -static_cast<int>(random() % 60));
    default:
      return x;
  }
}

// In sum over the functions, at parameters whose rounding the bounds count apart.
TEST(basis, functions_are_those_of_the_bezier_rows_within_the_stated_roundings) {
  std::mt19937_64 random(31);
  double worst_value = 0, worst_slope = 0;
  for (const SchemeRules* rules : all_rules()) {
    const BezierTwin twin(*rules);
    const std::vector<std::size_t> lattice = twin.lattice();
    ASSERT_EQ(lattice.size(), basis_count(rules->basis)) << rules->name;
    for (int trial = 0; trial < 20'000; ++trial) {
      double u = random_coordinate(random), v = random_coordinate(random);
      if (rules->triangular() ? u + v > 1 : v > u) std::swap(u, v);
      if (rules->triangular() && u + v > 1) u = 1 - u, v = 1 - v;
      if (rules->triangular() && u + v > 1) continue;
      // Of the half (0,0), (1,0), (1,1) of a quad.
      const bool quad = !rules->triangular();
      const auto exact = twin(quad ? static_cast<long double>(u) - v : u, v);
      const BasisFunctions found = functions(rules->basis, u, v);
      std::array<long double, 3> off{}, sum{};
      for (std::size_t i = 0; i < lattice.size(); ++i) {
        const std::size_t c = lattice[i];
        const long double slope_v = quad ? exact[2][c] - exact[1][c] : exact[2][c];
        off[0] += std::fabs(found.value[i] - exact[0][c]);
        off[1] += std::fabs(found.along_u[i] - exact[1][c]);
        off[2] += std::fabs(found.along_v[i] - slope_v);
        sum[0] += std::fabs(found.value[i]);
        sum[1] += std::fabs(found.along_u[i]);
        sum[2] += std::fabs(found.along_v[i]);
      }
      // The rounding of w, or of the coordinates in a triangle of Midedge: two units.
      const double units = unit_roundoff * (1 + 0x1p-20);
      ASSERT_LE(off[0], (BasisBounds::value_roundings + 2 * BasisBounds::value_change) * units)
          << rules->name;
      for (const std::size_t x : {1u, 2u}) {
        ASSERT_LE(off[x], (BasisBounds::derivative_roundings + 2 * BasisBounds::derivative_change) * units)
            << rules->name << " at " << u << ", " << v;
        ASSERT_LE(sum[x], BasisBounds::derivative_sum * (1 + 0x1p-40)) << rules->name;
        worst_slope = std::max(worst_slope, static_cast<double>(off[x]) / unit_roundoff);
      }
      ASSERT_LE(sum[0], 1 + 0x1p-40) << rules->name;
      worst_value = std::max(worst_value, static_cast<double>(off[0]) / unit_roundoff);
    }
  }
  std::printf("off by at most %.1f units, derivatives by %.1f\n", worst_value, worst_slope);
  EXPECT_GT(worst_value, 1);  // the twin can tell
}

}  // namespace
}  // namespace snug::basis_test
