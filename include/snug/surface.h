#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/mesh.h>

namespace snug {

class PlacedSurface;
class SharedPlan;
struct Place;
class SurfaceData;

/// How pieces of a surface are bounded.
enum class BoundMethod : std::uint8_t {
  rows,   ///< bounding rows: the convex hull of the weighted control points contains the piece
  table,  ///< the dissertation's tables: planes below and above every basis function (slefe-like bounds)
};

struct SurfaceOptions {
  /// Default: the mesh's tag, which readers set where a format means its triangles as they are (STL, glTF) or
  /// names a scheme; else Loop if all faces are triangles, else Catmull-Clark.
  std::optional<Scheme> scheme{};
  std::optional<BoundaryRule> boundary{};  ///< default: the mesh's tag, else edge_and_corner
  BoundMethod bounds = BoundMethod::rows;  ///< how pieces are bounded
  /// Bound every patch at the first query, some microseconds each. The BVH becomes tighter, which pays off for
  /// surfaces of a few thousand faces after some ten thousand queries. Otherwise the BVH is built only from control points.
  bool tight = false;
  /// Receives one line where triangles are smoothed although neither `scheme` nor a tag says so, with the result of
  /// limit_to_faces() up to 200,000 faces.
  Notes notes{};
};

/// The limit surface of a control mesh: a handle that is cheap to copy. The surface never changes, lives as long as
/// any handle to it, and may be used by any number of threads at once.
///
/// Cost:      linear in the mesh. The first query also builds a BVH: half a microsecond per patch; a tenth
///            of a microsecond for large meshes, whose BVH is built only where queries need it.
class SNUG_API Surface {
 public:
  /// The mesh's tags give creases, corners, holes, the crease method and how Catmull-Clark treats triangles.
  ///
  /// Errors:    InputError (refused), naming the element and the next step, for a mesh that has no limit
  ///            surface under these rules or is not supported: see docs/guarantees.md. Interrupted.
  explicit Surface(ControlMesh mesh, const SurfaceOptions& options = {}, const Run& run = {});
  Surface(const Surface&) noexcept;
  Surface& operator=(const Surface&) noexcept;
  ~Surface();

  /// The surface placed at a pose.
  [[nodiscard]] PlacedSurface at(const Motion& pose) const;

  [[nodiscard]] const ControlMesh& mesh() const;
  [[nodiscard]] Scheme scheme() const;
  [[nodiscard]] const SchemeTraits& traits() const { return traits_of(scheme()); }
  [[nodiscard]] BoundaryRule boundary() const;
  /// Longest side of the bounding box of the vertices that faces use; may overflow to infinity.
  [[nodiscard]] double size() const;
  /// Faces, or vertices of a dual scheme: see Place::owner.
  [[nodiscard]] std::size_t owner_count() const;
  /// Values of Place::corner on an owner. 0 of a vertex that no quad surrounds; 1 for triangles.
  /// Requires:  owner < owner_count().
  [[nodiscard]] std::size_t corner_count(std::uint32_t owner) const;
  /// Is there a limit point at these parameters?
  [[nodiscard]] bool has(const Place& at) const;
  /// Different patch topologies, by which bounds are shared.
  [[nodiscard]] std::size_t kind_count() const;
  /// Why it bounds no solid: names an edge whose faces do not run both ways, or a face without a surface.
  /// Empty if it is closed.
  [[nodiscard]] std::optional<std::string> open_reason() const;
  /// Builds the BVH now, and not at the first query. With the threads of the constructor; `run` only has the monitor.
  /// Errors:    InputError (refused) if no face has a limit surface. Interrupted.
  void prepare(const Run& run = {}) const;
  /// Memory of the surface and its BVH, without the mesh.
  [[nodiscard]] std::size_t bytes() const;

  /// For internal use.
  [[nodiscard]] const std::shared_ptr<const SurfaceData>& data() const { return data_; }

 private:
  friend class MovingSurface;
  explicit Surface(std::shared_ptr<const SurfaceData> data) noexcept;

