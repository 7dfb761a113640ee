#include <algorithm>

#include <fmt/core.h>
#include <snug/evaluate.h>
#include <support/atomic_file.h>

#include "common.h"
#include "curve.h"
#include "length.h"
#include "mesh_reading.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  Degree degree;
  unsigned level = 1;
  bool limit = false;
};

// Of files, polylines go to OBJ alone.
void require_obj(const std::string& output) {
  std::string ending = output == "-" ? ".obj" : output.substr(output.find_last_of('.'));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (ending == ".obj") return;
  throw UsageError("subdivide: -o " + output + ": polylines are written to .obj files only");
}

ExitStatus run(const Options& options) {
  if (options.output.empty()) throw UsageError("subdivide: -o FILE is missing: where the refined mesh goes");
  if (options.json && options.output == "-")
    throw UsageError("subdivide: --json and -o - both want standard output");
  ControlMesh mesh = load_mesh(options.mesh, options);
  const bool curves = asks_for_curves("subdivide", mesh, options.mesh, options, options.degree);
  if (curves) {
    require_obj(options.output);
  } else {
    refuse_curves(mesh, options.scheme, options.mesh);
  }
  const std::optional<double> units = mesh.metres_per_unit;
  ControlMesh result;
  Scheme scheme{};
  naming(options.mesh, [&] {
    ProgressBar bar("subdividing " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    if (curves) {
      result = subdivided(CurveSet(std::move(mesh), curve_degree(options.degree)), options.level,
                          options.limit, {.monitor = &monitor});
      return;
    }
    const SurfaceOptions how = surface_options(options, options.scheme, mesh);
    scheme = *how.scheme;
    result = subdivided(std::move(mesh), options.level, options.limit, how, {.monitor = &monitor});
  });
  if (!curves && format_of(options.output).scheme) result.tags.scheme = scheme;
  result.metres_per_unit = units;
  AtomicFile file(options.output);
  write_mesh(result, file, options.output, options);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("subdivide", to_standard_output);
  curves ? curve_heads(report, options.mesh, curve_degree(options.degree))
         : report.heads({options.mesh}, {name_of(scheme)});
  if (report.json()) {
    report.write().field("vertices", result.vertex_count()).field("faces", result.face_count());
    if (curves) report.write().field("polylines", result.polyline_count());
    report.write().field("level", options.level).field("limit", options.limit);
  }
  if (options.output != "-") {
    report.text(fmt::format("{}: {} vertices, {} {}{}", options.output, result.vertex_count(),
                            curves ? result.polyline_count() : result.face_count(),
                            curves ? "polylines" : "faces",
                            options.limit ? ", at their limit positions" : ""));
  }
  return report.finish(true, {&file});
}

}  // namespace

Command subdivide_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  list.add(Group::own, "--level N", &options->level, "Steps of subdivision, 0 to 12").between(0, 12);
  list.add(Group::own, "--limit", &options->limit, "Move every vertex to its limit position");
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  return {"subdivide",
          Topic::files,
          "Write the refined control mesh, or its limit positions",
          {"snug subdivide pawn.obj --level 3 --limit -o smooth.ply"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
