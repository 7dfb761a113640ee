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

/// Where the control points of a kind lie in the plane over which its basis functions are bounded.
///
/// By rings: corners, the first three control points, lie at (0, 0), (1, 0) and (0, 1). Other kinds:
/// fair_layout(); the limits of the corners lie there.
///
/// By rings, at most one extraordinary corner, inside the mesh: the dissertation's, spokes of equal length and
/// angle. Others: each control point in the mean of the places that the corners it is next to give it, an
/// affine image of a regular fan around each, moved as little as brings the limit corners of the layout to its
/// corners (but for a corner with one face, whose ring is the other corners).
///
/// Guarantee: finite numbers, the same for the same kind. A bound needs no more: any layout is sound.
/// Cost:      linear in the valences; that of fair_layout() for other kinds.
/// Source:    [Wu05, sec. 4.3]; derivations/tables.md.
[[nodiscard]] std::vector<LayoutPoint> make_layout(const Kind& kind);

/// The corner of a kind that the dissertation's layout is built around: the extraordinary one, or any of a
/// regular kind. None for kinds that are laid out otherwise.
[[nodiscard]] std::optional<std::size_t> lone_centre(const Kind& kind);

/// Where the outer points lie on the spokes of a valence-n corner: b = k u1 and d = k u2. 2 for n = 6.
/// Requires:  n >= 3.
[[nodiscard]] double outer_spoke(std::size_t n);

}  // namespace snug
