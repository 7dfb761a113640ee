#include "peer_fcl.h"

#include "peer_fcl_tree.h"

namespace snug::bench {

FclModel::FclModel(const TriangleMesh& mesh, FclBoxes boxes, FclBuild build) {
#ifdef SNUG_BENCH_FCL_REBUILT
  if (build == FclBuild::rebuilt) {
    tree_ = make_rebuilt_fcl_tree(mesh, boxes);
    return;
  }
#else
  static_cast<void>(build);
#endif
  tree_ = make_packaged_fcl_tree(mesh, boxes);
}
FclModel::~FclModel() = default;
FclModel::FclModel(FclModel&&) noexcept = default;
FclModel& FclModel::operator=(FclModel&&) noexcept = default;

std::size_t FclModel::bytes() const { return tree_->bytes(); }

std::span<const FclBuild> fcl_builds() {
#ifdef SNUG_BENCH_FCL_REBUILT
  static constexpr std::array builds{FclBuild::packaged, FclBuild::rebuilt};
#else
  static constexpr std::array builds{FclBuild::packaged};
#endif
  return builds;
}

const char* name_of(FclBuild build) {
  return build == FclBuild::packaged ? "Debian's FCL" : "FCL built with snug's flags";
}

bool fcl_collide(const FclModel& a, const Motion& place_a, const FclModel& b, const Motion& place_b) {
  return a.tree().collide(place_a, b.tree(), place_b);
}

double fcl_distance(const FclModel& a, const Motion& place_a, const FclModel& b, const Motion& place_b) {
  return a.tree().distance(place_a, b.tree(), place_b);
}

std::optional<double> fcl_first_contact(const FclModel& a, const Motion& place_a, const FclModel& b,
                                        const Motion& from, const Motion& to, FclContact how,
                                        std::size_t looks) {
  return a.tree().first_contact(place_a, b.tree(), from, to, how, looks);
}

}  // namespace snug::bench
