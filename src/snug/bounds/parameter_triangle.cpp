#include <snug/bounds/parameter_triangle.h>

#include <support/contract.h>

namespace snug {
namespace {

using Weights = std::array<double, 3>;

Weights middle_of(const Weights& a, const Weights& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

// Adds a share of the polar form at two parameters.
void add_polar(double share, const Weights& s, const Weights& t, QuadraticWeights& sum) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    sum[k] += share * (s[k] * t[k]);
    sum[3 + k] += share * (s[k] * t[next] + s[next] * t[k]);
  }
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

RaisedQuadratic::RaisedQuadratic(const ParameterTriangle& piece, std::size_t degree)
    : degree_(degree), polar_{} {
  SNUG_EXPECT(degree >= 2);
  for (std::size_t k = 0; k < 3; ++k) {
    add_polar(1, piece[k], piece[k], polar_[2 * k]);
    add_polar(1, piece[k], piece[(k + 1) % 3], polar_[2 * k + 1]);
  }
}

// Bezier point (a_0, a_1, a_2) of degree m is the mean of the values of the polar form at the pairs of
// corners among its m: C(a_k, 2) times corner k twice, a_k a_l times corners k and l.
QuadraticWeights RaisedQuadratic::point(std::size_t i, std::size_t j) const {
  SNUG_EXPECT(i + j <= degree_);
  const std::array<std::size_t, 3> times{degree_ - i - j, i, j};
  QuadraticWeights weights{};
  const auto add = [&](std::size_t pairs, const QuadraticWeights& polar) {
    if (pairs == 0) return;
    for (std::size_t l = 0; l < 6; ++l) weights[l] += static_cast<double>(pairs) * polar[l];
  };
  for (std::size_t k = 0; k < 3; ++k) {
    add(times[k] * (times[k] - (times[k] > 0)) / 2, polar_[2 * k]);
    add(times[k] * times[(k + 1) % 3], polar_[2 * k + 1]);
  }
  const auto pairs = static_cast<double>(degree_ * (degree_ - 1) / 2);
  for (double& weight : weights) weight /= pairs;
  return weights;
}

// The mean of the polar form over all pairs of different arguments in one direction, and such pairs in the other.
QuadraticWeights raised_quadratic(const ParameterTriangle& corners, std::size_t i, std::size_t j) {
  SNUG_EXPECT(i <= 3 && j <= 3);
  const Weights &origin = corners[0], &across = corners[1], &along = corners[2];
  const auto corner = [&](std::size_t a, std::size_t b) {
    Weights at = origin;
    for (std::size_t k = 0; k < 3; ++k) {
      if (a == 1) at[k] += across[k] - origin[k];
      if (b == 1) at[k] += along[k] - origin[k];
    }
    return at;
  };
  // Of three arguments, `ones` of which are 1: ordered pairs of different ones that are a and b.
  const auto pairs = [](std::size_t ones, std::size_t a, std::size_t b) {
    const std::size_t first = a == 1 ? ones : 3 - ones;
    return static_cast<double>(a == b ? first * (first - (first > 0)) : first * (3 - first));
  };
  QuadraticWeights weights{};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      const double count = pairs(i, a / 2, a % 2) * pairs(j, b / 2, b % 2);
      if (count > 0) add_polar(count, corner(a / 2, b / 2), corner(a % 2, b % 2), weights);
    }
  }
  for (double& weight : weights) weight /= 36;
  return weights;
}

}  // namespace snug
