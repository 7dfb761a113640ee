#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include <snug/bound.h>
#include <snug/bounds/bounds_cache.h>
#include <snug/mesh/topology.h>
#include <snug/patch/patch.h>
#include <snug/run.h>
#include <snug/scheme/creases.h>
#include <snug/scheme/rules.h>
#include <support/scaling.h>

namespace snug {

/// A root patch of a surface. Triangular schemes: of face f it is number f.
using PatchId = Id<struct PatchTag>;

/// The limit surface of a control mesh, in triangular patches. Immutable but for move(); may be read by many
/// threads.
///
/// A patch belongs to an owner: a face, or with a dual scheme a vertex. Triangular schemes, as Loop: one a
/// face. Other primal ones, as Catmull-Clark: two a quad with corners c0 to c3, part 0 from c0 by c1 to c2
/// and part 1 from c2 by c3 to c0; of another face with n corners 2 n after its first split: parts 2 k and 2
/// k + 1 those of the quad at corner k, from that corner and from the face's centre. Dual schemes likewise,
/// with the faces around the vertex, from topology().leaving() on, as corners.
///
/// Inside, coordinates are scaled by a power of two so that the largest lies in [1, 2); `scale()` leads there
/// from mesh units. Everything below surface/ works in scaled units, all answers are in mesh units.
///
/// Errors:    InputError (refused) from require_subdividable, and (value) for a library that is null.
/// Cost:      linear; 9 bytes a patch beside mesh and topology. Kinds are found where they are first asked
///            for, and their rows made when a patch is first bounded. All that depends on connectivity alone
///            is shared by the surfaces whose control points alone differ.
class LimitSurface {
 public:
  /// The mesh's tags name creases, corners, holes, the crease method and how triangles are treated;
  /// options.boundary alone counts for the boundary.
  LimitSurface(ControlMesh mesh, const SchemeOptions& options, std::shared_ptr<BoundsCache> library,
               const WorkMonitor& monitor = {});
  /// The same connectivity with other control points.
  /// Errors:    those of move().
  LimitSurface(const LimitSurface& like, std::span<const Point3> points);

  /// Puts the control points here. No memory is taken. Nobody else may use the surface meanwhile.
  /// Errors:    InputError: (value) unless there is a point for each vertex; (refused) for a coordinate that is
  ///            not finite. The surface is then as it was.
  void move(std::span<const Point3> points);

  [[nodiscard]] const ControlMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Topology& topology() const { return layout_->topology; }
  [[nodiscard]] const SchemeOptions& options() const { return layout_->options; }
  [[nodiscard]] const SchemeRules& rules() const { return *layout_->rules; }
  [[nodiscard]] BoundsCache& library() const { return *layout_->library; }
  /// The same, for another surface to share.
  [[nodiscard]] const std::shared_ptr<BoundsCache>& shared_library() const { return layout_->library; }

  /// From mesh units to scaled ones.
  [[nodiscard]] PowerOfTwo scale() const { return scale_; }
  /// Longest side of the box of the used vertices, in mesh units; may overflow to infinity.
  [[nodiscard]] double size() const { return size_; }

  [[nodiscard]] std::size_t face_count() const { return layout_->topology.face_count(); }
  /// Faces, or vertices of a dual scheme.
  [[nodiscard]] std::size_t owner_count() const { return layout_->owner_count(); }
  /// Number of patches, those that are not there included.
  [[nodiscard]] std::size_t patch_count() const { return layout_->patch_count; }
  /// The patches of an owner: begin, begin + 1, ... end - 1.
  struct PatchRange {
    std::size_t begin, end;
  };
  [[nodiscard]] PatchRange patches_of(std::size_t owner) const;
  [[nodiscard]] PatchPlace place(PatchId p) const;
  /// Is the patch half a quad that the first split of its owner made? Then it lies one level down.
  [[nodiscard]] bool after_first_split(PatchId p) const;

