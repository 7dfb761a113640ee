#pragma once

#include <oracle/tagged_mesh.h>
#include <oracle/tagged_shapes.h>
#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

/// Tagged meshes of the oracle as the library's own, and many of them.
namespace snug::testing {

[[nodiscard]] inline ControlMesh control_mesh(const oracle::TaggedMesh& twin,
                                              const oracle::Rules& rules = {}) {
  ControlMesh mesh;
  for (const oracle::Point& p : twin.points) mesh.points.push_back({p[0], p[1], p[2]});
  for (const auto& polygon : twin.polygons) {
    std::vector<VertexId> corners;
    for (const std::uint32_t v : polygon) corners.emplace_back(v);
    mesh.add_face(corners);
  }
  for (const auto& c : twin.creases) mesh.tags.creases.push_back({VertexId(c.a), VertexId(c.b), c.sharpness});
  for (const auto& c : twin.corners) mesh.tags.corners.push_back({VertexId(c.vertex), c.sharpness});
  for (const std::uint32_t f : twin.holes) mesh.tags.holes.emplace_back(f);
  mesh.tags.crease_method = rules.chaikin ? CreaseMethod::chaikin : CreaseMethod::uniform;
  mesh.tags.smooth_triangles = rules.smooth_triangles ? SmoothTriangles::smooth : SmoothTriangles::catmark;
  return mesh;
}

[[nodiscard]] inline SchemeOptions options_of(const oracle::Rules& rules) {
  SchemeOptions options;
  options.scheme = rules.scheme == oracle::PrimalScheme::loop ? Scheme::loop : Scheme::catmark;
  options.boundary = rules.boundary == oracle::Boundary::none        ? BoundaryRule::none
                     : rules.boundary == oracle::Boundary::edge_only ? BoundaryRule::edge_only
                                                                     : BoundaryRule::edge_and_corner;
  options.creases = rules.chaikin ? CreaseMethod::chaikin : CreaseMethod::uniform;
  options.triangles = rules.smooth_triangles ? SmoothTriangles::smooth : SmoothTriangles::catmark;
  return options;
}

struct TaggedCase {
  std::string name;
  oracle::TaggedMesh mesh;
  oracle::Rules rules;
};

[[nodiscard]] inline std::string text_of(const oracle::Rules& rules) {
  const char* const boundary[] = {"edge and corner", "edge only", "none"};
  return std::string(rules.scheme == oracle::PrimalScheme::loop ? "loop, " : "catmark, ") +
         boundary[static_cast<int>(rules.boundary)] + (rules.chaikin ? ", chaikin" : "") +
         (rules.smooth_triangles ? ", smooth triangles" : "");
}

/// Plain shapes: polygons, high valences, boundaries, every sort of non-manifold place.
[[nodiscard]] inline std::vector<std::pair<std::string, oracle::TaggedMesh>> plain_shapes() {
  namespace meshes = oracle::meshes;
  return {{"cube", meshes::cube()},
          {"grid", meshes::quad_grid(4, 3)},
          {"strip", meshes::quad_grid(3, 1)},
          {"prism 3", meshes::prism(3)},
          {"prism 5", meshes::prism(5)},
          {"prism 6", meshes::prism(6)},
          {"pyramid 3", meshes::pyramid(3)},
          {"pyramid 7", meshes::pyramid(7)},
          {"pyramid 24", meshes::pyramid(24)},
          {"mixed strip", meshes::mixed_strip()},
          {"book 3", meshes::book(3)},
          {"book 4", meshes::book(4)},
          {"cubes at a vertex", meshes::two_cubes_at_a_vertex()},
          {"cells at edges", meshes::cells({{0, 0, 0}, {0, 0, 1}, {1, 1, 0}, {1, 1, 1}, {2, 0, 1}})},
          {"moebius", meshes::moebius(5)},
          {"back to back", meshes::back_to_back()},
          {"same ways", meshes::same_ways()},
          {"valence two", meshes::valence_two_inside()}};
}

/// Tags some edges, vertices and faces.
inline void tag(oracle::TaggedMesh& mesh, std::mt19937_64& random, bool holes) {
  const double values[] = {0.3, 1, 2.5, 10, 1.7, 10};
  const auto value = [&] { return values[random() % 6]; };
  const auto share = 3 + random() % 4;
  for (const auto& polygon : mesh.polygons) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      if (random() % share == 0)
        mesh.creases.push_back({polygon[k], polygon[(k + 1) % polygon.size()], value()});
    }
  }
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (random() % 10 == 0) mesh.corners.push_back({v, value()});
  }
  for (std::uint32_t f = 0; holes && f < mesh.polygons.size(); ++f) {
    if (random() % 6 == 0) mesh.holes.push_back(f);
  }
}

