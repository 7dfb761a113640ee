#include "kinds.h"

#include <algorithm>
#include <array>

namespace tablegen {
namespace {

using snug::CornerFan;

CornerFan inside(std::uint16_t n) { return {0, static_cast<std::uint16_t>(n - 1), true, false}; }
CornerFan at_boundary(std::size_t before, std::size_t after) {
  return {static_cast<std::uint16_t>(before), static_cast<std::uint16_t>(after), false, false};
}

// Keys are turned so that they are the least of the three they could be.
snug::KindKey least_turn(const std::array<CornerFan, 3>& fans) {
  std::array<CornerFan, 3> best = fans;
  for (std::size_t first = 1; first < 3; ++first) {
    best =
        std::min(best, std::array<CornerFan, 3>{fans[first], fans[(first + 1) % 3], fans[(first + 2) % 3]});
  }
  return {snug::Scheme::loop, {best[0], best[1], best[2]}};
}

// The next corner and the last one around `fan`, regular, at the boundary where an edge they share with it is.
snug::KindKey with_regular_others(const CornerFan& fan) {
  const bool first_edge = !fan.closed && fan.before == 0, last_edge = !fan.closed && fan.after == 0;
  return least_turn(
      {fan, first_edge ? at_boundary(2, 0) : inside(6), last_edge ? at_boundary(0, 2) : inside(6)});
}

}  // namespace

std::vector<snug::KindKey> shipped_kinds() {
  std::vector<snug::KindKey> keys;
  const CornerFan touching = at_boundary(1, 1);  // regular, with no boundary edge on the patch
  keys.push_back(with_regular_others(inside(6)));
  keys.push_back(least_turn({touching, inside(6), inside(6)}));
  keys.push_back(least_turn({touching, touching, inside(6)}));
  keys.push_back(least_turn({touching, touching, touching}));
  keys.push_back(least_turn({at_boundary(0, 2), at_boundary(2, 0), inside(6)}));
  keys.push_back(least_turn({at_boundary(0, 2), at_boundary(2, 0), touching}));
  for (std::uint16_t n = 3; n <= 12; ++n) {
    if (n != 6) keys.push_back(with_regular_others(inside(n)));
  }
  for (const std::size_t faces : {1u, 2u, 4u, 5u, 6u}) {
    for (std::size_t before = 0; before < faces; ++before)
      keys.push_back(with_regular_others(at_boundary(before, faces - 1 - before)));
  }
  keys.push_back(with_regular_others({0, 0, false, true}));
  return keys;
}

}  // namespace tablegen
