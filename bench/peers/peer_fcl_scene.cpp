#include "peer_fcl_scene.h"

#include <stdexcept>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/narrowphase/collision.h>

namespace snug::bench {
namespace {

using FclMesh = fcl::BVHModel<fcl::OBB<double>>;

std::shared_ptr<FclMesh> tree_of(const TriangleMesh& mesh) {
  std::vector<fcl::Vector3d> points;
  for (const Point3& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto tree = std::make_shared<FclMesh>();
  tree->beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
  tree->addSubModel(points, triangles);
  if (tree->endModel() != fcl::BVH_OK) throw std::runtime_error("FCL makes no tree");
  return tree;
}

fcl::Transform3d transform(const Motion& pose) {
  fcl::Transform3d result = fcl::Transform3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      result.matrix()(row, column) = pose.numbers()[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return result;
}

bool count_if_they_meet(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  if (fcl::collide(a, b, request, result) > 0) ++*static_cast<std::size_t*>(data);
  return false;
}

}  // namespace

struct FclScene::State {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects;
  fcl::DynamicAABBTreeCollisionManagerd manager;
};

FclScene::FclScene(std::span<const TriangleMesh> meshes, std::span<const Part> parts)
    : state_(std::make_unique<State>()) {
  std::vector<std::shared_ptr<FclMesh>> trees;
  for (const TriangleMesh& mesh : meshes) trees.push_back(tree_of(mesh));
  std::vector<fcl::CollisionObjectd*> all;
  for (const Part& part : parts) {
    state_->objects.push_back(
        std::make_unique<fcl::CollisionObjectd>(trees[part.mesh], transform(part.pose)));
    all.push_back(state_->objects.back().get());
  }
  state_->manager.registerObjects(all);
  state_->manager.setup();
}
FclScene::~FclScene() = default;

std::size_t FclScene::meeting() const {
  std::size_t count = 0;
  state_->manager.collide(&count, count_if_they_meet);
  return count;
}

}  // namespace snug::bench
