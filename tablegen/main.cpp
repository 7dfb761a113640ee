// Makes the rows, tables and quadratics of common kinds, for checker to prove:  tablegen FILE

#include <cstdio>
#include <exception>
#include <fstream>

#include "file_writer.h"
#include "kinds.h"

namespace {

int run(const char* name) {
  const std::vector<snug::KindKey> kinds = tablegen::common_kinds();
  const std::vector<std::byte> bytes = tablegen::file_of(kinds);
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
