#include <snug/io/formats.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view bytes) { return parse_gltf(bytes, "input"); },
      [](const ControlMesh& mesh) {
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
          fuzz::claim(mesh.face(FaceId(f)).size() == 3, "faces are triangles");
        }
        // Rounding to floats may weld vertices, but only once.
        const ControlMesh rounded = parse_gltf(format_glb(mesh, "written"), "written");
        fuzz::claim_same(rounded, parse_gltf(format_glb(rounded, "written"), "written"));
      });
  return 0;
}
