// Checks certificates, which docs/certificates.md describes:  snug-check [--explain] FILE...
// Exit status: 0 all proved, 1 refused, 2 usage, 3 a file not read.

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "file.h"

namespace {

int check(const char* name, bool explain) {
  const checker::KeptByThread kept;
  std::ifstream stream(name, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(name)) {
    std::fprintf(stderr, "snug-check: cannot read %s\n", name);
    return 3;
  }
  try {
    answers::LeastSlack least;
    for (const std::string& sentence : answers::check(text.view(), least)) {
      std::printf("%s: proved: %s\n", name, sentence.c_str());
    }
    if (explain && least.line > 0)
      std::printf("%s: least slack: %.3g, line %zu\n", name, least.slack, least.line);
    return 0;
  } catch (const std::exception& refused) {
    std::fprintf(stderr, "snug-check: %s: refused: %s\n", name, refused.what());
  }
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  constexpr const char* usage =
      "usage: snug-check [--explain] FILE...\n"
      "Verifies proofs that snug writes with --certificate, and says what is proved.\n"
      "--explain also names the leaf with the least slack.\n"
      "Exit status: 0 all proved, 1 refused, 2 wrong use, 3 a file not read\n";
  const std::string_view option = count > 1 ? arguments[1] : "";
  if (option == "--help") return std::fputs(usage, stdout) < 0 ? 3 : 0;
  const bool explain = option == "--explain";
  const int first = explain ? 2 : 1;
  if (first >= count || (!explain && option.starts_with('-'))) {
    std::fputs(usage, stderr);
    return 2;
  }
  int worst = 0;
  for (int i = first; i < count; ++i) worst = std::max(worst, check(arguments[i], explain));
  return worst;
}
