#pragma once

#include <cstddef>

#include <snug/geometry/interval.h>

/// Loop's masks, all of them, and nothing else. A ring is listed counter-clockwise; at a boundary vertex it
/// runs from one boundary neighbour to the other. [Loop87]; boundary rules as in [DeRose98] and OpenSubdiv.
namespace snug::loop {

/// A symmetric mask: one weight for the vertex, one for each vertex of its ring. They sum to 1.
struct RingMask {
  Interval centre, each;
};

/// New position of an interior vertex of valence n:  (1 - a) v + a mean(ring),  a = 5/8 - (3 + 2 cos(2
/// pi/n))^2 / 64.
[[nodiscard]] RingMask vertex_mask(std::size_t n);

/// Limit position of an interior vertex:  w v + (1 - w) mean(ring),  w = 1 / (1 + 8 a / 3).
[[nodiscard]] RingMask limit_mask(std::size_t n);

/// New point of an interior edge: its ends, and the two vertices that face it.
inline constexpr double edge_end = 0.375, edge_wing = 0.125;

/// New position of a vertex on a smooth boundary curve: itself, its two neighbours on the curve. Limit
/// likewise.
inline constexpr double curve_centre = 0.75, curve_side = 0.125;
[[nodiscard]] RingMask curve_limit_mask();  // 2/3, 1/6

/// New point of a boundary edge.
inline constexpr double curve_edge_end = 0.5;

/// Subdominant eigenvalue at an interior vertex: 3/8 + cos(2 pi/n) / 4. The ring shrinks by it a level.
[[nodiscard]] double subdominant(std::size_t n);

/// Eigenvalue of the direction across a smooth boundary with `faces` faces: 3/8 + cos(pi/faces) / 4.
[[nodiscard]] double subdominant_across_boundary(std::size_t faces);

}  // namespace snug::loop
