#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>
#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/point_sets.h>
#include <oracle/tagged_shapes.h>

#include <random>
#include <vector>

namespace oracle::dual_twin_cgal_test {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;

std::vector<Point> refined_by_cgal(const TaggedMesh& mesh, unsigned levels) {
  Mesh other;
  std::vector<Mesh::Vertex_index> vertices;
  for (const Point& p : mesh.points) vertices.push_back(other.add_vertex({p[0], p[1], p[2]}));
  for (const auto& polygon : mesh.polygons) {
    std::vector<Mesh::Vertex_index> face;
    for (const std::uint32_t v : polygon) face.push_back(vertices[v]);
    other.add_face(face);
  }
  CGAL::Subdivision_method_3::DooSabin_subdivision(other, CGAL::parameters::number_of_iterations(levels));
  std::vector<Point> points;
  for (const auto v : other.vertices()) {
    const auto& p = other.point(v);
    points.push_back({p.x(), p.y(), p.z()});
  }
  return points;
}

TEST(dual_twin_and_cgal, agree_on_doo_sabin) {
  std::mt19937_64 random(45);
  for (const TaggedMesh& shape : {meshes::cube(), meshes::prism(3), meshes::prism(9), meshes::pyramid(5)}) {
    const TaggedMesh mesh = meshes::shaken(shape, 0.2, random);
    for (int levels = 1; levels <= 3; ++levels)
      EXPECT_LE(farthest_from_partner(refine_dual(mesh, DualScheme::doo_sabin, levels).points,
                                      refined_by_cgal(mesh, static_cast<unsigned>(levels))),
                1e-12);
  }
}

}  // namespace
}  // namespace oracle::dual_twin_cgal_test
