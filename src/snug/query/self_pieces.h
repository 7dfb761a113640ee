#pragma once

#include <cstddef>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <snug/bounds/quadratic.h>
#include <snug/monitor.h>
#include <snug/search/piece.h>
#include <snug/surface/level_complex.h>

namespace snug {

/// Patches and their pieces, by name. For one thread.
class SelfPieces {
 public:
  explicit SelfPieces(const LimitSurface& surface) : surface_(&surface) {}

  [[nodiscard]] const Patch& patch(const PieceName& name);
  [[nodiscard]] const Piece& piece(const PieceName& name);
  /// Where many have come together. What was returned is gone.
  /// Drops all where many have come together: what was returned is gone. Were any dropped?
  bool drop_many();

 private:
  const LimitSurface* surface_;
  std::unordered_map<PieceName, Patch, PieceNameHash> patches_;
  std::unordered_map<PieceName, Piece, PieceNameHash> pieces_;
  BoundingPoints scratch_;
};

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

}  // namespace snug
