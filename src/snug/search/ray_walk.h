#pragma once

#include <cstdint>
#include <vector>

#include <snug/ray.h>
#include <snug/search/piece_cache.h>
#include <snug/search/ray_crossing.h>

namespace snug {

/// A ray in scaled units; lengths along it are from its frame's origin.
struct RayTask {
  RayFrame ray;
  Extent outer,
      inner;  ///< the part that counts: all of `inner`, nothing beyond `outer`; they differ by roundings
  RayQuery query = RayQuery::nearest;
  double precision = 0;
  std::uint64_t budget = 0;
};

/// RayHit in scaled units, at a parameter of a piece.
struct FoundHit {
  Extent along;
  bool certified = false, reached = false;
  int side = 0;
  PieceName piece;
  TriangleParameter at;
};
struct FoundHits {
  std::vector<FoundHit> hits;
  bool complete = true;
};

/// The hits of a ray: ray() of ray.h.
///
/// Pieces that the line misses are dropped, others split, the nearest first. A piece that its line certainly
/// crosses is a hit by itself. Where a line comes too near to the border of a piece, all pieces near the line are
/// collected, and crossings are counted along another line beside it, where that can be done.
///
/// Source:    derivations/rays.md.
[[nodiscard]] FoundHits walk_ray(PieceCache& cache, const RayTask& task, const WorkMonitor& monitor);

}  // namespace snug
