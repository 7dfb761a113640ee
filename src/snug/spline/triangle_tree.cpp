#include <snug/spline/triangle_tree.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <snug/geometry/rounding.h>
#include <snug/scheme/bezier.h>

namespace snug {
namespace {

constexpr std::size_t quartic_count = QuarticTriangle::count, sextic_count = bezier_count(6);
constexpr unsigned jet_levels = 60, search_levels = 40;
constexpr std::size_t most_search_parts = 4096;

// Four children: 0 to 2 keep that corner in its place, 3 is the middle one, its corner k facing corner k (scheme/refine.h).
//
//             c2                      lower half            upper half
//            /  \           .             2              2 -- 1
//          m20--m12         .            /|              | 2/3|/
//          / \  / \         .           / |              |/  |/
//        c0--m01--c1        .          0--1              0
//
// The middle child of a half is a half of the other kind: of the lower one the upper half of the quarter (1, 0), with corners 2, 0,
// 1 of the child; of the upper one the lower half of the quarter (0, 1), with corners 1, 2, 0.
constexpr SquareHalf other(SquareHalf half) {
  return half == SquareHalf::lower ? SquareHalf::upper : SquareHalf::lower;
}
constexpr SquareHalf half_of_child(SquareHalf half, std::size_t child) {
  return child == 3 ? other(half) : half;
}
constexpr unsigned turn_of_child(SquareHalf half, std::size_t child) {
  if (child < 3) return 0;
  return half == SquareHalf::lower ? 2 : 1;
}
// The quarter of the square that a child lies in.
constexpr std::array<unsigned, 2> quarter_of_child(SquareHalf half, std::size_t child) {
  if (child == 0) return {0, 0};
  if (half == SquareHalf::lower) return child == 2 ? std::array{1u, 1u} : std::array{1u, 0u};
  return child == 1 ? std::array{1u, 1u} : std::array{0u, 1u};
}

using HalfWeights = std::array<double, 3>;

HalfWeights weights_at(SquareHalf half, double u, double v) {
  return half == SquareHalf::lower ? HalfWeights{1 - u, u - v, v} : HalfWeights{1 - v, u, v - u};
}
constexpr HalfWeights along_u(SquareHalf half) {
  return half == SquareHalf::lower ? HalfWeights{-1, 1, 0} : HalfWeights{0, 1, -1};
}
constexpr HalfWeights along_v(SquareHalf half) {
  return half == SquareHalf::lower ? HalfWeights{0, -1, 1} : HalfWeights{-1, 0, 1};
}

// A step of a quartic's polar form: one argument is given, what is left is of degree d - 1.
void step_polar(std::span<Vector3> p, std::size_t d, const HalfWeights& b) {
  for (std::size_t j = 0; j < d; ++j) {
    for (std::size_t i = 0; i + j < d; ++i) {
      p[bezier_index(d - 1, i, j)] = b[0] * p[bezier_index(d, i, j)] + b[1] * p[bezier_index(d, i + 1, j)] +
                                     b[2] * p[bezier_index(d, i, j + 1)];
    }
  }
}
// The last two steps, of a quadratic.
Vector3 polar(std::span<const Vector3> quadratic, const HalfWeights& a, const HalfWeights& b) {
  std::array<Vector3, bezier_count(2)> p;
  std::copy_n(quadratic.begin(), p.size(), p.begin());
  step_polar(p, 2, a);
  step_polar(p, 1, b);
  return p[0];
}

// How often k of n things can be chosen.
constexpr std::array<std::array<double, 5>, 5> choices{
    {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}, {1, 4, 6, 4, 1}}};

// What a Bezier point of degree 6 has of another polynomial's. The weights of a point are positive and sum to 1.
struct Share {
  std::uint8_t to, from;
  double weight;
};

// From those of a quartic.
const std::vector<Share>& raised_shares() {
  static const std::vector<Share> all = [] {
    std::vector<Share> shares;
    for (std::size_t j = 0; j <= 4; ++j) {
      for (std::size_t i = 0; i + j <= 4; ++i) {
        // Times (u + v + w)^2.
        for (std::size_t q = 0; q <= 2; ++q) {
          for (std::size_t p = 0; p + q <= 2; ++p) {
            const std::size_t to = bezier_index(6, i + p, j + q), from = bezier_index(4, i, j);
            shares.push_back(
                {static_cast<std::uint8_t>(to), static_cast<std::uint8_t>(from),
                 multinomial(4, from) * multinomial(2, bezier_index(2, p, q)) / multinomial(6, to)});
          }
        }
      }
    }
    return shares;
  }();
  return all;
}

// From those of a bicubic, on the lower half: with x = u + v and y = v (tensor_bezier()).
const std::vector<Share>& lower_shares() {
  static const std::vector<Share> all = [] {
    std::vector<Share> shares;
    constexpr std::size_t d = 3;
    for (std::size_t i = 0; i <= d; ++i) {
      for (std::size_t j = 0; j <= d; ++j) {
        for (std::size_t p = 0; p <= i; ++p) {
          for (std::size_t q = 0; q <= d - j; ++q) {
            const std::size_t to = bezier_index(6, p + q, i - p + j);
            shares.push_back(
                {static_cast<std::uint8_t>(to), static_cast<std::uint8_t>(i + 4 * j),
                 choices[d][i] * choices[d][j] * choices[i][p] * choices[d - j][q] / multinomial(6, to)});
          }
        }
      }
    }
    return shares;
  }();
  return all;
}

// Weights are rounded, sums of at most 16 products, which means are; and four means of three points each.
constexpr std::size_t row_roundings = 24;

// Of a quartic the polar values at all choices of four out of some points, which are given to `use` with how often each point
// was chosen. Choices with the same beginning share its means.
template <std::size_t degree, std::size_t count, class Use>
void all_polar_values(const std::array<Vector3, quartic_count>& p,
                      const std::array<HalfWeights, count>& points, std::size_t first,
                      std::array<std::size_t, count>& chosen, const Use& use) {
  for (std::size_t k = first; k < count; ++k) {
    const HalfWeights& b = points[k];
    std::array<Vector3, quartic_count> less;
    for (std::size_t j = 0; j < degree; ++j) {
      for (std::size_t i = 0; i + j < degree; ++i) {
        less[bezier_index(degree - 1, i, j)] = b[0] * p[bezier_index(degree, i, j)] +
                                               b[1] * p[bezier_index(degree, i + 1, j)] +
                                               b[2] * p[bezier_index(degree, i, j + 1)];
      }
    }
    ++chosen[k];
    if constexpr (degree == 1) {
      use(chosen, less[0]);
    } else {
      all_polar_values<degree - 1>(less, points, k, chosen, use);
    }
    --chosen[k];
  }
}

// The corners of a half on the square [low, high]^2 of the half of a square that it lies in, both having the diagonal.
QuarticTriangle on_diagonal(const QuarticTriangle& quartic, SquareHalf half, double low, double high) {
  const std::array<HalfWeights, 3> corners{
      weights_at(half, low, low),
      half == SquareHalf::lower ? weights_at(half, high, low) : weights_at(half, high, high),
      half == SquareHalf::lower ? weights_at(half, high, high) : weights_at(half, low, high)};
  QuarticTriangle result;
  std::array<std::size_t, 3> chosen{};
  all_polar_values<4>(quartic.points, corners, 0, chosen,
                      [&](const std::array<std::size_t, 3>& times, const Vector3& value) {
                        result.points[bezier_index(4, times[1], times[2])] = value;
                      });
  for (const Vector3& p : result.points) result.largest = std::max(result.largest, max_abs(p));
  result.error =
      enlarged(quartic.error + gamma_bound(row_roundings) * quartic.largest) + 64 * underflow_error;
  return result;
}

}  // namespace

