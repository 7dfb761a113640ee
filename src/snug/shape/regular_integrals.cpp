#include <snug/shape/regular_integrals.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <snug/geometry/bernstein.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/bezier.h>
#include <snug/scheme/rules.h>
#include <snug/shape/moment_kernel.h>

namespace snug {
namespace {

// Roundings of a Bezier point.
constexpr std::size_t point_roundings = 40;

// Bezier points of one polynomial part, by axis and relative to the piece's own origin.
template <class P>
using BezierPoints = std::array<std::array<double, P::count>, 3>;

// Adds up the moments of the parts of pieces, eight parts at once.
template <Domain domain, std::size_t degree>
class PartIntegrals {
 public:
  using Point = Bernstein<domain, degree>;

  PartIntegrals(std::span<FluxMoments> sums, std::vector<AreaPiece>& normals)
      : sums_(sums), normals_(normals) {}

  // A part of the piece of a number.
  void add(std::size_t number, const RegularPiece& piece, const BezierPoints<Point>& points) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < Point::count; ++k) parts_.points[a][k][count_] = points[a][k];
      parts_.origin[a][count_] = piece.origin[a];
    }
    parts_.point_error[count_] =
        enlarged(piece.error + gamma_bound(point_roundings) * piece.largest) + kernels::moment_underflow;
    parts_.origin_error[count_] = piece.origin_error;
    numbers_[count_++] = number;
    if (count_ == kernels::moment_lanes) finish();
  }
  void finish() {
    if (count_ == 0) return;
    kernels::integrate(domain, degree, count_, parts_);
    for (std::size_t lane = 0; lane < count_; ++lane) {
      FluxMoments& sum = sums_[numbers_[lane]];
      for (std::size_t m = 0; m < 10; ++m) {
        sum.value[m] += parts_.value[m][lane];
        sum.error[m] += parts_.error[m][lane] + unit_roundoff * std::fabs(sum.value[m]);
      }
      normals_.push_back(area_piece(lane));
    }
    count_ = 0;
  }

 private:
  static constexpr bool triangle = domain == Domain::triangle;
  using Normal = Bernstein<domain, triangle ? 2 * degree - 2 : 2 * degree - 1>;

  [[nodiscard]] AreaPiece area_piece(std::size_t lane) const {
    using Raised = AreaPiece::Polynomial<domain>;
    constexpr std::size_t more = AreaPiece::degree<domain> - (triangle ? 2 * degree - 2 : 2 * degree - 1);
    AreaPiece::Coefficients coefficients;
    for (std::size_t a = 0; a < 3; ++a) {
      Normal normal;
      for (std::size_t k = 0; k < Normal::count; ++k) normal.scaled[k] = parts_.normal[a][k][lane];
      const Raised raised = product(normal, one<Bernstein<domain, more>>);
      for (std::size_t k = 0; k < Raised::count; ++k) {
        coefficients[a][k] = raised.scaled[k] / binomials<Raised>[k];
      }
    }
    return {domain, coefficients,
            enlarged(parts_.normal_error[lane] + gamma_bound(64) * parts_.largest_normal[lane])};
  }

  std::span<FluxMoments> sums_;
  std::vector<AreaPiece>& normals_;
  kernels::MomentParts parts_;
  std::array<std::size_t, kernels::moment_lanes> numbers_{};
  std::size_t count_ = 0;
};

// Bezier points of a segment of a uniform B-spline, row by row.
template <std::size_t degree>
constexpr std::array<std::array<double, degree + 1>, degree + 1> segment() {
  if constexpr (degree == 1) {
    return {{{1, 0}, {0, 1}}};
  } else if constexpr (degree == 2) {
    return {{{0.5, 0.5, 0}, {0, 1, 0}, {0, 0.5, 0.5}}};
  } else {
    return {{{1.0 / 6, 2.0 / 3, 1.0 / 6, 0},
             {0, 2.0 / 3, 1.0 / 3, 0},
             {0, 1.0 / 3, 2.0 / 3, 0},
             {0, 1.0 / 6, 2.0 / 3, 1.0 / 6}}};
  }
}

template <std::size_t degree>
void integrate_tensor(std::size_t number, const RegularPiece& piece,
                      PartIntegrals<Domain::square, degree>& integrals) {
  constexpr std::size_t n = degree + 1;
  constexpr auto rows = segment<degree>();
  BezierPoints<Bernstein<Domain::square, degree>> points;
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, n * n> along_u{};
    for (std::size_t y = 0; y < n; ++y) {
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t x = 0; x < n; ++x) along_u[i + n * y] += rows[i][x] * piece.points[x + n * y][a];
      }
    }
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = 0; i < n; ++i) {
        double point = 0;
        for (std::size_t y = 0; y < n; ++y) point += rows[j][y] * along_u[i + n * y];
        points[a][i + n * j] = point;
      }
    }
  }
  integrals.add(number, piece, points);
}

