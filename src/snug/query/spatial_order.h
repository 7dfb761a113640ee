#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <snug/base/point.h>

namespace snug {

/// The points along a curve that fills their box (Morton's), so that ranges of them lie together and threads that share them
/// make few of the same pieces.
/// Requires:  fewer than 2^32 points. Those that are not finite may stand anywhere.
/// Cost:      that of sorting them.
[[nodiscard]] std::vector<std::uint32_t> spatial_order(std::span<const Point3> points);

}  // namespace snug
