#include <snug/spline/quad_pieces.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
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

// How many splits of a tip are tried to find polynomials at a corner, before it counts as extraordinary.
constexpr unsigned jet_splits = 8;
// Limits of the splits that bound a tip's distance.
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

// Puts Bezier points of degree 3 at a corner.
void put_jet(TensorPiece& bezier, std::size_t x, std::size_t y, const CornerJet& jet, double width = 1,
             double height = 1) {
  const double su = (x == 0 ? 1.0 / 3 : -1.0 / 3) / width, sv = (y == 0 ? 1.0 / 3 : -1.0 / 3) / height;
  const std::size_t i = 3 * x, j = 3 * y, a = x == 0 ? 1 : 2, b = y == 0 ? 1 : 2;
  bezier.at(i, j) = jet.point;
  bezier.at(a, j) = jet.point + su * jet.along_u;
  bezier.at(i, b) = jet.point + sv * jet.along_v;
  bezier.at(a, b) = bezier.at(a, j) + sv * jet.along_v + (su * sv) * jet.twist;
}

// The Bezier points of a tip: from derivatives at regular corners, else from limit points that it passes through.
class TipFit {
 public:
  /// Nets: of one row or column of parts that cover the tip.
  TipFit(std::span<const PartNet> nets, const ParameterBox& box, std::size_t degree,
         LimitEvaluator& evaluator, const FlatBall* ball)
      : box_(box), evaluator_(evaluator), ball_(ball) {
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [x, y] = corner_places[k];
      const PartNet& part = *std::find_if(nets.begin(), nets.end(), [x = x, y = y](const PartNet& p) {
        return (x == 0 ? p.box.u0 == 0 : p.box.u1 == 1) && (y == 0 ? p.box.v0 == 0 : p.box.v1 == 1);
      });
      if (auto jet = jet_at(part.net, k, degree)) {
        known_[k] = true;
        if (ball_ != nullptr) ball_->apply(*jet);
        put_jet(bezier_, x, y, *jet, part.box.u1 - part.box.u0, part.box.v1 - part.box.v0);
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
  [[nodiscard]] Vector3 limit(double u, double v) {
    CornerJet jet{evaluator_.frame(place(u, v)).point.relative, {}, {}, {}};
    if (ball_ != nullptr) ball_->apply(jet);
    return jet.point;
  }

  // Bezier points next to extraordinary ends of a side: through one or two limit points, then into the tangent plane.
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

  // Inner Bezier points: of one extraordinary corner such that the middle is the surface's, of several without a twist.
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
  const FlatBall* ball_;
  std::array<bool, 4> known_{};
  TensorPiece bezier_ = bezier_piece(TensorPiece::max_degree);
};

// An upper bound; not refined any more once it is at most `sufficient`.
double tip_distance(std::span<const PartNet> nets, const TensorPiece& bezier, std::size_t degree,
                    double sufficient) {
  struct Part {
    ControlNet net;
    TensorPiece bezier;
    double bound;
    unsigned level;
  };
  const auto farther = [](const Part& a, const Part& b) { return a.bound < b.bound; };
  std::vector<Part> parts;
  const auto add = [&](ControlNet net, const TensorPiece& here, unsigned level) {
    const double bound = distance_bound(net, here);
    parts.push_back({std::move(net), here, bound, level});
    std::push_heap(parts.begin(), parts.end(), farther);
  };
  for (const PartNet& part : nets) add(part.net, bezier_on(bezier, part.box), 0);
  double largest = 0;  // of what is polynomial
  for (unsigned steps = 0; !parts.empty() && parts.front().bound > largest; ++steps) {
    if (steps == most_bound_pieces || parts.front().level >= bound_splits ||
        parts.front().bound <= sufficient)
      return parts.front().bound;
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

QuadPieces::QuadPieces(const Patch& patch, const QuadDepths& depths, double error,
                       const std::array<QuadFlat, 4>& flats)
    : depths_(depths),
      flats_(flats),
      error_(error),
      evaluator_(patch),
      degree_(tensor_degree(patch.kind->rules().basis)) {
  for (std::size_t k = 0; k < 4; ++k) {
    if (flats_[k].radius == 0) continue;
    const auto [x, y] = corner_places[k];
    const LimitFrame frame = evaluator_.frame({0, 0, static_cast<double>(x), static_cast<double>(y)});
    if (frame.normal) balls_[k] = {frame.point.relative, *frame.normal, flats_[k].radius};
  }
  open(control_net(patch), {});
  for (Draft& draft : drafts_) {
    if (drafts_.size() == 1) break;  // a lattice, by which faces are packed
    TensorPiece& piece = draft.piece.piece;
    if (draft.piece.bent) continue;
    if (!draft.piece.tip) piece = bezier_on(piece, {});
    if (tips_ > 0 && !draft.piece.tip) piece = raised(piece);
  }
  if (patch.kind->transient()) {
    merge(true);
    merge(false);
  }
  fit_tips();
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
      if (const FlatBall* ball = ball_at(place, quarter.level)) {
        add_bent(quarter, *ball, flats_[static_cast<std::size_t>(ball - balls_.data())].splits);
      } else {
        drafts_.push_back({std::move(quarter), {}});
      }
    } else {
      open(quarters.net(k), quarter);
    }
  }
}

// About the corner that a part touches, if its pieces of this level are bent.
const FlatBall* QuadPieces::ball_at(const QuadPiece& place, unsigned level) const {
  for (std::size_t k = 0; k < 4; ++k) {
    if ((place.corners() >> k) % 2 == 1 && balls_[k].radius > 0 && level >= flats_[k].first)
      return &balls_[k];
  }
  return nullptr;
}

// A polynomial as bicubics by its bent positions and derivatives.
void QuadPieces::add_bent(const QuadPiece& quarter, const FlatBall& ball, unsigned splits) {
  const TensorPiece whole = raised(bezier_on(quarter.piece, {}));
  const std::uint32_t count = 1u << splits;
  const double size = 1.0 / count;
  for (std::uint32_t j = 0; j < count; ++j) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const TensorPiece exact = bezier_on(whole, {i * size, (i + 1) * size, j * size, (j + 1) * size});
      QuadPiece part;
      part.level = quarter.level + splits;
      part.i = quarter.i * count + i;
      part.j = quarter.j * count + j;
      part.bent = true;
      part.piece = bezier_piece(3);
      for (const auto& [x, y] : corner_places) {
        CornerJet jet = corner_jet(exact, x, y);
        ball.apply(jet);
        put_jet(part.piece, x, y, jet);
      }
      take_largest(part.piece);
      part.distance = distance_bound(exact, part.piece);
      drafts_.push_back({std::move(part), {}});
    }
  }
}

