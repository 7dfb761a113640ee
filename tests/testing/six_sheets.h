#pragma once

#include <vector>

#include <snug/mesh.h>

namespace snug::testing {

/// A cube of six open sheets, each with vertices of its own, moved away from the middle by `gap`.
inline ControlMesh six_sheets(double gap) {
  ControlMesh mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      std::vector<VertexId> face;
      for (int k = 0; k < 4; ++k) {
        const int turn = upper ? k : 3 - k;
        Point3 p;
        p[axis] = upper ? 1 + gap : -gap;
        p[(axis + 1) % 3] = turn == 1 || turn == 2;
        p[(axis + 2) % 3] = turn >= 2;
        face.emplace_back(mesh.points.size());
        mesh.points.push_back(p);
      }
      mesh.add_face(face);
    }
  }
  return mesh;
}

}  // namespace snug::testing
