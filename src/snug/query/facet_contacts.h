#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <snug/geometry/plane_facets.h>
#include <snug/search/pair_frames.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Plane faces of two placed surfaces against each other, exactly for the doubles of the poses; of equal poses, without them.
///
/// Source:    derivations/contacts.md, "Plane facets".
class FacetContacts {
 public:
  /// `frames`: of a and b.
  FacetContacts(const PairFrames& frames, const PlacedBvh& a, const PlacedBvh& b);

  /// The points that two owners have in common, in the units of the frames; null unless both are faces that can be compared exactly.
  [[nodiscard]] const FacetMeeting* between(std::uint32_t a, std::uint32_t b);

  struct Touching {
    std::array<std::uint32_t, 2> faces;
    const FacetMeeting* meeting;
  };
  /// Of all that were asked for, what touches; what edges and corners have in common, once, and not where it lies in what other faces
  /// have.
  [[nodiscard]] std::vector<Touching> touching() const;

  struct Crossing {
    static constexpr std::uint32_t none = UINT32_MAX;
    Touching segment;
    /// By end: that of another crossing, 2 * its number + 0 or 1, which is the same point, as an edge or a corner names it; `none` if there
    /// is none left. Each is that of one end.
    std::array<std::uint32_t, 2> next{none, none};
    std::array<bool, 2> at_border{};  ///< does an end lie on the border of a surface?
  };
  /// Of all that were asked for, what passes through each other.
  [[nodiscard]] std::vector<Crossing> crossings() const;

 private:
  using Key = std::array<std::uint32_t, 2>;

  [[nodiscard]] const LimitSurface& surface(std::size_t side) const {
    return frames_.cache(side).model().surface();
  }
  [[nodiscard]] const std::optional<PlaneFacet>& facet(std::size_t side, std::uint32_t owner);
  [[nodiscard]] std::optional<PlaneFacet> made(std::size_t side, std::uint32_t owner) const;
  [[nodiscard]] std::optional<ExactPoint> placed(std::size_t side, VertexId vertex) const;
  [[nodiscard]] BoundedPoint posed(const BoundedPoint& point) const;
  [[nodiscard]] std::vector<std::uint32_t> names(std::size_t side, std::uint32_t face,
                                                 const std::vector<std::size_t>& corners) const;
  [[nodiscard]] bool on_border(std::size_t side, std::uint32_t face,
                               const std::vector<std::size_t>& corners) const;

  const PairFrames& frames_;
  bool comparable_ = true;
  std::optional<PlacedFrame> common_;  // a pose that both have
  std::array<std::unordered_map<std::uint32_t, std::optional<PlaneFacet>>, 2> facets_;
  std::map<Key, FacetMeeting> known_;
};

}  // namespace snug
