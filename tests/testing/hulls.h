#pragma once

#include <gtest/gtest.h>
#include <oracle/hull_twin.h>
#include <oracle/winding_twin.h>
#include <snug/hull.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

/// Claims of hulls about a limit surface, checked by the twins from their triangles alone.
namespace snug::testing {

[[nodiscard]] inline oracle::Point twin_point(const Point3& p) { return {p.x, p.y, p.z}; }

[[nodiscard]] inline oracle::HullTwin hull_twin(const Hull& hull) {
  std::vector<oracle::Point> points;
  for (const Point3& p : hull.positions) points.push_back(twin_point(p));
  return {std::move(points), hull.triangles};
}

/// Points of a limit surface, and lines between neighbours with the point of the surface over their middle.
struct LimitSamples {
  struct Chord {
    oracle::Point from, to, middle;
  };
  std::vector<oracle::Point> points;
  std::vector<Chord> chords;  ///< none of dual schemes
};

[[nodiscard]] inline LimitSamples limit_samples(const oracle::TaggedMesh& mesh,
                                                const oracle::WindingScheme& scheme, int levels) {
  LimitSamples samples;
  if (const auto* const dual = std::get_if<oracle::DualScheme>(&scheme)) {
    for (const oracle::DualSample& s : oracle::sample_dual(mesh, *dual, levels))
      samples.points.push_back(s.position);
    return samples;
  }
  using Place = std::array<long, 4>;
  std::map<Place, oracle::Point> at;
  for (const oracle::FaceSample& s : oracle::sample_faces(mesh, std::get<oracle::Rules>(scheme), levels)) {
    samples.points.push_back(s.position);
    const auto lattice = [&](double x) { return std::lround(std::ldexp(x, levels)); };
    at[{s.face, s.part, lattice(s.u), lattice(s.v)}] = s.position;
  }
  for (const auto& [place, from] : at) {
    const auto [face, part, u, v] = place;
    for (const auto& [du, dv] : {std::pair{2L, 0L}, {0L, 2L}, {2L, -2L}}) {
      const auto to = at.find({face, part, u + du, v + dv}),
                 middle = at.find({face, part, u + du / 2, v + dv / 2});
      if (to != at.end() && middle != at.end()) samples.chords.push_back({from, to->second, middle->second});
    }
  }
  return samples;
}

[[nodiscard]] inline oracle::TaggedMesh moved(oracle::TaggedMesh mesh, double factor,
                                              const oracle::Point& by) {
  for (oracle::Point& p : mesh.points) {
    for (std::size_t a = 0; a < 3; ++a) p[a] = factor * p[a] + by[a];
  }
  return mesh;
}

[[nodiscard]] inline oracle::TaggedMesh both(oracle::TaggedMesh mesh, const oracle::TaggedMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (auto polygon : other.polygons) {
    for (std::uint32_t& v : polygon) v += first;
    mesh.polygons.push_back(polygon);
  }
  for (auto crease : other.creases) {
    crease.a += first;
    crease.b += first;
    mesh.creases.push_back(crease);
  }
  for (auto corner : other.corners) {
    corner.vertex += first;
    mesh.corners.push_back(corner);
  }
  return mesh;
}

struct HullCounts {
  std::size_t hulls = 0, triangles = 0, points = 0, chords = 0, sides = 0;
};

/// Every `step`th of some elements.
template <class T, class Visit>
void for_some(const std::vector<T>& all, std::size_t count, const Visit& visit) {
  const std::size_t step = std::max<std::size_t>(1, all.size() / count);
  for (std::size_t i = 0; i < all.size(); i += step) visit(all[i]);
}

/// One hull; `around` if it has to be, with the surface's winding numbers where it is closed.
inline void expect_hull(const Hull& hull, bool outer, double tolerance, const LimitSamples& samples,
                        const oracle::WindingTwin* surface, const std::string& name, HullCounts& counts) {
  const oracle::HullTwin twin = hull_twin(hull);
  const auto contacts = twin.contacts();
  EXPECT_TRUE(contacts.empty()) << name << ": triangles " << contacts[0].first << " and "
                                << contacts[0].second << " touch";
  EXPECT_LE(hull.gap, tolerance) << name;
  const double reach = hull.gap * (1 + 1e-9);
  for_some(samples.points, 300, [&](const oracle::Point& p) {
    EXPECT_LE(twin.distance(p), reach) << name;
    ++counts.points;
  });
  for_some(samples.chords, 600, [&](const LimitSamples::Chord& chord) {
    double bow = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      bow = std::max(bow, std::fabs(chord.middle[a] - 0.5 * (chord.from[a] + chord.to[a])));
    }
    // A line between two points of the surface may leave it only where it bends.
    if (8 * bow > std::min(twin.distance(chord.from), twin.distance(chord.to))) return;
    EXPECT_FALSE(twin.met_by(chord.from, chord.to)) << name << ": a triangle crosses the surface";
    ++counts.chords;
  });
  if (surface != nullptr) {
    EXPECT_EQ(twin.open_edges(), 0u) << name;
    for_some(samples.points, 60, [&](const oracle::Point& p) {
      const std::optional<int> winding = twin.winding(p);
      ASSERT_TRUE(winding) << name << ": a point of the surface is on the hull";
      EXPECT_EQ(*winding != 0, outer) << name << ", at " << p[0] << ' ' << p[1] << ' ' << p[2];
      EXPECT_GE(*winding, 0) << name << ": oriented inward";
    });
    for_some(hull.positions, 60, [&](const Point3& p) {
      const std::optional<int> winding = (*surface)(twin_point(p));
      if (!winding) return;
      EXPECT_EQ(*winding == 0, outer) << name << ", at " << p.x << ' ' << p.y << ' ' << p.z;
      ++counts.sides;
    });
  }
  ++counts.hulls;
  counts.triangles += hull.triangles.size();
}

/// Both hulls of a surface, verified ones, of a mesh with this scheme.
inline void expect_sandwich(const oracle::TaggedMesh& mesh, const oracle::WindingScheme& scheme,
                            const Hulls& hulls, double tolerance, int levels, const std::string& name,
                            HullCounts& counts) {
  const LimitSamples samples = limit_samples(mesh, scheme, levels);
  std::optional<oracle::WindingTwin> surface;
  if (hulls.closed) surface.emplace(mesh, scheme, levels);
  for (const bool outer : {false, true}) {
    const std::optional<Hull>& hull = outer ? hulls.outer : hulls.inner;
    if (!hull) continue;
    expect_hull(*hull, outer, tolerance, samples, surface ? &*surface : nullptr,
                name + (outer ? ", outer" : ", inner"), counts);
  }
  if (hulls.inner && hulls.outer) {
    EXPECT_FALSE(hull_twin(*hulls.inner).met_by(hull_twin(*hulls.outer))) << name << ": the hulls meet";
  }
}

}  // namespace snug::testing
