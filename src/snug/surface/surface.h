#pragma once

#include <memory>
#include <vector>

#include <snug/base/progress.h>
#include <snug/base/scaling.h>
#include <snug/basis/bound_library.h>
#include <snug/mesh/topology.h>
#include <snug/patch/patch.h>
#include <snug/scheme/scheme.h>

namespace snug {

/// The limit surface of a control mesh: one patch a face. Immutable; may be read by many threads.
///
/// Inside, coordinates are scaled by a power of two so that the largest lies in [1, 2); `scale()` leads there
/// from mesh units. Everything below surface/ works in scaled units, everything that questions answer with is
/// in mesh units.
///
/// Errors:    InputError (refused) from require_subdividable.
/// Cost:      linear; 9 bytes a face beside mesh and topology. Rows of kinds are made when a patch is first
///            bounded.
class Surface {
 public:
  Surface(ControlMesh mesh, const SchemeOptions& options, std::shared_ptr<BoundLibrary> library,
          int threads = 0, const WorkMonitor& monitor = {});

  [[nodiscard]] const ControlMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Topology& topology() const { return topology_; }
  [[nodiscard]] const SchemeOptions& options() const { return options_; }
  [[nodiscard]] BoundLibrary& library() const { return *library_; }

  /// From mesh units to scaled ones.
  [[nodiscard]] PowerOfTwo scale() const { return scale_; }
  /// Longest side of the box of the used vertices, in mesh units; may overflow to infinity.
  [[nodiscard]] double size() const { return size_; }

  [[nodiscard]] std::size_t face_count() const { return topology_.face_count(); }
  /// Has the face a limit patch? Not at a boundary with BoundaryRule::none.
  [[nodiscard]] bool has_patch(FaceId f) const { return kinds_[f.index()] != nullptr; }
  /// Requires:  has_patch(f).
  [[nodiscard]] const Kind& kind(FaceId f) const { return *kinds_[f.index()]; }
  /// Which corner of the face its kind calls corner 0.
  /// Requires:  has_patch(f).
  [[nodiscard]] std::uint8_t first(FaceId f) const { return firsts_[f.index()]; }
  /// The control vertices of a face's patch, in the order of its kind.
  /// Requires:  has_patch(f).
  void control_vertices(FaceId f, std::vector<VertexId>& out) const;
  /// The whole patch of a face, in scaled units.
  /// Requires:  has_patch(f).
  /// Cost:      a walk around its corners.
  [[nodiscard]] Patch patch(FaceId f) const;
  /// Number of different kinds among its patches.
  [[nodiscard]] std::size_t kind_count() const;

 private:
  ControlMesh mesh_;
  SchemeOptions options_;
  std::shared_ptr<BoundLibrary> library_;
  Topology topology_;
  PowerOfTwo scale_;
  double size_ = 0;
  std::vector<Point3> scaled_;
  std::vector<const Kind*> kinds_;
  std::vector<std::uint8_t> firsts_;
};

}  // namespace snug
