#pragma once

#include <cstddef>
#include <memory>

#include <snug/geometry/motion.h>

#include "peer_fcl.h"

namespace snug::bench {

/// FCL's tree over a mesh, with FCL's own types out of sight: peer_fcl_tree.cpp is compiled once against
/// Debian's FCL and once with FCL's sources, and each has a function that makes its trees.
class FclTree {
 public:
  virtual ~FclTree() = default;
  [[nodiscard]] virtual std::size_t bytes() const = 0;
  /// Requires:  the other tree made by the same function with the same boxes.
  [[nodiscard]] virtual bool collide(const Motion& place, const FclTree& other,
                                     const Motion& other_place) const = 0;
  [[nodiscard]] virtual double distance(const Motion& place, const FclTree& other,
                                        const Motion& other_place) const = 0;
  [[nodiscard]] virtual std::optional<double> first_contact(const Motion& place, const FclTree& other,
                                                            const Motion& from, const Motion& to,
                                                            FclContact how, std::size_t looks) const = 0;
};

[[nodiscard]] std::unique_ptr<FclTree> make_packaged_fcl_tree(const TriangleMesh& mesh, FclBoxes boxes);
#ifdef SNUG_BENCH_FCL_REBUILT
[[nodiscard]] std::unique_ptr<FclTree> make_rebuilt_fcl_tree(const TriangleMesh& mesh, FclBoxes boxes);
#endif

}  // namespace snug::bench
