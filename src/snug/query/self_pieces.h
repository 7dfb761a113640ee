#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <snug/run.h>
#include <snug/search/piece_cache.h>
#include <snug/search/piece_set.h>
#include <snug/shape/star.h>
#include <snug/surface/level_complex.h>
#include <support/parallel.h>

namespace snug {

/// The memory that a thread keeps for pieces of a surface that is compared with itself, which are bounded by rows.
inline constexpr std::size_t max_bytes_of_self = std::size_t{64} << 20;
[[nodiscard]] inline PieceCache pieces_of_self(const SurfaceBvh& model) { return PieceCache(model, 0, true); }

/// Calls body(pieces, i) for each i < count on the threads, each of which drops its pieces in time.
template <class Body>
void for_each_with_pieces(const SurfaceBvh& model, std::size_t count, int threads, const WorkMonitor& monitor,
                          const Body& body) {
  parallel_for_with(
      count, threads, [&] { return pieces_of_self(model); },
      [&](PieceCache& pieces, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          monitor.checkpoint();
          pieces.begin(max_bytes_of_self);
          body(pieces, i);
        }
      });
}

/// The sectors of a star, with patches that `pieces` keeps.
[[nodiscard]] std::vector<StarSector> sectors_of(PieceCache& pieces, const LevelStar& star);

/// The offset triangles of pieces, as a set that is prepared.
/// Errors:    InputError (unrepresentable) where one is not finite. Interrupted.
[[nodiscard]] PieceSet enclosures_of(const SurfaceBvh& model, std::span<const PieceName> pieces, int threads,
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
