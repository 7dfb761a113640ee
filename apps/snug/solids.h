#pragma once

#include <cstddef>
#include <string>

#include <snug/collide.h>

#include "placed_pair.h"

namespace snug::command {

/// "B or a part of it lies inside A".
[[nodiscard]] std::string inner_sentence(std::size_t inner);

/// Two surfaces that do not meet, closed both, one inside the other: a note that they do as solids.
void note_nesting(const CommonOptions& options, const PlacedSurface& a, const PlacedSurface& b,
                  const WorkMonitor& monitor);

[[nodiscard]] std::string penetration_sentence(const Penetration& found);

}  // namespace snug::command
