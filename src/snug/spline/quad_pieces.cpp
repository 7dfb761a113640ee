#include <snug/spline/quad_pieces.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

#include <snug/geometry/rounding.h>

namespace snug {

/// A net of a tip, and the part of the tip that it is of.
struct PartNet {
  ControlNet net;
  ParameterBox box;
};

namespace {

// Splits of a tip until the pieces at its corner are polynomials, or the corner is taken to be extraordinary.
constexpr unsigned jet_splits = 8;
// Of a tip whose distance is bounded, until what is left is small.
constexpr unsigned bound_splits = 40, most_bound_pieces = 4096;

constexpr std::array<std::array<std::size_t, 2>, 4> corner_places{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

QuadPiece quarter_of(const QuadPiece& whole, std::size_t k) {
  const auto [x, y] = corner_places[k];
  QuadPiece quarter;
  quarter.level = whole.level + 1;
  quarter.i = 2 * whole.i + static_cast<std::uint32_t>(x);
  quarter.j = 2 * whole.j + static_cast<std::uint32_t>(y);
  return quarter;
}

// Position and derivatives in the parameters of a net's piece, where pieces some levels down are polynomial at this corner.
std::optional<CornerJet> jet_at(ControlNet net, std::size_t corner, std::size_t degree) {
  double scale = 1;
  for (unsigned k = 0; k < jet_splits; ++k) {
    const NetQuarters quarters(net);
    scale *= 2;
    if (!quarters.regular(corner)) {
      net = quarters.net(corner);
      continue;
    }
    const auto [x, y] = corner_places[corner];
    CornerJet jet = corner_jet(bezier_on(tensor_piece(quarters.lattice(corner), degree), {}), x, y);
    jet.along_u = scale * jet.along_u;
    jet.along_v = scale * jet.along_v;
    jet.twist = (scale * scale) * jet.twist;
    return jet;
  }
  return {};
}

// The Bezier points of a tip, corner by corner, and by what it passes through where corners are extraordinary.
class TipFit {
 public:
  /// Nets: of one row or column of parts that cover the tip.
  TipFit(std::span<const PartNet> nets, const ParameterBox& box, std::size_t degree,
         LimitEvaluator& evaluator)
      : box_(box), evaluator_(evaluator) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [x, y] = corner_places[k];
      const PartNet& part = *std::find_if(nets.begin(), nets.end(), [x = x, y = y](const PartNet& p) {
        return (x == 0 ? p.box.u0 == 0 : p.box.u1 == 1) && (y == 0 ? p.box.v0 == 0 : p.box.v1 == 1);
      });
      if (const auto jet = jet_at(part.net, k, degree)) {
        known_[k] = true;
        const double su = (x == 0 ? 1.0 / 3 : -1.0 / 3) / (part.box.u1 - part.box.u0);
        const double sv = (y == 0 ? 1.0 / 3 : -1.0 / 3) / (part.box.v1 - part.box.v0);
        point(k, 0, 0) = jet->point;
        point(k, 1, 0) = jet->point + su * jet->along_u;
        point(k, 0, 1) = jet->point + sv * jet->along_v;
        point(k, 1, 1) = point(k, 1, 0) + sv * jet->along_v + (su * sv) * jet->twist;
      } else {
        point(k, 0, 0) = limit(static_cast<double>(x), static_cast<double>(y));
      }
    }
    for (std::size_t k = 0; k < 4; ++k) fit_side(k);
    fit_inside();
    take_largest(bezier_);
  }
  [[nodiscard]] const TensorPiece& bezier() const { return bezier_; }

 private:
  // The Bezier point so many steps from corner k along u, and along v.
  Vector3& point(std::size_t k, std::size_t along_u, std::size_t along_v) {
    const auto [x, y] = corner_places[k];
    return bezier_.at(x == 0 ? along_u : 3 - along_u, y == 0 ? along_v : 3 - along_v);
  }
  [[nodiscard]] Place place(double u, double v) const {
    return {0, 0, box_.u0 + (box_.u1 - box_.u0) * u, box_.v0 + (box_.v1 - box_.v0) * v};
  }
  [[nodiscard]] Vector3 limit(double u, double v) { return evaluator_.frame(place(u, v)).point.relative; }

