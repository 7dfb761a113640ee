#include <snug/distance.h>

#include <algorithm>
#include <array>
#include <variant>

#include <fmt/core.h>
#include <support/error.h>

#include "answer_writer.h"
#include "curve.h"
#include "length.h"
#include "mesh_reading.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh, candidate;
  std::string scheme_b;
  std::string precision = "0.01%";
  std::string tolerance;  ///< a length; empty: how far, not whether
  bool surface = false;
  bool solid = false;
  bool exit_code = false;
};

/// Triangles as they are, or a control mesh with its own limit surface.
using Candidate = std::variant<std::vector<Triangle>, Surface>;

// Whatever else may be wrong with them does not matter: a set of triangles is all that is asked for.
std::vector<Triangle> triangles_of(const ControlMesh& mesh, const std::string& path) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.face_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    if (face.size() != 3) {
      throw InputError(
          InputProblem::refused,
          fmt::format("{}: face {} has {} corners; the candidate is compared as triangles: triangulate it, "
                      "or give --surface to compare its own limit surface",
                      path, f, face.size()));
    }
    Triangle& corners = triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      if (face[k].index() >= mesh.points.size()) {
        throw InputError(InputProblem::refused,
                         fmt::format("{}: face {} refers to vertex {}, and there are {}", path, f,
                                     face[k].value(), mesh.points.size()));
      }
      corners[k] = mesh.points[face[k].index()];
    }
  }
  return triangles;
}

// `units`: those of the candidate, if they are known.
Candidate read_candidate(const Options& options, std::optional<double>& units) {
  const std::string& path = options.candidate;
  if (options.surface) {
    Surface surface =
        read_surface(path, options, options.scheme_b.empty() ? options.scheme : options.scheme_b);
    units = units_of(surface);
    return surface;
  }
  ProgressBar bar("reading " + path, options.quiet);
  const WorkMonitor monitor = bar.monitor();
  ControlMesh mesh = read_mesh(path, {{}, notes_for(options), {}}, {.monitor = &monitor});
  set_units(mesh, path, options);
  units = mesh.metres_per_unit;
  if (mesh.face_count() == 0) {
    throw InputError(InputProblem::refused,
                     path + ": there are no triangles to compare; give a mesh with faces");
  }
  return triangles_of(mesh, path);
}

// With --exit-code.
ExitStatus status_of(DeviationVerdict verdict) {
  constexpr std::array statuses{ExitStatus::answered, ExitStatus::exceeds, ExitStatus::undecided};
  return statuses[static_cast<std::size_t>(verdict)];
}

// Null where the farthest point lies on no surface.
void write_place_of(JsonWriter& json, const OneSidedDistance& found, const Surface* on) {
  if (!found.from.at || on == nullptr) {
    json.null();
    return;
  }
  json.begin_object();
  write_place(json, *on, *found.from.at);
  json.end_object();
}

void write_points(JsonWriter& json, const OneSidedDistance& found) {
  json.begin_array().value(found.from.point).value(found.to).end_array();
}

// Of the points of the candidate on one side of the solid; no points where there are none.
void write_side(JsonWriter& json, const std::string& side, const OneSidedDistance& found,
                const Surface* candidate) {
  write_field(json, side, found.distance, {});
  const bool none = found.distance.upper == 0;
  json.key(side + "_points");
  if (none) {
    json.null();
  } else {
    write_points(json, found);
  }
  json.key(side + "_error");
  none ? json.null() : json.value(found.from.error);
  json.key(side + "_at");
  write_place_of(json, found, none ? nullptr : candidate);
}

void write_answer(JsonWriter& json, const Deviation& answer, const std::array<const Surface*, 2>& surfaces) {
  const std::array sides{&answer.from_surface, &answer.from_candidate};
  json.field("outcome", snug::name_of(answer.outcome));
  write_field(json, "from_surface", sides[0]->distance, {});
  write_field(json, "from_candidate", sides[1]->distance, {});
  json.key("points").begin_array();
  for (const OneSidedDistance* side : sides) write_points(json, *side);
  json.end_array().key("points_error").begin_array();
  for (const OneSidedDistance* side : sides) json.value(side->from.error);
  json.end_array().key("points_at").begin_array();
  for (std::size_t s = 0; s < 2; ++s) write_place_of(json, *sides[s], surfaces[s]);
  json.end_array();
  if (answer.inside) write_side(json, "inside", *answer.inside, surfaces[1]);
  if (answer.outside) write_side(json, "outside", *answer.outside, surfaces[1]);
}

// "at least 0.1 and at most 0.2".
std::string text_of(const Interval& distance) {
  return fmt::format("at least {} and at most {}", text_at_most(distance.lower),
                     text_at_most(distance.upper, true));
}

// The farthest point, what is near it, and where it lies.
std::string text_of(const OneSidedDistance& found, const Surface* on) {
  const Point3& from = found.from.point;
  std::string text = fmt::format("  ({:.8g} {:.8g} {:.8g}), and near it ({:.8g} {:.8g} {:.8g})", from.x,
                                 from.y, from.z, found.to.x, found.to.y, found.to.z);
  if (!found.from.at || on == nullptr) return text;
  const Place& at = *found.from.at;
  const SchemeTraits& traits = on->traits();
  return text + fmt::format(", {} {}{} u {:.6g} v {:.6g}", traits.owner(), at.owner,
                            traits.triangular ? "" : fmt::format(" corner {}", at.corner), at.u, at.v);
}

