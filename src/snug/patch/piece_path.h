#pragma once

#include <array>
#include <cstdint>
#include <string>

#include <snug/geometry/triangle.h>
#include <support/contract.h>

namespace snug {

/// Which piece of a control face's patch: one digit a level, 0 to 2 the quarter at that corner, 3 the middle.
class PiecePath {
 public:
  static constexpr unsigned max_level = 60;

  [[nodiscard]] unsigned level() const { return level_; }
  [[nodiscard]] unsigned digit(unsigned i) const { return (bits_[i / 32] >> (2 * (i % 32))) & 3u; }
  /// Requires:  level() < max_level, child < 4.
  [[nodiscard]] PiecePath child(unsigned child) const {
    SNUG_EXPECT(level_ < max_level && child < 4);
    PiecePath path = *this;
    path.bits_[level_ / 32] |= static_cast<std::uint64_t>(child) << (2 * (level_ % 32));
    ++path.level_;
    return path;
  }
  [[nodiscard]] std::string text() const {
    std::string digits;
    for (unsigned i = 0; i < level_; ++i) digits += static_cast<char>('0' + digit(i));
    return digits;
  }
  friend bool operator==(const PiecePath&, const PiecePath&) = default;

 private:
  std::array<std::uint64_t, 2> bits_{};
  std::uint8_t level_ = 0;
};

/// A piece's own parameter as one of the whole face. Exact while the digits fit a double.
[[nodiscard]] inline TriangleParameter to_face(const PiecePath& path, TriangleParameter p) {
  for (unsigned i = path.level(); i-- > 0;) {
    const unsigned digit = path.digit(i);
    if (digit == 3) {
      p = {(1 - p.u) / 2, (1 - p.v) / 2};
    } else {
      p = {(digit == 1 ? 1 + p.u : p.u) / 2, (digit == 2 ? 1 + p.v : p.v) / 2};
    }
  }
  return p;
}

}  // namespace snug
