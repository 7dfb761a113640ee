#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include <snug/geometry.h>
#include <snug/geometry/bernstein.h>

namespace snug {

/// A part of a polynomial surface by x_u cross x_v, whose length is integrated to its area.
///
/// Source:    derivations/measures.md, "Area".
class AreaPiece {
 public:
  /// All polynomials are raised to this degree, on a square in u and in v.
  template <Domain domain>
  static constexpr std::size_t degree = domain == Domain::triangle ? 6 : 5;
  template <Domain domain>
  using Polynomial = Bernstein<domain, degree<domain>>;
  static constexpr std::size_t max_count = Polynomial<Domain::square>::count;
  /// Bezier coefficients, by axis.
  using Coefficients = std::array<std::array<double, max_count>, 3>;

  /// `error`: upper bound, a coordinate, of |coefficient - exact one|.
  AreaPiece(Domain domain, const Coefficients& normal, double error);

  /// Contains the area.
  [[nodiscard]] const Interval& area() const { return area_; }
  [[nodiscard]] double gap() const { return area_.upper - area_.lower; }
  /// Can tighten() or split() still reduce the gap, or is it all rounding?
  [[nodiscard]] bool can_improve() const;
  /// Has tighten() been called?
  [[nodiscard]] bool tight() const { return tight_; }
  /// Bounds of higher order: the length against a polynomial. Cost: 3 microseconds.
  void tighten();
  /// Two halves, across the direction in which the normal changes most.
  [[nodiscard]] std::pair<AreaPiece, AreaPiece> split() const;

 private:
  AreaPiece() = default;
  void bound();
  template <Domain domain>
  void tighten_on();
  template <Domain domain>
  [[nodiscard]] std::pair<AreaPiece, AreaPiece> split_on() const;

  Domain domain_ = Domain::triangle;
  bool tight_ = false;
  unsigned level_ = 0;
  double share_ = 0;  // of the parameters: area is this times a mean
  double error_ = 0;
  double largest_ = 0;  // |coefficient|, a coordinate
  Interval area_;
  Coefficients normal_;
};

}  // namespace snug
