#include <snug/mesh.h>
#include <snug/scene.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include <snug/io/formats.h>
#include <snug/io/zip.h>
#include <snug/mesh/loose_creases.h>
#include <snug/scheme/scheme.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/run.h>
#include <support/system_files.h>

namespace snug {
namespace {

/// The lower-case ending of a name, which is its format; refused if it is not among those known.
std::string format_among(std::initializer_list<std::string_view> known, const std::string& path,
                         const char* what) {
  std::string ending = system_files::ending_of(path);
  if (std::ranges::find(known, ending) == known.end()) {
    throw InputError(InputProblem::unreadable, path + ": meshes are " + what + " files only");
  }
  return ending;
}

/// The ending that names the format to write.
std::string format_to_write(const std::string& path) {
  if (path == "-") return ".obj";
  return format_among({".obj", ".off", ".ply", ".stl", ".glb", ".gltf", ".3mf", ".usda"}, path,
                      "written to .obj, .off, .ply, .stl, .glb, .gltf, .3mf and .usda");
}

bool holds_tags(const std::string& ending) { return ending == ".obj" || ending == ".usda"; }

/// Notes tags that a format without them drops although they change the surface.
void note_dropped_tags(const ControlMesh& mesh, const std::string& path, bool facets, const Notes& notes) {
  const std::optional<Scheme> scheme = mesh.tags.scheme;
  const Scheme read_back = facets ? Scheme::flat : scheme_of_faces(mesh);
  if (has_rules(mesh.tags) || (scheme && *scheme != read_back && *scheme != Scheme::flat)) {
    notes(path + ": this format has no tags: creases and rules are dropped");
  }
  if (scheme == Scheme::flat && read_back != Scheme::flat) {
    notes(path +
          ": this format does not say that its triangles are meant as they are, and who reads it may smooth "
          "them; "
          "OBJ, STL, glTF, 3MF and USD say so");
  }
}

/// The format of a file whose name does not show it.
std::string sniffed_format(std::string_view bytes) {
  if (begins_like_ply(bytes)) return ".ply";
  if (begins_like_gltf(bytes)) return ".glb";
  if (begins_like_zip(bytes) && bytes.find("_rels/.rels") != std::string_view::npos) return ".3mf";
  if (begins_like_usda(bytes)) return ".usda";
  return begins_like_off(bytes) ? ".off" : ".obj";
}

std::string formatted(const ControlMesh& mesh, const std::string& ending, const std::string& path,
                      const Notes& notes, std::span<const Vector3> normals) {
  if (ending == ".off") return format_off(mesh);
  if (ending == ".ply") return format_ply(mesh);
  if (ending == ".stl") return format_stl(mesh, path, notes);
  if (ending == ".usda") return format_usda(mesh, path, notes);
  if (ending == ".glb") return format_glb(mesh, path, notes, normals);
  if (ending == ".gltf") return format_gltf(mesh, path, notes, normals);
  if (ending == ".3mf") return format_3mf(mesh, path, notes);
  return format_obj(mesh);
}

bool by_assimp(std::string_view ending) {
  return std::ranges::find(assimp_endings, ending) != assimp_endings.end();
}

/// The ending that names the format to read; empty for none.
std::string format_to_read(const std::string& path) {
  if (std::string ending = system_files::ending_of(path); by_assimp(ending)) return ending;
  return format_among(
      {"", ".obj", ".off", ".ply", ".stl", ".usda", ".usd", ".usdc", ".usdz", ".glb", ".gltf", ".3mf"}, path,
      "read from .obj, .off, .ply, .stl, .usda, .glb, .gltf and .3mf");
}

ControlMesh parsed(std::string_view bytes, const std::string& ending, const std::string& name,
                   const ReadOptions& options) {
  if (ending == ".off") return parse_off(bytes, name);
  if (ending == ".ply") return parse_ply(bytes, name);
  if (ending == ".stl") return parse_stl(bytes, name);
  if (ending == ".glb" || ending == ".gltf")
    return parse_gltf(bytes, name, options.other_file, options.notes);
  if (ending == ".3mf") return parse_3mf(bytes, name, options.notes);
  if (by_assimp(ending)) return joined(read_assimp(bytes, ending, name, options.notes), name, options.notes);
  if (ending.starts_with(".usd")) return parse_usda(bytes, name, options.notes);  // refuses binary ones
  return parse_obj(bytes, name, options.notes);
}

/// Formats that hold several meshes; nothing for others.
std::optional<PlacedMeshes> parsed_parts(std::string_view bytes, const std::string& ending,
                                         const std::string& name, const ReadOptions& options) {
  if (ending == ".glb" || ending == ".gltf") return read_gltf(bytes, name, options.other_file, options.notes);
  if (ending == ".3mf") return read_3mf(bytes, name, options.notes);
  if (by_assimp(ending)) return read_assimp(bytes, ending, name, options.notes);
  if (ending.starts_with(".usd")) return read_usda(bytes, name, options.notes);
  return {};
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

std::string report_of(const WeldReport& welded) {
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

void note_loose_creases(const ControlMesh& mesh, const std::string& name, const Notes& notes) {
  const std::vector<std::size_t> loose = loose_creases(mesh);
  if (loose.empty()) return;
  const CreaseTag& first = mesh.tags.creases[loose.front()];
  notes(name + ": " + counted(loose.size(), "crease names", "creases name") +
        " no edge of a face: " + (loose.size() > 1 ? "the first is " : "") + "(" +
        std::to_string(first.a.value()) + ", " + std::to_string(first.b.value()) + ")");
}

}  // namespace

namespace {

std::string format_to_read(const std::string& path, std::string_view bytes) {
  const std::string ending = format_to_read(path);
  return ending.empty() ? sniffed_format(bytes) : ending;
}

/// A mesh that was read, as the options want it.
void finish(ControlMesh& mesh, const std::string& name, const ReadOptions& options) {
  if (options.weld) {
    try {
      const WeldReport welded = weld(mesh, options.weld(size_of(mesh)));
      if (options.notes) options.notes(name + ": " + report_of(welded));
    } catch (const InputError& error) {
      throw InputError(error.problem(), name + ": " + error.what());
    }
  }
  if (options.notes) note_loose_creases(mesh, name, options.notes);
}

/// With files beside that of the path, unless the caller has them.
ReadOptions beside(const std::string& path, ReadOptions options, const Run& run) {
  if (!options.other_file && path != "-") {
    options.other_file = [folder = system_files::path_of(path).parent_path(),
                          monitor = monitor_of(run)](const std::string& other) {
      return read_file(system_files::name_of(folder / system_files::path_of(other)), monitor);
    };
  }
  return options;
}

}  // namespace

ControlMesh parse_mesh(std::string_view bytes, const std::string& path, const ReadOptions& options) {
  const std::string name = input_name(path);
  ControlMesh mesh = parsed(bytes, format_to_read(path, bytes), name, options);
  finish(mesh, name, options);
  return mesh;
}

MeshAssembly parse_assembly(std::string_view bytes, const std::string& path, const ReadOptions& options) {
  const std::string name = input_name(path), ending = format_to_read(path, bytes);
  std::optional<PlacedMeshes> parts = parsed_parts(bytes, ending, name, options);
  MeshAssembly result;
  if (parts) {
    result = assembled(std::move(*parts), name, options.notes);
  } else {
    result.meshes.push_back(parsed(bytes, ending, name, options));
    result.parts.push_back({system_files::stem_of(name), 0, {}});
  }
  for (ControlMesh& mesh : result.meshes) finish(mesh, name, options);
  return result;
}

ControlMesh read_mesh(const std::string& path, const ReadOptions& options, const Run& run) {
  static_cast<void>(format_to_read(path));  // before the file is opened
  return parse_mesh(read_file(path, monitor_of(run)), path, beside(path, options, run));
}

MeshAssembly read_assembly(const std::string& path, const ReadOptions& options, const Run& run) {
  static_cast<void>(format_to_read(path));
  return parse_assembly(read_file(path, monitor_of(run)), path, beside(path, options, run));
}

MeshFormat format_of(const std::string& path) {
  const std::string ending = format_to_write(path);
  const bool gltf = ending == ".glb" || ending == ".gltf", floats = gltf || ending == ".stl";
  return {.polygons = !floats && ending != ".3mf",
          .floats = floats,
          .normals = gltf,
          .scheme = ending == ".usda"};
}

std::string format_mesh(const ControlMesh& mesh, const std::string& path, const WriteOptions& options,
                        const Run& run) {
  const std::string ending = format_to_write(path);
  require_value(options.normals.empty() || options.normals.size() == mesh.vertex_count(),
                "write_mesh: give a normal for each vertex, or none");
  const Notes& notes = options.notes;
  if (notes && !holds_tags(ending)) note_dropped_tags(mesh, path, !format_of(path).polygons, notes);
  if (notes && ending != ".obj" && mesh.polyline_count() > 0) {
    notes(path + ": this format has no polylines: they are dropped");
  }
  monitor_of(run).checkpoint();
  return formatted(mesh, ending, path, notes, options.normals);
}

std::string format_assembly(const MeshAssembly& assembly, const std::string& path,
                            const WriteOptions& options, const Run& run) {
  if (system_files::ending_of(path) != ".3mf") {
    throw InputError(InputProblem::unreadable,
                     path + ": parts in their places are written to .3mf files only");
  }
  for (const MeshAssembly::Part& part : assembly.parts) {
    require_value(part.mesh < assembly.meshes.size(), "an assembly has a part whose mesh does not exist");
  }
  if (options.notes) {
    for (const ControlMesh& mesh : assembly.meshes) note_dropped_tags(mesh, path, true, options.notes);
  }
  monitor_of(run).checkpoint();
  return format_3mf(assembly, path, options.notes);
}

void write_mesh(const ControlMesh& mesh, const std::string& path, const WriteOptions& options,
                const Run& run) {
  static_cast<void>(format_to_write(path));
  AtomicFile file(path);
  file.write(format_mesh(mesh, path, options, run), monitor_of(run));
  file.commit();
}

}  // namespace snug
