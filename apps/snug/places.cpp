#include "places.h"

#include <algorithm>

#include <snug/surface/evaluate.h>

#include "words.h"

namespace snug::command {

std::string place_words(const SchemeRules& rules) {
  return std::string(rules.owner()) + (rules.triangular() ? " u v" : " u v [corner]");
}

SurfaceParameter read_place(std::string_view line, const LimitSurface& surface, const std::string& where,
                            const std::string& expected) {
  const SchemeRules& rules = surface.rules();
  const std::string owner = rules.owner();
  const auto unreadable = [&](const std::string& why) {
    return InputError(InputProblem::unreadable, where + why);
  };
  SurfaceParameter at{};
  bool good =
      parse(next_word(line), at.owner) && parse(next_word(line), at.u) && parse(next_word(line), at.v);
  if (const std::string_view corner = next_word(line); good && !corner.empty()) {
    good = !rules.triangular() && parse(corner, at.corner) && next_word(line).empty();
  }
  if (!good) throw unreadable("a line is '" + expected + "'");
  if (at.owner >= surface.owner_count()) {
    throw unreadable(owner + " " + std::to_string(at.owner) + " of " + std::to_string(surface.owner_count()) +
                     " (they count from 0)");
  }
  if (rules.triangular() ? !(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1)
                         : !(at.u >= 0 && at.v >= 0 && at.u <= 1 && at.v <= 1)) {
    throw unreadable(rules.triangular() ? "u and v must be >= 0, and u + v <= 1"
                                        : "u and v must be from 0 to 1");
  }
  const LimitSurface::PatchRange range = surface.patches_of(at.owner);
  const std::size_t corners = std::max<std::size_t>(1, (range.end - range.begin) / 2);
  if (at.corner >= corners) {
    throw unreadable("corner " + std::to_string(at.corner) + " of " + owner + " " + std::to_string(at.owner) +
                     ", which counts from 0 to " + std::to_string(corners - 1));
  }
  if (!patch_at(surface, at)) {
    throw InputError(InputProblem::refused,
                     where + owner + " " + std::to_string(at.owner) +
                         " has no limit surface: it lies at the boundary, or is a hole");
  }
  return at;
}

}  // namespace snug::command
