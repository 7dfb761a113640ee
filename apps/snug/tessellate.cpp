#include <snug/tessellate.h>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/read_file.h>

#include <utility>

#include "coarsen.h"
#include "common.h"
#include "length.h"
#include "numbers.h"
#include "pose.h"
#include "progress_bar.h"
#include "scene_file.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, scene, error, max_edge, max_thickness, eye;
  std::optional<std::uint64_t> max_triangles;
  double max_angle = 0, eye_angle = 0.02;
  bool coarsen = false, nearest_rigid = false;
};

std::optional<double> length_of(const std::string& text, const char* option, const Surface& surface) {
  if (text.empty()) return {};
  return parse_length(text, option).in_mesh_units(surface.size(), units_of(surface));
}

void require_options(const Options& options) {
  if (options.output.empty()) throw UsageError("tessellate: -o FILE is missing: where the triangles go");
  if (options.json && options.output == "-") {
    throw UsageError("tessellate: --json and -o - both want standard output");
  }
  if (!options.scene.empty() && !options.output.ends_with(".3mf")) {
    throw UsageError(
        "tessellate: parts of a scene in their places go to -o FILE.3mf; envelope makes one mesh around "
        "them");
  }
  const bool other_goal = !options.max_edge.empty() || !options.max_thickness.empty() ||
                          !options.eye.empty() || options.max_triangles || options.max_angle > 0;
  if (options.error.empty() && !other_goal) {
    throw UsageError(
        "tessellate: give --error, --max-triangles, --max-edge, --max-angle, --max-thickness or --eye");
  }
  if (options.coarsen && (options.error.empty() || other_goal)) {
    throw UsageError("tessellate: --coarsen goes with --error, and no other goal");
  }
  if (!options.error.empty()) static_cast<void>(parse_length(options.error, "--error"));
  if (!options.max_edge.empty()) static_cast<void>(parse_length(options.max_edge, "--max-edge"));
  if (!options.max_thickness.empty())
    static_cast<void>(parse_length(options.max_thickness, "--max-thickness"));
  if (!options.eye.empty() && !parse_numbers<3>(options.eye)) {
    throw UsageError("--eye: '" + options.eye + "' is not a point; give three numbers");
  }
}

TessellateOptions how_to(const Options& options, const Surface& surface) {
  TessellateOptions how;
  how.error = length_of(options.error, "--error", surface);
  how.max_edge = length_of(options.max_edge, "--max-edge", surface);
  how.max_thickness = length_of(options.max_thickness, "--max-thickness", surface);
  if (!options.eye.empty()) {
    const auto [x, y, z] = *parse_numbers<3>(options.eye);
    how.view = {{x, y, z}, options.eye_angle};
  }
  if (options.max_angle > 0) how.max_angle = options.max_angle;
  how.max_triangles = options.max_triangles;
  how.single_precision = format_of(options.output).floats;
  how.normals = format_of(options.output).normals;
  return how;
}

// Takes all but the normals: a file is made in memory, and there need not be more beside it.
ControlMesh take_mesh(Tessellation& tessellation) {
  ControlMesh mesh;
  mesh.points = std::move(tessellation.positions);
  tessellation.parameters = {};
  tessellation.owners = {};
  const std::vector<std::array<std::uint32_t, 3>> triangles = std::exchange(tessellation.triangles, {});
  mesh.face_vertices.reserve(3 * triangles.size());
  mesh.face_offsets.reserve(triangles.size() + 1);
  for (const auto& [a, b, c] : triangles) mesh.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
  return mesh;
}

// A mesh and its triangles.
struct Shape {
  std::string mesh;  // its file
  Surface surface;
  std::size_t vertices = 0, triangles = 0;
  Tessellation result{};  // without its triangles
};

// A mesh, or a scene.
struct Job {
  std::vector<Shape> shapes;
  MeshAssembly written;
  std::optional<double> units;
};

Job read_all(const Options& options, const WorkMonitor& monitor) {
  Job job;
  if (options.scene.empty()) {
    job.shapes.push_back({options.mesh, read_surface(options.mesh, options, options.scheme)});
    job.units = units_of(job.shapes[0].surface);
    return job;
  }
  const LoadedScene scene = load_scene(
      options.scene, options, options.nearest_rigid,
      [&](const std::string& path) { return read_file(path, monitor); }, monitor);
  std::vector<std::string> files;
  for (std::size_t i = 0; i < scene.surfaces.size(); ++i) {
    files.push_back(scene.text.meshes[i].file);
    job.shapes.push_back({files.back(), scene.surfaces[i]});
  }
  for (const SceneText::Part& part : scene.text.parts)
    job.written.parts.push_back({part.name, part.mesh, part.pose});
  job.units = common_units(scene.surfaces, files);
  return job;
}

