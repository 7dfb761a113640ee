#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>
#include <snug/base/error.h>
#include <snug/io/atomic_file.h>
#include <snug/io/read_file.h>

#include "common.h"
#include "mesh_reading.h"
#include "pose.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::vector<std::string> meshes, poses;
  bool nearest_rigid = false;
  std::string answer, page;
};

constexpr std::string_view data_begins = R"(<script type="application/json" id="snug-data">)";
constexpr std::string_view data_ends = "</script>";

// Where the page lies: installed, beside the command; in a clone, where `make page` puts it.
std::string find_page() {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const char* place : {"../share/snug/view.html", "../../web/snug.html"}) {
    const std::filesystem::path page = (folder / place).lexically_normal();
    if (std::filesystem::exists(page, ignored)) return page.string();
  }
  throw InputError(InputProblem::unreadable,
                   fmt::format("view: the page to fill is not there ({}); build it with make page, or give "
                               "--template FILE",
                               (folder / "../share/snug/view.html").lexically_normal().string()));
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

// What the page does with it is the page's; this only tells another file from an answer.
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

// The meshes and the answer as a JSON document without '<', which might look like an end of the script.
std::string data_of(const Options& options, const std::vector<Motion>& poses) {
  std::string text;
  JsonWriter json([&](std::string_view part) { text += part; }, JsonWriter::Lines::one);
  json.begin_object().key("parts").begin_array();
  const auto cache = std::make_shared<BoundsCache>();
  for (std::size_t part = 0; part < options.meshes.size(); ++part) {
    const std::string& path = options.meshes[part];
    // Refused here, not in the page.
    static_cast<void>(load_surface(path, options, options.scheme, cache));
    json.begin_object().field("name", path).field("scheme", options.scheme);
    json.field("base64", base64(read_file(path)));
    if (part < poses.size()) {
      json.key("place").begin_array();
      for (const double number : poses[part].numbers()) json.value(number);
      json.end_array();
    }
    json.end_object();
  }
  json.end_array();
  if (const std::optional<double> angle = sharp_angle(options)) json.field("sharp", *angle);
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
  for (const std::string& path : options.meshes) {
    if (path == "-") throw UsageError("view: give the meshes as files, not on standard input");
  }
  if (options.poses.size() > options.meshes.size()) {
    throw UsageError(
        fmt::format("view: {} times --place, but {} meshes", options.poses.size(), options.meshes.size()));
  }
}

ExitStatus run(const Options& options) {
  require_sound(options);
  const Mending mending{options.nearest_rigid, notes_for(options)};
  std::vector<Motion> poses;
  for (const std::string& text : options.poses) poses.push_back(parse_pose(text, "--place", mending));
  const std::string name = options.page.empty() ? find_page() : options.page;
  const std::string page = filled(read_file(name), name, data_of(options, poses));
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("view", to_standard_output);
  report.heads(options.meshes, std::vector<std::string>(options.meshes.size(), options.scheme));
  AtomicFile file(options.output);
  file.write(page);
  if (report.json()) {
    report.write().field("bytes", page.size());
  } else if (options.output != "-") {
    report.text(fmt::format("{}: {} {} in a page of {:.1f} MB; open it in a browser", options.output,
                            options.meshes.size(), options.meshes.size() == 1 ? "part" : "parts",
                            static_cast<double>(page.size()) / 1e6));
  }
  return report.finish(true, {&file});
}

}  // namespace

Command view_command() {
  auto options = std::make_shared<Options>();
  OptionList list;
  list.add(Group::own, "MESH", &options->meshes, "Control meshes (OBJ, OFF, PLY, STL, USD or glTF)");
  list.add(Group::own, "--answer FILE", &options->answer,
           "JSON of collide or distance about the first two: shown, with its poses");
  list.add(Group::own, "--template FILE", &options->page, "The page to fill, if not the installed one");
  list.add(Group::placement, "--place \"NUMBERS\"", &options->poses,
           "Pose of the first mesh; again for the second, and so on");
  add_nearest_rigid_option(list, options->nearest_rigid).needs("--place");
  add_scheme_option(list, "--scheme", options->scheme,
                    "Subdivision scheme; auto: loop if all faces are triangles, else catmark");
  list.add(Group::mesh, "--sharp ANGLE", &options->sharp,
           "Edges whose face normals differ by more than ANGLE degrees stay sharp; auto: 30");
  add_output_options(list, *options);
  return {"view",
          Topic::two_surfaces,
          "Make a page, to move parts in a browser with live answers",
          {"snug view bracket.obj pin.obj --answer answer.json -o parts.html"},
          std::move(list),
          [options] { return run(*options); }};
}

}  // namespace snug::command
