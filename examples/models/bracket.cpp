#include "models.h"

namespace models {

// Three unit cubes in the shape of an L: 16 vertices, 14 quads; 2 vertices of valence 5 and 10 of valence 3.
std::string bracket_text() {
  //  6 -- 7            8 more in front
  //  |    |
  //  3 -- 4 -- 5
  //  |    |    |
  //  0 -- 1 -- 2
  constexpr std::array<std::array<int, 2>, 8> places{
      {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}, {0, 2}, {1, 2}}};
  constexpr std::array<Quad, 3> squares{{{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}}};
  constexpr std::array<Index, 8> around{0, 1, 2, 5, 4, 7, 6, 3};
  std::string text = "# Bracket\n# Control mesh of quads, written by generate_models.\n";
  for (const char* z : {"0", "1"}) {
    for (const auto& [x, y] : places)
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + z + "\n";
  }
  const auto add = [&](const Quad& face) {
    text += "f";
    for (const Index v : face) text += " " + std::to_string(v + 1);
    text += "\n";
  };
  for (const Quad& s : squares) add({s[0] + 8, s[1] + 8, s[2] + 8, s[3] + 8});
  for (const Quad& s : squares) add({s[3], s[2], s[1], s[0]});
  for (std::size_t k = 0; k < 8; ++k) {
    const Index a = around[k], b = around[(k + 1) % 8];
    add({a, b, b + 8, a + 8});
  }
  return text;
}

}  // namespace models