  std::shared_ptr<const SurfaceData> data_;
};

/// The limit surface of a mesh file, with the file's rules and tags unless `options` overrides them. Notes of
/// the reader and of Surface, and errors, name the file.
[[nodiscard]] SNUG_API Surface load(const std::string& path, const SurfaceOptions& options = {},
                                    const Run& run = {});

/// A surface whose control points move while its faces, tags and rules stay the same. Each set of positions is a
/// Surface of its own, a frame, which reuses the patch topologies and the order of the BVH of earlier frames: only
/// its boxes are recomputed, at the first query. For one thread at a time; its frames are Surfaces like all others.
///
/// Guarantee: frames never change: a handle shows its frame as long as it is kept, and a query of one frame uses no
///            results computed for another. Once one more frame exists than are held at the same time, move(),
///            collide(), distance() and closest_point() allocate no memory where earlier queries reached as far,
///            except for patch topologies that no other patch shares.
/// Cost:      0.06 microseconds per patch for a frame and its BVH (bench/results/moving.txt), which is rebuilt when
///            its boxes have grown by half. SurfaceOptions::tight affects only the first surface. Memory: that of
///            the frames held at the same time, plus one or two.
class SNUG_API MovingSurface {
 public:
  /// The first frame is `first` itself.
  explicit MovingSurface(const Surface& first);
  ~MovingSurface();
  MovingSurface(MovingSurface&&) noexcept;
  MovingSurface& operator=(MovingSurface&&) noexcept;

  /// The next frame: the surface with these control points, one for each vertex of the mesh.
  ///
  /// Errors:    InputError: (value) for a wrong number of points; (refused) for a coordinate that is not
  ///            finite. now() is then unchanged.
  const Surface& move(std::span<const Point3> points);
  /// The last frame.
  [[nodiscard]] const Surface& now() const { return now_; }

 private:
  Surface now_;
  std::shared_ptr<SharedPlan> plan_;
  std::vector<std::shared_ptr<SurfaceData>> frames_;  // frames in use, and frames to be reused
};

/// A surface and its pose. A Surface alone has the identity as its pose.
class PlacedSurface {
 public:
  PlacedSurface(const Surface& surface) : surface_(surface) {}  // NOLINT: implicit, at the identity
  PlacedSurface(const Surface& surface, const Motion& pose) : surface_(surface), pose_(pose) {}
  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] const Motion& pose() const { return pose_; }

 private:
  Surface surface_;
  Motion pose_;
};

/// Parameters of a point on a surface. For Loop, (1 - u - v) c0 + u c1 + v c2 on a face. Else (u, v) on a quad, from
/// corner 0 with u towards corner 1: the face itself if it has four corners (in a dual scheme, the faces around the
/// vertex), else the quad that the first split makes at `corner`, u along the edge that follows.
struct Place {
  std::uint32_t owner = 0;  ///< face; in a dual scheme, vertex
  std::uint32_t corner = 0;
  double u = 0, v = 0;
  [[gnu::always_inline]] friend bool operator==(const Place&, const Place&) = default;
};

/// A point that stands for a limit point, and where this lies on its surface, up to a few roundings.
struct LimitPoint {
  Point3 point;
  double error = 0;  ///< upper bound, per coordinate, of |point - limit point|, rounding included
  std::optional<Place> at{};
  [[gnu::always_inline]] friend bool operator==(const LimitPoint&, const LimitPoint&) = default;
};

/// Split pieces, their bounds and some answers, kept by queries. It makes later queries on the same surfaces
/// several times faster and never changes an answer. For one thread at a time.
///
/// Guarantee: memory is bounded: beyond max_bytes() the least recently used entries are dropped. It does not
///            keep surfaces alive; entries of surfaces that are gone are dropped eventually.
class SNUG_API Workspace {
 public:
  Workspace();
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  /// The default of all queries: one for each thread, destroyed with it.
  [[nodiscard]] static Workspace& of_this_thread();

  [[nodiscard]] std::size_t bytes() const;
  /// 512 MiB. A single query may exceed it.
  [[nodiscard]] static std::size_t max_bytes();
  /// Drops all entries.
  void clear();

  /// For internal use.
  class Pieces;
  [[nodiscard]] Pieces& pieces() const { return *pieces_; }

 private:
  std::unique_ptr<Pieces> pieces_;
};

}  // namespace snug
