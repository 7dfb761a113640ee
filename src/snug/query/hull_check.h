#pragma once

#include <snug/hull.h>

namespace snug {

/// The places where hulls are not proved to be what hull() guarantees, whoever made them: from their positions and
/// triangles alone. None if `hulls.inner`, `hulls.outer`, as far as they are there, and `hulls.closed` hold.
/// Requires:  indices in range, an owner for each triangle; of the options only `error` counts, which must be set.
[[nodiscard]] std::vector<HullProblem> problems_of(const Surface& surface, const Hulls& hulls,
                                                   const HullOptions& options, const Run& run = {});

}  // namespace snug