double distance_bound(const QuarticTriangle& quartic, const TensorPiece& bicubic, SquareHalf half) {
  std::array<Vector3, sextic_count> of_quartic, of_bicubic;
  for (const Share& s : raised_shares())
    of_quartic[s.to] = of_quartic[s.to] + s.weight * quartic.points[s.from];
  // On the upper half u and v change places.
  const bool lower = half == SquareHalf::lower;
  for (const Share& s : lower_shares()) {
    const std::size_t from = lower ? s.from : s.from / 4 + 4 * (s.from % 4);
    of_bicubic[s.to] = of_bicubic[s.to] + s.weight * bicubic.points[from];
  }
  double largest = 0;
  for (std::size_t j = 0; j <= 6; ++j) {
    for (std::size_t i = 0; i + j <= 6; ++i) {
      const std::size_t place = bezier_index(6, i, j);
      largest =
          std::max(largest, length_sq(of_quartic[place] - of_bicubic[lower ? place : bezier_index(6, j, i)]));
    }
  }
  const double rounding =
      quartic.error + bicubic.error +
      (gamma_bound(row_roundings) + unit_roundoff) * 1.01 * (quartic.largest + bicubic.largest) +
      256 * underflow_error;
  return distance_up(largest, rounding);
}

// The quartic as a biquartic: a Bezier point (i, j) is the mean of polar values at all ways of giving i of four points the second u, and
// j of them the second v.
double distance_bound(const QuarticTriangle& quartic, const TensorPiece& bicubic, SquareHalf half,
                      const ParameterBox& box) {
  // The corners of the box, and how often each is among the four points of a polar value.
  const std::array<HalfWeights, 4> corners{weights_at(half, box.u0, box.v0), weights_at(half, box.u1, box.v0),
                                           weights_at(half, box.u0, box.v1),
                                           weights_at(half, box.u1, box.v1)};
  std::array<Vector3, 25> off;
  std::array<std::size_t, 4> chosen{};
  all_polar_values<4>(quartic.points, corners, 0, chosen,
                      [&](const std::array<std::size_t, 4>& times, const Vector3& value) {
                        const std::size_t both = times[3], i = times[1] + both, j = times[2] + both;
                        const double share = choices[i][both] * choices[4 - i][j - both] / choices[4][j];
                        off[i + 5 * j] = off[i + 5 * j] + share * value;
                      });
  double largest = 0;
  for (std::size_t i = 0; i <= 4; ++i) {
    for (std::size_t j = 0; j <= 4; ++j) {
      // The bicubic, raised in both directions.
      const double su = static_cast<double>(i) / 4, sv = static_cast<double>(j) / 4;
      const std::size_t i0 = i == 0 ? 0 : i - 1, j0 = j == 0 ? 0 : j - 1, i1 = std::min<std::size_t>(i, 3),
                        j1 = std::min<std::size_t>(j, 3);
      largest = std::max(
          largest,
          length_sq(off[i + 5 * j] - (sv * (su * bicubic.at(i0, j0) + (1 - su) * bicubic.at(i1, j0)) +
                                      (1 - sv) * (su * bicubic.at(i0, j1) + (1 - su) * bicubic.at(i1, j1)))));
    }
  }
  const double rounding = quartic.error + bicubic.error +
                          gamma_bound(4 * row_roundings) * (quartic.largest + bicubic.largest) +
                          256 * underflow_error;
  return distance_up(largest, rounding);
}

