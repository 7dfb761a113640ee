#pragma once

#include <oracle/twin_mesh.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

/// Meshes in forms that are hard for arithmetic: scales to the ends of the doubles, offsets that leave few digits,
/// flat and needle shapes, points that coincide.
namespace snug::testing {

struct Disguise {
  std::string name;
  std::function<oracle::Point(oracle::Point)> change;
};

/// All of them, for meshes of about size 1 near the origin; the first one changes nothing.
[[nodiscard]] inline std::vector<Disguise> disguises() {
  using oracle::Point;
  std::vector<Disguise> list{{"plain", [](Point p) { return p; }}};
  const auto add_scaled = [&](const char* name, double s) {
    list.push_back({name, [s](Point p) { return Point{s * p[0], s * p[1], s * p[2]}; }});
  };
  add_scaled("tiny", 1e-300);
  add_scaled("squares underflow", 1e-155);
  add_scaled("fourth powers underflow", 1e-77);
  add_scaled("fourth powers overflow", 1e77);
  add_scaled("squares overflow", 1e155);
  add_scaled("huge", 1e300);
  const auto add_moved = [&](const char* name, double d) {
    list.push_back({name, [d](Point p) { return Point{p[0] + d, p[1] - d / 3, p[2] + 0.1 * d}; }});
  };
  add_moved("off", 1e3);
  add_moved("far", 1e8);
  add_moved("very far", 3e14);
  list.push_back({"tiny and far", [](Point p) {
                    return Point{1e-200 * (p[0] + 1e6), 1e-200 * p[1], 1e-200 * (p[2] - 2e6)};
                  }});
  list.push_back({"flat", [](Point p) { return Point{p[0], p[1], 0.0}; }});
  list.push_back({"nearly flat", [](Point p) { return Point{p[0], p[1], 1e-12 * p[2]}; }});
  list.push_back({"flat and tilted", [](Point p) { return Point{p[0], p[1], (p[0] + p[1]) / 3}; }});
  list.push_back({"needle", [](Point p) { return Point{p[0], 1e-7 * p[1], 1e-9 * p[2]}; }});
  list.push_back({"line", [](Point p) { return Point{p[0], 0.3 * p[0], -p[0]}; }});
  list.push_back({"snapped to a coarse grid", [](Point p) {
                    return Point{std::round(2 * p[0]), std::round(2 * p[1]), std::round(2 * p[2])};
                  }});
  list.push_back({"a single point", [](Point) { return Point{0.1, 0.2, 0.3}; }});
  list.push_back({"spiked", [](Point p) {
                    return Point{p[0], p[1], p[0] * p[1] > 0.2 ? 1e6 * p[2] : p[2]};
                  }});
  list.push_back({"huge and spiked", [](Point p) {
                    return Point{1e150 * p[0], 1e150 * p[1], 1e156 * p[2] * (p[0] > 0.3 ? 1 : 0)};
                  }});
  return list;
}

/// Those of these names.
[[nodiscard]] inline std::vector<Disguise> disguises(const std::vector<std::string>& names) {
  std::vector<Disguise> list;
  for (const std::string& name : names) {
    for (const Disguise& disguise : disguises()) {
      if (disguise.name == name) list.push_back(disguise);
    }
    if (list.empty() || list.back().name != name) throw std::invalid_argument("no disguise " + name);
  }
  return list;
}

}  // namespace snug::testing
