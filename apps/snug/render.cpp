#include <picture/render.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/core.h>
#include <snug/base/parallel.h>
#include <snug/geometry/direction.h>
#include <snug/io/atomic_file.h>
#include <snug/io/number.h>

#include "common.h"
#include "numbers.h"
#include "pose.h"
#include "progress_bar.h"
#include "scene_builder.h"

namespace snug::command {
namespace {

// Edges of surface triangles on the picture, in pixels: at most this in nine faces of ten, and in the rest;
// unless there would be too many triangles.
constexpr double usual_edge = 3, longest_edge = 6;
constexpr double most_surface_triangles = 2e6;
constexpr std::uint64_t most_enclosures = 200'000;
constexpr int largest_side = 16'384;
// A three-quarter view from above, of models whose front is towards +z.
constexpr Vector3 default_view{-0.55, -0.35, -0.85};
constexpr Vector3 default_up{0, 1, 0};

struct Options : CommonOptions {
  std::vector<std::string> meshes, poses, witnesses;
  bool nearest_rigid = false;
  std::string size = "1000x1000", view, up;
  int samples = 3;
  bool cage = false, enclosures = false;
  std::string tolerance;
  unsigned level = 0;
};

struct Size {
  int width, height;
};

Size parse_size(const std::string& text) {
  const auto side = [&](std::string_view word) {
    const auto number = parse_integer(word);
    if (!number || *number < 1 || *number > largest_side) {
      throw UsageError(
          fmt::format("--size: '{}' is not WxH or one number, in pixels from 1 to {}", text, largest_side));
    }
    return static_cast<int>(*number);
  };
  const auto by = text.find('x');
  if (by == std::string::npos) return {side(text), side(text)};
  const std::string_view whole = text;
  return {side(whole.substr(0, by)), side(whole.substr(by + 1))};
}

// Three numbers, scaled to a direction of length 1.
Vector3 parse_direction(const std::string& text, const std::string& option) {
  const auto numbers = parse_numbers<3>(text);
  const Vector3 given = numbers ? Vector3{(*numbers)[0], (*numbers)[1], (*numbers)[2]} : Vector3{};
  if (max_abs(given) == 0) {
    throw UsageError(option + ": '" + text + "' is not a direction; give three numbers, not all zero");
  }
  return normalized(given);
}

// Two points, one on each surface.
using Witness = std::array<Point3, 2>;

Witness parse_witness(const std::string& text) {
  const auto numbers = parse_numbers<6>(text);
  if (!numbers) {
    throw UsageError("--witness: '" + text +
                     "' is not two points; give six numbers, as collide and distance print them");
  }
  const auto& n = *numbers;
  return {Point3{n[0], n[1], n[2]}, Point3{n[3], n[4], n[5]}};
}

struct View {
  Vector3 direction, up;
};

View choose_view(const Options& options) {
  View view{options.view.empty() ? default_view : parse_direction(options.view, "--view"),
            options.up.empty() ? default_up : parse_direction(options.up, "--up")};
  const auto parallel = [&] { return length(cross(view.direction, view.up)) < 1e-6; };
  if (parallel() && options.up.empty()) view.up = {0, 0, -1};  // seen from above: the back is at the top
  if (parallel()) throw UsageError("--view and --up are parallel: give another --up");
  return view;
}

struct Colours {
  Colour surface, enclosure, outline;
};

Colours colours_of_part(std::size_t part) {
  if (part % 2 == 0) return {palette::sea, palette::mint, palette::mint_edge};
  return {palette::clay, palette::amber, palette::amber_edge};
}

// What encloses the surfaces, in mesh units, for each part.
struct Enclosures {
  std::vector<std::vector<IntervalTriangle>> of_part;
  std::size_t count = 0;
  bool reached = true;
};

// The budget of splits that keeps the enclosures drawable. Refuses what is too much without any split, or at
// a fixed level.
std::uint64_t drawable_budget(const Options& options, const std::vector<LimitSurface>& surfaces) {
  std::uint64_t pieces = 0;
  for (const LimitSurface& surface : surfaces) {
    for (std::size_t p = 0; p < surface.patch_count(); ++p) pieces += surface.has_patch(PatchId(p)) ? 1 : 0;
  }
  if (pieces > most_enclosures >> (2 * options.level)) {
    throw InputError(
        InputProblem::refused,
        fmt::format(
            "render: {} patches at level {} have more than {} enclosures, too many to draw; give a lower "
            "--level, or leave out --enclosures",
            pieces, options.level, most_enclosures));
  }
  return std::min(options.budget, (most_enclosures - pieces) / 3);
}

Enclosures enclose(const Options& options, const std::optional<Length>& tolerance,
                   const std::vector<LimitSurface>& surfaces) {
  Enclosures result;
  if (!options.enclosures) return result;
  BoundOptions how;
  how.level = options.level;
  how.budget = drawable_budget(options, surfaces);
  how.threads = options.threads;
  for (std::size_t part = 0; part < surfaces.size(); ++part) {
    std::vector<IntervalTriangle>& pieces = result.of_part.emplace_back();
    const auto keep = [&](const PieceEnclosure& piece) { pieces.push_back(piece.interval); };
    naming(options.meshes[part], [&] {
      if (tolerance) how.tolerance = tolerance->in_mesh_units(surfaces[part].size());
      ProgressBar bar("bounding " + options.meshes[part], options.quiet);
      const BoundSummary summary = bound(surfaces[part], how, keep, bar.monitor(), bound_method(options));
      how.budget -= summary.splits;
      result.count += pieces.size();
      result.reached = result.reached && summary.reached;
    });
  }
  return result;
}

// The surfaces on the finest lattice that is of use in this picture.
std::vector<Tessellation> tessellate(const Options& options, std::span<const PlacedSurface> parts,
                                     const PictureUnits& units, const Size& size, const View& view,
                                     const WorkMonitor& monitor) {
  const auto on_lattice = [&](std::uint32_t steps) {
    std::vector<Tessellation> result;
    for (std::size_t part = 0; part < parts.size(); ++part) {
      naming(options.meshes[part],
             [&] { result.emplace_back(parts[part], units, steps, options.threads, monitor); });
    }
    return result;
  };
  const std::vector<Tessellation> coarse = on_lattice(2);
  std::vector<Point3> points;
  double faces = 0;
  for (const Tessellation& part : coarse) {
    points.insert(points.end(), part.points().begin(), part.points().end());
    faces += static_cast<double>(part.triangle_count()) / 4;
  }
  if (points.empty()) return coarse;
  const Camera camera = frame(points, view.direction, view.up, static_cast<double>(size.width) / size.height);
  std::vector<double> edges;
  for (const Tessellation& part : coarse) {
    const std::vector<double> of_part = part.longest_edges(camera, size.height);
    edges.insert(edges.end(), of_part.begin(), of_part.end());
  }
  std::sort(edges.begin(), edges.end());
  const double wanted =
      std::ceil(std::max(edges[edges.size() * 9 / 10] / usual_edge, edges.back() / longest_edge));
  const double most = std::max(1.0, std::floor(std::sqrt(most_surface_triangles / faces)));
  return on_lattice(static_cast<std::uint32_t>(std::clamp(wanted, 1.0, most)));
}

void require_sound(const Options& options) {
  if (options.output.empty()) throw UsageError("render: -o FILE.png is missing: where the picture goes");
  if (options.output != "-" && !options.output.ends_with(".png")) {
    throw UsageError("render: '" + options.output + "' does not end in .png; pictures are PNG files");
  }
  if (options.json && options.output == "-")
    throw UsageError("render: --json and -o - both want standard output");
  if (options.poses.size() > options.meshes.size()) {
    throw UsageError(
        fmt::format("render: {} times --place, but {} meshes", options.poses.size(), options.meshes.size()));
  }
  for (const std::string& text : options.witnesses) parse_witness(text);
}

struct Shot {
  Scene scene;
  Camera camera;
};

Shot compose(const Options& options, std::span<const PlacedSurface> parts, const Enclosures& enclosures,
             const Size& size, const View& view, const WorkMonitor& monitor) {
  const PictureUnits units(parts);
  const double line_scale = std::min(size.width, size.height) / 1000.0;
  Shot shot;
  std::vector<Point3> visible;
  for (const Tessellation& part : tessellate(options, parts, units, size, view, monitor)) {
    const Colours colours = colours_of_part(shot.scene.materials.size() / 2);
    part.add_to(shot.scene, static_cast<std::uint32_t>(shot.scene.materials.size()), options.threads);
    shot.scene.materials.push_back(palette::surface(colours.surface));
    shot.scene.materials.push_back(palette::enclosure(colours.enclosure));
    visible.insert(visible.end(), part.points().begin(), part.points().end());
  }
  if (options.cage) {
    for (const PlacedSurface& part : parts) {
      add_cage(shot.scene, part, units, palette::cage_width * line_scale, palette::ink);
    }
    for (const Line& line : shot.scene.lines) visible.insert(visible.end(), {line.a, line.b});
  }
  for (const std::string& text : options.witnesses) {
    const std::size_t before = shot.scene.lines.size();
    add_witness(shot.scene, parse_witness(text), units, line_scale);
    for (std::size_t i = before; i < shot.scene.lines.size(); ++i) visible.push_back(shot.scene.lines[i].a);
  }
  std::vector<std::vector<Polyhedron>> solids;
  for (std::size_t part = 0; part < enclosures.of_part.size(); ++part) {
    solids.push_back(
        enclosure_hulls(enclosures.of_part[part], parts[part].pose, units, options.threads, monitor));
    for (const Polyhedron& solid : solids.back())
      visible.insert(visible.end(), solid.points.begin(), solid.points.end());
  }
  if (visible.empty()) return shot;
  shot.camera = frame(visible, view.direction, view.up, static_cast<double>(size.width) / size.height);
  for (std::size_t part = 0; part < solids.size(); ++part) {
    const SolidStyle style{static_cast<std::uint32_t>(2 * part + 1), palette::outline_width * line_scale,
                           colours_of_part(part).outline};
    for (const Polyhedron& solid : solids[part]) add_polyhedron(shot.scene, solid, shot.camera.eye, style);
  }
  return shot;
}

ExitStatus run(const Options& options) {
  require_sound(options);
  const Size size = parse_size(options.size);
  const View view = choose_view(options);
  std::optional<Length> tolerance;
  if (!options.tolerance.empty()) tolerance = parse_length(options.tolerance, "--tolerance");
  const Mending mending{options.nearest_rigid, notes_for(options)};
  std::vector<Motion> poses;
  for (const std::string& text : options.poses) poses.push_back(parse_pose(text, "--place", mending));
  poses.resize(options.meshes.size());
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("render", to_standard_output);

  const auto library = std::make_shared<BoundsCache>();
  std::vector<LimitSurface> surfaces;
  std::vector<std::string> schemes;
  for (const std::string& mesh : options.meshes) {
    surfaces.push_back(load_surface(mesh, options, options.scheme, library));
    schemes.emplace_back(name_of(surfaces.back().options().scheme));
  }
  report.heads(options.meshes, schemes);
  std::vector<PlacedSurface> parts;
  for (std::size_t part = 0; part < surfaces.size(); ++part) parts.push_back({&surfaces[part], poses[part]});
  const Enclosures enclosures = enclose(options, tolerance, surfaces);

  AtomicFile file(options.output);
  ProgressBar bar("rendering", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  const Shot shot = compose(options, parts, enclosures, size, view, monitor);
  RenderOptions how;
  how.width = size.width;
  how.height = size.height;
  how.samples = options.samples;
  how.parallel_for = [&](std::size_t count, const std::function<void(std::size_t, std::size_t)>& body) {
    parallel_for(count, options.threads, body);
  };
  how.progress = [&](double done) { monitor.report(done); };
  const CountedImage picture = render_counted(shot.scene, shot.camera, how);
  const std::vector<std::uint8_t> png = encode_png(picture.image);
  file.write({reinterpret_cast<const char*>(png.data()), png.size()});

  const std::size_t triangles = shot.scene.triangles.size();
  if (report.json()) {
    JsonWriter& json = report.write();
    json.field("rays", picture.rays)
        .field("hits", picture.hits)
        .field("width", size.width)
        .field("height", size.height);
    json.field("triangles", triangles)
        .field("enclosures", enclosures.count)
        .field("reached", enclosures.reached);
  } else if (options.output != "-") {
    report.text(fmt::format("{}: {} x {} pixels, {} triangles, {:.1f} % of {} rays hit", options.output,
                            size.width, size.height, triangles,
                            100 * static_cast<double>(picture.hits) / static_cast<double>(picture.rays),
                            picture.rays));
    if (!enclosures.reached) {
      report.text(fmt::format(
          "the tolerance was not reached everywhere: budget, levels, rounding, or {} enclosures that "
          "can be drawn",
          most_enclosures));
    }
  }
  return report.finish(enclosures.reached, {&file});
}

}  // namespace

Command render_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->meshes,
           "Control meshes (OBJ, OFF, PLY or STL; - for standard input)");
  list.add(Group::own, "--size WxH", &options->size, "Pixels: WxH, or one number");
  list.add(Group::own, "--samples N", &options->samples, "N * N rays a pixel, N from 1 to 16").between(1, 16);
  list.add(Group::own, "--cage", &options->cage, "Draw the edges of the control meshes");
  list.add(
      Group::own, "--witness \"X Y Z  X Y Z\"", &options->witnesses,
      "Draw two points, such as the witnesses of collide and distance, and the segment between them; may be "
      "repeated");
  list.add(Group::own, "--enclosures", &options->enclosures,
           "Draw the enclosures of the surfaces, half transparent");
  list.add(Group::own, "--tolerance LENGTH", &options->tolerance,
           "Split enclosures until each radius is at most half of this; mesh units or percent (1%)")
      .needs("--enclosures");
  list.add(Group::own, "--level N", &options->level, "Split every patch N times, 0 to 12")
      .between(0, 12)
      .excludes("--tolerance")
      .needs("--enclosures");
  list.add(Group::own, "--view \"X Y Z\"", &options->view,
           "Viewing direction; default: a three-quarter view from above");
  list.add(Group::own, "--up \"X Y Z\"", &options->up, "Up direction; default: y");
  list.add(Group::placement, "--place \"NUMBERS\"", &options->poses,
           "Pose of a mesh: a rigid transform as a row-major 3x4 or 4x4 matrix; one for each mesh, in order");
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--place");
  add_common_options(list, *options);
  for (Option* option : add_bound_options(list, *options)) option->needs("--enclosures");
  return {"render",
          Topic::files,
          "Draw a shaded picture of limit surfaces",
          {"snug render pawn.obj -o pawn.png",
           "snug render pawn.obj --enclosures --cage --size 1200x900 -o pawn.png"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
