#pragma once

#include <array>
#include <span>

#include <snug/bounds/bounds_cache.h>
#include <snug/bounds/quadratic.h>
#include <snug/patch/patch.h>

namespace snug {

/// All that a leaf keeps of a patch: an offset triangle, a quadratic with its errors, and how far the patch reaches along three
/// axes, those of its base triangle.
struct PieceFit {
  OffsetTriangle offset;  ///< a negative radius: no answer, ask offset_triangle() and quadratic_triangle()
  QuadraticTriangle quadratic;
  std::array<Vector3, 3> axes;  ///< orthonormal up to a few roundings
  /// Bounds of dot(axes[k], x) over the patch.
  std::array<double, 3> lower, upper;
};

/// Fits many patches at once. Each is split, and its parts, which are of few kinds whatever the patches are, are bounded in
/// vectors, those of a kind together. Parts at extraordinary corners are refined as long as their error exceeds that of the rest.
///
/// Guarantee: offsets as offset_triangle(), quadratics as quadratic_triangle(). A patch's answer does not depend on the others.
///            No answer for planes, needles, what is not finite, and patches with a part beside a semi-sharp crease, or at a
///            corner whose kind has no layout.
/// Requires:  out.size() == patches.size().
/// Cost:      3 to 5 microseconds a patch where many parts are of the same kinds; 4 KB of scratch a patch and thread.
/// Source:    derivations/quadratics.md, "Many patches at once".
void fit_pieces(BoundsCache& library, std::span<const Patch> patches, std::span<PieceFit> out);

/// The same sooner for patches of which those of one kind follow each other and are many: these are bounded as they are, without a
/// split, in single precision where its roundings are a small part of the bounds.
/// Cost:      1 to 2 microseconds a patch where vectors of 16 patches are full, and 0.1 ms a kind at first.
/// Source:    derivations/quadratics.md, "Many patches of one kind".
void fit_sorted_pieces(BoundsCache& library, std::span<const Patch> patches, std::span<PieceFit> out);

}  // namespace snug
