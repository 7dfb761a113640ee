#include <snug/shape/left_turn.h>

#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/shape/corner_rings.h>
#include <snug/shape/flat_patch.h>

namespace snug {
namespace {

// Levels that a piece is split to bound its coefficients.
constexpr unsigned polynomial_levels = 2;
// Of a net that stands for all further rings of a map that is conformal, against its size: more would hardly do.
constexpr double max_net_share = 0.02;
// A net, and its growths.
constexpr std::size_t max_nets = 3;

// An edge or a corner of a triangle.
struct Side {
  bool is_edge = true;
  unsigned which = 0;
  [[nodiscard]] std::uint8_t bit() const { return static_cast<std::uint8_t>((is_edge ? 1U : 8U) << which); }
};

// Differences along two edges of the parameters' triangle, by Bezier points.
struct FlatDerivatives {
  std::size_t count = 0;
  std::array<Point2, bezier_count(max_degree - 1)> u, v;
  std::array<std::uint8_t, bezier_count(max_degree - 1)>
      sides;  // of the kind that a point is on, as bits (Side)
  double largest = 0;
  double error = 0;  // of each number

  explicit FlatDerivatives(const FlatPolynomial& of) {
    for (std::size_t j = 0; j < of.degree; ++j) {
      for (std::size_t i = 0; i + j < of.degree; ++i) {
        const Point2 at = of.points[bezier_index(of.degree, i, j)];
        u[count] = of.points[bezier_index(of.degree, i + 1, j)] - at;
        v[count] = of.points[bezier_index(of.degree, i, j + 1)] - at;
        largest = std::max({largest, largest_of(u[count]), largest_of(v[count])});
        ++count;
      }
    }
    error = enlarged(2 * of.error + unit_roundoff * largest);
  }
  void find_sides(std::size_t degree) {
    std::size_t place = 0;
    for (std::size_t j = 0; j < degree; ++j) {
      for (std::size_t i = 0; i + j < degree; ++i, ++place) {
        const std::size_t k = degree - 1 - i - j;
        const unsigned on_edges = (j == 0 ? 1 : 0) | (k == 0 ? 2 : 0) | (i == 0 ? 4 : 0);
        const unsigned on_corners = (i + j == 0 ? 1 : 0) | (j + k == 0 ? 2 : 0) | (i + k == 0 ? 4 : 0);
        sides[place] = static_cast<std::uint8_t>(on_edges | on_corners << 3);
      }
    }
  }
  // From an edge of the kind, or a corner, into the patch.
  [[nodiscard]] Point2 into(std::size_t k, Side from) const {
    if (from.is_edge) return from.which == 0 ? v[k] : from.which == 1 ? Point2{} - u[k] : u[k] - v[k];
    return from.which == 0 ? u[k] : from.which == 1 ? v[k] - u[k] : Point2{} - v[k];
  }
};

// Which coefficients of a determinant: all but those of two points on a side, or these. Without a side: all.
struct Coefficients {
  std::uint8_t side = 0;  // as a bit
  bool on_it = false;
};

// Are coefficients of the determinant of the one's u and the other one's v, and the other way round, positive?
template <bool all>
bool turns_left(const FlatDerivatives& d, const FlatDerivatives& e, Coefficients which) {
  const double limit = enlarged(8 * (d.error * e.largest + e.error * d.largest + d.error * e.error) +
                                gamma_bound(8) * 8 * d.largest * e.largest);
  for (std::size_t k = 0; k < d.count; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      if (!all && ((d.sides[k] & d.sides[l] & which.side) != 0) != which.on_it) continue;
      const double both = cross(d.u[k], e.v[l]) + cross(d.u[l], e.v[k]);
      if (!(both + (cross(e.u[k], d.v[l]) + cross(e.u[l], d.v[k])) > limit)) return false;
    }
  }
  return true;
}
bool turns_left(const FlatDerivatives& d, const FlatDerivatives& e, Coefficients which) {
  return which.side == 0 ? turns_left<true>(d, e, which) : turns_left<false>(d, e, which);
}

// The end of a fan at an extraordinary corner: the Bezier points of the curve's derivative from there to some ring.
class FanEnd {
 public:
  FanEnd(const FlatCurve& curve, unsigned edge, bool leaves) : edge_(edge), leaves_(leaves) {
    double widest = 0;
    for (std::size_t t = 0; t < curve.degree; ++t) {
      along_.push_back(curve.points[t + 1] - curve.points[t]);
      widest = std::max(widest, largest_of(along_.back()));
    }
    error_ = enlarged(2 * curve.error + unit_roundoff * widest);
  }
  [[nodiscard]] unsigned edge() const { return edge_; }

