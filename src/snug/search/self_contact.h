#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/run.h>
#include <support/point.h>

namespace snug {

/// The common part of two triangles beside the vertices that both name and the edge between two of these; or one with itself.
enum class TriangleContact : std::uint8_t {
  none,
  crossing,     ///< a segment inside of both, where they pass through each other
  overlapping,  ///< a part of a plane
  touching,     ///< points, none of which is inside of both
  collapsed,    ///< a triangle without area, with itself: it is compared with no other one
  unknown,      ///< perhaps something: coordinates are too small for exact signs
};

/// Of two triangles by number, a < b, or of one, a = b.
struct TrianglePair {
  std::uint32_t a, b;
  TriangleContact contact;
  friend auto operator<=>(const TrianglePair&, const TrianglePair&) = default;
};

/// The contacts of a mesh with itself, none left out but pairs of a triangle beyond 16 with others: at most `most` of them. `wanted`, a mark
/// for each triangle, leaves out pairs of two without one.
///
/// Guarantee: in exact arithmetic. Pairs are in the order of triangles, the same for any number of threads.
/// Requires:  indices in range; coordinates of at most about 2.
/// Cost:      some microseconds a triangle that is wanted, and one for each other.
/// Source:    derivations/self_contact.md, "Facets".
[[nodiscard]] std::vector<TrianglePair> self_contacts(std::span<const Point3> points,
                                                      std::span<const std::array<std::uint32_t, 3>> triangles,
                                                      std::size_t most, int threads,
                                                      const WorkMonitor& monitor = {},
                                                      std::span<const std::uint8_t> wanted = {});

}  // namespace snug
