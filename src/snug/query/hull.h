#pragma once

#include <snug/hull.h>
#include <snug/search/surface_bvh.h>

namespace snug {

/// hull() of hull.h.
[[nodiscard]] Hulls hull(const SurfaceBvh& surface, const HullOptions& options, const Run& run = {});

/// The places where hulls are not proved to be what hull() guarantees, whoever made them: from their positions and
/// triangles alone. None if `hulls.inner`, `hulls.outer`, as far as they are there, and `hulls.closed` hold.
/// Requires:  indices in range, an owner for each triangle; of the options only `error` counts, which must be set.
[[nodiscard]] std::vector<HullProblem> problems_of(const SurfaceBvh& surface, const Hulls& hulls,
                                                   const HullOptions& options, const Run& run = {});

}  // namespace snug
