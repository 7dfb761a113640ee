#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/patch/net_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/net_kernels.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

#include <snug/scheme/basis_functions-inl.h>

constexpr hn::CappedTag<double, 4> d4;
using V = hn::Vec<decltype(d4)>;
constexpr std::size_t lanes = hn::MaxLanes(d4), parts = 4 / lanes;

// A point, or a sum of points, as one vector or several.
struct Sum {
  V part[parts];
};

HWY_INLINE Sum load(const NetPoint& p) {
  Sum sum;
  for (std::size_t k = 0; k < parts; ++k) sum.part[k] = hn::LoadU(d4, p.data() + k * lanes);
  return sum;
}
HWY_INLINE void store(const Sum& sum, NetPoint& out) {
  for (std::size_t k = 0; k < parts; ++k) hn::StoreU(sum.part[k], d4, out.data() + k * lanes);
}
HWY_INLINE Sum scaled(double weight, const Sum& p) {
  Sum result;
  for (std::size_t k = 0; k < parts; ++k) result.part[k] = hn::Mul(hn::Set(d4, weight), p.part[k]);
  return result;
}
HWY_INLINE void add_scaled(double weight, const Sum& p, Sum& sum) {
  for (std::size_t k = 0; k < parts; ++k) {
    sum.part[k] = hn::Add(sum.part[k], hn::Mul(hn::Set(d4, weight), p.part[k]));
  }
}

double RefineNet(const Stencils& stencils, const NetPoint* points, NetPoint* out) {
  Sum largest = load(NetPoint{});
  for (std::size_t r = 0; r < stencils.row_count(); ++r) {
    const Stencils::Row row = stencils.row(r);
    Sum sum = scaled(row.weights[0], load(points[row.sources[0]]));
    for (std::size_t i = 1; i < row.sources.size(); ++i) {
      add_scaled(row.weights[i], load(points[row.sources[i]]), sum);
    }
    store(sum, out[r]);
    for (std::size_t k = 0; k < parts; ++k) largest.part[k] = hn::Max(largest.part[k], hn::Abs(sum.part[k]));
  }
  NetPoint most;
  store(largest, most);
  return std::max({most[0], most[1], most[2]});
}

// Row by row of the lattice.
template <std::size_t degree>
HWY_INLINE void tensor_value(const LatticePlace& at, const NetPoint* points, NetPoint& out) {
  const Splines<degree> x = splines<degree>(at.u), y = splines<degree>(at.v);
  const std::uint32_t* lattice = at.lattice;
  Sum value;
  for (std::size_t j = 0; j <= degree; ++j, lattice += degree + 1) {
    Sum across = scaled(x.value[0], load(points[lattice[0]]));
    for (std::size_t i = 1; i <= degree; ++i) add_scaled(x.value[i], load(points[lattice[i]]), across);
    if (j == 0) {
      value = scaled(y.value[0], across);
    } else {
      add_scaled(y.value[j], across, value);
    }
  }
  store(value, out);
}

template <std::size_t degree>
HWY_INLINE void tensor_derivatives(const LatticePlace& at, const NetPoint* points, BasisSums& out) {
  const Splines<degree> x = splines<degree>(at.u), y = splines<degree>(at.v);
  const std::uint32_t* lattice = at.lattice;
  Sum value, along_u, along_v;
  for (std::size_t j = 0; j <= degree; ++j, lattice += degree + 1) {
    Sum p = load(points[lattice[0]]);
    Sum across = scaled(x.value[0], p), slope = scaled(x.slope[0], p);
    for (std::size_t i = 1; i <= degree; ++i) {
      p = load(points[lattice[i]]);
      add_scaled(x.value[i], p, across);
      add_scaled(x.slope[i], p, slope);
    }
    if (j == 0) {
      value = scaled(y.value[0], across);
      along_u = scaled(y.value[0], slope);
      along_v = scaled(y.slope[0], across);
    } else {
      add_scaled(y.value[j], across, value);
      add_scaled(y.value[j], slope, along_u);
      add_scaled(y.slope[j], across, along_v);
    }
  }
  store(value, out.value);
  store(along_u, out.along_u);
  store(along_v, out.along_v);
}

