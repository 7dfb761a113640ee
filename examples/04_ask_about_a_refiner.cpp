// Takes a mesh from OpenSubdiv and encloses its limit surface: 04_ask_about_a_refiner

#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyDescriptor.h>
#include <snug/adapters/opensubdiv.h>
#include <snug/bound.h>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

int main() {
  // An octahedron with Loop subdivision, made as in any program that uses OpenSubdiv.
  const std::vector<int> sizes(8, 3);
  const int corners[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  const std::vector<float> points{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
  Far::TopologyDescriptor mesh_of_others;
  mesh_of_others.numVertices = 6;
  mesh_of_others.numFaces = 8;
  mesh_of_others.numVertsPerFace = sizes.data();
  mesh_of_others.vertIndicesPerFace = corners;
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  const std::unique_ptr<Far::TopologyRefiner> refiner(
      Factory::Create(mesh_of_others, Factory::Options(Sdc::SCHEME_LOOP, Sdc::Options())));

  // Faces, creases, corners, holes and rules come from the refiner, points from the array.
  auto [mesh, options] = snug::opensubdiv::from_refiner(*refiner, points);
  const snug::Surface surface(std::move(mesh), options);
  snug::Box3 box;  // of all enclosures: proved to contain the limit surface
  const auto add_to_box = [&](const snug::PatchEnclosure& piece) {
    for (const snug::Box3& corner : piece.interval.corner) box.add(corner);
  };
  static_cast<void>(snug::bound(surface, {.error = 0.001 * surface.size()}, add_to_box));
  std::printf("x lies between %g and %g\n", box.lower.x, box.upper.x);
  return box.lower.x <= box.upper.x ? 0 : 5;
}
