#pragma once

#include <cstdint>
#include <optional>

#include <snug/search/closed_mesh.h>
#include <snug/search/feet.h>
#include <snug/search/piece_set.h>

namespace snug {

/// A ball that comes from outside: the mesh around places that its centre does not get to, and how far it reaches beyond that.
struct RollingBall {
  RollingBall(ClosedMesh around, double reach, int threads);
  ClosedMesh around;
  PieceSet facets;  ///< of that
  double reach;
};

struct OffsetMeshOptions {
  double offset;  ///< > 0: about the distance of the mesh from the set
  double cell;    ///< > 0: side of the cubes that it is sampled in, at most 2 / sqrt(3) of the offset
  std::uint64_t most_cells;           ///< nothing if it takes more of them
  const RollingBall* ball = nullptr;  ///< places that it does not reach are inside, too
  int threads = 0;
};

/// About how far outside a place is of the mesh that offset_mesh() makes, less than 0 inside; and its foot on the set, from the one of
/// a place nearby.
struct OffsetHeight {
  double height = 0;
  QuadraticFoot foot{}, centre{};
};
[[nodiscard]] OffsetHeight height_at(const PieceSet& set, double offset, const RollingBall* ball,
                                     const Point3& p, const OffsetHeight& hint = {});

/// Triangles about where the distance from a set is `offset`, as far as the outside reaches: what is enclosed by them, cavities
/// and what is in these, is left out. They face outward. One vertex for each sheet in a cube [Nielson04]; corners of cubes that would let
/// two sheets touch in a face count as nearer than they are.
///
/// Guarantee: is_manifold(). Of distances nothing is promised. Results depend on the input alone.
/// Requires:  a prepared set.
/// Errors:    Interrupted.
/// Cost:      3 distances of points for each cube that the mesh passes; 20 with a ball.
/// Source:    derivations/envelopes.md.
[[nodiscard]] std::optional<ClosedMesh> offset_mesh(const PieceSet& set, const OffsetMeshOptions& options,
                                                    const WorkMonitor& monitor);

}  // namespace snug
