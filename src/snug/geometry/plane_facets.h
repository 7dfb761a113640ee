#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/geometry/exact_number.h>
#include <support/point.h>

namespace snug {

/// A polygon in a plane, strictly convex, exactly.
class PlaneFacet {
 public:
  static constexpr std::size_t max_corners = 64;
  /// Nothing for a polygon without area.
  /// Requires:  3 to max_corners corners, strictly convex in one plane unless on one line; no coordinate above some 2^20.
  [[nodiscard]] static std::optional<PlaneFacet> made(std::vector<ExactPoint> corners);

  [[nodiscard]] std::size_t size() const { return corners_.size(); }
  [[nodiscard]] const ExactPoint& corner(std::size_t k) const { return corners_[k % corners_.size()]; }
  /// Where the corners run counter-clockwise.
  [[nodiscard]] Projection to() const { return to_; }

 private:
  std::vector<ExactPoint> corners_;
  Projection to_;
};

/// The points that two facets have in common.
struct FacetMeeting {
  enum class State : std::uint8_t {
    apart,     ///< nothing
    touching,  ///< `corners`, as hull
    crossing,  ///< the segment `corners`, in which each passes through the other one's plane
  };
  State state = State::apart;
  /// A convex polygon, in the order of the first facet's corners, a segment or a point. Exact where the error is 0.
  std::vector<BoundedPoint> corners;
  /// Of each facet the corners of the least element that all of this is on: one, two ends of an edge, or all, in rising order.
  std::array<std::vector<std::size_t>, 2> elements;
  /// The same of each end of a crossing.
  std::array<std::array<std::vector<std::size_t>, 2>, 2> ends;
};

/// Guarantee: the state and the number of corners, in exact arithmetic.
/// Cost:      some microseconds where facets are in one plane; 0.1 us where doubles see that they are not.
/// Source:    derivations/contacts.md, "Plane facets".
[[nodiscard]] FacetMeeting meet(const PlaneFacet& a, const PlaneFacet& b);

}  // namespace snug
