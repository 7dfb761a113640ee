#pragma once

#include <array>
#include <string>
#include <vector>

#include <snug/collide.h>

#include "json_writer.h"

namespace snug::command {

/// The fields face (dual: vertex), part or corner of its split, u, v, normal and normal_error of a place,
/// into the object that is open.
void write_place(JsonWriter& json, const PlacedSurface& surface, const SurfaceParameter& at);

/// Two surfaces where they are placed.
using Sides = std::array<PlacedSurface, 2>;

/// Witnesses and where they lie: "witness_at": two objects, null for a witness that is a point of the other
/// surface alone, or null without witnesses.
void write_places(JsonWriter& json, const Sides& sides, const WitnessPlaces* places);

/// The field stats: what the query did.
void write_stats(JsonWriter& json, const SearchStats& stats);

/// Columns of witnesses, for people: a header line, and one for each surface.
[[nodiscard]] std::vector<std::string> witness_lines(const Sides& sides, const std::array<Point3, 2>& witness,
                                                     const WitnessPlaces& places);

}  // namespace snug::command
