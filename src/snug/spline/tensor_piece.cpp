#include <snug/spline/tensor_piece.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr std::size_t most = TensorPiece::max_degree;

// Of polar form the shares of the second of two points: argument by argument, point by point.
using Shares = std::array<std::array<double, most>, most>;
Shares shares_of(std::size_t degree, const double* knots, std::span<const double> at) {
  Shares shares{};
  for (std::size_t r = 0; r < degree; ++r) {
    for (std::size_t i = 0; i + r < degree; ++i) {
      const double low = knots[i + r], high = knots[i + degree];
      shares[r][i] = (at[r] - low) / (high - low);
    }
  }
  return shares;
}

// One argument after the other. A step is a weighted mean of two points where the argument is between the knots: four
// roundings.
Vector3 polar(std::size_t degree, const Shares& shares, std::array<Vector3, most + 1> p) {
  for (std::size_t r = 0; r < degree; ++r) {
    for (std::size_t i = 0; i + r < degree; ++i) p[i] = (1 - shares[r][i]) * p[i] + shares[r][i] * p[i + 1];
  }
  return p[0];
}

// Of both directions in a piece.
constexpr std::size_t polar_roundings(std::size_t degree) { return 8 * degree; }

// Control points of a direction replaced by polar values.
template <class Arguments>
void change_direction(const TensorPiece& from, bool along_u, const Arguments& arguments, TensorPiece& to) {
  const std::size_t width = from.width(), step = along_u ? 1 : width, across = along_u ? width : 1;
  for (std::size_t i = 0; i < width; ++i) {
    const Shares shares = shares_of(from.degree, along_u ? from.u.data() : from.v.data(), arguments(i));
    for (std::size_t line = 0; line < width; ++line) {
      std::array<Vector3, most + 1> p;
      for (std::size_t k = 0; k < width; ++k) p[k] = from.points[line * across + k * step];
      to.points[line * across + i * step] = polar(from.degree, shares, p);
    }
  }
}

// Bezier points over a half: de Casteljau's means, each rounded once.
void halve(TensorPiece& bezier, bool along_u, bool second) {
  const std::size_t d = bezier.degree, width = d + 1, step = along_u ? 1 : width,
                    across = along_u ? width : 1;
  for (std::size_t line = 0; line < width; ++line) {
    std::array<Vector3, most + 1> p;
    for (std::size_t k = 0; k < width; ++k) p[k] = bezier.points[line * across + k * step];
    for (std::size_t r = 1; r <= d; ++r) {
      if (second) {
        for (std::size_t k = 0; k + r <= d; ++k) p[k] = 0.5 * (p[k] + p[k + 1]);
      } else {
        for (std::size_t k = d; k >= r; --k) p[k] = 0.5 * (p[k - 1] + p[k]);
      }
    }
    for (std::size_t k = 0; k < width; ++k) bezier.points[line * across + k * step] = p[k];
  }
}

// The part of Bezier points in a direction by halves of halves, at most four times: no more roundings than polar forms have. False
// for parts that are none.
bool take_halves(TensorPiece& bezier, bool along_u, double low, double high) {
  std::array<bool, 4> second{};
  std::size_t count = 0;
  for (; low != 0 || high != 1; ++count) {
    if (count == second.size() || (low < 0.5 && high > 0.5)) return false;
    second[count] = low >= 0.5;
    low = 2 * low - (second[count] ? 1 : 0);
    high = 2 * high - (second[count] ? 1 : 0);
  }
  for (std::size_t k = 0; k < count; ++k) halve(bezier, along_u, second[k]);
  return true;
}

// Those of a lattice.
std::array<double, 2 * most> uniform_knots(std::size_t degree) {
  std::array<double, 2 * most> knots{};
  for (std::size_t k = 0; k < 2 * degree; ++k)
    knots[k] = static_cast<double>(k) - static_cast<double>(degree - 1);
  return knots;
}

