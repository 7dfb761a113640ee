#include <snug/spline/triangle_tree.h>

#include <algorithm>
#include <cmath>
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

// Polar form of a quartic; Number has sums and multiples.
template <class Number>
Number polar(std::array<Number, quartic_count> p, const std::array<HalfWeights, 4>& at) {
  for (std::size_t d = 4; d > 0; --d) {
    const HalfWeights& b = at[4 - d];
    for (std::size_t j = 0; j < d; ++j) {
      for (std::size_t i = 0; i + j < d; ++i) {
        p[bezier_index(d - 1, i, j)] = b[0] * p[bezier_index(d, i, j)] + b[1] * p[bezier_index(d, i + 1, j)] +
                                       b[2] * p[bezier_index(d, i, j + 1)];
      }
    }
  }
  return p[0];
}

template <std::size_t rows, std::size_t columns>
using Matrix = std::array<std::array<double, columns>, rows>;

// Bezier points of a child from those of a quartic: multiples of 1/16.
using Quarter = Matrix<quartic_count, quartic_count>;
Quarter quarter_rows(std::size_t child) {
  constexpr HalfWeights c0{1, 0, 0}, c1{0, 1, 0}, c2{0, 0, 1}, m01{0.5, 0.5, 0}, m12{0, 0.5, 0.5},
      m20{0.5, 0, 0.5};
  constexpr std::array<std::array<HalfWeights, 3>, 4> corners{
      {{c0, m01, m20}, {m01, c1, m12}, {m20, m12, c2}, {m12, m20, m01}}};
  Quarter rows{};
  for (std::size_t source = 0; source < quartic_count; ++source) {
    std::array<double, quartic_count> unit{};
    unit[source] = 1;
    for (std::size_t j = 0; j <= 4; ++j) {
      for (std::size_t i = 0; i + j <= 4; ++i) {
        std::array<HalfWeights, 4> at{};
        for (std::size_t k = 0; k < 4; ++k) at[k] = corners[child][k < i ? 1 : k < i + j ? 2 : 0];
        rows[bezier_index(4, i, j)][source] = polar(unit, at);
      }
    }
  }
  return rows;
}
const std::array<Quarter, 4>& quarters() {
  static const std::array<Quarter, 4> all{quarter_rows(0), quarter_rows(1), quarter_rows(2), quarter_rows(3)};
  return all;
}

double binomial(std::size_t n, std::size_t k) {
  return k == 0 ? 1 : binomial(n - 1, k - 1) * static_cast<double>(n) / static_cast<double>(k);
}

// Bezier points of degree 6 from those of a quartic.
using Raised = Matrix<sextic_count, quartic_count>;
const Raised& raised_rows() {
  static const Raised rows = [] {
    Raised result{};
    for (std::size_t j = 0; j <= 4; ++j) {
      for (std::size_t i = 0; i + j <= 4; ++i) {
        // Times (u + v + w)^2.
        for (std::size_t q = 0; q <= 2; ++q) {
          for (std::size_t p = 0; p + q <= 2; ++p) {
            const std::size_t place = bezier_index(6, i + p, j + q);
            result[place][bezier_index(4, i, j)] += multinomial(4, bezier_index(4, i, j)) *
                                                    multinomial(2, bezier_index(2, p, q)) /
                                                    multinomial(6, place);
          }
        }
      }
    }
    return result;
  }();
  return rows;
}

// The same of a bicubic, on the lower half: with x = u + v and y = v (tensor_bezier()).
using Halved = Matrix<sextic_count, 16>;
const Halved& lower_rows() {
  static const Halved rows = [] {
    Halved result{};
    constexpr std::size_t d = 3;
    for (std::size_t i = 0; i <= d; ++i) {
      for (std::size_t j = 0; j <= d; ++j) {
        for (std::size_t p = 0; p <= i; ++p) {
          for (std::size_t q = 0; q <= d - j; ++q) {
            const std::size_t place = bezier_index(6, p + q, i - p + j);
            result[place][i + 4 * j] +=
                binomial(d, i) * binomial(d, j) * binomial(i, p) * binomial(d - j, q) / multinomial(6, place);
          }
        }
      }
    }
    return result;
  }();
  return rows;
}

template <std::size_t rows, std::size_t columns, class Points>
Vector3 applied(const Matrix<rows, columns>& matrix, std::size_t row, const Points& points) {
  Vector3 sum;
  for (std::size_t k = 0; k < columns; ++k) sum = sum + matrix[row][k] * points[k];
  return sum;
}

// Weights are rounded, sums of at most 16 products, which means are.
constexpr std::size_t row_roundings = 24;

QuarticTriangle child_of(const QuarticTriangle& quartic, SquareHalf half, std::size_t child) {
  std::array<Vector3, quartic_count> points;
  for (std::size_t r = 0; r < quartic_count; ++r) points[r] = applied(quarters()[child], r, quartic.points);
  QuarticTriangle result;
  const unsigned turn = turn_of_child(half, child);
  for (std::size_t j = 0; j <= 4; ++j) {
    for (std::size_t i = 0; i + j <= 4; ++i) {
      const std::array<std::size_t, 3> own{4 - i - j, i, j};
      std::array<std::size_t, 3> there{};
      for (std::size_t k = 0; k < 3; ++k) there[(k + turn) % 3] = own[k];
      result.points[bezier_index(4, i, j)] = points[bezier_index(4, there[1], there[2])];
    }
  }
  for (const Vector3& p : result.points) result.largest = std::max(result.largest, max_abs(p));
  result.error =
      enlarged(quartic.error + gamma_bound(row_roundings) * quartic.largest) + 64 * underflow_error;
  return result;
}

}  // namespace

