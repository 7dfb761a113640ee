#include <picture/render.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/direction.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/run.h>

#include "common.h"
#include "curve.h"
#include "drawn_curves.h"
#include "field_colours.h"
#include "numbers.h"
#include "patch_lattice.h"
#include "pose.h"
#include "progress_bar.h"
#include "scene_builder.h"

namespace snug::command {
namespace {

// How far a ray's hit may be from the surface, in pixels; points that the camera is placed by, at most about.
constexpr double surface_pixels = 0.2;
constexpr std::size_t framing_points = 1'000'000;
// In units of the picture: single precision is what rays are traced in.
constexpr double min_tolerance = 1e-6;
// Curves: how far their chords are from them, and the sides of tubes from circles, in pixels; unless there
// would be too many of them.
constexpr double curve_deviation = 0.1;
constexpr double max_chords = 100'000;
constexpr std::size_t max_curve_edges = 50'000;
constexpr std::size_t max_tube_triangles = 2'000'000;
constexpr unsigned fewest_sides = 6, max_sides = 256;
// The radius of tubes, in the longest side of the scene. Where there is much to draw, tubes side by side would
// cover this share of its face.
constexpr double usual_radius = 0.006, min_radius = 0.0015, covered_share = 0.5;
constexpr double share_in_enclosures = 1.0 / 3;  // which would be inside of wider ones
constexpr std::uint64_t max_enclosures = 200'000;
constexpr int largest_side = 16'384;
// A three-quarter view from above, of models whose front is towards +z.
constexpr Vector3 default_view{-0.55, -0.35, -0.85};
constexpr Vector3 default_up{0, 1, 0};

struct Options : CommonOptions {
  std::vector<std::string> meshes, poses, witnesses, labels;
  bool nearest_rigid = false;
  Degree degree;
  std::string size = "1000x1000", view, up;
  int samples = 3;
  bool cage = false, enclosures = false, no_shadows = false, dark = false;
  std::string error, cut;
  std::string colour = "plain";
  double zoom = 1;
  std::vector<std::string> opacities;
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

Witness parse_witness(const std::string& text, const std::string& option = "--witness") {
  const auto numbers = parse_numbers<6>(text);
  if (!numbers) {
    throw UsageError(option + ": '" + text +
                     "' is not two points; give six numbers, as collide and distance print them");
  }
  const auto& n = *numbers;
  return {Point3{n[0], n[1], n[2]}, Point3{n[3], n[4], n[5]}};
}

double parse_opacity(const std::string& text) {
  const auto number = parse_numbers<1>(text);
  if (!number || !((*number)[0] >= 0 && (*number)[0] <= 1)) {
    throw UsageError("--opacity: '" + text + "' is not a number from 0 to 1");
  }
  return (*number)[0];
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
  if (part % 2 == 0) return {palette::sea, palette::amber, palette::amber_edge};
  return {palette::clay, palette::mint, palette::mint_edge};
}

// A drawn file: its scheme and its pose.
struct Part {
  std::string path;
  std::variant<Surface, CurveSet> shape;
  Motion pose;

