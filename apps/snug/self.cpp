#include <snug/contacts.h>

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "answer_writer.h"
#include "common.h"
#include "length.h"
#include "mesh_summary.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  std::string tolerance, radius;
};

void write_text(Report& report, const SelfContact& found, std::optional<double> tolerance,
                const Surface& surface) {
  const char* const owner = surface.traits().owner();
  report.text(fmt::format("verdict   {}", name_of(found.verdict)));
  if (tolerance) {
    report.text(fmt::format("near      at most {} apart, and more than {} along the surface", *tolerance,
                            found.radius));
  }
  constexpr std::size_t max_lines = 10;
  std::size_t lines = 0, left = 0;
  std::set<std::string> vertices;
  for (const SelfContactPair& pair : found.pairs) {
    const bool undecided = pair.verdict == SelfVerdict::undecided;
    const std::string vertex = undecided ? vertex_at(surface, *pair.points[0].at) : "";
    // All that is undecided around a vertex is one place.
    if (!vertex.empty() && !vertices.insert(vertex).second) continue;
    if (lines == max_lines) {
      ++left;
      continue;
    }
    const Point3& p = pair.points[0].point;
    std::string line =
        fmt::format("{:<12}  {} {} and {}, at {} {} {}", pair.touching ? "touching" : name_of(pair.verdict),
                    owner, pair.points[0].at->owner, pair.points[1].at->owner, p.x, p.y, p.z);
    if (pair.verdict == SelfVerdict::near) line += fmt::format(", at most {} apart", pair.distance.upper);
    if (undecided)
      line += ": " + (vertex.empty() ? "pieces too near to each other to be told apart" : vertex);
    report.text(line);
    ++lines;
  }
  if (left > 0) report.text(fmt::format("... {} more; --json lists all", left));
}

ExitStatus run(const Options& options) {
  SelfContactOptions wanted;
  std::optional<Length> tolerance, radius;
  if (!options.tolerance.empty()) tolerance = parse_length(options.tolerance, "--within");
  if (!options.radius.empty()) radius = parse_length(options.radius, "--radius");
  if (radius && !tolerance) throw UsageError("--radius needs --within");
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  if (tolerance) wanted.within = tolerance->in_mesh_units(surface.size(), units_of(surface));
  if (radius) wanted.radius = radius->in_mesh_units(surface.size(), units_of(surface));
  Report report("self-contact", options);
  SelfContact found;
  {
    ProgressBar bar("looking", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(options.mesh, [&] { found = self_contact(surface, wanted, run_of(options, monitor)); });
  }
  report.heads({options.mesh}, {name_of(surface.scheme())});
  if (report.json()) {
    if (wanted.within) report.write().field("within", *wanted.within);
    write_fields(report.write(), found, std::array<PlacedSurface, 2>{surface, surface});
  }
  write_text(report, found, wanted.within, surface);
  return report.finish(found.verdict != SelfVerdict::undecided);
}

}  // namespace

Command self_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::self_contact;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_help);
  list.add(Group::own, "--within LENGTH", &options->tolerance,
           "Also decide whether points at most this far apart (mesh units, or percent of the size) are far "
           "apart "
           "along the surface")
      .formerly("--tolerance");
  list.add(Group::own, "--radius LENGTH", &options->radius,
           "Points farther apart than this along the surface are far apart; at least twice --within, default "
           "4 times");
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "Compare at most N stars and pairs of pieces")
      .formerly("--budget")
      .between(0, std::uint64_t{1} << 40);
  add_common_options(list, *options);
  return {"self-contact",
          Topic::one_surface,
          "Does a limit surface intersect itself, or come near itself?",
          {"snug self-contact pawn.obj", "snug self-contact pawn.obj --within 1%",
           "snug self-contact part.stl --sharp auto --json"},
          std::move(list),
          [options] { return run(*options); },
          "self"};
}

}  // namespace snug::command
