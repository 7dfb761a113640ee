#include <snug/io/formats.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view text) { return parse_off(text, "input"); },
      [](const ControlMesh& mesh) { fuzz::claim_same(mesh, parse_off(format_off(mesh), "written")); });
  return 0;
}