  [[nodiscard]] const Surface* surface() const { return std::get_if<Surface>(&shape); }
  [[nodiscard]] const CurveSet* curves() const { return std::get_if<CurveSet>(&shape); }
};

void require_drawable(const CurveSet& curves, const std::string& path) {
  if (curves.edge_count() <= max_curve_edges) return;
  throw InputError(InputProblem::refused, fmt::format("{}: its polylines have {} edges, and curves of more "
                                                      "than {} are too many to draw; draw part of them",
                                                      path, curves.edge_count(), max_curve_edges));
}

std::vector<Part> load_parts(const Options& options, const std::vector<Motion>& poses) {
  std::vector<Part> parts;
  for (std::size_t part = 0; part < options.meshes.size(); ++part) {
    const std::string& path = options.meshes[part];
    ControlMesh mesh = load_mesh(path, options);
    if (is_curve(mesh, options.scheme)) {
      CurveSet curves = make_curves(std::move(mesh), path, curve_degree(options.degree));
      require_drawable(curves, path);
      parts.push_back({path, std::move(curves), poses[part]});
    } else {
      parts.push_back({path, make_surface(std::move(mesh), path, options, options.scheme), poses[part]});
    }
  }
  return parts;
}

// Errors:    UsageError for options that would change nothing.
void require_of_use(const Options& options, const std::vector<Part>& parts) {
  const bool surfaces = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.surface(); });
  const bool curves = std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.curves(); });
  const std::string which =
      parts.size() > 1 ? "all meshes are answered as " : parts[0].path + " is answered as ";
  if (!curves && options.degree) {
    throw UsageError("render: --degree is for curves; " + which +
                     (parts.size() > 1 ? "surfaces" : "a surface"));
  }
  if (!surfaces && !options.boundary.empty()) {
    throw UsageError("render: --boundary is for surfaces; " + which + "curves");
  }
  if (curves && options.colour == "distance") {
    throw UsageError("render: --colour distance is for two surfaces; one of these is answered as curves");
  }
  if (!surfaces && bound_method(options) == BoundMethod::table) {
    throw UsageError("render: --bounds table is for surfaces; " + which + "curves");
  }
}

// Enclosures of the surfaces and curves, in mesh units, for each part; a segment is a triangle with one corner
// twice.
struct Enclosures {
  std::vector<std::vector<IntervalTriangle>> of_part;
  std::size_t count = 0;
  Outcome outcome = Outcome::complete;
};

// The patches or edges of a part, which are split into how many pieces?
struct Pieces {
  std::uint64_t count, children;
};

Pieces pieces_of(const Part& part) {
  if (const CurveSet* curves = part.curves()) return {curves->edge_count(), 2};
  return {PatchLattice(*part.surface(), 1).patches().size(), 4};
}

// How many more enclosures than those without any split can be drawn. Refuses what is too much without a
// split, or at a fixed level.
std::uint64_t room_for_splits(const Options& options, const std::vector<Part>& parts) {
  std::uint64_t count = 0, at_level = 0;
  for (const Part& part : parts) {
    const Pieces pieces = pieces_of(part);
    count += pieces.count;
    at_level += pieces.count << (pieces.children == 4 ? 2 * options.level : options.level);
  }
  if (at_level > max_enclosures) {
    throw InputError(
        InputProblem::refused,
        fmt::format(
            "render: {} patches and edges at level {} have more than {} enclosures, too many to draw; "
            "give a lower --level, or leave out --enclosures",
            count, options.level, max_enclosures));
  }
  return max_enclosures - count;
}

Enclosures enclose(const Options& options, const std::optional<Length>& tolerance,
                   const std::vector<Part>& parts) {
  Enclosures result;
  if (!options.enclosures) return result;
  BoundOptions how;
  how.level = options.level;
  std::uint64_t room = room_for_splits(options, parts), budget = options.max_splits;
  for (const Part& part : parts) {
    std::vector<IntervalTriangle>& pieces = result.of_part.emplace_back();
    const auto keep = [&](const PatchEnclosure& piece) { pieces.push_back(piece.interval); };
    const auto keep_curve = [&](const CurveEnclosure& piece) {
      const auto& ends = piece.interval.corner;
      pieces.push_back({{ends[0], ends[1], ends[1]}});
    };
    naming(part.path, [&] {
      const Surface* surface = part.surface();
      const CurveSet* curves = part.curves();
      const std::uint64_t more_a_split = pieces_of(part).children - 1;
      if (tolerance) {
        how.error = curves ? tolerance->in_mesh_units(curves->size())
                           : tolerance->in_mesh_units(surface->size(), units_of(*surface));
      }
      ProgressBar bar("bounding " + part.path, options.quiet);
      const WorkMonitor monitor = bar.monitor();
      Run run = run_of(options, monitor);
      run.max_splits = std::min(budget, room / more_a_split);
      const BoundSummary summary =
          curves ? bound(*curves, how, keep_curve, run) : bound(*surface, how, keep, run);
      budget -= summary.splits;
      room -= summary.splits * more_a_split;
      result.count += pieces.size();
      result.outcome = worse(result.outcome, summary.outcome);
    });
  }
  return result;
}

