#include <snug/io/formats.h>
#include <snug/io/zip.h>

#include "claims.h"

using namespace snug;

namespace {

void check(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    fuzz::claim(mesh.face(FaceId(f)).size() == 3, "faces are triangles");
  }
  // Triangles that name a vertex twice are not written.
  try {
    const ControlMesh written = parse_3mf(format_3mf(mesh, "written"), "written");
    fuzz::claim_same(written, parse_3mf(format_3mf(written, "written"), "written"));
    fuzz::claim(written.metres_per_unit == mesh.metres_per_unit, "the unit is kept");
  } catch (const InputError&) {
    // All of them named a vertex twice.
  }
}

// Bytes as a package, and as the model in one: most of the former fail in the archive.
std::string package_of(std::string_view model) {
  ZipWriter archive;
  archive.add("3D/3dmodel.model", model);
  return archive.finish("input");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parse = [](std::string_view bytes) {
    return parse_3mf(begins_like_zip(bytes) ? std::string(bytes) : package_of(bytes), "input");
  };
  fuzz::read_or_refuse(data, size, parse, check);
  return 0;
}