void QuadPieces::add_tip(ControlNet net, const QuadPiece& place) {
  Draft tip{place, {}};
  tip.piece.tip = true;
  tip.nets.push_back({std::move(net), {}});
  drafts_.push_back(std::move(tip));
  ++tips_;
}

namespace {

// Rows of tips beside semi-sharp creases: one polynomial may do for several.
class TipRows {
 public:
  enum class Row : std::uint8_t { none, along_u, along_v };

  template <class Drafts>
  explicit TipRows(const Drafts& tips) {
    for (const auto& tip : tips) places_.insert({tip.piece.level, tip.piece.i, tip.piece.j});
  }
  // The side of the quad that a tip lies on, if it is one; at a corner the side on which the next tip is.
  [[nodiscard]] Row row_of(const QuadPiece& p) const {
    const bool inner = p.corners() == 0;
    const bool u = (p.sides() & 5u) != 0 && (inner || has(p, p.i + 1, p.j) || has(p, p.i - 1, p.j));
    const bool v = (p.sides() & 10u) != 0 && (inner || has(p, p.i, p.j + 1) || has(p, p.i, p.j - 1));
    return u == v ? Row::none : u ? Row::along_u : Row::along_v;
  }
  // In the order of rows, and in rows.
  [[nodiscard]] bool before(const QuadPiece& a, const QuadPiece& b) const { return key(a) < key(b); }
  [[nodiscard]] bool adjoin(const QuadPiece& a, const QuadPiece& b) const {
    const Row row = row_of(a);
    if (row == Row::none || row_of(b) != row || a.level != b.level) return false;
    return row == Row::along_u ? a.j == b.j && b.i == a.i + 1 : a.i == b.i && b.j == a.j + 1;
  }

 private:
  [[nodiscard]] bool has(const QuadPiece& p, std::uint32_t i, std::uint32_t j) const {
    return places_.contains({p.level, i, j});
  }
  [[nodiscard]] std::tuple<Row, unsigned, std::uint32_t, std::uint32_t> key(const QuadPiece& p) const {
    const Row row = row_of(p);
    return row == Row::along_u ? std::tuple(row, p.level, p.j, p.i) : std::tuple(row, p.level, p.i, p.j);
  }
  std::set<std::tuple<unsigned, std::uint32_t, std::uint32_t>> places_;
};

}  // namespace

