#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <snug/search/piece_set.h>

namespace snug {

/// Which pieces lie on flat pieces of a set, all of each: triangulations of one plane, whatever their edges and corners. May be asked by
/// many threads.
///
/// Guarantee: pieces are a set that a projection shows to be covered, and all heights between both are counted.
/// Requires:  a set that is prepared and outlives this.
/// Source:    derivations/deviation.md, "Planes".
class PlaneCover {
 public:
  /// With heights of at most `most`.
  PlaneCover(const PieceSet& set, double most);
  /// How far all points of a piece are from the set, at most; none where that is not proved.
  [[nodiscard]] std::optional<double> distance_of(const QuadraticTriangle& piece) const;

 private:
  struct Side {
    std::uint32_t low, high;  // names of its ends
    std::uint32_t piece;
  };

  const PieceSet& set_;
  double most_;
  std::vector<double> off_;           // of each piece: from the triangle of its corners
  std::vector<std::uint32_t> names_;  // of the corners, three a piece
  std::vector<Side> sides_;           // in order
};

}  // namespace snug
