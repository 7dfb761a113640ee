#include <support/number.h>

#include <algorithm>
#include <string>

#include "claims.h"

using namespace snug;

namespace {

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

void check_real(const std::string& word) {
  const ParsedReal real = parse_real(word);
  if (!real.fault.empty()) return;
  fuzz::claim(std::isfinite(real.value), "numbers are finite");
  char* end = nullptr;
  fuzz::claim(same_bits(std::strtod(word.c_str(), &end), real.value), "numbers are what the C library reads");
  fuzz::claim(end == word.c_str() + word.size(), "no number stops early");
  std::string written;
  append_real(written, real.value);
  fuzz::claim(same_bits(parse_real(written).value, real.value), "a round trip keeps numbers");
}

void check_integer(const std::string& word) {
  const auto value = parse_integer(word);
  if (!value || *value < 0) return;
  std::string written;
  append_integer(written, static_cast<std::uint64_t>(*value));
  fuzz::claim(parse_integer(written) == value, "a round trip keeps whole numbers");
  fuzz::claim(parse_real(word).fault.empty() || word.size() > 300, "whole numbers are numbers");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Words of a file hold no NUL bytes.
  const std::string word(reinterpret_cast<const char*>(data),
                         std::find(data, data + size, std::uint8_t{0}) - data);
  check_real(word);
  check_integer(word);
  // The eight first bytes as a double, so that writing meets all of them.
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(size, 8); ++i) bits = bits << 8 | data[i];
  if (const double value = std::bit_cast<double>(bits); std::isfinite(value)) {
    std::string written;
    append_real(written, value);
    const ParsedReal again = parse_real(written);
    fuzz::claim(again.fault.empty() && same_bits(again.value, value), "what is written is read again");
  }
  return 0;
}
