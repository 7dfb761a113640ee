#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <snug/base/lazy.h>
#include <snug/search/surface_bvh.h>
#include <snug/surface.h>

namespace snug {

/// What a Surface is a handle of: the limit surface, and its tree once a query asks.
class SurfaceData {
 public:
  SurfaceData(ControlMesh mesh, const SurfaceOptions& options);

  [[nodiscard]] const LimitSurface& limit() const { return limit_; }
  /// Errors:    InputError (refused) if nothing of the mesh has a limit surface.
  [[nodiscard]] const SurfaceBvh& bvh() const;
  [[nodiscard]] BoundMethod method() const { return bvh_options_.method; }
  [[nodiscard]] std::size_t bytes() const;
  /// Another one for each surface of the process.
  [[nodiscard]] std::uint64_t number() const { return number_; }

 private:
  LimitSurface limit_;
  SurfaceBvhOptions bvh_options_;
  Lazy<SurfaceBvh> bvh_;
  std::uint64_t number_;
};

}  // namespace snug