double distance_bound(const QuarticTriangle& quartic, const TensorPiece& bicubic, SquareHalf half) {
  // On the upper half u and v change places.
  std::array<Vector3, 16> points;
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i)
      points[i + 4 * j] = half == SquareHalf::lower ? bicubic.at(i, j) : bicubic.at(j, i);
  }
  double largest = 0;
  for (std::size_t j = 0; j <= 6; ++j) {
    for (std::size_t i = 0; i + j <= 6; ++i) {
      const std::size_t place = bezier_index(6, i, j),
                        from = half == SquareHalf::lower ? place : bezier_index(6, j, i);
      largest = std::max(largest, length_sq(applied(raised_rows(), place, quartic.points) -
                                            applied(lower_rows(), from, points)));
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
  const HalfWeights a = weights_at(half, box.u0, box.v0), b = weights_at(half, box.u1, box.v0),
                    c = weights_at(half, box.u1, box.v1), d = weights_at(half, box.u0, box.v1);
  double largest = 0;
  for (std::size_t i = 0; i <= 4; ++i) {
    for (std::size_t j = 0; j <= 4; ++j) {
      Vector3 off;
      for (std::size_t both = i + j > 4 ? i + j - 4 : 0; both <= std::min(i, j); ++both) {
        std::array<HalfWeights, 4> at{a, a, a, a};
        for (std::size_t k = 0; k < i + j - both; ++k) at[k] = k < both ? c : k < i ? b : d;
        const double share = binomial(i, both) * binomial(4 - i, j - both) / binomial(4, j);
        off = off + share * polar(quartic.points, at);
      }
      // The bicubic, raised in both directions.
      const double su = static_cast<double>(i) / 4, sv = static_cast<double>(j) / 4;
      const std::size_t i0 = i == 0 ? 0 : i - 1, j0 = j == 0 ? 0 : j - 1, i1 = std::min<std::size_t>(i, 3),
                        j1 = std::min<std::size_t>(j, 3);
      off = off - (sv * (su * bicubic.at(i0, j0) + (1 - su) * bicubic.at(i1, j0)) +
                   (1 - sv) * (su * bicubic.at(i0, j1) + (1 - su) * bicubic.at(i1, j1)));
      largest = std::max(largest, length_sq(off));
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

std::optional<CornerJet> TriangleTree::jet(double u, double v) {
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
  const std::array<Vector3, quartic_count>& p = there.quartic->points;
  return CornerJet{polar(p, {at, at, at, at}), (4 * scale) * polar(p, {at, at, at, du}),
                   (4 * scale) * polar(p, {at, at, at, dv}),
                   (12 * scale * scale) * polar(p, {at, at, du, dv})};
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
    visit({0, nullptr}, tree_.half_, {0, 1, 0, 1});
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
        add({children + static_cast<std::uint32_t>(child), nullptr}, half_of_child(half, child),
            bezier_on(part.bicubic, {u, u + 0.5, v, v + 0.5}), part.level + 1);
      }
    }
    return parts_.empty() ? largest_ : std::max(largest_, parts_.front().bound);
  }

 private:
  // A node, or a polynomial that is part of one.
  struct Triangle {
    std::uint32_t node;
    const QuarticTriangle* quartic;
  };
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

  void visit(const Triangle& triangle, SquareHalf half, const ParameterBox& square) {
    if (!meets(half, square)) return;
    const ParameterBox common{std::max(square.u0, box_.u0), std::min(square.u1, box_.u1),
                              std::max(square.v0, box_.v0), std::min(square.v1, box_.v1)};
    if (common == square) {
      add(triangle, half, on_part(square), 0);
      return;
    }
    const QuarticTriangle* const whole = quartic_of(triangle);
    if (whole != nullptr && covers(half, square, common)) {
      largest_ = std::max(largest_, distance_bound(*whole, on_part(common), half, within(square, common)));
      return;
    }
    const std::uint32_t children = whole != nullptr ? 0 : tree_.children_of(triangle.node);
    // The polynomial moves when nodes are added.
    const std::optional<QuarticTriangle> kept = whole != nullptr ? std::optional(*whole) : std::nullopt;
    for (std::size_t child = 0; child < 4; ++child) {
      const auto [x, y] = quarter_of_child(half, child);
      const double mu = 0.5 * (square.u0 + square.u1), mv = 0.5 * (square.v0 + square.v1);
      const ParameterBox quarter{x == 0 ? square.u0 : mu, x == 0 ? mu : square.u1, y == 0 ? square.v0 : mv,
                                 y == 0 ? mv : square.v1};
      if (!meets(half_of_child(half, child), quarter)) continue;
      if (!kept) {
        visit({children + static_cast<std::uint32_t>(child), nullptr}, half_of_child(half, child), quarter);
      } else {
        const QuarticTriangle part = child_of(*kept, half, child);
        visit({triangle.node, &part}, half_of_child(half, child), quarter);
      }
    }
  }
  [[nodiscard]] const QuarticTriangle* quartic_of(const Triangle& triangle) const {
    if (triangle.quartic != nullptr) return triangle.quartic;
    const auto& own = tree_.nodes_[triangle.node].quartic;
    return own ? &*own : nullptr;
  }

  void add(const Triangle& triangle, SquareHalf half, const TensorPiece& bicubic, unsigned level) {
    if (const QuarticTriangle* quartic = quartic_of(triangle)) {
      largest_ = std::max(largest_, distance_bound(*quartic, bicubic, half));
      return;
    }
    parts_.push_back(
        {triangle.node, bicubic, distance_bound(tree_.nodes_[triangle.node].net, bicubic), level});
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
