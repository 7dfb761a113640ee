#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <snug/geometry/motion.h>

#include "triangle_mesh.h"

namespace snug::bench {

/// The sort of box in FCL's trees: oriented ones, or these with rectangles swept by balls, which distances
/// need.
enum class FclBoxes { obb, obbrss };

/// Whose FCL: the package's, or FCL's sources (SNUG_FCL_SOURCE) compiled as snug is.
enum class FclBuild : std::uint8_t { packaged, rebuilt };
/// Those that this program has: the package's first.
[[nodiscard]] std::span<const FclBuild> fcl_builds();
[[nodiscard]] const char* name_of(FclBuild build);

class FclTree;

/// A triangle mesh with FCL's tree over it, fcl::BVHModel in double precision with FCL's own settings.
class FclModel {
 public:
  /// Requires:  a build that fcl_builds() has.
  FclModel(const TriangleMesh& mesh, FclBoxes boxes, FclBuild build = FclBuild::packaged);
  ~FclModel();
  FclModel(FclModel&&) noexcept;
  FclModel& operator=(FclModel&&) noexcept;

  /// Nodes, points and triangles; FCL's memUsage() only prints, and counts boxes without what nodes add to
  /// them.
  [[nodiscard]] std::size_t bytes() const;

  [[nodiscard]] const FclTree& tree() const { return *tree_; }

 private:
  std::unique_ptr<FclTree> tree_;
};

/// Do two triangles meet? One contact, without its details.
/// Requires:  both models of one build with the same boxes.
[[nodiscard]] bool fcl_collide(const FclModel& a, const Motion& place_a, const FclModel& b,
                               const Motion& place_b);

/// Distance of two triangle meshes: no error allowed, no nearest points, no signed distance. Negative or 0
/// for meshes that meet.
/// Requires:  both models of one build with FclBoxes::obbrss.
[[nodiscard]] double fcl_distance(const FclModel& a, const Motion& place_a, const FclModel& b,
                                  const Motion& place_b);

/// How FCL looks for a first contact: at even times, or by conservative advancement.
enum class FclContact : std::uint8_t { naive, advancement };
/// The time in [0, 1] at which b, on a screw between two placements, first meets a; nothing if FCL sees no
/// contact. `looks`: times, at most.
/// Requires:  as fcl_distance().
[[nodiscard]] std::optional<double> fcl_first_contact(const FclModel& a, const Motion& place_a,
                                                      const FclModel& b, const Motion& from, const Motion& to,
                                                      FclContact how, std::size_t looks);

}  // namespace snug::bench
