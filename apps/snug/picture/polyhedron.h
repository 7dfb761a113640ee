#pragma once

#include <cstdint>
#include <vector>

#include <snug/geometry.h>
#include <support/point.h>

namespace snug {

/// A convex polyhedron by its corners and its facets: convex polygons, counter-clockwise when seen from
/// outside.
struct Polyhedron {
  std::vector<Point3> points;
  std::vector<std::vector<std::uint32_t>> facets;
};

/// Convex hull of the three boxes of an interval triangle, for drawing: what encloses a patch as one solid.
///
/// Guarantee: a closed convex polyhedron, exactly, with coplanar facets merged and no corner within an edge
///            or a facet; its corners are corners of the boxes, moved by at most 2^-41 of the hull's longest
///            side a coordinate. At most 17 facets if the boxes are translates of one another; else at most
///            38, by counting directions (8 octants, 2 in each of 12 quadrants, 6 axes), of which a search
///            over random boxes met 26. A flat hull has two facets, back to back; one that is a segment or a
///            point has none, and its ends for corners.
/// Requires:  boxes that are finite and not empty; the longest side of the hull does not overflow.
/// Errors:    InputError (value) on what is required.
/// Cost:      about 20 microseconds.
/// Source:    gift wrapping; differs: on a lattice of integers, so that every decision is exact.
[[nodiscard]] Polyhedron hull_of_boxes(const IntervalTriangle& triangle);

}  // namespace snug
