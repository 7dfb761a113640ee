#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/independence/control_net.h>

namespace snug {

/// A control point of a regular piece, or with Midedge a sum of two that is zero on the dependent combination of its nine
/// functions: pairs of a row of a step and its sign. The function is zero on the piece iff all of its are.
using Functional = std::vector<std::pair<std::uint32_t, int>>;

/// One step of refinement of a net, and the regular pieces that come of it.
struct PieceStep {
  std::uint32_t dimension = 0;                  ///< points of the net: K
  std::vector<WeightRow> rows;                  ///< of the finer net
  std::vector<std::vector<Functional>> pieces;  ///< the regular ones
  std::uint32_t kept = 0;  ///< how many rows begin the finer net of the part that is not regular
};

/// The step of a piece with one extraordinary corner: its rows are the dissertation's A (M by K), the first K of them A',
/// and its three pieces are what P_1, P_2 and P_3 pick.
///
/// Source:    [Wu05, sec. 3.3 and 3.5], whose numbers are kept.
/// `order`: a multiple of n, of which weights are cosines; 0 for n.
[[nodiscard]] PieceStep piece_step(const ExactScheme& scheme, std::uint32_t n, std::uint32_t order = 0);

/// The step of a face at a boundary vertex with `faces` faces: likewise; its regular pieces may lie at the boundary, and have
/// then the control points that are in the mesh.
///
/// Requires:  that boundary_net() takes it.
[[nodiscard]] PieceStep boundary_step(const ExactScheme& scheme, std::uint32_t faces, const BoundaryFace& at);

/// The first step of a piece with two extraordinary corners: two regular pieces, and a part with one corner at each.
struct TwoCornerStep {
  struct Part {
    std::uint32_t valence = 0;
    std::vector<WeightRow> net;  ///< its control points, as piece_net() has them
  };
  PieceStep step;
  std::array<Part, 2> parts;
};

/// Requires:  valences of 3 and more, not both 3 with Loop; opposite corners not with Loop; a common multiple of both.
[[nodiscard]] TwoCornerStep two_corner_step(const ExactScheme& scheme, const PieceCorners& corners,
                                            std::uint32_t order);

/// The step of the n pieces around a corner: 3 n regular pieces, nothing kept.
[[nodiscard]] PieceStep annulus_step(const ExactScheme& scheme, std::uint32_t n);

/// A step of a whole mesh: no pieces; all rows are kept.
[[nodiscard]] PieceStep mesh_step(const RefinedNet& refined, std::uint32_t points);

}  // namespace snug
