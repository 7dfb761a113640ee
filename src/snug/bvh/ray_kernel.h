#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <snug/bvh/node_kernels.h>
#include <support/point.h>

/// Segments of rays against boxes of nodes, eight boxes or eight segments at once, in single precision. The same bits on every
/// instruction set, and for a box and a segment either way.
namespace snug::kernels {

/// Segments at once.
inline constexpr std::size_t ray_width = 8;

/// Segments of lines, a lane each, as a node sees them.
struct alignas(32) SeenSegments {
  std::array<std::array<float, ray_width>, 3> middle;     ///< relative to the node's origin
  std::array<std::array<float, ray_width>, 3> direction;  ///< of length 1, up to some roundings
  std::array<float, ray_width> half;                      ///< of their lengths
  std::array<float, ray_width> origin;  ///< the node's, along the segment from its middle; rounded once
  std::array<float, ray_width> slack;   ///< boxes this near are met, besides what roundings do
};

/// The same segments in space.
struct alignas(64) SegmentPlaces {
  std::array<std::array<double, ray_width>, 3> middle, direction;
};
/// Writes what depends on the node's origin: the middles, and where along each it is.
void place_segments(const SegmentPlaces& all, const Point3& node_origin, SeenSegments& out);

/// The boxes of a node that one of the segments may meet, a bit each, and lower bounds of where, from its middle.
/// Guarantee: a box without its bit is farther than the slack from the segment; so are points of boxes before `begin`.
/// Source:    derivations/boxes.md, "Segments".
std::uint32_t boxes_met(const NodeBoxes& node, const SeenSegments& segments, std::size_t which,
                        std::array<float, node_width>& begin);
/// The segments that may meet one of the boxes, likewise.
std::uint32_t segments_meeting(const NodeBoxes& node, std::size_t place, const SeenSegments& segments,
                               std::array<float, ray_width>& begin);

/// A quadratic triangle and how far a set may be from it, relative to a node's origin.
struct NearQuadratic {
  const float* net;  ///< corners, then middles of the edges 01, 12, 20, three coordinates each
  float error;
  float reach;  ///< at least the sum of the sizes of a point's coordinates
};
/// Segments, a bit each.
struct Meeting {
  std::uint32_t near;    ///< that may meet the set
  std::uint32_t inside;  ///< of them those that seem to pass all sides on the inner side: a hint
};
/// Guarantee: the lines of those that are not near pass the set with more than their slack, as far as the segments reach.
/// Source:    derivations/rays.md, "Pieces beside a ray".
Meeting segments_meeting(const NearQuadratic& set, const SeenSegments& segments);

}  // namespace snug::kernels