  // To the next ring: the half at the corner.
  void descend() {
    if (!leaves_) std::reverse(along_.begin(), along_.end());
    double widest = 0;
    for (const Point2& p : along_) widest = std::max(widest, largest_of(p));
    for (std::size_t k = 1; k < along_.size(); ++k) {
      for (std::size_t t = along_.size() - 1; t >= k; --t) along_[t] = 0.5 * (along_[t - 1] + along_[t]);
    }
    if (!leaves_) std::reverse(along_.begin(), along_.end());
    error_ = enlarged(error_ + gamma_bound(2 * max_degree) * widest);
  }

  // Does the curve's direction turn left to all that leads from it into a piece: of a net, and of that and of what may be added to it
  // (CornerRings::all_further)? The piece has this side on the curve; nets are along these axes.
  [[nodiscard]] bool turns_left(std::span<const FlatDerivatives> nets, Side side,
                                const std::array<Point2, 2>& axes, double axis_off) const {
    for (const Point2& at : along_) {
      const Point2 direction{dot(axes[0], at), dot(axes[1], at)};
      const Point2 off{off_along(axes[0], at, axis_off), off_along(axes[1], at, axis_off)};
      for (std::size_t k = 0; k < nets[0].count; ++k) {
        if ((nets[0].sides[k] & side.bit()) == 0) continue;
        std::array<double, 3> least{};
        for (std::size_t n = 0; n < nets.size(); ++n) {
          const double far = 2 * nets[n].largest, off_across = 2 * nets[n].error + unit_roundoff * far;
          const double size = std::fabs(direction.x) + std::fabs(direction.y);
          least[n] = cross(direction, nets[n].into(k, side)) -
                     enlarged(size * off_across + (off.x + off.y) * (far + off_across) +
                              gamma_bound(8) * size * far);
        }
        // Of two growths the first one is added at most as often as the second one.
        if (!(least[0] > 0) || (nets.size() > 1 && !(least[nets.size() - 1] > 0))) return false;
        if (nets.size() > 2 && !(least[1] + least[2] > 0)) return false;
      }
    }
    return true;
  }

 private:
  [[nodiscard]] double off_along(Point2 axis, Point2 at, double axis_off) const {
    return enlarged((std::fabs(axis.x) + std::fabs(axis.y)) * (1 + 2 * axis_off) *
                    (error_ + (2 * axis_off + gamma_bound(3)) * largest_of(at)));
  }

  unsigned edge_;
  bool leaves_;
  std::vector<Point2> along_;
  double error_ = 0;  // of each number
};

// A side of a patch that is on the end of a fan.
struct AtEnd {
  const FanEnd* end = nullptr;
  Side side;
  // Of a child.
  [[nodiscard]] AtEnd of(unsigned child) const {
    const unsigned k = side.which;
    if (end == nullptr) return {};
    if (side.is_edge) {
      if (child == k || child == (k + 1) % 3) return *this;
      // The middle one has the middle of the edge.
      return child == 3 ? AtEnd{end, {false, (k + 2) % 3}} : AtEnd{};
    }
    return child == k ? *this : AtEnd{};
  }
};

class LeftTurn {
 public:
  // Of the first net, and of all that rings add to it (CornerRings::all_further).
  bool holds(std::span<const Patch> nets, unsigned levels, const AtEnd& at) {
    const Patch& patch = nets[0];
    if (patch.kind->polynomial() && coefficients_hold(nets, at)) return true;
    if (levels == 0) return false;
    if (const RingDecay* tip = decay_of(*patch.kind))
      return nets.size() == 1 && LeftTurn{}.tip_holds(*tip, patch, levels - 1);
    for (unsigned child = 0; child < 4; ++child) {
      if (!child_holds(nets, child, levels - 1, at)) return false;
    }
    return true;
  }

  // Of a patch at a spike that it is seen along.
  bool holds_around_spike(const Patch& patch, unsigned corner, unsigned levels) {
    if (levels == 0) return false;
    if (const RingDecay* tip = decay_across_spike(*patch.kind))
      return corner_of(*tip, patch) == corner && tip_holds(*tip, patch, levels - 1);
    for (unsigned child = 0; child < 4; ++child) {
      if (!(child == corner ? holds_around_spike(split(patch, child), corner, levels - 1)
                            : child_holds({&patch, 1}, child, levels - 1, {})))
        return false;
    }
    return true;
  }

