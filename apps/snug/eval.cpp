#include <cmath>
#include <limits>
#include <optional>

#include <fmt/core.h>
#include <snug/evaluate.h>
#include <support/atomic_file.h>
#include <support/read_file.h>
#include "column_table.h"

#include "common.h"
#include "curve.h"
#include "places.h"
#include "progress_bar.h"
#include "words.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  Degree degree;
  unsigned samples = 4;
  std::string at;
};

using Columns = std::vector<ColumnTable::Column>;

Columns columns_of(const Surface& surface) {
  using Type = ColumnTable::Type;
  Columns columns{{surface.traits().owner(), Type::integer}, {"corner", Type::integer}};
  if (surface.traits().triangular) columns.pop_back();
  for (const char* name : {"u", "v", "x", "y", "z", "error", "normal_x", "normal_y", "normal_z", "du_x",
                           "du_y", "du_z", "dv_x", "dv_y", "dv_z"}) {
    columns.push_back({name, Type::real});
  }
  columns.push_back({"differentiable", Type::flag});
  return columns;
}

void add_row(ColumnTable& table, const Surface& surface, const Place& at, const SurfacePoint& point) {
  table.add(at.owner);
  if (!surface.traits().triangular) table.add(at.corner);
  for (const double x : {at.u, at.v, point.point.x, point.point.y, point.point.z, point.error}) table.add(x);
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  for (const Vector3& vector :
       {point.normal.value_or(Vector3{none, none, none}), point.tangents[0], point.tangents[1]}) {
    for (std::size_t axis = 0; axis < 3; ++axis) table.add(vector[axis]);
  }
  table.add(point.differentiable ? 1 : 0);
}

// Where points go: a document or lines, or a table.
struct Output {
  Report& report;
  ColumnTable* table;
};

void write_point(const Output& output, const Surface& surface, const Place& at, const SurfacePoint& point) {
  if (output.table) return add_row(*output.table, surface, at, point);
  Report& report = output.report;
  const SchemeTraits& traits = surface.traits();
  if (!report.json()) {
    report.text(fmt::format("{} {} {}{}  {} {} {}", at.owner, at.u, at.v,
                            traits.triangular ? "" : fmt::format(" {}", at.corner), point.point.x,
                            point.point.y, point.point.z));
    return;
  }
  JsonWriter& json = report.write();
  json.begin_object();
  write_place(json, surface, at, point);
  json.end_object();
}

// Writes the points of a lattice on an owner; returns how many.
std::size_t write_lattice(const Output& output, const Options& options, const Surface& surface,
                          std::uint32_t owner) {
  std::vector<Place> places;
  for_each_place(surface, owner, options.samples, [&](const Place& at) { places.push_back(at); });
  const std::vector<SurfacePoint> points = evaluate(surface, places, {.threads = 1});
  for (std::size_t i = 0; i < places.size(); ++i) write_point(output, surface, places[i], points[i]);
  return places.size();
}

// A place on a curve.
struct CurveParameter {
  std::uint32_t edge;
  double t;
};

CurvePoint evaluate(const CurveSet& curves, const CurveParameter& at) {
  return evaluate(curves, EdgeId(at.edge), at.t);
}

using command::read_places;  // of surfaces

// Lines "edge t".
std::vector<CurveParameter> read_places(const std::string& path, const CurveSet& curves) {
  const std::string text = read_file(path, stopped_by_interrupts());
  std::vector<CurveParameter> requests;
  for_each_line(text, [&](std::string_view line, std::size_t line_number) {
    const auto unreadable = [&](const std::string& why) {
      return InputError(InputProblem::unreadable, path + ":" + std::to_string(line_number) + ": " + why);
    };
    CurveParameter at{};
    if (!parse(next_word(line), at.edge) || !parse(next_word(line), at.t) || !next_word(line).empty()) {
      throw unreadable("a line is 'edge t'");
    }
    if (at.edge >= curves.edge_count()) {
      throw unreadable("edge " + std::to_string(at.edge) + " of " + std::to_string(curves.edge_count()) +
                       " (they count from 0)");
    }
    if (!(at.t >= 0 && at.t <= 1)) throw unreadable("t must be from 0 to 1");
    requests.push_back(at);
  });
  return requests;
}

