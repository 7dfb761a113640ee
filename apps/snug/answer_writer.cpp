#include "answer_writer.h"

#include <algorithm>
#include <string>

#include <snug/evaluate.h>

namespace snug::command {

void write_place(JsonWriter& json, const PlacedSurface& surface, const Place& at) {
  const SchemeTraits& traits = surface.surface().traits();
  json.field(traits.owner(), at.owner);
  if (!traits.triangular) json.field("corner", at.corner);
  json.field("u", at.u).field("v", at.v);
  const std::optional<SurfaceNormal> normal = normal_at(surface, at);
  json.key("normal");
  normal ? json.value(normal->direction) : json.null();
  json.key("normal_error");
  normal && normal->error ? json.value(*normal->error) : json.null();
}

void write_field(JsonWriter& json, std::string_view, const Place& at, On on) { write_place(json, on[0], at); }

void write_field(JsonWriter& json, std::string_view name, const std::optional<WitnessPoints>& points, On on) {
  const std::string error = std::string(name) + "_error", places = std::string(name) + "_at";
  if (!points) {
    for (const std::string_view field : {name, std::string_view(error), std::string_view(places)})
      json.key(field).null();
    return;
  }
  const auto& [a, b] = *points;
  json.key(name).begin_array().value(a.point).value(b.point).end_array();
  json.field(error, std::max(a.error, b.error)).key(places).begin_array();
  for (std::size_t s = 0; s < 2; ++s) {
    if (!(*points)[s].at) {
      json.null();
      continue;
    }
    json.begin_object();
    write_place(json, on[s], *(*points)[s].at);
    json.end_object();
  }
  json.end_array();
}

void write_field(JsonWriter& json, std::string_view, const std::array<PatchPlace, 2>& patches, On) {
  json.field("a", patches[0].owner).field("part_a", patches[0].part);
  json.field("b", patches[1].owner).field("part_b", patches[1].part);
}

}  // namespace snug::command
