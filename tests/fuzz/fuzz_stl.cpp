#include <snug/io/formats.h>
#include <snug/mesh/weld.h>
#include <testing/written_forms.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view bytes) { return parse_stl(bytes, "input"); },
      [](const ControlMesh& mesh) {
        fuzz::claim_same(mesh, parse_stl(testing::ascii_stl(mesh), "written"));
        // Rounding to floats may weld vertices, but only once.
        const ControlMesh rounded = parse_stl(format_stl(mesh, "written"), "written");
        fuzz::claim_same(rounded, parse_stl(format_stl(rounded, "written"), "written"));
      });
  fuzz::read_or_refuse(
      data, size,
      [](std::string_view bytes) {
        const ControlMesh mesh = parse_stl(bytes, "input");
        ControlMesh welded = mesh;
        weld(welded, longest_side(used_box(mesh)) / 8);
        return welded.face_count() > 0 ? welded : mesh;  // small faces may all be gone
      },
      [](const ControlMesh&) {});
  return 0;
}
