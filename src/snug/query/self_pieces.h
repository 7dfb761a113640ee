#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <vector>

#include <snug/bounds/quadratic.h>
#include <snug/run.h>
#include <snug/search/piece.h>
#include <snug/shape/star.h>
#include <snug/surface/level_complex.h>
#include <support/parallel.h>

namespace snug {

/// Patches and their pieces, by name. For one thread.
class SelfPieces {
 public:
  explicit SelfPieces(const LimitSurface& surface) : surface_(&surface) {}

  [[nodiscard]] const Patch& patch(const PieceName& name);
  [[nodiscard]] const Piece& piece(const PieceName& name);
  /// Drops all where many have come together: what was returned is gone. Were any dropped?
  bool drop_many();

 private:
  const LimitSurface* surface_;
  std::unordered_map<PieceName, Patch, PieceNameHash> patches_;
  std::unordered_map<PieceName, Piece, PieceNameHash> pieces_;
  BoundingPoints scratch_;
};

/// Calls body(pieces, i) for each i < count on the threads, each of which drops its pieces in time.
template <class Body>
void for_each_with_pieces(const LimitSurface& surface, std::size_t count, int threads,
                          const WorkMonitor& monitor, const Body& body) {
  parallel_for_with(
      count, threads, [&] { return SelfPieces(surface); },
      [&](SelfPieces& pieces, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          monitor.checkpoint();
          pieces.drop_many();
          body(pieces, i);
        }
      });
}

/// The sectors of a star, with patches that `pieces` keeps.
[[nodiscard]] std::vector<StarSector> sectors_of(SelfPieces& pieces, const LevelStar& star);

/// The offset triangles of pieces as quadratic ones, which are flat.
/// Errors:    InputError (unrepresentable) where one is not finite. Interrupted.
[[nodiscard]] std::vector<QuadraticTriangle> enclosures_of(const LimitSurface& surface,
                                                           std::span<const PieceName> pieces, int threads,
                                                           const WorkMonitor& monitor);

/// Do two pieces of one level have a common corner?
[[nodiscard]] bool share_corner(const LevelComplex& complex, const PieceName& a, const PieceName& b);
/// Their common corners.
[[nodiscard]] std::vector<LevelVertex> common_corners(const LevelComplex& complex, const PieceName& a,
                                                      const PieceName& b);

/// Sorted vertices, each once, and a mark for each.
class MarkedVertices {
 public:
  explicit MarkedVertices(std::vector<LevelVertex> vertices);
  [[nodiscard]] std::size_t count() const { return vertices_.size(); }
  [[nodiscard]] const LevelVertex& operator[](std::size_t i) const { return vertices_[i]; }
  /// May be called by several threads for different vertices.
  void mark(std::size_t i, bool marked) { marks_[i] = marked ? 1 : 0; }
  /// Is one of these marked?
  /// Requires:  they are among the vertices.
  [[nodiscard]] bool any(const std::vector<LevelVertex>& of) const;

 private:
  std::vector<LevelVertex> vertices_;
  std::vector<std::uint8_t> marks_;
};

}  // namespace snug