void write_text(Report& report, const Deviation& answer, const std::array<const Surface*, 2>& surfaces) {
  const auto write = [&](const std::string& what, const OneSidedDistance& found, const Surface* on) {
    if (found.distance.upper == 0) {
      report.text(what + ": 0, proved");
      return;
    }
    report.text(what + ": " + text_of(found.distance) + "; the farthest point found");
    report.text(text_of(found, on));
  };
  write("from the surface to the candidate", answer.from_surface, surfaces[0]);
  write("from the candidate to the surface", answer.from_candidate, surfaces[1]);
  if (answer.inside) write("of the candidate's points inside the solid", *answer.inside, surfaces[1]);
  if (answer.outside) write("of the candidate's points outside the solid", *answer.outside, surfaces[1]);
}

// The verdict as a sentence for people.
std::string sentence(DeviationVerdict verdict, double tolerance, Outcome outcome) {
  switch (verdict) {
    case DeviationVerdict::within:
      return fmt::format("within: proved, no point of either is farther than {:.6g} from the other",
                         tolerance);
    case DeviationVerdict::exceeds:
      return fmt::format("exceeds: proved, a point of one is farther than {:.6g} from the other", tolerance);
    case DeviationVerdict::undecided:
      break;
  }
  return fmt::format("undecided: a distance is too close to {:.6g} to decide; {}", tolerance,
                     outcome == Outcome::complete       ? "give a smaller --absolute"
                     : outcome == Outcome::budget_spent ? "give a larger --max-splits"
                                                        : "rounding is in the way");
}

ExitStatus run(const Options& options) {
  const Length precision = parse_length(options.precision, "--absolute");
  std::optional<Length> tolerance;
  if (!options.tolerance.empty()) tolerance = parse_length(options.tolerance, "--threshold", true);
  const Surface surface = read_surface(options.mesh, options, options.scheme);
  std::array<std::optional<double>, 2> units{units_of(surface), {}};
  const Candidate candidate = read_candidate(options, units[1]);
  static_cast<void>(common_units(units, std::array{options.mesh, options.candidate}));
  DeviationOptions wanted;
  wanted.absolute = precision.in_mesh_units(surface.size(), units_of(surface));
  if (tolerance) wanted.threshold = tolerance->in_mesh_units(surface.size(), units_of(surface));
  wanted.solid = options.solid;
  Deviation answer;
  {
    ProgressBar bar("comparing", options.quiet);
    const WorkMonitor monitor = bar.monitor();
    if (options.solid) naming(options.mesh, [&] { require_closed(surface); });
    answer = std::visit(
        [&](const auto& other) { return deviation(surface, other, wanted, run_of(options, monitor)); },
        candidate);
  }
  const Surface* const other = std::get_if<Surface>(&candidate);
  const std::array<const Surface*, 2> surfaces{&surface, other};
  Report report("deviation", options);
  report.heads({options.mesh, options.candidate},
               {name_of(surface.scheme()), name_of(other ? other->scheme() : Scheme::flat)});
  const std::optional<DeviationVerdict> verdict = answer.verdict;
  if (report.json()) {
    report.write().field("absolute", *wanted.absolute).key("threshold");
    wanted.threshold ? report.write().value(*wanted.threshold) : report.write().null();
    write_field(report.write(), "verdict", verdict, {});
    write_answer(report.write(), answer, surfaces);
  }
  if (verdict) report.text(sentence(*verdict, *wanted.threshold, answer.outcome));
  write_text(report, answer, surfaces);
  if (!verdict && answer.outcome != Outcome::complete) {
    report.text(answer.outcome == Outcome::budget_spent
                    ? "the precision was not reached: give a larger --max-splits or --absolute"
                    : "the precision was not reached: rounding is in the way; give a larger --absolute");
  }
  const ExitStatus status =
      report.finish(verdict ? *verdict != DeviationVerdict::undecided : answer.outcome == Outcome::complete);
  return options.exit_code ? status_of(*verdict) : status;
}

}  // namespace

Command deviation_command() {
  auto options = std::make_shared<Options>();
  options->max_splits = default_splits::deviation;
  OptionList list;
  list.add(Group::own, "MESH", &options->mesh, mesh_help);
  list.add(Group::own, "CANDIDATE", &options->candidate,
           "Triangles to compare with the limit surface, such as a tessellation or a scan");
  list.add(Group::own, "--absolute LENGTH", &options->precision,
           "Largest width of the intervals; mesh units, or percent of MESH")
      .formerly("--precision");
  list.add(Group::own, "--threshold LENGTH", &options->tolerance,
           "Only decide whether all points are within this distance; mesh units, or percent of MESH")
      .formerly("--tolerance");
  list.add(Group::own, "--exit-code", &options->exit_code, "Exit with 0 within, 13 exceeds, 12 undecided")
      .needs("--threshold");
  list.add(Group::own, "--surface", &options->surface,
           "CANDIDATE is a control mesh: compare the two limit surfaces");
  list.add(Group::own, "--solid", &options->solid,
           "MESH bounds a solid: also bound how far CANDIDATE lies inside and outside it");
  add_common_options(list, *options);
  list.add(Group::effort, "--max-splits N", &options->max_splits,
           "Compare at most N parts in each direction, then report the bounds reached")
      .formerly("--budget")
      .between(0, std::uint64_t{1} << 40);
  add_scheme_option(list, "--scheme-b", options->scheme_b, "Scheme of CANDIDATE; overrides --scheme")
      .needs("--surface");
  return {
      "deviation",
      Topic::two_surfaces,
      "How far is a mesh from the limit surface that it represents? Bounds in both directions",
      {"snug deviation bust.obj tessellated.stl", "snug deviation bust.obj tessellated.stl --threshold 0.1%"},
      std::move(list),
      [options] { return run(*options); }};
}

}  // namespace snug::command
