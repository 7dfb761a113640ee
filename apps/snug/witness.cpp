#include "witness.h"

#include <fmt/core.h>

namespace snug::command {

std::vector<std::string> witness_lines(const Sides& sides, const WitnessPoints& witness) {
  const auto line = [](const std::string& on, const std::string& x, const std::string& y,
                       const std::string& z, const std::string& place) {
    return fmt::format("  {:<2}  {:>12}  {:>12}  {:>12}  {}", on, x, y, z, place);
  };
  const auto number = [](double x) { return fmt::format("{:.8g}", x); };
  std::vector<std::string> lines{line("on", "x", "y", "z", "place")};
  for (std::size_t s = 0; s < 2; ++s) {
    if (!witness[s].at) continue;
    const Place& at = *witness[s].at;
    const Point3& p = witness[s].point;
    const SchemeTraits& traits = sides[s].surface().traits();
    const std::string place =
        fmt::format("{} {}{} u {:.6g} v {:.6g}", traits.owner(), at.owner,
                    traits.triangular ? "" : fmt::format(" corner {}", at.corner), at.u, at.v);
    lines.push_back(line(s == 0 ? "A" : "B", number(p.x), number(p.y), number(p.z), place));
  }
  return lines;
}

}  // namespace snug::command
