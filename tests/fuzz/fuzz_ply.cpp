#include <snug/io/ply.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::read_or_refuse(
      data, size, [](std::string_view bytes) { return parse_ply(bytes, "input"); },
      [](const ControlMesh& mesh) {
        for (const PlyFormat format :
             {PlyFormat::ascii, PlyFormat::binary_little_endian, PlyFormat::binary_big_endian}) {
          fuzz::claim_same(mesh, parse_ply(format_ply(mesh, format), "written"));
        }
      });
  return 0;
}
