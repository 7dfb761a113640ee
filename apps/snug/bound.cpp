#include <fmt/core.h>
#include <picture/polyhedron.h>
#include <snug/bound.h>
#include <support/atomic_file.h>
#include <support/scaling.h>

#include <algorithm>
#include <numbers>

#include "answer_writer.h"
#include "common.h"
#include "curve.h"
#include "length.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

constexpr std::size_t max_facets = 4'000'000;

struct Options : CommonOptions {
  std::string mesh;
  Degree degree;
  std::string error;
  std::string polyhedra;
  unsigned level = 0;
  bool normals = false;
};

template <class Piece>
void write_box_corners(JsonWriter& json, const char* key, const Piece& piece, Point3 Box3::*end) {
  json.key(key).begin_array();
  for (const Box3& box : piece.interval.corner) json.value(box.*end);
  json.end_array();
}

template <std::size_t N>
void write_points(JsonWriter& json, const char* key, const std::array<Point3, N>& points) {
  json.key(key).begin_array();
  for (const Point3& p : points) json.value(p);
  json.end_array();
}

template <class Piece>
void write_enclosure(JsonWriter& json, const Piece& piece, const std::string& name, unsigned level) {
  json.field("piece", name).field("level", level);
  write_box_corners(json, "lower", piece, &Box3::lower);
  write_box_corners(json, "upper", piece, &Box3::upper);
  write_points(json, "base", piece.offset.base);
  json.field("radius", piece.offset.radius);
  write_points(json, "corners", piece.corners);
}

void write_cone(JsonWriter& json, const std::optional<NormalCone>& cone) {
  json.key("normals");
  if (!cone) {
    json.null();
    return;
  }
  json.begin_object().field("axis", cone->axis).field("angle", cone->angle).end_object();
}

void write_piece(JsonWriter& json, const Surface& surface, const PatchEnclosure& piece, bool normals) {
  json.begin_object();
  json.field(surface.traits().owner(), piece.patch.owner);
  if (!surface.traits().triangular) json.field("part", piece.patch.part);
  write_enclosure(json, piece, piece.piece, piece.level);
  if (normals) write_cone(json, piece.normals);
  json.end_object();
}

void write_piece(JsonWriter& json, const CurveSet&, const CurveEnclosure& piece) {
  json.begin_object().field("edge", piece.edge.index());
  write_enclosure(json, piece, piece.piece, piece.level);
  json.end_object();
}

// The hulls of enclosures side by side in one mesh, for pictures.
class Polyhedra {
 public:
  explicit Polyhedra(bool triangles) : triangles_(triangles) {}

  void add(const PatchEnclosure& piece) {
    Box3 all;
    for (const Box3& box : piece.interval.corner) all.add(box);
    require_representable(longest_side(all));
    const Polyhedron solid = hull_of_boxes(piece.interval);
    if (solid.facets.empty()) return;  // a segment or a point
    ++count_;
    const std::size_t first = mesh_.vertex_count();
    mesh_.points.insert(mesh_.points.end(), solid.points.begin(), solid.points.end());
    for (const std::vector<std::uint32_t>& facet : solid.facets) {
      const auto corner = [&](std::size_t i) { return VertexId(first + facet[i]); };
      if (triangles_) {
        for (std::size_t i = 2; i < facet.size(); ++i)
          mesh_.add_face(std::array{corner(0), corner(i - 1), corner(i)});
      } else {
        for (std::size_t i = 0; i < facet.size(); ++i) mesh_.face_vertices.push_back(corner(i));
        mesh_.add_face({});
      }
    }
    if (mesh_.face_count() > max_facets) {
      throw InputError(
          InputProblem::refused,
          fmt::format("--polyhedra: more than {} facets; give a larger --error or a lower --level",
                      max_facets));
    }
  }

  [[nodiscard]] const ControlMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  bool triangles_;
  std::size_t count_ = 0;
  ControlMesh mesh_;
};

void write_polyhedra(const Polyhedra& polyhedra, const Options& options, std::optional<double> units,
                     AtomicFile& file, Report& report) {
  if (polyhedra.count() == 0) {
    throw InputError(InputProblem::refused, options.mesh + ": no enclosure is a solid or a polygon to write");
  }
  write_facets(polyhedra.mesh(), file, options.polyhedra, options, units);
  report.text(fmt::format("{}: {} polyhedra with {} facets, for pictures", options.polyhedra,
                          polyhedra.count(), polyhedra.mesh().face_count()));
}

// How many pieces have a cone of normals, and how wide the widest is.
class ConeCount {
 public:
  void add(const std::optional<NormalCone>& cone) {
    ++pieces_;
    if (!cone) return;
    ++cones_;
    widest_ = std::max(widest_, cone->angle);
  }
  [[nodiscard]] std::string text() const {
    std::string text = fmt::format("normals: {} of {} pieces have a cone", cones_, pieces_);
    if (cones_ > 0) {
      text += ", the widest one of half-angle " + text_at_most(widest_ * (180 / std::numbers::pi), true) +
              " degrees";
    }
    return text;
  }

 private:
  std::uint64_t pieces_ = 0, cones_ = 0;
  double widest_ = 0;
};

