#include <snug/io/formats.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view text) { return parse_obj(text, "input"); },
      [](const ControlMesh& mesh) {
        const std::string written = format_obj(mesh);
        const ControlMesh again = parse_obj(written, "written");
        fuzz::claim_same(mesh, again);
        fuzz::claim(format_obj(again) == written, "a round trip keeps tags");
      });
  return 0;
}
