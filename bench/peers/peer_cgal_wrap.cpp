#include "peer_cgal_wrap.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <vector>

namespace snug::bench {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

TriangleMesh cgal_alpha_wrap(const TriangleMesh& mesh, double alpha, double offset) {
  std::vector<Kernel::Point_3> points;
  points.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  CGAL::Surface_mesh<Kernel::Point_3> wrap;
  CGAL::alpha_wrap_3(points, mesh.triangles, alpha, offset, wrap);
  TriangleMesh result;
  for (const auto v : wrap.vertices()) {
    const auto& p = wrap.point(v);
    result.points.push_back({p.x(), p.y(), p.z()});
  }
  for (const auto f : wrap.faces()) {
    std::array<std::uint32_t, 3>& t = result.triangles.emplace_back();
    std::size_t k = 0;
    for (const auto v : wrap.vertices_around_face(wrap.halfedge(f))) t[k++] = v.idx();
  }
  return result;
}

}  // namespace snug::bench
