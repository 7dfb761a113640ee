#include <snug/query/bound.h>

#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include "common.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  std::string tolerance;
  unsigned level = 0;
};

void write_box_corners(JsonWriter& json, const char* key, const PieceEnclosure& piece, Point3 Box3::*end) {
  json.key(key).begin_array();
  if (piece.box) json.value((*piece.box).*end);
  if (piece.interval) {
    for (const Box3& box : piece.interval->corner) json.value(box.*end);
  }
  json.end_array();
}

void write_triangle(JsonWriter& json, const char* key, const Triangle& triangle) {
  json.key(key).begin_array();
  for (const Point3& p : triangle) json.value(p);
  json.end_array();
}

void write_piece(JsonWriter& json, const PieceEnclosure& piece) {
  json.begin_object();
  json.field("face", piece.face.index()).field("piece", piece.path.text()).field("level", piece.path.level());
  write_box_corners(json, "lower", piece, &Box3::lower);
  write_box_corners(json, "upper", piece, &Box3::upper);
  if (piece.offset) {
    write_triangle(json, "base", piece.offset->base);
    json.field("radius", piece.offset->radius);
  } else {
    json.key("base").null().key("radius").null();
  }
  json.field("growth", 0);
  write_triangle(json, "corners", piece.corners);
  json.end_object();
}

ExitStatus run(const Options& options) {
  BoundOptions how;
  how.method = bound_method(options);
  how.layout = table_layout(options);
  how.level = options.level;
  how.budget = options.budget;
  how.threads = options.threads;
  std::optional<Length> tolerance;
  if (!options.tolerance.empty()) tolerance = parse_length(options.tolerance, "--tolerance");
  const Surface surface =
      load_surface(options.mesh, options, options.scheme, std::make_shared<BoundLibrary>());
  BoundSummary summary;
  Report report("bound", options);
  naming(options.mesh, [&] {
    if (tolerance) how.tolerance = tolerance->in_mesh_units(surface.size());
    report.heads({options.mesh}, {name_of(surface.options().scheme)});
    if (report.json()) report.write().key("enclosures").begin_array();
    ProgressBar bar("bounding " + options.mesh, options.quiet);
    summary = bound(
        surface, how,
        [&](const PieceEnclosure& piece) {
          if (report.json()) write_piece(report.write(), piece);
        },
        bar.monitor());
  });
  if (report.json()) {
    report.write().end_array().field("count", summary.count).field("max_radius", summary.max_radius);
    report.write().field("reached", summary.reached).field("splits", summary.splits);
  }
  report.text(fmt::format("{}: {} enclosures of {} faces contain the limit surface, largest radius {}",
                          options.mesh, summary.count, surface.face_count(),
                          text_at_most(summary.max_radius, true)));
  if (!summary.reached) {
    const bool spent = summary.splits >= options.budget;
    report.text(fmt::format("{} was not reached everywhere: {}; what is printed is still proved",
                            tolerance ? "the tolerance" : "the level",
                            spent ? "the budget was spent, face by face; give a larger --budget"
                                  : "rounding stands in the way; give a larger --tolerance"));
  }
  report.finish();
  return summary.reached ? ExitStatus::answered : ExitStatus::not_reached;
}

}  // namespace

Command add_bound(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("bound", "Enclosures that contain the limit surface");
  command->add_option("MESH", options->mesh, "Control mesh (OBJ or OFF; - for standard input)")->required();
  CLI::Option* tolerance =
      command->add_option("--tolerance", options->tolerance,
                          "Split until each radius is at most half of this: mesh units, or 1%");
  command->add_option("--level", options->level, "Split every patch this often")
      ->check(CLI::Range(0u, 12u))
      ->excludes(tolerance);
  add_common_options(*command, *options);
  return {command, [options] { return run(*options); }};
}

}  // namespace snug::command
