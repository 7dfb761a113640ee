#include "kinds.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace tablegen {
namespace {

using snug::CornerFan;

CornerFan inside(std::uint16_t n) { return {0, static_cast<std::uint16_t>(n - 1), true, false}; }
CornerFan at_boundary(std::size_t before, std::size_t after) {
  return {static_cast<std::uint16_t>(before), static_cast<std::uint16_t>(after), false, false};
}

// Keys are turned so that they are the least of the three they could be.
snug::KindKey min_turn(const std::array<CornerFan, 3>& fans) {
  std::array<CornerFan, 3> best = fans;
  for (std::size_t first = 1; first < 3; ++first) {
    best =
        std::min(best, std::array<CornerFan, 3>{fans[first], fans[(first + 1) % 3], fans[(first + 2) % 3]});
  }
  return {snug::Scheme::loop, {best[0], best[1], best[2]}};
}

// The next corner and the last one around `fan`, regular, at the boundary where an edge they share with it
// is.
snug::KindKey with_regular_others(const CornerFan& fan) {
  const bool first_edge = !fan.closed && fan.before == 0, last_edge = !fan.closed && fan.after == 0;
  return min_turn(
      {fan, first_edge ? at_boundary(2, 0) : inside(6), last_edge ? at_boundary(0, 2) : inside(6)});
}

std::vector<snug::KindKey> loop_kinds() {
  std::vector<snug::KindKey> keys;
  const CornerFan touching = at_boundary(1, 1);  // regular, with no boundary edge on the patch
  keys.push_back(with_regular_others(inside(6)));
  keys.push_back(min_turn({touching, inside(6), inside(6)}));
  keys.push_back(min_turn({touching, touching, inside(6)}));
  keys.push_back(min_turn({touching, touching, touching}));
  keys.push_back(min_turn({at_boundary(0, 2), at_boundary(2, 0), inside(6)}));
  keys.push_back(min_turn({at_boundary(0, 2), at_boundary(2, 0), touching}));
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

// Half quads: regular inside, and with one corner of each of these sizes in each place.
void add_inside(snug::Scheme scheme, std::initializer_list<std::uint16_t> sizes,
                std::vector<snug::KindKey>& keys) {
  const snug::KindKey regular{scheme, {inside(4), inside(4), inside(4), inside(4)}};
  keys.push_back(regular);
  for (const std::uint16_t n : sizes) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      keys.push_back(regular);
      keys.back().corners[corner] = inside(n);
    }
  }
}

// Catmull-Clark's half quads with a boundary, or an infinitely sharp crease: along one edge, or two that meet
// in a lone sharp corner.
void add_at_boundary(std::vector<snug::KindKey>& keys) {
  for (const bool lone : {false, true}) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      snug::KindKey key{snug::Scheme::catmark, {inside(4), inside(4), inside(4), inside(4)}};
      key.corners[corner] = lone ? CornerFan{0, 0, false, true} : at_boundary(0, 1);
      key.corners[(corner + 1) % 4] = at_boundary(1, 0);
      if (lone) key.corners[(corner + 3) % 4] = at_boundary(0, 1);
      keys.push_back(key);
    }
  }
}

}  // namespace

std::vector<snug::KindKey> common_kinds() {
  std::vector<snug::KindKey> keys = loop_kinds();
  add_inside(snug::Scheme::catmark, {3, 5, 6}, keys);
  add_at_boundary(keys);
  add_inside(snug::Scheme::doo_sabin, {3, 5, 6}, keys);
  add_inside(snug::Scheme::midedge, {3, 5, 6}, keys);
  return keys;
}

}  // namespace tablegen
