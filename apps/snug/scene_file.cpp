#include "scene_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <unordered_map>

#include <fmt/core.h>
#include <support/error.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/read_file.h>
#include <support/system_files.h>
#include <nlohmann/json.hpp>

#include "curve.h"
#include "mesh_reading.h"
#include "nearest.h"
#include "pose.h"

namespace snug::command {
namespace {

using Json = nlohmann::json;

// Deeper than any scene: parts, a part, a placement, its numbers.
constexpr int max_levels = 8;

// Fit for a message of one line, as meshes' words are: control characters by their codes.
std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= ' ' && byte != 0x7f) {
      result += c;
    } else {
      result += fmt::format("\\x{:02x}", byte);
    }
  }
  return result;
}

[[noreturn]] void fail(const std::string& message) { throw InputError(InputProblem::unreadable, message); }

std::string shortened(const std::string& text) {
  std::size_t size = 40;
  if (text.size() <= size) return text;
  while ((static_cast<unsigned char>(text[size]) & 0xc0) == 0x80) --size;  // not inside a character of UTF-8
  return text.substr(0, size) + "...";
}
// A value as messages quote it.
std::string quoted(const Json& value) {
  return shortened(value.dump(-1, ' ', false, Json::error_handler_t::replace));
}

const char* kind_of(const Json& value) {
  return value.is_object()   ? "an object"
         : value.is_array()  ? "a list"
         : value.is_string() ? "a text"
         : value.is_number() ? "a number"
         : value.is_null()   ? "null"
                             : "true or false";
}

[[noreturn]] void fail_kind(const std::string& where, const Json& value, const std::string& wanted) {
  fail(fmt::format("{} is {}; give {}", where, kind_of(value), wanted));
}

// Looks a text over before a document is made of it: how deep it is, and whether an object has a name twice. A callback of
// Json::parse() could see the same, but with one the parser searches a list anew for each object that it ends.
class Overseer : public nlohmann::json_sax<Json> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override {
    names_.emplace_back();
    return deeper();
  }
  bool key(string_t& name) override {
    if (!names_.back().insert(name).second) fail("\"" + shortened(name) + "\" appears twice in one object");
    return true;
  }
  bool end_object() override {
    names_.pop_back();
    return --depth_, true;
  }
  bool start_array(std::size_t) override { return deeper(); }
  bool end_array() override { return --depth_, true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error ..."
    const std::string text = error.what();
    const auto end = text.find("] ");
    fail("not a scene in JSON: " + (end == std::string::npos ? text : text.substr(end + 2)));
  }

 private:
  bool deeper() {
    if (++depth_ > max_levels) fail(fmt::format("lists and objects nested more than {} deep", max_levels));
    return true;
  }

  std::vector<std::set<std::string>> names_;  // of the objects that are open
  int depth_ = 0;
};

Json parse_document(const std::string& bytes) {
  Overseer overseer;
  Json::sax_parse(bytes, &overseer);
  return Json::parse(bytes);
}

void require_names(const Json& object, const std::string& where, const std::vector<std::string>& known) {
  for (const auto& [name, value] : object.items()) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      fail(fmt::format("{}unknown name \"{}\"{}", where, shortened(name), did_you_mean(name, known)));
    }
  }
}

double number_of(const Json& value, const std::string& where) {
  if (!value.is_number()) fail_kind(where, value, "a number");
  return value.get<double>();
}

double length_of(const Json& value, const std::string& where) {
  const double length = number_of(value, where);
  if (!(length >= 0 && std::isfinite(length))) {
    fail(fmt::format("{}: {} is not a length; give a number >= 0", where, quoted(value)));
  }
  return length;
}

std::string text_of(const Json& value, const std::string& where) {
  if (!value.is_string()) fail_kind(where, value, "a text");
  return value.get<std::string>();
}

