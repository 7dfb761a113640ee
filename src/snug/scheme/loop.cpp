#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <snug/base/contract.h>
#include <snug/geometry/rounding.h>
#include <snug/scheme/creased.h>
#include <snug/scheme/loop_masks.h>

// Loop's scheme: triangles, box splines of degree 4. [Loop87]
namespace snug::loop {
namespace {

// The share of the ring. Exact where the cosine is rational.
Interval ring_share(std::size_t n) {
  SNUG_EXPECT(n >= 3);
  if (n == 3) return 0.5625;
  if (n == 4) return 0.484375;
  if (n == 6) return 0.375;
  const Interval f = Interval(3) + Interval(2) * cos_of_turn(1, static_cast<unsigned>(n));
  return Interval(0.625) - f * f * Interval(0x1p-6);
}

}  // namespace

RingMask vertex_mask(std::size_t n) {
  const Interval a = ring_share(n);
  if (n == 3) return {0.4375, 0.1875};
  if (n == 4) return {0.515625, 0.12109375};
  if (n == 6) return {0.625, 0.0625};
  return {Interval(1) - a, a / Interval(static_cast<double>(n))};
}

RingMask limit_mask(std::size_t n) {
  const Interval third = Interval(1) + Interval(8) * ring_share(n) / Interval(3);
  const Interval w = n == 6 ? Interval(0.5) : Interval(1) / third;
  return {w, (Interval(1) - w) / Interval(static_cast<double>(n))};
}

RingMask curve_limit_mask() { return {Interval(2) / Interval(3), Interval(1) / Interval(6)}; }

double subdominant(std::size_t n) { return 0.375 + 0.25 * middle(cos_of_turn(1, static_cast<unsigned>(n))); }

double subdominant_across_boundary(std::size_t faces) {
  return 0.375 + 0.25 * middle(cos_of_turn(1, static_cast<unsigned>(2 * faces)));
}

}  // namespace snug::loop

