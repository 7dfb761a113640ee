#include <snug/mesh/control_mesh.h>

namespace snug {

Box3 used_box(const ControlMesh& mesh) {
  Box3 box;
  for (const VertexId v : mesh.face_vertices) {
    if (v.index() < mesh.vertex_count()) box.add(mesh.points[v.index()]);
  }
  return box;
}

}  // namespace snug
