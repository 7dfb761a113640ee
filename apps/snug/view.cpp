#include <snug/tessellate.h>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <support/atomic_file.h>
#include <support/error.h>
#include <support/read_file.h>

#include "common.h"
#include "mesh_reading.h"
#include "pose.h"
#include "process.h"
#include "progress_bar.h"
#include "scene_file.h"
#include "still_page.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::vector<std::string> meshes, poses;
  bool nearest_rigid = false;
  std::string answer, page, scene;
};

constexpr std::string_view data_begins = R"(<script type="application/json" id="snug-data">)";
constexpr std::string_view data_ends = "</script>";

// Where the page with live answers lies: installed, beside the command; in a clone, where `make page` puts it. Builds without
// emscripten have none, and fill the still page, which the command holds itself.
std::optional<std::string> find_page() {
  std::error_code ignored;
  const std::filesystem::path folder = process::folder();
  for (const char* place : {"../share/snug/view.html", "../../web/snug.html"}) {
    const std::filesystem::path page = (folder / place).lexically_normal();
    if (std::filesystem::exists(page, ignored)) return page.string();
  }
  return {};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

// Only distinguishes an answer from another file; the page reads it.
std::string read_answer(const std::string& path) {
  std::string text = read_file(path);
  const auto begin = text.find_first_not_of(" \t\r\n"), end = text.find_last_not_of(" \t\r\n");
  const bool document = begin != std::string::npos && text[begin] == '{' && text[end] == '}';
  if (!document || text.find("\"distance\"") == std::string::npos) {
    throw InputError(
        InputProblem::unreadable,
        input_name(path) + ": is not an answer of collide or distance; make one with -o FILE.json");
  }
  return text;
}

void write_place(JsonWriter& json, const Motion& pose) {
  json.key("place").begin_array();
  for (const double number : pose.numbers()) json.value(number);
  json.end_array();
}

template <typename T>
std::string bytes_of(const std::vector<T>& numbers) {
  const auto bytes = std::as_bytes(std::span(numbers));
  return base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

// Triangles within 0.2 % of the size, if not too many are needed, for the page that cannot make its own.
void write_still(JsonWriter& json, const Surface& surface) {
  TessellateOptions how;
  how.error = 0.002 * surface.size();
  how.max_triangles = 60000;
  const Tessellation made = tessellate(surface, how);
  std::vector<float> positions;
  for (const Point3& p : made.positions) {
    for (const double x : {p.x, p.y, p.z}) positions.push_back(static_cast<float>(x));
  }
  std::vector<std::uint32_t> triangles;
  for (const auto& corners : made.triangles)
    triangles.insert(triangles.end(), corners.begin(), corners.end());
  json.key("still").begin_object().field("positions", bytes_of(positions));
  json.field("triangles", bytes_of(triangles)).end_object();
}

// A file's content, which parts name by its place among all; for the still page, what is drawn of it.
void write_file(JsonWriter& json, const std::string& name, std::string_view bytes, const Surface& surface,
                bool still) {
  json.begin_object().field("name", name).field("base64", base64(bytes));
  if (still) write_still(json, surface);
  json.end_object();
}

// `files` and `parts` of the meshes on the command line; equal names are one file.
void write_meshes(JsonWriter& json, const Options& options, const std::vector<Motion>& poses, bool still) {
  std::map<std::string, std::size_t> files;
  json.key("files").begin_array();
  for (const std::string& path : options.meshes) {
    if (!files.emplace(path, files.size()).second) continue;
    // Refused here, not in the page.
    const Surface surface = read_surface(path, options, options.scheme);
    write_file(json, path, read_file(path), surface, still);
  }
  json.end_array().key("parts").begin_array();
  for (std::size_t part = 0; part < options.meshes.size(); ++part) {
    const std::string& path = options.meshes[part];
    json.begin_object().field("name", path).field("scheme", options.scheme).field("file", files.at(path));
    if (part < poses.size()) write_place(json, poses[part]);
    json.end_object();
  }
  json.end_array();
}

// A mesh of a scene as its part has it read: with the scheme and the boundary rule as tags, welded and sharpened.
std::string as_read(const SceneMesh& mesh, const Surface& surface) {
  ControlMesh control = surface.mesh();
  control.tags.scheme = surface.scheme();
  if (!mesh.options.boundary.empty()) control.tags.boundary = surface.boundary();
  return format_mesh(control, "part.obj");
}

// `files` and `parts` of a scene. `options`: what the command about two parts needs, to read a mesh in the same way.
void write_scene(JsonWriter& json, const LoadedScene& loaded, bool still) {
  const std::vector<SceneMesh>& meshes = loaded.text.meshes;
  json.key("files").begin_array();
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    write_file(json, meshes[i].file, as_read(meshes[i], loaded.surfaces[i]), loaded.surfaces[i], still);
  }
  json.end_array().key("parts").begin_array();
  for (const SceneText::Part& part : loaded.text.parts) {
    const SceneMesh& mesh = meshes[part.mesh];
    json.begin_object().field("name", part.name).field("file", part.mesh);
    write_place(json, part.pose);
    json.key("options").begin_object();
    if (mesh.options.scheme != "auto") json.field("--scheme", mesh.options.scheme);
    if (!mesh.options.boundary.empty()) json.field("--boundary", mesh.options.boundary);
    if (!mesh.options.sharp.empty()) json.field("--sharp", mesh.options.sharp);
    if (!mesh.options.weld.empty()) json.field("--weld", mesh.options.weld);
    json.end_object().end_object();
  }
  json.end_array();
}

// Data of the page, as a JSON document without '<', which might look like an end of the script.
std::string data_of(const Options& options, const std::vector<Motion>& poses, const LoadedScene* scene,
                    bool still) {
  std::string text;
  JsonWriter json([&](std::string_view part) { text += part; }, JsonWriter::Lines::one);
  json.begin_object();
  if (scene) {
    write_scene(json, *scene, still);
  } else {
    write_meshes(json, options, poses, still);
    if (const std::optional<double> angle = sharp_angle(options)) json.field("sharp", *angle);
  }
  if (!options.answer.empty()) json.field("answer", read_answer(options.answer));
  json.end_object().finish();
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe += "\\u003c" : safe += c;
  return safe;
}

std::string filled(const std::string& page, const std::string& name, const std::string& data) {
  const auto at = page.find(data_begins);
  const auto end = at == std::string::npos ? at : page.find(data_ends, at);
  if (end == std::string::npos) {
    throw InputError(InputProblem::unreadable, name + ": is not snug's page; build it with make page");
  }
  return page.substr(0, at) + std::string(data_begins) + data + page.substr(end);
}

void require_sound(const Options& options) {
  if (options.output.empty()) throw UsageError("view: -o FILE.html is missing: where the page goes");
  if (options.json && options.output == "-") {
    throw UsageError("view: --json and -o - both want standard output");
  }
  if (!options.scene.empty() && !options.meshes.empty()) {
    throw UsageError("view: give meshes or --scene, not both");
  }
  for (const std::string& path : options.meshes) {
    if (path == "-") throw UsageError("view: give the meshes as files, not on standard input");
  }
  if (options.nearest_rigid && options.poses.empty() && options.scene.empty()) {
    throw UsageError("view: --nearest-rigid needs --place or --scene");
  }
  if (options.scene.empty() && options.poses.size() > options.meshes.size()) {
    throw UsageError(
        fmt::format("view: {} times --place, but {} meshes", options.poses.size(), options.meshes.size()));
  }
}

ExitStatus run(const Options& options) {
  require_sound(options);
  const Mending mending{options.nearest_rigid, notes_for(options)};
  std::vector<Motion> poses;
  for (const std::string& text : options.poses) poses.push_back(parse_pose(text, "--place", mending));
  const WorkMonitor monitor = stopped_by_interrupts();
  std::optional<LoadedScene> scene;
  if (!options.scene.empty()) {
    scene = load_scene(
        options.scene, options, options.nearest_rigid,
        [&](const std::string& path) { return read_file(path, monitor); }, monitor);
  }
  const std::optional<std::string> name = options.page.empty() ? find_page() : options.page;
  const std::string data = data_of(options, poses, scene ? &*scene : nullptr, !name);
  const std::string page =
      name ? filled(read_file(*name), *name, data) : filled(std::string(still_page), "still.html", data);
  if (const Notes note = notes_for(options); note && !name) {
    note(
        "parts stay where they are: this build of snug lacks the page with live answers, which make page "
        "builds");
  }
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("view", to_standard_output);
  std::vector<std::string> meshes = options.meshes, schemes(meshes.size(), options.scheme);
  if (scene) {
    for (std::size_t i = 0; i < scene->surfaces.size(); ++i) {
      meshes.push_back(scene->text.meshes[i].file);
      schemes.push_back(name_of(scene->surfaces[i].scheme()));
    }
  }
  const std::size_t parts = scene ? scene->text.parts.size() : meshes.size();
  report.heads(meshes, schemes);
  AtomicFile file(options.output);
  file.write(page);
  if (report.json()) {
    report.write().field("bytes", page.size());
  } else if (options.output != "-") {
    report.text(fmt::format("{}: {} {} in a page of {:.1f} MB; open it in a browser", options.output, parts,
                            parts == 1 ? "part" : "parts", static_cast<double>(page.size()) / 1e6));
  }
  return report.finish(true, {&file});
}

}  // namespace

