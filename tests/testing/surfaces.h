#pragma once

#include <snug/scheme/scheme.h>
#include <snug/surface.h>
#include <testing/twins.h>

#include <utility>

namespace snug::testing {

/// The public surface of a mesh under rules, of which its tags have to say some.
[[nodiscard]] inline Surface public_surface(ControlMesh mesh, const SchemeOptions& rules,
                                            SurfaceOptions options = {}, const Run& run = {.threads = 1}) {
  mesh.tags.crease_method = rules.creases;
  mesh.tags.smooth_triangles = rules.triangles;
  options.scheme = rules.scheme;
  options.boundary = rules.boundary;
  return Surface(std::move(mesh), options, run);
}
[[nodiscard]] inline Surface public_surface(const oracle::TwinMesh& twin, const SurfaceOptions& options = {},
                                            const Run& run = {.threads = 1}) {
  return public_surface(control_mesh(twin), rules(twin), options, run);
}

}  // namespace snug::testing
