#include <snug/query/bound_curve.h>

#include <fmt/core.h>

#include "curve.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

void write_points(JsonWriter& json, const char* key, const Segment& points) {
  json.key(key).begin_array().value(points[0]).value(points[1]).end_array();
}

void write_piece(JsonWriter& json, const CurveEnclosure& piece) {
  json.begin_object().field("edge", piece.edge.index()).field("piece", piece.path.text());
  json.field("level", piece.path.level());
  const auto& end = piece.interval.corner;
  write_points(json, "lower", {end[0].lower, end[1].lower});
  write_points(json, "upper", {end[0].upper, end[1].upper});
  write_points(json, "base", piece.offset.base);
  json.field("radius", piece.offset.radius);
  write_points(json, "corners", piece.corners);
  json.end_object();
}

}  // namespace

ExitStatus bound_curve(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                       CurveDegree degree, BoundOptions how, const std::optional<Length>& tolerance) {
  if (how.method == BoundMethod::table) {
    throw UsageError("bound: --bounds table is for surfaces; " + path + " is answered as curves");
  }
  BoundSummary summary;
  std::size_t edges = 0;
  Report report("bound", options);
  naming(path, [&] {
    const CurveSet curves(std::move(mesh), degree);
    edges = curves.edge_count();
    if (tolerance) how.tolerance = tolerance->in_mesh_units(curves.size());
    curve_heads(report, path, degree);
    if (report.json()) report.write().key("enclosures").begin_array();
    ProgressBar bar("bounding " + path, options.quiet);
    summary = bound(
        curves, how,
        [&](const CurveEnclosure& piece) {
          if (report.json()) write_piece(report.write(), piece);
        },
        bar.monitor());
  });
  if (report.json()) {
    report.write().end_array().field("count", summary.count).field("max_radius", summary.max_radius);
    report.write().field("reached", summary.reached).field("splits", summary.splits);
  }
  report.text(fmt::format(
      "{}: {} enclosures of {} edges contain the limit curves of degree {}, largest radius {}", path,
      summary.count, edges, static_cast<int>(degree), text_at_most(summary.max_radius, true)));
  if (!summary.reached) {
    const bool spent = summary.splits >= options.budget;
    report.text(fmt::format("{} was not reached everywhere: {}; what is printed is still proved",
                            tolerance ? "the tolerance" : "the level",
                            spent ? "the budget was spent, edge by edge; give a larger --budget"
                                  : "rounding stands in the way; give a larger --tolerance"));
  }
  report.finish();
  return summary.reached ? ExitStatus::answered : ExitStatus::not_reached;
}

}  // namespace snug::command
