#include <snug/io/formats.h>
#include <testing/written_forms.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view bytes) { return parse_ply(bytes, "input"); },
      [](const ControlMesh& mesh) {
        fuzz::claim_same(mesh, parse_ply(format_ply(mesh), "written"));
        fuzz::claim_same(mesh, parse_ply(testing::big_endian_ply(mesh), "written"));
        fuzz::claim_same(mesh, parse_ply(testing::ascii_ply(mesh), "written"));
      });
  return 0;
}
