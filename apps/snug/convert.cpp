#include <snug/brep.h>

#include <fmt/core.h>
#include <support/atomic_file.h>

#include <algorithm>
#include <filesystem>

#include "answer_writer.h"
#include "common.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, error, name, units = "mm", protocol = "ap242";
  double max_angle = 0;
};

LengthUnit unit_named(const std::string& name) {
  return name == "mm"   ? LengthUnit::millimetre
         : name == "cm" ? LengthUnit::centimetre
         : name == "m"  ? LengthUnit::metre
                        : LengthUnit::inch;
}

double error_of(const Options& options, const Surface& surface) {
  const Length length = parse_length(options.error.empty() ? "0.01%" : options.error, "--error");
  return length.in_mesh_units(surface.size(), options.units);
}

std::string name_of_part(const Options& options) {
  if (!options.name.empty()) return options.name;
  return options.mesh == "-" ? "part" : std::filesystem::path(options.mesh).stem().string();
}

std::string number_of(std::size_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

void write_summary(Report& report, const Options& options, double error, const Brep& brep,
                   std::size_t bytes) {
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("error", error);
    write_fields(json, brep);
    json.field("bytes", bytes).field("units", options.units);
  }
  std::string shapes;
  const auto add = [&](std::size_t count, const char* word) {
    if (count > 0) shapes += (shapes.empty() ? "" : ", ") + number_of(count, word);
  };
  add(fields::solids(brep), "solid");
  add(fields::voids(brep), "void");
  add(fields::sheets(brep), "open sheet");
  const std::string unit = options.units == "inch" ? "in" : options.units;
  report.text(fmt::format("{}: {}; {}, {} spans, {} bytes, in {}", options.output, shapes,
                          number_of(brep.faces.size(), "B-spline face"), brep.spans, bytes, unit));
  report.text(fmt::format("faces within {} {} of the limit surface and {:.1e} {} of their edges: proved",
                          text_at_most(brep.error_bound, true), unit, 1.06 * brep.gap_bound,
                          unit));  // rounded up
  if (brep.break_angle > 0)
    report.text(fmt::format("largest angle between faces measured across smooth edges: {:.3g} degrees",
                            brep.break_angle));
  if (brep.outcome == Outcome::budget_spent)
    report.text("the budget is spent: give a larger --max-splits, --error or --max-angle");
  else if (brep.outcome != Outcome::complete)
    report.text("the error or angle was not reached: give a larger --error or --max-angle");
}

ExitStatus run(const Options& options) {
  if (options.output.empty()) throw UsageError("convert: -o FILE.step is missing: where the solid goes");
  if (options.json && options.output == "-")
    throw UsageError("convert: --json and -o - both want standard output");
  if (!options.error.empty()) static_cast<void>(parse_length(options.error, "--error"));
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("convert", to_standard_output);
  Brep brep;
  double error = 0;
  naming(options.mesh, [&] {
    error = error_of(options, surface);
    ProgressBar bar("converting " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    BrepOptions how{error, {}};
    if (options.max_angle > 0) how.max_angle = options.max_angle;
    brep = to_brep(surface, how, run_of(options, monitor));
  });
  AtomicFile file(options.output);
  const std::string text =
      format_step(brep, {name_of_part(options), unit_named(options.units), options.protocol == "ap214"});
  file.write(text);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  if (options.output != "-" || report.json()) write_summary(report, options, error, brep, text.size());
  return report.finish(brep.outcome == Outcome::complete, {&file});
}

}  // namespace

Command convert_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::brep;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh (OBJ, OFF, PLY, USD or glTF; - for standard input)");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance between limit surface and faces; mesh units, percent, or with a unit, such as "
           "0.01mm "
           "(default 0.01%)");
  list.add(Group::own, "--max-angle DEGREES", &options->max_angle,
           "Largest angle between faces across edges where the surface is smooth; 0 for any")
      .between(0, 90);
  list.add(Group::own, "--units UNIT", &options->units, "Units of the mesh")
      .one_of({"mm", "cm", "m", "inch"});
  list.add(Group::own, "--name NAME", &options->name, "Name of the part; default: the file's");
  list.add(Group::own, "--protocol NAME", &options->protocol, "Application protocol of the STEP file")
      .one_of({"ap242", "ap214"});
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "At most N spans, polynomial pieces of faces; if more are needed, write what is proved and exit "
           "with status 5");
  return {"convert",
          Topic::files,
          "Write a STEP file of B-spline faces within a proved distance of the limit surface",
          {"snug convert bracket.obj -o bracket.step --error 0.01mm"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
