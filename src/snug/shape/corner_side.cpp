#include <snug/shape/corner_side.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/shape/corner_rings.h>
#include <snug/shape/flat_patch.h>

namespace snug {
namespace {

// Levels that a piece away from the corner, and that a piece of a ring is split.
constexpr unsigned far_levels = 2, ring_levels = 2;
// A net and its growths.
constexpr std::size_t max_nets = 3;

// Which edges and corners of a patch have values that are known to be positive.
struct Known {
  std::uint8_t edges = 0, corners = 0;

  [[nodiscard]] Known of_child(unsigned child) const {
    Known own;
    for (unsigned k = 0; k < 3; ++k) {
      const auto bit = [](unsigned which) { return static_cast<std::uint8_t>(1U << which); };
      if ((edges & bit(k)) != 0) {
        if (child == k || child == (k + 1) % 3) own.edges |= bit(k);
        // The middle one has the middle of the edge.
        if (child == 3) own.corners |= bit((k + 2) % 3);
      }
      if ((corners & bit(k)) != 0 && child == k) own.corners |= bit(k);
    }
    return own;
  }
  // Of a Bezier point of the kind's triangle.
  [[nodiscard]] bool has(const Patch& patch, std::size_t degree, std::size_t i, std::size_t j) const {
    const std::array<std::size_t, 3> weight{degree - i - j, i, j};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t own = patch.to_kind(k);
      if ((edges & (1U << k)) != 0 && weight[(own + 2) % 3] == 0) return true;
      if ((corners & (1U << k)) != 0 && weight[own] == degree) return true;
    }
    return false;
  }
};

// Of nets that stand for all further ones (CornerRings::all_further), in two coefficients or more: is any such one positive?
bool all_positive(std::span<const double> coefficients, std::span<const double> errors) {
  std::array<double, max_nets> least{};
  for (std::size_t n = 0; n < coefficients.size(); ++n) least[n] = coefficients[n] - errors[n];
  const std::size_t last = coefficients.size() - 1;
  // Of two growths the first one is added at most as often as the second one.
  const double rounding = gamma_bound(4) * (std::fabs(least[1]) + std::fabs(least[2]));
  return least[0] > 0 && least[last] > 0 && (last < 2 || least[1] + least[2] > rounding);
}

bool are_positive(std::span<const Patch> nets, unsigned levels, Known known) {
  if (nets[0].kind->polynomial()) {
    const BezierRows& form = nets[0].kind->form();
    bool hold = true;
    for (std::size_t part = 0; hold && part < form.parts; ++part) {
      std::vector<FlatPolynomial> of;
      for (const Patch& net : nets) of.push_back(polynomial_of(net, part));
      const Known own = form.parts == 1 ? known : Known{};
      for (std::size_t j = 0; hold && j <= form.degree; ++j) {
        for (std::size_t i = 0; hold && i + j <= form.degree; ++i) {
          if (own.has(nets[0], form.degree, i, j)) continue;
          std::array<double, max_nets> value{}, error{};
          for (std::size_t n = 0; n < of.size(); ++n) {
            value[n] = of[n].points[bezier_index(form.degree, i, j)].x;
            error[n] = of[n].error;
          }
          hold = all_positive(std::span(value).first(of.size()), std::span(error).first(of.size()));
        }
      }
    }
    if (hold) return true;
  } else if (nets.size() == 1) {
    // Points are means of control points.
    const auto least = std::min_element(nets[0].points.begin(), nets[0].points.end(),
                                        [](const Vector3& a, const Vector3& b) { return a.x < b.x; });
    if (least->x > nets[0].error) return true;
  }
  if (levels == 0) return false;
  for (unsigned child = 0; child < 4; ++child) {
    std::array<Patch, max_nets> pieces;
    for (std::size_t n = 0; n < nets.size(); ++n) split(nets[n], child, pieces[n]);
    if (!are_positive(std::span(pieces).first(nets.size()), levels - 1, known.of_child(child))) return false;
  }
  return true;
}

class CornerSide {
 public:
  explicit CornerSide(unsigned corner) : corner_(corner) {}

  [[nodiscard]] bool holds(const Patch& patch, unsigned levels) const {
    if (patch.kind->polynomial()) {
      Known known;
      known.corners = static_cast<std::uint8_t>(1U << corner_);
      return are_positive({&patch, 1}, far_levels, known);
    }
    if (levels == 0) return false;
    if (const RingDecay* const tip = decay_of(*patch.kind)) {
      if (corner_of(*tip, patch) == corner_) return rings_hold(*tip, patch);
    }
    for (unsigned child = 0; child < 4; ++child) {
      const Patch piece = split(patch, child);
      if (!(child == corner_ ? holds(piece, levels - 1) : are_positive({&piece, 1}, far_levels, {})))
        return false;
    }
    return true;
  }

 private:
  // The end of a fan is one polynomial, for all rings.
  [[nodiscard]] bool end_holds(const Patch& patch, unsigned edge, Known& known) const {
    const std::optional<FlatCurve> curve = curve_at_end_of_fan(patch, corner_, edge);
    if (!curve) return true;
    known.edges |= static_cast<std::uint8_t>(1U << edge);
    const bool leaves = edge == corner_;
    for (std::size_t k = 1; k <= curve->degree; ++k) {
      if (!(curve->points[leaves ? k : curve->degree - k].x > curve->error)) return false;
    }
    return true;
  }

  [[nodiscard]] bool rings_hold(const RingDecay& tip, const Patch& patch) const {
    Known known;
    if (!end_holds(patch, corner_, known) || !end_holds(patch, (corner_ + 2) % 3, known)) return false;
    // It stays in place, so it is one control point, of value 0.
    const Stencils::Row vertex = patch.kind->corner_limits().row(patch.to_kind(corner_));
    if (vertex.sources.size() != 1) return false;
    const CornerRings rings(tip, patch);
    // What grows does so along the second axis.
    const double along = tip.larger ? rings.axes(0)[1].x : 0;
    if (tip.larger && along == 0) return false;
    const auto ring_holds = [&](const std::vector<Patch>& nets) {
      for (unsigned child = 0; child < 4; ++child) {
        if (child == corner_) continue;
        std::vector<Patch> pieces;
        for (const Patch& net : nets)
          pieces.push_back(split(from_vertex(net, vertex.sources[0], along), child));
        if (!are_positive(pieces, ring_levels, known.of_child(child))) return false;
      }
      return true;
    };
    for (std::size_t ring = 0; ring < std::min(rings.count(), max_single_rings); ++ring) {
      if (ring_holds(rings.all_further(ring))) return true;
      if (!ring_holds({rings.net(ring)})) return false;
    }
    return false;
  }

  // Nets are known up to constants: their values less the vertex's, which is the same point of each; along the second axis, if that is not
  // across them.
  [[nodiscard]] static Patch from_vertex(Patch net, std::size_t vertex, double along) {
    const auto value = [&](const Vector3& p) { return along == 0 ? p.x : along > 0 ? p.y : -p.y; };
    const double at_vertex = value(net.points[vertex]);
    net.largest = 0;
    for (Vector3& p : net.points) {
      p = {value(p) - at_vertex, 0, 0};
      net.largest = std::max(net.largest, std::fabs(p.x));
    }
    net.error = enlarged(2 * net.error + unit_roundoff * net.largest);
    return net;
  }

  unsigned corner_;
};

}  // namespace

bool certainly_positive_but_at_corner(const Patch& values, unsigned corner) {
  return CornerSide(corner).holds(values, corner_levels);
}

}  // namespace snug