TriangleTree::TriangleTree(const Patch& patch, unsigned turn, SquareHalf half)
    : patch_(patch), turn_(turn % 3), half_(half) {
  // Local corner k is corner k + turn of the patch, which is corner k + turn - first of the kind.
  nodes_.push_back(node_of(control_net(patch), (patch.first + 3 - turn_) % 3, half));
}

TriangleTree::Node TriangleTree::node_of(ControlNet net, unsigned first, SquareHalf half) {
  Node node{std::move(net), static_cast<std::uint8_t>(first), half, {}, 0};
  if (!node.net.kind->polynomial()) return node;
  const Stencils& rows = node.net.kind->bezier();
  std::array<kernels::NetPoint, quartic_count> points;
  QuarticTriangle quartic;
  quartic.largest = kernels::refine_net(rows, node.net.points.data(), points.data());
  quartic.error = rows.result_error(node.net.largest, node.net.error);
  for (std::size_t j = 0; j <= 4; ++j) {
    for (std::size_t i = 0; i + j <= 4; ++i) {
      const std::array<std::size_t, 3> own{4 - i - j, i, j};
      std::array<std::size_t, 3> of_kind{};
      for (std::size_t k = 0; k < 3; ++k) of_kind[(k + 3 - first) % 3] = own[k];
      const kernels::NetPoint& p = points[bezier_index(4, of_kind[1], of_kind[2])];
      quartic.points[bezier_index(4, i, j)] = {p[0], p[1], p[2]};
    }
  }
  node.quartic = quartic;
  node.net.points.clear();
  return node;
}

