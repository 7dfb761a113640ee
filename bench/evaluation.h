#pragma once

#include <cstddef>
#include <vector>

#include "runner.h"
#include "subject.h"

namespace snug::bench {

/// Contestants of bench_evaluation(), beside others.
inline constexpr const char *snug_with_errors = "snug: limit points with error bounds",
                            *snug_single = "snug: the same in single precision",
                            *bfr_points = "Bfr: patch points and points, in double";
/// Many points on each of the faces with so many extraordinary corners, printed and returned.
std::vector<Times> bench_evaluation(const ControlMesh& mesh, const Subject& subject, std::size_t corners,
                                    std::size_t per_face, const Options& options);

}  // namespace snug::bench