void integrate_triangle(std::size_t number, const RegularPiece& piece,
                        PartIntegrals<Domain::triangle, 1>& integrals) {
  BezierPoints<Bernstein<Domain::triangle, 1>> points;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) points[a][k] = piece.points[k][a];
  }
  integrals.add(number, piece, points);
}

// The Bezier points of a regular patch of Loop from its twelve points.
const Stencils& box_spline_rows() {
  static const Stencils rows = [] {
    const SchemeRules& rules = rules_of(Scheme::loop);
    const std::array<CornerFan, 3> regular{};
    return rules.bezier(rules.ring(regular), regular).rows;
  }();
  return rows;
}

void integrate_box_spline(std::size_t number, const RegularPiece& piece,
                          PartIntegrals<Domain::triangle, 4>& integrals) {
  using Point = Bernstein<Domain::triangle, 4>;
  const Stencils& rows = box_spline_rows();
  BezierPoints<Point> points;
  for (std::size_t k = 0; k < Point::count; ++k) {
    const Stencils::Row row = rows.row(k);
    kernels::NetPoint sum{};
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      const kernels::NetPoint& from = piece.points[row.sources[i]];
      for (std::size_t a = 0; a < 4; ++a) sum[a] += row.weights[i] * from[a];
    }
    for (std::size_t a = 0; a < 3; ++a) points[a][k] = sum[a];
  }
  integrals.add(number, piece, points);
}

// Four triangles of an edge and the middle, as basis.h has them: 0 is the patch's vertex, 1 to 4 the ends of
// its edges, 5 to 8 the far corners of its faces.
void integrate_zwart_powell(std::size_t number, const RegularPiece& piece,
                            PartIntegrals<Domain::triangle, 2>& integrals) {
  using Point = Bernstein<Domain::triangle, 2>;
  for (std::size_t k = 0; k < 4; ++k) {
    BezierPoints<Point> points;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto at = [&](std::size_t i) { return piece.points[i][a]; };
      const auto spoke = [&](std::size_t i) { return at(1 + (k + i) % 4); };
      const auto far = [&](std::size_t i) { return at(5 + (k + i) % 4); };
      const double middle = at(0);
      const auto set = [&](std::size_t i, std::size_t j, double p) { points[a][Point::place(i, j)] = p; };
      set(0, 0, 0.25 * (middle + spoke(0) + spoke(1) + far(0)));
      set(2, 0, 0.25 * (middle + spoke(1) + spoke(2) + far(1)));
      set(0, 2, 0.5 * middle + 0.125 * (spoke(0) + spoke(1) + spoke(2) + spoke(3)));
      set(1, 0, 0.5 * (middle + spoke(1)));
      set(0, 1, 0.5 * middle + 0.25 * (spoke(0) + spoke(1)));
      set(1, 1, 0.5 * middle + 0.25 * (spoke(1) + spoke(2)));
    }
    integrals.add(number, piece, points);
  }
}

template <Domain domain, std::size_t degree>
void integrate_each(std::span<const RegularPiece> pieces, std::span<FluxMoments> sums,
                    std::vector<AreaPiece>& normals,
                    void (*add)(std::size_t, const RegularPiece&, PartIntegrals<domain, degree>&)) {
  PartIntegrals<domain, degree> integrals(sums, normals);
  for (std::size_t i = 0; i < pieces.size(); ++i) add(i, pieces[i], integrals);
  integrals.finish();
}

}  // namespace

void integrate(std::span<const RegularPiece> pieces, std::span<FluxMoments> sums,
               std::vector<AreaPiece>& normals) {
  if (pieces.empty()) return;
  switch (pieces[0].basis) {
    case RegularBasis::linear:
      integrate_each(pieces, sums, normals, integrate_triangle);
      break;
    case RegularBasis::box_spline:
      integrate_each(pieces, sums, normals, integrate_box_spline);
      break;
    case RegularBasis::bilinear:
      integrate_each(pieces, sums, normals, integrate_tensor<1>);
      break;
    case RegularBasis::biquadratic:
      integrate_each(pieces, sums, normals, integrate_tensor<2>);
      break;
    case RegularBasis::bicubic:
      integrate_each(pieces, sums, normals, integrate_tensor<3>);
      break;
    case RegularBasis::zwart_powell:
      integrate_each(pieces, sums, normals, integrate_zwart_powell);
      break;
  }
  for (FluxMoments& sum : sums.first(pieces.size())) {
    for (double& e : sum.error) e = enlarged(e);
  }
}

}  // namespace snug
