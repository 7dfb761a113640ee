// Compiled twice, see peer_fcl_tree.h. SNUG_FCL_MAKER names the function; for FCL's sources the macro `fcl`
// names its namespace anew, so that both live in one program.

#include "peer_fcl_tree.h"

#include <stdexcept>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/continuous_collision.h>
#include <fcl/narrowphase/distance.h>

namespace snug::bench {
namespace {

fcl::Transform3d transform(const Motion& pose) {
  fcl::Transform3d result = fcl::Transform3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      result.matrix()(row, column) = pose.numbers()[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return result;
}

class Tree final : public FclTree {
 public:
  Tree(const TriangleMesh& mesh, FclBoxes boxes) {
    geometry_ = boxes == FclBoxes::obb ? build<fcl::OBB<double>>(mesh) : build<fcl::OBBRSS<double>>(mesh);
  }

  [[nodiscard]] std::size_t bytes() const override { return bytes_; }

  [[nodiscard]] bool collide(const Motion& place, const FclTree& other,
                             const Motion& other_place) const override {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(geometry_.get(), transform(place), static_cast<const Tree&>(other).geometry_.get(),
                        transform(other_place), request, result) > 0;
  }

  [[nodiscard]] double distance(const Motion& place, const FclTree& other,
                                const Motion& other_place) const override {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    return fcl::distance(geometry_.get(), transform(place), static_cast<const Tree&>(other).geometry_.get(),
                         transform(other_place), request, result);
  }

  [[nodiscard]] std::optional<double> first_contact(const Motion& place, const FclTree& other,
                                                    const Motion& from, const Motion& to, FclContact how,
                                                    std::size_t looks) const override {
    const fcl::ContinuousCollisionRequestd request(
        looks, 1e-4, fcl::CCDM_SCREW, fcl::GST_LIBCCD,
        how == FclContact::naive ? fcl::CCDC_NAIVE : fcl::CCDC_CONSERVATIVE_ADVANCEMENT);
    fcl::ContinuousCollisionResultd result;
    fcl::continuousCollide(geometry_.get(), transform(place), transform(place),
                           static_cast<const Tree&>(other).geometry_.get(), transform(from), transform(to),
                           request, result);
    // Advancement leaves is_collide as it is.
    if (!result.is_collide && !(result.time_of_contact < 1)) return std::nullopt;
    return result.time_of_contact;
  }

 private:
  template <class Boxes>
  std::unique_ptr<fcl::CollisionGeometryd> build(const TriangleMesh& mesh) {
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
    bytes_ = static_cast<std::size_t>(model->getNumBVs()) * sizeof(fcl::BVNode<Boxes>) +
             triangles.size() * (sizeof(fcl::Triangle) + sizeof(unsigned)) +
             points.size() * sizeof(fcl::Vector3d) + sizeof(*model);
    return model;
  }

  std::unique_ptr<fcl::CollisionGeometryd> geometry_;
  std::size_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<FclTree> SNUG_FCL_MAKER(const TriangleMesh& mesh, FclBoxes boxes) {
  return std::make_unique<Tree>(mesh, boxes);
}

}  // namespace snug::bench
