#include "witness.h"

#include <fmt/core.h>
#include <snug/evaluate.h>

namespace snug::command {

void write_place(JsonWriter& json, const PlacedSurface& surface, const SurfaceParameter& at) {
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

void write_stats(JsonWriter& json, const SearchStats& stats) {
  json.key("stats").begin_object();
  json.field("box_tests", stats.box_tests).field("triangle_tests", stats.triangle_tests);
  json.field("evaluations", stats.evaluations).field("splits", stats.splits).end_object();
}

void write_places(JsonWriter& json, const Sides& sides, const WitnessPlaces* places) {
  json.key("witness_at");
  if (places == nullptr) {
    json.null();
    return;
  }
  json.begin_array();
  for (std::size_t s = 0; s < 2; ++s) {
    if (!(*places)[s]) {
      json.null();
      continue;
    }
    json.begin_object();
    write_place(json, sides[s], *(*places)[s]);
    json.end_object();
  }
  json.end_array();
}

std::vector<std::string> witness_lines(const Sides& sides, const std::array<Point3, 2>& witness,
                                       const WitnessPlaces& places) {
  const auto line = [](const std::string& on, const std::string& x, const std::string& y,
                       const std::string& z, const std::string& place) {
    return fmt::format("  {:<2}  {:>12}  {:>12}  {:>12}  {}", on, x, y, z, place);
  };
  const auto number = [](double x) { return fmt::format("{:.8g}", x); };
  std::vector<std::string> lines{line("on", "x", "y", "z", "place")};
  for (std::size_t s = 0; s < 2; ++s) {
    if (!places[s]) continue;
    const SurfaceParameter& at = *places[s];
    const SchemeTraits& traits = sides[s].surface().traits();
    const std::string place =
        fmt::format("{} {}{} u {:.6g} v {:.6g}", traits.owner(), at.owner,
                    traits.triangular ? "" : fmt::format(" corner {}", at.corner), at.u, at.v);
    lines.push_back(
        line(s == 0 ? "A" : "B", number(witness[s].x), number(witness[s].y), number(witness[s].z), place));
  }
  return lines;
}

}  // namespace snug::command
