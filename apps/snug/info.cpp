#include <fmt/core.h>
#include <snug/evaluate.h>
#include <snug/mesh/loose_creases.h>
#include <snug/mesh/validate.h>
#include <snug/query/nesting.h>
#include <snug/query/smoothing_note.h>
#include <snug/scheme/rules.h>
#include <snug/search/surface_data.h>
#include <support/names.h>

#include "common.h"
#include "curve.h"
#include "mesh_counts.h"
#include "mesh_reading.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

constexpr auto defect_kind_names =
    std::to_array<Named<DefectKind>>({{"index-out-of-range", DefectKind::index_out_of_range},
                                      {"coordinate-not-finite", DefectKind::coordinate_not_finite},
                                      {"too-few-vertices", DefectKind::too_few_vertices},
                                      {"repeated-vertex", DefectKind::repeated_vertex},
                                      {"duplicate-face", DefectKind::duplicate_face},
                                      {"edge-of-many-faces", DefectKind::edge_of_many_faces},
                                      {"inconsistent-orientation", DefectKind::inconsistent_orientation},
                                      {"pinched-vertex", DefectKind::pinched_vertex},
                                      {"bad-tag", DefectKind::bad_tag},
                                      {"isolated-vertex", DefectKind::isolated_vertex},
                                      {"zero-area-face", DefectKind::zero_area_face}});

struct Options : CommonOptions {
  std::string mesh;
};

// Vertices unlike those of a regular lattice; with a dual scheme faces.
std::size_t extraordinary(const ControlMesh& mesh, const MeshCounts& counts, const SchemeRules& scheme) {
  if (scheme.primal) return counts.extraordinary;
  std::size_t found = 0;
  for (std::size_t f = 0; f < mesh.face_count(); ++f)
    found += mesh.face(FaceId(f)).size() != scheme.regular_valence;
  return found;
}

// The scheme that the mesh is read with, why, and how far the surface is from its faces.
std::string taken_as(const ControlMesh& mesh, const SchemeRules& scheme, const Options& options,
                     const std::optional<double>& apart, double size) {
  const char* const because = options.scheme != "auto" ? "--scheme"
                              : !options.sharp.empty() ? "--sharp"
                              : mesh.tags.scheme       ? "the file"
                                                       : "its faces";
  const char* const what =
      scheme.scheme == Scheme::flat ? "triangles" : "the control mesh of a limit surface";
  std::string text = fmt::format("taken as {}, scheme {} (chosen by {})", what, scheme.name, because);
  if (apart && scheme.scheme != Scheme::flat) {
    text += ", within " + text_of_length(*apart, size) + " of its faces";
  }
  return text;
}

// An owner of a shell that lies within another one, or overlaps it, turned the same way.
std::optional<std::uint32_t> owner_wound_twice(const Surface& surface) {
  if (surface.open_reason()) return {};
  const std::optional<PatchId> patch = wound_twice(surface.data()->bvh(), stopped_by_interrupts());
  return patch ? std::optional(surface.data()->limit().place(*patch).owner) : std::nullopt;
}

ExitStatus run(const Options& options) {
  const ControlMesh mesh = load_mesh(options.mesh, options);
  refuse_curves(mesh, options.scheme, options.mesh);
  const SurfaceOptions how = surface_options(options, options.scheme, mesh);
  const SchemeRules& scheme = rules_of(*how.scheme);
  const MeshCounts counts = count_elements(mesh, scheme.regular_valence);
  const std::size_t odd_ones = extraordinary(mesh, counts, scheme);
  const std::vector<Defect> found = defects(mesh);
  std::optional<std::size_t> kinds;
  std::optional<double> apart;
  std::optional<std::uint32_t> twice;
  std::string open;
  double size = 0;
  std::string refusal;
  try {
    const Surface surface(mesh, how, {.threads = options.threads});
    apart = limit_to_faces(surface, {.threads = options.threads});
    size = surface.size();
    kinds = surface.kind_count();
    if (counts.closed && counts.boxes_meet) twice = owner_wound_twice(surface);
    if (!counts.closed && counts.boundary_edges == 0) open = ": " + surface.open_reason().value_or("");
    note_smoothing(surface, options.mesh, options, options.scheme, apart);
  } catch (const InputError& error) {
    refusal = error.what();
  }

  const std::size_t creases = mesh.tags.creases.size() - loose_creases(mesh).size();
  Report report("info", options);
  report.heads({options.mesh}, {scheme.name});
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("vertices", mesh.vertex_count())
        .field("faces", mesh.face_count())
        .field("edges", counts.edges);
    json.field("closed", counts.closed).field("components", counts.components);
    json.key("valence").begin_array().value(counts.min_valence).value(counts.max_valence).end_array();
    json.field("extraordinary", odd_ones).field("boundary_edges", counts.boundary_edges);
    json.field("creases", creases).field("corners", mesh.tags.corners.size());
    json.field("holes", mesh.tags.holes.size());
    json.key("kinds");
    kinds ? json.value(*kinds) : json.null();
    json.key("limit_to_faces");
    apart ? json.value(*apart) : json.null();
    json.key("overlapping_shell");
    twice ? json.value(*twice) : json.null();
    json.key("refusal");
    kinds ? json.null() : json.value(refusal);
    json.key("defects").begin_array();
    for (const Defect& defect : found) {
      json.begin_object().field("kind", name_in(defect_kind_names, defect.kind)).field("text", defect.text);
      json.field("legal", scheme.answers(defect.kind)).end_object();
    }
    json.end_array();
  }
  report.text(options.mesh + ": " + taken_as(mesh, scheme, options, apart, size));
  if (!kinds) report.text("refused: " + refusal);
  report.text(fmt::format("{} vertices, {} edges, {} faces, {}, {} component{}", mesh.vertex_count(),
                          counts.edges, mesh.face_count(),
                          counts.closed               ? std::string("closed")
                          : counts.boundary_edges > 0 ? "open"
                                                      : "not closed" + open,
                          counts.components, counts.components == 1 ? "" : "s"));
  report.text(fmt::format("valence {} to {}, {} extraordinary {}, {} boundary edges, {} creases",
                          counts.min_valence, counts.max_valence, odd_ones,
                          scheme.primal ? "vertices" : "faces", counts.boundary_edges, creases));
  if (kinds) report.text(fmt::format("patch topologies: {}", *kinds));
  if (twice) {
    report.text(
        fmt::format("note: the shell of {} {} lies within another one, or overlaps it, and is turned the "
                    "same way: the solid "
                    "includes both, and its volume counts their common part twice; if the shell bounds a "
                    "cavity, turn its faces",
                    scheme.owner(), *twice));
  }
  for (std::size_t i = 0; i < found.size() && i < 10; ++i) {
    report.text(fmt::format("{}: {}", scheme.answers(found[i].kind) ? "note" : "defect", found[i].text));
  }
  if (found.size() > 10) report.text(fmt::format("and {} more", found.size() - 10));
  return report.finish();
}

}  // namespace

Command info_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh (OBJ, OFF, PLY, STL, USD or glTF; - for standard input)");
  add_common_options(list, *options);
  return {"info",
          Topic::files,
          "Print counts, valences and defects of a mesh, even a broken one",
          {"snug info pawn.obj"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
