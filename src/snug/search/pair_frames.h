#pragma once

#include <array>
#include <optional>

#include <snug/search/piece_cache.h>

namespace snug {

/// Two placed surfaces as one query sees them. Lengths are in units of its own, powers of two away from mesh
/// units, in which both are at most about 2 large and far.
class PairFrames {
 public:
  /// Errors:    InputError (value) unless each has a cache of its own.
  PairFrames(const PlacedBvh& a, const PlacedBvh& b);

  /// From mesh units; a lower bound and an upper bound of the exact length.
  [[nodiscard]] double length_down(double mesh_units) const;
  [[nodiscard]] double length_up(double mesh_units) const;
  [[nodiscard]] PowerOfTwo to_mesh_units() const { return world_.inverse(); }

  [[nodiscard]] PieceCache& cache(std::size_t side) const { return *cache_[side]; }
  [[nodiscard]] const PlacedFrame& frame(std::size_t side) const { return frame_[side]; }
  /// How the other side is seen from the frame of `side`.
  [[nodiscard]] const RelativeFrame& seen_from(std::size_t side) const { return seen_from_[side]; }
  /// The same for boxes; made on first use.
  [[nodiscard]] const View& view(std::size_t side) {
    if (!view_[side]) view_[side].emplace(seen_from_[side]);
    return *view_[side];
  }
  /// Gaps::lines looks along this direction, from A to B.
  void look_along(const Vector3& direction);

 private:
  std::array<PieceCache*, 2> cache_;
  PowerOfTwo world_;
  std::array<PlacedFrame, 2> frame_;
  std::array<RelativeFrame, 2> seen_from_;
  std::array<std::optional<View>, 2> view_;
};

/// Lower bound, in mesh units, of the distance of two placed surfaces, by balls and then by boxes around them.
/// No better one is looked for than `enough`, nor, with a finite one, where balls lie deep in each other and boxes are no rods or
/// plates. Not positive where none shows, or where doubles do not reach.
/// Cost:      5 to 30 ns.
/// Source:    derivations/boxes.md, "Whole models".
[[nodiscard]] double root_gap(const PlacedBvh& a, const PlacedBvh& b, double enough);

/// Lower bound, in mesh units, of the distance of two placed surfaces, along the line between their middles:
/// cheap. Not positive where none shows, or where doubles do not reach.
/// Source:    derivations/boxes.md, "Whole models".
[[nodiscard]] double outer_gap(const PlacedBvh& a, const PlacedBvh& b);

}  // namespace snug
