#pragma once

#include <gtest/gtest.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <snug/tessellate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// Claims of a tessellation, checked from its triangles and their parameters alone.
namespace snug::testing {

/// How many patches the surface has at an edge of the mesh, counted face by face (vertex by vertex).
[[nodiscard]] inline std::vector<std::size_t> sheets_at_edges(const LimitSurface& surface) {
  const Topology& topology = surface.topology();
  std::vector<std::size_t> sheets(topology.edge_count(), 0);
  for (std::size_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [begin, end] = surface.patches_of(owner);
    if (begin == end || !surface.has_patch(PatchId(begin))) continue;
    if (surface.rules().primal) {
      for (std::size_t k = 0; k < topology.face(FaceId(owner)).size(); ++k) {
        ++sheets[topology.edge_of(topology.first_of(FaceId(owner)) + static_cast<HalfEdge>(k)).index()];
      }
    } else {
      topology.walk_fan(topology.leaving(VertexId(owner)),
                        [&](HalfEdge h) { ++sheets[topology.edge_of(topology.prev(h)).index()]; });
    }
  }
  return sheets;
}

/// The mesh edge under the line between two parameters of an owner; nothing for a line inside.
[[nodiscard]] inline std::optional<EdgeId> edge_under(const LimitSurface& surface, const Place& a,
                                                      const Place& b) {
  const Topology& topology = surface.topology();
  const bool primal = surface.rules().primal;
  // Between corner k and the next one.
  const auto side = [&](std::size_t k) {
    HalfEdge h = primal ? topology.first_of(FaceId(a.owner)) : topology.leaving(VertexId(a.owner));
    if (primal) return topology.edge_of(h + static_cast<HalfEdge>(k));
    for (; k > 0; --k) h = topology.ccw(h);
    return topology.edge_of(topology.prev(h));
  };
  const auto [begin, end] = surface.patches_of(a.owner);
  const std::size_t parts = end - begin, corners = parts / 2;
  if (surface.rules().triangular()) {
    if (a.v == 0 && b.v == 0) return side(0);
    if (a.u + a.v == 1 && b.u + b.v == 1) return side(1);
    if (a.u == 0 && b.u == 0) return side(2);
    return {};
  }
  if (a.v == 0 && b.v == 0) return side(a.corner);
  if (a.u == 0 && b.u == 0) return side(parts == 2 ? 3 : (a.corner + corners - 1) % corners);
  if (parts == 2 && a.u == 1 && b.u == 1) return side(1);
  if (parts == 2 && a.v == 1 && b.v == 1) return side(2);
  return {};
}

/// The triangles cover the parameters of every patch once, oriented as the faces; edges belong to as many triangles
/// as there are sheets, inside to two in opposite directions.
inline void expect_watertight(const Surface& whole_surface, const Tessellation& t, const std::string& name) {
  const LimitSurface& surface = whole_surface.data()->limit();
  struct Use {
    std::optional<EdgeId> edge;
    std::uint32_t owner;
    std::size_t forward = 0, backward = 0;
  };
  std::map<std::pair<std::uint32_t, std::uint32_t>, Use> uses;
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> areas;
  ASSERT_EQ(t.corners.size(), t.triangles.size()) << name;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    const auto& [a, b, c] = t.corners[i];
    ASSERT_EQ(a.owner, t.owners[i]) << name;
    const double twice_area = (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v);
    ASSERT_GT(twice_area, 0) << name << ", triangle " << i;
    areas[{a.owner, a.corner}] += twice_area;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t.triangles[i][k], to = t.triangles[i][(k + 1) % 3];
      ASSERT_NE(from, to) << name << ", triangle " << i;
      const auto edge = edge_under(surface, t.corners[i][k], t.corners[i][(k + 1) % 3]);
      const auto [use, fresh] = uses.try_emplace(std::minmax(from, to), Use{edge, a.owner});
      ASSERT_EQ(use->second.edge, edge) << name << ": two edges with the same ends";
      if (!edge) {
        ASSERT_EQ(use->second.owner, a.owner) << name << ": a line inside two owners";
      }
      ++(from < to ? use->second.forward : use->second.backward);
    }
  }
  const std::vector<std::size_t> sheets = sheets_at_edges(surface);
  for (const auto& [ends, use] : uses) {
    if (!use.edge) {
      ASSERT_TRUE(use.forward == 1 && use.backward == 1) << name << ": a crack inside owner " << use.owner;
      continue;
    }
    ASSERT_EQ(use.forward + use.backward, sheets[use.edge->index()])
        << name << ": edge " << use.edge->index();
    if (!surface.topology().ends_fans(*use.edge) && sheets[use.edge->index()] == 2) {
      ASSERT_EQ(use.forward, 1u) << name << ": orientation at edge " << use.edge->index();
    }
  }
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const auto [owner, part] = surface.place(PatchId(p));
    const double whole = surface.rules().triangular() ? 1 : 2;
    if (!surface.has_patch(PatchId(p))) {
      ASSERT_FALSE(areas.contains({owner, part / 2})) << name;
    } else {
      ASSERT_EQ((areas[{owner, surface.rules().triangular() ? 0 : part / 2}]), whole) << name;
    }
  }
}