/// One edge, a path, and two paths that cross, of the inner edges of a grid.
[[nodiscard]] inline std::vector<std::pair<std::string, oracle::TaggedMesh>> creased_grids() {
  std::vector<std::pair<std::string, oracle::TaggedMesh>> list;
  const auto at = [](std::uint32_t i, std::uint32_t j) { return j * 5 + i; };
  for (const double s : {0.3, 1.0, 2.5, 10.0}) {
    oracle::TaggedMesh dart = oracle::meshes::quad_grid(4, 4);
    dart.creases = {{at(1, 2), at(2, 2), s}, {at(2, 2), at(3, 2), s}};
    list.emplace_back("darts " + std::to_string(s), dart);
    dart.creases = {{at(2, 2), at(3, 2), s}};
    list.emplace_back("one sharp edge " + std::to_string(s), dart);
    oracle::TaggedMesh crossing = oracle::meshes::quad_grid(4, 4);
    for (std::uint32_t i = 0; i < 4; ++i) {
      crossing.creases.push_back({at(i, 2), at(i + 1, 2), s});
      if (i % 2 == 1)
        list.emplace_back("path " + std::to_string(i + 1) + " of " + std::to_string(s), crossing);
    }
    for (std::uint32_t j = 0; j < 4; ++j) crossing.creases.push_back({at(2, j), at(2, j + 1), 2.5});
    list.emplace_back("crossing " + std::to_string(s), crossing);
    oracle::TaggedMesh bend = oracle::meshes::quad_grid(4, 4);
    bend.creases = {
        {at(0, 2), at(1, 2), s}, {at(1, 2), at(2, 2), 10}, {at(2, 2), at(2, 3), 10}, {at(2, 3), at(2, 4), s}};
    bend.corners = {{at(1, 1), s}};
    list.emplace_back("bend " + std::to_string(s), bend);
  }
  return list;
}

/// Shapes under every rule, moved at random; `rounds` times some tags on each.
[[nodiscard]] inline std::vector<TaggedCase> tagged_cases(oracle::PrimalScheme scheme, std::uint64_t seed,
                                                          int rounds = 1) {
  using oracle::Boundary;
  std::mt19937_64 random(seed);
  std::vector<TaggedCase> list;
  const auto add = [&](std::string name, const oracle::TaggedMesh& mesh, oracle::Rules rules) {
    rules.scheme = scheme;
    rules.clamp_dart_edges = true;
    list.push_back({std::move(name), oracle::meshes::shaken(mesh, 0.3, random), rules});
  };
  const auto shape = [&](const oracle::TaggedMesh& mesh) {
    return scheme == oracle::PrimalScheme::loop ? oracle::meshes::triangulated(mesh) : mesh;
  };
  for (const auto& [name, plain] : plain_shapes()) {
    if (scheme == oracle::PrimalScheme::loop && (name == "valence two" || name == "same ways"))
      continue;  // see sound/schemes_test.cpp
    const oracle::TaggedMesh mesh = shape(plain);
    for (const Boundary boundary : {Boundary::edge_and_corner, Boundary::edge_only, Boundary::none}) {
      oracle::Rules rules;
      rules.boundary = boundary;
      add(name, mesh, rules);
      for (int round = 0; round < rounds; ++round) {
        oracle::TaggedMesh tagged = mesh;
        tag(tagged, random, random() % 3 == 0);
        rules.chaikin = random() % 2 == 0;
        rules.smooth_triangles = scheme == oracle::PrimalScheme::catmull_clark && random() % 2 == 0;
        add(name + ", tags " + std::to_string(round), tagged, rules);
      }
    }
  }
  for (const auto& [name, plain] : creased_grids()) {
    oracle::Rules rules;
    rules.chaikin = random() % 2 == 0;
    rules.boundary = static_cast<Boundary>(random() % 3);
    add(name, shape(plain), rules);
  }
  return list;
}

}  // namespace snug::testing