// Bezier points of a span of a uniform B-spline, in one direction.
void take_uniform(TensorPiece& piece, bool along_u) {
  const std::size_t d = piece.degree, width = d + 1, step = along_u ? 1 : width, across = along_u ? width : 1;
  for (std::size_t line = 0; line < width; ++line) {
    const auto at = [&](std::size_t k) -> Vector3& { return piece.points[line * across + k * step]; };
    if (d == 2) {
      at(0) = 0.5 * (at(0) + at(1));
      at(2) = 0.5 * (at(1) + at(2));
    } else if (d == 3) {
      constexpr double third = 1.0 / 3, sixth = 1.0 / 6;
      const Vector3 p = at(1), q = at(2);
      at(0) = sixth * (at(0) + (4.0 * p + q));
      at(1) = third * (2.0 * p + q);
      at(2) = third * (p + 2.0 * q);
      at(3) = sixth * (p + (4.0 * q + at(3)));
    }
  }
}

}  // namespace

void take_largest(TensorPiece& piece) {
  piece.largest = 0;
  for (std::size_t i = 0; i < piece.count(); ++i)
    piece.largest = std::max(piece.largest, max_abs(piece.points[i]));
}

TensorPiece bezier_piece(std::size_t degree) {
  TensorPiece piece;
  piece.degree = degree;
  std::fill_n(piece.u.begin() + static_cast<std::ptrdiff_t>(degree), degree, 1.0);
  std::fill_n(piece.v.begin() + static_cast<std::ptrdiff_t>(degree), degree, 1.0);
  return piece;
}

TensorPiece tensor_piece(const LatticeNet& net, std::size_t degree) {
  TensorPiece piece;
  piece.degree = degree;
  piece.u = piece.v = uniform_knots(degree);
  for (std::size_t i = 0; i < piece.count(); ++i) {
    const kernels::NetPoint& p = net.points[net.lattice[i]];
    piece.points[i] = {p[0], p[1], p[2]};
  }
  piece.largest = net.largest;
  piece.error = net.error;
  return piece;
}

Vector3 blossom(const TensorPiece& piece, std::span<const double> u, std::span<const double> v) {
  const Shares along_u = shares_of(piece.degree, piece.u.data(), u);
  std::array<Vector3, most + 1> lines;
  for (std::size_t j = 0; j < piece.width(); ++j) {
    std::array<Vector3, most + 1> line;
    for (std::size_t i = 0; i < piece.width(); ++i) line[i] = piece.at(i, j);
    lines[j] = polar(piece.degree, along_u, line);
  }
  return polar(piece.degree, shares_of(piece.degree, piece.v.data(), v), lines);
}

Vector3 value(const TensorPiece& piece, double u, double v) {
  std::array<double, most> all_u, all_v;
  all_u.fill(u);
  all_v.fill(v);
  return blossom(piece, {all_u.data(), piece.degree}, {all_v.data(), piece.degree});
}

CornerJet jet_at(const TensorPiece& piece, double u, double v) {
  const std::size_t d = piece.degree;
  std::array<double, most> all_u, all_v;
  all_u.fill(u);
  all_v.fill(v);
  const Shares su = shares_of(d, piece.u.data(), {all_u.data(), d}),
               sv = shares_of(d, piece.v.data(), {all_v.data(), d});
  // The last step is between the values at the ends of the span.
  const auto last = [d](const Shares& shares, const double* knots, std::array<Vector3, most + 1> p) {
    for (std::size_t r = 0; r + 1 < d; ++r) {
      for (std::size_t i = 0; i + r < d; ++i) p[i] = (1 - shares[r][i]) * p[i] + shares[r][i] * p[i + 1];
    }
    const double s = shares[d - 1][0], slope = static_cast<double>(d) / (knots[d] - knots[d - 1]);
    return std::pair((1 - s) * p[0] + s * p[1], slope * (p[1] - p[0]));
  };
  std::array<Vector3, most + 1> values, slopes;
  for (std::size_t j = 0; j <= d; ++j) {
    std::array<Vector3, most + 1> line;
    for (std::size_t i = 0; i <= d; ++i) line[i] = piece.at(i, j);
    std::tie(values[j], slopes[j]) = last(su, piece.u.data(), line);
  }
  const auto [point, along_v] = last(sv, piece.v.data(), values);
  const auto [along_u, twist] = last(sv, piece.v.data(), slopes);
  return {point, along_u, along_v, twist};
}

CornerJet corner_jet(const TensorPiece& bezier, std::size_t x, std::size_t y) {
  const std::size_t d = bezier.degree, i = x * d, j = y * d, a = x == 0 ? 1 : d - 1, b = y == 0 ? 1 : d - 1;
  const double n = static_cast<double>(d), su = x == 0 ? n : -n, sv = y == 0 ? n : -n;
  const Vector3 p = bezier.at(i, j), pu = bezier.at(a, j) - p, pv = bezier.at(i, b) - p;
  return {p, su * pu, sv * pv, (su * sv) * (bezier.at(a, b) - bezier.at(i, b) - pu)};
}