std::string text_of_numbers(const Json& value, const std::string& where, std::size_t count) {
  if (value.size() != count) fail(fmt::format("{} has {} numbers, not {}", where, value.size(), count));
  std::string text;
  for (std::size_t i = 0; i < value.size(); ++i) {
    text += ' ';
    append_real(text, number_of(value[i], fmt::format("{}[{}]", where, i)));
  }
  return text;
}

// A text as options have it, or a list of so many numbers.
std::string words_of(const Json& value, const std::string& where, std::size_t count) {
  if (value.is_array()) return text_of_numbers(value, where, count);
  if (!value.is_string()) fail_kind(where, value, fmt::format("a text or a list of {} numbers", count));
  return value.get<std::string>();
}

class SceneReader {
 public:
  SceneReader(const std::string& path, const CommonOptions& options, bool nearest_rigid)
      : folder_(system_files::path_of(path == "-" ? "" : path).parent_path()),
        options_(options),
        mending_{nearest_rigid, notes_for(options)} {}

  SceneText read(const Json& document) {
    if (!document.is_object()) fail_kind("the document", document, "an object with \"parts\"");
    require_names(document, "", {"parts", "pairs", "tolerance", "margin", "margins"});
    if (!document.contains("parts")) fail("\"parts\" is missing");
    const Json& parts = document["parts"];
    if (!parts.is_array()) fail_kind("parts", parts, "a list of parts");
    if (parts.empty()) fail("parts is empty; give at least one part");
    for (std::size_t i = 0; i < parts.size(); ++i) add_part(parts[i], fmt::format("parts[{}]", i));
    if (document.contains("tolerance")) scene_.tolerance = tolerance_of(document["tolerance"]);
    if (document.contains("margin")) scene_.margin = length_of(document["margin"], "margin");
    if (document.contains("pairs")) add_pairs(document["pairs"]);
    if (document.contains("margins")) add_margins(document["margins"]);
    return std::move(scene_);
  }

 private:
  void add_part(const Json& part, const std::string& where) {
    if (!part.is_object()) fail_kind(where, part, "an object with \"mesh\"");
    require_names(part, where + ": ",
                  {"name", "mesh", "scheme", "boundary", "sharp", "weld", "scale", "units", "place"});
    if (!part.contains("mesh")) fail(where + ": \"mesh\" is missing");
    const std::uint32_t place = static_cast<std::uint32_t>(scene_.parts.size());
    const std::string name =
        part.contains("name") ? text_of(part["name"], where + ".name") : std::to_string(place);
    if (name.empty()) fail(where + ".name is empty");
    const auto [known, fresh] = names_.emplace(name, place);
    if (!fresh) {
      fail(fmt::format("{}: the name \"{}\" is that of parts[{}]; give each part its own", where,
                       shortened(name), known->second));
    }
    const std::uint32_t mesh = mesh_of_part(part, where);
    scene_.parts.push_back({name, mesh, part.contains("place") ? pose_at(part["place"], where) : Motion()});
  }

  std::uint32_t mesh_of_part(const Json& part, const std::string& where) {
    const std::string path = text_of(part["mesh"], where + ".mesh");
    // The system would read a name as far as its first NUL.
    if (path.empty() || path == "-" || path.find('\0') != std::string::npos) {
      fail(where + ".mesh: give the name of a file");
    }
    CommonOptions options = options_;
    const auto take = [&](const char* name, std::string& option) {
      if (part.contains(name)) option = text_of(part[name], where + "." + name);
    };
    take("scheme", options.scheme);
    take("boundary", options.boundary);
    take("units", options.units);
    if (part.contains("scale")) options.scale = number_of(part["scale"], where + ".scale");
    for (const auto& [name, option] : {std::pair{"sharp", &options.sharp}, {"weld", &options.weld}}) {
      if (!part.contains(name)) continue;
      const Json& value = part[name];
      *option = value.is_number() ? shortest(number_of(value, where)) : text_of(value, where + "." + name);
    }
    const auto key = std::tuple(path, options.scheme, options.boundary, options.sharp, options.weld,
                                options.scale, options.units);
    const auto [known, fresh] = meshes_.emplace(key, static_cast<std::uint32_t>(scene_.meshes.size()));
    if (fresh) {
      require_words(options, where);
      const std::filesystem::path own = system_files::path_of(path);
      scene_.meshes.push_back(
          {path, own.is_absolute() ? path : system_files::name_of(folder_ / own), options});
    }
    return known->second;
  }