 private:
  bool child_holds(std::span<const Patch> nets, unsigned child, unsigned levels, const AtEnd& at) {
    std::array<Patch, max_nets> pieces;
    for (std::size_t n = 0; n < nets.size(); ++n) split(nets[n], child, pieces[n]);
    if (pieces[0].kind->polynomial()) levels = std::min(levels, polynomial_levels);
    return holds(std::span(pieces).first(nets.size()), levels, at.of(child));
  }

  bool tip_holds(const RingDecay& tip, const Patch& patch, unsigned levels) {
    const unsigned corner = corner_of(tip, patch);
    std::vector<FanEnd> ends;
    for (const unsigned edge : {corner, (corner + 2) % 3}) {
      if (const auto curve = curve_at_end_of_fan(patch, corner, edge))
        ends.emplace_back(*curve, edge, edge == corner);
    }
    const auto ring_holds = [&](std::span<const Patch> nets) {
      for (unsigned child = 0; child < 4; ++child) {
        if (child == corner) continue;
        // Not at both, but where the fan is one face: then at the last one of them, which is no loss.
        AtEnd at;
        for (const FanEnd& end : ends) {
          const AtEnd whole{&end, {true, end.edge()}};
          if (whole.of(child).end != nullptr) at = whole;
        }
        if (!child_holds(nets, child, levels, at)) return false;
      }
      return true;
    };
    const CornerRings rings(tip, patch);
    std::size_t at_once = 1;
    for (std::size_t ring = 0; ring < std::min(rings.count(), max_single_rings); ring += at_once) {
      const std::vector<Patch> further = rings.all_further(ring);
      const bool may_hold = further.size() > 1 || further[0].error < max_net_share * further[0].largest;
      chain_turns_ = tip.links > 1;
      axes_ = rings.axes(ring);
      axis_off_ = rings.axis_off();
      if (may_hold && ring_holds(further)) return true;
      at_once = std::min(2 * at_once, rings.rings_at_once(ring));
      for (;; at_once /= 2) {
        const Patch net = rings.net(ring, at_once);
        if (ring_holds({&net, 1})) break;
        if (at_once == 1) return false;
      }
      for (std::size_t k = 0; k < at_once; ++k) {
        for (FanEnd& end : ends) end.descend();
      }
    }
    return false;
  }

  bool coefficients_hold(std::span<const Patch> nets, const AtEnd& at) const {
    const BezierRows& form = nets[0].kind->form();
    for (std::size_t part = 0; part < form.parts; ++part) {
      if (nets.size() == 1 && at.end == nullptr) {
        const FlatDerivatives d(polynomial_of(nets[0], part));
        if (!turns_left(d, d, {})) return false;
        continue;
      }
      std::vector<FlatDerivatives> d;
      for (const Patch& net : nets) {
        d.emplace_back(polynomial_of(net, part));
        d.back().find_sides(form.degree);
      }
      if (at.end == nullptr || form.parts > 1) {
        if (!all_turn_left(d, {})) return false;
        continue;
      }
      const Side own{at.side.is_edge, static_cast<unsigned>(nets[0].to_kind(at.side.which))};
      if (!all_turn_left(d, {own.bit(), false})) return false;
      if (!all_turn_left(d, {own.bit(), true}) && !at.end->turns_left(d, own, axes_, axis_off_)) return false;
    }
    return true;
  }

  // Of a growth alone, which is one vector times numbers, the determinant is 0; but not of a chain of more than one link.
  bool all_turn_left(std::span<const FlatDerivatives> nets, Coefficients which) const {
    for (std::size_t a = 0; a < nets.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) {
        if (a == b && a > 0 && !(a == 1 && chain_turns_)) continue;
        if (!turns_left(nets[a], nets[b], which)) return false;
      }
    }
    return true;
  }

  bool chain_turns_ = false;
  std::array<Point2, 2> axes_{};  // of the tip's nets
  double axis_off_ = 0;
};

}  // namespace

bool turns_left_everywhere(const Patch& patch) {
  return LeftTurn{}.holds({&patch, 1}, patch.kind->polynomial() ? 1 : corner_levels, {});
}

bool turns_left_around_spike(const Patch& patch, unsigned corner) {
  return LeftTurn{}.holds_around_spike(patch, corner, corner_levels);
}

}  // namespace snug
