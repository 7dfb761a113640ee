#include <snug/bounds/parameter_triangle.h>

#include <support/contract.h>

namespace snug {
namespace {

using Weights = std::array<double, 3>;

Weights middle_of(const Weights& a, const Weights& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

}  // namespace

ParameterTriangle child_of(const ParameterTriangle& t, std::size_t child) {
  if (child == 3) return {middle_of(t[1], t[2]), middle_of(t[2], t[0]), middle_of(t[0], t[1])};
  return {middle_of(t[child], t[0]), middle_of(t[child], t[1]), middle_of(t[child], t[2])};
}

ParameterTriangle turned(const ParameterTriangle& t, std::size_t first) {
  return {t[first], t[(first + 1) % 3], t[(first + 2) % 3]};
}

ParameterTriangle part_of(const ParameterTriangle& t, std::size_t part) {
  const Weights middle = middle_of(t[0], t[2]);
  return part == 0 ? ParameterTriangle{t[0], t[1], middle} : ParameterTriangle{middle, t[1], t[2]};
}

// Bezier point (a_0, a_1, a_2) of degree m is the mean of the values of the polar form at the pairs of
// corners among its m: C(a_k, 2) times corner k twice, a_k a_l times corners k and l.
QuadraticWeights raised_quadratic(const ParameterTriangle& piece, std::size_t degree, std::size_t i,
                                  std::size_t j) {
  SNUG_EXPECT(degree >= 2 && i + j <= degree);
  const std::array<std::size_t, 3> times{degree - i - j, i, j};
  QuadraticWeights weights{};
  const auto add = [&](std::size_t pairs, const Weights& s, const Weights& t) {
    if (pairs == 0) return;
    const auto share = static_cast<double>(pairs);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      weights[k] += share * (s[k] * t[k]);
      weights[3 + k] += share * (s[k] * t[next] + s[next] * t[k]);
    }
  };
  for (std::size_t k = 0; k < 3; ++k) {
    add(times[k] * (times[k] - 1) / 2 * (times[k] > 0), piece[k], piece[k]);
    add(times[k] * times[(k + 1) % 3], piece[k], piece[(k + 1) % 3]);
  }
  const auto pairs = static_cast<double>(degree * (degree - 1) / 2);
  for (double& weight : weights) weight /= pairs;
  return weights;
}

}  // namespace snug
