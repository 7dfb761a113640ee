// Proves all of a file of bounds again:  checker [--self-test] FILE
// Exit status: 0 all proved (with --self-test: and every fault found), 1 rejected, 2 usage, 3 a file not read.

#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "faults.h"
#include "prove.h"
#include "rejected.h"

namespace {

int self_test(const std::vector<std::byte>& bytes) {
  const checker::BoundsFile whole = checker::parse(bytes);
  std::size_t planted = 0, overlooked = 0;
  for (const checker::Scheme scheme : checker::schemes) {
    const checker::BoundsFile file = checker::excerpt(whole, scheme);
    static_cast<void>(checker::prove_file(checker::to_bytes(file)));
    for (const checker::Fault& fault : checker::faults(file)) {
      ++planted;
      try {
        static_cast<void>(checker::prove_file(fault.spoil(file)));
        std::fprintf(stderr, "checker: self test: overlooked: %s, %s\n", checker::name_of(scheme),
                     fault.name.c_str());
        ++overlooked;
      } catch (const checker::Rejected& rejected) {
        std::printf("%s, %s: %s\n", checker::name_of(scheme), fault.name.c_str(), rejected.what());
      }
    }
  }
  std::printf("checker: self test: %zu faults planted, %zu overlooked\n", planted, overlooked);
  return overlooked == 0 ? 0 : 1;
}

int prove(const std::vector<std::byte>& bytes, const char* name) {
  const checker::FileProof proof = checker::prove_file(bytes);
  std::printf(
      "checker: %s: %zu kinds, %zu tables, %zu comparisons with quadratics and %zu frames proved; %zu rows "
      "stored, %zu covered; %zu pieces, depth at most %u\n",
      name, proof.kinds, proof.tables, proof.comparisons, proof.frames, proof.stored_rows, proof.covered,
      proof.pieces, proof.depth);
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  const bool test = !words.empty() && words[0] == "--self-test";
  if (words.size() != (test ? 2 : 1)) {
    std::fprintf(stderr, "usage: checker [--self-test] FILE\n");
    return 2;
  }
  const char* const name = words.back().c_str();
  std::ifstream stream(name, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream) {
    std::fprintf(stderr, "checker: cannot read %s\n", name);
    return 3;
  }
  std::vector<std::byte> bytes(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) bytes[i] = static_cast<std::byte>(text[i]);
  try {
    return test ? self_test(bytes) : prove(bytes, name);
  } catch (const checker::Rejected& rejected) {
    std::fprintf(stderr, "checker: %s: rejected: %s\n", name, rejected.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "checker: %s: %s\n", name, error.what());
  }
  return 1;
}
