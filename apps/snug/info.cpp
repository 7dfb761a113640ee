#include <fmt/core.h>
#include <snug/inspect.h>

#include "common.h"
#include "mesh_reading.h"
#include "mesh_summary.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
};

ExitStatus run(const Options& options) {
  const ControlMesh mesh = load_mesh(options.mesh, options);
  const MeshSummary summary = summary_of(mesh, options.mesh, options);
  const auto& [scheme, counts, found, surface, refusal, apart, twice] = summary;
  if (surface) note_smoothing(*surface, options.mesh, options, options.scheme, apart);

  Report report("info", options);
  report.heads({options.mesh}, {name_of(scheme)});
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
    surface ? json.value(surface->kind_count()) : json.null();
    json.key("limit_to_faces");
    apart ? json.value(*apart) : json.null();
    json.key("overlapping_shell");
    twice ? json.value(*twice) : json.null();
    json.key("refusal");
    surface ? json.null() : json.value(refusal);
    json.key("defects").begin_array();
    for (const Defect& defect : found) {
      json.begin_object().field("kind", name_of(defect.kind)).field("text", defect.text);
      json.field("legal", scheme_answers(scheme, defect.kind)).end_object();
    }
    json.end_array();
  }
  for (const std::string& line : lines_of(summary, mesh, options.mesh, options)) report.text(line);
  if (surface) report.text(fmt::format("patch topologies: {}", surface->kind_count()));
  if (twice) report.text("note: " + overlap_sentence(summary));
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
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  add_common_options(list, *options);
  return {"info",
          Topic::files,
          "Print counts, valences and defects of a mesh, even a broken one",
          {"snug info pawn.obj"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
