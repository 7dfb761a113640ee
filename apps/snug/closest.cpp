#include <snug/distance.h>

#include <cmath>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/read_file.h>
#include "column_table.h"
#include "number_rows.h"

#include "answer_writer.h"
#include "certificate_file.h"
#include "length.h"
#include "placed_pair.h"
#include "progress_bar.h"
#include "words.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, points;
  std::string precision = "0.01%";
  double relative = 0;
  bool with_sign = false;
};

std::vector<Point3> read_points(const std::string& path) {
  std::vector<Point3> points;
  for_each_row(read_file(path, stopped_by_interrupts()), path, {3}, "a line is 'x y z', three finite numbers",
               [&](std::span<const double> row) {
                 points.push_back({row[0], row[1], row[2]});
                 return is_finite(points.back());
               });
  return points;
}

// Of one point: with --signed, bounds of the signed distance too.
struct Result {
  ClosestPoint nearest;
  std::optional<SignedDistance> with_sign;
  [[nodiscard]] Outcome outcome() const { return with_sign ? with_sign->outcome : nearest.outcome; }
  [[nodiscard]] bool reached() const { return outcome() == Outcome::complete; }
};

std::vector<Result> find(const Surface& surface, std::span<const Point3> points, const Precision& wanted,
                         bool with_sign, const Run& run) {
  std::vector<Result> results;
  results.reserve(points.size());
  if (with_sign) {
    for (SignedDistance& found : signed_distance(surface, points, wanted, run)) {
      results.push_back({found.nearest, found});
    }
  } else {
    for (ClosestPoint& found : closest_point(surface, points, wanted, run)) {
      results.push_back({found, {}});
    }
  }
  return results;
}

std::string text_of_bounds(double lower, double upper) {
  const double within = (upper - lower) / 4;  // an interval that is no wider than it has to be
  const auto down = [&](double x) {
    return x < 0 ? "-" + text_at_most(-x, true, within) : text_at_most(x, false, within);
  };
  const auto up = [&](double x) {
    return x < 0 ? "-" + text_at_most(-x, false, within) : text_at_most(x, true, within);
  };
  return down(lower) + " " + up(upper);
}

void write_sign(JsonWriter& json, const SignedDistance& found) {
  write_field(json, "signed_distance", found.distance, {});
  json.key("inside");
  if (found.distance.upper < 0) {
    json.value(true);
  } else if (found.distance.lower > 0) {
    json.value(false);
  } else {
    json.null();
  }
}

void write_result(Report& report, const Surface& surface, const Result& result) {
  const ClosestPoint& near = result.nearest;
  if (!report.json()) {
    report.text(fmt::format(
        "{}  {} {} {}  {} {} {}{}",
        result.with_sign ? text_of_bounds(result.with_sign->distance.lower, result.with_sign->distance.upper)
                         : text_of_bounds(near.distance.lower, near.distance.upper),
        near.point.x, near.point.y, near.point.z, near.at->owner, near.at->u, near.at->v,
        surface.traits().triangular ? "" : fmt::format(" {}", near.at->corner)));
    return;
  }
  JsonWriter& json = report.write().begin_object();
  if (result.with_sign) write_sign(json, *result.with_sign);
  ClosestPoint shown = near;
  shown.outcome = result.outcome();
  const PlacedSurface placed(surface);
  write_fields(json, shown, {&placed, 1});
  json.end_object();
}

// Columns of a file of answers, a row a point.
ColumnTable table_of(const std::vector<Result>& results, const Surface& surface, const Options& options) {
  using Type = ColumnTable::Type;
  const bool has_corner = !surface.traits().triangular;
  std::vector<ColumnTable::Column> columns;
  for (const char* name : {"x", "y", "z", "error", "distance_lower", "distance_upper"}) {
    columns.push_back({name, Type::real});
  }
  if (options.with_sign)
    columns.insert(columns.end(), {{"signed_lower", Type::real}, {"signed_upper", Type::real}});
  columns.push_back({surface.traits().owner(), Type::integer});
  if (has_corner) columns.push_back({"corner", Type::integer});
  columns.insert(columns.end(), {{"u", Type::real}, {"v", Type::real}, {"complete", Type::flag}});
  ColumnTable table(std::move(columns), options.output);
  for (const Result& result : results) {
    const ClosestPoint& near = result.nearest;
    for (const double x :
         {near.point.x, near.point.y, near.point.z, near.error, near.distance.lower, near.distance.upper}) {
      table.add(x);
    }
    if (result.with_sign) {
      table.add(result.with_sign->distance.lower);
      table.add(result.with_sign->distance.upper);
    }
    table.add(near.at->owner);
    if (has_corner) table.add(near.at->corner);
    for (const double x : {near.at->u, near.at->v, result.reached() ? 1.0 : 0.0}) table.add(x);
  }
  return table;
}

