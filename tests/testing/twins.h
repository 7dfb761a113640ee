#pragma once

#include <oracle/test_meshes.h>
#include <oracle/twin_mesh.h>
#include <snug/mesh/control_mesh.h>
#include <snug/scheme/scheme.h>

#include <random>
#include <vector>

/// Between the plain arrays of the oracles and the library's own meshes.
namespace snug::testing {

[[nodiscard]] inline ControlMesh control_mesh(const oracle::TwinMesh& twin) {
  ControlMesh mesh;
  for (const oracle::Point& p : twin.points) mesh.points.push_back({p[0], p[1], p[2]});
  for (const oracle::Triangle& t : twin.triangles) {
    const VertexId corners[3] = {VertexId(t[0]), VertexId(t[1]), VertexId(t[2])};
    mesh.add_face(corners);
  }
  return mesh;
}

[[nodiscard]] inline SchemeOptions rules(const oracle::TwinMesh& twin) {
  switch (twin.boundary) {
    case oracle::Boundary::edge_only:
      return {Scheme::loop, BoundaryRule::edge_only};
    case oracle::Boundary::none:
      return {Scheme::loop, BoundaryRule::none};
    case oracle::Boundary::edge_and_corner:
      break;
  }
  return {Scheme::loop, BoundaryRule::edge_and_corner};
}

[[nodiscard]] inline oracle::TwinMesh twin_mesh(const ControlMesh& mesh, BoundaryRule boundary) {
  oracle::TwinMesh twin;
  for (const Point3& p : mesh.points) twin.points.push_back({p.x, p.y, p.z});
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    twin.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  twin.boundary = boundary == BoundaryRule::none        ? oracle::Boundary::none
                  : boundary == BoundaryRule::edge_only ? oracle::Boundary::edge_only
                                                        : oracle::Boundary::edge_and_corner;
  return twin;
}

/// Meshes with irregular valences inside and at the boundary, closed and open, for every rule.
[[nodiscard]] inline std::vector<oracle::TwinMesh> assorted_meshes(std::uint64_t seed) {
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(seed);
  std::vector<oracle::TwinMesh> list{meshes::disturbed(meshes::octahedron(), 0, 0.3, random),
                                     meshes::disturbed(meshes::icosahedron(), 12, 0.2, random)};
  for (const std::uint32_t n : {3u, 4u, 5u, 7u, 12u, 50u}) {
    list.push_back(meshes::disturbed(meshes::bipyramid(n), 3, 0.1, random));
  }
  for (const oracle::Boundary rule :
       {oracle::Boundary::edge_and_corner, oracle::Boundary::edge_only, oracle::Boundary::none}) {
    list.push_back(meshes::disturbed(meshes::grid(4, 3, rule), 5, 0.3, random));
    list.push_back(meshes::disturbed(meshes::wheel(7, rule), 2, 0.3, random));
  }
  list.push_back(meshes::wheel(3, oracle::Boundary::edge_and_corner));
  return list;
}

}  // namespace snug::testing
