#pragma once

#include <cstddef>

#include <snug/geometry/interval.h>

/// Catmull-Clark's masks, all of them. Curves of creases and boundaries are those of Loop (loop_masks.h).
/// [CatmullClark78]; boundaries and creases as in [DeRose98] and OpenSubdiv.
namespace snug::catmark {

/// Weights of a vertex, of each vertex at the far end of one of its edges, and of each diagonally across one of its
/// quads. They sum to 1.
struct StarMask {
  Interval centre, edge, diagonal;
};

/// New position of an interior vertex of valence n among quads: with n-gons' centres the mask is
/// (n - 2)/n, 1/n^2 an edge, 1/n^2 a face's centre.
[[nodiscard]] StarMask vertex_mask(std::size_t n);

/// The same by face centres, for faces of any size.
struct CentreMask {
  Interval centre, edge, face;
};
[[nodiscard]] CentreMask vertex_centre_mask(std::size_t n);

/// Limit position of an interior vertex among quads:  n^2, 4, 1, over n (n + 5).
/// Source:    [HalsteadKassDeRose93].
[[nodiscard]] StarMask limit_mask(std::size_t n);

/// New point of an interior edge between quads: its ends, and the four vertices beyond.
inline constexpr double edge_end = 0.375, edge_wing = 0.0625;
/// By face centres: a quarter each; 0.470 for the centre of a triangle where these are to be smooth.
inline constexpr double edge_face = 0.25;
[[nodiscard]] Interval smooth_triangle_face();

/// Subdominant eigenvalue at an interior vertex.
[[nodiscard]] double subdominant(std::size_t n);

}  // namespace snug::catmark
