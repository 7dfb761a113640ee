#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <snug/motion.h>

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
/// Rings in rows, each half a turn from the one before, so near that neighbours nearly mesh: model 0.
[[nodiscard]] ModelScene gear_train(std::size_t parts);
/// The last model on a path of many poses through a cell of packed parts: each pose is a part.
[[nodiscard]] ModelScene robot_cell(std::size_t parts, std::size_t models, std::uint64_t seed);
/// Flat parts in layers with a little air between them, as sheets of cloth lie: model 0.
[[nodiscard]] ModelScene layers(std::size_t parts);

}  // namespace snug::bench
