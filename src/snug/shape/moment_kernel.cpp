#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/shape/moment_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/shape/moment_kernel.h>

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

// A polynomial a lane, scaled as Bernstein is.
template <class P>
struct Polynomials {
  V scaled[P::count];
};

// As snug::add_product().
template <class P, class Q>
HWY_INLINE void add_product(const Polynomials<P>& p, const Polynomials<Q>& q, double factor,
                            Polynomials<ProductOf<P, Q>>& out) {
  using Out = ProductOf<P, Q>;
  constexpr std::size_t rows_of_p = P::rows, rows_of_q = Q::rows;
  for (std::size_t j = 0; j < rows_of_p; ++j) {
    for (std::size_t i = 0; i < P::width(j); ++i) {
      const V a = times(set(factor), p.scaled[P::place(i, j)]);
      for (std::size_t l = 0; l < rows_of_q; ++l) {
        const V* const from = q.scaled + Q::place(0, l);
        V* const to = out.scaled + Out::place(i, j + l);
        for (std::size_t k = 0; k < Q::width(l); ++k) to[k] = plus(to[k], times(a, from[k]));
      }
    }
  }
}

// Means of q times each basis function of P, from row j on; sums of a row stay in registers.
template <class P, class Q, std::size_t j = 0>
HWY_INLINE void means_with(const Polynomials<Q>& q, V* result) {
  using Out = ProductOf<P, Q>;
  constexpr std::size_t width = P::width(j);
  V sums[width];
  for (V& sum : sums) sum = set(0);
  const V* factor = q.scaled;
  for (std::size_t l = 0; l < Q::rows; ++l) {
    const double* weights = means<Out>.data() + Out::place(0, j + l);
    for (std::size_t k = 0; k < Q::width(l); ++k, ++factor, ++weights) {
      for (std::size_t i = 0; i < width; ++i) sums[i] = plus(sums[i], times(*factor, set(weights[i])));
    }
  }
  std::copy(sums, sums + width, result + P::place(0, j));
  if constexpr (j + 1 < P::rows) means_with<P, Q, j + 1>(q, result);
}

template <class P>
HWY_INLINE void clear(Polynomials<P>& p) {
  for (V& x : p.scaled) x = set(0);
}

template <Domain domain, std::size_t degree>
struct Part {
  static constexpr bool triangle = domain == Domain::triangle;
  using Point = Bernstein<domain, degree>;
  using AlongU = Bernstein<domain, degree - 1, triangle ? degree - 1 : degree>;
  using AlongV = Bernstein<domain, triangle ? degree - 1 : degree, degree - 1>;
  using Normal = ProductOf<AlongU, AlongV>;
  using Flux = ProductOf<Point, Normal>;
  using Pair = ProductOf<Point, Point>;

  MomentParts& parts;
  std::size_t at;  // the first lane
  Polynomials<Normal> normal[3];
  V point_error, normal_error, largest_normal;

  HWY_INLINE V load(const MomentParts::Lanes& lanes) const { return hn::LoadU(Tag(), lanes + at); }
  HWY_INLINE void store(V x, MomentParts::Lanes& lanes) const { hn::StoreU(x, Tag(), lanes + at); }

  // Derivatives, and their largest Bezier coefficient.
  template <class Derivative>
  HWY_INLINE void along(std::size_t axis, std::size_t by_i, std::size_t by_j, Polynomials<Derivative>& out,
                        V& largest) const {
    for (std::size_t j = 0; j < Derivative::rows; ++j) {
      for (std::size_t i = 0; i < Derivative::width(j); ++i) {
        const V difference = hn::Sub(load(parts.points[axis][Point::place(i + by_i, j + by_j)]),
                                     load(parts.points[axis][Point::place(i, j)]));
        const V coefficient = times(set(static_cast<double>(degree)), difference);
        largest = hn::Max(largest, hn::Abs(coefficient));
        const std::size_t k = Derivative::place(i, j);
        out.scaled[k] = times(coefficient, set(binomials<Derivative>[k]));
      }
    }
  }

