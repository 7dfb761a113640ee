#include "peer_fcl.h"

#include <stdexcept>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

namespace snug::bench {
namespace {

template <class Boxes>
std::unique_ptr<fcl::CollisionGeometryd> build(const TriangleMesh& mesh, std::size_t& bytes) {
  std::vector<fcl::Vector3d> points;
  points.reserve(mesh.points.size());
  for (const Point3& p : mesh.points) points.emplace_back(p.x, p.y, p.z);
  std::vector<fcl::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  auto model = std::make_unique<fcl::BVHModel<Boxes>>();
  model->beginModel(static_cast<int>(triangles.size()), static_cast<int>(points.size()));
  model->addSubModel(points, triangles);
  if (model->endModel() != fcl::BVH_OK) throw std::runtime_error("FCL makes no tree");
  bytes = static_cast<std::size_t>(model->getNumBVs()) * sizeof(fcl::BVNode<Boxes>) +
          triangles.size() * (sizeof(fcl::Triangle) + sizeof(unsigned)) +
          points.size() * sizeof(fcl::Vector3d) + sizeof(*model);
  return model;
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

}  // namespace

struct FclModel::Impl {
  std::unique_ptr<fcl::CollisionGeometryd> geometry;
  std::size_t bytes = 0;
};

FclModel::FclModel(const TriangleMesh& mesh, FclBoxes boxes) : impl_(new Impl) {
  impl_->geometry = boxes == FclBoxes::obb ? build<fcl::OBB<double>>(mesh, impl_->bytes)
                                           : build<fcl::OBBRSS<double>>(mesh, impl_->bytes);
}
FclModel::~FclModel() = default;
FclModel::FclModel(FclModel&&) noexcept = default;
FclModel& FclModel::operator=(FclModel&&) noexcept = default;

std::size_t FclModel::bytes() const { return impl_->bytes; }

bool fcl_collide(const FclModel& a, const Motion& place_a, const FclModel& b, const Motion& place_b) {
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return fcl::collide(a.impl().geometry.get(), transform(place_a), b.impl().geometry.get(),
                      transform(place_b), request, result) > 0;
}

double fcl_distance(const FclModel& a, const Motion& place_a, const FclModel& b, const Motion& place_b) {
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  return fcl::distance(a.impl().geometry.get(), transform(place_a), b.impl().geometry.get(),
                       transform(place_b), request, result);
}

}  // namespace snug::bench
