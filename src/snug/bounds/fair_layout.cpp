#include <snug/bounds/layout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <set>
#include <span>
#include <utility>

#include <snug/patch/piece_path.h>
#include <support/contract.h>

namespace snug {
namespace {

// Fairness of one equation against one sample of the limit, both squared.
constexpr double fairness = 0.3;
// Of a limit at a corner of the patch, against one elsewhere: what cannot be fair shall not collapse for it.
constexpr double fair_corner_weight = 100;
// Weight of the equations that hold control points which no other one does; far below all others.
constexpr double hold = 1e-11;
// Samples at all corners of pieces on this level.
constexpr unsigned sample_level = 2;

// Least squares for places of all control points, both coordinates at once.
class Places {
 public:
  explicit Places(std::size_t count)
      : count_(count), matrix_(count * count, 0.0), right_(count, LayoutPoint{0, 0}) {
    for (std::size_t i = 0; i < count; ++i) {
      matrix_[i * count + i] = hold;
      right_[i] = {hold / 3, hold / 3};  // the centre of the patch
    }
  }

  // sum row_i place_i = target
  void add(std::span<const double> row, LayoutPoint target, double weight) {
    SNUG_EXPECT(row.size() == count_);
    for (std::size_t i = 0; i < count_; ++i) {
      if (row[i] == 0) continue;
      for (std::size_t j = 0; j <= i; ++j) matrix_[i * count_ + j] += weight * row[i] * row[j];
      for (std::size_t a = 0; a < 2; ++a) right_[i][a] += weight * row[i] * target[a];
    }
  }

  // The same for a few terms, which should be 0; vertices may come twice.
  struct Term {
    VertexId vertex;
    double factor;
  };
  void add_fair(std::initializer_list<Term> terms) {
    for (const Term& one : terms) {
      for (const Term& two : terms) {
        if (two.vertex.index() <= one.vertex.index()) {
          matrix_[one.vertex.index() * count_ + two.vertex.index()] += fairness * one.factor * two.factor;
        }
      }
    }
  }

  // By Cholesky's factors.
  [[nodiscard]] std::vector<LayoutPoint> take() {
    const std::size_t n = count_;
    for (std::size_t i = 0; i < n; ++i) {
      double* const own = matrix_.data() + i * n;
      for (std::size_t j = 0; j <= i; ++j) {
        const double* const other = matrix_.data() + j * n;
        double sum = own[j];
        for (std::size_t k = 0; k < j; ++k) sum -= own[k] * other[k];
        own[j] = i == j ? std::sqrt(std::max(sum, hold / 2)) : sum / other[j];
      }
    }
    std::vector<LayoutPoint>& x = right_;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t k = 0; k < i; ++k) x[i][a] -= matrix_[i * n + k] * x[k][a];
        x[i][a] /= matrix_[i * n + i];
      }
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t k = i + 1; k < n; ++k) x[i][a] -= matrix_[k * n + i] * x[k][a];
        x[i][a] /= matrix_[i * n + i];
      }
    }
    return std::move(x);
  }

 private:
  std::size_t count_;
  std::vector<double> matrix_;  // lower triangle
  std::vector<LayoutPoint> right_;
};

// Dense rows over the root's control points.
using Net = std::vector<std::vector<double>>;

std::vector<double> product(const Stencils::Row& row, const Net& net) {
  std::vector<double> sum(net.front().size(), 0.0);
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    const std::vector<double>& source = net[row.sources[i]];
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += row.weights[i] * source[c];
  }
  return sum;
}

