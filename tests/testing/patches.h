#pragma once

#include <memory>

#include <snug/patch/evaluate.h>
#include <snug/surface/limit_surface.h>
#include <testing/twins.h>

namespace snug::testing {

/// Surface of a twin's mesh. `scaled` coordinates are the mesh's own where they lie in [1, 2).
[[nodiscard]] inline LimitSurface surface_of(const oracle::TwinMesh& twin) {
  return LimitSurface(control_mesh(twin), rules(twin), std::make_shared<BoundsCache>());
}

}  // namespace snug::testing
