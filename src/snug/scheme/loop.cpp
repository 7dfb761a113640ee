#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <snug/scheme/creased.h>
#include <support/contract.h>

// Loop's scheme: triangles, box splines of degree 4. [Loop87]
namespace snug {
namespace {

// A symmetric mask: one weight for the vertex, one for each vertex of its ring. They sum to 1.
struct RingMask {
  Interval centre, each;
};

// The share of the ring of an interior vertex: a = 5/8 - (3 + 2 cos(2 pi/n))^2 / 64. Exact where the cosine
// is rational.
Interval ring_share(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  if (n == 3) return 0.5625;
  if (n == 4) return 0.484375;
  if (n == 6) return 0.375;
  const Interval f = Interval(3) + Interval(2) * cos_of_turn(1, static_cast<unsigned>(n));
  return Interval(0.625) - f * f * Interval(0x1p-6);
}

// New position:  (1 - a) v + a mean(ring).
RingMask ring_vertex_mask(std::size_t n) {
  const Interval a = ring_share(n);
  if (n == 3) return {0.4375, 0.1875};
  if (n == 4) return {0.515625, 0.12109375};
  if (n == 6) return {0.625, 0.0625};
  return {Interval(1) - a, a / Interval(static_cast<double>(n))};
}

// Limit position:  w v + (1 - w) mean(ring),  w = 1 / (1 + 8 a / 3).
RingMask ring_limit_mask(std::size_t n) {
  const Interval third = Interval(1) + Interval(8) * ring_share(n) / Interval(3);
  const Interval w = n == 6 ? Interval(0.5) : Interval(1) / third;
  return {w, (Interval(1) - w) / Interval(static_cast<double>(n))};
}

// 3/8 + cos(2 pi/n) / 4: subdominant eigenvalue at an interior vertex of valence n, and of the direction
// across a smooth boundary with n / 2 faces. What is around shrinks by it a level.
double ring_subdominant(std::size_t n) {
  return 0.375 + 0.25 * middle(cos_of_turn(1, static_cast<unsigned>(n)));
}

constexpr std::size_t full_count = 12;  // control points of a full Loop lattice

// 24 times the Bezier points (i, j), j outermost, of a patch whose twelve control points lie as drawn in
// rings.h. derivations/loop_bezier.md
constexpr std::array<std::array<int, full_count>, bezier_count(4)> full_rows{{
    {12, 2, 2, 2, 0, 2, 2, 2, 0, 0, 0, 0},
    {12, 4, 3, 3, 0, 1, 0, 1, 0, 0, 0, 0},
    {8, 8, 4, 4, 0, 0, 0, 0, 0, 0, 0, 0},
    {4, 12, 3, 3, 1, 0, 0, 0, 1, 0, 0, 0},
    {2, 12, 2, 2, 2, 0, 0, 0, 2, 2, 0, 0},
    {12, 3, 4, 1, 0, 3, 1, 0, 0, 0, 0, 0},
    {10, 6, 6, 1, 0, 1, 0, 0, 0, 0, 0, 0},
    {6, 10, 6, 1, 1, 0, 0, 0, 0, 0, 0, 0},
    {3, 12, 4, 1, 3, 0, 0, 0, 0, 1, 0, 0},
    {8, 4, 8, 0, 0, 4, 0, 0, 0, 0, 0, 0},
    {6, 6, 10, 0, 1, 1, 0, 0, 0, 0, 0, 0},
    {4, 8, 8, 0, 4, 0, 0, 0, 0, 0, 0, 0},
    {4, 3, 12, 0, 1, 3, 0, 0, 0, 0, 0, 1},
    {3, 4, 12, 0, 3, 1, 0, 0, 0, 0, 1, 0},
    {2, 2, 12, 0, 2, 2, 0, 0, 0, 0, 2, 2},
}};

// The ghost beyond a boundary edge pq of a triangle with third vertex r: p + q - r.
Combination ghost(std::size_t p, std::size_t q, std::size_t r, std::size_t count) {
  Combination c(count, 0);
  c[p] += 1;
  c[q] += 1;
  c[r] -= 1;
  return c;
}

// The twelve places of the full lattice, ghosts filled in. A regular boundary corner has three faces; its
// ring of six is the four vertices of its fan and two ghosts.
Lattice complete(const Topology& topology, std::span<const CornerFan> fans) {
  const std::size_t count = topology.vertex_count();
  Lattice places(full_count);
  Star star;
  for (std::size_t i = 0; i < 3; ++i) {
    places[i] = unit_combination(i, count);
    gather_star({topology, {}, {}}, VertexId(i), star);
    std::vector<Combination> ring;
    std::size_t first = 0;  // where v_{i+1} is
    for (std::size_t k = 0; k < star.spokes.size(); ++k) {
      const std::size_t end = star.spokes[k].end.index();
      ring.push_back(unit_combination(end, count));
      if (end == (i + 1) % 3) first = k;
    }
    if (!fans[i].closed) {
      const auto fan = [&](std::size_t k) { return star.spokes[k].end.index(); };
      ring.push_back(ghost(i, fan(3), fan(2), count));
      ring.push_back(ghost(i, fan(0), fan(1), count));
    }
    const auto seen = [&](std::size_t k) { return ring[(k + first) % 6]; };  // counted from v_{i+1}
    places[3 + (i + 2) % 3] = seen(2);
    places[6 + 2 * i] = seen(3);
    places[7 + 2 * i] = seen(4);
    places[3 + i] = seen(5);
  }
  return places;
}

constexpr std::array loop_names{"scheme-loop"};

class LoopRules : public CreasedRules {
 public:
  LoopRules()
      : CreasedRules({.scheme = Scheme::loop,
                      .name = "loop",
                      .other_names = loop_names,
                      .corners = 3,
                      .regular_valence = 6,
                      .wants_triangles = "Loop subdivision needs triangles: triangulate the mesh",
                      .laid_by_rings = true,
                      .kernel = RegularKernel::box_spline,
                      .basis = RegularBasis::box_spline}) {}

