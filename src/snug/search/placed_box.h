#pragma once

#include <snug/geometry/motion.h>
#include <snug/search/surface_bvh.h>

namespace snug {

/// A box, in mesh units and world coordinates, around a placed surface, and so around the solid that it bounds. Infinite
/// where doubles do not reach.
///
/// Guarantee: contains the image of the limit surface under exactly the pose's twelve doubles.
/// Cost:      50 ns.
/// Source:    derivations/boxes.md, "Parts of a scene".
[[nodiscard]] Box3 placed_box(const SurfaceBvh& model, const Motion& pose);

}  // namespace snug
