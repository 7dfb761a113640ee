#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include <snug/geometry/point.h>
#include <snug/mesh.h>

namespace snug {

/// Points rounded to the nearest floats, for formats that hold no doubles.
///
/// Notes:     one line that says that coordinates were rounded, if any were.
/// Errors:    InputError (refused) naming the vertex if a coordinate is too large for a float. InputError (value) on
///            one that is not finite.
[[nodiscard]] std::vector<std::array<float, 3>> in_single_precision(std::span<const Point3> points,
                                                                    const std::string& name,
                                                                    const Notes& notes);

}  // namespace snug
