#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/patch/net_kernels.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>

#include <snug/patch/net_kernels.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

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
void sum_all(const NetPoint* points, std::span<const LatticePlace> all, NetPoint* out) {
  for (const LatticePlace& at : all) {
    if constexpr (is_tensor(basis)) {
      tensor_value<tensor_degree(basis)>(at, points + at.net, *out++);
    } else {
      other_value<basis>(at, points + at.net, *out++);
    }
  }
}

template <RegularBasis basis>
void sum_all(const NetPoint* points, std::span<const LatticePlace> all, BasisSums* out) {
  for (const LatticePlace& at : all) {
    if constexpr (is_tensor(basis)) {
      tensor_derivatives<tensor_degree(basis)>(at, points + at.net, *out++);
    } else {
      other_derivatives<basis>(at, points + at.net, *out++);
    }
  }
}

template <class Out>
void sum_with(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at, Out* out) {
  switch (basis) {
    case RegularBasis::linear:
      return sum_all<RegularBasis::linear>(points, at, out);
    case RegularBasis::box_spline:
      return sum_all<RegularBasis::box_spline>(points, at, out);
    case RegularBasis::bilinear:
      return sum_all<RegularBasis::bilinear>(points, at, out);
    case RegularBasis::biquadratic:
      return sum_all<RegularBasis::biquadratic>(points, at, out);
    case RegularBasis::bicubic:
      return sum_all<RegularBasis::bicubic>(points, at, out);
    case RegularBasis::zwart_powell:
      return sum_all<RegularBasis::zwart_powell>(points, at, out);
  }
}

void SumValues(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at, NetPoint* out) {
  sum_with(basis, points, at, out);
}
void SumDerivatives(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at,
                    BasisSums* out) {
  sum_with(basis, points, at, out);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(RefineNet);
HWY_EXPORT(SumValues);
HWY_EXPORT(SumDerivatives);

double refine_net(const Stencils& stencils, const NetPoint* points, NetPoint* out) {
  return HWY_DYNAMIC_DISPATCH(RefineNet)(stencils, points, out);
}

void sum_values(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at, NetPoint* out) {
  HWY_DYNAMIC_DISPATCH(SumValues)(basis, points, at, out);
}

void sum_derivatives(RegularBasis basis, const NetPoint* points, std::span<const LatticePlace> at,
                     BasisSums* out) {
  HWY_DYNAMIC_DISPATCH(SumDerivatives)(basis, points, at, out);
}

}  // namespace snug::kernels
#endif
