#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <snug/patch/kind_cache.h>
#include <snug/patch/net_kernels.h>

namespace snug {

/// Bounds of the area of a small piece, and the integral of x_u cross x_v.
struct PieceArea {
  double lower, upper;
  Vector3 flux;
  double flux_error;  ///< upper bound of |flux - exact|
};

/// Quadratic forms by which the control points of a piece at an extraordinary corner tell its area: means of products of
/// derivatives, all that is split off later included.
/// Source:    derivations/measures.md, "What is left at a corner".
class CornerForms {
 public:
  /// `extent_sq` at least the square of the diagonal of the box around the points, `middle` in its middle up to rounding;
  /// `error` at least, a coordinate, |point - exact| and what the middle is off by.
  /// Guarantee: both bounds, and flux_error, rounding included. Cost: about 0.2 microseconds.
  [[nodiscard]] PieceArea area_of(std::span<const kernels::NetPoint> points, const Point3& middle,
                                  double extent_sq, double error) const;

 private:
  friend std::optional<CornerForms> make_corner_forms(const Kind& kind, double area_factor);
  // Of points i >= j, row by row: of their dot product in the means of x_u x_u, x_u x_v, x_v x_v; of p_j cross p_i in that
  // of x_u cross x_v.
  std::vector<std::array<double, 4>> pairs_;
  // At least the sum of the sizes of all entries of one form, and of their errors with what is never split off.
  double size_ = 0, rest_ = 0;
};

/// None unless a kind comes again after one step and splits off regular pieces only, with points enough in common.
/// `area_factor` that of the kind, CornerAsymptotics.
/// Cost:      six products of matrices of the kind's control points.
[[nodiscard]] std::optional<CornerForms> make_corner_forms(const Kind& kind, double area_factor);

}  // namespace snug
