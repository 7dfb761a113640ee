#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <snug/geometry.h>

#include "placements.h"

namespace snug::bench {

/// A part of a generated scene: a model, by its place, and where it stands.
struct PlacedModel {
  std::uint32_t model;
  Motion pose;
};
using ModelScene = std::vector<PlacedModel>;

/// Models of size 1 in random places and turns, `density` of them in a unit cube on average. With 1 most parts meet one or
/// two others, with 4 about ten.
[[nodiscard]] ModelScene packed_scene(std::size_t parts, double density, std::size_t models,
                                      std::uint64_t seed);
/// The last model on a path of many poses through a cell of packed parts: each pose is a part.
[[nodiscard]] ModelScene robot_cell(std::size_t parts, std::size_t models, std::uint64_t seed);

/// A gear with twelve teeth, a link of a hose, and a sheet with folds: models that are made, not read.
enum class MadeModel : std::uint8_t { gear, link, sheet };
/// All three, of Catmull-Clark; gears and links are closed.
[[nodiscard]] std::vector<Model> make_models();

/// Rows of gears that mesh with their neighbours, 100 at ten times of a turn by one tooth, above each other.
/// Models are those of make_models(); so below.
[[nodiscard]] ModelScene gear_train(std::size_t parts);
/// Links one after the other, a hose wound around a torus: inside its hole the windings lie in each other.
[[nodiscard]] ModelScene hose(std::size_t parts);
/// Sheets of cloth side by side in layers with hardly any air between them, each turned and moved a little.
[[nodiscard]] ModelScene sheets(std::size_t parts);

}  // namespace snug::bench
