#pragma once

#include <cstddef>

#include <snug/geometry/interval.h>

/// Loop's masks of interior vertices. [Loop87]
namespace snug::loop {

/// A symmetric mask: one weight for the vertex, one for each vertex of its ring. They sum to 1.
struct RingMask {
  Interval centre, each;
};

/// New position at valence n:  (1 - a) v + a mean(ring),  a = 5/8 - (3 + 2 cos(2 pi/n))^2 / 64.
[[nodiscard]] RingMask vertex_mask(std::size_t n);

/// Limit position:  w v + (1 - w) mean(ring),  w = 1 / (1 + 8 a / 3).
[[nodiscard]] RingMask limit_mask(std::size_t n);

}  // namespace snug::loop
