#include <snug/bounds/crease_rows.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <snug/bounds/layout.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/bezier.h>
#include <support/contract.h>

namespace snug {
namespace {

// One direction of the tensor product: four Bezier points of a cubic, each from four control points.
using CubicWeights = std::array<Interval, 4>;
using Cubic = std::array<CubicWeights, 4>;

// Exact where a factor, or a term, is 0.
Interval product(const Interval& a, const Interval& b) {
  return a == Interval{} || b == Interval{} ? Interval{} : times(a, b);
}
Interval sum(const Interval& a, const Interval& b) {
  return a == Interval{} ? b : b == Interval{} ? a : a + b;
}

CubicWeights combined(const Interval& a, const CubicWeights& x, const Interval& b, const CubicWeights& y) {
  CubicWeights all;
  for (std::size_t k = 0; k < 4; ++k) all[k] = sum(product(a, x[k]), product(b, y[k]));
  return all;
}

// Columns across the crease, that of the crease at 1.
using Columns = std::array<CubicWeights, 5>;

// The piece of a uniform cubic B-spline that begins at column `first`.
Cubic segment(const Columns& column, std::size_t first) {
  const CubicWeights *const a = &column[first], &b = a[1], &c = a[2];
  const CubicWeights ends_b = combined({1.0}, a[0], {1.0}, c), ends_c = combined({1.0}, b, {1.0}, a[3]);
  const Interval sixth = Interval(1.0) / Interval(6.0), third = Interval(1.0) / Interval(3.0);
  const Interval two_thirds = Interval(2.0) / Interval(3.0);
  return {combined(sixth, ends_b, two_thirds, b), combined(two_thirds, b, third, c),
          combined(third, b, two_thirds, c), combined(sixth, ends_c, two_thirds, c)};
}

// The same from t on, or up to t.
Cubic cut(Cubic cubic, double t, bool from) {
  for (std::size_t step = 1; step < 4; ++step) {
    for (std::size_t i = 0; i + step < 4; ++i) {
      const std::size_t k = from ? i : 3 - i, next = from ? k + 1 : k - 1;
      const double own = from ? 1 - t : t;
      cubic[k] = combined({own}, cubic[k], {1 - own}, cubic[next]);
    }
  }
  return cubic;
}

// Seen from the other end.
Cubic mirrored(const Cubic& cubic) {
  Cubic result;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) result[3 - i][3 - k] = cubic[i][k];
  }
  return result;
}

Columns unit_columns() {
  Columns columns{};
  for (std::size_t k = 0; k < 4; ++k) columns[k][k] = Interval(1.0);
  return columns;
}

// Columns from the one before the crease on after a step, with the part `sharp` of the crease's rule.
Columns refined(const Columns& c, double sharp) {
  const Interval half{0.5}, eighth{0.125}, most{0.75};
  Columns next;
  next[0] = combined(half, c[0], half, c[1]);
  next[2] = combined(half, c[1], half, c[2]);
  next[4] = combined(half, c[2], half, c[3]);
  next[3] = combined(eighth, combined({1.0}, c[1], {1.0}, c[3]), most, c[2]);
  next[1] = c[1];
  if (sharp < 1) {
    const CubicWeights smooth = combined(eighth, combined({1.0}, c[0], {1.0}, c[2]), most, c[1]);
    next[1] = combined({sharp}, c[1], Interval(1.0) - Interval(sharp), smooth);
  }
  return next;
}

// How a patch lies on its crease.
struct CreaseLine {
  std::array<std::uint32_t, 16> place;  // the control point at x + 4 y; the quad's corner 0 is at (1, 1)
  bool along_x;
  bool far;  // at 2 of the other coordinate, not at 1
  double sharpness;
  // Does it run along an edge of this half of the quad, or meet one of its corners?
  [[nodiscard]] bool along_edge() const { return along_x != far; }
};

// The control points of a quad among eight others.
std::optional<std::array<std::uint32_t, 16>> quad_lattice(const Kind& kind, const Topology& topology) {
  if (topology.face_count() != 9 || topology.vertex_count() != 16) return {};
  for (const VertexId corner : topology.face(FaceId(0))) {
    if (topology.face_valence(corner) != 4 || topology.on_boundary(corner) || !topology.is_manifold(corner))
      return {};
  }
  const std::vector<LayoutPoint> layout = lattice_layout(kind);
  std::array<std::uint32_t, 16> place;
  place.fill(16);
  for (std::uint32_t v = 0; v < layout.size(); ++v) {
    // Corners 1 and 2 of the patch are at (2, 1) and (2, 2).
    const double x = 1 + layout[v][0] + layout[v][1], y = 1 + layout[v][1];
    if (!(x >= 0 && x <= 3 && y >= 0 && y <= 3)) return {};
    place[static_cast<std::size_t>(x + 4 * y)] = v;
  }
  if (std::find(place.begin(), place.end(), 16u) != place.end()) return {};
  return place;
}

