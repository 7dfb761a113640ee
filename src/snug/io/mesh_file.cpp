#include <snug/io/mesh_file.h>

#include <algorithm>
#include <filesystem>

#include <snug/base/error.h>
#include <snug/io/atomic_file.h>
#include <snug/io/obj.h>
#include <snug/io/off.h>
#include <snug/io/read_file.h>

namespace snug {
namespace {

std::string lower_case_ending(const std::string& path) {
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return ending;
}

[[noreturn]] void refuse_ending(const std::string& path) {
  throw InputError(InputProblem::unreadable, path + ": meshes are read and written as .obj and .off only");
}

bool changes_surface(const MeshTags& tags) {
  return !tags.creases.empty() || !tags.corners.empty() || !tags.holes.empty() || tags.boundary ||
         tags.crease_method != CreaseMethod::uniform || tags.smooth_triangles != SmoothTriangles::catmark;
}

}  // namespace

ControlMesh read_mesh(const std::string& path, const Notes& notes, const WorkMonitor& monitor) {
  const std::string ending = path == "-" ? "" : lower_case_ending(path);
  if (!ending.empty() && ending != ".obj" && ending != ".off") refuse_ending(path);
  const std::string text = read_file(path, monitor);
  const std::string name = input_name(path);
  const bool off = ending.empty() ? begins_like_off(text) : ending == ".off";
  return off ? parse_off(text, name) : parse_obj(text, name, notes);
}

void write_mesh(const ControlMesh& mesh, const std::string& path, const Notes& notes) {
  const std::string ending = path == "-" ? ".obj" : lower_case_ending(path);
  if (ending != ".obj" && ending != ".off") refuse_ending(path);
  const bool off = ending == ".off";
  if (off && notes && changes_surface(mesh.tags))
    notes(path + ": OFF has no tags: creases and rules are left out");
  AtomicFile file(path);
  file.write(off ? format_off(mesh) : format_obj(mesh));
  file.commit();
}

}  // namespace snug
