// Makes the file that is compiled into the library, src/snug/bounds/shipped.bin:  tablegen FILE

#include <cstdio>
#include <exception>
#include <fstream>
#include <utility>

#include "file_writer.h"
#include "kinds.h"

namespace {

constexpr const char* provenance =
    "made by tablegen of snug, no arguments; kinds: tablegen/kinds.h; arithmetic: IEEE doubles rounded to "
    "nearest, error terms by snug/geometry/rounding.h; proved by checker";

int run(const char* name) {
  snug::KindCache library;
  std::vector<tablegen::KindBounds> kinds;
  for (const snug::KindKey& key : tablegen::shipped_kinds()) {
    const snug::Kind& kind = library.find(key);
    snug::BoundRows rows = snug::make_bound_rows(kind);
    snug::BoundTable table = snug::make_bound_table(kind, rows);
    kinds.push_back({key, std::move(rows), std::move(table)});
  }
  const std::vector<std::byte> bytes = tablegen::file_of(kinds, provenance);
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) {
    std::fprintf(stderr, "tablegen: cannot write %s\n", name);
    return 3;
  }
  std::printf("%s: %zu kinds, %zu bytes\n", name, kinds.size(), bytes.size());
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: tablegen FILE\n");
    return 2;
  }
  try {
    return run(arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tablegen: %s\n", error.what());
    return 1;
  }
}
