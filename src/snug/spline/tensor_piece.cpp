#include <snug/spline/tensor_piece.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>

namespace snug {
namespace {

constexpr std::size_t most = TensorPiece::max_degree;

// One argument of the polar form after the other. A step is a weighted mean of two points where the argument is between the
// knots: four roundings.
Vector3 polar(std::size_t degree, const double* knots, std::array<Vector3, most + 1> p,
              std::span<const double> at) {
  for (std::size_t r = 0; r < degree; ++r) {
    for (std::size_t i = 0; i + r < degree; ++i) {
      const double low = knots[i + r], high = knots[i + degree], share = (at[r] - low) / (high - low);
      p[i] = (1 - share) * p[i] + share * p[i + 1];
    }
  }
  return p[0];
}

// Of both directions in a piece.
constexpr std::size_t polar_roundings(std::size_t degree) { return 8 * degree; }

// From a piece: `knots` and control points of a direction replaced.
template <class Arguments>
void change_direction(const TensorPiece& from, bool along_u, const Arguments& arguments, TensorPiece& to) {
  const std::size_t width = from.width();
  for (std::size_t line = 0; line < width; ++line) {
    std::array<Vector3, most + 1> p;
    for (std::size_t i = 0; i < width; ++i) p[i] = along_u ? from.at(i, line) : from.at(line, i);
    for (std::size_t i = 0; i < width; ++i) {
      const Vector3 q = polar(from.degree, along_u ? from.u.data() : from.v.data(), p, arguments(i));
      (along_u ? to.at(i, line) : to.at(line, i)) = q;
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
  for (std::size_t k = 0; k < 2 * degree; ++k)
    piece.u[k] = piece.v[k] = static_cast<double>(k) - static_cast<double>(degree - 1);
  for (std::size_t i = 0; i < piece.count(); ++i) {
    const kernels::NetPoint& p = net.points[net.lattice[i]];
    piece.points[i] = {p[0], p[1], p[2]};
  }
  piece.largest = net.largest;
  piece.error = net.error;
  return piece;
}

Vector3 blossom(const TensorPiece& piece, std::span<const double> u, std::span<const double> v) {
  std::array<Vector3, most + 1> lines;
  for (std::size_t j = 0; j < piece.width(); ++j) {
    std::array<Vector3, most + 1> line;
    for (std::size_t i = 0; i < piece.width(); ++i) line[i] = piece.at(i, j);
    lines[j] = polar(piece.degree, piece.u.data(), line, u);
  }
  return polar(piece.degree, piece.v.data(), lines, v);
}

Vector3 value(const TensorPiece& piece, double u, double v) {
  std::array<double, most> all_u, all_v;
  all_u.fill(u);
  all_v.fill(v);
  return blossom(piece, {all_u.data(), piece.degree}, {all_v.data(), piece.degree});
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
  half.v = piece.v;
  std::array<double, most> at{};
  const auto between = [&](double low, double high) {
    return [&, low, high](std::size_t i) {
      for (std::size_t k = 0; k < d; ++k) at[k] = k < d - i ? low : high;
      return std::span<const double>(at.data(), d);
    };
  };
  change_direction(piece, true, between(box.u0, box.u1), half);
  change_direction(half, false, between(box.v0, box.v1), result);
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

double distance_bound(const TensorPiece& a, const TensorPiece& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.count(); ++i)
    largest = std::max(largest, length_sq(a.points[i] - b.points[i]));
  // Each difference is off by a rounding of two coordinates.
  const double rounding = a.error + b.error + unit_roundoff * (a.largest + b.largest);
  return enlarged(enlarged(std::sqrt(enlarged(largest))) + spatial_error(rounding));
}

}  // namespace snug
