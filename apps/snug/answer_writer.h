#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <snug/fields.h>

#include "json_writer.h"

namespace snug::command {

/// The surfaces that places of an answer lie on: none, one, or A and B.
using On = std::span<const PlacedSurface>;

/// Fields of an answer, named and in the order of <snug/fields.h>, into the object that is open; but for one of this name.
template <class Answer>
void write_fields(JsonWriter& json, const Answer& answer, On on = {}, std::string_view without = {});

/// The fields face (dual: vertex), corner of its split, u, v, normal and normal_error of a place, into the object that is open.
void write_place(JsonWriter& json, const PlacedSurface& surface, const Place& at);

// Values: intervals and boxes are pairs, and what is infinite or not there is null.

template <class V>
void write_value(JsonWriter& json, const V& value, On on) {
  if constexpr (has_fields<V>) {
    json.begin_object();
    write_fields(json, value, on);
    json.end_object();
  } else if constexpr (std::is_enum_v<V>) {
    json.value(name_of(value));
  } else {
    json.value(value);
  }
}
inline void write_value(JsonWriter& json, const Interval& interval, On) {
  json.begin_array().value(interval.lower);
  interval.upper == INFINITY ? json.null() : json.value(interval.upper);
  json.end_array();
}
inline void write_value(JsonWriter& json, const Box3& box, On) {
  json.begin_array().value(box.lower).value(box.upper).end_array();
}
/// A side: one of two surfaces.
inline void write_value(JsonWriter& json, const std::optional<std::size_t>& side, On) {
  side ? json.value(*side == 0 ? "a" : "b") : json.null();
}
template <class V>
void write_value(JsonWriter& json, const std::optional<V>& value, On on) {
  value ? write_value(json, *value, on) : static_cast<void>(json.null());
}
template <class List>
void write_list(JsonWriter& json, const List& list, On on) {
  json.begin_array();
  for (const auto& each : list) write_value(json, each, on);
  json.end_array();
}
template <class V>
void write_value(JsonWriter& json, const std::vector<V>& list, On on) {
  write_list(json, list, on);
}
template <class V, std::size_t N>
void write_value(JsonWriter& json, const std::array<V, N>& list, On on) {
  write_list(json, list, on);
}

/// Its normal stands with its place.
inline void write_value(JsonWriter& json, const RayHit& hit, On on) {
  json.begin_object();
  write_fields(json, hit, on, "normal");
  json.end_object();
}

// Fields that are more than one.

template <class V>
void write_field(JsonWriter& json, std::string_view name, const V& value, On on) {
  json.key(name);
  write_value(json, value, on);
}
/// The fields of write_place().
void write_field(JsonWriter& json, std::string_view name, const Place& at, On on);
/// Also NAME_error, and NAME_at: objects, of which one is null if its witness is a point of the other surface alone.
void write_field(JsonWriter& json, std::string_view name, const std::optional<WitnessPoints>& points, On on);
inline void write_field(JsonWriter& json, std::string_view name, const WitnessPoints& points, On on) {
  write_field(json, name, std::optional(points), on);
}
/// a, part_a, b, part_b.
void write_field(JsonWriter& json, std::string_view name, const std::array<PatchPlace, 2>& patches, On on);

template <class Answer>
void write_fields(JsonWriter& json, const Answer& answer, On on, std::string_view without) {
  for_each_field<Answer>([&](const auto& field) {
    if (field.name != without) write_field(json, field.name, std::invoke(field.of, answer), on);
  });
}

}  // namespace snug::command