namespace snug {
namespace {

constexpr std::size_t full_count = 12;  // control points of a full Loop lattice

// 24 times the Bezier points (i, j), j outermost, of a patch whose twelve control points lie as drawn in
// rings.h. Derived in derivations/loop_bezier.md.
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
std::array<Combination, full_count> complete(const Topology& topology, std::span<const CornerFan> fans) {
  const std::size_t count = topology.vertex_count();
  std::array<Combination, full_count> places;
  for (std::size_t i = 0; i < 3; ++i) places[i] = unit_combination(i, count);
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfEdge corner = topology.first_of(FaceId(0)) + static_cast<HalfEdge>(i);
    // Ring counter-clockwise from the clockwise boundary neighbour, or from v_{i+1} in a closed fan.
    HalfEdge start = corner;
    std::size_t before = 0;
    while (!fans[i].closed && topology.cw(start) != no_half_edge) {
      start = topology.cw(start);
      ++before;
    }
    std::vector<std::size_t> fan;
    for (HalfEdge h = start;;) {
      fan.push_back(topology.to(h).index());
      const HalfEdge after = topology.ccw(h);
      if (after == start) break;
      if (after == no_half_edge) {
        fan.push_back(topology.from(topology.prev(h)).index());
        break;
      }
      h = after;
    }
    std::array<Combination, 6> ring;
    for (std::size_t k = 0; k < 6; ++k) {
      if (k < fan.size()) ring[k] = unit_combination(fan[k], count);
    }
    if (!fans[i].closed) {
      ring[4] = ghost(i, fan[3], fan[2], count);
      ring[5] = ghost(i, fan[0], fan[1], count);
    }
    const auto seen = [&](std::size_t k) { return ring[(k + before) % 6]; };  // counted from v_{i+1}
    places[3 + (i + 2) % 3] = seen(2);
    places[6 + 2 * i] = seen(3);
    places[7 + 2 * i] = seen(4);
    places[3 + i] = seen(5);
  }
  return places;
}

Stencils box_spline_rows(const Topology& ring, std::span<const CornerFan> fans) {
  const std::array<Combination, full_count> places = complete(ring, fans);
  Stencils out;
  for (const auto& row : full_rows) {
    for (std::size_t c = 0; c < places[0].size(); ++c) {
      int sum = 0;
      for (std::size_t k = 0; k < full_count; ++k) sum += row[k] * places[k][c];
      if (sum == 0) continue;
      const double weight = sum / 24.0;
      out.add(static_cast<std::uint32_t>(c), weight, std::fabs(weight) * unit_roundoff);
    }
    out.end_row();
  }
  return out;
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
                      .kernel = RegularKernel::box_spline}) {}

  // One step makes two edges between the same two vertices of duplicate faces, which are not one.
  [[nodiscard]] bool answers(DefectKind kind) const override {
    return kind != DefectKind::duplicate_face && CreasedRules::answers(kind);
  }

  void add_smooth_vertex(const Topology&, const SchemeOptions&, VertexId v, const Star& star,
                         const Interval& share, RowBuilder& row) const override {
    const loop::RingMask mask = loop::vertex_mask(star.spokes.size());
    row.add(v.value(), times(share, mask.centre));
    for (const Spoke& spoke : star.spokes) row.add(spoke.end.value(), times(share, mask.each));
  }
  void add_smooth_edge(const Topology& topology, const SchemeOptions&, HalfEdge h, const Interval& share,
                       RowBuilder& row) const override {
    for (const VertexId end : {topology.from(h), topology.to(h)}) {
      row.add(end.value(), times(share, loop::edge_end));
    }
    for (const HalfEdge g : {h, topology.twin(h)}) {
      row.add(topology.from(topology.prev(g)).value(), times(share, loop::edge_wing));
    }
  }

  [[nodiscard]] bool is_settled(const Topology&, const Star&, bool) const override { return true; }
  void add_smooth_limit(const Topology&, VertexId v, const Star& star, Stencils& out) const override {
    const loop::RingMask mask = loop::limit_mask(star.spokes.size());
    out.add(v.value(), mask.centre);
    for (const Spoke& spoke : star.spokes) out.add(spoke.end.value(), mask.each);
  }
  void add_smooth_tangents(const Topology&, const Star& star, Stencils& out) const override {
    const auto n = static_cast<unsigned>(star.spokes.size());
    for (const unsigned turn : {0u, 3 * n}) {  // sin x = cos(x - pi/2), in quarters of a step
      for (unsigned i = 0; i < n; ++i) {
        out.add(star.spokes[i].end.value(), cos_of_turn((4 * i + turn) % (4 * n), 4 * n));
      }
      out.end_row();
    }
  }
  [[nodiscard]] AcrossCrease across_crease(std::size_t faces) const override {
    const double step = std::numbers::pi / static_cast<double>(faces);
    AcrossCrease across;
    for (std::size_t i = 1; i < faces; ++i) across.inner.push_back(std::sin(static_cast<double>(i) * step));
    const double sum = std::accumulate(across.inner.begin(), across.inner.end(), 0.0);
    across.end = (std::sin(step) - sum) / (8 * loop::subdominant_across_boundary(faces) - 2);
    return across;
  }

  [[nodiscard]] bool regular(const CornerFan& fan) const override {
    return !fan.odd && !fan.sharp && (fan.closed ? fan.after == 5 : fan.faces() == 3);
  }
  [[nodiscard]] BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const override {
    return {4, 1, box_spline_rows(ring, fans)};
  }
  [[nodiscard]] double shrink_factor(const CornerFan& fan) const override {
    return fan.closed ? loop::subdominant(fan.faces())
                      : std::max(0.5, loop::subdominant_across_boundary(fan.faces()));
  }
};

}  // namespace

const SchemeRules& loop_rules() {
  static const LoopRules rules;
  return rules;
}

}  // namespace snug
