// bench_kinds: what a kind costs that was never met: the kind itself, its descendants' matrices, and its
// rows.

#include <array>
#include <cstdio>
#include <string>

#include <snug/bounds/bounds_cache.h>

#include "runner.h"

namespace {

using namespace snug;
using namespace snug::bench;

CornerFan inside(std::size_t valence) { return {0, static_cast<std::uint16_t>(valence - 1), true, false}; }

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 0, "");
  Group group("a new kind, cold library", "kind", options);
  group.set_cold();
  for (const auto& [a, b, c] : std::initializer_list<std::array<std::size_t, 3>>{{6, 6, 6},
                                                                                 {6, 6, 5},
                                                                                 {6, 6, 7},
                                                                                 {6, 6, 8},
                                                                                 {6, 6, 12},
                                                                                 {7, 8, 9},
                                                                                 {12, 12, 12},
                                                                                 {6, 6, 50},
                                                                                 {6, 6, 500}}) {
    if (options.quick && c == 500) continue;
    const KindKey key{Scheme::loop, {inside(a), inside(b), inside(c)}};
    BoundsCache library;
    const BoundingRows rows = make_bounding_rows(library.kinds().find(key));
    const std::string name = "valences " + std::to_string(a) + " " + std::to_string(b) + " " +
                             std::to_string(c) + ", " + std::to_string(rows.count()) + " rows of " +
                             std::to_string(rows.control_count()) + ", " +
                             std::to_string(rows.bytes() / 1024) + " KiB";
    // Rows to the full depth, though a library composes some of those of other kinds.
    group.add(name, 1, [key] {
      KindCache cold;
      return static_cast<double>(make_bounding_rows(cold.find(key)).count());
    });
    if (c > 50) continue;
    group.add("  its table", 1, [key] {
      KindCache cold;
      const Kind& kind = cold.find(key);
      return make_bound_table(kind, make_bounding_rows(kind)).upper.back()[0];
    });
  }
  group.run();
  return 0;
}
