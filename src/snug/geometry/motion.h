#pragma once

#include <snug/geometry.h>
#include <snug/geometry/rounding.h>
#include <support/point.h>

namespace snug {

/// How far R'R may be from the identity, in its largest entry, before a matrix is refused as a motion.
inline constexpr double rigidity_tolerance = 1e-9;

/// Upper bound of the largest entry of |R'R - I| of a row-major 3x4 matrix; infinite beyond doubles.
[[nodiscard]] double rigidity_defect(const std::array<double, 12>& matrix);

/// The first three rows of a row-major 4x4 matrix.
/// Errors:    InputError (pose) unless the last row is exactly 0 0 0 1.
[[nodiscard]] std::array<double, 12> upper_rows(const std::array<double, 16>& matrix);

}  // namespace snug
