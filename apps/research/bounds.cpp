#include <memory>
#include <optional>
#include <vector>

#include <apps/snug/curve.h>
#include <apps/snug/progress_bar.h>
#include <experiments/bound_counts.h>
#include <experiments/older_catmark.h>
#include <fmt/core.h>
#include <snug/search/surface_data.h>
#include <support/atomic_file.h>

#include "commands.h"

namespace snug::command {
namespace {

struct CountsOptions : CommonOptions {
  std::string mesh, error;
  std::optional<std::uint64_t> level;
  Degree degree;
};

struct OlderOptions : CommonOptions {
  std::string mesh;
  unsigned level = 1;
};

struct Row {
  BoundWay way;
  PieceCount pieces;
};

// A row for each way to bound what is in the file.
std::vector<Row> count_rows(ControlMesh mesh, const CountsOptions& options,
                            const std::optional<Length>& tolerance, std::string& scheme,
                            const WorkMonitor& monitor) {
  std::vector<Row> rows;
  CountOptions how{.level = static_cast<unsigned>(options.level.value_or(0)), .budget = options.max_splits};
  if (asks_for_curves("bounds", mesh, options.mesh, options, options.degree)) {
    scheme = "curve";
    naming(options.mesh, [&] {
      const CurveSet curves(std::move(mesh), curve_degree(options.degree));
      if (tolerance) how.tolerance = tolerance->in_mesh_units(curves.size());
      for (const BoundWay way : {BoundWay::rows, BoundWay::control_box}) {
        rows.push_back({way, count_pieces(curves, way, how, monitor)});
      }
    });
    return rows;
  }
  const Surface held = make_surface(std::move(mesh), options.mesh, options, options.scheme);
  const LimitSurface& surface = held.data()->limit();
  scheme = name_of(surface.options().scheme);
  if (tolerance) how.tolerance = tolerance->in_mesh_units(surface.size());
  LayoutTables tables(surface.library());
  for (const BoundWay way : all_bound_ways) {
    rows.push_back({way, count_pieces(surface, tables, way, how, {}, monitor)});
  }
  return rows;
}

ExitStatus counts(const CountsOptions& options) {
  std::optional<Length> tolerance;
  if (!options.level) tolerance = parse_length(options.error.empty() ? "1%" : options.error, "--error");
  ControlMesh mesh = load_mesh(options.mesh, options);
  Report report("bounds", options);
  std::string scheme;
  std::vector<Row> rows;
  {
    ProgressBar bar("bounding " + options.mesh, options.quiet);
    rows = count_rows(std::move(mesh), options, tolerance, scheme, bar.monitor());
  }
  report.heads({options.mesh}, {scheme});
  if (report.json()) report.write().key("rows").begin_array();
  report.text(fmt::format("{:<22} {:>9} {:>9} {:>14}", "bounds", "pieces", "splits", "largest radius"));
  bool reached = true;
  for (const auto& [way, pieces] : rows) {
    reached = reached && pieces.reached;
    if (report.json()) {
      report.write().begin_object().field("bounds", name_of(way)).field("count", pieces.count);
      report.write().field("splits", pieces.splits).field("max_radius", pieces.largest);
      report.write().field("reached", pieces.reached).end_object();
    }
    report.text(fmt::format("{:<22} {:>9} {:>9} {:>14}{}", name_of(way), pieces.count, pieces.splits,
                            text_at_most(pieces.largest, true), pieces.reached ? "" : ", not reached"));
  }
  if (report.json()) report.write().end_array();
  report.finish();
  return reached ? ExitStatus::answered : ExitStatus::not_reached;
}

ExitStatus subdivide_older(const OlderOptions& options) {
  if (options.output.empty()) throw UsageError("subdivide: -o FILE is missing: where the refined mesh goes");
  if (options.json && options.output == "-")
    throw UsageError("subdivide: --json and -o - both want standard output");
  ControlMesh mesh = load_mesh(options.mesh, options);
  naming(options.mesh, [&] { mesh = subdivide_by_older_rule(std::move(mesh), options.level); });
  AtomicFile file(options.output);
  write_mesh(mesh, file, options.output, options);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("subdivide", to_standard_output);
  report.heads({options.mesh}, {name_of(Scheme::catmark)});
  if (report.json()) {
    report.write().field("vertices", mesh.vertex_count()).field("faces", mesh.face_count());
    report.write().field("level", options.level);
  }
  if (options.output != "-") {
    report.text(
        fmt::format("{}: {} vertices, {} faces", options.output, mesh.vertex_count(), mesh.face_count()));
  }
  report.finish(true, {&file});
  return ExitStatus::answered;
}

}  // namespace

Command bounds_command() {
  auto options = std::make_shared<CountsOptions>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, "Control mesh (OBJ, OFF, PLY or STL; - for standard input)");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Split until each radius, or half a box's longest side, is at most half of this (default 1%)")
      .formerly("--tolerance");
  list.add(Group::own, "--level N", &options->level, "Or split every patch N times, 0 to 12")
      .between(0, 12)
      .excludes("--error");
  list.add(Group::own, "--max-splits N", &options->max_splits, "Split at most N patches, by each method")
      .formerly("--budget")
      .between(0, std::uint64_t{1} << 40);
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  return {"bounds",
          Topic::comparisons,
          "Number of pieces by bounding rows, tables of two layouts, boxes, and after splitting at creases",
          {"snug-research bounds bracket.obj --error 2%"},
          std::move(list),
          [options] { return counts(*options); }};
}

Command older_rule_command() {
  auto options = std::make_shared<OlderOptions>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, "Control mesh (OBJ, OFF, PLY or STL; - for standard input)");
  list.add(Group::own, "--level N", &options->level, "Steps of subdivision, 0 to 8").between(0, 8);
  add_output_options(list, *options);
  return {"subdivide",
          Topic::comparisons,
          "Catmull-Clark by the older vertex rule, (Q + 2R + S)/4 at every valence",
          {"snug-research subdivide bracket.obj --level 3 -o older.obj"},
          std::move(list),
          [options] { return subdivide_older(*options); }};
}

}  // namespace snug::command