// Row by row, in the largest blocks whose lengths and places are multiples of the same power of two.
void QuadPieces::fit_tips() {
  const auto first =
      std::partition(drafts_.begin(), drafts_.end(), [](const Draft& d) { return !d.piece.tip; });
  std::vector<Draft> tips(std::make_move_iterator(first), std::make_move_iterator(drafts_.end()));
  drafts_.erase(first, drafts_.end());
  const TipRows rows(tips);
  std::sort(tips.begin(), tips.end(),
            [&](const Draft& a, const Draft& b) { return rows.before(a.piece, b.piece); });
  for (std::size_t begin = 0, end = 0; begin < tips.size(); begin = end) {
    for (end = begin + 1; end < tips.size() && rows.adjoin(tips[end - 1].piece, tips[end].piece);) ++end;
    const bool along_u = rows.row_of(tips[begin].piece) == TipRows::Row::along_u;
    for (std::size_t at = begin, count = 0; at < end; at += count) {
      const std::size_t place = along_u ? tips[at].piece.i : tips[at].piece.j;
      for (count = 1; place % (2 * count) == 0 && at + 2 * count <= end;) count *= 2;
      fit_block({tips.data() + at, count}, along_u);
    }
  }
}

// One polynomial for a block if that is near enough, else one for each half.
void QuadPieces::fit_block(std::span<Draft> tips, bool along_u) {
  const std::size_t count = tips.size();
  Draft block{tips[0].piece, {}};
  (along_u ? block.piece.columns : block.piece.rows) = static_cast<std::uint32_t>(count);
  const double share = 1 / static_cast<double>(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double low = share * static_cast<double>(k), high = share * static_cast<double>(k + 1);
    block.nets.push_back(
        {tips[k].nets[0].net, along_u ? ParameterBox{low, high, 0, 1} : ParameterBox{0, 1, low, high}});
  }
  const FlatBall* ball = block.piece.level == 0 ? nullptr : ball_at(block.piece, block.piece.level);
  block.piece.piece = TipFit(block.nets, block.piece.box(), degree_, evaluator_, ball).bezier();
  if (count == 1 || is_border_of(block.piece, along_u, 2 * count)) {
    block.piece.distance = tip_distance(block.nets, block.piece.piece, degree_, 0.5 * error_);
    if (count == 1 || block.piece.distance <= error_) {
      drafts_.push_back(std::move(block));
      return;
    }
  }
  fit_block(tips.subspan(0, count / 2), along_u);
  fit_block(tips.subspan(count / 2), along_u);
}

// Is a tip the limit curve, up to rounding, where it lies on the quad's border? Then every choice of blocks gives this curve.
bool QuadPieces::is_border_of(const QuadPiece& tip, bool along_u, std::size_t samples) {
  const ParameterBox box = tip.box();
  const double tolerance = 0x1p-40 * tip.piece.largest;
  for (const double side : {0.0, 1.0}) {
    const double across = along_u ? box.v0 + (box.v1 - box.v0) * side : box.u0 + (box.u1 - box.u0) * side;
    if (across != 0 && across != 1) continue;
    for (std::size_t k = 1; k < samples; ++k) {
      const double t = static_cast<double>(k) / static_cast<double>(samples);
      const double u = along_u ? box.u0 + (box.u1 - box.u0) * t : across,
                   v = along_u ? across : box.v0 + (box.v1 - box.v0) * t;
      const Vector3 limit = evaluator_.frame({0, 0, u, v}).point.relative;
      if (max_abs(value(tip.piece, along_u ? t : side, along_u ? side : t) - limit) > tolerance) return false;
    }
  }
  return true;
}

// One piece for two, if it is the same polynomial up to rounding.
std::optional<QuadPieces::Draft> QuadPieces::merged(const Draft& a, const Draft& b, bool along_u) {
  Draft both{a.piece, {}};
  (along_u ? both.piece.columns : both.piece.rows) *= 2;
  both.piece.piece = joined(a.piece.piece, b.piece.piece, along_u);
  for (std::size_t k = 0; k < 2; ++k) {
    const QuadPiece& part = k == 0 ? a.piece : b.piece;
    const double apart = distance_bound(part.piece, bezier_on(both.piece.piece, half_box(k, along_u)));
    if (apart > 0x1p-40 * both.piece.piece.largest) return {};
    both.piece.distance = std::max(both.piece.distance, enlarged(part.distance + apart));
  }
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
        const bool beside = a.level == b.level && !a.tip && !b.tip && a.columns == b.columns &&
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
