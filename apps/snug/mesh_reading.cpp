#include "mesh_reading.h"

#include <charconv>
#include <cmath>

#include <fmt/core.h>
#include <snug/evaluate.h>
#include <snug/inspect.h>
#include <snug/mesh.h>
#include <support/error.h>
#include <support/number.h>

#include "curve.h"

namespace snug::command {

std::function<double(double)> weld_distance(const CommonOptions& options) {
  if (options.weld.empty()) return {};
  std::optional<double> metres;  // of a unit before --scale
  if (!options.units.empty()) metres = options.scale * metres_of(options.units);
  return [length = parse_length(options.weld, "--weld", true), metres](double size) {
    return length.in_mesh_units(size, metres);
  };
}

void set_units(ControlMesh& mesh, const std::string& path, const CommonOptions& options) {
  if (options.scale != 1) {
    for (Point3& point : mesh.points) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] *= options.scale;
        if (!std::isfinite(point[axis]))
          throw InputError(InputProblem::refused,
                           path + ": --scale brings a coordinate beyond the range of doubles");
      }
    }
    mesh.metres_per_unit.reset();
  }
  if (!options.units.empty()) mesh.metres_per_unit = metres_of(options.units);
}

std::vector<Finding> coincidences_found(const ControlMesh& mesh) {
  const Coincidences found = coincidences(mesh);
  std::vector<Finding> findings;
  if (found.vertices > 0) {
    const std::string edges =
        found.edges == 0 ? "" : fmt::format(", and {} boundary edges coincide", found.edges);
    findings.push_back({"coincident-vertices",
                        fmt::format("{} vertices coincide with others, in {} place{}{}: they are not merged",
                                    found.vertices, found.places, found.places == 1 ? "" : "s", edges),
                        "--weld 0 merges them"});
  }
  if (found.near > 0) {
    const std::string gaps =
        found.nearest == found.farthest
            ? text_at_most(found.farthest, true)
            : fmt::format("{} to {}", text_at_most(found.nearest), text_at_most(found.farthest, true));
    findings.push_back({"near-vertices",
                        fmt::format("{} boundary {} {} from another one: not merged", found.near,
                                    found.near == 1 ? "vertex is" : "vertices are", gaps),
                        fmt::format("--weld {} merges {}", text_at_most(found.farthest, true),
                                    found.near == 1 ? "it" : "them")});
  }
  if (found.on_edges > 0) {
    findings.push_back({"t-junctions",
                        fmt::format("{} boundary {} on another boundary edge: the faces are not joined there",
                                    found.on_edges, found.on_edges == 1 ? "vertex stands" : "vertices stand"),
                        ""});
  }
  return findings;
}

void note_coincidences(const ControlMesh& mesh, const std::string& path, const CommonOptions& options) {
  const Notes note = notes_for(options);
  if (!note) return;
  for (const Finding& found : coincidences_found(mesh)) {
    note(path + ": " + found.text + (found.mends.empty() ? "" : "; " + found.mends));
  }
}

std::optional<double> sharp_angle(const CommonOptions& options) {
  const std::string& text = options.sharp;
  if (text.empty()) return {};
  if (text == "auto") return default_sharp_angle;
  double angle = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), angle);
  if (error != std::errc() || end != text.data() + text.size() || !(angle >= 0 && angle < 180)) {
    throw UsageError("--sharp: '" + text + "' is not an angle; give degrees from 0 to below 180, or auto");
  }
  return angle;
}

void sharpen_mesh(ControlMesh& mesh, const std::string& path, double angle, const CommonOptions& options) {
  if (is_curve(mesh, options.scheme)) {
    throw UsageError("--sharp: " + path +
                     " is answered as curves, which have no edges to sharpen; leave it out");
  }
  const std::size_t faces = mesh.face_count();
  const SharpenReport done = sharpen(mesh, angle);
  const Notes note = notes_for(options);
  if (!note) return;
  std::string text = fmt::format(
      "{}: --sharp {} made {} creases and {} corners; {} planar and {} curved regions stay as they are", path,
      angle, done.creases, done.corners, done.flat_regions, done.fixed_regions);
  if (done.split_faces > 0) {
    text +=
        fmt::format("; {} of their faces were not convex and are split into triangles, new ones from {} on",
                    done.split_faces, faces);
  }
  if (done.crossed_faces > 0) {
    text +=
        fmt::format("; {} of their faces cross themselves, and their surface may differ", done.crossed_faces);
  }
  note(text);
}

void note_smoothing(const Surface& surface, const std::string& path, const CommonOptions& options,
                    const std::string& scheme, std::optional<double> apart) {
  const Notes note = notes_for(options);
  if (!note || surface.traits().local) return;
  if (options.sharp.empty()) {
    if (scheme != "auto") return;
    const std::string line = smoothing_note(surface, "--scheme", apart, {.threads = options.threads});
    if (!line.empty()) note(path + ": " + line);
    return;
  }
  if (!apart && surface.mesh().face_count() > max_measured_faces) return;
  if (!apart) apart = limit_to_faces(surface, {.threads = options.threads});
  if (apart && *apart > 0) {
    note(path + ": where it is smooth the limit surface differs from the faces: at most " +
         text_of_length(*apart, surface.size()));
  }
}

}  // namespace snug::command
