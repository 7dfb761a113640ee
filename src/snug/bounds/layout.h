#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include <snug/patch/kind_cache.h>

namespace snug {

/// A place in the plane, in affine coordinates: weights of corners 1 and 2 of a patch; corner 0 has the rest.
using LayoutPoint = std::array<double, 2>;

/// Is a kind laid out by the rings of its corners? Loop where the valences say everything.
[[nodiscard]] bool laid_by_rings(const KindKey& key);

/// Where the control points of a kind lie in the plane over which its basis functions are bounded:
/// fair_layout(), or by rings with corners, the first three control points, at (0, 0), (1, 0) and (0, 1).
///
/// By rings around a lone_centre(): the dissertation's, spokes of equal length and angle. Others: each
/// control point in the mean of the places that the corners it is next to give it, an affine image of a
/// regular fan around each, moved as little as brings the limit corners of the layout to its corners (but for
/// a corner with one face, whose ring is the other corners).
///
/// Guarantee: finite numbers, the same for the same kind. A bound needs no more: any layout is sound.
/// Source:    [Wu05, sec. 4.3]; derivations/tables.md.
[[nodiscard]] std::vector<LayoutPoint> make_layout(const Kind& kind);

/// Where the control points lie on the regular lattice of triangles or quads, tags aside; empty if the faces around the
/// patch do not fit it. Exact.
[[nodiscard]] std::vector<LayoutPoint> lattice_layout(const Kind& kind);

/// A layout for any kind of patch: the control net that is nearest to both of these. Its limit patch is its
/// own parametrisation, and it is fair: each face around the patch an affine image of a regular polygon, each
/// fan at its vertices one of a regular fan. Corners of the limit patch lie at (0, 0), (1, 0) and (0, 1).
///
/// Guarantee: as make_layout(). Where everything is regular the lattice, without error.
/// Cost:      a dense system: the third power of the number of control points.
/// Source:    derivations/tables.md, "Other kinds".
[[nodiscard]] std::vector<LayoutPoint> fair_layout(const Kind& kind);

/// The corner of a kind laid by rings that alone may be extraordinary, inside the mesh; none for other kinds.
[[nodiscard]] std::optional<std::size_t> lone_centre(const Kind& kind);

/// Where the outer points lie on the spokes of a corner of valence n >= 3: b = k u1 and d = k u2. 2 for 6.
[[nodiscard]] double outer_spoke(std::size_t n);

}  // namespace snug
