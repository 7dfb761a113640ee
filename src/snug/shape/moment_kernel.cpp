#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/shape/moment_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include <snug/geometry/rounding.h>
#include <snug/shape/moment_kernel.h>

#ifndef SNUG_SHAPE_MOMENT_KERNEL_DEGREES
#define SNUG_SHAPE_MOMENT_KERNEL_DEGREES
namespace snug::kernels {
namespace {

// Where the coefficients of a Bernstein polynomial are, as its type has it.
struct Grid {
  bool triangle;
  std::size_t row, rows;  // coefficients of the first row, and the number of rows

  template <Domain domain, std::size_t A, std::size_t B>
  constexpr explicit Grid(Bernstein<domain, A, B>)
      : triangle(domain == Domain::triangle), row(A + 1), rows(B + 1) {}
  [[nodiscard]] constexpr std::size_t width(std::size_t j) const { return triangle ? row - j : row; }
  [[nodiscard]] constexpr std::size_t place(std::size_t i, std::size_t j) const {
    return i + j * row - (triangle ? (j * j - j) / 2 : 0);
  }
  [[nodiscard]] constexpr std::size_t count() const { return place(0, rows); }
};

// Numbers that depend on the degree of parts alone.
template <Domain of, std::size_t n>
struct Polynomials {
  static constexpr bool triangle = of == Domain::triangle;
  using Point = Bernstein<of, n>;
  using AlongU = Bernstein<of, n - 1, triangle ? n - 1 : n>;
  using AlongV = Bernstein<of, triangle ? n - 1 : n, n - 1>;
  using Normal = ProductOf<AlongU, AlongV>;
  using Flux = ProductOf<Point, Normal>;
  using Pair = ProductOf<Point, Point>;
  using Integrand = ProductOf<Pair, Flux>;
};
struct Degree {
  template <Domain of, std::size_t n, class P = Polynomials<of, n>>
  static constexpr Degree make() {
    return {of,
            static_cast<double>(n),
            Grid(typename P::Point()),
            Grid(typename P::AlongU()),
            Grid(typename P::AlongV()),
            Grid(typename P::Normal()),
            Grid(typename P::Flux()),
            Grid(typename P::Pair()),
            Grid(typename P::Integrand()),
            binomials<typename P::Point>.data(),
            binomials<typename P::AlongU>.data(),
            binomials<typename P::AlongV>.data(),
            binomials<typename P::Normal>.data(),
            binomials<typename P::Pair>.data(),
            means<typename P::Integrand>.data()};
  }

  Domain domain;
  double degree;
  Grid point, along_u, along_v, normal, flux, pair, integrand;
  const double *point_binomials, *along_u_binomials, *along_v_binomials, *normal_binomials, *pair_binomials;
  const double* integrand_means;
};
constexpr std::size_t max_points = 16, max_along = 12, max_normals = 36, max_flux = 81, max_pairs = 49;

}  // namespace
}  // namespace snug::kernels
#endif

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

using Tag = hn::CappedTag<double, moment_lanes>;
using V = hn::Vec<Tag>;

// Roundings of a product in the integrands, and of a mean.
constexpr std::size_t product_roundings = 128, mean_roundings = 512;

HWY_INLINE V set(double x) { return hn::Set(Tag(), x); }
HWY_INLINE V times(V a, V b) { return hn::Mul(a, b); }
HWY_INLINE V plus(V a, V b) { return hn::Add(a, b); }
HWY_INLINE V up(V x) { return plus(times(x, set(1 + 0x1p-42)), set(underflow_error)); }

// Calls work(width) with the width as a constant: sums of a row stay in registers then.
template <std::size_t max, std::size_t width = 1, class Work>
HWY_INLINE void with_width(std::size_t wanted, const Work& work) {
  if constexpr (width < max) {
    if (wanted > width) return with_width<max, width + 1>(wanted, work);
  }
  work(std::integral_constant<std::size_t, width>());
}

// Adds factor * p * q to `out`: for each coefficient in the order of snug::add_product().
HWY_NOINLINE void add_product(const Grid& of_p, const V* p, const Grid& of_q, const V* q, double factor,
                              const Grid& of_out, V* out) {
  for (std::size_t j = 0; j < of_p.rows; ++j) {
    const V* const row = p + of_p.place(0, j);
    const std::size_t count = of_p.width(j);
    for (std::size_t l = 0; l < of_q.rows; ++l) {
      const V* const from = q + of_q.place(0, l);
      V* const to = out + of_out.place(0, j + l);
      with_width<7>(of_q.width(l), [&](auto constant) HWY_ATTR {
        constexpr std::size_t width = constant;
        for (std::size_t i = 0; i < count; ++i) {
          const V a = times(set(factor), row[i]);
          for (std::size_t k = 0; k < width; ++k) to[i + k] = plus(to[i + k], times(a, from[k]));
        }
      });
    }
  }
}