std::uint32_t TriangleTree::children_of(std::uint32_t node) {
  if (nodes_[node].children != 0) return nodes_[node].children;
  const NetQuarters quarters(nodes_[node].net);
  const unsigned first = nodes_[node].first;
  const SquareHalf half = nodes_[node].half;
  const KindStep& step = nodes_[node].net.kind->step();
  const auto begin = static_cast<std::uint32_t>(nodes_.size());
  for (unsigned child = 0; child < 4; ++child) {
    const unsigned of_kind = child == 3 ? 3 : (child + 3 - first) % 3;
    const unsigned turned = step.pieces[of_kind].first + first + 3 - turn_of_child(half, child);
    nodes_.push_back(node_of(quarters.net(of_kind), turned % 3, half_of_child(half, child)));
  }
  nodes_[node].children = begin;
  return begin;
}

std::optional<CornerJet> TriangleTree::limit_jet(double u, double v) {
  std::uint32_t node = 0;
  double scale = 1;
  for (unsigned level = 0; !nodes_[node].quartic; ++level) {
    const SquareHalf half = nodes_[node].half;
    const bool right = u >= 0.5, upper = v >= 0.5;
    if ((u == 0 || u == 1) && (v == 0 || v == 1)) {
      const std::size_t corner = u == 0 && v == 0       ? 0
                                 : (u == 1) == (v == 1) ? (half == SquareHalf::lower ? 2 : 1)
                                                        : (half == SquareHalf::lower ? 1 : 2);
      if (!nodes_[node].net.kind->regular_corner((corner + 3 - nodes_[node].first) % 3)) return {};
    }
    if (level == jet_levels) return {};
    u = 2 * u - (right ? 1 : 0);
    v = 2 * v - (upper ? 1 : 0);
    scale *= 2;
    std::size_t child = 0;
    if (half == SquareHalf::lower) {
      child = !right ? 0 : upper ? 2 : v <= u ? 1 : 3;
    } else {
      child = !upper ? 0 : right ? 1 : v >= u ? 2 : 3;
    }
    node = children_of(node) + static_cast<std::uint32_t>(child);
  }
  const Node& there = nodes_[node];
  const HalfWeights at = weights_at(there.half, u, v), du = along_u(there.half), dv = along_v(there.half);
  std::array<Vector3, quartic_count> p = there.quartic->points;
  step_polar(p, 4, at);
  step_polar(p, 3, at);
  return CornerJet{polar(p, at, at), (4 * scale) * polar(p, at, du), (4 * scale) * polar(p, at, dv),
                   (12 * scale * scale) * polar(p, du, dv)};
}

std::optional<CornerJet> TriangleTree::jet(double u, double v) {
  std::optional<CornerJet> jet = limit_jet(u, v);
  if (jet) {
    for (const FlatBall& ball : flats_) ball.apply(*jet);
  }
  return jet;
}

