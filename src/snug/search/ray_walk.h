#pragma once

#include <cstddef>
#include <span>

#include <snug/search/piece_cache.h>
#include <snug/search/ray_task.h>

namespace snug {

/// Rays that are asked for at once. Of those that come near the surface up to eight that follow one another and lie close together
/// go down the tree as one.
inline constexpr std::size_t rays_at_once = 64;
/// The hits of one ray or more: ray() of ray.h.
///
/// Pieces that the line misses are dropped, others split, the nearest first. A piece that its line certainly
/// crosses is a hit by itself. Where a line comes too near to the border of a piece, all pieces near the line are
/// collected, and crossings are counted along another line beside it, where that can be done.
///
/// Source:    derivations/rays.md.
/// Requires:  at most rays_at_once of them, and as many answers.
void walk_rays(PieceCache& cache, std::span<const RayTask> tasks, const WorkMonitor& monitor,
               std::span<FoundHits> found);

}  // namespace snug