// The limits of all corners of pieces at sample_level should be their parameters. The piece's kind calls
// corner `first` its corner 0.
void add_limits(const Kind& kind, std::size_t first, const PiecePath& path, const Net& net,
                std::set<std::pair<double, double>>& done, Places& places) {
  if (path.level() == sample_level) {
    constexpr std::array<TriangleParameter, 3> corners{{{0, 0}, {1, 0}, {0, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const TriangleParameter at = to_face(path, corners[(k + first) % 3]);
      if (!done.emplace(at.u, at.v).second) continue;
      const bool corner = at.u == 1 || at.v == 1 || (at.u == 0 && at.v == 0);
      places.add(product(kind.corner_limits().row(k), net), {at.u, at.v}, corner ? fair_corner_weight : 1);
    }
    return;
  }
  // Children are counted in their kind's order, and its corner k is corner k + first of this piece.
  for (std::size_t c = 0; c < 4; ++c) {
    const KindChild& child = kind.children()[c];
    Net refined;
    for (const std::uint32_t r : child.control) refined.push_back(product(child.step->row(r), net));
    const unsigned digit = c < 3 ? static_cast<unsigned>((c + first) % 3) : 3;
    add_limits(*child.kind, (child.first + first) % 3, path.child(digit), refined, done, places);
  }
}

// Four vertices in a row of an affinely regular n-gon: p3 - p0 = (1 + 2 cos(2 pi / n)) (p2 - p1). No
// condition on a triangle; that a quad is a parallelogram.
void add_face(const Topology& topology, FaceId f, Places& places) {
  const auto face = topology.face(f);
  const std::size_t n = face.size();
  if (n < 4) return;
  const double c = 1 + 2 * std::cos(2 * std::numbers::pi / static_cast<double>(n));
  for (std::size_t k = 0; k < (n == 4 ? 1 : n); ++k) {
    places.add_fair({{face[(k + 3) % n], 1}, {face[k], -1}, {face[(k + 2) % n], -c}, {face[(k + 1) % n], c}});
  }
}

// Three spokes in a row of an affinely regular fan: s2 + s0 - 2 cos(angle) s1 = (2 - 2 cos(angle)) v.
void add_fan(const Topology& topology, HalfEdge start, bool closed, Places& places) {
  std::size_t faces = 0;
  topology.walk_fan(start, [&](HalfEdge) { ++faces; });
  const double c = 2 * std::cos((closed ? 2 : 1) * std::numbers::pi / static_cast<double>(faces));
  topology.walk_fan(start, [&](HalfEdge h) {
    const HalfEdge before = topology.cw(h), after = topology.ccw(h);
    if (before == no_half_edge) return;
    const VertexId next = after == no_half_edge ? topology.from(topology.prev(h)) : topology.to(after);
    places.add_fair({{next, 1}, {topology.to(before), 1}, {topology.to(h), -c}, {topology.from(h), c - 2}});
  });
}

// Open fans only at the patch's own vertices: others go on outside.
void add_fairness(const Kind& kind, Places& places) {
  const Topology topology = neighbourhood(kind.key()).topology;
  std::vector<bool> own(topology.vertex_count(), false);
  own[0] = true;
  if (kind.rules().primal) {
    for (const VertexId v : topology.face(FaceId(0))) own[v.index()] = true;
  }
  for (std::size_t f = 0; f < topology.face_count(); ++f) add_face(topology, FaceId(f), places);
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    topology.for_each_fan(VertexId(v), [&](HalfEdge start) {
      const bool closed = topology.cw(start) != no_half_edge;
      if (closed || own[v]) add_fan(topology, start, closed, places);
    });
  }
}

// The affine map that brings the limit corners to their places.
void put_corners_in_place(const Kind& kind, std::vector<LayoutPoint>& layout) {
  std::array<LayoutPoint, 3> limit{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Stencils::Row row = kind.corner_limits().row(k);
    for (std::size_t i = 0; i < row.sources.size(); ++i) {
      for (std::size_t a = 0; a < 2; ++a) limit[k][a] += row.weights[i] * layout[row.sources[i]][a];
    }
  }
  const LayoutPoint one{limit[1][0] - limit[0][0], limit[1][1] - limit[0][1]};
  const LayoutPoint two{limit[2][0] - limit[0][0], limit[2][1] - limit[0][1]};
  const double area = one[0] * two[1] - one[1] * two[0];
  if (!(area > 0.01)) return;  // limits that can be nowhere else: any layout is sound
  for (LayoutPoint& p : layout) {
    const double x = p[0] - limit[0][0], y = p[1] - limit[0][1];
    p = {(x * two[1] - y * two[0]) / area, (y * one[0] - x * one[1]) / area};
  }
}

// A lattice has places at halves.
void clean_lattice(std::vector<LayoutPoint>& layout) {
  const auto near = [](double x) { return std::round(2 * x) / 2; };
  for (const LayoutPoint& p : layout) {
    if (!(std::fabs(p[0] - near(p[0])) < 1e-7 && std::fabs(p[1] - near(p[1])) < 1e-7)) return;
  }
  for (LayoutPoint& p : layout) p = {near(p[0]), near(p[1])};
}

}  // namespace

std::vector<LayoutPoint> fair_layout(const Kind& kind) {
  const std::size_t count = kind.control_count();
  Places places(count);
  Net net(count, std::vector<double>(count, 0.0));
  for (std::size_t i = 0; i < count; ++i) net[i][i] = 1;
  std::set<std::pair<double, double>> done;
  add_limits(kind, 0, {}, net, done, places);
  add_fairness(kind, places);
  std::vector<LayoutPoint> layout = places.take();
  put_corners_in_place(kind, layout);
  clean_lattice(layout);
  return layout;
}

}  // namespace snug
