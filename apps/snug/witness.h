#pragma once

#include <array>
#include <string>
#include <vector>

#include <snug/collide.h>

#include "json_writer.h"

namespace snug::command {

/// The fields face (dual: vertex), part or corner of its split, u, v, normal and normal_error of a place,
/// into the object that is open.
void write_place(JsonWriter& json, const PlacedSurface& surface, const Place& at);

/// Two surfaces where they are placed.
using Sides = std::array<PlacedSurface, 2>;

/// The fields witness, witness_error and witness_at: two points, and two objects, of which one is null if its witness is a
/// point of the other surface alone. All are null without witnesses.
void write_witness(JsonWriter& json, const Sides& sides, const WitnessPoints* witness);

/// The field stats: what the query did.
void write_stats(JsonWriter& json, const SearchStats& stats);

/// Columns of witnesses, for people: a header line, and one for each surface.
[[nodiscard]] std::vector<std::string> witness_lines(const Sides& sides, const WitnessPoints& witness);

}  // namespace snug::command
