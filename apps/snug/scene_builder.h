#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <picture/camera.h>
#include <picture/polyhedron.h>
#include <picture/scene.h>
#include <snug/geometry.h>
#include <snug/run.h>
#include <snug/surface.h>
#include <support/scaling.h>

namespace snug::command {

/// A control mesh where it stands in the picture, and those of its vertices that count.
/// Requires:  the mesh outlives it.
struct PlacedMesh {
  const ControlMesh* mesh;
  std::span<const VertexId> used;
  Motion pose;
};

/// The coordinates of a picture: the box of the placed control meshes, whatever its size and place, is
/// brought to the origin and to a longest side of 1.
class PictureUnits {
 public:
  explicit PictureUnits(std::span<const PlacedMesh> parts);

  /// From mesh units, before the pose, to the picture.
  [[nodiscard]] Point3 operator()(const Motion& pose, Point3 p) const {
    return from_scaled(pose, scale_.apply(p));
  }
  [[nodiscard]] Vector3 operator()(const Motion& pose, Vector3 direction) const {
    return pose.rotate(direction);
  }
  /// The same for points that scale() was applied to.
  [[nodiscard]] Point3 from_scaled(const Motion& pose, Point3 p) const {
    return Point3{} + zoom_ * (placed(pose, p) - centre_);
  }
  /// From displacements of the picture to mesh units, before the pose; where the picture's origin is there.
  [[nodiscard]] Rows3 to_mesh(const Motion& pose) const;
  [[nodiscard]] Point3 origin_in_mesh(const Motion& pose) const;
  /// A length of the picture in mesh units.
  [[nodiscard]] double to_mesh(double length) const { return scale_.inverse().apply(length / zoom_); }
  /// A first step that brings the largest coordinate to about 1, without rounding.
  [[nodiscard]] PowerOfTwo scale() const { return scale_; }

 private:
  [[nodiscard]] Point3 placed(const Motion& pose, Point3 p) const {
    return Point3{} + pose.rotate(p - Point3{}) + scale_.apply(pose.offset());
  }

  PowerOfTwo scale_;
  Point3 centre_;
  double zoom_ = 1;
};

/// Limit points of every patch on a lattice of so many steps a side, in picture units: what a picture must hold.
/// Errors:    InputError if a coordinate does not fit a double; Interrupted.
/// Cost:      steps^2 / 2 evaluations a patch.
[[nodiscard]] std::vector<Point3> limit_points(const PlacedSurface& part, const PictureUnits& units,
                                               std::uint32_t steps, int threads, const WorkMonitor& monitor);

/// A surface in a picture.
/// Requires:  the caster outlives it.
[[nodiscard]] SceneSurface scene_surface(const RayCaster& caster, const Motion& pose,
                                         const PictureUnits& units, std::uint32_t material);

/// The hull of each enclosure, in picture units.
[[nodiscard]] std::vector<Polyhedron> enclosure_hulls(std::span<const IntervalTriangle> enclosures,
                                                      const Motion& pose, const PictureUnits& units,
                                                      int threads, const WorkMonitor& monitor);

/// How solids are drawn: facets of one material, outlined.
struct SolidStyle {
  std::uint32_t material;
  double line_width;  ///< of the silhouette; the other edges that the eye sees are half as wide
  Colour line_colour;
};

/// Adds what an eye sees of a convex solid by itself: the facets towards the eye and their edges.
void add_polyhedron(PictureScene& scene, const Polyhedron& solid, Point3 eye, const SolidStyle& style);

/// Adds two points of the world and the segment between them; `scale` is the picture's smaller side over a
/// thousand pixels.
/// Errors:    InputError (value) for points so far away that the picture cannot hold them.
void add_witness(PictureScene& scene, const std::array<Point3, 2>& points, const PictureUnits& units,
                 double scale);

/// The plane through the first of two points of the world, across from it to the second one.
[[nodiscard]] CutPlane cut_plane(const std::array<Point3, 2>& points, const PictureUnits& units);

/// Adds the edges of the control mesh.
void add_cage(PictureScene& scene, const PlacedSurface& part, const PictureUnits& units, double line_width,
              Colour line_colour);

}  // namespace snug::command
