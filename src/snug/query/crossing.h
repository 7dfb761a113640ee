#pragma once

#include <array>

#include <snug/surface/refinement.h>
#include <snug/tree/frame.h>

namespace snug {

/// What a connected set must do to be proved to meet a piece: run from below it to above it inside the prism over what its
/// border leaves free.
///
///              . above .           The piece lies between two planes across n. Its border lies, seen along n, within
///          ___/_________\___       three strips along the edges of the limit triangle. A set that stays inside of the
///         /   | . . . . |   \      strips and has a point below and one above is cut by the piece: else the degree of
///        /____|_________|____\     the map (point of the piece) - (point of the set) on the sphere around the product of
///              \ below /           both would be zero, and it is one.
///
/// Guarantee: crossed_by() is true only if every connected set of which the given things hold meets the piece.
/// Source:    derivations/contact.md.
class Crossed {
 public:
  Crossed(const Piece& piece, const Heights& heights);

  /// False if the border leaves nothing free, or the piece has no normal.
  [[nodiscard]] bool possible() const { return possible_; }
  /// The set lies within `radius` of the hull of `around`, and has points within `error` of each of `points`; all in the
  /// frame of the piece's surface.
  [[nodiscard]] bool crossed_by(const Triangle& around, double radius, const Triangle& points,
                                double error) const;
  /// Could a set so far apart along the normal be long enough?
  [[nodiscard]] double thickness() const { return upper_ - lower_; }

 private:
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

/// Do pieces of `id` around a parameter cross? Splits a few levels down.
/// Requires:  seen: the pieces' frame as seen from that of the crossed piece.
[[nodiscard]] bool crosses_near(Refinement& pieces, PieceId id, TriangleParameter at, const Crossed& crossed,
                                const RelativeFrame& seen);

}  // namespace snug
