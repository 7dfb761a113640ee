#pragma once

#include <oracle/contact_twin.h>
#include <oracle/dual_twin.h>
#include <oracle/tagged_mesh.h>

#include <cstdint>
#include <memory>
#include <optional>

namespace oracle {

/// Splits of the patches of one scheme and its rules: computed once for all surfaces that share them.
class LimitRules {
 public:
  /// Catmull-Clark and Loop with every tag. Chaikin's dart edges are clamped, so that all masks are convex.
  explicit LimitRules(const Rules& rules);
  explicit LimitRules(DualScheme scheme);
  ~LimitRules();
  LimitRules(const LimitRules&) = delete;
  LimitRules& operator=(const LimitRules&) = delete;

 private:
  friend class LimitTwin;
  struct Kinds;
  std::unique_ptr<Kinds> kinds_;
};

/// The limit surface of a mesh of any scheme with any tags, for questions about distances.
///
/// Every patch is known by its control points, in whose convex hull it lies since all masks are convex
/// combinations, and by limit points at its corners. Patches are split by matrices that the refinement of
/// polygon_twin and dual_twin, applied to unit vectors in 113 bits, gives for each connectivity and
/// sharpness.
///
/// Rounding:  as ContactSurface: plain doubles; control points after L splits are off by at most (L + 2) (K +
///            16) 2^-52 S a coordinate, K the largest number of control points of a patch. Every bound is
///            moved outwards by that, and by how far a limit corner is from its limit where no formula is
///            known.
/// Errors:    std::invalid_argument, see TaggedMesh; also if there is no surface or a placement is not
///            finite. Dual schemes want an oriented manifold.
/// Requires:  coordinates between 1e-140 and 1e140 in size, or zero; rules and surfaces are used by one
///            thread.
/// Cost:      a split some microseconds once the kind is known; a kind a millisecond, hundreds at valences of
///            hundreds.
class LimitTwin {
 public:
  LimitTwin(const TaggedMesh& mesh, std::shared_ptr<LimitRules> rules);
  ~LimitTwin();
  LimitTwin(LimitTwin&&) noexcept;
  LimitTwin& operator=(LimitTwin&&) noexcept;

  /// Guarantee: as ContactSurface's.
  friend ContactBounds contact_bounds(LimitTwin& a, const Placement& place_a, LimitTwin& b,
                                      const Placement& place_b, const ContactGoal& goal);
  /// Bounds of the distance of a point to the placed surface, or to its part that belongs to a face (a
  /// vertex, with a dual scheme).
  [[nodiscard]] ContactBounds distance_to(const Placement& placement, const Point& point,
                                          const ContactGoal& goal, std::optional<std::uint32_t> owner = {});
  /// Is a limit point within `tolerance` of `point`? True only if there is one.
  [[nodiscard]] bool on_surface(const Placement& placement, const Point& point, double tolerance,
                                std::optional<std::uint32_t> owner = {});

  /// The limit point at a place as FaceSample names it, not placed; rounded as described above.
  /// Requires:  a primal scheme and a face with a surface.
  [[nodiscard]] Point limit_point(std::uint32_t face, std::uint32_t part, double u, double v);
  /// A limit point at a corner of patch `i`, modulo their number.
  [[nodiscard]] Point some_limit_point(std::size_t i) const;

  /// How often the surface winds around a point. All patches are split equally often, until none has the
  /// point in its hull; then that of the polyhedron of limit corners is the same. Nothing where `max_levels`
  /// do not reach.
  /// Requires:  a closed surface.
  [[nodiscard]] std::optional<int> winding_number(const Point& point, int max_levels = 5);

  /// Largest |coordinate| of the mesh.
  [[nodiscard]] double largest() const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

[[nodiscard]] ContactBounds contact_bounds(LimitTwin& a, const Placement& place_a, LimitTwin& b,
                                           const Placement& place_b, const ContactGoal& goal);

}  // namespace oracle