// The end of the command, after its last enclosure: the fields of the summary, the sentence `found` with the
// largest radius, and why not all was reached.
void write_bound_summary(Report& report, const BoundSummary& summary, const BoundOptions& how,
                         const std::string& found) {
  if (report.json()) {
    write_fields(report.write().end_array(), summary);
  }
  report.text(found + ", largest radius " + text_at_most(summary.max_radius, true));
  if (summary.outcome == Outcome::complete) return;
  report.text(
      fmt::format("{} was not reached everywhere: {}; what is printed is still proved",
                  how.error ? "the error" : "the level",
                  summary.outcome == Outcome::budget_spent
                      ? "the budget was spent, in the order of the mesh; give a larger --max-splits"
                      : "60 levels or the precision of doubles are the limit; give a larger --error"));
}

ExitStatus run(const Options& options) {
  if (options.polyhedra == "-") throw UsageError("bound: --polyhedra - : give a file");
  const bool triangles = !options.polyhedra.empty() && !format_of(options.polyhedra).polygons;
  if (!options.polyhedra.empty()) require_writable(options.polyhedra);
  BoundOptions how;
  how.level = options.level;
  how.normals = options.normals;
  std::optional<Length> tolerance;
  if (!options.error.empty()) tolerance = parse_length(options.error, "--error");
  ControlMesh mesh = load_mesh(options.mesh, options);
  const std::optional<double> units = mesh.metres_per_unit;
  std::optional<CurveSet> curves;
  std::optional<Surface> surface;
  if (asks_for_curves("bound", mesh, options.mesh, options, options.degree)) {
    for (const auto& [asked, option] :
         {std::pair(!options.polyhedra.empty(), "--polyhedra"), std::pair(options.normals, "--normals"),
          std::pair(bound_method(options) == BoundMethod::table, "--bounds table")}) {
      if (!asked) continue;
      throw UsageError(
          fmt::format("bound: {} is for surfaces; {} is answered as curves", option, options.mesh));
    }
    curves = make_curves(std::move(mesh), options.mesh, curve_degree(options.degree));
  } else {
    surface = make_surface(std::move(mesh), options.mesh, options, options.scheme);
  }
  Polyhedra polyhedra(triangles);
  Report report("bound", options);
  curves ? curve_heads(report, options.mesh, curve_degree(options.degree))
         : report.heads({options.mesh}, {name_of(surface->scheme())});
  BoundSummary summary;
  ConeCount cones;
  naming(options.mesh, [&] {
    if (tolerance) how.error = tolerance->in_mesh_units(curves ? curves->size() : surface->size(), units);
    if (report.json()) report.write().key("enclosures").begin_array();
    ProgressBar bar("bounding " + options.mesh, options.quiet);
    const auto keep_curve = [&](const CurveEnclosure& piece) {
      if (report.json()) write_piece(report.write(), *curves, piece);
    };
    const auto keep = [&](const PatchEnclosure& piece) {
      if (report.json()) write_piece(report.write(), *surface, piece, options.normals);
      if (options.normals) cones.add(piece.normals);
      if (!options.polyhedra.empty()) polyhedra.add(piece);
    };
    const WorkMonitor monitor = bar.monitor();
    const Run run = run_of(options, monitor);
    summary = curves ? bound(*curves, how, keep_curve, run) : bound(*surface, how, keep, run);
  });
  const std::string whole = curves ? fmt::format("{} edges contain the limit curves of degree {}",
                                                 curves->edge_count(), static_cast<int>(curves->degree()))
                                   : fmt::format("{} {} contain the limit surface", surface->owner_count(),
                                                 surface->traits().dual ? "vertices" : "faces");
  write_bound_summary(report, summary, how,
                      fmt::format("{}: {} enclosures of {}", options.mesh, summary.count, whole));
  if (options.normals) report.text(cones.text());
  std::optional<AtomicFile> file;
  if (!options.polyhedra.empty()) {
    file.emplace(options.polyhedra);
    write_polyhedra(polyhedra, options, units, *file, report);
  }
  if (file) return report.finish(summary.outcome == Outcome::complete, {&*file});
  return report.finish(summary.outcome == Outcome::complete);
}

}  // namespace

Command bound_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_or_input_help);
  list.add(Group::own, "--error LENGTH", &options->error,
           "Split until each radius is at most half of this; mesh units or percent, such as 1%")
      .formerly("--tolerance");
  list.add(Group::own, "--level N", &options->level,
           "Split every patch N times, 0 to 12; the first split of a polygon counts")
      .between(0, 12)
      .excludes("--error");
  list.add(Group::own, "--polyhedra FILE", &options->polyhedra,
           "Also write the enclosures as one mesh, for pictures: .obj, .off, .ply, .stl or .glb");
  list.add(Group::own, "--normals", &options->normals, "Also enclose the normals of each piece in a cone");
  add_degree_option(list, options->degree);
  add_common_options(list, *options);
  add_bound_options(list, *options);
  return {"bound",
          Topic::one_surface,
          "Enclose a limit surface, or limit curves, in small sets",
          {"snug bound pawn.obj --error 0.5% --json"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