[[nodiscard]] inline Place between(const std::array<Place, 3>& corner, double b, double c) {
  const auto mix = [&](double x, double y, double z) { return x + b * (y - x) + c * (z - x); };
  return {corner[0].owner, corner[0].corner, std::clamp(mix(corner[0].u, corner[1].u, corner[2].u), 0.0, 1.0),
          std::clamp(mix(corner[0].v, corner[1].v, corner[2].v), 0.0, 1.0)};
}

/// Distance in extended precision of a point and that of a triangle at weights b, c of its corners 1 and 2.
[[nodiscard]] inline double distance_at(const Tessellation& t, std::size_t i, double b, double c,
                                        const std::array<double, 3>& point) {
  std::array<long double, 3> d;
  for (std::size_t a = 0; a < 3; ++a) {
    const long double x = t.positions[t.triangles[i][0]][a], y = t.positions[t.triangles[i][1]][a],
                      z = t.positions[t.triangles[i][2]][a];
    d[a] = x + b * (y - x) + c * (z - x) - point[a];
  }
  return static_cast<double>(std::hypot(std::hypot(d[0], d[1]), d[2]));
}

/// Evaluated limit points are within error_bound of every triangle at its parameters. The largest distance.
inline double expect_near(const Surface& surface, const Tessellation& t, const std::string& name,
                          int steps = 4) {
  SurfaceEvaluator evaluator(surface.data()->limit());  // much faster than evaluate() of each point
  double largest = 0;
  for (std::size_t i = 0; i < t.triangles.size(); ++i) {
    for (int p = 0; p <= steps; ++p) {
      for (int q = 0; p + q <= steps; ++q) {
        const double b = p / static_cast<double>(steps), c = q / static_cast<double>(steps);
        Place at = between(t.corners[i], b, c);
        if (surface.traits().triangular) at.v = std::min(at.v, 1 - at.u);
        const SurfacePoint point = evaluator(at);
        const double found = distance_at(t, i, b, c, {point.point.x, point.point.y, point.point.z});
        largest = std::max(largest, found);
        // Weights and parameters are rounded, by far less than the surface moves.
        const double slack = 1.8 * point.error + 1e-12 * t.error_bound + 0x1p-48 * surface.size();
        EXPECT_LE(found, t.error_bound + slack) << name << ", triangle " << i << " at " << b << ' ' << c;
        if (p == steps || q == steps || p + q == 0) {
          const std::size_t k = p == steps ? 1 : q == steps ? 2 : 0;
          for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_LE(std::fabs(t.positions[t.triangles[i][k]][a] - point.point[a]),
                      t.position_error + point.error)
                << name << ", vertex " << t.triangles[i][k];
          }
        }
        if (::testing::Test::HasFailure()) return largest;
      }
    }
  }
  return largest;
}

}  // namespace snug::testing
