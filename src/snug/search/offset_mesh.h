#pragma once

#include <cstdint>
#include <optional>

#include <snug/search/closed_mesh.h>
#include <snug/search/piece_set.h>

namespace snug {

struct OffsetMeshOptions {
  double offset;  ///< > 0: about the distance of the mesh from the set
  double cell;    ///< > 0: side of the cubes that it is sampled in, at most 2 / sqrt(3) of the offset
  std::uint64_t most_cells;  ///< nothing if it takes more of them
  int threads = 0;
};

/// Triangles about where the distance from a set is `offset`, as far as the outside reaches: what is enclosed by them, cavities
/// and what is in these, is left out. They face outward. One vertex for each sheet in a cube [Nielson04]; corners of cubes that would let
/// two sheets touch in a face count as nearer than they are.
///
/// Guarantee: is_manifold(). Of distances nothing is promised. Results depend on the input alone.
/// Requires:  a prepared set.
/// Errors:    Interrupted.
/// Cost:      20 distances of points for each cube that the mesh passes.
/// Source:    derivations/envelopes.md.
[[nodiscard]] std::optional<ClosedMesh> offset_mesh(const PieceSet& set, const OffsetMeshOptions& options,
                                                    const WorkMonitor& monitor);

}  // namespace snug
