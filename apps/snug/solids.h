#pragma once

#include <cstddef>
#include <optional>

#include <snug/collide.h>

#include "placed_pair.h"

namespace snug::command {

/// "contained": "a" or "b", the part that lies in the other one, or null.
void write_inner(JsonWriter& json, const std::optional<std::size_t>& inner);

/// "B or a part of it lies inside A".
[[nodiscard]] std::string inner_sentence(std::size_t inner);

/// Two surfaces that do not meet, closed both, one inside the other: a note that they do as solids.
void note_nesting(const CommonOptions& options, const PlacedSurface& a, const PlacedSurface& b,
                  const WorkMonitor& monitor);

/// "penetration": {depth, translation, outcome}, and as a sentence.
void write_penetration(JsonWriter& json, const Penetration& found);
[[nodiscard]] std::string penetration_sentence(const Penetration& found);

}  // namespace snug::command
