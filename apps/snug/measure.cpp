#include <snug/measure.h>

#include <fmt/core.h>

#include "answer_writer.h"
#include "common.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  std::string precision = "0.01%";
};

// A share of what is measured: 0.0001 or 0.01%.
double relative_precision(const std::string& text) {
  const Length share = parse_length(text, "--relative", true);
  return share.percent ? share.number / 100 : share.number;
}

std::string text_of(const Interval& x) { return fmt::format("{} to {}", x.lower, x.upper); }

void write_text(Report& report, const Measures& found, const std::optional<std::string>& open) {
  report.text("area      " + text_of(found.area));
  if (open) {
    report.text("volume    none: " + *open);
    return;
  }
  report.text("volume    " + text_of(*found.volume));
  if (!found.centroid) {
    report.text("centroid  none: the volume may be 0");
    return;
  }
  constexpr const char* axes[] = {"x", "y", "z"};
  constexpr const char* products[] = {"xx", "yy", "zz", "xy", "yz", "zx"};
  for (std::size_t a = 0; a < 3; ++a) {
    report.text(fmt::format("centroid  {}   {}", axes[a], text_of((*found.centroid)[a])));
  }
  for (std::size_t m = 0; m < 6; ++m) {
    report.text(fmt::format("inertia   {}  {}", products[m], text_of((*found.inertia)[m])));
  }
}

ExitStatus run(const Options& options) {
  MeasureOptions wanted;
  wanted.relative = relative_precision(options.precision);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  Report report("measure", options);
  Measures found;
  {
    ProgressBar bar("measuring", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    naming(options.mesh, [&] { found = measure(surface, wanted, run_of(options, monitor)); });
  }
  report.heads({options.mesh}, {name_of(surface.scheme())});
  if (report.json()) write_fields(report.write().field("relative", *wanted.relative), found);
  write_text(report, found, surface.open_reason());
  if (found.outcome != Outcome::complete) {
    report.text(found.outcome == Outcome::budget_spent
                    ? "the precision was not reached; give a larger --max-splits or --relative"
                    : "the precision was not reached: rounding is in the way; give a larger --relative");
  }
  return report.finish(found.outcome == Outcome::complete);
}

}  // namespace

Command measure_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::measure;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_help);
  list.add(Group::own, "--relative SHARE", &options->precision,
           "Largest relative width of an interval: 0.0001 or 0.01%")
      .formerly("--precision");
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "Split at most N pieces, divided evenly among patches")
      .formerly("--budget")
      .between(0, std::uint64_t{1} << 40);
  add_common_options(list, *options);
  return {"measure",
          Topic::one_surface,
          "Bound the area, volume, centroid and inertia of a limit surface",
          {"snug measure pawn.obj", "snug measure part.stl --sharp auto --relative 1e-6 --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