// All answers as a document or as lines; returns whether all reached what was asked for.
bool write_results(Report& report, const Surface& surface, const std::vector<Result>& results) {
  bool reached = true;
  for (const Result& result : results) {
    write_result(report, surface, result);
    reached = reached && result.reached();
  }
  return reached;
}

ExitStatus finish_with_table(Report& report, const Options& options, const Surface& surface,
                             const std::vector<Result>& results, CertificateFile& certificate) {
  const ColumnTable table = table_of(results, surface, options);
  AtomicFile file(options.output);
  file.write(table.file());
  std::size_t missed = 0;
  for (const Result& result : results) missed += result.reached() ? 0 : 1;
  if (report.json()) report.write().field("count", results.size()).field("complete", results.size() - missed);
  report.text(fmt::format("{}: {} closest points{}", options.output, results.size(),
                          missed == 0 ? "" : fmt::format(", {} wider than asked for", missed)));
  std::vector<AtomicFile*> files{&file};
  certificate.add_to(report, files);
  return report.finish(missed == 0, files);
}

ExitStatus run(const Options& options) {
  const Length precision = parse_length(options.precision, "--absolute", true);
  const std::vector<Point3> points = read_points(options.points);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  Precision wanted;
  wanted.absolute = precision.in_mesh_units(surface.size(), units_of(surface));
  wanted.relative = options.relative;
  std::vector<Result> results;
  CertificateFile certificate(options);
  {
    ProgressBar bar("closest points", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(options.mesh, [&] {
      results = find(surface, points, wanted, options.with_sign, certificate.with(run_of(options, monitor)));
    });
  }
  const bool as_table = ColumnTable::is_table(options.output);
  CommonOptions shown = options;
  if (as_table) shown.output.clear();
  Report report("closest", shown);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  if (report.json()) report.write().field("absolute", *wanted.absolute).field("relative", *wanted.relative);
  if (as_table) return finish_with_table(report, options, surface, results, certificate);
  if (report.json()) report.write().key("results").begin_array();
  report.text(fmt::format("# {}  x y z  {} u v{}",
                          options.with_sign ? "signed distance: lower upper" : "distance: lower upper",
                          surface.traits().owner(), surface.traits().triangular ? "" : " corner"));
  const bool reached = write_results(report, surface, results);
  if (report.json()) report.write().end_array();
  std::vector<AtomicFile*> files;
  certificate.add_to(report, files);
  return report.finish(reached, files);
}

}  // namespace

Command closest_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::closest_point;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_help);
  list.add(Group::own, "--points FILE", &options->points,
           "File with one point per line, 'x y z'; text, CSV or a NumPy array (.npy); - for standard input")
      .required();
  list.add(Group::own, "--absolute LENGTH", &options->precision,
           "Largest width of a distance interval; mesh units, or percent of the mesh")
      .formerly("--precision");
  list.add(Group::own, "--relative SHARE", &options->relative, "Or this fraction of the upper bound")
      .between(0, 1);
  list.add(Group::own, "--signed", &options->with_sign,
           "Signed distances to a closed surface, negative inside; the sign is proved");
  add_certificate_option(list, *options);
  add_common_options(list, *options);
  add_bound_options(list, *options);
  return {"closest",
          Topic::one_surface,
          "Find the points of a limit surface closest to given points",
          {"snug closest bust.obj --points points.txt",
           "snug closest bust.obj --points points.npy -o closest.npy",
           "echo \"0 2 5\" | snug closest bust.obj --points -"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
