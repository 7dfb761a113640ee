#include <experiments/limit_evaluator.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/descent.h>

namespace snug {
namespace {

// Where the kind counts the Bezier point that the patch counts as u^i v^j.
std::size_t kind_index(const Patch& patch, std::size_t degree, std::size_t i, std::size_t j) {
  const std::array<std::size_t, 3> powers{degree - i - j, i, j};
  std::array<std::size_t, 3> kind_powers;
  for (std::size_t corner = 0; corner < 3; ++corner) kind_powers[patch.to_kind(corner)] = powers[corner];
  return bezier_index(degree, kind_powers[1], kind_powers[2]);
}

template <std::size_t degree>
std::array<double, 4> sum_of(const std::array<double, 4>* weights, double u, double v) {
  std::array<double, bezier_count(degree)> powers;
  monomials<degree>(1 - u - v, u, v, powers.data());
  std::array<double, 4> sum{};
  for (const double power : powers) {
    for (std::size_t a = 0; a < 4; ++a) sum[a] += power * (*weights)[a];
    ++weights;
  }
  return sum;
}

}  // namespace

void LimitEvaluator::reset(const Patch& patch) {
  inner_.clear();
  polynomials_.clear();
  weights_.clear();
  patch_ = patch;
  inner_.push_back({patch, 0, {}});
  if (patch.kind->polynomial()) inner_[0].children[0] = make(Patch(patch), 0);
}

LimitEvaluator::Child LimitEvaluator::make(Patch&& piece, double drift) {
  if (!piece.kind->polynomial()) {
    inner_.push_back({std::move(piece), drift, {}});
    return {Child::inner, static_cast<std::uint32_t>(inner_.size() - 1)};
  }
  const PolynomialForm& form = piece.kind->form();
  SNUG_EXPECT(form.parts == 1 || piece.first == 0);
  const std::size_t d = form.degree, count = bezier_count(d);
  Polynomial polynomial{static_cast<std::uint32_t>(weights_.size()), static_cast<std::uint16_t>(d),
                        static_cast<std::uint16_t>(form.parts), 0};
  double largest = 0;
  for (std::size_t part = 0; part < form.parts; ++part) {
    for (std::size_t j = 0; j <= d; ++j) {
      for (std::size_t i = 0; i + j <= d; ++i) {
        const double factor = multinomial(d, bezier_index(d, i, j));
        const Vector3 p = form.rows.apply<Vector3>(part * count + kind_index(piece, d, i, j), piece.points);
        largest = std::max(largest, max_abs(p));
        weights_.push_back({factor * p.x, factor * p.y, factor * p.z, 0});
      }
    }
  }
  // Monomials, their products with the weights and the sum: at most 3 degree + 28 roundings. w = 1 - u - v is
  // off by 2 u, and the parameters by `drift`, in a part by four times that and 8 u more; the derivative is
  // the degree times a difference of Bezier points.
  const double off = form.parts == 1 ? drift + 2 * unit_roundoff : 4 * drift + 10 * unit_roundoff;
  polynomial.error = enlarged((gamma_bound(3 * d + 32) + 4 * static_cast<double>(d) * off) * largest +
                              form.rows.result_error(piece.largest, piece.error) + 64 * underflow_error);
  polynomials_.push_back(polynomial);
  return {Child::polynomial, static_cast<std::uint32_t>(polynomials_.size() - 1)};
}

LimitPoint LimitEvaluator::evaluate(const Polynomial& polynomial, TriangleParameter at) const {
  const std::array<double, 4>* weights = weights_.data() + polynomial.first;
  double u = at.u, v = at.v;
  if (polynomial.parts == 2) {  // as in evaluate.cpp
    const double w = std::fmax(0.0, 1 - u - v);
    if (v <= w) {
      v = 2 * v;
    } else {
      v = v - w;
      weights += bezier_count(polynomial.degree);
    }
  }
  const std::array<double, 4> sum =
      with_degree(polynomial.degree, [&](auto degree) { return sum_of<degree>(weights, u, v); });
  return {{sum[0], sum[1], sum[2]}, polynomial.error};
}

LimitPoint LimitEvaluator::operator()(TriangleParameter parameter) {
  require_value(!inner_.empty(), "limit evaluator: it has no patch; call reset() first");
  TriangleParameter at = checked(parameter);
  if (const std::size_t corner = corner_at(at); corner < 3) return corner_point(patch_, corner);
  Child child = inner_[0].children[0];
  if (patch_.kind->polynomial()) return evaluate(polynomials_[child.place], at);
  std::uint32_t here = 0;
  while (true) {
    if (inner_[here].patch.path.level() >= PiecePath::max_level) return stopped_point(inner_[here].patch);
    const Descent step = descend(at);
    at = step.at;
    child = inner_[here].children[step.child];
    if (child.sort == Child::unknown) {
      const double drift = 2 * inner_[here].drift + (step.child == 3 ? unit_roundoff : 0);
      child = make(split(inner_[here].patch, step.child), drift);
      inner_[here].children[step.child] = child;
    }
    if (child.sort == Child::polynomial) return evaluate(polynomials_[child.place], at);
    here = child.place;
  }
}

void LimitEvaluator::operator()(std::span<const TriangleParameter> at, std::span<LimitPoint> out) {
  require_value(out.size() == at.size(),
                "limit evaluator: there must be room for as many points as parameters");
  for (std::size_t i = 0; i < at.size(); ++i) out[i] = (*this)(at[i]);
}

std::size_t LimitEvaluator::bytes() const {
  std::size_t sum = sizeof(*this) + inner_.capacity() * sizeof(Inner) +
                    polynomials_.capacity() * sizeof(Polynomial) + weights_.capacity() * sizeof(weights_[0]);
  sum += patch_.points.capacity() * sizeof(Vector3);
  for (const Inner& inner : inner_) sum += inner.patch.points.capacity() * sizeof(Vector3);
  return sum;
}

}  // namespace snug
