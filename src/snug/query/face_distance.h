#pragma once

#include <optional>

#include <snug/surface/limit_surface.h>

namespace snug {

/// limit_to_faces() of evaluate.h.
[[nodiscard]] std::optional<double> limit_to_faces(const LimitSurface& surface, int threads = 0);

}  // namespace snug
