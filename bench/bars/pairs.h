#pragma once

#include <string>
#include <vector>

#include "placements.h"

namespace snug::bench {

struct ModelPair {
  Model a, b;
  [[nodiscard]] std::string name() const { return a.name + " and " + b.name; }
};

/// Where venus, cow, mannequin, knight and horse are given, which goals are set on: those in four pairs, and bust and figure.
/// Else the first seven files, those of examples/models: five pairs of them. Of the others those that suit, at
/// most ten, evenly by their size, in pairs of a smaller and a larger one: closed surfaces of 200 to 10,000
/// triangles whose uniform mesh of 1 % has at most 200,000.
/// Errors:    as read_mesh for the first seven; others that cannot be read do not suit.
[[nodiscard]] std::vector<ModelPair> choose_pairs(const std::vector<std::string>& files);

/// Every model of the pairs once.
[[nodiscard]] std::vector<const Model*> models_of(const std::vector<ModelPair>& pairs);

}  // namespace snug::bench
