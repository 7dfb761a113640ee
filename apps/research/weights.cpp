#include <map>
#include <memory>

#include <apps/snug/curve.h>
#include <apps/snug/places.h>
#include <apps/snug/progress_bar.h>
#include <apps/snug/words.h>
#include <fmt/core.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>

#include "commands.h"
#include "limit_weights.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, at;
  unsigned samples = 4;
};

using Weights = std::map<std::uint32_t, double>;  // of control points, by vertex

Weights weights_at(const LimitSurface& surface, const Place& at) {
  const Stencils rows = limit_weights(surface, {&at, 1});
  const Stencils::Row row = rows.row(0);
  Weights sums;  // a vertex may come twice
  for (std::size_t i = 0; i < row.sources.size(); ++i) sums[row.sources[i]] += row.weights[i];
  return sums;
}

void write_row(Report& report, const Surface& surface, const Place& at, const SurfacePoint& point) {
  const Weights weights = weights_at(surface.data()->limit(), at);
  if (report.json()) {
    JsonWriter& json = report.write();
    json.begin_object();
    write_place(json, surface, at, point);
    json.key("weights").begin_object();
    for (const auto& [vertex, weight] : weights) json.field(std::to_string(vertex), weight);
    json.end_object().end_object();
    return;
  }
  std::string line = fmt::format("{} {} {}{} ", at.owner, at.u, at.v,
                                 surface.traits().triangular ? "" : fmt::format(" {}", at.corner));
  for (const auto& [vertex, weight] : weights) line += fmt::format(" {}:{}", vertex, weight);
  report.text(line);
}

ExitStatus run(const Options& options) {
  ControlMesh mesh = load_mesh(options.mesh, options);
  if (is_curve(mesh, options.scheme)) {
    throw UsageError("weights: " + options.mesh + " is answered as curves; weights are those of surfaces");
  }
  const Surface surface = make_surface(std::move(mesh), options.mesh, options, options.scheme);
  const auto places = options.at.empty() ? std::vector<Place>() : read_places(options.at, surface);
  Report report("weights", options);
  report.heads({options.mesh}, {surface.traits().name});
  report.text(fmt::format("# {} u v{}  vertex:weight ...", surface.traits().owner(),
                          surface.traits().triangular ? "" : " corner"));
  if (report.json()) report.write().key("points").begin_array();
  std::size_t count = 0;
  SurfaceEvaluator evaluator(surface.data()->limit());
  const auto answer = [&](const Place& at) {
    write_row(report, surface, at, evaluator(at));
    ++count;
  };
  naming(options.mesh, [&] {
    for (const Place& at : places) answer(at);
    if (!options.at.empty()) return;
    ProgressBar bar("evaluating " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    for (std::uint32_t owner = 0; owner < surface.owner_count(); ++owner) {
      for_each_place(surface, owner, options.samples, answer);
      monitor.report(static_cast<double>(owner + 1) / static_cast<double>(surface.owner_count()));
    }
  });
  if (report.json()) report.write().end_array().field("count", count);
  return report.finish();
}

}  // namespace

Command weights_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  add_place_options(list, options->samples, options->at);
  add_common_options(list, *options);
  return {"weights",
          Topic::functions,
          "Evaluate nodal functions: the weights of control points in limit points",
          {"snug-research weights pawn.obj --samples 2",
           "echo \"0 0.25 0.5\" | snug-research weights pawn.obj --at - --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
