#include <snug/io/mesh_file.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include <snug/base/error.h>
#include <snug/io/atomic_file.h>
#include <snug/io/glb.h>
#include <snug/io/number.h>
#include <snug/io/obj.h>
#include <snug/io/off.h>
#include <snug/io/ply.h>
#include <snug/io/read_file.h>
#include <snug/mesh/weld.h>

namespace snug {
namespace {

std::string lower_case_ending(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

[[noreturn]] void refuse_ending(const std::string& path, const std::string& what) {
  throw InputError(InputProblem::unreadable, path + ": meshes are " + what);
}

/// The ending that names the format to write.
std::string format_to_write(const std::string& path) {
  std::string ending = path == "-" ? ".obj" : lower_case_ending(path);
  constexpr std::array<std::string_view, 5> known{".obj", ".off", ".ply", ".stl", ".glb"};
  if (std::find(known.begin(), known.end(), ending) == known.end()) {
    refuse_ending(path, "written to .obj, .off, .ply, .stl and .glb files only");
  }
  return ending;
}

bool changes_surface(const MeshTags& tags) {
  return !tags.creases.empty() || !tags.corners.empty() || !tags.holes.empty() || tags.boundary ||
         tags.crease_method != CreaseMethod::uniform || tags.smooth_triangles != SmoothTriangles::catmark;
}

/// The format of a file whose name does not tell.
std::string sniffed_format(std::string_view bytes) {
  if (begins_like_ply(bytes)) return ".ply";
  return begins_like_off(bytes) ? ".off" : ".obj";
}

std::string formatted(const ControlMesh& mesh, const std::string& ending, const std::string& path,
                      const Notes& notes) {
  if (ending == ".off") return format_off(mesh);
  if (ending == ".ply") return format_ply(mesh);
  if (ending == ".stl") return format_stl(mesh, path, notes);
  if (ending == ".glb") return format_glb(mesh, path, notes);
  return format_obj(mesh);
}

ControlMesh parsed(const std::string& path, const std::string& name, const Notes& notes,
                   const WorkMonitor& monitor) {
  std::string ending = path == "-" ? "" : lower_case_ending(path);
  constexpr std::array<std::string_view, 5> known{"", ".obj", ".off", ".ply", ".stl"};
  if (std::find(known.begin(), known.end(), ending) == known.end()) {
    refuse_ending(path, "read from .obj, .off, .ply and .stl files only");
  }
  const std::string bytes = read_file(path, monitor);
  if (ending.empty()) ending = sniffed_format(bytes);
  if (ending == ".off") return parse_off(bytes, name);
  if (ending == ".ply") return parse_ply(bytes, name);
  if (ending == ".stl") return parse_stl(bytes, name);
  return parse_obj(bytes, name, notes);
}

/// Longest side of the box of the vertices that faces or polylines use.
double size_of(const ControlMesh& mesh) {
  Box3 box = used_box(mesh);
  for (const VertexId v : mesh.polyline_vertices) box.add(mesh.points[v.index()]);
  return longest_side(box);
}

std::string counted(std::size_t count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

std::string told(const Welded& welded) {
  std::string text = "no two vertices are close enough to be welded";
  if (welded.vertices > 0) {
    text = counted(welded.vertices, "vertex was", "vertices were") + " welded to others, at most ";
    append_real(text, welded.farthest);
    text += " away";
  }
  if (welded.shortened > 0) text += "; " + counted(welded.shortened, "face", "faces") + " lost corners";
  if (welded.dropped > 0) {
    text += "; " + counted(welded.dropped, "face was", "faces were") +
            " left with fewer than three corners and dropped: faces are numbered without them";
  }
  return text;
}

}  // namespace

ControlMesh read_mesh(const std::string& path, const ReadOptions& options) {
  const std::string name = input_name(path);
  ControlMesh mesh = parsed(path, name, options.notes, options.monitor);
  if (!options.weld) return mesh;
  try {
    const Welded welded = weld(mesh, options.weld(size_of(mesh)));
    if (options.notes) options.notes(name + ": " + told(welded));
  } catch (const InputError& error) {
    throw InputError(error.problem(), name + ": " + error.what());
  }
  return mesh;
}

void require_writable_ending(const std::string& path) { static_cast<void>(format_to_write(path)); }

bool writes_polygons(const std::string& path) {
  const std::string ending = format_to_write(path);
  return ending != ".stl" && ending != ".glb";
}

void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path, const Notes& notes,
                const WorkMonitor& monitor) {
  const std::string ending = format_to_write(path);
  if (ending != ".obj" && notes && changes_surface(mesh.tags)) {
    notes(path + ": this format has no tags: creases and rules are dropped");
  }
  if (ending != ".obj" && notes && mesh.polyline_count() > 0) {
    notes(path + ": this format has no polylines: they are dropped");
  }
  monitor.checkpoint();
  const std::string bytes = formatted(mesh, ending, path, notes);
  constexpr std::size_t part = std::size_t{1} << 20;
  for (std::size_t begin = 0; begin < bytes.size(); begin += part) {
    monitor.checkpoint();
    file.write(std::string_view(bytes).substr(begin, part));
  }
}

void write_mesh(const ControlMesh& mesh, const std::string& path, const Notes& notes,
                const WorkMonitor& monitor) {
  require_writable_ending(path);
  AtomicFile file(path);
  write_mesh(mesh, file, path, notes, monitor);
  file.commit();
}

}  // namespace snug
