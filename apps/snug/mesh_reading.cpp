#include "mesh_reading.h"

#include <fmt/core.h>
#include <snug/mesh/weld.h>

namespace snug::command {

WeldDistance weld_distance(const CommonOptions& options) {
  if (options.weld.empty()) return {};
  return [length = parse_length(options.weld, "--weld", true)](double size) {
    return length.in_mesh_units(size);
  };
}

void note_coincidences(const ControlMesh& mesh, const std::string& path, const CommonOptions& options) {
  const Notes note = notes_for(options);
  if (!note) return;
  const Coincidences found = coincidences(mesh);
  if (found.vertices > 0) {
    const std::string edges =
        found.edges == 0 ? "" : fmt::format(" and {} boundary edges lie on others", found.edges);
    note(fmt::format(
        "{}: {} vertices stand exactly where others stand, in {} place{}{}: they are not joined; --weld 0 "
        "joins them",
        path, found.vertices, found.places, found.places == 1 ? "" : "s", edges));
  }
  if (found.near > 0) {
    const std::string gaps =
        found.nearest == found.farthest
            ? text_at_most(found.farthest, true)
            : fmt::format("{} to {}", text_at_most(found.nearest), text_at_most(found.farthest, true));
    note(fmt::format("{}: {} boundary {} {} from another one: not joined; --weld {} joins {}", path,
                     found.near, found.near == 1 ? "vertex is" : "vertices are", gaps,
                     text_at_most(found.farthest, true), found.near == 1 ? "it" : "them"));
  }
}

}  // namespace snug::command
