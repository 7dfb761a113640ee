#include <snug/shape/flat_patch.h>

#include <snug/geometry/rounding.h>
#include <snug/shape/corner_asymptotics.h>

namespace snug {

FlatPolynomial polynomial_of(const Patch& patch, std::size_t part) {
  const BezierRows& form = patch.kind->form();
  const std::size_t count = bezier_count(form.degree);
  FlatPolynomial result{form.degree, {}, form.rows.result_error(patch.largest, patch.error)};
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 p = form.rows.apply<Vector3>(part * count + i, patch.points);
    result.points[i] = {p.x, p.y};
  }
  return result;
}

const RingDecay* decay_of(const Kind& kind) {
  return kind.polynomial() ? nullptr : asymptotics_of(kind).ring_decay();
}

const RingDecay* decay_across_spike(const Kind& kind) {
  return kind.polynomial() ? nullptr : asymptotics_of(kind).spike_decay();
}

bool ends_fan(const Patch& patch, unsigned corner, unsigned edge) {
  const CornerFan& fan = patch.kind->corner(patch.to_kind(corner));
  // Not the line through a quad that its halves share.
  const bool of_face = patch.kind->rules().triangular() || patch.to_kind(edge) != 2;
  const bool at_corner = corner == edge || corner == (edge + 1) % 3;
  return at_corner && !fan.closed && (!fan.odd || fan.sharp) && of_face &&
         (corner == edge ? fan.before : fan.after) == 0;
}

// Continues its half that is away from the corner.
std::optional<FlatCurve> curve_at_end_of_fan(const Patch& patch, unsigned corner, unsigned edge) {
  if (!ends_fan(patch, corner, edge)) return std::nullopt;
  const Patch half = split(patch, corner == edge ? (edge + 1) % 3 : edge);
  if (!half.kind->polynomial() || half.kind->form().parts != 1) return std::nullopt;
  FlatCurve whole;
  each_curve(half, edge, [&](const FlatCurve& curve) {
    whole = curve;
    return true;
  });
  const auto end = [&] { return whole.points.begin() + static_cast<std::ptrdiff_t>(whole.degree) + 1; };
  if (corner == edge) std::reverse(whole.points.begin(), end());
  // Point k of the whole curve from the far corner is the half's polar form at 0 and 2.
  std::array<Point2, max_degree + 1> row = whole.points;
  for (std::size_t k = 1; k <= whole.degree; ++k) {
    for (std::size_t t = whole.degree; t >= k; --t) row[t] = 2 * row[t] - row[t - 1];
  }
  double largest = 0;
  for (std::size_t t = 0; t <= whole.degree; ++t) largest = std::max(largest, largest_of(whole.points[t]));
  const double grown = std::pow(3.0, static_cast<double>(whole.degree));
  whole.error = enlarged(grown * (whole.error + gamma_bound(3 * max_degree) * largest));
  whole.points = row;
  if (corner == edge) std::reverse(whole.points.begin(), end());
  return whole;
}

}  // namespace snug