void TriangleTree::flatten(std::size_t corner, double radius) {
  const LimitFrame frame = corner_frame(corner);
  if (!frame.normal) return;
  flats_.push_back({frame.point.relative, *frame.normal, radius});
}

LimitFrame TriangleTree::corner_frame(std::size_t corner) {
  if (!evaluator_) evaluator_.emplace(patch_);
  const std::size_t k = (corner + turn_) % 3;
  return evaluator_->frame({0, 0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0});
}

Vector3 TriangleTree::limit(double u, double v) {
  if (const auto known = jet(u, v)) return known->point;
  // An extraordinary corner; or the parameter is next to one.
  const std::size_t corner = u < 0.5 && v < 0.5     ? 0
                             : u >= 0.5 && v >= 0.5 ? (half_ == SquareHalf::lower ? 2 : 1)
                                                    : (half_ == SquareHalf::lower ? 1 : 2);
  return corner_frame(corner).point.relative;
}

std::optional<Vector3> TriangleTree::normal(std::size_t corner) { return corner_frame(corner).normal; }

// Bounds over a box: triangles in it that are polynomials, and the farthest nets first.
class TriangleTree::Search {
 public:
  Search(TriangleTree& tree, const ParameterBox& box, const TensorPiece& bicubic)
      : tree_(tree), box_(box), bicubic_(bicubic) {}

  double run(double sufficient) {
    visit(0, tree_.half_, {0, 1, 0, 1});
    for (std::size_t steps = 0; !parts_.empty() && parts_.front().bound > std::max(largest_, sufficient);
         ++steps) {
      if (steps == most_search_parts || parts_.front().level >= search_levels) break;
      std::pop_heap(parts_.begin(), parts_.end(), nearer);
      const Part part = std::move(parts_.back());
      parts_.pop_back();
      const SquareHalf half = tree_.nodes_[part.node].half;
      const std::uint32_t children = tree_.children_of(part.node);
      for (std::size_t child = 0; child < 4; ++child) {
        const auto [x, y] = quarter_of_child(half, child);
        const double u = 0.5 * x, v = 0.5 * y;
        add(children + static_cast<std::uint32_t>(child), half_of_child(half, child),
            bezier_on(part.bicubic, {u, u + 0.5, v, v + 0.5}), part.level + 1);
      }
    }
    return parts_.empty() ? largest_ : std::max(largest_, parts_.front().bound);
  }

 private:
  struct Part {
    std::uint32_t node;
    TensorPiece bicubic;
    double bound;
    unsigned level;
  };
  static bool nearer(const Part& a, const Part& b) { return a.bound < b.bound; }

  // Does the half of a square lie in the box in part?
  [[nodiscard]] bool meets(SquareHalf half, const ParameterBox& square) const {
    const double u0 = std::max(square.u0, box_.u0), u1 = std::min(square.u1, box_.u1),
                 v0 = std::max(square.v0, box_.v0), v1 = std::min(square.v1, box_.v1);
    if (u0 >= u1 || v0 >= v1) return false;
    return half == SquareHalf::lower ? u1 - square.u0 > v0 - square.v0 : v1 - square.v0 > u0 - square.u0;
  }

  // Does the half of a square contain a box that lies in the square?
  [[nodiscard]] static bool covers(SquareHalf half, const ParameterBox& square, const ParameterBox& box) {
    return half == SquareHalf::lower ? box.v1 - square.v0 <= box.u0 - square.u0
                                     : box.u1 - square.u0 <= box.v0 - square.v0;
  }
  [[nodiscard]] static ParameterBox within(const ParameterBox& outer, const ParameterBox& box) {
    const double width = outer.u1 - outer.u0, height = outer.v1 - outer.v0;
    return {(box.u0 - outer.u0) / width, (box.u1 - outer.u0) / width, (box.v0 - outer.v0) / height,
            (box.v1 - outer.v0) / height};
  }
  [[nodiscard]] TensorPiece on_part(const ParameterBox& part) const {
    return bezier_on(bicubic_, within(box_, part));
  }