// Points of all surfaces, dense enough to place the camera.
std::vector<Point3> surface_points(const Options& options, std::span<const Part> parts,
                                   const PictureUnits& units, const WorkMonitor& monitor) {
  std::size_t patches = 0;
  for (const Part& part : parts)
    patches += part.surface() ? PatchLattice(*part.surface(), 1).patches().size() : 0;
  const std::uint32_t steps = patches > framing_points / 10 ? 1 : patches > framing_points / 150 ? 4 : 16;
  std::vector<Point3> points;
  for (const Part& part : parts) {
    if (!part.surface()) continue;
    naming(part.path, [&] {
      const PlacedSurface placed{*part.surface(), part.pose};
      const std::vector<Point3> more = limit_points(placed, units, steps, options.threads, monitor);
      points.insert(points.end(), more.begin(), more.end());
    });
  }
  return points;
}

// For the surfaces of the parts.
std::vector<std::unique_ptr<RayCaster>> make_casters(const Options& options, std::span<const Part> parts,
                                                     double tolerance, const WorkMonitor& monitor) {
  std::vector<std::unique_ptr<RayCaster>> casters;
  for (const Part& part : parts) {
    std::unique_ptr<RayCaster>& caster = casters.emplace_back();
    if (!part.surface()) continue;
    naming(part.path, [&] {
      caster = std::make_unique<RayCaster>(*part.surface(), tolerance, run_of(options, monitor));
    });
  }
  return casters;
}

// The curves of a part, and which it is.
struct PartCurves {
  std::size_t part;
  DrawnCurves curves;
};

std::vector<PartCurves> place_curves(std::span<const Part> parts, const PictureUnits& units) {
  std::vector<PartCurves> result;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (const CurveSet* curves = parts[part].curves()) {
      result.push_back({part, DrawnCurves(*curves, parts[part].pose, units)});
    }
  }
  return result;
}

// A radius that suits how much there is to draw.
double radius_of_tubes(const Options& options, std::span<const PartCurves> drawn) {
  double polygons = 0;
  for (const auto& [part, curves] : drawn) polygons += curves.polygon_length();
  const double suited = covered_share / (2 * std::max(polygons, 1.0));
  return std::clamp(suited, min_radius, usual_radius) * (options.enclosures ? share_in_enclosures : 1);
}

// A tube around a curve, and which part that is of.
struct PartTube {
  std::size_t part;
  Tube tube;
};

std::vector<PartTube> make_tubes(std::span<const Part> parts, std::span<const PartCurves> drawn,
                                 double deviation, double radius, const WorkMonitor& monitor) {
  std::vector<PartTube> result;
  for (const auto& [part, curves] : drawn) {
    naming(parts[part].path, [&, part = part, &curves = curves] {
      for (Tube& tube : curves.tubes(deviation, radius, monitor)) result.push_back({part, std::move(tube)});
    });
  }
  return result;
}

std::vector<Point3> outline(std::span<const PartTube> tubes) {
  std::vector<Point3> points;
  for (const auto& [part, tube] : tubes) tube.add_outline(points);
  return points;
}

// Pixels a unit where the picture is nearest to the eye.
double largest_scale(std::span<const Point3> points, const Camera& camera, int height) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Point3& p : points) nearest = std::min(nearest, dot(p - camera.eye, camera.forward));
  return 0.5 * height / (camera.tangent * nearest);
}

// How far chords may be from curves so that it does not show, where a unit is `scale` pixels long.
double useful_deviation(std::span<const PartCurves> drawn, double scale) {
  const double deviation = curve_deviation / scale;
  double chords = 0;
  for (const auto& [part, curves] : drawn) chords += curves.chord_count(deviation);
  return deviation * std::pow(std::max(1.0, chords / max_chords), 2);
}

