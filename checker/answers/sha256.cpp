#include <array>
#include <bit>
#include <cstdio>

#include "words.h"

namespace answers {
namespace {

using Word = std::uint32_t;
__extension__ using Wide = unsigned __int128;

// The first 32 bits of the fractional parts of the square or cube roots of the first primes.
template <std::size_t Count>
std::array<Word, Count> fractions_of_roots(int degree) {
  std::array<Word, Count> words{};
  Word prime = 2;
  for (Word& word : words) {
    // The largest x with (x / 2^32)^degree <= prime, of which the low 32 bits are the fraction.
    Wide root = 0;
    for (int bit = 36; bit >= 0; --bit) {
      const Wide more = root | static_cast<Wide>(1) << bit;
      // more^3 has up to 108 bits; both sides are compared in units of 2^-32 or 2^-96.
      const Wide power = degree == 2 ? more * more : more * more * more;
      if (power <= static_cast<Wide>(prime) << (32 * degree)) root = more;
    }
    word = static_cast<Word>(root);
    for (bool composite = true; composite;) {
      ++prime;
      composite = false;
      for (Word d = 2; d * d <= prime; ++d) composite = composite || prime % d == 0;
    }
  }
  return words;
}

void mix(std::array<Word, 8>& hash, std::string_view block) {
  static const std::array<Word, 64> constants = fractions_of_roots<64>(3);
  std::array<Word, 64> w{};
  for (std::size_t i = 0; i < 16; ++i) {
    for (std::size_t k = 0; k < 4; ++k)
      w[i] = w[i] << 8 | static_cast<unsigned char>(block[4 * i + k]);
  }
  for (std::size_t i = 16; i < 64; ++i) {
    const Word a = w[i - 15], b = w[i - 2];
    w[i] = w[i - 16] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ a >> 3) + w[i - 7] +
           (std::rotr(b, 17) ^ std::rotr(b, 19) ^ b >> 10);
  }
  std::array<Word, 8> s = hash;
  for (std::size_t i = 0; i < 64; ++i) {
    const Word sum1 = std::rotr(s[4], 6) ^ std::rotr(s[4], 11) ^ std::rotr(s[4], 25);
    const Word sum0 = std::rotr(s[0], 2) ^ std::rotr(s[0], 13) ^ std::rotr(s[0], 22);
    const Word t1 = s[7] + sum1 + ((s[4] & s[5]) ^ (~s[4] & s[6])) + constants[i] + w[i];
    const Word t2 = sum0 + ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
    s = {t1 + t2, s[0], s[1], s[2], s[3] + t1, s[4], s[5], s[6]};
  }
  for (std::size_t i = 0; i < 8; ++i) hash[i] += s[i];
}

}  // namespace

std::string sha256(std::string_view bytes) {
  std::string padded(bytes);
  padded += '\x80';
  while (padded.size() % 64 != 56) padded += '\0';
  const std::uint64_t bits = 8 * static_cast<std::uint64_t>(bytes.size());
  for (int shift = 56; shift >= 0; shift -= 8) padded += static_cast<char>(bits >> shift & 255);
  std::array<Word, 8> hash = fractions_of_roots<8>(2);
  for (std::size_t i = 0; i < padded.size(); i += 64)
    mix(hash, std::string_view(padded).substr(i, 64));
  std::string digits;
  for (const Word word : hash) {
    std::array<char, 9> text{};
    std::snprintf(text.data(), text.size(), "%08x", word);
    digits += text.data();
  }
  return digits;
}

}  // namespace answers
