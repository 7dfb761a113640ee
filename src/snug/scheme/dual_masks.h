#pragma once

#include <cstddef>
#include <vector>

#include <snug/geometry/interval.h>

/// Masks of the dual schemes: each corner of a face of n vertices moves by these weights, its own first, then around.
/// Regular are quads.
namespace snug::dual {

/// a_0 = 1/4 + 5/(4n), a_i = (3 + 2 cos(2 pi i/n)) / (4n).  [DooSabin78]
[[nodiscard]] std::vector<Interval> doo_sabin_mask(std::size_t n);

/// v/2 + prev/4 + next/4: two steps of edge midpoints.  [PetersReif97]
[[nodiscard]] std::vector<Interval> midedge_mask(std::size_t n);

/// Subdominant eigenvalues at a face of n vertices.
[[nodiscard]] double doo_sabin_subdominant(std::size_t n);
[[nodiscard]] double midedge_subdominant(std::size_t n);

}  // namespace snug::dual
