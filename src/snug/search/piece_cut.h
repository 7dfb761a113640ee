#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <snug/bounds/bounds_cache.h>
#include <snug/bvh/frame.h>
#include <snug/bvh/obb.h>
#include <snug/geometry/triangle.h>
#include <snug/patch/patch.h>

namespace snug {

/// A piece as placed: points whose hull holds it, and bounds of its tangent planes if it is polynomial. Corners are
/// counted as its kind does.
class PlacedPiece {
 public:
  PlacedPiece(BoundsCache& library, const Patch& patch, const PlacedFrame& frame);

  /// Around the piece; infinite where numbers are not finite.
  [[nodiscard]] const Box3& box() const { return box_; }
  /// Bounds of dot(w, x) over the piece.
  /// Requires:  |w| about 1.
  [[nodiscard]] Extent extent(const Vector3& w) const;
  /// Are tangent planes known, as near to one another as chords need?
  [[nodiscard]] bool bounded_slope() const { return slope_ < INFINITY; }
  /// |dot(normal(), v)| <= slope() |v| for the difference v of any two of its points, which is not zero for two
  /// parameters.
  [[nodiscard]] const Vector3& normal() const { return normal_; }
  [[nodiscard]] double slope() const { return slope_; }

  [[nodiscard]] const BoundedPoint& origin() const { return origin_; }
  /// The point at a parameter, relative to the origin.
  [[nodiscard]] Vector3 at(TriangleParameter at) const { return net_.at(at); }
  /// Upper bound, a coordinate, of what at() is off.
  [[nodiscard]] double error() const { return error_; }
  /// Vectors whose hull holds the derivatives along u and along v, or along the edge from corner k to k + 1.
  struct Derivatives {
    std::vector<Vector3> u, v;
    std::array<std::vector<Vector3>, 3> edge;
    double error = 0;  ///< upper bound, a coordinate, of what they are off
  };
  [[nodiscard]] const Derivatives& derivatives() const { return derivatives_; }
  /// Points whose hull holds the edge, up to error().
  [[nodiscard]] const std::vector<Vector3>& edge(std::size_t k) const { return edge_[k]; }

 private:
  // Relative to the origin: Bezier points of one part or of two halves, or points whose hull holds the piece.
  struct Net {
    std::vector<Vector3> points;
    std::size_t degree = 0, parts = 0;
    [[nodiscard]] Vector3 at(TriangleParameter at) const;
  };

  void take_polynomial(const Patch& patch, const PlacedFrame& frame);
  void take_hull(BoundsCache& library, const Patch& patch, const PlacedFrame& frame);
  void bound_slope();
  void bound_box();

  BoundedPoint origin_;
  Net net_;
  double error_ = 0;
  Derivatives derivatives_;
  std::array<std::vector<Vector3>, 3> edge_;
  Vector3 normal_;
  double slope_ = INFINITY;
  Box3 box_;
};

/// Where an edge of one piece passes through the other one.
struct CutEnd {
  std::size_t side;      ///< 0: an edge of the first piece
  std::size_t edge;      ///< from corner k of its kind to the next
  double along;          ///< in [0, 1], along the edge
  TriangleParameter at;  ///< on the other piece; if `sure` in its inside
  double doubt;          ///< upper bound of what these parameters are off
  bool sure;             ///< else several edges pass so near to it that it is not known which ends the arc
  Point3 point;
  double error;  ///< upper bound of |point - exact|, a length
};

/// An arc in which two pieces cut each other.
struct CutArc {
  std::array<CutEnd, 2> ends;
  double
      deviation;  ///< upper bound of the distance of arc and straight line between the points, each from the other
  Box3 box;       ///< holds the arc
};

/// How two pieces cut each other.
struct PieceCut {
  enum class State : std::uint8_t {
    apart,  ///< proved: they have no point in common
    arcs,   ///< proved: what they have in common are these arcs, and the contents of the end boxes
    unsure,
  };
  State state = State::unsure;
  std::vector<CutArc> arcs;
  /// Tiny boxes around ends that are not `sure`, where an edge of one piece meets an edge of the other, or nearly so.
  std::vector<Box3> end_boxes;
};

/// Guarantee: the state, rounding included. Ends of arcs that are `sure` are each the only common point of their edge
///            and the other piece; an arc begins and ends within CutEnd::error of these, or in an end box.
/// Source:    derivations/contacts.md.
[[nodiscard]] PieceCut cut(const PlacedPiece& a, const PlacedPiece& b);

/// The box that both boxes have in common; empty if there is none.
[[nodiscard]] Box3 common_box(const Box3& a, const Box3& b);

}  // namespace snug
