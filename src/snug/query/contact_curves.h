#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <snug/contacts.h>
#include <snug/search/piece_cut.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// Two pieces, of A and of B, that may have a point in common.
struct CrossingPieces {
  std::array<std::shared_ptr<const Patch>, 2> pieces;
  std::array<PatchId, 2> roots;
  std::uint32_t contact;  ///< a number of the caller's that goes with whatever is found
};

/// Two pieces, where it is not known how they cut each other.
struct UnresolvedPieces {
  Box3 box;  ///< holds what they have in common
  std::array<PatchId, 2> roots;
  std::uint32_t contact;
};

/// An end of an arc as a point of both root patches.
struct ArcEnd {
  Point3 point;
  std::array<TriangleParameter, 2> at;  ///< of the root patches
};

/// An arc, and where it goes on.
struct ChainArc {
  static constexpr std::uint32_t none = UINT32_MAX;
  CutArc arc;
  std::array<ArcEnd, 2> ends;
  std::array<PatchId, 2> roots;
  std::uint32_t contact;
  /// The end, 2 * arc + 0 or 1, that is proved to be the same point; `none` if there is none.
  std::array<std::uint32_t, 2> next{none, none};
  std::array<bool, 2> at_border{};  ///< does an end certainly lie on the border of a surface?
};

/// Intersection of two placed surfaces, in the units of their frames.
struct CutSurfaces {
  std::vector<ChainArc> arcs;
  std::vector<UnresolvedPieces> unresolved;
  std::uint64_t compared = 0;  ///< pairs of pieces
  bool reached = true;         ///< false if open pieces are coarser than the precision
  bool budget_spent = false;   ///< and others were not compared any further
  /// Contacts of pairs of which one piece is in the box of an unresolved one altogether.
  std::vector<std::uint32_t> covered;
};

/// Splits pieces until they are apart, cut each other in arcs as near to straight lines as `precision`, or have no
/// more in common than a box of that size. Pieces that lie in the other surface, as far as samples tell, are left as they are, each in
/// a box of its own.
///
/// Guarantee: all common points of the pieces are in the boxes of arcs or of open pieces. The same for any number of
///            threads.
[[nodiscard]] CutSurfaces cut_surfaces(const std::array<const LimitSurface*, 2>& surfaces,
                                       const std::array<PlacedFrame, 2>& frames,
                                       std::span<const CrossingPieces> pieces, double precision,
                                       std::uint64_t budget, int threads, const WorkMonitor& monitor);

/// Arcs in a row. Two ends that are not proved to be one point are joined where both lie in the same set of open
/// boxes that touch, and no third one does.
struct Chains {
  struct Chain {
    std::vector<std::uint32_t> ends;  ///< where each arc is entered: 2 * arc + 0 or 1
    /// A box for each arc but the last, of a closed chain for it too: of the open pieces between it and the next one;
    /// empty where these meet.
    std::vector<Box3> gaps;
    bool closed;
    std::array<bool, 2> at_border;
  };
  std::vector<Chain> chains;
};
[[nodiscard]] Chains chains_of(const CutSurfaces& cut);

}  // namespace snug
