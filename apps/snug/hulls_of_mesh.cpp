#include "hulls_of_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "length.h"

namespace snug::command {
namespace {

constexpr std::size_t max_printed = 10;

// The fault, and what helps.
const char* explained(HullFault fault) {
  switch (fault) {
    case HullFault::no_position:
      return "no position near enough is in front of all faces around: a larger --error helps at tight "
             "curves, and not at a spike, a fold or a saddle-shaped corner";
    case HullFault::meets_surface:
      return "the hull could not be kept off the surface: sheets are too near to each other, or touch; try a "
             "smaller --error";
    case HullFault::meets_itself:
      return "the hull could not be kept off itself: sheets are too near to each other, or touch; try a "
             "smaller "
             "--error";
    case HullFault::meets_other:
      return "the hulls could not be kept off each other; try a smaller --error";
    case HullFault::too_few_triangles:
      return "the budget allows too few triangles; give a larger --max-splits or --error";
    case HullFault::through_itself:
      return "the surface goes through itself there, and the hull failed; snug envelope makes a mesh around "
             "it";
    case HullFault::not_around:
      break;
  }
  return "the hull is on the wrong side: part of the surface is inside another part, or is oriented the "
         "other way; query the parts one at a time";
}

void write_problem(JsonWriter& json, const HullProblem& problem, const char* owner) {
  json.begin_object().field("fault", name_of(problem.fault)).field("hull", problem.inner ? "inner" : "outer");
  json.field("place", problem.place).key(owner);
  problem.owner ? json.value(*problem.owner) : json.null();
  json.end_object();
}

}  // namespace

std::string sentence(const HullProblem& problem, const char* owner) {
  const auto& [x, y, z] = problem.place;
  const std::string at = problem.owner ? fmt::format(" at {} {}", owner, *problem.owner) : "";
  if (problem.fault == HullFault::through_itself) {
    return fmt::format("{}({:.6g} {:.6g} {:.6g}): {}", problem.owner ? at.substr(1) + ", " : "", x, y, z,
                       explained(problem.fault));
  }
  return fmt::format("{} hull{}, near ({:.6g} {:.6g} {:.6g}): {}", problem.inner ? "inner" : "outer", at, x,
                     y, z, explained(problem.fault));
}

ControlMesh mesh_of(const Hull& hull) {
  ControlMesh mesh;
  mesh.points = hull.positions;
  mesh.face_vertices.reserve(3 * hull.triangles.size());
  mesh.face_offsets.reserve(hull.triangles.size() + 1);
  for (const auto& [a, b, c] : hull.triangles)
    mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
  return mesh;
}

void require_error(const std::string& command, const std::string& tolerance) {
  if (tolerance.empty()) throw UsageError(command + ": give --error LENGTH, such as 1%");
  static_cast<void>(parse_length(tolerance, "--error"));
}

void write_hull(JsonWriter& json, const std::optional<Hull>& hull) {
  if (!hull) {
    json.null();
    return;
  }
  json.begin_object().field("vertices", hull->positions.size()).field("triangles", hull->triangles.size());
  json.key("gap");
  std::isfinite(hull->gap) ? json.value(hull->gap) : json.null();
  json.end_object();
}

void write_verdict(Report& report, const Hulls& hulls, const char* owner) {
  const std::size_t printed = std::min(hulls.problems.size(), max_printed);
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("outcome", name_of(hulls.outcome)).key("problems").begin_array();
    for (std::size_t i = 0; i < printed; ++i) write_problem(json, hulls.problems[i], owner);
    json.end_array();
  }
  if (hulls.outcome == Outcome::complete) return;
  report.text("not proved, so nothing was written:");
  for (std::size_t i = 0; i < printed; ++i) report.text("  " + sentence(hulls.problems[i], owner));
  if (printed < hulls.problems.size()) report.text("  and at more places");
}

}  // namespace snug::command
