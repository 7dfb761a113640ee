#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing {

using Json = nlohmann::json;

/// A scene of so many models and octahedra, placed at random in a cube.
inline Json random_scene(std::size_t parts, double half_side, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  const std::vector<std::string> meshes{model("pawn.obj"), model("star.obj"), model("bracket.obj"),
                                        model("pin.obj")};
  Json scene{{"parts", Json::array()}, {"tolerance", "0.1%"}, {"margin", 0.02}};
  for (std::size_t i = 0; i < parts; ++i) {
    scene["parts"].push_back(
        {{"name", "part " + std::to_string(i)},
         {"mesh", meshes[random() % meshes.size()]},
         {"place",
          {{"move", {half_side * unit(random), half_side * unit(random), half_side * unit(random)}},
           {"rotate", {unit(random), unit(random), 0.1 + std::abs(unit(random)), 180 * unit(random)}}}}});
  }
  return scene;
}

inline std::string write_text(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}
inline std::string write_scene(const std::string& path, const Json& scene) {
  return write_text(path, scene.dump(1));
}

/// A document without what differs from run to run.
inline Json comparable(const std::string& text) {
  Json document = Json::parse(text);
  document.erase("seconds");
  return document;
}

}  // namespace snug::testing
