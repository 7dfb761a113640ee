#pragma once

#include <support/point.h>

namespace snug {

/// Parameters on a triangle: its point is (1 - u - v) c0 + u c1 + v c2.
struct TriangleParameter {
  double u = 0, v = 0;
};

/// Weights of the second and third corner; the first has the rest.
struct Barycentric {
  double b = 0, c = 0;
};

/// Feet of many points on one triangle, prepared once. The triangle may be a needle or a point.
///
/// Guarantee: b >= 0, c >= 0 and b + c <= 1, in doubles: whatever the rounding, the foot is a point of the
///            triangle up to 2 unit roundoffs of its edges, so |p - foot| is never below the distance by more
///            than that. No proof rests on its being the nearest one.
/// Source:    [Ericson05, sec. 5.1.5]; differs: the plane's foot by dual vectors, edges each on their own.
class TriangleFoot {
 public:
  TriangleFoot(const Vector3& a, const Vector3& b, const Vector3& c);
  [[nodiscard]] Barycentric operator()(const Vector3& p) const;
  [[nodiscard]] Vector3 edge_b() const { return edge_b_; }
  [[nodiscard]] Vector3 edge_c() const { return edge_c_; }
  /// p - foot.
  [[nodiscard]] Vector3 rest(const Vector3& p) const;

 private:
  Vector3 a_, edge_b_, edge_c_, edge_bc_;
  Vector3 dual_b_, dual_c_;
  double inverse_b_, inverse_c_, inverse_bc_;  // of squared lengths; 0 for an edge without length
  bool flat_;                                  // no area: the edges are all there is
};

/// The same on one segment, which may be a point.
class SegmentFoot {
 public:
  SegmentFoot(const Vector3& a, const Vector3& b);
  /// p - foot.
  [[nodiscard]] Vector3 rest(const Vector3& p) const;

 private:
  Vector3 a_, edge_;
  double inverse_;  // of the squared length; 0 for a point
};

}  // namespace snug
