#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/mesh.h>
#include <snug/surface.h>
#include <support/number.h>

#include "command_line.h"
#include "exit_status.h"
#include "json_writer.h"
#include "length.h"
#include "options.h"

namespace snug {
class AtomicFile;
}

namespace snug::command {

/// Options that several commands take.
struct CommonOptions {
  std::string scheme = "auto";
  std::string boundary;  ///< empty: the file's tag, else edge-and-corner
  std::string bounds = "rows";
  bool json = false;
  std::string output;       ///< -o; empty for none
  std::string certificate;  ///< --certificate; empty for none
  int threads = 0;
  std::uint64_t max_splits = default_splits::bound;
  std::string weld;   ///< a length; empty: only equal vertices of STL and glTF files are
  std::string sharp;  ///< an angle or auto; empty: only what tags make sharp
  std::string units;  ///< of coordinates, after --scale; empty: those that the file states
  double scale = 1;   ///< coordinates are multiplied by it
  bool quiet = false;
};

/// Help of the argument MESH.
inline constexpr const char *mesh_help = "Control mesh (OBJ, OFF, PLY, STL, USD, glTF or 3MF)",
                            *mesh_or_input_help =
                                "Control mesh (OBJ, OFF, PLY, STL, USD, glTF or 3MF; - for standard input)";

/// Those of every command: --scheme, --boundary, --weld, --sharp, --scale, --units, and those below.
void add_common_options(OptionList& list, CommonOptions& options);
/// Those of commands without a mesh: --json, -o, --quiet, --threads.
void add_output_options(OptionList& list, CommonOptions& options);
/// Those of commands that bound patches: --max-splits, --bounds. Returns both.
std::array<Option*, 2> add_bound_options(OptionList& list, CommonOptions& options);
/// Adds an option that names a scheme of surfaces, under the names of other programs too.
Option& add_scheme_option(OptionList& list, const std::string& name, std::string& scheme,
                          const std::string& help);

/// The scheme that --scheme (or an override of it) names for this mesh.
[[nodiscard]] Scheme choose_scheme(const std::string& name, const ControlMesh& mesh);
/// How a mesh becomes a surface: with the options given, else by its tags.
/// Errors:    UsageError for --sharp and --boundary with a dual scheme.
[[nodiscard]] SurfaceOptions surface_options(const CommonOptions& options, const std::string& scheme,
                                             const ControlMesh& mesh);

/// How queries run: --threads, --max-splits, and a monitor that outlives them.
[[nodiscard]] Run run_of(const CommonOptions& options, const WorkMonitor& monitor,
                         Workspace* workspace = nullptr);

/// Where notes of readers and writers go: standard error, unless quiet, each line once.
[[nodiscard]] Notes notes_for(const CommonOptions& options);

/// Reads a file that another one names: ReadOptions::other_file.
using OtherFile = std::function<std::string(const std::string& path)>;

/// Reads a control mesh, welds and sharpens it as the options say.
/// Errors:    UsageError for --weld that is no length and --sharp that is no angle, or for curves.
[[nodiscard]] ControlMesh load_mesh(const std::string& path, const CommonOptions& options);
/// The same for the bytes that the file holds.
[[nodiscard]] ControlMesh mesh_of(std::string_view bytes, const std::string& path,
                                  const CommonOptions& options, OtherFile other_file = {});
/// The same for all meshes of a file, each as it is.
[[nodiscard]] MeshAssembly assembly_of(std::string_view bytes, const std::string& path,
                                       const CommonOptions& options, OtherFile other_file);

/// Reads a mesh and makes its surface. Refusals name the file.
[[nodiscard]] Surface read_surface(const std::string& path, const CommonOptions& options,
                                   const std::string& scheme);
/// The same for a mesh that has been read from `path`.
[[nodiscard]] Surface make_surface(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                                   const std::string& scheme);
/// Metres of a unit of its mesh, if they are known.
[[nodiscard]] std::optional<double> units_of(const Surface& surface);
/// The same of several meshes that one answer is about; `names`: their files.
/// Errors:    InputError (refused) if the units of two are known and differ.
[[nodiscard]] std::optional<double> common_units(std::span<const std::optional<double>> units,
                                                 std::span<const std::string> names);
[[nodiscard]] std::optional<double> common_units(std::span<const Surface> surfaces,
                                                 std::span<const std::string> names);
/// Throws InputError (refused) unless the surface bounds a solid.
void require_closed(const Surface& surface);
/// Calls `work` and puts the name of the file in front of refusals it throws.
void naming(const std::string& path, const std::function<void()>& work);

/// Writes a mesh into a file that was opened for `path`.
void write_mesh(const ControlMesh& mesh, AtomicFile& file, const std::string& path,
                const CommonOptions& options, std::span<const Vector3> normals = {});
/// The same for faces that are meant as they are, which is said where the format names schemes; `units`: metres of one.
void write_facets(ControlMesh mesh, AtomicFile& file, const std::string& path, const CommonOptions& options,
                  std::optional<double> units, std::span<const Vector3> normals = {});

/// The method that --bounds names.
[[nodiscard]] BoundMethod bound_method(const CommonOptions& options);

/// Before any work: can what -o names be written, and is its ending one that the command writes?
/// Errors:    UsageError for an ending; InputError (unreadable) for what cannot be written. Nothing is left
///            of the trial.
void require_output(const std::string& command, const std::string& output);

/// The output of a command: one JSON document on standard output or in the file of -o, or a few lines of
/// text.
///
/// The head of the document (command, version) is written at once; mesh and scheme by heads(); finish() adds
/// seconds.
class Report {
 public:
  Report(const char* command, const CommonOptions& options);
  ~Report();

