#include <fmt/core.h>
#include <snug/evaluate.h>
#include <snug/inspect.h>
#include <support/number.h>

#include "common.h"
#include "curve.h"
#include "mesh_reading.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
};

// The scheme that the mesh is read with, why, and how far the surface is from its faces.
std::string taken_as(const ControlMesh& mesh, Scheme scheme, const Options& options,
                     const std::optional<double>& apart, double size) {
  const char* const because = options.scheme != "auto" ? "--scheme"
                              : !options.sharp.empty() ? "--sharp"
                              : mesh.tags.scheme       ? "the file"
                                                       : "its faces";
  const char* const what = scheme == Scheme::flat ? "triangles" : "the control mesh of a limit surface";
  std::string text = fmt::format("taken as {}, scheme {} (chosen by {})", what, name_of(scheme), because);
  if (apart && scheme != Scheme::flat) {
    text += ", within " + text_of_length(*apart, size) + " of its faces";
  }
  return text;
}

ExitStatus run(const Options& options) {
  const ControlMesh mesh = load_mesh(options.mesh, options);
  refuse_curves(mesh, options.scheme, options.mesh);
  const SurfaceOptions how = surface_options(options, options.scheme, mesh);
  const Scheme scheme = *how.scheme;
  const SchemeTraits& traits = traits_of(scheme);
  const MeshCounts counts = count_elements(mesh, scheme);
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
    if (counts.closed && counts.boxes_meet && !surface.open_reason()) {
      const WorkMonitor monitor = stopped_by_interrupts();
      twice = overlapping_shell(surface, {.monitor = &monitor});
    }
    if (!counts.closed && counts.boundary_edges == 0) open = ": " + surface.open_reason().value_or("");
    note_smoothing(surface, options.mesh, options, options.scheme, apart);
  } catch (const InputError& error) {
    refusal = error.what();
  }

  Report report("info", options);
  report.heads({options.mesh}, {traits.name});
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("vertices", mesh.vertex_count())
        .field("faces", mesh.face_count())
        .field("edges", counts.edges);
    json.field("closed", counts.closed).field("components", counts.components);
    json.key("valence").begin_array().value(counts.min_valence).value(counts.max_valence).end_array();
    json.field("extraordinary", counts.extraordinary).field("boundary_edges", counts.boundary_edges);
    json.field("creases", counts.creases).field("corners", mesh.tags.corners.size());
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
      json.begin_object().field("kind", name_of(defect.kind)).field("text", defect.text);
      json.field("legal", scheme_answers(scheme, defect.kind)).end_object();
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
                          counts.min_valence, counts.max_valence, counts.extraordinary,
                          traits.dual ? "faces" : "vertices", counts.boundary_edges, counts.creases));
  if (kinds) report.text(fmt::format("patch topologies: {}", *kinds));
  if (twice) {
    report.text(
        fmt::format("note: the shell of {} {} lies within another one, or overlaps it, and is turned the "
                    "same way: the solid "
                    "includes both, and its volume counts their common part twice; if the shell bounds a "
                    "cavity, turn its faces",
                    traits.owner(), *twice));
  }
  for (std::size_t i = 0; i < found.size() && i < 10; ++i) {
    report.text(
        fmt::format("{}: {}", scheme_answers(scheme, found[i].kind) ? "note" : "defect", found[i].text));
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
