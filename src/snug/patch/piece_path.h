#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstdint>
#include <string>

#include <snug/geometry/triangle.h>
#include <support/contract.h>

namespace snug {

/// Where a piece lies in its patch: the triangle (i, j), (i + 1, j), (i, j + 1) of the lattice that cuts each edge of the patch in
/// 2^level, or the one beside it that is turned: (i + 1, j + 1), (i, j + 1), (i + 1, j). Its corners are counted in this order.
class PiecePath {
 public:
  static constexpr unsigned max_level = 60;

  /// The whole patch.
  PiecePath() = default;
  /// Requires:  a triangle of the lattice.
  PiecePath(unsigned level, bool turned, std::uint64_t i, std::uint64_t j)
      : level_(static_cast<std::uint8_t>(level)), turned_(turned), i_(i), j_(j) {}

  [[nodiscard]] unsigned level() const { return level_; }
  [[nodiscard]] bool turned() const { return turned_; }
  [[nodiscard]] std::uint64_t i() const { return i_; }
  [[nodiscard]] std::uint64_t j() const { return j_; }
  /// In the lattice.
  using Corners = std::array<std::array<std::uint64_t, 2>, 3>;
  [[nodiscard]] Corners corners() const {
    if (turned_) return {{{i_ + 1, j_ + 1}, {i_, j_ + 1}, {i_ + 1, j_}}};
    return {{{i_, j_}, {i_ + 1, j_}, {i_, j_ + 1}}};
  }

  /// One of the four pieces that this one splits into: 0 to 2 at that corner, 3 the middle.
  /// Requires:  level() < max_level, child < 4.
  [[nodiscard]] PiecePath child(unsigned child) const {
    SNUG_EXPECT(level_ < max_level && child < 4);
    // From the corner that it is turned at, a child lies against the directions of the lattice.
    const bool along_i = turned_ ? child != 1 : child == 1, along_j = turned_ ? child != 2 : child == 2;
    return {level_ + 1u, turned_ != (child == 3), 2 * i_ + (along_i ? 1 : 0), 2 * j_ + (along_j ? 1 : 0)};
  }
  /// The piece of a level that holds this one.
  /// Requires:  level <= level().
  [[nodiscard]] PiecePath ancestor(unsigned level) const {
    SNUG_EXPECT(level <= level_);
    const unsigned below = level_ - level;
    const std::uint64_t cell = std::uint64_t{1} << below, mask = cell - 1;
    return {level, (i_ & mask) + (j_ & mask) + (turned_ ? 2 : 1) > cell, i_ >> below, j_ >> below};
  }
  /// Requires:  level() > 0.
  [[nodiscard]] PiecePath parent() const { return ancestor(level_ - 1u); }
  /// Which child of its parent the ancestor of level k + 1 is.
  /// Requires:  k < level().
  [[nodiscard]] unsigned digit(unsigned k) const {
    const PiecePath child = ancestor(k + 1), parent = child.parent();
    if (child.turned_ != parent.turned_) return 3;
    const unsigned along_i = child.i_ & 1u, along_j = child.j_ & 1u;
    return parent.turned_ ? 2 * (1 - along_j) + (1 - along_i) : along_i + 2 * along_j;
  }
  /// All digits from the whole patch on.
  [[nodiscard]] std::string text() const {
    std::string digits;
    for (unsigned k = 0; k < level_; ++k) digits += static_cast<char>('0' + digit(k));
    return digits;
  }

  /// 2^level.
  [[nodiscard]] double scale() const { return std::bit_cast<double>((std::uint64_t{1023} + level_) << 52); }
  /// A parameter of the patch as one of the piece. Exact while all digits fit a double.
  [[nodiscard]] TriangleParameter local(TriangleParameter p) const {
    const double u = p.u * scale(), v = p.v * scale();
    if (turned_) return {static_cast<double>(i_ + 1) - u, static_cast<double>(j_ + 1) - v};
    return {u - static_cast<double>(i_), v - static_cast<double>(j_)};
  }
  friend auto operator<=>(const PiecePath&, const PiecePath&) = default;

 private:
  std::uint8_t level_ = 0;
  bool turned_ = false;
  std::uint64_t i_ = 0, j_ = 0;
};

/// A piece's own parameter as one of the patch. Exact while all digits fit a double.
[[nodiscard]] inline TriangleParameter to_face(const PiecePath& path, TriangleParameter p) {
  const double share = 1 / path.scale();
  if (path.turned()) {
    return {share * (static_cast<double>(path.i() + 1) - p.u),
            share * (static_cast<double>(path.j() + 1) - p.v)};
  }
  return {share * (static_cast<double>(path.i()) + p.u), share * (static_cast<double>(path.j()) + p.v)};
}

}  // namespace snug