  /// Is a document wanted? Else write() is not to be called.
  [[nodiscard]] bool json() const { return writer_ != nullptr; }
  [[nodiscard]] JsonWriter& write() { return *writer_; }
  void heads(const std::vector<std::string>& meshes, const std::vector<std::string>& schemes);
  /// One line for people on standard output; nothing with --json, or where the document goes there.
  void text(const std::string& line);
  /// Lets out what stands so far at once: lines, and a document where it goes to a stream.
  void flush();
  /// The end of a command: ends the document and puts the file in place, and others that the command has
  /// written. Where anything cannot be written, none is left. What the command ends with: was all
  /// `reached` that was asked for?
  /// Notes:     one line if threads could not be started.
  /// Errors:    InputError (unreadable) if standard output or a file cannot be written; Interrupted.
  ExitStatus finish(bool reached = true, const std::vector<AtomicFile*>& others = {});

 private:
  struct Target;
  Notes notes_;
  std::chrono::steady_clock::time_point start_;
  std::unique_ptr<Target> target_, text_;  // the document, and lines for people
  std::unique_ptr<JsonWriter> writer_;
};

[[nodiscard]] Command info_command();
[[nodiscard]] Command judge_command();
[[nodiscard]] Command bound_command();
[[nodiscard]] Command eval_command();
[[nodiscard]] Command subdivide_command();
[[nodiscard]] Command tessellate_command();
[[nodiscard]] Command convert_command();
[[nodiscard]] Command robot_command();
[[nodiscard]] Command hull_command();
[[nodiscard]] Command envelope_command();
[[nodiscard]] Command collide_command();
[[nodiscard]] Command clearance_command();
[[nodiscard]] Command contact_command();
[[nodiscard]] Command distance_command();
[[nodiscard]] Command measure_command();
[[nodiscard]] Command self_command();
[[nodiscard]] Command closest_command();
[[nodiscard]] Command ray_command();
[[nodiscard]] Command deviation_command();
[[nodiscard]] Command render_command();
[[nodiscard]] Command view_command();

}  // namespace snug::command