  // Handles at extraordinary corners of a side: through one or two limit points, then onto the tangent planes.
  void fit_side(std::size_t k) {
    const std::size_t l = (k + 1) % 4;
    if (known_[k] && known_[l]) return;
    const std::array<std::size_t, 2>&from = corner_places[k], &to = corner_places[l];
    const bool along_u = from[1] == to[1];
    const auto on_side = [&](double t) {
      const auto between = [&](std::size_t axis) {
        return static_cast<double>(from[axis]) * (1 - t) + static_cast<double>(to[axis]) * t;
      };
      return limit(between(0), between(1));
    };
    const Vector3 a = point(k, 0, 0), b = point(l, 0, 0);
    Vector3 &from_a = along_u ? point(k, 1, 0) : point(k, 0, 1),
            &from_b = along_u ? point(l, 1, 0) : point(l, 0, 1);
    if (!known_[k] && !known_[l]) {
      const Vector3 p = 27.0 * on_side(1.0 / 3) - 8.0 * a - b, q = 27.0 * on_side(2.0 / 3) - a - 8.0 * b;
      from_a = (1.0 / 18) * (2.0 * p - q);
      from_b = (1.0 / 18) * (2.0 * q - p);
    } else {
      const Vector3 rest = 8.0 * on_side(0.5) - a - b;
      if (known_[l]) from_a = (1.0 / 3) * rest - from_b;
      if (known_[k]) from_b = (1.0 / 3) * rest - from_a;
    }
    for (const std::size_t end : {k, l}) {
      if (known_[end]) continue;
      const auto [ex, ey] = corner_places[end];
      const auto normal = evaluator_.frame(place(static_cast<double>(ex), static_cast<double>(ey))).normal;
      Vector3& handle = end == k ? from_a : from_b;
      if (normal) handle = handle - dot(*normal, handle - point(end, 0, 0)) * *normal;
    }
  }

  // A point beside an extraordinary corner: such that the middle is the surface's; of more than one corner without a twist.
  void fit_inside() {
    const auto unknown = static_cast<std::size_t>(std::count(known_.begin(), known_.end(), false));
    for (std::size_t k = 0; k < 4; ++k) {
      if (!known_[k]) point(k, 1, 1) = point(k, 1, 0) + point(k, 0, 1) - point(k, 0, 0);
    }
    if (unknown != 1) return;
    const auto k = static_cast<std::size_t>(std::find(known_.begin(), known_.end(), false) - known_.begin());
    const Vector3 off = limit(0.5, 0.5) - value(bezier_, 0.5, 0.5);
    point(k, 1, 1) = point(k, 1, 1) + (64.0 / 9) * off;
  }

