#pragma once

#include <cstddef>
#include <vector>

#include <snug/mesh/control_mesh.h>

namespace snug {

/// What sharpen() takes for sharp when nothing else is asked for, in degrees.
inline constexpr double default_sharp_angle = 30;

/// What sharpen() did to a mesh.
struct Sharpened {
  std::size_t creases = 0;  ///< tags added: edges that were not infinitely sharp
  std::size_t corners = 0;  ///< tags added
  std::size_t flat_regions =
      0;  ///< planar regions between sharp edges; their limit surface is now the region itself
  std::size_t fixed_regions =
      0;  ///< curved regions that are kept facet by facet: all their vertices are corners
  std::size_t split_faces = 0;  ///< faces of both that were not convex: now triangles
  std::size_t crossed_faces =
      0;  ///< faces of both that cross or touch themselves and could not be split: these alone may leave their polygon
  /// Of the faces that splitting added behind the others: the face that each was a part of.
  std::vector<FaceId> parts_of;
};

/// Tags edges by their angles, for meshes whose faces are what is meant: parts from CAD.
///
/// - An edge of two faces whose normals differ by more than `angle` degrees becomes an infinitely sharp crease. Boundary
///   edges and non-manifold ones are sharp by rule and get no tag.
/// - A region of faces that only such edges bound, and edges tagged infinitely sharp before, is planar if its vertices lie
///   between two parallel planes, at most 2 t apart. Its edges all become infinitely sharp, and its vertices corners.
/// - A vertex with two sharp edges that turn there by more than `angle` becomes a corner. One with three and more is one by
///   the rules, and gets no tag; one with a single sharp edge stays a dart.
/// - A region that is curved and has corners alone for vertices, as the wall of a hole with one row of facets, is kept facet by
///   facet: its edges all become infinitely sharp.
/// - Faces of these regions that are not convex are split into triangles: the first keeps the number of the face, the
///   others come behind all faces. Holes are not split.
///
/// t is how exact coordinates are taken to be: 2^-17 of the longest side of used_box(), or if that is more 2^-22 of the largest
/// coordinate where all coordinates are floats, 2^-48 else. A face with less width than t (twice its area over half its
/// perimeter) has no normal of its own: an edge between it and others, or between other such faces and others, is sharp if the
/// faces that meet across them differ by more than `angle`.
///
/// Guarantee: under Loop and Catmull-Clark the limit surface of a face whose edges are infinitely sharp and whose vertices are
///            corners lies in the convex hull of its vertices and ends at its edges; it is the triangle itself under
///            Loop, and under Catmull-Clark the polygon where that is planar and convex. After sharpen() all faces of these
///            regions are such faces, crossed_faces excepted. Angles are measured in double precision: which edges are sharp may depend
///            on rounding, what the limit surface of these tags is does not. Tags are kept; new ones come behind
///            them, so they count. Positions stay as they are. Faces that cross no limit keep their numbers.
/// Requires:  dual schemes know no creases: the tags change nothing there.
/// Errors:    InputError (value) unless 0 <= angle < 180.
/// Cost:      linear, times the logarithm of the largest valence; splitting is quadratic in the corners of a face.
///            A mesh with faces of less than three vertices, vertices that are not there or coordinates that are not finite
///            is left as it is: no question takes it.
/// Source:    derivations/sharp_parts.md; corners and rules: derivations/creases.md.
Sharpened sharpen(ControlMesh& mesh, double angle = default_sharp_angle);

}  // namespace snug
