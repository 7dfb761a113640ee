#include "common.h"

#include <algorithm>
#include <mutex>
#include <unordered_set>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/names.h>
#include <support/parallel.h>
#include "column_table.h"

#include "curve.h"
#include "mesh_reading.h"
#include "messages.h"
#include "progress_bar.h"
#include "version.h"

namespace snug::command {
namespace {

constexpr auto boundary_rules =
    std::to_array<Named<BoundaryRule>>({{"none", BoundaryRule::none},
                                        {"edge-only", BoundaryRule::edge_only},
                                        {"edge-and-corner", BoundaryRule::edge_and_corner}});

}  // namespace

void require_output(const std::string& command, const std::string& output) {
  if (output.empty() || output == "-") return;
  if (command == "subdivide" || command == "tessellate" || command == "envelope" || command == "fit") {
    static_cast<void>(format_of(output));
  } else if (command == "convert") {
    std::string name = output;
    std::transform(name.begin(), name.end(), name.begin(), lower_case);
    if (!name.ends_with(".step") && !name.ends_with(".stp")) {
      throw UsageError("-o " + output + ": convert writes STEP; give a file that ends in .step or .stp");
    }
  } else if (command == "view") {
    if (!output.ends_with(".html")) {
      throw UsageError("-o " + output + ": view writes a page; give a file that ends in .html");
    }
  } else if (command == "closest" || command == "eval") {
    if (!output.ends_with(".json") && !ColumnTable::is_table(output)) {
      throw UsageError("-o " + output + ": " + command +
                       " writes JSON or a table; give a file that ends in .json, .npy, .ply or .csv");
    }
  } else if (command != "render" && !output.ends_with(".json")) {
    throw UsageError("-o " + output + ": " + command + " writes JSON; give a file that ends in .json");
  }
  require_writable(output);
}

Option& add_scheme_option(OptionList& list, const std::string& name, std::string& scheme,
                          const std::string& help) {
  Option& option = list.add(Group::mesh, name + " NAME", &scheme, help).one_of({"auto"});
  for (const Scheme known : all_schemes) {
    const SchemeTraits& traits = traits_of(known);
    option.choices.emplace_back(traits.name);
    for (const char* other : traits.other_names) option.alias(other, traits.name);
  }
  return option;
}

void add_common_options(OptionList& list, CommonOptions& options) {
  Option& scheme = add_scheme_option(list, "--scheme", options.scheme,
                                     "Subdivision scheme; auto: curve if the file has only polylines, flat "
                                     "for STL, glTF and 3MF, the file's own "
                                     "if it names one, loop if all faces are triangles, otherwise catmark");
  scheme.choices.emplace_back("curve");
  list.add(Group::mesh, "--boundary RULE", &options.boundary,
           "Boundary rule; default: the file's tag, else edge-and-corner")
      .one_of(all_names(boundary_rules))
      .alias("vtx-boundary-edge-and-corner", "edge-and-corner")
      .alias("vtx-boundary-edge-only", "edge-only")
      .alias("vtx-boundary-none", "none");
  list.add(
      Group::mesh, "--weld LENGTH", &options.weld,
      "Merge vertices within this distance; mesh units, or percent of the mesh (0.001%); 0: equal ones only");
  list.add(Group::mesh, "--sharp ANGLE", &options.sharp,
           "For parts from CAD: edges whose face normals differ by more than ANGLE degrees stay sharp, and "
           "flat regions stay flat; auto: 30");
  list.add(Group::mesh, "--scale FACTOR", &options.scale,
           "Multiply coordinates by this, before anything else")
      .between(1e-100, 1e100);
  list.add(Group::mesh, "--units UNIT", &options.units,
           "What the coordinates' units are, after --scale; default: what the file says (USD, 3MF, glTF: m)")
      .one_of(unit_words());
  add_output_options(list, options);
}

void add_output_options(OptionList& list, CommonOptions& options) {
  list.add(Group::output, "--json", &options.json, "Print one JSON document");
  list.add(Group::output, "-o FILE", &options.output,
           "Output file: JSON (.json), a table of points (.npy, .ply, .csv), the mesh or picture; - for "
           "standard output");
  list.add(Group::output, "--quiet", &options.quiet, "No progress and no notes on standard error");
  list.add(Group::effort, "--threads N", &options.threads,
           "Threads, up to 1024; 0: all cores. Results do not depend on threads")
      .between(0, 1024);
}

std::array<Option*, 2> add_bound_options(OptionList& list, CommonOptions& options) {
  Option& budget = list.add(Group::effort, "--max-splits N", &options.max_splits,
                            "Split at most N patches, then report the bounds reached")
                       .formerly("--budget")
                       .between(0, std::uint64_t{1} << 40);
  Option& bounds = list.add(Group::research, "--bounds WHAT", &options.bounds,
                            "How patches are bounded: by bounding rows, or by the dissertation's tables")
                       .one_of({"rows", "table"});
  return {&budget, &bounds};
}

Scheme choose_scheme(const std::string& name, const ControlMesh& mesh) {
  return scheme_named(name).value_or(natural_scheme(mesh));
}

SurfaceOptions surface_options(const CommonOptions& options, const std::string& scheme,
                               const ControlMesh& mesh) {
  SurfaceOptions result;
  result.scheme = choose_scheme(scheme, mesh);
  const SchemeTraits& traits = traits_of(*result.scheme);
  if (!options.sharp.empty() && !traits.creases) {
    throw UsageError(std::string("--sharp: ") + traits.name +
                     " has no creases; give --scheme loop or catmark");
  }
  if (!options.boundary.empty() && traits.dual) {
    throw UsageError(std::string("--boundary: ") + traits.name +
                     " has no patches at boundaries under any rule; leave it out");
  }
  if (!options.boundary.empty()) result.boundary = value_in(boundary_rules, options.boundary);
  result.bounds = bound_method(options);
  return result;
}

Run run_of(const CommonOptions& options, const WorkMonitor& monitor, Workspace* workspace) {
  return {.threads = options.threads,
          .monitor = &monitor,
          .workspace = workspace,
          .max_splits = options.max_splits};
}

Notes notes_for(const CommonOptions& options) {
  if (options.quiet) return {};
  return [](const std::string& line) {
    // A file that is read twice has the same notes twice.
    static std::mutex mutex;
    static std::unordered_set<std::string> reported;
    const std::lock_guard lock(mutex);
    if (reported.insert(line).second) print_message("note: " + line);
  };
}

namespace {

// A mesh that has been read and welded, sharpened as the options say.
ControlMesh prepared(ControlMesh mesh, const std::string& path, const CommonOptions& options) {
  set_units(mesh, path, options);
  note_coincidences(mesh, path, options);
  if (const auto sharp = sharp_angle(options)) sharpen_mesh(mesh, path, *sharp, options);
  return mesh;
}

}  // namespace

ControlMesh load_mesh(const std::string& path, const CommonOptions& options) {
  static_cast<void>(weld_distance(options));  // what is wrong with options comes before any file
  static_cast<void>(sharp_angle(options));
  ProgressBar bar("reading " + path, options.quiet);
  const WorkMonitor monitor = bar.monitor();
  const ReadOptions reading{weld_distance(options), notes_for(options), {}};
  return prepared(read_mesh(path, reading, {.monitor = &monitor}), path, options);
}

ControlMesh mesh_of(std::string_view bytes, const std::string& path, const CommonOptions& options,
                    OtherFile other_file) {
  const ReadOptions reading{weld_distance(options), notes_for(options), std::move(other_file)};
  return prepared(parse_mesh(bytes, path, reading), path, options);
}

MeshAssembly assembly_of(std::string_view bytes, const std::string& path, const CommonOptions& options,
                         OtherFile other_file) {
  const ReadOptions reading{weld_distance(options), notes_for(options), std::move(other_file)};
  MeshAssembly assembly = parse_assembly(bytes, path, reading);
  for (ControlMesh& mesh : assembly.meshes) mesh = prepared(std::move(mesh), path, options);
  return assembly;
}

void naming(const std::string& path, const std::function<void()>& work) {
  try {
    work();
  } catch (const InputError& error) {
    throw InputError(error.problem(), path + ": " + error.what());
  }
}

Surface read_surface(const std::string& path, const CommonOptions& options, const std::string& scheme) {
  return make_surface(load_mesh(path, options), path, options, scheme);
}

Surface make_surface(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                     const std::string& scheme) {
  refuse_curves(mesh, scheme, path);
  std::optional<Surface> surface;
  naming(path, [&] {
    const SurfaceOptions how = surface_options(options, scheme, mesh);
    ProgressBar bar("preparing " + path, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    surface.emplace(std::move(mesh), how, run_of(options, monitor));
  });
  note_smoothing(*surface, path, options, scheme);
  return *surface;
}

std::optional<double> units_of(const Surface& surface) { return surface.mesh().metres_per_unit; }

std::optional<double> common_units(std::span<const std::optional<double>> units,
                                   std::span<const std::string> names) {
  std::optional<std::size_t> known;
  bool all = true;
  for (std::size_t i = 0; i < units.size(); ++i) {
    all = all && units[i];
    if (!units[i]) continue;
    if (known && *units[i] != *units[*known]) {
      throw InputError(InputProblem::refused,
                       names[*known] + " is in " + text_of_unit(*units[*known]) + ", " + names[i] + " in " +
                           text_of_unit(*units[i]) +
                           ": bring both to one unit, such as by --scale-b 25.4 --units mm, or say by "
                           "--units that they have it");
    }
    known = i;
  }
  return all && known ? units[*known] : std::nullopt;
}

std::optional<double> common_units(std::span<const Surface> surfaces, std::span<const std::string> names) {
  std::vector<std::optional<double>> units;
  for (const Surface& surface : surfaces) units.push_back(units_of(surface));
  return common_units(units, names);
}

void require_closed(const Surface& surface) {
  if (const auto reason = surface.open_reason()) refuse_open(*reason);
}

void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path,
                const CommonOptions& options, std::span<const Vector3> normals) {
  file.write(format_mesh(mesh, path, {.normals = normals, .notes = notes_for(options)}),
             stopped_by_interrupts());
}

void write_facets(ControlMesh mesh, AtomicFile& file, const std::string& path, const CommonOptions& options,
                  std::optional<double> units, std::span<const Vector3> normals) {
  mesh.metres_per_unit = units;
  if (format_of(path).scheme) mesh.tags.scheme = Scheme::flat;
  write_mesh(mesh, file, path, options, normals);
}

BoundMethod bound_method(const CommonOptions& options) {
  return options.bounds == "table" ? BoundMethod::table : BoundMethod::rows;
}

struct Report::Target {
  explicit Target(const std::string& path) : file(path) {}
  AtomicFile file;
};

Report::Report(const char* command, const CommonOptions& options)
    : notes_(notes_for(options)), start_(std::chrono::steady_clock::now()) {
  const std::string& output = options.output;
  const std::string target = output.empty() && options.json ? "-" : output;
  if (!options.json && target != "-") text_ = std::make_unique<Target>("-");
  if (target.empty()) return;
  target_ = std::make_unique<Target>(target);
  writer_ = std::make_unique<JsonWriter>([this](std::string_view text) { target_->file.write(text); });
  writer_->begin_object().field("command", command).field("version", version_number);
}

Report::~Report() = default;

void Report::heads(const std::vector<std::string>& meshes, const std::vector<std::string>& schemes) {
  if (!writer_) return;
  const auto one_or_list = [&](const char* key, const std::vector<std::string>& values) {
    writer_->key(key);
    if (values.size() == 1) {
      writer_->value(values[0]);
      return;
    }
    writer_->begin_array();
    for (const std::string& value : values) writer_->value(value);
    writer_->end_array();
  };
  one_or_list("mesh", meshes);
  one_or_list("scheme", schemes);
}

void Report::text(const std::string& line) {
  if (text_) text_->file.write(one_line(line) + "\n");
}

void Report::flush() {
  if (text_) text_->file.send();
  if (!writer_) return;
  writer_->flush();
  target_->file.send();
}

ExitStatus Report::finish(bool reached, const std::vector<AtomicFile*>& others) {
  stopped_by_interrupts().checkpoint();
  if (writer_) {
    writer_->field("seconds",
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
    writer_->end_object().finish();
  }
  if (notes_ && threads_were_refused()) {
    notes_("the system refused to start threads: fewer did the work, and it took longer");
  }
  // Steps that may fail come before any file is put in its place.
  std::vector<AtomicFile*> files;
  for (Target* target : {text_.get(), target_.get()}) {
    if (target) files.push_back(&target->file);
  }
  files.insert(files.end(), others.begin(), others.end());
  for (AtomicFile* file : files) file->complete();
  for (AtomicFile* file : files) file->commit();
  return reached ? ExitStatus::answered : ExitStatus::not_reached;
}

}  // namespace snug::command
