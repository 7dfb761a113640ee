#pragma once

#include <oracle/loop_net.h>
#include <oracle/tagged_mesh.h>

#include <cstdint>
#include <vector>

namespace oracle {

enum class DualScheme { doo_sabin, midedge };

namespace detail {
/// Weight of the corner i steps further in a face of n corners.
[[nodiscard]] std::vector<Quad> dual_mask(DualScheme scheme, std::size_t n);
}  // namespace detail

/// A point of the limit surface, on the patches of the control vertices `owners` (in order).
struct DualSample {
  std::vector<std::uint32_t> owners;
  Point position;
  double error;  ///< of each coordinate, the rounding to double included
};

/// Centroids of all faces after `levels` refinements; masks keep a face's centroid, so it is on the limit
/// surface.
///
/// A control vertex has a patch if the corners at it are one closed fan of three or more, each edge there
/// having two faces. Orientation does not matter, tags are ignored. After L steps each corner of a face
/// descends from one corner of a control face, whose vertex owns it; a sample is on the patches of all its
/// corners' owners, and is left out if none has a patch.
///
/// Guarantee: positions are within `error`: in 113-bit arithmetic one step adds at most (N + 12) 2^-112 M, N
///            the largest face or valence, M the largest coordinate: masks are convex with weights good to 4
///            roundoffs.
/// Requires:  0 <= levels <= 8.
/// Errors:    std::invalid_argument, see TaggedMesh and Requires.
/// Source:    [DooSabin78] a_0 = 1/4 + 5/(4n), a_i = (3 + 2 cos(2 pi i/n)) / (4n); [PetersReif97] 1/2, 1/4,
///            1/4.
[[nodiscard]] std::vector<DualSample> sample_dual(const TaggedMesh& mesh, DualScheme scheme, int levels);

/// The control mesh after `levels` steps, rounded to double: a vertex for each corner of a face, then a face
/// for each face, for each edge with two faces, for each vertex with a patch. It may have several
/// orientations.
[[nodiscard]] TaggedMesh refine_dual(const TaggedMesh& mesh, DualScheme scheme, int levels = 1);

}  // namespace oracle
