#pragma once

#include <optional>

#include <snug/geometry/plane_facets.h>
#include <snug/geometry/point_triangle.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// A patch whose surface is a triangle, or half of a convex quad that is plane up to roundings. Half a quad stands for the
/// triangle of its corners: both halves together for the quad, as the two patches do. Scaled units.
struct Facet {
  Triangle triangle;            ///< the corners of the patch
  std::optional<Point3> far{};  ///< of half a quad: its fourth corner
  std::uint32_t corner = 0;     ///< as in Place
  bool second = false;          ///< the half that begins at corner 2 of the quad
  double error = 0;             ///< upper bound, a coordinate, of how far the corners are from the exact ones
  double off = 0;               ///< upper bound of how far the quad and its two triangles are from each other
  double largest = 0;           ///< of the corners' coordinates

  /// The quad's parameters at a point of the triangle, or of the triangle itself: to some roundings, within [0, 1].
  [[nodiscard]] TriangleParameter place_of(Barycentric at) const;
  /// The surface's point there, rounded once. Its error is that of the point.
  [[nodiscard]] BoundedPoint point(TriangleParameter at) const;
};

/// Is a patch the triangle of its corners, or bilinear between those of its quad? So are those of the schemes flat and bilinear,
/// and those of faces whose edges and corners are all sharp.
/// Requires:  has_patch(patch), here and below.
[[nodiscard]] bool is_between_corners(const LimitSurface& surface, PatchId patch);

/// Nothing for any other patch, and for halves of quads that are not plane and convex.
///
/// Guarantee: the two facets of a quad, each within its `off`, are the surface of the two patches, and the corners are in the
///            patches' own boxes.
/// Source:    derivations/closest.md, "Facets".
[[nodiscard]] std::optional<Facet> facet_of(const LimitSurface& surface, PatchId patch);

/// Is the surface of a face the polygon of its corners, plane and strictly convex in exact arithmetic, and are these signed exactly
/// (geometry/exact_sign.h)? Triangles may have no area.
/// Requires:  has_patch(patch), the first one of the face.
[[nodiscard]] bool is_exact_facet(const LimitSurface& surface, FaceId face, PatchId patch);
/// Corners of a face that is looked at; comparing each with each edge takes their square.
inline constexpr std::size_t max_facet_corners = PlaneFacet::max_corners;

}  // namespace snug
