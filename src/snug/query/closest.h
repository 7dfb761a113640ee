#pragma once

#include <snug/distance.h>
#include <snug/search/piece_cache.h>

/// Questions of distance.h about a surface whose pieces are at hand.
namespace snug {

[[nodiscard]] ClosestPoint closest_point(PieceCache& cache, const Point3& to, const Precision& options,
                                         const Run& run = {});
[[nodiscard]] std::optional<bool> contains(PieceCache& cache, const Point3& point, const Run& run = {});
[[nodiscard]] SignedDistance signed_distance(PieceCache& cache, const Point3& point, const Precision& options,
                                             const Run& run = {});

}  // namespace snug