  ParameterBox box_;
  LimitEvaluator& evaluator_;
  std::array<bool, 4> known_{};
  TensorPiece bezier_ = bezier_piece(TensorPiece::max_degree);
};

// Both lie in the hulls of their points.
double hull_distance(const ControlNet& net, const TensorPiece& bezier) {
  double largest = 0;
  for (const kernels::NetPoint& p : net.points) {
    const Vector3 point{p[0], p[1], p[2]};
    for (std::size_t i = 0; i < bezier.count(); ++i)
      largest = std::max(largest, length_sq(point - bezier.points[i]));
  }
  const double rounding = net.error + bezier.error + unit_roundoff * (net.largest + bezier.largest);
  return enlarged(enlarged(std::sqrt(enlarged(largest))) + spatial_error(rounding));
}

double tip_distance(std::span<const PartNet> nets, const TensorPiece& bezier, std::size_t degree) {
  struct Part {
    ControlNet net;
    TensorPiece bezier;
    double bound;
    unsigned level;
  };
  const auto farther = [](const Part& a, const Part& b) { return a.bound < b.bound; };
  std::vector<Part> parts;
  const auto add = [&](ControlNet net, const TensorPiece& here, unsigned level) {
    const double bound = hull_distance(net, here);
    parts.push_back({std::move(net), here, bound, level});
    std::push_heap(parts.begin(), parts.end(), farther);
  };
  for (const PartNet& part : nets) add(part.net, bezier_on(bezier, part.box), 0);
  double largest = 0;  // of what is polynomial
  for (unsigned steps = 0; !parts.empty() && parts.front().bound > largest; ++steps) {
    if (steps == most_bound_pieces || parts.front().level >= bound_splits) return parts.front().bound;
    std::pop_heap(parts.begin(), parts.end(), farther);
    const Part part = std::move(parts.back());
    parts.pop_back();
    const NetQuarters quarters(part.net);
    for (std::size_t k = 0; k < 4; ++k) {
      const double u = 0.5 * static_cast<double>(corner_places[k][0]),
                   v = 0.5 * static_cast<double>(corner_places[k][1]);
      const TensorPiece here = bezier_on(part.bezier, {u, u + 0.5, v, v + 0.5});
      if (quarters.regular(k)) {
        const TensorPiece exact = raised(bezier_on(tensor_piece(quarters.lattice(k), degree), {}));
        largest = std::max(largest, distance_bound(exact, here));
      } else {
        add(quarters.net(k), here, part.level + 1);
      }
    }
  }
  return largest;
}

// Bezier points over two parts side by side, each of the nearer one.
TensorPiece joined(const TensorPiece& a, const TensorPiece& b, bool along_u) {
  const std::size_t d = a.degree;
  TensorPiece both = bezier_piece(d);
  for (std::size_t j = 0; j <= d; ++j) {
    for (std::size_t i = 0; i <= d; ++i) {
      const std::size_t along = along_u ? i : j, across = along_u ? j : i;
      const bool first = 2 * along <= d;
      std::array<double, TensorPiece::max_degree> there{}, other{};
      for (std::size_t k = 0; k < d; ++k) {
        const double t = k < d - along ? 0 : 2;
        there[k] = first ? t : t - 1;
        other[k] = k < d - across ? 0 : 1;
      }
      const std::span<const double> p(there.data(), d), q(other.data(), d);
      both.at(i, j) = blossom(first ? a : b, along_u ? p : q, along_u ? q : p);
    }
  }
  take_largest(both);
  return both;
}

// The halves of what is over two parts.
ParameterBox half_box(std::size_t k, bool along_u) {
  const double low = 0.5 * static_cast<double>(k);
  return along_u ? ParameterBox{low, low + 0.5, 0, 1} : ParameterBox{0, 1, low, low + 0.5};
}

// Does a tip go on along its sides as the two did that it stands for? Up to rounding.
bool same_sides(const TensorPiece& whole, const TensorPiece& a, const TensorPiece& b, bool along_u) {
  const double tolerance = 0x1p-40 * whole.largest;
  for (std::size_t k = 0; k < 2; ++k) {
    const TensorPiece half = bezier_on(whole, half_box(k, along_u));
    const TensorPiece& part = k == 0 ? a : b;
    for (std::size_t i = 0; i <= part.degree; ++i) {
      for (const std::size_t side : {std::size_t{0}, part.degree}) {
        const std::size_t x = along_u ? i : side, y = along_u ? side : i;
        if (max_abs(half.at(x, y) - part.at(x, y)) > tolerance) return false;
      }
    }
  }
  return true;
}

}  // namespace

unsigned QuadPiece::corners() const {
  unsigned bits = 0;
  for (unsigned k = 0; k < 4; ++k) {
    const unsigned both = (1u << k) | (1u << ((k + 3) % 4));
    if ((sides() & both) == both) bits |= 1u << k;
  }
  return bits;
}

unsigned QuadPiece::sides() const {
  const std::uint64_t end = std::uint64_t{1} << level;
  return (j == 0 ? 1u : 0u) | (i + columns == end ? 2u : 0u) | (j + rows == end ? 4u : 0u) |
         (i == 0 ? 8u : 0u);
}

// A piece in the making, with the nets of a tip.
struct QuadPieces::Draft {
  QuadPiece piece;
  std::vector<PartNet> nets;
};

QuadPieces::QuadPieces(const Patch& patch, const QuadDepths& depths, double error)
    : depths_(depths), error_(error), evaluator_(patch), degree_(tensor_degree(patch.kind->rules().basis)) {
  open(control_net(patch), {});
  for (Draft& draft : drafts_) {
    if (drafts_.size() == 1) break;  // a lattice, by which faces are packed
    TensorPiece& piece = draft.piece.piece;
    if (!draft.piece.tip) piece = bezier_on(piece, {});
    if (tips_ > 0 && !draft.piece.tip) piece = raised(piece);
  }
  if (patch.kind->transient()) {
    merge(true);
    merge(false);
  }
  pieces_.reserve(drafts_.size());
  for (Draft& draft : drafts_) pieces_.push_back(std::move(draft.piece));
}
QuadPieces::~QuadPieces() = default;

