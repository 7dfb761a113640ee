#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include <snug/search/surface_bvh.h>
#include <snug/surface.h>
#include <support/lazy.h>

namespace snug {

/// The data behind a Surface: its limit surface, and a tree that the first query builds.
class SurfaceData {
 public:
  SurfaceData(ControlMesh mesh, const SurfaceOptions& options, const Run& run = {});
  /// A frame of a moving surface: `like` with other control points. Frames share the plan of their trees.
  /// Errors:    those of LimitSurface::move().
  SurfaceData(const SurfaceData& like, std::span<const Point3> points, std::shared_ptr<SharedPlan> plan);
  /// Makes another frame of a frame, which keeps its memory. Nobody else may use it meanwhile, or have kept
  /// anything that it handed out.
  /// Errors:    those of LimitSurface::move(); it is then as it was.
  void move(std::span<const Point3> points);

  [[nodiscard]] const LimitSurface& limit() const { return limit_; }
  /// Errors:    InputError (refused) if nothing of the mesh has a limit surface.
  [[nodiscard]] const SurfaceBvh& bvh(const WorkMonitor& monitor = {}) const;
  [[nodiscard]] BoundMethod method() const { return bvh_options_.method; }
  [[nodiscard]] std::size_t bytes() const;
  /// Another one for each surface of the process, and for each frame of one that moves.
  [[nodiscard]] std::uint64_t number() const { return number_; }
  /// The same for all frames that are in this memory one after the other.
  [[nodiscard]] std::uint64_t storage() const { return storage_; }

 private:
  LimitSurface limit_;
  SurfaceBvhOptions bvh_options_;
  std::shared_ptr<SharedPlan> plan_;  // null unless it moves
  Lazy<SurfaceBvh> bvh_;
  std::uint64_t number_, storage_;
};

}  // namespace snug