void add_tubes(PictureScene& scene, std::span<const PartTube> tubes, double radius_in_pixels) {
  const double side = 2 * std::acos(std::max(0.5, 1 - curve_deviation / radius_in_pixels));
  auto sides = static_cast<unsigned>(
      std::clamp(std::ceil(2 * std::numbers::pi / side), double{fewest_sides}, double{max_sides}));
  const auto triangles = [&] {
    std::size_t count = 0;
    for (const auto& [part, tube] : tubes) count += tube.triangle_count(sides);
    return count;
  };
  while (sides > fewest_sides && triangles() > max_tube_triangles) {
    sides = std::max(fewest_sides, sides - sides / 6);
  }
  scene.triangles.reserve(scene.triangles.size() + triangles());
  for (const auto& [part, tube] : tubes) tube.add_to(scene, sides, static_cast<std::uint32_t>(2 * part));
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
  if (!options.cut.empty()) {
    const Witness cut = parse_witness(options.cut, "--cut");
    if (cut[0] == cut[1])
      throw UsageError("--cut: the two points are the same; the plane is normal to the line between them");
  }
  for (const std::string& text : options.opacities) parse_opacity(text);
  if (options.opacities.size() > options.meshes.size()) {
    throw UsageError(fmt::format("render: {} times --opacity, but {} meshes", options.opacities.size(),
                                 options.meshes.size()));
  }
  if (options.colour == "distance" && options.meshes.size() != 2) {
    throw UsageError("render: --colour distance is for two meshes: each shows how far the other one is");
  }
}

struct Shot {
  std::vector<std::unique_ptr<RayCaster>> casters;  // of the surfaces in the scene
  PictureScene scene;
  Camera camera;
  double tolerance = 0;  // of these, in units of the picture
};

// Adds the surfaces, as fine as the camera shows them.
void add_surfaces(Shot& shot, const Options& options, std::span<const Part> parts, const PictureUnits& units,
                  double pixels_a_unit, const WorkMonitor& monitor) {
  shot.tolerance = std::max(surface_pixels / pixels_a_unit, min_tolerance);
  shot.casters = make_casters(options, parts, units.to_mesh(shot.tolerance), monitor);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (!shot.casters[part]) continue;
    shot.scene.surfaces.push_back(
        scene_surface(*shot.casters[part], parts[part].pose, units, static_cast<std::uint32_t>(2 * part)));
  }
}

Colour ink_of(const Options& options) { return options.dark ? palette::chalk : palette::ink; }

double label_height(double line_scale) {
  return std::max(palette::smallest_label, palette::label_height * line_scale);
}

// The colours that --colour asks for, and the key to them.
void add_colours(Shot& shot, const Options& options, std::span<const Part> parts, double line_scale,
                 const WorkMonitor& monitor) {
  if (options.colour == "plain" || shot.scene.surfaces.empty()) return;
  const WorkMonitor quiet{.on_progress = {}, .stop = monitor.stop};
  FieldColours colours(options.colour);
  for (std::size_t part = 0; part < parts.size(); ++part) {
    if (!shot.casters[part]) continue;
    const Part& other = options.colour == "distance" ? parts[part == 0 ? 1 : 0] : parts[part];
    naming(parts[part].path, [&] {
      colours.add({*parts[part].surface(), parts[part].pose}, {*other.surface(), other.pose},
                  {.threads = options.threads, .monitor = &quiet});
    });
  }
  for (std::size_t i = 0; i < shot.scene.surfaces.size(); ++i) shot.scene.surfaces[i].colour = colours.of(i);
  shot.scene.bar = colours.bar();
  shot.scene.bar->height_in_pixels = label_height(line_scale);
  shot.scene.bar->text = ink_of(options);
}

PictureUnits units_of(std::span<const Part> parts) {
  std::vector<PlacedMesh> placed;
  for (const Part& part : parts) {
    const ControlMesh& mesh = part.curves() ? part.curves()->mesh() : part.surface()->mesh();
    placed.push_back({&mesh, part.curves() ? mesh.polyline_vertices : mesh.face_vertices, part.pose});
  }
  return PictureUnits(placed);
}

