#pragma once

#include <string>
#include <string_view>

#include <snug/scene.h>

namespace snug::command {

/// The answer for one pair of a scene, as it is written, kept and sent.
struct SceneAnswer {
  Verdict verdict =
      Verdict::undecided;  ///< of distances: separated beyond the limit, within it, or intersecting
  bool reached = true;
  std::string row;  ///< for people, without names; no tabs
  std::string
      json;  ///< an object on one line; empty for a pair that is not listed, or where no document is wanted
};

/// A line that holds a pair and its answer, with a line feed and a checksum.
[[nodiscard]] std::string line_of(const PartPair& parts, const SceneAnswer& answer);

/// Reads such a line, without its line feed; false for another text, such as a torn line.
[[nodiscard]] bool parse_line(std::string_view line, PartPair& parts, SceneAnswer& answer);

}  // namespace snug::command