  void visit(std::uint32_t node, SquareHalf half, const ParameterBox& square) {
    if (!meets(half, square)) return;
    const ParameterBox common{std::max(square.u0, box_.u0), std::min(square.u1, box_.u1),
                              std::max(square.v0, box_.v0), std::min(square.v1, box_.v1)};
    if (common == square) {
      add(node, half, on_part(square), 0);
      return;
    }
    const QuarticTriangle* const whole = quartic_of(node);
    if (whole != nullptr && covers(half, square, common)) {
      largest_ = std::max(largest_, distance_bound(*whole, on_part(common), half, within(square, common)));
      return;
    }
    if (whole != nullptr) {
      visit_polynomial(*whole, half, square, common);
      return;
    }
    const std::uint32_t children = tree_.children_of(node);
    for (std::size_t child = 0; child < 4; ++child) {
      const auto [x, y] = quarter_of_child(half, child);
      const double mu = 0.5 * (square.u0 + square.u1), mv = 0.5 * (square.v0 + square.v1);
      const ParameterBox quarter{x == 0 ? square.u0 : mu, x == 0 ? mu : square.u1, y == 0 ? square.v0 : mv,
                                 y == 0 ? mv : square.v1};
      if (meets(half_of_child(half, child), quarter))
        visit(children + static_cast<std::uint32_t>(child), half_of_child(half, child), quarter);
    }
  }
  // A part of a square through which the diagonal runs: half of a square on it, and at most two rectangles of the half. Below it:
  //
  //      .-------.-----.
  //      |     / |     |
  //      |   /   |     |
  //      :-------:     |
  //      '-------'-----'
  void visit_polynomial(const QuarticTriangle& quartic, SquareHalf half, const ParameterBox& square,
                        const ParameterBox& common) {
    const double low = std::max(common.u0 - square.u0, common.v0 - square.v0),
                 high = std::min(common.u1 - square.u0, common.v1 - square.v0), size = square.u1 - square.u0;
    const ParameterBox middle{square.u0 + low, square.u0 + high, square.v0 + low, square.v0 + high};
    largest_ = std::max(
        largest_, distance_bound(on_diagonal(quartic, half, low / size, high / size), on_part(middle), half));
    const bool lower = half == SquareHalf::lower;
    for (const ParameterBox& rest : {lower ? ParameterBox{middle.u1, common.u1, common.v0, common.v1}
                                           : ParameterBox{common.u0, common.u1, middle.v1, common.v1},
                                     lower ? ParameterBox{middle.u0, middle.u1, common.v0, middle.v0}
                                           : ParameterBox{common.u0, middle.u0, middle.v0, middle.v1}}) {
      if (rest.u0 < rest.u1 && rest.v0 < rest.v1)
        largest_ = std::max(largest_, distance_bound(quartic, on_part(rest), half, within(square, rest)));
    }
  }
  [[nodiscard]] const QuarticTriangle* quartic_of(std::uint32_t node) const {
    const auto& own = tree_.nodes_[node].quartic;
    return own ? &*own : nullptr;
  }

  void add(std::uint32_t node, SquareHalf half, const TensorPiece& bicubic, unsigned level) {
    if (const QuarticTriangle* quartic = quartic_of(node)) {
      largest_ = std::max(largest_, distance_bound(*quartic, bicubic, half));
      return;
    }
    parts_.push_back({node, bicubic, distance_bound(tree_.nodes_[node].net, bicubic), level});
    std::push_heap(parts_.begin(), parts_.end(), nearer);
  }

  TriangleTree& tree_;
  ParameterBox box_;
  const TensorPiece& bicubic_;
  std::vector<Part> parts_;
  double largest_ = 0;
};

double TriangleTree::distance(const ParameterBox& box, const TensorPiece& bicubic, double sufficient) {
  return Search(*this, box, bicubic).run(sufficient);
}

}  // namespace snug
