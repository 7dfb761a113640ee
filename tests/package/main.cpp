#include <cstdio>

#include <snug/mesh/control_mesh.h>

int main() {
  snug::ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.face_vertices = {snug::VertexId(0), snug::VertexId(1), snug::VertexId(2)};
  mesh.face_offsets = {0, 3};
  std::printf("consumer: %zu vertices, %zu face\n", mesh.vertex_count(), mesh.face_count());
  return mesh.vertex_count() == 3 && mesh.face_count() == 1 ? 0 : 1;
}
