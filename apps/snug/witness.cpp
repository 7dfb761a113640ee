#include "witness.h"

#include <algorithm>

#include <fmt/core.h>
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

void write_stats(JsonWriter& json, const SearchStats& stats) {
  json.key("stats").begin_object();
  json.field("box_tests", stats.box_tests).field("triangle_tests", stats.triangle_tests);
  json.field("evaluations", stats.evaluations).field("splits", stats.splits).end_object();
}

void write_witness(JsonWriter& json, const Sides& sides, const WitnessPoints* witness) {
  if (witness == nullptr) {
    for (const char* field : {"witness", "witness_error", "witness_at"}) json.key(field).null();
    return;
  }
  const auto& [a, b] = *witness;
  json.key("witness").begin_array().value(a.point).value(b.point).end_array();
  json.field("witness_error", std::max(a.error, b.error));
  json.key("witness_at").begin_array();
  for (std::size_t s = 0; s < 2; ++s) {
    if (!(*witness)[s].at) {
      json.null();
      continue;
    }
    json.begin_object();
    write_place(json, sides[s], *(*witness)[s].at);
    json.end_object();
  }
  json.end_array();
}

std::vector<std::string> witness_lines(const Sides& sides, const WitnessPoints& witness) {
  const auto line = [](const std::string& on, const std::string& x, const std::string& y,
                       const std::string& z, const std::string& place) {
    return fmt::format("  {:<2}  {:>12}  {:>12}  {:>12}  {}", on, x, y, z, place);
  };
  const auto number = [](double x) { return fmt::format("{:.8g}", x); };
  std::vector<std::string> lines{line("on", "x", "y", "z", "place")};
  for (std::size_t s = 0; s < 2; ++s) {
    if (!witness[s].at) continue;
    const Place& at = *witness[s].at;
    const Point3& p = witness[s].point;
    const SchemeTraits& traits = sides[s].surface().traits();
    const std::string place =
        fmt::format("{} {}{} u {:.6g} v {:.6g}", traits.owner(), at.owner,
                    traits.triangular ? "" : fmt::format(" corner {}", at.corner), at.u, at.v);
    lines.push_back(line(s == 0 ? "A" : "B", number(p.x), number(p.y), number(p.z), place));
  }
  return lines;
}

}  // namespace snug::command
