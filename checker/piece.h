#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "bounds_file.h"
#include "real.h"

namespace checker {

/// Weights of the root's control points.
using Row = std::vector<Real>;

/// A place in the root's parameter triangle, weights of its corners 1 and 2 times 2^30.
using Place = std::array<std::int64_t, 2>;
inline constexpr unsigned place_bits = 30;

/// A triangle of a net that was subdivided some levels, with all that its limit patch depends on: the faces
/// around its corners, and their vertices as rows.
struct Piece {
  using Face = std::array<std::size_t, 3>;  // counter-clockwise

  std::array<std::size_t, 3> corners{};
  std::array<bool, 3> sharp{};
  std::array<Place, 3> places{};
  std::vector<Face> faces;  // each once, the piece's own among them
  std::vector<std::shared_ptr<const Row>> rows;
  unsigned depth = 0;

  /// The ring of corner k, counter-clockwise from corner k + 1 round a closed fan, else from one boundary
  /// neighbour to the other.
  struct Ring {
    std::vector<std::size_t> vertices;
    bool closed = false;
    std::size_t own = 0;  // place of corner k + 1
    [[nodiscard]] Fan fan(bool sharp) const;
  };
  [[nodiscard]] Ring ring(std::size_t k) const;
  /// All corners smooth, with six faces inside or three at a boundary: then the limit patch is a quartic.
  [[nodiscard]] bool polynomial() const;
};

/// The net of a kind, its control points as unit rows, numbered as snug/patch/neighbourhood.h documents.
/// Errors:    Rejected for a key that no patch has.
[[nodiscard]] Piece root_piece(const Key& key);

/// One step of Loop's scheme: children 0 to 2 keep that corner as their own corner of the same number; 3 is
/// the middle one.
/// Errors:    Rejected if a child has other fans than the scheme gives it, or past 28 levels.
[[nodiscard]] std::array<Piece, 4> split(const Piece& piece);

/// Where corner k of the piece goes in the limit.
[[nodiscard]] Row limit(const Piece& piece, std::size_t k);

/// The control points of a piece in the order of a kind whose corner 0 is corner `first` of the piece. None if
/// it is not of that kind so.
[[nodiscard]] std::vector<const Row*> net_of(const Piece& piece, const Key& key, std::size_t first);

}  // namespace checker