Columns columns_of(const CurveSet&) {
  using Type = ColumnTable::Type;
  Columns columns{{"edge", Type::integer}};
  for (const char* name : {"t", "x", "y", "z", "error", "tangent_x", "tangent_y", "tangent_z"}) {
    columns.push_back({name, Type::real});
  }
  return columns;
}

void write_point(const Output& output, const CurveSet&, const CurveParameter& at, const CurvePoint& point) {
  const auto& [x, y, z] = point.point;
  if (output.table) {
    output.table->add(at.edge);
    for (const double number :
         {at.t, x, y, z, point.error, point.tangent.x, point.tangent.y, point.tangent.z}) {
      output.table->add(number);
    }
    return;
  }
  Report& report = output.report;
  if (!report.json()) return report.text(fmt::format("{} {}  {} {} {}", at.edge, at.t, x, y, z));
  JsonWriter& json = report.write();
  json.begin_object().field("edge", at.edge).field("t", at.t).field("point", point.point);
  json.field("error", point.error).field("tangent", point.tangent).end_object();
}

std::size_t write_lattice(const Output& output, const Options& options, const CurveSet& curves,
                          std::uint32_t edge) {
  const unsigned steps = options.samples;
  for (unsigned i = 0; i <= steps; ++i) {
    const CurveParameter at{edge, i / static_cast<double>(steps)};
    write_point(output, curves, at, evaluate(curves, at));
  }
  return steps + 1;
}

// The points that are asked for, on a surface or on curves with `owners` faces, vertices or edges.
template <class Source>
ExitStatus answer(const Options& options, const Source& source, std::size_t owners,
                  const std::function<void(Report&, bool lines)>& heads) {
  const auto requests =
      options.at.empty() ? decltype(read_places("", source)){} : read_places(options.at, source);
  std::optional<ColumnTable> table;
  CommonOptions shown = options;
  if (ColumnTable::is_table(options.output)) {
    table.emplace(columns_of(source), options.output);
    shown.output.clear();
  }
  Report report("eval", shown);
  const Output output{report, table ? &*table : nullptr};
  heads(report, !table);
  if (report.json() && !table) report.write().key("points").begin_array();
  std::size_t count = requests.size();
  naming(options.mesh, [&] {
    for (const auto& at : requests) write_point(output, source, at, evaluate(source, at));
    if (!options.at.empty()) return;
    ProgressBar bar("evaluating " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    for (std::uint32_t owner = 0; owner < owners; ++owner) {
      count += write_lattice(output, options, source, owner);
      monitor.report(static_cast<double>(owner + 1) / static_cast<double>(owners));
    }
  });
  if (report.json() && !table) report.write().end_array();
  if (report.json()) report.write().field("count", count);
  if (!table) return report.finish();
  AtomicFile file(options.output);
  file.write(table->file());
  report.text(fmt::format("{}: {} limit points", options.output, count));
  return report.finish(true, {&file});
}

ExitStatus run(const Options& options) {
  ControlMesh mesh = load_mesh(options.mesh, options);
  if (asks_for_curves("eval", mesh, options.mesh, options, options.degree)) {
    const CurveSet curves = make_curves(std::move(mesh), options.mesh, curve_degree(options.degree));
    return answer(options, curves, curves.edge_count(), [&](Report& report, bool lines) {
      curve_heads(report, options.mesh, curves.degree());
      if (lines) report.text("# edge t  x y z");
    });
  }
  const Surface surface = make_surface(std::move(mesh), options.mesh, options, options.scheme);
  return answer(options, surface, surface.owner_count(), [&](Report& report, bool lines) {
    const Scheme scheme = surface.scheme();
    report.heads({options.mesh}, {name_of(scheme)});
    if (!lines) return;
    report.text(fmt::format("# {} u v{}  x y z", surface.traits().owner(),
                            surface.traits().triangular ? "" : " corner"));
  });
}

}  // namespace

Command eval_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  add_place_options(list, options->samples, options->at).help += ", 'edge t' for curves";
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  return {"eval",
          Topic::one_surface,
          "Evaluate limit points, tangents and normals",
          {"snug eval pawn.obj --samples 2", "snug eval pawn.obj --samples 8 -o points.ply",
           "echo \"0 0.25 0.5\" | snug eval pawn.obj --at - --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