std::optional<CreaseLine> crease_line(const Kind& kind) {
  if (kind.scheme() != Scheme::catmark || kind.key().polygon || !kind.transient()) return {};
  const Neighbourhood around = neighbourhood(kind.key());
  const std::vector<double>& sharpness = around.sharpness.edges;
  const auto positive = [](double s) { return s > 0; };
  if (around.options.creases != CreaseMethod::uniform || sharpness.empty() ||
      std::any_of(around.sharpness.vertices.begin(), around.sharpness.vertices.end(), positive) ||
      std::count_if(sharpness.begin(), sharpness.end(), positive) != 3) {
    return {};
  }
  const auto place = quad_lattice(kind, around.topology);
  if (!place) return {};
  const auto sharpness_between = [&](std::size_t a, std::size_t b) {
    for (std::size_t e = 0; e < sharpness.size(); ++e) {
      const HalfEdge h = around.topology.half_of(EdgeId(e));
      const std::uint32_t from = around.topology.from(h).value(), to = around.topology.to(h).value();
      if (std::minmax(from, to) == std::minmax((*place)[a], (*place)[b])) return sharpness[e];
    }
    return 0.0;
  };
  for (const bool along_x : {true, false}) {
    for (const bool far : {false, true}) {
      const std::size_t step = along_x ? 1 : 4, begin = (along_x ? 4 : 1) * (far ? 2 : 1);
      const double s = sharpness_between(begin, begin + step);
      if (is_semi_sharp(s) && s == sharpness_between(begin + step, begin + 2 * step) &&
          s == sharpness_between(begin + 2 * step, begin + 3 * step)) {
        return CreaseLine{*place, along_x, far, s};
      }
    }
  }
  return {};
}

// Weights of the lattice, and the Bezier points of a triangle of degree 6.
using Row = std::array<Interval, 16>;
using RowTriangle = std::array<Row, bezier_count(6)>;

Row tensor(const CubicWeights& x, const CubicWeights& y) {
  Row row;
  for (std::size_t i = 0; i < 16; ++i) row[i] = product(x[i % 4], y[i / 4]);
  return row;
}

// The half of a tensor product between (0, 0), (1, 0) and (1, 1): derivations/tensor_bezier.md.
RowTriangle half_of(const Cubic& x, const Cubic& y) {
  constexpr int binomial[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
  RowTriangle sums{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const Row point = tensor(x[i], y[j]);
      for (std::size_t p = 0; p <= i; ++p) {
        for (std::size_t q = 0; q <= 3 - j; ++q) {
          const Interval factor = binomial[3][i] * binomial[3][j] * binomial[i][p] * binomial[3 - j][q];
          Row& total = sums[bezier_index(6, p + q, i - p + j)];
          for (std::size_t c = 0; c < 16; ++c) total[c] = sum(total[c], product(factor, point[c]));
        }
      }
    }
  }
  for (std::size_t place = 0; place < sums.size(); ++place) {
    for (Interval& weight : sums[place]) {
      if (weight != Interval{}) weight = weight / Interval(multinomial(6, place));
    }
  }
  return sums;
}

// From another corner: corners 0 and 2 change places.
RowTriangle turned(const RowTriangle& triangle) {
  RowTriangle result;
  for (std::size_t j = 0; j <= 6; ++j) {
    for (std::size_t i = 0; i + j <= 6; ++i) {
      result[bezier_index(6, i, j)] = triangle[bezier_index(6, i, 6 - i - j)];
    }
  }
  return result;
}

// Cut from corner 1 or 2 to the point t of the edge from corner 0 to the other: what is beyond, or before.
RowTriangle cut(RowTriangle triangle, double t, std::size_t edge, bool beyond) {
  for (std::size_t line = 0; line <= 6; ++line) {
    const std::size_t last = 6 - line;
    const auto at = [&](std::size_t k) -> Row& {
      return triangle[edge == 1 ? bezier_index(6, k, line) : bezier_index(6, line, k)];
    };
    const auto mix = [&](Row& to, const Row& a, const Row& b) {
      for (std::size_t c = 0; c < 16; ++c) {
        to[c] = sum(product(Interval(1 - t), a[c]), product(Interval(t), b[c]));
      }
    };
    for (std::size_t step = 1; step <= last; ++step) {
      for (std::size_t i = 0; i + step <= last; ++i) {
        if (beyond) {
          mix(at(i), at(i), at(i + 1));
        } else {
          mix(at(last - i), at(last - i - 1), at(last - i));
        }
      }
    }
  }
  return triangle;
}

// Where a corner of a piece is, in the patch, from the row of its point: rows make of the lattice the parameters.
// These are whole numbers over a power of two.
std::array<double, 3> place_of(const Row& row) {
  double x = -1, y = -1;
  for (std::size_t c = 0; c < 16; ++c) {
    x += middle(row[c]) * static_cast<double>(c % 4);
    y += middle(row[c]) * static_cast<double>(c / 4);
  }
  const auto exact = [](double value) {
    const double near = std::ldexp(std::round(std::ldexp(value, 16)), -16);
    SNUG_EXPECT(std::fabs(near - value) < 1e-9);
    return near;
  };
  x = exact(x);
  y = exact(y);
  SNUG_EXPECT(0 <= y && y <= x && x <= 1);
  return {1 - x, x - y, y};
}

