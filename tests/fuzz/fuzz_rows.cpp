#include <apps/snug/number_rows.h>

#include "claims.h"

using namespace snug;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  std::size_t numbers = 0;
  try {
    for_each_row(bytes, "input", {3, 6}, "three or six numbers", [&](std::span<const double> row) {
      fuzz::claim(row.size() == 3 || row.size() == 6, "rows have a width that is wanted");
      numbers += row.size();
      return true;
    });
  } catch (const InputError& error) {
    fuzz::claim_one_line(error);
  }
  fuzz::claim(numbers <= size, "a number takes a byte or more");
  return 0;
}