Command view_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->meshes, "Control meshes (OBJ, OFF, PLY, STL, USD, glTF or 3MF)")
      .unless("--scene");
  list.add(Group::own, "--scene FILE", &options->scene,
           "Show the parts that a JSON file names and places, instead of meshes");
  list.add(Group::own, "--answer FILE", &options->answer,
           "Show this JSON answer of collide or distance for the first two meshes, in its poses")
      .excludes("--scene");
  list.add(Group::own, "--template FILE", &options->page,
           "Page template to use instead of the installed one");
  list.add(Group::placement, "--place \"NUMBERS\"", &options->poses,
           "Pose of the first mesh; repeat for the second, and so on")
      .excludes("--scene");
  add_nearest_rigid_option(list, options->nearest_rigid);
  add_scheme_option(
      list, "--scheme", options->scheme,
      "Subdivision scheme; auto: flat for STL, glTF and 3MF, the file's own if it names one, loop "
      "if all faces are triangles, otherwise catmark");
  list.add(Group::mesh, "--sharp ANGLE", &options->sharp,
           "Edges whose face normals differ by more than ANGLE degrees stay sharp; auto: 30");
  add_output_options(list, *options);
  return {"view",
          Topic::two_surfaces,
          "Write a page for moving parts in a browser, with live answers",
          {"snug view bracket.obj pin.obj --answer answer.json -o parts.html",
           "snug view --scene assembly.json -o assembly.html"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
