#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/point_sets.h>
#include <oracle/tagged_shapes.h>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Tools/Subdivider/Uniform/MidpointT.hh>
#include <random>
#include <vector>

namespace oracle::dual_twin_openmesh_test {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<Traits>;

/// Two steps to the midpoints of edges are one of Midedge.
std::vector<Point> refined_by_openmesh(const TaggedMesh& mesh, int levels) {
  Mesh other;
  std::vector<Mesh::VertexHandle> vertices;
  for (const Point& p : mesh.points) vertices.push_back(other.add_vertex({p[0], p[1], p[2]}));
  for (const auto& polygon : mesh.polygons) {
    std::vector<Mesh::VertexHandle> face;
    for (const std::uint32_t v : polygon) face.push_back(vertices[v]);
    other.add_face(face);
  }
  OpenMesh::Subdivider::Uniform::MidpointT<Mesh> midpoint;
  midpoint.attach(other);
  midpoint(static_cast<std::size_t>(2 * levels));
  midpoint.detach();
  other.garbage_collection();
  std::vector<Point> points;
  for (const auto v : other.vertices())
    points.push_back({other.point(v)[0], other.point(v)[1], other.point(v)[2]});
  return points;
}

TEST(dual_twin_and_openmesh, agree_on_midedge) {
  std::mt19937_64 random(46);
  for (const TaggedMesh& shape : {meshes::cube(), meshes::prism(3), meshes::prism(9), meshes::pyramid(5)}) {
    const TaggedMesh mesh = meshes::shaken(shape, 0.2, random);
    for (int levels = 1; levels <= 3; ++levels)
      EXPECT_LE(farthest_from_partner(refine_dual(mesh, DualScheme::midedge, levels).points,
                                      refined_by_openmesh(mesh, levels)),
                1e-12);
  }
}

}  // namespace
}  // namespace oracle::dual_twin_openmesh_test