template <RegularBasis basis>
HWY_INLINE void other_value(const LatticePlace& at, const NetPoint* points, NetPoint& out) {
  BasisFunctions functions;
  basis_functions<basis, false>(at.w, at.u, at.v, functions);
  Sum value = scaled(functions.value[0], load(points[at.lattice[0]]));
  for (std::size_t i = 1; i < basis_count(basis); ++i) {
    add_scaled(functions.value[i], load(points[at.lattice[i]]), value);
  }
  store(value, out);
}

template <RegularBasis basis>
HWY_INLINE void other_derivatives(const LatticePlace& at, const NetPoint* points, BasisSums& out) {
  BasisFunctions functions;
  basis_functions<basis, true>(at.w, at.u, at.v, functions);
  Sum p = load(points[at.lattice[0]]);
  Sum value = scaled(functions.value[0], p), along_u = scaled(functions.along_u[0], p),
      along_v = scaled(functions.along_v[0], p);
  for (std::size_t i = 1; i < basis_count(basis); ++i) {
    p = load(points[at.lattice[i]]);
    add_scaled(functions.value[i], p, value);
    add_scaled(functions.along_u[i], p, along_u);
    add_scaled(functions.along_v[i], p, along_v);
  }
  store(value, out.value);
  store(along_u, out.along_u);
  store(along_v, out.along_v);
}

template <RegularBasis basis>
HWY_INLINE void sums_at(const LatticePlace& at, const NetPoint* points, NetPoint& out) {
  if constexpr (is_tensor(basis)) {
    tensor_value<tensor_degree(basis)>(at, points, out);
  } else {
    other_value<basis>(at, points, out);
  }
}

template <RegularBasis basis>
HWY_INLINE void sums_at(const LatticePlace& at, const NetPoint* points, BasisSums& out) {
  if constexpr (is_tensor(basis)) {
    tensor_derivatives<tensor_degree(basis)>(at, points, out);
  } else {
    other_derivatives<basis>(at, points, out);
  }
}

// A number of each of several points, a lane a point.
constexpr hn::CappedTag<double, 8> d8;
constexpr std::size_t most_lanes = hn::MaxLanes(d8);
struct Number {
  hn::Vec<decltype(d8)> lanes;
  Number() = default;
  HWY_INLINE Number(hn::Vec<decltype(d8)> of_lanes) : lanes(of_lanes) {}
  HWY_INLINE Number(double of_all) : lanes(hn::Set(d8, of_all)) {}
  friend HWY_INLINE Number operator+(Number a, Number b) { return hn::Add(a.lanes, b.lanes); }
  friend HWY_INLINE Number operator-(Number a, Number b) { return hn::Sub(a.lanes, b.lanes); }
  friend HWY_INLINE Number operator-(Number a) { return hn::Neg(a.lanes); }
  friend HWY_INLINE Number operator*(Number a, Number b) { return hn::Mul(a.lanes, b.lanes); }
};
struct Numbers {
  Number x, y, z;
};
HWY_INLINE Numbers scaled(Number weight, const Numbers& p) {
  return {weight * p.x, weight * p.y, weight * p.z};
}
HWY_INLINE void add_scaled(Number weight, const Numbers& p, Numbers& sum) {
  sum = {sum.x + weight * p.x, sum.y + weight * p.y, sum.z + weight * p.z};
}