TensorPiece bezier_on(const TensorPiece& piece, const ParameterBox& box) {
  const std::size_t d = piece.degree;
  TensorPiece half = bezier_piece(d), result = half;
  if (piece.u == half.u && piece.v == half.v && box == ParameterBox{}) return piece;
  std::array<double, most> at{};
  const auto between = [&](double low, double high) {
    return [&, low, high](std::size_t i) {
      for (std::size_t k = 0; k < d; ++k) at[k] = k < d - i ? low : high;
      return std::span<const double>(at.data(), d);
    };
  };
  result.points = piece.points;
  const bool whole = box == ParameterBox{};
  for (const bool along_u : {true, false}) {
    const std::array<double, 2 * most>& knots = along_u ? piece.u : piece.v;
    const double low = along_u ? box.u0 : box.v0, high = along_u ? box.u1 : box.v1;
    if (whole && knots == uniform_knots(d)) {
      take_uniform(result, along_u);
    } else if (knots != half.u || !take_halves(result, along_u, low, high)) {
      TensorPiece from = result;
      (along_u ? from.u : from.v) = knots;
      change_direction(from, along_u, between(low, high), result);
    }
  }
  take_largest(result);
  result.error =
      enlarged(piece.error + gamma_bound(polar_roundings(d)) * piece.largest) + 64 * underflow_error;
  return result;
}

TensorPiece raised(const TensorPiece& bezier) {
  TensorPiece from = bezier;
  while (from.degree < most) {
    const std::size_t d = from.degree;
    TensorPiece half, result = bezier_piece(d + 1);
    half.degree = d + 1;
    const auto mean = [d](std::size_t i, const Vector3& before, const Vector3& here) {
      const double share = static_cast<double>(i) / static_cast<double>(d + 1);
      return share * before + (1 - share) * here;
    };
    for (std::size_t j = 0; j <= d; ++j) {
      for (std::size_t i = 0; i <= d + 1; ++i)
        half.at(i, j) = mean(i, from.at(i == 0 ? 0 : i - 1, j), from.at(std::min(i, d), j));
    }
    for (std::size_t j = 0; j <= d + 1; ++j) {
      for (std::size_t i = 0; i <= d + 1; ++i)
        result.at(i, j) = mean(j, half.at(i, j == 0 ? 0 : j - 1), half.at(i, std::min(j, d)));
    }
    take_largest(result);
    result.error = enlarged(from.error + gamma_bound(8) * from.largest) + 8 * underflow_error;
    from = result;
  }
  return from;
}

TensorPiece turned(const TensorPiece& piece, std::size_t k) {
  TensorPiece result = piece;
  const std::size_t d = piece.degree;
  for (std::size_t j = 0; j <= d; ++j) {
    for (std::size_t i = 0; i <= d; ++i) {
      result.at(i, j) = k == 0   ? piece.at(i, j)
                        : k == 1 ? piece.at(d - j, i)
                        : k == 2 ? piece.at(d - i, d - j)
                                 : piece.at(j, d - i);
    }
  }
  return result;
}

double distance_up(double largest_sq, double rounding) {
  return enlarged(enlarged(std::sqrt(enlarged(largest_sq + 4 * underflow_error))) +
                  spatial_error(enlarged(rounding)));
}

double distance_bound(const TensorPiece& a, const TensorPiece& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.count(); ++i)
    largest = std::max(largest, length_sq(a.points[i] - b.points[i]));
  // Each difference is off by a rounding of two coordinates.
  return distance_up(largest, a.error + b.error + unit_roundoff * (a.largest + b.largest));
}

// Both lie in the hulls of their points.
double distance_bound(const ControlNet& net, const TensorPiece& bezier) {
  double largest = 0;
  for (const kernels::NetPoint& p : net.points) {
    const Vector3 point{p[0], p[1], p[2]};
    for (std::size_t i = 0; i < bezier.count(); ++i)
      largest = std::max(largest, length_sq(point - bezier.points[i]));
  }
  return distance_up(largest, net.error + bezier.error + unit_roundoff * (net.largest + bezier.largest));
}

}  // namespace snug
