#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <snug/mesh/control_mesh.h>
#include <snug/patch/piece_path.h>
#include <snug/surface/limit_surface.h>

#include "triangle_mesh.h"

namespace snug::bench {

/// A mesh as OpenSubdiv's Far::TopologyRefiner, with its creases: Loop if all faces are triangles, else
/// Catmull-Clark; boundary edge and corner. One thread.
class OsdMesh {
 public:
  explicit OsdMesh(const ControlMesh& mesh);
  ~OsdMesh();
  OsdMesh(const OsdMesh&) = delete;
  OsdMesh& operator=(const OsdMesh&) = delete;

  struct Impl;
  [[nodiscard]] Impl& impl() const { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

/// Bfr surfaces of faces, initialised and kept; Bfr's own settings (irregular patches approximated from level
/// 2).
class OsdSurfaces {
 public:
  /// `cache`: with the factory's cache of topologies, which Bfr's default is.
  /// Requires:  the mesh outlives the surfaces.
  OsdSurfaces(const OsdMesh& mesh, std::span<const PatchId> faces, bool cache);
  ~OsdSurfaces();
  OsdSurfaces(const OsdSurfaces&) = delete;
  OsdSurfaces& operator=(const OsdSurfaces&) = delete;

  /// Number of patch points of all surfaces: a checksum of the setup.
  [[nodiscard]] double patch_points() const;
  /// Patch points of all surfaces and the boxes of these, as a user of Bfr would bound them. Since irregular
  /// patches are approximations, the boxes do not provably contain the limit surface.
  /// Returns:   the sum of the boxes' longest sides.
  [[nodiscard]] double box_all() const;
  /// Points of the i-th surface: its patch points, then one evaluation a parameter, in double precision.
  void evaluate(std::size_t i, std::span<const TriangleParameter> at, std::span<Point3> out);
  /// The same with derivatives along u and v.
  void evaluate(std::size_t i, std::span<const TriangleParameter> at, std::span<Point3> out,
                std::span<std::array<Vector3, 2>> derivatives);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A table of stencils, in double precision as Far makes it.
class OsdStencils {
 public:
  /// Limit stencils at the same parameters of every face: Far::LimitStencilTableFactory after adaptive
  /// refinement to `isolation` levels; no derivatives.
  static OsdStencils limit(const ControlMesh& mesh, std::span<const TriangleParameter> at, int isolation);
  /// The vertices of the mesh after one step of uniform refinement: the least that any refit of finer patches
  /// starts from.
  static OsdStencils refined(const ControlMesh& mesh);
  ~OsdStencils();
  OsdStencils(OsdStencils&&) noexcept;
  OsdStencils& operator=(OsdStencils&&) noexcept;

  [[nodiscard]] std::size_t count() const;
  [[nodiscard]] std::size_t weights() const;
  /// New positions, new values of all stencils: the table's own UpdateValues in double precision.
  /// Returns:   the sum of the values' first coordinates.
  double update(std::span<const Point3> points);
  /// The same with Osd::CpuEvaluator, which is in single precision. Points are converted outside of the work.
  double update_float();
  /// Positions for update_float().
  void set_float_points(std::span<const Point3> points);

 private:
  OsdStencils();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A limit point by uniform refinement: exact but for the rounding of double precision.
struct OsdLimitSample {
  PatchId face;
  TriangleParameter at;
  Point3 point;
};

/// Corners of all faces after `level` steps, at their limit positions, in the order of control faces. A
/// corner that pieces of one face share is listed once for each.
[[nodiscard]] std::vector<OsdLimitSample> osd_limit_samples(const ControlMesh& mesh, int level);

/// The mesh after `level` uniform steps, as a user of Far writes it: a topology refiner, RefineUniform,
/// PrimvarRefiner. `snapped`: its vertices at their limit positions.
[[nodiscard]] TriangleMesh osd_uniform(const ControlMesh& mesh, int level, bool snapped = false);

/// The first level at which every vertex is within tolerance / 2 of its limit position: what "uniform Loop"
/// means in [Wu05, table 5.1]. Nothing says how near triangles are between their vertices.
/// Errors:    std::runtime_error if that is beyond level 10.
[[nodiscard]] int osd_uniform_level(const ControlMesh& mesh, double tolerance);

/// The first level at which the mesh snapped to the limit looks fine enough: the limit of the vertex that one
/// more step puts on an edge is within tolerance / 2 of that edge. What somebody would take who knows limit
/// positions; measured at these points, not proved.
/// Errors:    std::runtime_error if that is beyond level 10.
[[nodiscard]] int osd_snapped_level(const ControlMesh& mesh, double tolerance);

}  // namespace snug::bench
