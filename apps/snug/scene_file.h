#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <snug/scene.h>

#include "common.h"

namespace snug::command {

/// A mesh of a scene with the options it is read by: parts that say the same share it.
struct SceneMesh {
  std::string path;       ///< as the scene file names it; in a file of several meshes FILE#0 and so on
  std::string file;       ///< relative paths begin at the scene file's folder
  CommonOptions options;  ///< those of the command line, with what the part says in place of some
};

/// Contents of a scene file.
struct SceneText {
  struct Part {
    std::string name;    ///< its place where the file gives none
    std::uint32_t mesh;  ///< in `meshes`
    Motion pose;
  };
  std::vector<Part> parts;
  std::vector<SceneMesh> meshes;
  std::optional<std::vector<PartPair>> pairs;
  std::vector<PairMargin> margins;
  double margin = 0;
  std::optional<Length> tolerance;
};

/// Reads a scene, as docs/assemblies.md describes it.
///
/// Guarantee: numbers are the nearest doubles.
/// Errors:    InputError, one line with the file's name and a line and column, or a path such as parts[3].place: unreadable;
///            pose for a placement that is not rigid.
/// Cost:      about a kilobyte a part while it is read.
[[nodiscard]] SceneText parse_scene(const std::string& bytes, const std::string& path,
                                    const CommonOptions& options, bool nearest_rigid);

/// A scene with its surfaces, and what names and writing need.
struct LoadedScene {
  SceneText text;
  std::vector<Surface> surfaces;  ///< one a mesh
  Scene scene;
  std::uint64_t fingerprint = 0;  ///< of the bytes of the scene and of its meshes
};

/// The bytes of a file that all ranks of a job read together.
using ReadBytes = std::function<std::string(const std::string& path)>;

/// Reads a scene and its meshes, each file once. A file of several meshes, such as glTF or 3MF, is a scene by its ending.
/// Errors:    those of parse_scene(), read_assembly(), load_mesh() and Surface; refusals of a mesh name its file.
[[nodiscard]] LoadedScene load_scene(const std::string& path, const CommonOptions& options,
                                     bool nearest_rigid, const ReadBytes& read, const WorkMonitor& monitor);

/// FNV-1a, from a previous value on: to distinguish files, not against attackers.
[[nodiscard]] std::uint64_t fingerprint(std::string_view bytes, std::uint64_t from = 0xcbf29ce484222325u);

}  // namespace snug::command
