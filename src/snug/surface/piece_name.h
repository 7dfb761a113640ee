#pragma once

#include <cstddef>

#include <snug/patch/piece_path.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A piece of a surface: the patch, and where in it the piece lies.
struct PieceName {
  PatchId patch;
  PiecePath path;

  [[nodiscard]] PieceName child(unsigned child) const { return {patch, path.child(child)}; }
  friend auto operator<=>(const PieceName&, const PieceName&) = default;
};

struct PieceNameHash {
  std::size_t operator()(const PieceName& name) const noexcept {
    const std::uint64_t rest = std::uint64_t{name.patch.value()} << 8 |
                               std::uint64_t{name.path.level()} << 1 | (name.path.turned() ? 1 : 0);
    return mixed(mixed(name.path.i() << 32 ^ name.path.j()) + rest);
  }

 private:
  static std::uint64_t mixed(std::uint64_t x) {
    x ^= x >> 31;
    x *= 0x9e3779b97f4a7c15u;
    return x ^ x >> 29;
  }
};

}  // namespace snug