  // Are words of options that the command line would take?
  static void require_words(CommonOptions& options, const std::string& where) {
    OptionList list;
    CommonOptions words;
    add_common_options(list, words);
    try {
      std::map<std::string, std::vector<std::string>> given;
      if (!options.scheme.empty()) given["--scheme"] = {options.scheme};
      if (!options.boundary.empty()) given["--boundary"] = {options.boundary};
      if (!options.units.empty()) given["--units"] = {options.units};
      if (options.scale != 1) given["--scale"] = {shortest(options.scale)};
      list.assign(given);
      options.scheme = words.scheme;
      options.boundary = words.boundary;
      options.units = words.units;
      static_cast<void>(weld_distance(options));
      static_cast<void>(sharp_angle(options));
    } catch (const UsageError& error) {
      fail(where + ": " + error.what());
    }
  }

  [[nodiscard]] Motion pose_at(const Json& place, const std::string& where) const {
    const std::string here = where + ".place";
    PoseOptions words;
    if (place.is_array()) {
      words.place = text_of_numbers(place, here, place.size() == 16 ? 16 : 12);
    } else if (place.is_object()) {
      require_names(place, here + ": ", {"move", "rotate"});
      if (place.contains("move")) words.move = words_of(place["move"], here + ".move", 3);
      if (place.contains("rotate")) words.rotate = words_of(place["rotate"], here + ".rotate", 4);
    } else {
      fail_kind(here, place, "12 numbers, a row-major 3x4 matrix, or {\"move\": ..., \"rotate\": ...}");
    }
    try {
      return pose_of(words, "", mending_);
    } catch (const InputError& error) {
      throw InputError(error.problem(), where + error.what());
    } catch (const UsageError& error) {
      fail(where + error.what());
    }
  }

  [[nodiscard]] static Length tolerance_of(const Json& value) {
    if (value.is_number()) return {length_of(value, "tolerance"), false};
    try {
      return parse_length(text_of(value, "tolerance"), "tolerance", true);
    } catch (const UsageError& error) {
      fail(error.what());
    }
  }

  [[nodiscard]] std::uint32_t part_at(const Json& value, const std::string& where) const {
    if (value.is_string()) {
      const auto known = names_.find(value.get<std::string>());
      if (known == names_.end()) fail(fmt::format("{}: no part is called {}", where, quoted(value)));
      return known->second;
    }
    if (!value.is_number_integer()) fail_kind(where, value, "the place of a part, from 0 on, or its name");
    const bool there = value.is_number_unsigned() && value.get<std::uint64_t>() < scene_.parts.size();
    if (!there) {
      fail(fmt::format("{}: there is no part {}; places are 0 to {}", where, quoted(value),
                       scene_.parts.size() - 1));
    }
    return static_cast<std::uint32_t>(value.get<std::uint64_t>());
  }

  [[nodiscard]] PartPair pair_at(const Json& value, const std::string& where, std::size_t size) const {
    if (!value.is_array() || value.size() != size) {
      fail_kind(where, value,
                size == 2 ? "two parts, as in [0, 1] or [\"a\", \"b\"]"
                          : "two parts and a length, as in [0, 1, 0.5]");
    }
    const PartPair pair{part_at(value[0], where + "[0]"), part_at(value[1], where + "[1]")};
    if (pair.a == pair.b) {
      fail(
          fmt::format("{}: \"{}\" with itself; give two parts", where, shortened(scene_.parts[pair.a].name)));
    }
    return pair;
  }

