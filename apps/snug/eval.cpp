#include <charconv>
#include <cmath>

#include <fmt/core.h>
#include <snug/io/read_file.h>
#include <snug/query/evaluate.h>
#include <CLI/CLI.hpp>

#include "common.h"
#include "curve.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Options : CommonOptions {
  std::string mesh;
  unsigned degree = 3;
  unsigned samples = 4;
  std::string at;
};

struct Request {
  FaceId face;
  TriangleParameter at;
};

// The next blank-separated word of a line, or an empty one.
std::string_view next_word(std::string_view& line) {
  const auto begin = line.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return line = {};
  const auto end = std::min(line.find_first_of(" \t\r", begin), line.size());
  const std::string_view word = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return word;
}

template <class Number>
bool parse(std::string_view word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

// Lines "face u v"; blank lines and those that begin with # are passed over.
std::vector<Request> read_requests(const std::string& path, const Surface& surface) {
  const std::string text = read_file(path);
  std::vector<Request> requests;
  std::size_t line_number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const auto end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    ++line_number;
    const std::string where = path + ":" + std::to_string(line_number) + ": ";
    const std::string_view first = next_word(line);
    if (first.empty() || first.front() == '#') continue;
    std::uint32_t face = 0;
    double u = 0, v = 0;
    if (!parse(first, face) || !parse(next_word(line), u) || !parse(next_word(line), v) ||
        !next_word(line).empty()) {
      throw InputError(InputProblem::unreadable, where + "a line is 'face u v'");
    }
    if (face >= surface.face_count()) {
      throw InputError(InputProblem::unreadable, where + "face " + std::to_string(face) + " of " +
                                                     std::to_string(surface.face_count()) +
                                                     " (they count from 0)");
    }
    if (!(u >= 0 && v >= 0 && u + v <= 1)) {
      throw InputError(InputProblem::unreadable, where + "u and v must be >= 0, and u + v <= 1");
    }
    if (!surface.has_patch(FaceId(face))) {
      throw InputError(InputProblem::refused,
                       where + "face " + std::to_string(face) +
                           " has no limit surface: it touches the boundary, whose rule is none");
    }
    requests.push_back({FaceId(face), {u, v}});
  }
  return requests;
}

void write_point(Report& report, const Request& request, const SurfacePoint& point) {
  if (!report.json()) {
    report.text(fmt::format("{} {} {}  {} {} {}", request.face.index(), request.at.u, request.at.v,
                            point.position.x, point.position.y, point.position.z));
    return;
  }
  JsonWriter& json = report.write();
  json.begin_object().field("face", request.face.index()).field("u", request.at.u).field("v", request.at.v);
  json.field("position", point.position).field("error", point.error).key("normal");
  point.normal ? json.value(*point.normal) : json.null();
  json.key("tangents").begin_array().value(point.tangents[0]).value(point.tangents[1]).end_array();
  json.field("differentiable", point.differentiable).end_object();
}

ExitStatus run(const Options& options) {
  ControlMesh mesh = load_mesh(options.mesh, options);
  if (is_curve(mesh, options.scheme))
    return eval_curve(std::move(mesh), options.mesh, options, {options.degree, options.samples, options.at});
  const Surface surface =
      make_surface(std::move(mesh), options.mesh, options, options.scheme, std::make_shared<BoundLibrary>());
  std::vector<Request> requests;
  if (!options.at.empty()) requests = read_requests(options.at, surface);
  Report report("eval", options);
  report.heads({options.mesh}, {name_of(surface.options().scheme)});
  if (report.json()) report.write().key("points").begin_array();
  std::size_t count = 0;
  naming(options.mesh, [&] {
    if (!options.at.empty()) {
      for (const Request& request : requests)
        write_point(report, request, evaluate(surface, request.face, request.at));
      count = requests.size();
      return;
    }
    ProgressBar bar("evaluating " + options.mesh, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    const double steps = options.samples;
    for (std::size_t f = 0; f < surface.face_count(); ++f) {
      if (!surface.has_patch(FaceId(f))) continue;
      const FaceEvaluator evaluator(surface, FaceId(f));
      for (unsigned j = 0; j <= options.samples; ++j) {
        for (unsigned i = 0; i + j <= options.samples; ++i) {
          // The far edge is met exactly: u + v rounds to at most 1.
          const double v = j / steps, u = std::fmin(i / steps, 1 - v);
          write_point(report, {FaceId(f), {u, v}}, evaluator({u, v}));
          ++count;
        }
      }
      monitor.report(static_cast<double>(f + 1) / static_cast<double>(surface.face_count()));
    }
  });
  if (report.json()) report.write().end_array().field("count", count);
  report.finish();
  return ExitStatus::answered;
}

}  // namespace

Command add_eval(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("eval", "Limit points, tangents and normals");
  command->add_option("MESH", options->mesh, "Control mesh (OBJ, OFF, PLY or STL; - for standard input)")
      ->required();
  CLI::Option* samples =
      command
          ->add_option("--samples", options->samples,
                       "A lattice of N steps along each edge of every face, or of every polyline")
          ->check(CLI::Range(1u, 1000u))
          ->capture_default_str();
  command
      ->add_option("--at", options->at,
                   "File of lines 'face u v': p = (1-u-v) c0 + u c1 + v c2; of curves: 'edge t'")
      ->excludes(samples);
  add_degree_option(*command, options->degree);
  add_common_options(*command, *options);
  return {command, [options] { return run(*options); }};
}

}  // namespace snug::command