// The operations of tensor_value() and other_value(), in their order, for parameters in the kind's order of corners.
template <RegularBasis basis>
HWY_INLINE Numbers lattice_sums(const LatticePoints& piece, Number w, Number u, Number v) {
  const auto point = [&](std::size_t i) {
    const NetPoint& p = piece.points[piece.lattice[i]];
    return Numbers{p[0], p[1], p[2]};
  };
  Numbers value;
  if constexpr (is_tensor(basis)) {
    constexpr std::size_t degree = tensor_degree(basis);
    const Splines<degree, Number> x = splines<degree>(u), y = splines<degree>(v);
    for (std::size_t j = 0, place = 0; j <= degree; ++j) {
      Numbers across = scaled(x.value[0], point(place++));
      for (std::size_t i = 1; i <= degree; ++i) add_scaled(x.value[i], point(place++), across);
      if (j == 0) {
        value = scaled(y.value[0], across);
      } else {
        add_scaled(y.value[j], across, value);
      }
    }
  } else {
    BasisFunctionsOf<Number> functions;
    basis_functions<basis, false>(w, u, v, functions);
    value = scaled(functions.value[0], point(0));
    for (std::size_t i = 1; i < basis_count(basis); ++i) add_scaled(functions.value[i], point(i), value);
  }
  return value;
}

// As many points as there are lanes.
template <RegularBasis basis>
HWY_INLINE void points_in_lanes(const LatticePoints& piece, const double* first_u, const double* first_v,
                                BoundedPoint* out) {
  const Number u = hn::LoadU(d8, first_u), v = hn::LoadU(d8, first_v);
  const std::array<Number, 5> turned{1 - u - v, u, v, 1 - u - v, u};
  const Number* const at = turned.data() + piece.first;
  const Numbers sum = lattice_sums<basis>(piece, at[0], at[1], at[2]);
  const Number x = piece.origin.x + sum.x, y = piece.origin.y + sum.y, z = piece.origin.z + sum.z;
  const Number largest = hn::Max(hn::Abs(x.lanes), hn::Max(hn::Abs(y.lanes), hn::Abs(z.lanes)));
  const Number error = piece.error + unit_roundoff * largest;
  static_assert(sizeof(BoundedPoint) == 4 * sizeof(double));
  hn::StoreInterleaved4(x.lanes, y.lanes, z.lanes, error.lanes, d8, &out->position.x);
}

// A point alone, which takes less than half of what all lanes do.
template <RegularBasis basis>
HWY_INLINE void point_alone(const LatticePoints& piece, double u, double v, BoundedPoint& out) {
  const std::array<double, 5> turned{1 - u - v, u, v, 1 - u - v, u};
  const double* const at = turned.data() + piece.first;
  NetPoint sum;
  sums_at<basis>({at[0], at[1], at[2], piece.lattice}, piece.points, sum);
  const Point3 point = piece.origin + Vector3{sum[0], sum[1], sum[2]};
  out = {point, piece.error + unit_roundoff * max_abs(point - Point3{})};
}

template <RegularBasis basis>
void lattice_points(const LatticePoints& piece, const LatticeParameters& at, BoundedPoint* out) {
  // On which of its four triangles a parameter lies chooses the functions of the Zwart-Powell element.
  constexpr std::size_t at_once = basis == RegularBasis::zwart_powell ? 1 : most_lanes;
  for (std::size_t begin = 0; begin < at.count; begin += at_once) {
    const double *u = at.u + begin, *v = at.v + begin;
    const std::size_t here = std::min(at_once, at.count - begin);
    if (here <= 2) {
      for (std::size_t i = 0; i < here; ++i)
        point_alone<basis>(piece, u[i], v[i], out[at.numbers[begin + i]]);
      continue;
    }
    if constexpr (at_once > 1) {
      std::array<double, most_lanes> last_u{}, last_v{};
      if (here < most_lanes) {
        u = std::copy_n(u, here, last_u.begin()) - here;
        v = std::copy_n(v, here, last_v.begin()) - here;
      }
      std::array<BoundedPoint, most_lanes> points;
      points_in_lanes<basis>(piece, u, v, points.data());
      for (std::size_t i = 0; i < here; ++i) out[at.numbers[begin + i]] = points[i];
    }
  }
}