  void add_pairs(const Json& pairs) {
    if (pairs == "all") return;
    if (!pairs.is_array()) fail_kind("pairs", pairs, "\"all\" or a list of pairs");
    scene_.pairs.emplace();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      scene_.pairs->push_back(pair_at(pairs[i], fmt::format("pairs[{}]", i), 2));
    }
  }

  void add_margins(const Json& margins) {
    if (!margins.is_array()) fail_kind("margins", margins, "a list of [i, j, length]");
    std::set<std::pair<std::uint32_t, std::uint32_t>> known;
    for (std::size_t i = 0; i < margins.size(); ++i) {
      const std::string where = fmt::format("margins[{}]", i);
      const PartPair pair = pair_at(margins[i], where, 3);
      if (!known.insert(std::minmax(pair.a, pair.b)).second) fail(where + ": this pair has a margin already");
      scene_.margins.push_back({pair, length_of(margins[i][2], where + "[2]")});
    }
  }

  std::filesystem::path folder_;
  const CommonOptions& options_;
  Mending mending_;
  SceneText scene_;
  std::unordered_map<std::string, std::uint32_t> names_;
  std::map<std::tuple<std::string, std::string, std::string, std::string, std::string, double, std::string>,
           std::uint32_t>
      meshes_;
};

// Faults of options are faults of the scene file here.
SurfaceOptions options_for(const SceneMesh& mesh, const ControlMesh& control) {
  try {
    return surface_options(mesh.options, mesh.options.scheme, control);
  } catch (const UsageError& error) {
    throw InputError(InputProblem::refused, error.what());
  }
}

Surface surface_of(ControlMesh control, const SceneMesh& mesh, const WorkMonitor& monitor) {
  refuse_curves(control, mesh.options.scheme, mesh.file);
  std::optional<Surface> surface;
  naming(mesh.file, [&] {
    const SurfaceOptions how = options_for(mesh, control);
    const Run run{.threads = 1, .monitor = &monitor};
    surface.emplace(std::move(control), how, run);
    surface->prepare(run);  // with the file's name where that fails
  });
  note_smoothing(*surface, mesh.file, mesh.options, mesh.options.scheme);
  return *surface;
}

}  // namespace

namespace {

// Formats that place several meshes.
bool is_assembly(const std::string& path) {
  const std::string ending = system_files::ending_of(path);
  for (const char* known :
       {".gltf", ".glb", ".3mf", ".usda", ".usd", ".dae", ".fbx", ".3ds", ".blend", ".lwo", ".x"}) {
    if (ending == known) return true;
  }
  return false;
}

// Reads files beside one, and takes each into a fingerprint.
std::function<std::string(const std::string&)> beside(const std::string& path, const ReadBytes& read,
                                                      std::uint64_t& of_all) {
  const std::filesystem::path folder = system_files::path_of(path).parent_path();
  return [folder, &read, &of_all](const std::string& other) {
    std::string bytes = read(system_files::name_of(folder / system_files::path_of(other)));
    of_all = fingerprint(bytes, of_all);
    return bytes;
  };
}

// The scene that one file of several meshes is; its control meshes are left in `meshes`.
SceneText scene_of_assembly(const std::string& bytes, const std::string& path, const CommonOptions& options,
                            const ReadBytes& read, std::uint64_t& of_all, std::vector<ControlMesh>& meshes) {
  MeshAssembly assembly = assembly_of(bytes, path, options, beside(path, read, of_all));
  SceneText scene;
  for (std::size_t i = 0; i < assembly.meshes.size(); ++i)
    scene.meshes.push_back({fmt::format("{}#{}", path, i), fmt::format("{}#{}", path, i), options});
  for (MeshAssembly::Part& part : assembly.parts) {
    Vector3 offset = part.pose.offset();
    for (std::size_t axis = 0; axis < 3; ++axis) offset[axis] *= options.scale;
    scene.parts.push_back({std::move(part.name), part.mesh, part.pose.with_offset(offset)});
  }
  meshes = std::move(assembly.meshes);
  return scene;
}

// The meshes that the scene file names. Those of formats with several files are read on this thread, in their order.
std::vector<std::function<ControlMesh()>> meshes_of_text(const SceneText& text, const ReadBytes& read,
                                                         std::map<std::string, std::string>& files,
                                                         std::uint64_t& of_all) {
  std::vector<std::function<ControlMesh()>> meshes;
  for (const SceneMesh& mesh : text.meshes) {
    const auto [file, fresh] = files.try_emplace(mesh.file);
    if (fresh) {
      file->second = read(mesh.file);
      of_all = fingerprint(file->second, of_all);
    }
    const std::string& bytes = file->second;
    if (is_assembly(mesh.file)) {
      auto control = std::make_shared<ControlMesh>(
          mesh_of(bytes, mesh.file, mesh.options, beside(mesh.file, read, of_all)));
      meshes.emplace_back([control] { return std::move(*control); });
    } else {
      meshes.emplace_back([&bytes, &mesh] { return mesh_of(bytes, mesh.file, mesh.options); });
    }
  }
  return meshes;
}

}  // namespace

