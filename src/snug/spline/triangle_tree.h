#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/patch/limit_evaluator.h>
#include <snug/spline/flat_ball.h>

namespace snug {

/// Half of a square of parameters, cut along the diagonal: `lower` has the corners (0, 0), (1, 0), (1, 1), `upper` has (0, 0),
/// (1, 1), (0, 1).
enum class SquareHalf : std::uint8_t { lower, upper };

/// A quartic on a triangle by Bezier points, in the order of bezier_index().
struct QuarticTriangle {
  static constexpr std::size_t count = 15;
  std::array<Vector3, count> points{};
  double largest = 0;  ///< |coordinate|
  double error = 0;    ///< upper bound, a coordinate, of |point - exact point|
};

/// Upper bound of the distance, parameter by parameter, between a quartic on half of a square and a bicubic on the square.
/// Requires:  Bezier points of degree 3.
[[nodiscard]] double distance_bound(const QuarticTriangle& quartic, const TensorPiece& bicubic,
                                    SquareHalf half);

/// The same on a rectangle of the square's parameters that lies in the half; the bicubic's Bezier points are those on it.
[[nodiscard]] double distance_bound(const QuarticTriangle& quartic, const TensorPiece& bicubic,
                                    SquareHalf half, const ParameterBox& box);

/// The limit surface of a triangle of Loop's scheme, laid on half of a unit square: polynomials, and nets that are split
/// where questions need it. Points are relative to the patch's origin.
/// Source:    derivations/brep.md.
class TriangleTree {
 public:
  /// Corner k of the half is corner (k + turn) mod 3 of the patch.
  TriangleTree(const Patch& patch, unsigned turn, SquareHalf half);

  [[nodiscard]] const Point3& origin() const { return patch_.origin; }
  /// Flattens positions and derivatives, as the following have them, about a corner that has a tangent plane. distance() is from the
  /// limit surface itself.
  void flatten(std::size_t corner, double radius);
  /// Position, derivatives and mixed derivative at a point of the half; none at a corner that is extraordinary.
  [[nodiscard]] std::optional<CornerJet> jet(double u, double v);
  /// The limit point there.
  [[nodiscard]] Vector3 limit(double u, double v);
  /// At a corner of the half; none where there is no tangent plane.
  [[nodiscard]] std::optional<Vector3> normal(std::size_t corner);

  /// Upper bound of the distance, parameter by parameter, between the surface and a bicubic over the common part of the half
  /// and a box. No more work is done once it is at most `sufficient`.
  /// Requires:  Bezier points on the box; dyadic parameters.
  [[nodiscard]] double distance(const ParameterBox& box, const TensorPiece& bicubic, double sufficient);

 private:
  // A dyadic part of the half: either a polynomial or a net.
  struct Node {
    ControlNet net;  // corner k of the half is corner (k + 3 - first) mod 3 of its kind
    std::uint8_t first = 0;
    SquareHalf half{};
    std::optional<QuarticTriangle> quartic;
    std::uint32_t children = 0;  // number of the first of four, once it is split
  };
  class Search;

  [[nodiscard]] static Node node_of(ControlNet net, unsigned first, SquareHalf half);
  [[nodiscard]] std::uint32_t children_of(std::uint32_t node);
  [[nodiscard]] LimitFrame corner_frame(std::size_t corner);
  [[nodiscard]] std::optional<CornerJet> limit_jet(double u, double v);

  Patch patch_;
  unsigned turn_;
  SquareHalf half_;
  std::optional<LimitEvaluator> evaluator_;  // of corners
  std::vector<Node> nodes_;
  std::vector<FlatBall> flats_;
};

}  // namespace snug