// Means of q times each basis function of a grid, from those of the basis functions of their product.
HWY_NOINLINE void means_with(const Grid& of_result, const Grid& of_q, const V* q, const Grid& of_means,
                             const double* means, V* result) {
  for (std::size_t j = 0; j < of_result.rows; ++j) {
    with_width<9>(of_result.width(j), [&](auto constant) HWY_ATTR {
      constexpr std::size_t width = constant;
      V sums[width];
      for (V& sum : sums) sum = set(0);
      const V* factor = q;
      for (std::size_t l = 0; l < of_q.rows; ++l) {
        const double* weights = means + of_means.place(0, j + l);
        for (std::size_t k = 0; k < of_q.width(l); ++k, ++factor, ++weights) {
          for (std::size_t i = 0; i < width; ++i) sums[i] = plus(sums[i], times(*factor, set(weights[i])));
        }
      }
      std::copy(sums, sums + width, result + of_result.place(0, j));
    });
  }
}

// Sums of p times what begins at each of its coefficients in a larger grid: the means of p times each basis function of
// its grid, from those of the basis functions of their products.
HWY_NOINLINE void sums_with(const Grid& grid, const V* p, const Grid& of_means, const V* means, V* result) {
  for (std::size_t l = 0; l < grid.rows; ++l) {
    with_width<5>(grid.width(l), [&](auto constant) HWY_ATTR {
      constexpr std::size_t width = constant;
      V sums[width];
      for (V& sum : sums) sum = set(0);
      const V* factor = p;
      for (std::size_t j = 0; j < grid.rows; ++j) {
        const V* from = means + of_means.place(0, j + l);
        for (std::size_t i = 0; i < grid.width(j); ++i, ++factor, ++from) {
          for (std::size_t k = 0; k < width; ++k) sums[k] = plus(sums[k], times(*factor, from[k]));
        }
      }
      std::copy(sums, sums + width, result + grid.place(0, l));
    });
  }
}

class Part {
 public:
  HWY_INLINE Part(const Degree& degree, MomentParts& parts, std::size_t at)
      : degree_(degree), parts_(parts), at_(at) {}

