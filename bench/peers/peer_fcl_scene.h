#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <snug/geometry/motion.h>

#include "triangle_mesh.h"

namespace snug::bench {

/// FCL's broad phase, fcl::DynamicAABBTreeCollisionManager, over placed triangle meshes with FCL's trees of oriented boxes,
/// which parts share.
class FclScene {
 public:
  struct Part {
    std::size_t mesh;
    Motion pose;
  };
  FclScene(std::span<const TriangleMesh> meshes, std::span<const Part> parts);
  ~FclScene();

  /// How many pairs of parts meet: one contact a pair, without its details.
  [[nodiscard]] std::size_t meeting() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace snug::bench
