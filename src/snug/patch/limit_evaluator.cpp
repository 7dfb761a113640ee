#include <snug/patch/limit_evaluator.h>

#include <algorithm>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>
#include <snug/patch/descent.h>

namespace snug {
namespace {

// 4! / (i! j! k!) in the order of bezier_index().
constexpr std::array<double, 15> multinomial{1, 4, 6, 4, 1, 4, 12, 12, 4, 6, 12, 6, 4, 4, 1};

// Where the kind counts the Bezier point that the patch counts as u^i v^j.
std::size_t kind_index(const Patch& patch, std::size_t i, std::size_t j) {
  const std::array<std::size_t, 3> powers{4 - i - j, i, j};
  std::array<std::size_t, 3> kind_powers;
  for (std::size_t corner = 0; corner < 3; ++corner) kind_powers[patch.to_kind(corner)] = powers[corner];
  return bezier_index(kind_powers[1], kind_powers[2]);
}

}  // namespace

void LimitEvaluator::reset(const Patch& patch) {
  inner_.clear();
  quartics_.clear();
  patch_ = patch;
  inner_.push_back({patch, 0, {}});
  if (patch.kind->polynomial()) inner_[0].children[0] = make(Patch(patch), 0);
}

LimitEvaluator::Child LimitEvaluator::make(Patch&& piece, double drift) {
  if (!piece.kind->polynomial()) {
    inner_.push_back({std::move(piece), drift, {}});
    return {Child::inner, static_cast<std::uint32_t>(inner_.size() - 1)};
  }
  const Stencils& rows = piece.kind->bezier();
  Quartic quartic{};
  double largest = 0;
  for (std::size_t j = 0; j < 5; ++j) {
    for (std::size_t i = 0; i + j < 5; ++i) {
      const std::size_t place = bezier_index(i, j);
      const Vector3 p = rows.apply<Vector3>(kind_index(piece, i, j), piece.points);
      largest = std::max(largest, max_abs(p));
      quartic.weights[place] = {multinomial[place] * p.x, multinomial[place] * p.y, multinomial[place] * p.z,
                                0};
    }
  }
  // Monomials, their products with the weights and the sum: at most 24 roundings. w = 1 - u - v is off by 2 u, and the
  // parameters by `drift`; the derivative of a quartic is four times a difference of Bezier points.
  quartic.error = enlarged((gamma_bound(32) + 16 * (drift + 2 * unit_roundoff)) * largest +
                           rows.result_error(piece.largest, piece.error) + 64 * underflow_error);
  quartics_.push_back(quartic);
  return {Child::quartic, static_cast<std::uint32_t>(quartics_.size() - 1)};
}

LimitPoint LimitEvaluator::evaluate(const Quartic& quartic, TriangleParameter at) {
  const double u = at.u, v = at.v, w = 1 - u - v;
  const double uu = u * u, vv = v * v, ww = w * w, uv = u * v;
  const std::array<double, 15> monomial{ww * ww,      ww * (w * u), ww * uu,      uu * (w * u), uu * uu,
                                        ww * (w * v), ww * uv,      uu * (w * v), uu * uv,      ww * vv,
                                        vv * (w * u), uu * vv,      vv * (w * v), vv * uv,      vv * vv};
  std::array<double, 4> sum{};
  for (std::size_t k = 0; k < 15; ++k) {
    for (std::size_t a = 0; a < 4; ++a) sum[a] += monomial[k] * quartic.weights[k][a];
  }
  return {{sum[0], sum[1], sum[2]}, quartic.error};
}

LimitPoint LimitEvaluator::operator()(TriangleParameter parameter) {
  SNUG_EXPECT(!inner_.empty());
  TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at); corner < 3) return corner_point(patch_, corner);
  Child child = inner_[0].children[0];
  if (patch_.kind->polynomial()) return evaluate(quartics_[child.place], at);
  std::uint32_t here = 0;
  while (true) {
    if (inner_[here].patch.path.level() >= PiecePath::max_level) {
      LimitPoint corner = corner_point(inner_[here].patch, 0);
      corner.error += net_size(inner_[here].patch);
      return corner;
    }
    const Descent step = descend(at);
    at = step.at;
    child = inner_[here].children[step.child];
    if (child.sort == Child::unknown) {
      const double drift = 2 * inner_[here].drift + (step.child == 3 ? unit_roundoff : 0);
      child = make(split(inner_[here].patch, step.child), drift);
      inner_[here].children[step.child] = child;
    }
    if (child.sort == Child::quartic) return evaluate(quartics_[child.place], at);
    here = child.place;
  }
}

void LimitEvaluator::operator()(std::span<const TriangleParameter> at, std::span<LimitPoint> out) {
  SNUG_EXPECT(out.size() == at.size());
  for (std::size_t i = 0; i < at.size(); ++i) out[i] = (*this)(at[i]);
}

std::size_t LimitEvaluator::bytes() const {
  std::size_t sum =
      sizeof(*this) + inner_.capacity() * sizeof(Inner) + quartics_.capacity() * sizeof(Quartic);
  sum += patch_.points.capacity() * sizeof(Vector3);
  for (const Inner& inner : inner_) sum += inner.patch.points.capacity() * sizeof(Vector3);
  return sum;
}

}  // namespace snug
