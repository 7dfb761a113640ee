#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <picture/camera.h>
#include <picture/polyhedron.h>
#include <picture/scene.h>
#include <snug/geometry/motion.h>
#include <snug/monitor.h>
#include <snug/query/bound.h>
#include <snug/surface/limit_surface.h>

namespace snug::command {

/// A surface where it stands in the picture.
/// Requires:  the surface outlives it.
struct PlacedSurface {
  const LimitSurface* surface;
  Motion pose;
};

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

/// Limit points of every patch on the same lattice. Points on edges and at corners are taken from one of the
/// patches there, so that triangles of neighbours share them exactly; not beside polygons that split first.
class Tessellation {
 public:
  /// Errors:    InputError if a coordinate does not fit a double; Interrupted.
  /// Cost:      steps^2 / 2 evaluations a patch; 48 bytes each.
  Tessellation(const PlacedSurface& part, const PictureUnits& units, std::uint32_t steps, int threads,
               const WorkMonitor& monitor);

  /// All the points, patch by patch, in picture units.
  [[nodiscard]] std::span<const Point3> points() const { return positions_; }
  [[nodiscard]] std::size_t triangle_count() const { return patches_.size() * steps_ * steps_; }
  /// Of each patch, the length on the picture of its longest edge, in pixels.
  [[nodiscard]] std::vector<double> longest_edges(const Camera& camera, int height) const;
  /// Adds its triangles to the scene.
  void add_to(Scene& scene, std::uint32_t material, int threads) const;

 private:
  // Point (i, j) has the parameters u = i / steps, v = j / steps.
  struct LatticePoint {
    std::uint32_t i, j;
  };

  [[nodiscard]] std::size_t number(LatticePoint p) const {
    return p.j * (steps_ + 1) - std::size_t{p.j} * (p.j - std::size_t{1}) / 2 + p.i;
  }
  [[nodiscard]] LatticePoint on_side(std::size_t side, std::uint32_t steps_along) const;
  [[nodiscard]] Point3 shared_position(std::size_t rank, LatticePoint p) const;

  std::uint32_t steps_;
  std::size_t points_a_patch_;
  std::vector<PatchId> patches_;        // those that are there
  Topology topology_;                   // their corners, a triangle each
  std::vector<HalfEdge> vertex_owner_;  // the corner of a patch that lends a name its point
  std::vector<Point3> positions_;
  std::vector<Vector3> normals_;
};

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
void add_polyhedron(Scene& scene, const Polyhedron& solid, Point3 eye, const SolidStyle& style);

/// Adds two points of the world and the segment between them; `scale` is the picture's smaller side over a
/// thousand pixels.
/// Errors:    InputError (value) for points so far away that the picture cannot hold them.
void add_witness(Scene& scene, const std::array<Point3, 2>& points, const PictureUnits& units, double scale);

/// Adds the edges of the control mesh.
void add_cage(Scene& scene, const PlacedSurface& part, const PictureUnits& units, double line_width,
              Colour line_colour);

}  // namespace snug::command