void QuadPieces::open(ControlNet net, const QuadPiece& place) {
  QuadPiece here = place;
  if (net.kind->polynomial()) {
    here.piece = tensor_piece(with_ghosts(net), degree_);
    drafts_.push_back({std::move(here), {}});
    return;
  }
  unsigned depth = place.sides() == 0 ? bound_splits : 0u;
  for (unsigned k = 0; k < 4; ++k) {
    if ((place.corners() >> k) % 2 == 1) depth = std::max<unsigned>(depth, depths_.corners[k]);
    if ((place.sides() >> k) % 2 == 1) depth = std::max<unsigned>(depth, depths_.sides[k]);
  }
  if (place.level >= depth) {
    add_tip(std::move(net), place);
    return;
  }
  const NetQuarters quarters(net);
  for (std::size_t k = 0; k < 4; ++k) {
    QuadPiece quarter = quarter_of(place, k);
    if (quarters.regular(k)) {
      quarter.piece = tensor_piece(quarters.lattice(k), degree_);
      drafts_.push_back({std::move(quarter), {}});
    } else {
      open(quarters.net(k), quarter);
    }
  }
}

void QuadPieces::add_tip(ControlNet net, const QuadPiece& place) {
  Draft tip{place, {}};
  tip.nets.push_back({std::move(net), {}});
  tip.piece.piece = TipFit(tip.nets, place.box(), degree_, evaluator_).bezier();
  tip.piece.tip = true;
  tip.piece.distance = tip_distance(tip.nets, tip.piece.piece, degree_);
  drafts_.push_back(std::move(tip));
  ++tips_;
}

// One piece for two, if it is the same polynomial up to rounding; tips if they are near enough, and the same on the border.
std::optional<QuadPieces::Draft> QuadPieces::merged(const Draft& a, const Draft& b, bool along_u) {
  Draft both{a.piece, {}};
  (along_u ? both.piece.columns : both.piece.rows) *= 2;
  if (!a.piece.tip) {
    both.piece.piece = joined(a.piece.piece, b.piece.piece, along_u);
    for (std::size_t k = 0; k < 2; ++k) {
      const QuadPiece& part = k == 0 ? a.piece : b.piece;
      const double apart = distance_bound(part.piece, bezier_on(both.piece.piece, half_box(k, along_u)));
      if (apart > 0x1p-40 * both.piece.piece.largest) return {};
      both.piece.distance = std::max(both.piece.distance, enlarged(part.distance + apart));
    }
    return both;
  }
  for (const Draft* part : {&a, &b}) {
    for (const PartNet& net : part->nets) {
      const double from = part == &a ? 0 : 0.5;
      ParameterBox box = net.box;
      (along_u ? box.u0 : box.v0) = from + 0.5 * (along_u ? box.u0 : box.v0);
      (along_u ? box.u1 : box.v1) = from + 0.5 * (along_u ? box.u1 : box.v1);
      both.nets.push_back({net.net, box});
    }
  }
  both.piece.piece = TipFit(both.nets, both.piece.box(), degree_, evaluator_).bezier();
  if (!same_sides(both.piece.piece, a.piece.piece, b.piece.piece, along_u)) return {};
  both.piece.distance = tip_distance(both.nets, both.piece.piece, degree_);
  if (both.piece.distance > std::max({error_, a.piece.distance, b.piece.distance})) return {};
  return both;
}

void QuadPieces::merge(bool along_u) {
  const auto key = [along_u](const QuadPiece& p) {
    return along_u ? std::tuple(p.level, p.j, p.rows, p.columns, p.i)
                   : std::tuple(p.level, p.i, p.columns, p.rows, p.j);
  };
  for (bool again = true; again;) {
    again = false;
    std::sort(drafts_.begin(), drafts_.end(),
              [&](const Draft& a, const Draft& b) { return key(a.piece) < key(b.piece); });
    std::vector<Draft> kept;
    for (std::size_t k = 0; k < drafts_.size(); ++k) {
      if (k + 1 < drafts_.size()) {
        const QuadPiece &a = drafts_[k].piece, &b = drafts_[k + 1].piece;
        const std::uint32_t width = along_u ? a.columns : a.rows, begin = along_u ? a.i : a.j;
        const bool beside = a.level == b.level && a.tip == b.tip && a.columns == b.columns &&
                            a.rows == b.rows &&
                            (along_u ? a.j == b.j && b.i == a.i + width : a.i == b.i && b.j == a.j + width);
        if (beside && begin % (2 * width) == 0) {
          if (auto both = merged(drafts_[k], drafts_[k + 1], along_u)) {
            kept.push_back(std::move(*both));
            ++k;
            again = true;
            continue;
          }
        }
      }
      kept.push_back(std::move(drafts_[k]));
    }
    drafts_ = std::move(kept);
  }
}

}  // namespace snug
