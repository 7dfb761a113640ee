#pragma once

#include <vector>

#include "pairs.h"
#include "table.h"

/// The bars, subject by subject: each measures, prints what it measured, and adds its rows.
namespace snug::bench {

/// Collisions with a margin of 1 % of the size; distances to 0.1 %.
inline constexpr double collide_tolerance = 0.01, distance_precision = 0.001;

/// collide() and distance() of models with tight trees beside FCL.
void query_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table);
/// Costs of a control mesh of some 363,000 faces.
void size_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table);
/// Memory after many queries, and what a tight tree takes to build.
void model_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table);
/// Closest points beside Embree.
void closest_bars(const std::vector<ModelPair>& pairs, const Options& options, BarTable& table);
/// Bounds of many patches, and points on them.
void patch_bars(const Options& options, BarTable& table);
void evaluation_bars(const Options& options, BarTable& table);

}  // namespace snug::bench
