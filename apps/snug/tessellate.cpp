#include <snug/tessellate.h>

#include <fmt/core.h>
#include <support/atomic_file.h>

#include <utility>

#include "coarsen.h"
#include "common.h"
#include "length.h"
#include "numbers.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, error, max_edge, max_thickness, eye;
  std::optional<std::uint64_t> max_triangles;
  double max_angle = 0, eye_angle = 0.02;
  bool coarsen = false;
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

struct Counts {
  std::size_t vertices, triangles;
};

void write_summary(Report& report, const Options& options, const Counts& counts, const Tessellation& result) {
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("vertices", counts.vertices).field("triangles", counts.triangles);
    json.field("error_bound", result.error_bound).field("position_error", result.position_error);
    json.field("outcome", name_of(result.outcome));
  }
  if (options.output == "-") return;
  report.text(fmt::format("{}: {} vertices, {} triangles within {} of the limit surface, both ways",
                          options.output, counts.vertices, counts.triangles,
                          text_at_most(result.error_bound, true)));
  if (result.outcome == Outcome::complete) return;
  report.text(options.max_triangles && *options.max_triangles <= options.max_splits
                  ? "the error was not reached: give more --max-triangles, or a larger --error"
                  : "not all that was asked for was reached: give a larger --max-splits or --error");
}

ExitStatus run(const Options& options) {
  require_options(options);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("tessellate", to_standard_output);
  Tessellation result;
  naming(options.mesh, [&] {
    ProgressBar bar((options.coarsen ? "simplifying " : "tessellating ") + options.mesh, options.quiet);
    const TessellateOptions how = how_to(options, surface);
    const WorkMonitor monitor = bar.monitor();
    const Run run = run_of(options, monitor);
    result = options.coarsen ? coarsened(surface, how, run) : tessellate(surface, how, run);
  });
  AtomicFile file(options.output);
  const Counts counts{result.positions.size(), result.triangles.size()};
  write_facets(take_mesh(result), file, options.output, options, units_of(surface), result.normals);
  report.heads({options.mesh}, {name_of(surface.scheme())});
  write_summary(report, options, counts, result);
  return report.finish(result.outcome == Outcome::complete, {&file});
}

}  // namespace

Command tessellate_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::tessellate;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh,
           "Control mesh (OBJ, OFF, PLY, STL, USD, glTF or 3MF; - for standard input)");
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
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "At most N triangles; if more are needed, report the bound that is proved and exit with status 5")
      .formerly("--budget");
  return {"tessellate",
          Topic::files,
          "Write triangles within a proved distance of the limit surface",
          {"snug tessellate pawn.obj --error 0.1% -o pawn.ply",
           "snug tessellate pawn.obj --max-triangles 5000 -o pawn.glb"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
