#include <fmt/core.h>
#include <snug/io/atomic_file.h>
#include <snug/io/mesh_file.h>
#include <snug/query/subdivide.h>

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

ExitStatus run(const Options& options) {
  if (options.output.empty()) throw UsageError("subdivide: -o FILE is missing: where the refined mesh goes");
  if (options.json && options.output == "-")
    throw UsageError("subdivide: --json and -o - both want standard output");
  ControlMesh mesh = load_mesh(options.mesh, options);
  if (asks_for_curves("subdivide", mesh, options.mesh, options, options.degree)) {
    return subdivide_curve(mesh, options.mesh, options,
                           {curve_degree(options.degree), options.level, options.limit});
  }
  refuse_curves(mesh, options.scheme, options.mesh);
  ControlMesh result;
  Scheme scheme{};
  naming(options.mesh, [&] {
    const SchemeOptions rules = choose_rules(options, options.scheme, mesh);
    scheme = rules.scheme;
    ProgressBar bar("subdividing " + options.mesh, options.quiet);
    result = subdivide(std::move(mesh), rules, options.level, options.limit, bar.monitor());
  });
  note_smooth_facets(options.mesh, options, ask_info);
  AtomicFile file(options.output);
  write_mesh(result, file, options.output, notes_for(options), stopped_by_interrupts());
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("subdivide", to_standard_output);
  report.heads({options.mesh}, {name_of(scheme)});
  if (report.json()) {
    report.write().field("vertices", result.vertex_count()).field("faces", result.face_count());
    report.write().field("level", options.level).field("limit", options.limit);
  }
  if (options.output != "-") {
    report.text(fmt::format("{}: {} vertices, {} faces{}", options.output, result.vertex_count(),
                            result.face_count(), options.limit ? ", at their limit positions" : ""));
  }
  report.finish(&file);
  return ExitStatus::answered;
}

}  // namespace

Command subdivide_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, "Control mesh (OBJ, OFF, PLY or STL; - for standard input)");
  list.add(Group::own, "--level N", &options->level, "Steps of subdivision, 0 to 12").between(0, 12);
  list.add(Group::own, "--limit", &options->limit, "Move every vertex to its limit position");
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  return {"subdivide",
          Topic::files,
          "The refined control mesh, or its limit positions",
          {"snug subdivide pawn.obj --level 3 --limit -o smooth.ply"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