Shot compose(const Options& options, std::span<const Part> parts, const Enclosures& enclosures,
             const Size& size, const View& view, const WorkMonitor& monitor) {
  const PictureUnits units = units_of(parts);
  const double line_scale = std::min(size.width, size.height) / 1000.0;
  const double aspect = static_cast<double>(size.width) / size.height;
  Shot shot;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    shot.scene.materials.push_back(palette::surface(colours_of_part(part).surface));
    if (part < options.opacities.size()) {
      shot.scene.materials.back().opacity = parse_opacity(options.opacities[part]);
    }
    shot.scene.materials.push_back(palette::enclosure(colours_of_part(part).enclosure));
  }
  const std::vector<PartCurves> curves = place_curves(parts, units);
  const double radius = radius_of_tubes(options, curves);
  const auto tubes = [&](double deviation) { return make_tubes(parts, curves, deviation, radius, monitor); };
  const std::vector<Point3> coarse = outline(tubes(std::numeric_limits<double>::infinity()));
  std::vector<Point3> visible = surface_points(options, parts, units, monitor);
  if (!curves.empty()) {
    visible.insert(visible.end(), coarse.begin(), coarse.end());
    const double scale = largest_scale(visible, frame(visible, view.direction, view.up, aspect), size.height);
    const std::vector<PartTube> fine = tubes(useful_deviation(curves, scale));
    add_tubes(shot.scene, fine, radius * scale);
    const std::vector<Point3> around = outline(fine);
    visible.insert(visible.end(), around.begin(), around.end());
  }
  if (options.cage) {
    const double width = palette::cage_width * line_scale;
    for (const Part& part : parts) {
      if (part.surface()) add_cage(shot.scene, {*part.surface(), part.pose}, units, width, ink_of(options));
    }
    for (const auto& [part, drawn] : curves) drawn.add_polygons(shot.scene, width, ink_of(options));
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
  shot.camera = frame(visible, view.direction, view.up, aspect);
  constexpr double room_for_bar = 1.15;
  shot.camera.tangent *= (options.colour == "plain" ? 1 : room_for_bar) / options.zoom;
  add_surfaces(shot, options, parts, units, largest_scale(visible, shot.camera, size.height), monitor);
  add_colours(shot, options, parts, line_scale, monitor);
  const double below = shot.scene.bar ? 1.5 : 0;  // lines that the bar takes
  for (std::size_t i = 0; i < options.labels.size(); ++i) {
    shot.scene.labels.push_back({options.labels[i], label_height(line_scale), ink_of(options),
                                 static_cast<double>(options.labels.size() - 1 - i) + below});
  }
  if (!options.cut.empty()) shot.scene.cut = cut_plane(parse_witness(options.cut, "--cut"), units);
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
  if (!options.error.empty()) tolerance = parse_length(options.error, "--error");
  const Mending mending{options.nearest_rigid, notes_for(options)};
  std::vector<Motion> poses;
  for (const std::string& text : options.poses) poses.push_back(parse_pose(text, "--place", mending));
  poses.resize(options.meshes.size());
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("render", to_standard_output);

  const std::vector<Part> parts = load_parts(options, poses);
  require_of_use(options, parts);
  std::vector<std::string> schemes;
  bool curves = false;
  for (const Part& part : parts) {
    schemes.emplace_back(part.curves() ? "curve" : name_of(part.surface()->scheme()));
    curves = curves || part.curves();
  }
  report.heads(options.meshes, schemes);
  if (curves && report.json()) report.write().field("degree", static_cast<int>(curve_degree(options.degree)));
  const Enclosures enclosures = enclose(options, tolerance, parts);

  AtomicFile file(options.output);
  ProgressBar bar("rendering", options.quiet);
  const WorkMonitor monitor = bar.monitor();
  const Shot shot = compose(options, parts, enclosures, size, view, monitor);
  RenderOptions how;
  how.width = size.width;
  how.height = size.height;
  how.samples = options.samples;
  how.shadows = !options.no_shadows;
  if (options.dark) how.background = {palette::slate_top, palette::slate_foot};
  how.surface_tolerance = shot.tolerance;
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
        .field("outcome", name_of(enclosures.outcome));
  } else if (options.output != "-") {
    report.text(fmt::format("{}: {} x {} pixels, {}{:.1f} % of {} rays hit", options.output, size.width,
                            size.height, triangles == 0 ? "" : fmt::format("{} triangles, ", triangles),
                            100 * static_cast<double>(picture.hits) / static_cast<double>(picture.rays),
                            picture.rays));
    if (enclosures.outcome != Outcome::complete) {
      report.text(
          fmt::format("the error was not reached everywhere: budget, levels, rounding, or {} enclosures that "
                      "can be drawn",
                      max_enclosures));
    }
  }
  return report.finish(enclosures.outcome == Outcome::complete, {&file});
}

}  // namespace