  HWY_INLINE void find_normal() {
    Polynomials<AlongU> u[3];
    Polynomials<AlongV> v[3];
    V largest = set(0);
    for (std::size_t a = 0; a < 3; ++a) {
      along<AlongU>(a, 1, 0, u[a], largest);
      along<AlongV>(a, 0, 1, v[a], largest);
    }
    point_error = load(parts.point_error);
    const V slope_error = plus(times(set(2 * static_cast<double>(degree)), point_error),
                               times(set(4 * unit_roundoff), largest));
    largest = plus(largest, slope_error);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      clear(normal[a]);
      add_product(u[b], v[c], 1, normal[a]);
      add_product(u[c], v[b], -1, normal[a]);
    }
    normal_error = plus(up(plus(times(times(set(4), slope_error), plus(largest, slope_error)),
                                times(set(gamma_bound(product_roundings) * 2), times(largest, largest)))),
                        set(moment_underflow));
    largest_normal = normal_error;
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t k = 0; k < Normal::count; ++k) {
        const V coefficient = hn::Div(hn::Abs(normal[a].scaled[k]), set(binomials<Normal>[k]));
        largest_normal = hn::Max(largest_normal, plus(coefficient, normal_error));
        store(normal[a].scaled[k], parts.normal[a][k]);
      }
    }
    store(normal_error, parts.normal_error);
    store(largest_normal, parts.largest_normal);
  }

  HWY_INLINE void find_moments() const {
    Polynomials<Point> x[3];
    V reach = set(0);
    for (std::size_t a = 0; a < 3; ++a) {
      const V origin = load(parts.origin[a]);
      for (std::size_t k = 0; k < Point::count; ++k) {
        const V coordinate = plus(origin, load(parts.points[a][k]));
        reach = hn::Max(reach, hn::Abs(coordinate));
        x[a].scaled[k] = times(coordinate, set(binomials<Point>[k]));
      }
    }
    const V x_error = plus(plus(point_error, load(parts.origin_error)), times(set(2 * unit_roundoff), reach));
    reach = plus(reach, x_error);
    Polynomials<Flux> flux;
    clear(flux);
    for (std::size_t a = 0; a < 3; ++a) add_product(x[a], normal[a], 1, flux);
    const V largest_flux = times(times(set(3), reach), largest_normal);
    const V flux_error = plus(times(set(3), plus(times(x_error, largest_normal), times(reach, normal_error))),
                              times(set(gamma_bound(product_roundings)), largest_flux));

    // Means of q times Bernstein polynomials, then of x_i q times those of half the degree.
    V mean[Pair::count];
    means_with<Pair>(flux, mean);
    const V area = set(area_of(domain));
    V value[10];
    value[0] = set(0);
    for (std::size_t k = 0; k < Pair::count; ++k)
      value[0] = plus(value[0], times(set(binomials<Pair>[k]), mean[k]));
    V by_axis[3][Point::count];
    for (std::size_t a = 0; a < 3; ++a) {
      for (V& sum : by_axis[a]) sum = set(0);
      for (std::size_t j = 0; j < Point::rows; ++j) {
        for (std::size_t i = 0; i < Point::width(j); ++i) {
          const V factor = x[a].scaled[Point::place(i, j)];
          for (std::size_t l = 0; l < Point::rows; ++l) {
            V* const to = by_axis[a] + Point::place(0, l);
            const V* const from = mean + Pair::place(i, j + l);
            for (std::size_t k = 0; k < Point::width(l); ++k) to[k] = plus(to[k], times(factor, from[k]));
          }
        }
      }
      value[1 + a] = set(0);
      for (std::size_t k = 0; k < Point::count; ++k)
        value[1 + a] = plus(value[1 + a], times(set(binomials<Point>[k]), by_axis[a][k]));
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3;
      V square = set(0), mixed = set(0);
      for (std::size_t k = 0; k < Point::count; ++k) {
        square = plus(square, times(x[a].scaled[k], by_axis[a][k]));
        mixed = plus(mixed, times(x[b].scaled[k], by_axis[a][k]));
      }
      value[4 + a] = square;
      value[7 + a] = mixed;
    }
    const V rounded = times(set(gamma_bound(mean_roundings)), largest_flux);
    for (std::size_t m = 0; m < 10; ++m) {
      const V power = m == 0 ? set(1) : m < 4 ? reach : times(reach, reach);
      const V by_points = m == 0 ? set(0) : m < 4 ? x_error : times(times(set(2), reach), x_error);
      store(times(area, value[m]), parts.value[m]);
      store(plus(times(area, plus(times(power, plus(flux_error, rounded)), times(by_points, largest_flux))),
                 set(moment_underflow)),
            parts.error[m]);
    }
  }
};

// Lanes that are not used repeat the first one.
template <std::size_t points>
HWY_INLINE void fill_up(std::size_t count, MomentParts& parts) {
  const auto fill = [&](MomentParts::Lanes& lanes)
                        HWY_ATTR { std::fill(lanes + count, lanes + moment_lanes, lanes[0]); };
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < points; ++k) fill(parts.points[a][k]);
    fill(parts.origin[a]);
  }
  fill(parts.point_error);
  fill(parts.origin_error);
}

template <Domain domain, std::size_t degree>
HWY_NOINLINE void integrate_all(std::size_t count, MomentParts& parts) {
  if (count < moment_lanes) fill_up<Bernstein<domain, degree>::count>(count, parts);
  for (std::size_t at = 0; at < count; at += hn::Lanes(Tag())) {
    Part<domain, degree> part{parts, at, {}, {}, {}, {}};
    part.find_normal();
    part.find_moments();
  }
}

void IntegrateParts(Domain domain, std::size_t degree, std::size_t count, MomentParts& parts) {
  if (domain == Domain::triangle) {
    if (degree == 1) return integrate_all<Domain::triangle, 1>(count, parts);
    if (degree == 2) return integrate_all<Domain::triangle, 2>(count, parts);
    return integrate_all<Domain::triangle, 4>(count, parts);
  }
  if (degree == 1) return integrate_all<Domain::square, 1>(count, parts);
  if (degree == 2) return integrate_all<Domain::square, 2>(count, parts);
  return integrate_all<Domain::square, 3>(count, parts);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(IntegrateParts);

void integrate(Domain domain, std::size_t degree, std::size_t count, MomentParts& parts) {
  HWY_DYNAMIC_DISPATCH(IntegrateParts)(domain, degree, count, parts);
}

}  // namespace snug::kernels
#endif