class RowWriter {
 public:
  explicit RowWriter(const CreaseLine& line) : line_(line) {}
  // The half of the quad that is the patch, as far as it is `width` from the crease or more, if it was a
  // boundary: a triangle where an edge is on the crease, else two beside the corner that is.
  void add_beyond(double width, const Cubic& across, const Cubic& along) {
    if (line_.along_edge()) return add(half(cut(across, width, true), stretch(along, width, 1)));
    const RowTriangle whole = half(across, along), at_corner = line_.far ? turned(whole) : whole;
    add(cut(at_corner, width, 1, true));
    add(cut(cut(at_corner, width, 1, false), width, 2, true));
  }
  // Its part between the distances begin and end from the crease, where `across` is: half a square on the
  // diagonal, and what lies beside that.
  void add_strip(double begin, double end, const Cubic& across, const Cubic& along) {
    add(half(across, stretch(along, begin, end)));
    if (!line_.along_edge() && begin == 0) return;
    const Cubic beside = line_.along_edge() ? stretch(along, end, 1) : stretch(along, 0, begin);
    std::array<Row, 16> rectangle;
    std::size_t at = 0;
    for (const CubicWeights& a : placed(across)) {
      for (const CubicWeights& b : beside) rectangle[at++] = line_.along_x ? tensor(b, a) : tensor(a, b);
    }
    add(rectangle);
  }
  [[nodiscard]] BoundingRows rows() const {
    std::vector<double> weights(16 * rows_.size());
    double most = 0;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      double error = 0;
      for (std::size_t c = 0; c < 16; ++c) {
        weights[16 * r + line_.place[c]] = middle(rows_[r][c]);
        error += radius(rows_[r][c]);
      }
      most = std::max(most, enlarged(error));
    }
    return polynomial_rows(16, weights, most, quadratic_);
  }

 private:
  // Across the crease as the lattice runs; along it, from a to b as the diagonal runs away from the crease.
  [[nodiscard]] Cubic placed(const Cubic& across) const { return line_.far ? mirrored(across) : across; }
  [[nodiscard]] Cubic stretch(const Cubic& along, double a, double b) const {
    return line_.far ? cut(cut(along, 1 - b, true), (b - a) / b, false)
                     : cut(cut(along, b, false), a / b, true);
  }
  [[nodiscard]] RowTriangle half(const Cubic& across, const Cubic& along) const {
    return line_.along_x ? half_of(along, placed(across)) : half_of(placed(across), along);
  }

  void add(const RowTriangle& triangle) {
    rows_.insert(rows_.end(), triangle.begin(), triangle.end());
    const ParameterTriangle place{place_of(triangle[bezier_index(6, 0, 0)]),
                                  place_of(triangle[bezier_index(6, 6, 0)]),
                                  place_of(triangle[bezier_index(6, 0, 6)])};
    const RaisedQuadratic quadratic(place, 6);
    for (std::size_t j = 0; j <= 6; ++j) {
      for (std::size_t i = 0; i + j <= 6; ++i) quadratic_.push_back(quadratic.point(i, j));
    }
  }
  // The last index runs first.
  void add(const std::array<Row, 16>& rectangle) {
    rows_.insert(rows_.end(), rectangle.begin(), rectangle.end());
    const ParameterTriangle place{place_of(rectangle[0]), place_of(rectangle[12]), place_of(rectangle[3])};
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) quadratic_.push_back(raised_quadratic(place, i, j));
    }
  }

  const CreaseLine& line_;
  std::vector<Row> rows_;
  std::vector<QuadraticWeights> quadratic_;
};

// Below it a few levels of subdivision leave nothing that passes.
constexpr double min_sharpness = 2;

}  // namespace

CreaseRows make_crease_rows(const Kind& kind) {
  const auto line = crease_line(kind);
  if (!line || line->sharpness < min_sharpness) return {};
  const auto levels = static_cast<unsigned>(std::floor(line->sharpness));
  const double width = std::ldexp(1.0, -static_cast<int>(levels)), rest = line->sharpness - levels;
  RowWriter writer(*line);

  Columns columns = unit_columns();
  const Cubic along = segment(columns, 0);
  Columns sharp = columns;
  sharp[0] = combined({2.0}, columns[1], {-1.0}, columns[2]);
  writer.add_beyond(width, segment(sharp, 0), along);

  for (unsigned level = 0; level < levels; ++level) columns = refined(columns, 1);
  if (rest > 0) columns = refined(columns, rest);
  const std::size_t pieces = rest > 0 ? 2 : 1;
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const double step = width / static_cast<double>(pieces), begin = step * static_cast<double>(piece);
    writer.add_strip(begin, begin + step, segment(columns, piece), along);
  }
  return {writer.rows()};
}

}  // namespace snug
