#pragma once

#include <array>
#include <string_view>
#include <vector>

namespace snug {

/// A stroke of a letter: from the first place to the second, in heights of a capital from the left end of the line
/// of text, y upwards from the foot of the letters.
struct LetterStroke {
  std::array<double, 2> from, to;
};

/// A line of text as strokes: capitals, digits and common signs; letters come as capitals, other signs as a box.
[[nodiscard]] std::vector<LetterStroke> lettering(std::string_view text);
/// How wide that is, in heights of a capital.
[[nodiscard]] double lettering_width(std::string_view text);

}  // namespace snug