Command render_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->meshes,
           "Control meshes (OBJ, OFF, PLY, STL, USD, glTF or 3MF; - for standard input)");
  list.add(Group::own, "--size WxH", &options->size, "Pixels: WxH, or one number");
  list.add(Group::own, "--samples N", &options->samples, "N * N rays per pixel, N from 1 to 16")
      .between(1, 16);
  list.add(Group::own, "--cage", &options->cage, "Draw the edges of the control meshes and polygons");
  list.add(
      Group::own, "--witness \"X Y Z  X Y Z\"", &options->witnesses,
      "Draw two points, such as the witnesses of collide and distance, and the segment between them; may be "
      "repeated");
  list.add(Group::own, "--label TEXT", &options->labels,
           "Write a line at the lower left, such as the verdict; may be repeated");
  list.add(Group::own, "--enclosures", &options->enclosures,
           "Draw the enclosures of the surfaces and curves, translucent");
  list.add(Group::own, "--error LENGTH", &options->error,
           "Split enclosures until each radius is at most half of this; mesh units or percent, such as 1%")
      .formerly("--tolerance")
      .needs("--enclosures");
  list.add(Group::own, "--level N", &options->level, "Split every patch or edge N times, 0 to 12")
      .between(0, 12)
      .excludes("--error")
      .needs("--enclosures");
  list.add(Group::own, "--colour NAME", &options->colour,
           "Surface colours: plain; kind: grey for regular polynomial patches; level: number of splits; "
           "thickness: of interval triangles; curvature: mean curvature; distance: from each of two meshes "
           "to the other")
      .one_of({"plain", "kind", "level", "thickness", "curvature", "distance"});
  list.add(Group::own, "--opacity SHARE", &options->opacities,
           "Opacity of a mesh, from 0 to 1; one for each mesh, in order");
  list.add(Group::own, "--cut \"X Y Z  X Y Z\"", &options->cut,
           "Clip surfaces by the plane through the first point, normal to the line to the second");
  list.add(Group::own, "--no-shadows", &options->no_shadows, "Shade surfaces without cast shadows");
  list.add(Group::own, "--dark", &options->dark, "A dark background, with bright lines and letters");
  list.add(Group::own, "--zoom FACTOR", &options->zoom, "Magnify the centre of the picture, 0.01 to 1000")
      .between(0.01, 1000);
  list.add(Group::own, "--view \"X Y Z\"", &options->view,
           "Viewing direction; default: a three-quarter view from above");
  list.add(Group::own, "--up \"X Y Z\"", &options->up, "Up direction; default: y");
  list.add(Group::placement, "--place \"NUMBERS\"", &options->poses,
           "Pose of a mesh: a rigid transform as a row-major 3x4 or 4x4 matrix; one for each mesh, in order");
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--place");
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  for (Option* option : add_bound_options(list, *options)) option->needs("--enclosures");
  return {"render",
          Topic::files,
          "Draw a shaded picture of limit surfaces and curves",
          {"snug render pawn.obj -o pawn.png",
           "snug render pawn.obj --enclosures --cage --size 1200x900 -o pawn.png"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