// visit() with the basis as a constant.
template <class Visit>
HWY_INLINE void with_basis(RegularBasis basis, const Visit& visit) {
  using enum RegularBasis;
  switch (basis) {
    case linear:
      return visit.template operator()<linear>();
    case box_spline:
      return visit.template operator()<box_spline>();
    case bilinear:
      return visit.template operator()<bilinear>();
    case biquadratic:
      return visit.template operator()<biquadratic>();
    case bicubic:
      return visit.template operator()<bicubic>();
    case zwart_powell:
      return visit.template operator()<zwart_powell>();
  }
}

void SumValues(RegularBasis basis, const NetPoint* points, const LatticePlace& at, NetPoint& out) {
  with_basis(basis, [&]<RegularBasis b>() { sums_at<b>(at, points, out); });
}
void SumDerivatives(RegularBasis basis, const NetPoint* points, const LatticePlace& at, BasisSums& out) {
  with_basis(basis, [&]<RegularBasis b>() { sums_at<b>(at, points, out); });
}
void PointsOnLattice(const LatticePoints& piece, const LatticeParameters& at, BoundedPoint* out) {
  with_basis(piece.basis, [&]<RegularBasis b>() { lattice_points<b>(piece, at, out); });
}

double RoundPoints(std::span<const BoundedPoint> points, const std::size_t* numbers, float* out) {
  const hn::Rebind<float, decltype(d4)> f4;
  // The least number that rounds to no float, for which DemoteTo() gives the largest one where there are no vectors.
  const V too_large = hn::Set(d4, 0x1.ffffffp127);
  Sum largest = load(NetPoint{});
  for (const BoundedPoint& point : points) {
    float rounded[4];
    for (std::size_t k = 0; k < parts; ++k) {
      const V exact = hn::LoadU(d4, &point.position.x + k * lanes);
      const auto near = hn::DemoteTo(f4, exact);
      hn::StoreU(near, f4, rounded + k * lanes);
      const V off = hn::Add(hn::Abs(hn::Sub(hn::PromoteTo(d4, near), exact)), hn::Set(d4, point.error));
      largest.part[k] = hn::Max(
          largest.part[k], hn::IfThenElse(hn::Lt(hn::Abs(exact), too_large), off, hn::Set(d4, INFINITY)));
    }
    std::copy_n(rounded, 3, out + 3 * *numbers++);
  }
  NetPoint most;
  store(largest, most);
  return enlarged(std::max({most[0], most[1], most[2]}));
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(RefineNet);
HWY_EXPORT(SumValues);
HWY_EXPORT(SumDerivatives);
HWY_EXPORT(PointsOnLattice);
HWY_EXPORT(RoundPoints);

double refine_net(const Stencils& stencils, const NetPoint* points, NetPoint* out) {
  return HWY_DYNAMIC_DISPATCH(RefineNet)(stencils, points, out);
}

void sum_values(RegularBasis basis, const NetPoint* points, const LatticePlace& at, NetPoint& out) {
  HWY_DYNAMIC_DISPATCH(SumValues)(basis, points, at, out);
}

void sum_derivatives(RegularBasis basis, const NetPoint* points, const LatticePlace& at, BasisSums& out) {
  HWY_DYNAMIC_DISPATCH(SumDerivatives)(basis, points, at, out);
}

void points_on_lattice(const LatticePoints& piece, const LatticeParameters& at, BoundedPoint* out) {
  HWY_DYNAMIC_DISPATCH(PointsOnLattice)(piece, at, out);
}

double round_points(std::span<const BoundedPoint> points, const std::size_t* numbers, float* out) {
  return HWY_DYNAMIC_DISPATCH(RoundPoints)(points, numbers, out);
}

}  // namespace snug::kernels
#endif