std::uint64_t fingerprint(std::string_view bytes, std::uint64_t from) {
  const auto mix = [&](std::uint64_t word) {
    from = (from ^ word) * 0x9e3779b97f4a7c15u;
    from ^= from >> 32;
  };
  std::uint64_t word = 0;
  std::size_t i = 0;
  for (; i + sizeof word <= bytes.size(); i += sizeof word) {
    std::memcpy(&word, bytes.data() + i, sizeof word);
    mix(word);
  }
  word = 0;
  std::memcpy(&word, bytes.data() + i, bytes.size() - i);
  mix(word);
  mix(bytes.size());
  return from;
}

SceneText parse_scene(const std::string& bytes, const std::string& path, const CommonOptions& options,
                      bool nearest_rigid) {
  SceneText scene;
  if (!bytes.empty()) static_cast<void>(plain_text(bytes, input_name(path)));
  naming(input_name(path), [&] {
    try {
      scene = SceneReader(path, options, nearest_rigid).read(parse_document(bytes));
    } catch (const InputError& error) {
      throw InputError(error.problem(), printable(error.what()));
    }
  });
  return scene;
}

LoadedScene load_scene(const std::string& path, const CommonOptions& options, bool nearest_rigid,
                       const ReadBytes& read, const WorkMonitor& monitor) {
  LoadedScene loaded;
  const std::string bytes = read(path);
  loaded.fingerprint = fingerprint(bytes);
  std::map<std::string, std::string> files;
  std::vector<std::function<ControlMesh()>> meshes;
  std::vector<ControlMesh> of_assembly;
  if (is_assembly(path)) {
    loaded.text = scene_of_assembly(bytes, path, options, read, loaded.fingerprint, of_assembly);
    for (ControlMesh& mesh : of_assembly) meshes.emplace_back([&mesh] { return std::move(mesh); });
  } else {
    loaded.text = parse_scene(bytes, path, options, nearest_rigid);
    meshes = meshes_of_text(loaded.text, read, files, loaded.fingerprint);
  }
  std::vector<std::optional<Surface>> surfaces(meshes.size());
  parallel_for(surfaces.size(), options.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      surfaces[i] = surface_of(meshes[i](), loaded.text.meshes[i], monitor);
    }
  });
  for (const std::optional<Surface>& surface : surfaces) loaded.surfaces.push_back(*surface);
  for (const SceneText::Part& part : loaded.text.parts) {
    loaded.scene.parts.emplace_back(loaded.surfaces[part.mesh], part.pose);
  }
  loaded.scene.pairs = loaded.text.pairs;
  loaded.scene.margins = loaded.text.margins;
  return loaded;
}

}  // namespace snug::command
