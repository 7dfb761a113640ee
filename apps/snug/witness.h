#pragma once

#include <array>
#include <string>
#include <vector>

#include <snug/collide.h>

namespace snug::command {

/// Two surfaces where they are placed.
using Sides = std::array<PlacedSurface, 2>;

/// Columns of witnesses, for people: a header line, and one for each surface.
[[nodiscard]] std::vector<std::string> witness_lines(const Sides& sides, const WitnessPoints& witness);

}  // namespace snug::command
