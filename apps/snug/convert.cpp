#include <snug/brep.h>
#include <snug/contacts.h>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/names.h>
#include <support/read_file.h>
#include <support/system_files.h>

#include <algorithm>

#include "answer_writer.h"
#include "common.h"
#include "pose.h"
#include "progress_bar.h"
#include "scene_file.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, scene, error, name, protocol = "ap242", continuity = "g0";
  double max_angle = 0;
  bool nearest_rigid = false;
};

LengthUnit unit_named(const std::string& name) {
  return name == "mm"       ? LengthUnit::millimetre
         : name == "cm"     ? LengthUnit::centimetre
         : name == "m"      ? LengthUnit::metre
         : name == "foot"   ? LengthUnit::foot
         : name == "micron" ? LengthUnit::micron
                            : LengthUnit::inch;
}

double error_of(const Options& options, const Surface& surface) {
  const Length length = parse_length(options.error.empty() ? "0.01%" : options.error, "--error");
  return length.in_mesh_units(surface.size(), metres_of(options.units));
}

std::string name_of_part(const Options& options) {
  if (!options.name.empty()) return options.name;
  const std::string& file = options.scene.empty() ? options.mesh : options.scene;
  return file == "-" ? "part" : system_files::stem_of(file);
}

std::string number_of(std::size_t count, const char* word) {
  return fmt::format("{} {}{}", count, word, count == 1 ? "" : "s");
}

// Surfaces on their way to a file, and the parts of an assembly.
struct Job {
  std::vector<std::string> meshes;  // their files
  std::vector<Surface> surfaces;
  std::vector<double> errors;
  std::vector<SelfContact> contacts;
  std::vector<StepShape> shapes;
  std::vector<StepPart> parts;
  void add(const std::string& mesh, const Surface& surface, const std::string& name) {
    meshes.push_back(mesh);
    surfaces.push_back(surface);
    shapes.push_back({name, {}});
  }
};

std::string unit_word(const Options& options) {
  return options.units == "inch" ? "in" : options.units == "foot" ? "ft" : options.units;
}

void write_fields_of(JsonWriter& json, const Job& job, std::size_t i) {
  json.field("error", job.errors[i]);
  write_fields(json, job.shapes[i].brep);
  json.field("self_contact", name_of(job.contacts[i].verdict));
}

void write_shape(Report& report, const Options& options, const std::string& name, const Brep& brep) {
  std::string shapes;
  const auto add = [&](std::size_t count, const char* word) {
    if (count > 0) shapes += (shapes.empty() ? "" : ", ") + number_of(count, word);
  };
  add(fields::solids(brep), "solid");
  add(fields::voids(brep), "void");
  add(fields::sheets(brep), "open sheet");
  const std::string unit = unit_word(options);
  report.text(fmt::format("{}: {}; {}, {} spans, in {}", name, shapes, number_of(brep.faces.size(), "face"),
                          brep.spans, unit));
  report.text(fmt::format("faces within {} {} of the limit surface and {:.1e} {} of their edges: proved",
                          text_at_most(brep.error_bound, true), unit, 1.06 * brep.gap_bound,
                          unit));  // rounded up
  if (brep.break_angle > 0)
    report.text(fmt::format("largest angle between faces measured across smooth edges: {:.3g} degrees",
                            brep.break_angle));
  if (brep.outcome == Outcome::budget_spent)
    report.text("the budget is spent: give a larger --max-splits, --error or --max-angle");
  else if (brep.outcome != Outcome::complete)
    report.text(options.max_angle > 0 && brep.break_angle > options.max_angle
                    ? "the angle was not reached: around a vertex of high valence, or a spike, faces become "
                      "flat slowly or never; "
                      "give a larger --max-angle"
                    : "the error was not reached, the least that was found is above: give a larger --error");
}

void write_summary(Report& report, const Options& options, const Job& job, std::size_t bytes) {
  if (report.json()) {
    JsonWriter& json = report.write();
    if (options.scene.empty()) {
      write_fields_of(json, job, 0);
    } else {
      json.field("parts", job.parts.size());
      json.key("shapes").begin_array();
      for (std::size_t i = 0; i < job.shapes.size(); ++i) {
        json.begin_object().field("name", job.shapes[i].name);
        write_fields_of(json, job, i);
        json.end_object();
      }
      json.end_array();
    }
    json.field("bytes", bytes).field("units", options.units);
  }
  if (options.scene.empty()) {
    write_shape(report, options, options.output, job.shapes[0].brep);
  } else {
    report.text(fmt::format("{}: {} of {}", options.output, number_of(job.parts.size(), "part"),
                            number_of(job.shapes.size(), "shape")));
    for (std::size_t i = 0; i < job.shapes.size(); ++i)
      write_shape(report, options, job.meshes[i], job.shapes[i].brep);
  }
  report.text(number_of(bytes, "byte"));
}

// The mesh, or a scene.
Job read_all(const Options& options, const WorkMonitor& monitor) {
  Job job;
  if (options.scene.empty()) {
    job.add(options.mesh, read_surface(options.mesh, options, options.scheme), name_of_part(options));
    return job;
  }
  const LoadedScene scene = load_scene(
      options.scene, options, options.nearest_rigid,
      [&](const std::string& path) { return read_file(path, monitor); }, monitor);
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    const std::string& file = scene.text.meshes[i].file;
    job.add(file, scene.surfaces[i], system_files::stem_of(file));
  }
  for (const SceneText::Part& part : scene.text.parts) job.parts.push_back({part.name, part.mesh, part.pose});
  return job;
}