  // One step makes two edges between the same two vertices of duplicate faces, which are not one.
  [[nodiscard]] bool answers(DefectKind kind) const override {
    return kind != DefectKind::duplicate_face && CreasedRules::answers(kind);
  }

  void add_smooth_vertex(const Topology&, VertexId v, const Star& star, const Interval& share,
                         RowBuilder& row) const override {
    const RingMask mask = ring_vertex_mask(star.spokes.size());
    row.add(v.value(), times(share, mask.centre));
    for (const Spoke& spoke : star.spokes) row.add(spoke.end.value(), times(share, mask.each));
  }
  // 3/8 of its ends, 1/8 of the two vertices that face it.
  void add_smooth_edge(const Topology& topology, SmoothTriangles, HalfEdge h, const Interval& share,
                       RowBuilder& row) const override {
    for (const VertexId end : {topology.from(h), topology.to(h)}) row.add(end.value(), times(share, 0.375));
    for (const HalfEdge g : {h, topology.twin(h)}) {
      row.add(topology.from(topology.prev(g)).value(), times(share, 0.125));
    }
  }

  [[nodiscard]] bool has_limit_in_star(const Topology&, const Star&, bool) const override { return true; }
  void add_smooth_limit(const Topology&, VertexId v, const Star& star, Stencils& out) const override {
    const RingMask mask = ring_limit_mask(star.spokes.size());
    out.add(v.value(), mask.centre);
    for (const Spoke& spoke : star.spokes) out.add(spoke.end.value(), mask.each);
  }
  void add_smooth_tangents(const Topology&, const Star& star, Stencils& out) const override {
    const auto add = [&](unsigned i, const auto& wave) { out.add(star.spokes[i].end.value(), wave(i)); };
    add_first_modes(star.spokes.size(), add, out);
  }
  [[nodiscard]] AcrossCrease across_crease(std::size_t faces) const override {
    const double step = std::numbers::pi / static_cast<double>(faces);
    AcrossCrease across;
    for (std::size_t i = 1; i < faces; ++i) across.inner.push_back(std::sin(static_cast<double>(i) * step));
    const double sum = std::accumulate(across.inner.begin(), across.inner.end(), 0.0);
    across.end = (std::sin(step) - sum) / (8 * ring_subdominant(2 * faces) - 2);
    return across;
  }

  [[nodiscard]] bool regular(const CornerFan& fan) const override {
    return !fan.odd && !fan.sharp && (fan.closed ? fan.after == 5 : fan.faces() == 3);
  }
  [[nodiscard]] BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const override {
    const Lattice places = lattice(ring, fans);
    BezierRows out{4, 1, {}};
    for (const auto& row : full_rows) {
      Combination sum(ring.vertex_count(), 0);
      for (std::size_t k = 0; k < full_count; ++k) {
        for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += row[k] * places[k][c];
      }
      add_fractions(sum, 24, out.rows);
    }
    return out;
  }
  [[nodiscard]] Lattice lattice(const Topology& ring, std::span<const CornerFan> fans) const override {
    return complete(ring, fans);
  }
  [[nodiscard]] double shrink_factor(const CornerFan& fan) const override {
    return fan.closed ? ring_subdominant(fan.faces()) : std::max(0.5, ring_subdominant(2 * fan.faces()));
  }
};

}  // namespace

const SchemeRules& loop_rules() { return only<LoopRules>(); }

}  // namespace snug
