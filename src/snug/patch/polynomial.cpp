#include <snug/patch/polynomial.h>

#include <algorithm>
#include <array>

#include <snug/base/contract.h>
#include <snug/base/rounding.h>

namespace snug {
namespace {

constexpr std::size_t point_count = 15, full_count = 12;

// 24 times the Bezier points (i, j), j outermost, of a patch whose twelve control points lie as drawn in
// neighbourhood.h. Derived in derivations/loop_bezier.md.
constexpr std::array<std::array<int, full_count>, point_count> full_rows{{
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

// A control point of the full lattice as an integer combination of those that the kind has.
using Combination = std::vector<int>;

Combination unit(std::size_t i, std::size_t count) {
  Combination c(count, 0);
  c[i] = 1;
  return c;
}

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
std::array<Combination, full_count> complete(const KindKey& key) {
  const Topology topology = neighbourhood(key);
  const std::size_t count = topology.vertex_count();
  std::array<Combination, full_count> places;
  for (std::size_t i = 0; i < 3; ++i) places[i] = unit(i, count);
  for (std::size_t i = 0; i < 3; ++i) {
    const HalfEdge corner = topology.first_of(FaceId(0)) + static_cast<HalfEdge>(i);
    // Ring counter-clockwise from the clockwise boundary neighbour, or from v_{i+1} in a closed fan.
    HalfEdge start = corner;
    std::size_t before = 0;
    while (!key.corners[i].closed && topology.cw(start) != no_half_edge) {
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
      if (k < fan.size()) ring[k] = unit(fan[k], count);
    }
    if (!key.corners[i].closed) {
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

}  // namespace

bool is_polynomial(const KindKey& key) {
  return std::all_of(key.corners.begin(), key.corners.end(),
                     [](const CornerFan& fan) { return fan.regular(); });
}

Stencils bezier_rows(const KindKey& key) {
  SNUG_EXPECT(is_polynomial(key));
  const std::array<Combination, full_count> places = complete(key);
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

}  // namespace snug
