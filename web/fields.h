// Answers as objects of JavaScript, by <snug/fields.h>.

#pragma once

#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <snug/fields.h>

#include "values.h"

namespace snug::web {

// What the places of an answer lie on: nothing, or A and B.
using On = std::span<const PlacedSurface>;

template <class Answer>
val object_of(const Answer& answer, On on = {});

// max_radius: maxRadius.
inline std::string spelled(const char* name) {
  std::string text;
  for (; *name != 0; ++name) text += *name == '_' ? static_cast<char>(std::toupper(*++name)) : *name;
  return text;
}

// Values.

template <class V, std::size_t N>
val value_of(const std::array<V, N>& values, On on);
template <class V>
val value_of(const std::vector<V>& values, On on);
template <class V>
val value_of(const std::optional<V>& value, On on);
inline val value_of(const Box3& box, On on);

template <class V>
val value_of(const V& value, On on) {
  if constexpr (has_fields<V>) {
    return object_of(value, on);
  } else if constexpr (std::is_enum_v<V>) {
    return word(name_of(value));
  } else if constexpr (std::is_same_v<V, std::uint64_t>) {
    return val(static_cast<double>(value));
  } else {
    return val(value);
  }
}
inline val value_of(const Point3& p, On) { return array_of(p); }
inline val value_of(const Vector3& v, On) { return array_of(v); }
inline val value_of(const Interval& interval, On) { return array_of(interval); }
inline val value_of(const Place& at, On) { return object_of(at); }
inline val value_of(const PatchPlace& at, On) {
  val place = val::object();
  place.set("owner", at.owner);
  place.set("part", at.part);
  return place;
}
// A side: one of two surfaces.
inline val value_of(const std::optional<std::size_t>& side, On) {
  return side ? val(static_cast<unsigned>(*side)) : val::null();
}
template <class V>
val value_of(const std::optional<V>& value, On on) {
  return value ? value_of(*value, on) : val::null();
}
template <class List>
val list_of(const List& values, On on) {
  val list = val::array();
  for (const auto& each : values) list.call<void>("push", value_of(each, on));
  return list;
}
template <class V, std::size_t N>
val value_of(const std::array<V, N>& values, On on) {
  return list_of(values, on);
}
inline val value_of(const Box3& box, On on) { return list_of(std::array{box.lower, box.upper}, on); }
template <class V>
val value_of(const std::vector<V>& values, On on) {
  if constexpr (std::is_same_v<V, Point3> || std::is_same_v<V, Vector3>) {
    return copied(flat_points(values));
  } else if constexpr (std::is_same_v<V, std::array<std::uint32_t, 3>>) {
    return copied(flat(values));
  } else if constexpr (std::is_arithmetic_v<V>) {
    return copied(values);
  } else {
    return list_of(values, on);
  }
}

// Fields that are more than one.

template <class V>
void set_field(val& object, const std::string& name, const V& value, On on) {
  object.set(name, value_of(value, on));
}
// Also NAMEError, and NAMEAt: places with normals; one is null if its witness is a point of the other surface alone.
inline void set_field(val& object, const std::string& name, const std::optional<WitnessPoints>& points,
                      On on) {
  val witness = val::array(), places = val::array();
  for (std::size_t s = 0; points && s < 2; ++s) {
    witness.set(s, array_of((*points)[s].point));
    const std::optional<Place>& at = (*points)[s].at;
    val place = value_of(at, on);
    if (at) {
      const std::optional<SurfaceNormal> normal = normal_at(on[s], *at);
      place.set("normal", normal ? array_of(normal->direction) : val::null());
      place.set("normalError", normal ? value_of(normal->error, on) : val::null());
    }
    places.set(s, place);
  }
  object.set(name, points ? witness : val::null());
  object.set(name + "Error", points ? val(std::max((*points)[0].error, (*points)[1].error)) : val::null());
  object.set(name + "At", points ? places : val::null());
}
inline void set_field(val& object, const std::string& name, const WitnessPoints& points, On on) {
  set_field(object, name, std::optional(points), on);
}

template <class Answer>
val object_of(const Answer& answer, On on) {
  val object = val::object();
  for_each_field<Answer>(
      [&](const auto& field) { set_field(object, spelled(field.name), std::invoke(field.of, answer), on); });
  return object;
}

}  // namespace snug::web
