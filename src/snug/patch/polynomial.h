#pragma once

#include <optional>
#include <vector>

#include <snug/patch/neighbourhood.h>
#include <snug/scheme/bezier.h>

namespace snug {

/// A patch as one polynomial or two, and what evaluates it.
struct PolynomialForm : BezierRows {
  /// The rows, each times its multinomial coefficient: of w^k u^i v^j from control points. A part after the other, in it
  /// four control points after the other (zeros where there are none), in these four doubles a row.
  std::vector<double> weights;
};

/// The polynomial form of a kind, if every corner is regular: degree 4 for Loop and Doo-Sabin, 6 for the half of a
/// bicubic Catmull-Clark quad, two quadratic parts for Midedge. Smooth boundaries and sharp corners of the regular sort
/// are completed by ghost points, which reproduce them exactly.
///
/// Guarantee: entries of rows are small fractions, each rounded once; those of weights are these, times a whole number
///            and rounded again.
/// Source:    derivations/loop_bezier.md, tensor_bezier.md, midedge_bezier.md; [Stam98] gives the same basis for Loop.
[[nodiscard]] std::optional<PolynomialForm> polynomial_form(const KindKey& key);

}  // namespace snug
