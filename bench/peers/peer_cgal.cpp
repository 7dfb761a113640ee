#include "peer_cgal.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/Surface_mesh.h>

#include <stdexcept>
#include <vector>

namespace snug::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

struct CgalMesh::Impl {
  CGAL::Surface_mesh<Kernel::Point_3> mesh;
};

CgalMesh::CgalMesh(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  std::vector<CGAL::Surface_mesh<Kernel::Point_3>::Vertex_index> vertices;
  vertices.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) vertices.push_back(impl_->mesh.add_vertex({p.x, p.y, p.z}));
  for (const auto& t : mesh.triangles) {
    const auto face = impl_->mesh.add_face(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    if (!face.is_valid()) throw std::runtime_error("CGAL takes manifold meshes only");
  }
}

CgalMesh::~CgalMesh() = default;

double cgal_hausdorff(const CgalMesh& from, const CgalMesh& to, double error) {
  return CGAL::Polygon_mesh_processing::bounded_error_Hausdorff_distance<CGAL::Sequential_tag>(
      from.impl().mesh, to.impl().mesh, error);
}

}  // namespace snug::bench
