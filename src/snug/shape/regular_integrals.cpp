#include <snug/shape/regular_integrals.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/bernstein.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/bezier.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

// Roundings of a Bezier point, of a product in the integrands, of a mean.
constexpr std::size_t point_roundings = 40, product_roundings = 128, mean_roundings = 512;

// Bound of all underflow in the computations on a piece; sizes are between 1e-30 and 4.
constexpr double tiny = 0x1p-900;

// Bezier points of one polynomial part, by axis and relative to the piece's own origin.
template <class P>
using BezierPoints = std::array<std::array<double, P::count>, 3>;

// Adds up the moments of the parts of one piece.
template <Domain domain, std::size_t degree>
class PartIntegrals {
 public:
  using Point = Bernstein<domain, degree>;

  // `point_error`: of the points.
  PartIntegrals(const RegularPiece& piece, double point_error) : piece_(piece), point_error_(point_error) {}

  void add(const BezierPoints<Point>& points, FluxMoments& sum, std::vector<AreaPiece>& normals) {
    set_normal(points);
    add_moments(points, sum);
    normals.push_back(area_piece());
  }

 private:
  static constexpr bool triangle = domain == Domain::triangle;

  template <std::size_t n>
  static double dot(const std::array<double, n>& a, const std::array<double, n>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += a[k] * b[k];
    return sum;
  }

  using AlongU = Bernstein<domain, degree - 1, triangle ? degree - 1 : degree>;
  using AlongV = Bernstein<domain, triangle ? degree - 1 : degree, degree - 1>;
  using Normal = ProductOf<AlongU, AlongV>;
  using Flux = ProductOf<Point, Normal>;

  // Derivatives, scaled, and their largest Bezier coefficient.
  template <class Derivative>
  static Derivative along(const std::array<double, Point::count>& points, std::size_t by_i, std::size_t by_j,
                          double& largest) {
    Derivative result;
    Derivative::for_each([&](std::size_t i, std::size_t j) {
      const double difference = points[Point::place(i + by_i, j + by_j)] - points[Point::place(i, j)];
      const double coefficient = static_cast<double>(degree) * difference;
      largest = std::max(largest, std::fabs(coefficient));
      const std::size_t k = Derivative::place(i, j);
      result.scaled[k] = coefficient * binomials<Derivative>[k];
    });
    return result;
  }

  void set_normal(const BezierPoints<Point>& points) {
    std::array<AlongU, 3> u;
    std::array<AlongV, 3> v;
    double largest = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      u[a] = along<AlongU>(points[a], 1, 0, largest);
      v[a] = along<AlongV>(points[a], 0, 1, largest);
    }
    const double slope_error = static_cast<double>(degree) * 2 * point_error_ + 4 * unit_roundoff * largest;
    largest += slope_error;
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      normal_[a] = {};
      add_product(u[b], v[c], 1, normal_[a]);
      add_product(u[c], v[b], -1, normal_[a]);
    }
    normal_error_ = enlarged(4 * slope_error * (largest + slope_error) +
                             gamma_bound(product_roundings) * 2 * largest * largest) +
                    tiny;
    largest_normal_ = normal_error_;
    for (const Normal& n : normal_) {
      for (std::size_t k = 0; k < Normal::count; ++k) {
        largest_normal_ =
            std::max(largest_normal_, std::fabs(n.scaled[k]) / binomials<Normal>[k] + normal_error_);
      }
    }
  }

  void add_moments(const BezierPoints<Point>& points, FluxMoments& sum) const {
    std::array<Point, 3> x;
    double reach = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < Point::count; ++k) {
        const double coordinate = piece_.origin[a] + points[a][k];
        reach = std::max(reach, std::fabs(coordinate));
        x[a].scaled[k] = coordinate * binomials<Point>[k];
      }
    }
    const double x_error = point_error_ + piece_.origin_error + 2 * unit_roundoff * reach;
    reach += x_error;
    Flux flux;
    for (std::size_t a = 0; a < 3; ++a) add_product(x[a], normal_[a], 1, flux);
    const double largest_flux = 3 * reach * largest_normal_;
    const double flux_error = 3 * (x_error * largest_normal_ + reach * normal_error_) +
                              gamma_bound(product_roundings) * largest_flux;

    // Means of q times Bernstein polynomials, then of x_i q times those of half the degree.
    using Pair = ProductOf<Point, Point>;
    const std::array<double, Pair::count> means = means_with<Pair>(flux);
    std::array<double, 10> value;
    value[0] = area_of(domain) * dot(one<Pair>.scaled, means);
    std::array<std::array<double, Point::count>, 3> by_axis{};
    for (std::size_t a = 0; a < 3; ++a) {
      Point::for_each([&](std::size_t i, std::size_t j) {
        const double factor = x[a].scaled[Point::place(i, j)];
        Point::for_each([&](std::size_t k, std::size_t l) {
          by_axis[a][Point::place(k, l)] += factor * means[Pair::place(i + k, j + l)];
        });
      });
      value[1 + a] = area_of(domain) * dot(one<Point>.scaled, by_axis[a]);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      value[4 + a] = area_of(domain) * dot(x[a].scaled, by_axis[a]);
      value[7 + a] = area_of(domain) * dot(x[(a + 1) % 3].scaled, by_axis[a]);
    }
    const double rounded = gamma_bound(mean_roundings) * largest_flux;
    for (std::size_t m = 0; m < 10; ++m) {
      const unsigned factors = m == 0 ? 0 : m < 4 ? 1 : 2;
      const double power = factors == 0 ? 1 : factors == 1 ? reach : reach * reach;
      const double by_points = factors == 0 ? 0 : factors == 1 ? x_error : 2 * reach * x_error;
      sum.value[m] += value[m];
      sum.error[m] += area_of(domain) * (power * (flux_error + rounded) + by_points * largest_flux) +
                      unit_roundoff * std::fabs(sum.value[m]) + tiny;
    }
  }

  [[nodiscard]] AreaPiece area_piece() const {
    using Raised = AreaPiece::Polynomial<domain>;
    constexpr std::size_t more = AreaPiece::degree<domain> - (triangle ? 2 * degree - 2 : 2 * degree - 1);
    AreaPiece::Coefficients coefficients;
    for (std::size_t a = 0; a < 3; ++a) {
      const Raised raised = product(normal_[a], one<Bernstein<domain, more>>);
      for (std::size_t k = 0; k < Raised::count; ++k) {
        coefficients[a][k] = raised.scaled[k] / binomials<Raised>[k];
      }
    }
    return {domain, coefficients, enlarged(normal_error_ + gamma_bound(64) * largest_normal_)};
  }

  const RegularPiece& piece_;
  double point_error_;
  std::array<Normal, 3> normal_;
  double normal_error_ = 0, largest_normal_ = 0;
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
void integrate_tensor(const RegularPiece& piece, double error, FluxMoments& sum,
                      std::vector<AreaPiece>& normals) {
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
  PartIntegrals<Domain::square, degree>(piece, error).add(points, sum, normals);
}