  /// Is there a limit patch? Not in a hole, not at a boundary with BoundaryRule::none, and with a dual scheme
  /// not of a boundary vertex.
  [[nodiscard]] bool has_patch(PatchId p) const {
    return layout_->without_surface.empty() || !layout_->without_surface[place(p).owner];
  }
  /// Requires:  has_patch(p).
  [[nodiscard]] const Kind& kind(PatchId p) const {
    const Kind* const known = layout_->kinds[p.index()].load(std::memory_order_acquire);
    return known != nullptr ? *known : find_kind(p);
  }
  /// Which corner of the face its kind calls corner 0; 0 unless the scheme is triangular.
  /// Requires:  has_patch(p).
  [[nodiscard]] std::uint8_t first(PatchId p) const {
    if (layout_->firsts.empty()) return 0;
    static_cast<void>(kind(p));  // refuses it
    return layout_->firsts[p.index()].load(std::memory_order_relaxed);
  }
  /// The kind of the polygon that a patch is made of in a first split; none for others. Requires has_patch(p).
  [[nodiscard]] const Kind* polygon_of(PatchId p) const;
  /// The control vertices of a patch, or of its polygon, in the order of its kind. Requires has_patch(p).
  void control_vertices(PatchId p, std::vector<VertexId>& out) const;
  [[nodiscard]] const Point3& scaled_point(VertexId v) const { return scaled_[v.index()]; }
  /// Those of all vertices.
  [[nodiscard]] std::span<const Point3> scaled_points() const { return scaled_; }
  /// Vertices that no face uses, in rising order.
  [[nodiscard]] std::span<const VertexId> isolated() const { return layout_->isolated; }
  /// The middle of its owner's corners, in scaled units.
  [[nodiscard]] Point3 middle(PatchId p) const;
  /// The whole patch, in scaled units. InputError (value) unless has_patch(p).
  [[nodiscard]] Patch patch(PatchId p) const;
  /// The same, written over `out`, which keeps its memory.
  void patch(PatchId p, Patch& out) const;
  /// Names of the patch's three corners: equal names, equal limit points. Below corner_name_count().
  [[nodiscard]] std::array<std::uint32_t, 3> corner_names(PatchId p) const;
  [[nodiscard]] std::size_t corner_name_count() const;
  /// Finds the kinds of all patches.
  void find_kinds(int threads) const;
  /// Number of different kinds among its patches, all of which it finds.
  [[nodiscard]] std::size_t kind_count() const;

 private:
  // Depends on connectivity alone.
  struct Layout {
    Layout(const ControlMesh& mesh, const SchemeOptions& scheme, std::shared_ptr<BoundsCache> cache,
           const WorkMonitor& monitor);
    [[nodiscard]] std::size_t owner_count() const {
      return rules->primal ? topology.face_count() : topology.vertex_count();
    }
    void lay_out_patches();
    void find_owners_without_surface(const ControlMesh& mesh);

    SchemeOptions options;
    const SchemeRules* rules;
    std::shared_ptr<BoundsCache> library;
    Topology topology;
    Sharpness sharpness;
    std::vector<VertexId> isolated;
    std::size_t patch_count = 0;
    std::vector<bool> without_surface;  // owners without a surface; empty where there are none
    std::vector<std::uint32_t> begins;  // first patch of each owner and the end; empty for triangles
    std::vector<std::uint32_t> owners;  // of each patch; empty for triangles
    // Null until asked for. What `firsts` and `polygons` say is there before the kind.
    mutable std::vector<std::atomic<const Kind*>> kinds;
    mutable std::vector<std::atomic<std::uint8_t>> firsts;   // empty unless triangles
    mutable std::vector<std::atomic<const Kind*>> polygons;  // of each owner; empty where there are none
  };

  void set_scale();
  const Kind& find_kind(PatchId p) const;
  // The half-edge of corner k: of the face from there, or from the vertex in face k.
  [[nodiscard]] HalfEdge corner_at(std::size_t owner, std::size_t k = 0) const;

  ControlMesh mesh_;
  std::shared_ptr<const Layout> layout_;
  PowerOfTwo scale_;
  double size_ = 0;
  std::vector<Point3> scaled_;
};

}  // namespace snug
