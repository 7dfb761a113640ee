#include "mesh_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/core.h>
#include <snug/evaluate.h>
#include <support/number.h>

#include "curve.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

// The scheme that the mesh is read with, why, and how far the surface is from its faces.
std::string taken_as(const MeshSummary& summary, const ControlMesh& mesh, const CommonOptions& options) {
  const char* const because = options.scheme != "auto" ? "--scheme"
                              : !options.sharp.empty() ? "--sharp"
                              : mesh.tags.scheme       ? "the file"
                                                       : "its faces";
  const char* const what =
      summary.scheme == Scheme::flat ? "triangles" : "the control mesh of a limit surface";
  std::string text =
      fmt::format("taken as {}, scheme {} (chosen by {})", what, name_of(summary.scheme), because);
  if (summary.apart && summary.scheme != Scheme::flat) {
    text += ", within " + text_of_length(*summary.apart, summary.surface->size()) + " of its faces";
  }
  return text;
}

constexpr double beside = 0.01;  // as parameters

// The corner of its face that a place is at.
std::optional<VertexId> corner_at(const Surface& surface, const Place& place) {
  const auto face = surface.mesh().face(FaceId(place.owner));
  const auto at = [&](double u, double v) { return std::abs(place.u - u) + std::abs(place.v - v) < beside; };
  constexpr std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const bool triangle = surface.traits().triangular;
  if (!triangle && face.size() != corners.size()) {
    return at(0, 0) ? std::optional(face[place.corner % face.size()]) : std::nullopt;
  }
  for (std::size_t k = 0; k < face.size(); ++k) {
    const auto [u, v] = corners[triangle && k == 2 ? 3 : k];
    if (at(u, v)) return face[k];
  }
  return std::nullopt;
}

}  // namespace

MeshSummary summary_of(const ControlMesh& mesh, const std::string& path, const CommonOptions& options) {
  refuse_curves(mesh, options.scheme, path);
  const SurfaceOptions how = surface_options(options, options.scheme, mesh);
  MeshSummary summary{.scheme = *how.scheme,
                      .counts = count_elements(mesh, *how.scheme),
                      .defects = defects(mesh),
                      .surface = {},
                      .refusal = {},
                      .apart = {},
                      .twice = {}};
  try {
    const Surface surface(mesh, how, {.threads = options.threads});
    summary.apart = limit_to_faces(surface, {.threads = options.threads});
    if (summary.counts.closed && summary.counts.boxes_meet && !surface.open_reason()) {
      const WorkMonitor monitor = stopped_by_interrupts();
      summary.twice = overlapping_shell(surface, {.monitor = &monitor});
    }
    static_cast<void>(surface.kind_count());
    summary.surface = surface;
  } catch (const InputError& error) {
    summary.refusal = error.what();
  }
  return summary;
}

std::vector<std::string> lines_of(const MeshSummary& summary, const ControlMesh& mesh,
                                  const std::string& path, const CommonOptions& options) {
  const MeshCounts& counts = summary.counts;
  const SchemeTraits& traits = traits_of(summary.scheme);
  std::vector<std::string> lines{path + ": " + taken_as(summary, mesh, options)};
  if (!summary.surface) lines.push_back("refused: " + summary.refusal);
  std::string open = "open";
  if (counts.closed) open = "closed";
  if (!counts.closed && counts.boundary_edges == 0) {
    open = "not closed";
    if (summary.surface) open += ": " + summary.surface->open_reason().value_or("");
  }
  lines.push_back(fmt::format("{} vertices, {} edges, {} face{}, {}, {} component{}", mesh.vertex_count(),
                              counts.edges, mesh.face_count(), mesh.face_count() == 1 ? "" : "s", open,
                              counts.components, counts.components == 1 ? "" : "s"));
  lines.push_back(fmt::format("valence {} to {}, {} extraordinary {}, {} boundary edges, {} creases",
                              counts.min_valence, counts.max_valence, counts.extraordinary,
                              traits.dual ? "faces" : "vertices", counts.boundary_edges, counts.creases));
  return lines;
}

std::string overlap_sentence(const MeshSummary& summary) {
  return fmt::format(
      "the shell of {} {} lies within another one, or overlaps it, and is turned the same way: the solid "
      "includes both, and its volume counts their common part twice; if the shell bounds a cavity, turn its "
      "faces",
      traits_of(summary.scheme).owner(), *summary.twice);
}

std::string vertex_at(const Surface& surface, const Place& place) {
  if (surface.traits().dual) return "";
  const std::optional<VertexId> vertex = corner_at(surface, place);
  if (!vertex) return "";
  const ControlMesh& mesh = surface.mesh();
  std::size_t faces = 0;
  std::map<VertexId, std::size_t> beside_edge;  // faces of each edge, by its other end
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (face[k] != *vertex) continue;
      ++faces;
      ++beside_edge[face[(k + 1) % face.size()]];
      ++beside_edge[face[(k + face.size() - 1) % face.size()]];
    }
  }
  const auto alone = std::count_if(beside_edge.begin(), beside_edge.end(),
                                   [](const auto& edge) { return edge.second == 1; });
  const auto creases = std::count_if(
      mesh.tags.creases.begin(), mesh.tags.creases.end(),
      [&](const CreaseTag& tag) { return tag.sharpness > 0 && (tag.a == *vertex || tag.b == *vertex); });
  std::string text = fmt::format("vertex {} of {} face{}", vertex->value(), faces, faces == 1 ? "" : "s");
  if (alone > 0) text += ", on the border";
  if (creases > 0) text += fmt::format(", with {} crease{}", creases, creases == 1 ? "" : "s");
  return text;
}

}  // namespace snug::command
