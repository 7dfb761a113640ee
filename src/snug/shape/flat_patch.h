#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

#include <snug/patch/patch.h>
#include <snug/scheme/bezier.h>
#include <snug/shape/point2.h>
#include <snug/shape/ring_decay.h>

/// Patches in the plane, with z = 0.
namespace snug {

/// Levels that a patch is split to come to polynomials and to extraordinary corners.
inline constexpr unsigned corner_levels = 6;
/// Rings at an extraordinary corner that are looked at one by one, or some at once.
inline constexpr std::size_t max_single_rings = 2000;

inline double largest_of(Point2 a) { return std::max(std::fabs(a.x), std::fabs(a.y)); }

/// One of the polynomials of a patch.
struct FlatPolynomial {
  std::size_t degree;
  std::array<Point2, bezier_count(max_degree)> points;
  double error;  ///< of each number
};
[[nodiscard]] FlatPolynomial polynomial_of(const Patch& patch, std::size_t part);

struct FlatCurve {
  std::size_t degree;
  std::array<Point2, max_degree + 1> points;
  double error;  ///< of each number
};

/// visit(curve) of each polynomial along an edge of a polynomial patch, from a corner to the next one, until one is false.
/// Of a patch of two parts, 0, 1, m and m, 1, 2, the edge 20 runs through m.
template <class Visit>
bool each_curve(const Patch& patch, unsigned edge, const Visit& visit) {
  const std::size_t own = patch.to_kind(edge), parts = patch.kind->form().parts;
  const auto part_holds = [&](std::size_t part) {
    const FlatPolynomial all = polynomial_of(patch, part);
    FlatCurve curve{all.degree, {}, all.error};
    for (std::size_t t = 0; t <= all.degree; ++t) {
      curve.points[t] = all.points[own == 0   ? bezier_index(all.degree, t, 0)
                                   : own == 1 ? bezier_index(all.degree, all.degree - t, t)
                                              : bezier_index(all.degree, 0, all.degree - t)];
    }
    return visit(curve);
  };
  if (parts == 1 || own == 0) return part_holds(0);
  return part_holds(1) && (own == 1 || part_holds(0));
}

/// How nets change at the extraordinary corner where the patch's kind comes again; null where there is none.
[[nodiscard]] const RingDecay* decay_of(const Kind& kind);
/// The same of a spike that is seen along (make_spike_decay).
[[nodiscard]] const RingDecay* decay_across_spike(const Kind& kind);
[[nodiscard]] inline unsigned corner_of(const RingDecay& tip, const Patch& patch) {
  return static_cast<unsigned>((tip.corner + patch.first) % 3);
}

/// An edge that the fan at an extraordinary corner ends with: of a boundary, or of a crease. It is one polynomial; none where the edge is
/// another one, or has another such corner.
/// Source:    derivations/self_contact.md, "Borders".
[[nodiscard]] bool ends_fan(const Patch& patch, unsigned corner, unsigned edge);
[[nodiscard]] std::optional<FlatCurve> curve_at_end_of_fan(const Patch& patch, unsigned corner,
                                                           unsigned edge);

}  // namespace snug
