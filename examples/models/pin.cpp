#include "models.h"

namespace models {
namespace {

// A length in units of 1/2000, as a decimal number.
std::string decimal(int units) {
  const int size = units < 0 ? -units : units;
  std::string digits = std::to_string(size % 2000 * 5);
  digits.insert(0, 4 - digits.size(), '0');
  return (units < 0 ? "-" : "") + std::to_string(size / 2000) + "." + digits;
}

struct Ring {
  int height, radius;
};

}  // namespace

// A pin that stands on its tip: rings of eight around the y axis, tenths of their radius exact, so that all faces are flat.
std::string pin_text() {
  constexpr std::array<Ring, 7> rings{
      {{0, 60}, {100, 70}, {1100, 160}, {1200, 400}, {1500, 480}, {1900, 480}, {2000, 400}}};
  constexpr std::array<std::array<int, 2>, 8> octagon{
      {{10, 0}, {7, 7}, {0, 10}, {-7, 7}, {-10, 0}, {-7, -7}, {0, -10}, {7, -7}}};
  std::string text = "# Pin\n# Control mesh of quads, written by generate_models.\n";
  const auto vertex = [&](int x, int y, int z) {
    text += "v " + decimal(x) + " " + decimal(y) + " " + decimal(z) + "\n";
  };
  vertex(0, rings.front().height, 0);
  for (const auto& [height, radius] : rings) {
    for (const auto& [x, z] : octagon) vertex(x * radius / 10, height, z * radius / 10);
  }
  vertex(0, rings.back().height, 0);

  const std::size_t foot = 1, head = 2 + 8 * rings.size();  // numbers in the file
  const auto at = [](std::size_t ring, std::size_t k) { return 2 + 8 * ring + k % 8; };
  const auto add = [&](const std::array<std::size_t, 4>& face) {
    text += "f";
    for (const std::size_t v : face) text += " " + std::to_string(v);
    text += "\n";
  };
  for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring) {
    for (std::size_t k = 0; k < 8; ++k) {
      add({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)});
    }
  }
  const std::size_t last = rings.size() - 1;
  for (std::size_t k = 0; k < 8; k += 2) {
    add({foot, at(0, k), at(0, k + 1), at(0, k + 2)});
    add({head, at(last, k + 2), at(last, k + 1), at(last, k)});
  }
  return text;
}

}  // namespace models
