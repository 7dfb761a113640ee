#pragma once

#include <oracle/distance_twin.h>
#include <oracle/twin_mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

namespace oracle {

/// When a search of ContactSurface may stop.
struct ContactGoal {
  Precision precision{0, 0};  ///< upper - lower <= max(absolute, relative * upper)
  std::optional<double> threshold =
      {};                       ///< or once the distance is proved above it, or points no farther are found
  std::size_t effort = 20'000;  ///< or after so many pairs of patches
};

/// lower <= distance <= upper, whether or not the goal was reached. on_a and on_b are placed limit points at
/// a distance of at most upper, up to their rounding.
struct ContactBounds {
  double lower, upper;
  Point on_a, on_b;
  bool spent;  ///< the effort ended the search
};

/// A Loop limit surface for very many questions about distances: a fast sibling of SurfaceTwin that takes
/// one-sided questions. Patches are split by matrices, one for each connectivity of a net, made once a thread
/// by the masks of loop_net.h.
///
/// Rounding:  plain doubles; a net after L splits is off by at most (L + 2) (K + 16) 2^-52 S a coordinate, K the largest
///            number of points in a net, S the largest |coordinate|. Every bound is moved outwards by that. A pair's frame
///            is that of the first surface without its translation, so far away pairs are as exact as near ones as
///            long as the difference of the translations is.
/// Errors:    std::invalid_argument, see TwinMesh; also if no face has a surface or a placement is not
///            finite.
/// Requires:  coordinates between 1e-140 and 1e140 in size, or zero; each surface is used by the thread that
///            made it.
/// Cost:      a split some 4 microseconds, a pair of patches one or two.
class ContactSurface {
 public:
  static constexpr std::size_t kLargestTree = 60'000;
  static constexpr std::uint32_t kDeepestPatch = 46;

  explicit ContactSurface(const TwinMesh& mesh);
  ~ContactSurface();
  ContactSurface(ContactSurface&&) noexcept;
  ContactSurface& operator=(ContactSurface&&) noexcept;

  /// Distance bounds of two placed surfaces, or of one and itself.
  ///
  /// Guarantee: lower <= distance <= upper, rounding included. Where the goal has a threshold: lower >
  ///            threshold, or upper <= threshold, or `spent`, or rounding hides the answer.
  friend ContactBounds contact_bounds(ContactSurface& a, const Placement& place_a, ContactSurface& b,
                                      const Placement& place_b, const ContactGoal& goal);

  /// Bounds of the distance of a point to the placed surface, or to its part that belongs to a face.
  [[nodiscard]] ContactBounds distance_to(const Placement& placement, const Point& point,
                                          const ContactGoal& goal, std::optional<std::uint32_t> face = {});

  /// Is a limit point within `tolerance` of `point`? True only if there is one.
  [[nodiscard]] bool on_surface(const Placement& placement, const Point& point, double tolerance,
                                std::optional<std::uint32_t> face = {});

  /// Is it proved that no point of the segment from p to q lies on the placed surface?
  [[nodiscard]] bool misses(const Placement& placement, const Point& p, const Point& q);

  /// The limit point at (u, v) of a face, not placed, rounded as described above.
  /// Requires:  u, v >= 0, u + v <= 1; a face with a surface.
  [[nodiscard]] Point limit_point(std::uint32_t face, double u, double v);

  /// Largest |coordinate| of the net.
  [[nodiscard]] double largest() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

[[nodiscard]] ContactBounds contact_bounds(ContactSurface& a, const Placement& place_a, ContactSurface& b,
                                           const Placement& place_b, const ContactGoal& goal);

}  // namespace oracle