  HWY_NOINLINE void find_normal() {
    V u[3][max_along], v[3][max_along];
    V largest = set(0);
    for (std::size_t a = 0; a < 3; ++a) {
      along(a, degree_.along_u, degree_.along_u_binomials, 1, 0, u[a], largest);
      along(a, degree_.along_v, degree_.along_v_binomials, 0, 1, v[a], largest);
    }
    point_error_ = load(parts_.point_error);
    const V slope_error =
        plus(times(set(2 * degree_.degree), point_error_), times(set(4 * unit_roundoff), largest));
    largest = plus(largest, slope_error);
    const std::size_t count = degree_.normal.count();
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      std::fill(normal_[a], normal_[a] + count, set(0));
      add_product(degree_.along_u, u[b], degree_.along_v, v[c], 1, degree_.normal, normal_[a]);
      add_product(degree_.along_u, u[c], degree_.along_v, v[b], -1, degree_.normal, normal_[a]);
    }
    normal_error_ = plus(up(plus(times(times(set(4), slope_error), plus(largest, slope_error)),
                                 times(set(gamma_bound(product_roundings) * 2), times(largest, largest)))),
                         set(moment_underflow));
    V largest_coefficient = set(0);
    for (std::size_t k = 0; k < count; ++k) {
      V scaled = set(0);
      for (std::size_t a = 0; a < 3; ++a) {
        scaled = hn::Max(scaled, hn::Abs(normal_[a][k]));
        store(normal_[a][k], parts_.normal[a][k]);
      }
      largest_coefficient = hn::Max(largest_coefficient, hn::Div(scaled, set(degree_.normal_binomials[k])));
    }
    largest_normal_ = plus(largest_coefficient, normal_error_);
    store(normal_error_, parts_.normal_error);
    store(largest_normal_, parts_.largest_normal);
  }

  HWY_NOINLINE void find_moments() const {
    const std::size_t count = degree_.point.count();
    V x[3][max_points];
    V reach = set(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const V origin = load(parts_.origin[a]);
      for (std::size_t k = 0; k < count; ++k) {
        const V coordinate = plus(origin, load(parts_.points[a][k]));
        reach = hn::Max(reach, hn::Abs(coordinate));
        x[a][k] = times(coordinate, set(degree_.point_binomials[k]));
      }
    }
    const V x_error =
        plus(plus(point_error_, load(parts_.origin_error)), times(set(2 * unit_roundoff), reach));
    reach = plus(reach, x_error);
    V flux[max_flux];
    std::fill(flux, flux + degree_.flux.count(), set(0));
    for (std::size_t a = 0; a < 3; ++a)
      add_product(degree_.point, x[a], degree_.normal, normal_[a], 1, degree_.flux, flux);
    const V largest_flux = times(times(set(3), reach), largest_normal_);
    const V flux_error =
        plus(times(set(3), plus(times(x_error, largest_normal_), times(reach, normal_error_))),
             times(set(gamma_bound(product_roundings)), largest_flux));

    // Means of q times Bernstein polynomials, then of x_i q times those of half the degree.
    V mean[max_pairs];
    means_with(degree_.pair, degree_.flux, flux, degree_.integrand, degree_.integrand_means, mean);
    V value[10];
    value[0] = set(0);
    for (std::size_t k = 0; k < degree_.pair.count(); ++k)
      value[0] = plus(value[0], times(set(degree_.pair_binomials[k]), mean[k]));
    V by_axis[3][max_points];
    for (std::size_t a = 0; a < 3; ++a) {
      sums_with(degree_.point, x[a], degree_.pair, mean, by_axis[a]);
      value[1 + a] = set(0);
      for (std::size_t k = 0; k < count; ++k)
        value[1 + a] = plus(value[1 + a], times(set(degree_.point_binomials[k]), by_axis[a][k]));
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      V square = set(0), mixed = set(0);
      for (std::size_t k = 0; k < count; ++k) {
        square = plus(square, times(x[a][k], by_axis[a][k]));
        mixed = plus(mixed, times(x[b][k], by_axis[a][k]));
      }
      value[4 + a] = square;
      value[7 + a] = mixed;
    }
    const V area = set(area_of(degree_.domain)),
            rounded = times(set(gamma_bound(mean_roundings)), largest_flux);
    for (std::size_t m = 0; m < 10; ++m) {
      const V power = m == 0 ? set(1) : m < 4 ? reach : times(reach, reach);
      const V by_points = m == 0 ? set(0) : m < 4 ? x_error : times(times(set(2), reach), x_error);
      store(times(area, value[m]), parts_.value[m]);
      store(plus(times(area, plus(times(power, plus(flux_error, rounded)), times(by_points, largest_flux))),
                 set(moment_underflow)),
            parts_.error[m]);
    }
  }

 private:
  HWY_INLINE V load(const MomentParts::Lanes& lanes) const { return hn::LoadU(Tag(), lanes + at_); }
  HWY_INLINE void store(V x, MomentParts::Lanes& lanes) const { hn::StoreU(x, Tag(), lanes + at_); }

  // Derivatives along u or v, and their largest Bezier coefficient.
  HWY_INLINE void along(std::size_t axis, const Grid& grid, const double* binomials, std::size_t by_i,
                        std::size_t by_j, V* out, V& largest) const {
    const auto& points = parts_.points[axis];
    std::size_t k = 0;
    for (std::size_t j = 0; j < grid.rows; ++j) {
      const auto* const from = points + degree_.point.place(0, j);
      const auto* const to = points + degree_.point.place(by_i, j + by_j);
      for (std::size_t i = 0; i < grid.width(j); ++i, ++k) {
        const V coefficient = times(set(degree_.degree), hn::Sub(load(to[i]), load(from[i])));
        largest = hn::Max(largest, hn::Abs(coefficient));
        out[k] = times(coefficient, set(binomials[k]));
      }
    }
  }

  const Degree& degree_;
  MomentParts& parts_;
  std::size_t at_;  // the first lane
  V normal_[3][max_normals];
  V point_error_, normal_error_, largest_normal_;
};

// Lanes that are not used repeat the first one.
HWY_INLINE void fill_up(std::size_t points, std::size_t count, MomentParts& parts) {
  const auto fill = [&](MomentParts::Lanes& lanes)
                        HWY_ATTR { std::fill(lanes + count, lanes + moment_lanes, lanes[0]); };
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < points; ++k) fill(parts.points[a][k]);
    fill(parts.origin[a]);
  }
  fill(parts.point_error);
  fill(parts.origin_error);
}

void IntegrateParts(const Degree& degree, std::size_t count, MomentParts& parts) {
  if (count < moment_lanes) fill_up(degree.point.count(), count, parts);
  for (std::size_t at = 0; at < count; at += hn::Lanes(Tag())) {
    Part part(degree, parts, at);
    part.find_normal();
    part.find_moments();
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(IntegrateParts);

void integrate(Domain domain, std::size_t degree, std::size_t count, MomentParts& parts) {
  static constexpr std::array triangles{Degree::make<Domain::triangle, 1>(),
                                        Degree::make<Domain::triangle, 2>(),
                                        Degree::make<Domain::triangle, 4>()};
  static constexpr std::array squares{Degree::make<Domain::square, 1>(), Degree::make<Domain::square, 2>(),
                                      Degree::make<Domain::square, 3>()};
  const auto& degrees = domain == Domain::triangle ? triangles : squares;
  HWY_DYNAMIC_DISPATCH(IntegrateParts)(degrees[degree < 3 ? degree - 1 : 2], count, parts);
}

}  // namespace snug::kernels
#endif
