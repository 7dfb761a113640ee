#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/bounds/quadratic.h>
#include <snug/patch/piece_path.h>
#include <snug/run.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A piece of a limit surface, and a quadratic triangle near it, in scaled units.
struct QuadraticPiece {
  QuadraticTriangle quadratic;
  PatchId root;
  PiecePath path;
};

/// Pieces that together are the surface, each split until its quadratic's error is at most `error`. Where
/// rounding or the last level ends that, the error is larger. None if these would be more than `most`; memory
/// stays below what so many take.
/// Guarantee: the same for any number of threads.
/// Errors:    InputError (refused) if no face has a limit surface. Interrupted.
[[nodiscard]] std::vector<QuadraticPiece> quadratic_pieces(const LimitSurface& surface, double error,
                                                           int threads, const WorkMonitor& monitor = {},
                                                           std::uint64_t most = UINT64_MAX);

/// Pieces, and which of other pieces each is a part of.
struct RefinedPieces {
  std::vector<QuadraticPiece> pieces;
  std::vector<std::uint32_t> origins;
};
/// The same pieces, but for those that `which` names: these are split further. None if these would be more than
/// `most`.
/// Requires:  which.size() == pieces.size().
[[nodiscard]] RefinedPieces refined(const LimitSurface& surface, std::span<const QuadraticPiece> pieces,
                                    std::span<const std::uint8_t> which, double error, int threads,
                                    const WorkMonitor& monitor = {}, std::uint64_t most = UINT64_MAX);

}  // namespace snug
