#include <snug/self.h>

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "common.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  std::string tolerance, radius;
};

void write_json(JsonWriter& json, const SelfContact& found, std::optional<double> tolerance,
                const char* owner) {
  json.field("verdict", name_of(found.verdict));
  if (tolerance) json.field("tolerance", *tolerance).field("radius", found.radius);
  json.key("pairs").begin_array();
  for (const SelfContactPair& pair : found.pairs) {
    json.begin_object().field("verdict", name_of(pair.verdict));
    json.key("at").begin_array();
    for (const SurfaceParameter& at : pair.at) {
      json.begin_object().field(owner, at.owner).field("corner", at.corner);
      json.field("u", at.u).field("v", at.v).end_object();
    }
    json.end_array().key("witness").begin_array();
    for (const Point3& p : pair.points) json.value(p);
    json.end_array().key("distance").begin_array();
    json.value(pair.distance.lower).value(pair.distance.upper).end_array().end_object();
  }
  json.end_array().key("stats").begin_object();
  json.field("stars", found.stars).field("pair_tests", found.pair_tests).field("levels", found.levels);
  json.end_object();
}

void write_text(Report& report, const SelfContact& found, std::optional<double> tolerance,
                const char* owner) {
  report.text(fmt::format("verdict   {}", name_of(found.verdict)));
  if (tolerance) {
    report.text(fmt::format("near      at most {} apart, and more than {} along the surface", *tolerance,
                            found.radius));
  }
  constexpr std::size_t max_lines = 10;
  for (std::size_t i = 0; i < std::min(max_lines, found.pairs.size()); ++i) {
    const SelfContactPair& pair = found.pairs[i];
    const Point3& p = pair.points[0];
    std::string line = fmt::format("{:<12}  {} {} and {}, at {} {} {}", name_of(pair.verdict), owner,
                                   pair.at[0].owner, pair.at[1].owner, p.x, p.y, p.z);
    if (pair.verdict == SelfVerdict::near) line += fmt::format(", at most {} apart", pair.distance.upper);
    report.text(line);
  }
  if (found.pairs.size() > max_lines) {
    report.text(fmt::format("... {} more; --json lists all", found.pairs.size() - max_lines));
  }
}

ExitStatus run(const Options& options) {
  SelfContactOptions wanted;
  wanted.budget = options.budget;
  wanted.threads = options.threads;
  std::optional<Length> tolerance, radius;
  if (!options.tolerance.empty()) tolerance = parse_length(options.tolerance, "--tolerance");
  if (!options.radius.empty()) radius = parse_length(options.radius, "--radius");
  if (radius && !tolerance) throw UsageError("--radius needs --tolerance");
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  if (tolerance) wanted.tolerance = tolerance->in_mesh_units(surface.size());
  if (radius) wanted.radius = radius->in_mesh_units(surface.size());
  Report report("self", options);
  SelfContact found;
  {
    ProgressBar bar("looking", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(options.mesh, [&] { found = self_contact(surface, wanted, monitor); });
  }
  report.heads({options.mesh}, {name_of(surface.scheme())});
  const char* const owner = surface.traits().owner();
  if (report.json()) write_json(report.write(), found, wanted.tolerance, owner);
  write_text(report, found, wanted.tolerance, owner);
  return report.finish(found.verdict != SelfVerdict::undecided);
}

}  // namespace

Command self_command() {
  auto options = std::make_shared<Options>();
  options->budget = SelfContactOptions{}.budget;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, "Control mesh (OBJ, OFF, PLY, STL, USD or glTF)");
  list.add(Group::own, "--tolerance T", &options->tolerance,
           "Also decide whether points at most T apart (mesh units, or percent of the size) are far apart "
           "along the surface");
  list.add(Group::own, "--radius R", &options->radius,
           "Points more than R apart along the surface are far apart; at least 2 T, default 4 T");
  list.add(Group::effort, "--budget N", &options->budget, "Compare at most N stars and pairs of pieces")
      .between(0, std::uint64_t{1} << 40);
  add_common_options(list, *options);
  return {
      "self",
      Topic::one_surface,
      "Does a limit surface intersect itself, or come near itself?",
      {"snug self pawn.obj", "snug self pawn.obj --tolerance 1%", "snug self part.stl --sharp auto --json"},
      std::move(list),
      [options] { return run(*options); }};
}

}  // namespace snug::command
