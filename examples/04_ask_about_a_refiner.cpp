// Takes a mesh from OpenSubdiv and encloses its limit surface.
//
//   04_ask_about_a_refiner

#include <cstdio>
#include <exception>
#include <memory>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyDescriptor.h>
#include <snug/adapters/opensubdiv.h>
#include <snug/bound.h>

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

namespace {

// An octahedron with Loop subdivision, made as in any program that uses OpenSubdiv.
std::unique_ptr<Far::TopologyRefiner> make_refiner() {
  const std::vector<int> sizes(8, 3);
  const int corners[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
  Far::TopologyDescriptor description;
  description.numVertices = 6;
  description.numFaces = 8;
  description.numVertsPerFace = sizes.data();
  description.vertIndicesPerFace = corners;
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(
      Factory::Create(description, Factory::Options(Sdc::SCHEME_LOOP, options)));
}

}  // namespace

int main() {
  try {
    const std::unique_ptr<Far::TopologyRefiner> refiner = make_refiner();
    const std::vector<float> points{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};

    // Faces, creases, corners, holes and rules come from the refiner, points from the array.
    auto [mesh, options] = snug::opensubdiv::from_refiner(*refiner, points);
    const snug::Surface surface(std::move(mesh), options);

    snug::Box3 box;  // of all enclosures: proved to contain the limit surface
    const auto add_to_box = [&](const snug::PatchEnclosure& piece) {
      for (const snug::Box3& corner : piece.interval.corner) box.add(corner);
    };
    const snug::BoundSummary summary = snug::bound(surface, {.error = 0.001 * surface.size()}, add_to_box);
    std::printf("%zu faces: %llu enclosures contain the surface; its x lies between %g and %g\n",
                surface.mesh().face_count(), static_cast<unsigned long long>(summary.count), box.lower.x,
                box.upper.x);
    return summary.outcome == snug::Outcome::complete ? 0 : 5;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