// What the files state, if STEP has a word for it here; millimetres where they state nothing.
std::string units_of_files(const Job& job) {
  std::string unit;
  for (std::size_t i = 0; i < job.surfaces.size(); ++i) {
    const std::optional<double> metres = units_of(job.surfaces[i]);
    const std::string own = metres ? text_of_unit(*metres) : "mm";
    if (metres && !unit_of(*metres)) {
      throw InputError(InputProblem::refused, job.meshes[i] + " is in " + own +
                                                  ": STEP files are written in " +
                                                  listed(unit_words(), "or") + "; give --scale and --units");
    }
    if (i > 0 && own != unit) {
      throw InputError(InputProblem::refused, job.meshes[i] + " is in " + own + ", " + job.meshes[0] +
                                                  " in " + unit + ": give --units, if all are in one unit");
    }
    unit = own;
  }
  return unit;
}

constexpr double angle_of_g1 = 0.1;  // degrees

// Below this CAD programs lose their way: they take points within 1e-7 mm for one.
constexpr double least_millimetres = 1;

void note_small_parts(const Options& options, const Job& job) {
  const Notes notes = notes_for(options);
  if (!notes) return;
  for (std::size_t i = 0; i < job.surfaces.size(); ++i) {
    const double size = job.surfaces[i].size() * metres_of(options.units) * 1000;
    if (size >= least_millimetres) continue;
    notes(
        fmt::format("{} is {:.3g} mm long: CAD programs take points within 1e-7 mm for one, and Open CASCADE "
                    "finds wrong nearest points on parts so small; give --units if its numbers are not {}",
                    job.meshes[i], size, options.units));
  }
}

// A shape that meets itself is written, but not silently.
constexpr std::uint64_t most_self_tests = 200'000;

SelfContact self_contact_of(const Options& options, const std::string& mesh, const Surface& surface,
                            Run run) {
  run.max_splits = most_self_tests;
  SelfContact found = self_contact(surface, {}, run);
  const Notes notes = notes_for(options);
  if (!notes || found.verdict == SelfVerdict::clear) return found;
  if (found.verdict == SelfVerdict::undecided) {
    notes(mesh + ": whether it meets itself was not decided; self-contact says where");
    return found;
  }
  const Point3& at = found.pairs.front().points[0].point;
  notes(fmt::format(
      "{} meets itself, near {:.6g} {:.6g} {:.6g}: CAD programs may fail on such a shape; envelope makes a "
      "mesh around it that does not",
      mesh, at.x, at.y, at.z));
  return found;
}

ExitStatus run(Options options) {
  if (options.output.empty()) throw UsageError("convert: -o FILE.step is missing: where the solid goes");
  if (options.json && options.output == "-")
    throw UsageError("convert: --json and -o - both want standard output");
  if (!options.error.empty()) static_cast<void>(parse_length(options.error, "--error"));
  if (options.continuity == "g1" && options.max_angle == 0) options.max_angle = angle_of_g1;
  Job job = read_all(options, stopped_by_interrupts());
  options.units = units_of_files(job);
  note_small_parts(options, job);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("convert", to_standard_output);
  bool complete = true;
  std::vector<std::string> schemes;
  std::string text;
  {
    ProgressBar bar("converting " + (options.scene.empty() ? options.mesh : options.scene), options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const Run run = run_of(options, monitor);
    for (std::size_t i = 0; i < job.shapes.size(); ++i) {
      const Surface& surface = job.surfaces[i];
      naming(job.meshes[i], [&] {
        BrepOptions how{error_of(options, surface), {}};
        job.errors.push_back(*how.error);
        if (options.max_angle > 0) how.max_angle = options.max_angle;
        job.shapes[i].brep = to_brep(surface, how, run);
        job.contacts.push_back(self_contact_of(options, job.meshes[i], surface, run));
      });
      complete = complete && job.shapes[i].brep.outcome == Outcome::complete;
      schemes.emplace_back(name_of(surface.scheme()));
    }
    const StepOptions how{name_of_part(options), unit_named(options.units), options.protocol == "ap214"};
    text = options.scene.empty() ? format_step(job.shapes[0].brep, how, run)
                                 : format_step(job.shapes, job.parts, how, run);
  }
  AtomicFile file(options.output);
  file.write(text);
  report.heads(job.meshes, schemes);
  if (options.output != "-" || report.json()) write_summary(report, options, job, text.size());
  return report.finish(complete, {&file});
}

}  // namespace

Command convert_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::brep;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help).unless("--scene");
  list.add(Group::own, "--scene FILE", &options->scene,
           "A scene file instead: an assembly, in which its parts are placed");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance between limit surface and faces; mesh units, percent, or with a unit, such as "
           "0.01mm "
           "(default 0.01%)")
      .formerly("--tolerance");
  list.add(Group::own, "--max-angle DEGREES", &options->max_angle,
           "Largest angle between faces across edges where the surface is smooth; 0 for any")
      .between(0, 90);
  list.add(Group::own, "--continuity NAME", &options->continuity,
           "g1: faces meet at 0.1 degrees at most where the surface is smooth, unless --max-angle says "
           "another "
           "angle; g0: at any angle")
      .one_of({"g0", "g1"});
  list.add(Group::own, "--name NAME", &options->name, "Name of the part or assembly; default: the file's");
  list.add(Group::own, "--protocol NAME", &options->protocol, "Application protocol of the STEP file")
      .one_of({"ap242", "ap214"});
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--scene");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "At most N spans, polynomial pieces of faces; if more are needed, write what is proved and exit "
           "with status 5");
  return {"convert",
          Topic::files,
          "Write a STEP file of B-spline faces within a proved distance of the limit surface",
          {"snug convert bracket.obj -o bracket.step --error 0.01mm",
           "snug convert --scene assembly.json -o assembly.step"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
