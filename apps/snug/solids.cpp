#include "solids.h"

#include <fmt/core.h>
#include <snug/collide.h>

namespace snug::command {

std::string inner_sentence(std::size_t inner) {
  return inner == 0 ? "A or a part of it lies inside B" : "B or a part of it lies inside A";
}

void note_nesting(const CommonOptions& options, const PlacedSurface& a, const PlacedSurface& b,
                  const WorkMonitor& monitor) {
  const Notes notes = notes_for(options);
  if (!notes || a.surface().open_reason() || b.surface().open_reason()) return;
  const Collision found = collide(a, b, {.witness = WitnessKind::none, .prove_contact = true, .solid = true},
                                  {.monitor = &monitor});
  if (found.contained) {
    notes(inner_sentence(*found.contained).append(", but the surfaces do not meet; --solid compares solids"));
  }
}

std::string penetration_sentence(const Penetration& found) {
  if (found.depth.upper == 0) return "the solids are separated where they are";
  return fmt::format(
      "proved: the penetration depth is at least {}; moving B by ({:.6g} {:.6g} {:.6g}), {} long, separates "
      "the solids",
      text_at_most(found.depth.lower), found.translation.x, found.translation.y, found.translation.z,
      text_at_most(found.depth.upper, true));
}

}  // namespace snug::command
