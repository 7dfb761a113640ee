#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <snug/bound.h>
#include <snug/mesh.h>

namespace snug {

/// Uniform B-spline curves, as subdivision curves of polylines.
enum class CurveDegree : std::uint8_t {
  quadratic = 2,  ///< corner cutting: 3/4 1/4 and 1/4 3/4 on every edge [Chaikin74]
  cubic = 3,      ///< vertices 1/8 6/8 1/8, edges 1/2 1/2
};

/// The limit curves of a mesh's polylines: a handle that is cheap to copy, of curves that never change and may be used by any
/// number of threads at once. Edges are counted along the polylines; the closing edge of a closed one is its last.
///
/// Errors:    InputError (refused), naming elements, unless every polyline has a limit curve: at least one polyline, two
///            vertices each (twice the same is legal), all of them there and finite, no corners.
/// Cost:      linear; 16 bytes an edge beside the mesh.
class SNUG_API CurveSet {
 public:
  explicit CurveSet(ControlMesh mesh, CurveDegree degree = CurveDegree::cubic);
  CurveSet(const CurveSet&) noexcept;
  CurveSet& operator=(const CurveSet&) noexcept;
  ~CurveSet();

  [[nodiscard]] const ControlMesh& mesh() const;
  [[nodiscard]] CurveDegree degree() const;
  /// Longest side of the box of the vertices that polylines use; may overflow to infinity.
  [[nodiscard]] double size() const;
  [[nodiscard]] std::size_t edge_count() const;

  /// For internal use.
  class Edges;
  [[nodiscard]] const Edges& edges() const { return *edges_; }

 private:
  std::shared_ptr<const Edges> edges_;
};

/// A limit point of a curve in mesh units, and the derivative there along t.
struct CurvePoint {
  Point3 point;
  double error = 0;  ///< upper bound, per coordinate, of |point - limit point|, rounding included
  Vector3 tangent;   ///< in double precision without a bound; 0 where the curve has none
};

/// The limit point of an edge at exactly this t: 0 at the limit of its first vertex, 1 at that of the second.
/// Errors:    InputError: (value) unless edge < curves.edge_count() and 0 <= t <= 1; (unrepresentable) if a coordinate
///            does not fit a double.
/// Source:    derivations/curves.md.
[[nodiscard]] SNUG_API CurvePoint evaluate(const CurveSet& curves, EdgeId edge, double t);

/// Two sets that contain one piece of a limit curve, in mesh units.
struct CurveEnclosure {
  EdgeId edge;
  /// Which piece of its edge, one digit for each split: 0 for the first half, 1 for the second.
  std::string piece;
  unsigned level = 0;               ///< number of splits
  std::array<Point3, 2> corners{};  ///< limit points at its ends, in double precision
  OffsetSegment offset{};           ///< contains the piece
  IntervalSegment interval{};       ///< contains the piece, too
};

/// bound() of limit curves, edge by edge, pieces of one from its first end to its last. There are no normals.
SNUG_API BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                            const std::function<void(const CurveEnclosure&)>& sink, const Run& run = {});

/// The polylines after `level` steps of subdivision, or the limit positions of their vertices, in double precision: every
/// polyline with vertices of its own. Ends of open ones stay where they are. A step makes 2n - 1 (open) or 2n (closed) of n
/// vertices if cubic, else 2n.
/// Errors:    InputError: (refused) for more than 2^31 vertices; (unrepresentable) if a coordinate does not fit a double.
///            Interrupted.
/// Source:    derivations/curves.md.
[[nodiscard]] SNUG_API ControlMesh subdivided(const CurveSet& curves, unsigned level, bool limit = false,
                                              const Run& run = {});

}  // namespace snug
