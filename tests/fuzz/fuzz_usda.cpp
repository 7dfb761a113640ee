#include <snug/io/formats.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Notes notes = [](const std::string& line) {
    for (const char c : line) fuzz::claim(c >= ' ' && c <= '~', "notes are one printable line");
  };
  fuzz::read_or_refuse(
      data, size, [&](std::string_view text) { return parse_usda(text, "input", notes); },
      [](const ControlMesh& mesh) {
        fuzz::claim(mesh.tags.scheme.has_value(), "the scheme is told");
        const std::string written = format_usda(mesh, "written");
        const ControlMesh again = parse_usda(written, "written");
        fuzz::claim_same(mesh, again);
        fuzz::claim(format_usda(again, "written") == written, "a round trip keeps tags");
      });
  return 0;
}
