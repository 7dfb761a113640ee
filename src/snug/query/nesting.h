#pragma once

#include <cstddef>
#include <optional>

#include <snug/collide.h>
#include <snug/search/piece_cache.h>
#include <snug/surface/evaluate.h>

namespace snug {

/// Throws InputError (refused) unless both surfaces are closed.
void require_solids(const PlacedBvh& a, const PlacedBvh& b);

/// Whether a component of one closed surface lies in the solid that another one bounds.
struct Nesting {
  /// 0: a component of A has a point in the solid of B; 1: the other way round. Nothing where none is found.
  std::optional<std::size_t> inner;
  /// Is it certain that there is no other? Not where a point is too near the other surface to decide.
  bool certain = true;
  BoundedPoint point;  ///< of the inner surface, in the outer solid; mesh units, world coordinates
  Place at{};          ///< where it lies on the inner surface

  /// This point as both witnesses. Requires:  inner.
  [[nodiscard]] WitnessPoints witness() const {
    const LimitPoint common{point.position, point.error, {}};
    WitnessPoints points{common, common};
    points[*inner].at = at;
    return points;
  }
  /// Writes this common point of two solids to a Collision or a Distance.
  /// Requires:  inner.
  template <class Answer>
  void write_to(Answer& answer) const {
    answer.distance = 0;
    answer.witness = witness();
    answer.contained = inner;
  }
};

/// Asks one limit point of each component of two placed surfaces whether it lies in the other solid.
///
/// Guarantee: a point that is named lies on one surface and in the solid of the other one. Surfaces that do
///            not meet bound solids that do not meet if `certain` and there is no `inner`.
/// Source:    derivations/contact.md, "Two solids".
[[nodiscard]] Nesting nesting(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor = {});

/// Looks for a point of one surface in the other solid where the surfaces may meet: also in the middles of
/// some patches, those deepest in the box around the other one. Where faces of two parts lie in each other no
/// crossing proves contact; a point of this sort does.
///
/// Guarantee: as nesting(); nothing follows where none is found.
[[nodiscard]] Nesting common_point(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor = {});

/// Is there a point inside of both solids? Points a little inward of some patches of each are asked: they prove
/// that equal solids in one place meet, no point of whose surfaces is inside of the other one.
///
/// Guarantee: true is proved; nothing follows from false.
/// Source:    derivations/contact.md, "Two solids".
[[nodiscard]] bool have_inner_point_in_common(const PlacedBvh& a, const PlacedBvh& b,
                                              const WorkMonitor& monitor = {});

/// A patch of a closed surface beside which the surface winds around a point more than once, either way: then a shell
/// lies within another one that is turned the same way, or shells overlap. Points beside one patch of each of at most
/// 100 components are asked, and beside 200 patches of all of the surface.
///
/// Guarantee: a patch that is named is beside such a point; nothing follows where none is.
/// Errors:    InputError (refused) unless the surface is closed.
[[nodiscard]] std::optional<PatchId> wound_twice(const SurfaceBvh& model, const WorkMonitor& monitor = {});

}  // namespace snug