void tessellate_shape(const Options& options, Job& job, Shape& shape) {
  naming(shape.mesh, [&] {
    ProgressBar bar((options.coarsen ? "simplifying " : "tessellating ") + shape.mesh, options.quiet);
    const TessellateOptions how = how_to(options, shape.surface);
    const WorkMonitor monitor = bar.monitor();
    const Run run = run_of(options, monitor);
    shape.result = options.coarsen ? coarsened(shape.surface, how, run) : tessellate(shape.surface, how, run);
  });
  shape.vertices = shape.result.positions.size();
  shape.triangles = shape.result.triangles.size();
  ControlMesh mesh = take_mesh(shape.result);
  if (!options.scene.empty()) mesh.tags.scheme = Scheme::flat;
  mesh.metres_per_unit = job.units;
  job.written.meshes.push_back(std::move(mesh));
}

void write_fields_of(JsonWriter& json, const Shape& shape) {
  json.field("vertices", shape.vertices).field("triangles", shape.triangles);
  json.field("error_bound", shape.result.error_bound).field("position_error", shape.result.position_error);
  json.field("outcome", name_of(shape.result.outcome));
}

void write_shape(Report& report, const Options& options, const std::string& name, const Shape& shape) {
  report.text(fmt::format("{}: {} vertices, {} triangles within {} of the limit surface, both ways", name,
                          shape.vertices, shape.triangles, text_at_most(shape.result.error_bound, true)));
  if (shape.result.outcome == Outcome::complete) return;
  report.text(options.max_triangles && *options.max_triangles <= options.max_splits
                  ? "the error was not reached: give more --max-triangles, or a larger --error"
                  : "not all that was asked for was reached: give a larger --max-splits or --error");
}

void write_summary(Report& report, const Options& options, const Job& job) {
  if (options.scene.empty()) {
    if (report.json()) write_fields_of(report.write(), job.shapes[0]);
    if (options.output != "-") write_shape(report, options, options.output, job.shapes[0]);
    return;
  }
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("scene", options.scene).field("parts", job.written.parts.size());
    json.key("shapes").begin_array();
    for (const Shape& shape : job.shapes) {
      json.begin_object().field("name", shape.mesh);
      write_fields_of(json, shape);
      json.end_object();
    }
    json.end_array();
  }
  report.text(
      fmt::format("{}: {} parts of {} meshes", options.output, job.written.parts.size(), job.shapes.size()));
  for (const Shape& shape : job.shapes) write_shape(report, options, shape.mesh, shape);
}

ExitStatus run(const Options& options) {
  require_options(options);
  Job job = read_all(options, stopped_by_interrupts());
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("tessellate", to_standard_output);
  std::vector<std::string> meshes, schemes;
  bool complete = true;
  for (Shape& shape : job.shapes) {
    tessellate_shape(options, job, shape);
    meshes.push_back(shape.mesh);
    schemes.emplace_back(name_of(shape.surface.scheme()));
    complete = complete && shape.result.outcome == Outcome::complete;
  }
  AtomicFile file(options.output);
  if (options.scene.empty()) {
    write_facets(std::move(job.written.meshes[0]), file, options.output, options, job.units,
                 job.shapes[0].result.normals);
  } else {
    file.write(format_assembly(job.written, options.output, {.notes = notes_for(options)}),
               stopped_by_interrupts());
  }
  report.heads(meshes, schemes);
  write_summary(report, options, job);
  return report.finish(complete, {&file});
}

}  // namespace

Command tessellate_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::tessellate;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help).unless("--scene");
  list.add(Group::own, "--scene FILE", &options->scene,
           "A scene file instead: its parts in their places, to a 3MF file");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Largest distance between limit surface and triangles, either way; mesh units or percent, such as "
           "0.1%")
      .formerly("--tolerance");
  list.add(Group::own, "--max-triangles N", &options->max_triangles,
           "Use at most N triangles, with the smallest error found, but not below --error");
  list.add(Group::own, "--max-edge LENGTH", &options->max_edge, "Longest edge; mesh units or percent");
  list.add(Group::own, "--max-angle DEGREES", &options->max_angle,
           "Largest angle between the limit normals at corners of a triangle; 0 for any")
      .between(0, 180);
  list.add(Group::own, "--max-thickness LENGTH", &options->max_thickness,
           "Longest side of the box of a piece's interval triangle, the dissertation's criterion");
  list.add(Group::own, "--eye \"X Y Z\"", &options->eye,
           "Eye point, from which no error subtends more than --eye-angle; mesh units");
  list.add(Group::own, "--eye-angle DEGREES", &options->eye_angle,
           "Largest visible error in degrees: field of view / pixels")
      .between(1e-9, 45);
  list.add(Group::own, "--coarsen", &options->coarsen,
           "Allow fewer triangles than faces: simplify, then prove that the result is within the error");
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--scene");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "At most N triangles; if more are needed, report the bound that is proved and exit with status 5")
      .formerly("--budget");
  return {"tessellate",
          Topic::files,
          "Write triangles within a proved distance of the limit surface",
          {"snug tessellate pawn.obj --error 0.1% -o pawn.ply",
           "snug tessellate pawn.obj --max-triangles 5000 -o pawn.glb",
           "snug tessellate --scene assembly.json --error 0.01mm -o assembly.3mf"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