void integrate_triangle(const RegularPiece& piece, double error, FluxMoments& sum,
                        std::vector<AreaPiece>& normals) {
  BezierPoints<Bernstein<Domain::triangle, 1>> points;
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) points[a][k] = piece.points[k][a];
  }
  PartIntegrals<Domain::triangle, 1>(piece, error).add(points, sum, normals);
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

void integrate_box_spline(const RegularPiece& piece, double error, FluxMoments& sum,
                          std::vector<AreaPiece>& normals) {
  using Point = Bernstein<Domain::triangle, 4>;
  const Stencils& rows = box_spline_rows();
  BezierPoints<Point> points;
  for (std::size_t k = 0; k < Point::count; ++k) {
    const Stencils::Row row = rows.row(k);
    for (std::size_t a = 0; a < 3; ++a) {
      double sum_of_row = 0;
      for (std::size_t i = 0; i < row.sources.size(); ++i) {
        sum_of_row += row.weights[i] * piece.points[row.sources[i]][a];
      }
      points[a][k] = sum_of_row;
    }
  }
  PartIntegrals<Domain::triangle, 4>(piece, error).add(points, sum, normals);
}

// Four triangles of an edge and the middle, as basis.h has them: 0 is the patch's vertex, 1 to 4 the ends of
// its edges, 5 to 8 the far corners of its faces.
void integrate_zwart_powell(const RegularPiece& piece, double error, FluxMoments& sum,
                            std::vector<AreaPiece>& normals) {
  using Point = Bernstein<Domain::triangle, 2>;
  PartIntegrals<Domain::triangle, 2> integrals(piece, error);
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
    integrals.add(points, sum, normals);
  }
}

}  // namespace

FluxMoments integrate(const RegularPiece& piece, std::vector<AreaPiece>& normals) {
  FluxMoments sum;
  const double error = enlarged(piece.error + gamma_bound(point_roundings) * piece.largest) + tiny;
  switch (piece.basis) {
    case RegularBasis::linear:
      integrate_triangle(piece, error, sum, normals);
      break;
    case RegularBasis::box_spline:
      integrate_box_spline(piece, error, sum, normals);
      break;
    case RegularBasis::bilinear:
      integrate_tensor<1>(piece, error, sum, normals);
      break;
    case RegularBasis::biquadratic:
      integrate_tensor<2>(piece, error, sum, normals);
      break;
    case RegularBasis::bicubic:
      integrate_tensor<3>(piece, error, sum, normals);
      break;
    case RegularBasis::zwart_powell:
      integrate_zwart_powell(piece, error, sum, normals);
      break;
  }
  for (double& e : sum.error) e = enlarged(e);
  return sum;
}

}  // namespace snug
