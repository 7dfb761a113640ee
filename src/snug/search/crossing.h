#pragma once

#include <array>

#include <snug/search/piece_pairs.h>

namespace snug {

/// A condition under which a connected set meets a piece: it runs from below the piece to above it, inside the prism
/// over the part that the border leaves free.
///
///              . above .           The piece lies between two planes across n, and its border, seen along n,
///          ___/_________\___       within three strips along the edges of the limit triangle. A set inside
///         /   | . . . . |   \      of the strips with a point below and one above is cut by the piece: else
///        /____|_________|____\     the degree of the map (point of the piece) - (point of the set) on the
///              \ below /           sphere around the product of both would be zero, and it is one.
///
/// Guarantee: a connected set meets the piece if holds() all its parts and sides() finds points on either.
/// Source:    derivations/contact.md.
class CrossingTest {
 public:
  CrossingTest(const Piece& piece, const Heights& heights);

  /// False if the border leaves nothing free, or the piece has no normal.
  [[nodiscard]] bool possible() const { return possible_; }
  /// Is all within `radius` of the hull of `around`, in the piece's frame, certainly inside of the strips?
  [[nodiscard]] bool holds(const Triangle& around, double radius) const;
  struct Sides {
    bool below = false, above = false;
  };
  /// Is one of three points, each known up to `error`, certainly below, is one above?
  [[nodiscard]] Sides sides(const Triangle& points, double error) const;
  /// How far apart the planes are.
  [[nodiscard]] double thickness() const { return upper_ - lower_; }

 private:
  [[nodiscard]] double rounding(const Triangle& points) const;

  bool possible_ = false;
  Point3 from_;
  Vector3 normal_;
  double lower_ = 0, upper_ = 0;
  struct Strip {
    Vector3 inward;
    Point3 from;
    double width;  // upper bound of dot(inward, x - from) on the border curve
  };
  std::array<Strip, 3> strips_;
};

/// Is it proved that two pieces, or smaller ones where their base triangles are nearest, cross each other?
/// Source:    derivations/contact.md.
[[nodiscard]] bool proves_crossing(PairFrames& frames, const PiecePair& pieces);
/// The same of two pieces of one surface, by rows: an approximate place, if it is proved.
[[nodiscard]] std::optional<PairOfPoints> proved_crossing(BoundsCache& library, const Piece& a,
                                                          const Piece& b);

}  // namespace snug
