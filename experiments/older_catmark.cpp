#include <experiments/older_catmark.h>

#include <utility>

#include <snug/scheme/creases.h>
#include <snug/scheme/refine.h>
#include <support/error.h>

namespace snug {

ControlMesh subdivide_by_older_rule(ControlMesh mesh, unsigned level) {
  if (!mesh.tags.creases.empty() || !mesh.tags.corners.empty()) {
    throw InputError(InputProblem::refused,
                     "the older rule knows no creases and corners; give a mesh without them");
  }
  const SchemeOptions rules = with_tags({.scheme = Scheme::catmark}, mesh.tags);
  Topology topology = require_subdividable(mesh, rules);
  Sharpness sharpness = sharpness_of(mesh, topology);
  Star star;
  for (unsigned step = 0; step < level; ++step) {
    RefinedTopology refined = refine(topology, rules, sharpness);
    ControlMesh fine = refined_mesh(mesh, rules, topology, refined);
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      if (topology.isolated(VertexId(v))) continue;
      gather_star({topology, rules, sharpness}, VertexId(v), star);
      if (vertex_rule(star.sharpness, star.spokes) != VertexRule::smooth) continue;
      // The standard rule's point P has Q + 2 R = n P - (n - 3) S.
      const double quarters = static_cast<double>(star.faces.size()) / 4;
      fine.points[v] = mesh.points[v] + quarters * (fine.points[v] - mesh.points[v]);
    }
    mesh = std::move(fine);
    topology = std::move(refined.topology);
    sharpness = std::move(refined.sharpness);
  }
  return mesh;
}

}  // namespace snug
