#include <snug/surface/evaluate_curve.h>

#include <charconv>
#include <sstream>
#include <vector>

#include <fmt/core.h>
#include <snug/io/read_file.h>

#include "curve.h"
#include "progress_bar.h"

namespace snug::command {
namespace {

struct Request {
  EdgeId edge;
  double t;
};

template <class Number>
bool parse(const std::string& word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

// Lines "edge t"; blank lines and those that begin with # are passed over.
std::vector<Request> read_requests(const std::string& path, const CurveSet& curves) {
  std::istringstream text(read_file(path, stopped_by_interrupts()));
  std::vector<Request> requests;
  std::string line;
  for (std::size_t line_number = 1; std::getline(text, line); ++line_number) {
    const auto fail = [&](const std::string& why) {
      throw InputError(InputProblem::unreadable, path + ":" + std::to_string(line_number) + ": " + why);
    };
    std::istringstream words(line);
    std::string first, second, more;
    words >> first >> second >> more;
    if (first.empty() || first.front() == '#') continue;
    std::uint32_t edge = 0;
    double t = 0;
    if (!parse(first, edge) || !parse(second, t) || !more.empty()) fail("a line is 'edge t'");
    if (edge >= curves.edge_count()) {
      fail("edge " + std::to_string(edge) + " of " + std::to_string(curves.edge_count()) +
           " (they count from 0)");
    }
    if (!(t >= 0 && t <= 1)) fail("t must be from 0 to 1");
    requests.push_back({EdgeId(edge), t});
  }
  return requests;
}

void write_point(Report& report, const Request& request, const CurveSetPoint& point) {
  if (!report.json()) {
    report.text(fmt::format("{} {}  {} {} {}", request.edge.index(), request.t, point.position.x,
                            point.position.y, point.position.z));
    return;
  }
  JsonWriter& json = report.write();
  json.begin_object().field("edge", request.edge.index()).field("t", request.t);
  json.field("position", point.position)
      .field("error", point.error)
      .field("tangent", point.tangent)
      .end_object();
}

}  // namespace

ExitStatus eval_curve(ControlMesh mesh, const std::string& path, const CommonOptions& options,
                      const CurveSamples& which) {
  std::optional<CurveSet> curves;
  naming(path, [&] { curves.emplace(std::move(mesh), which.degree); });
  std::vector<Request> requests;
  if (!which.at.empty()) requests = read_requests(which.at, *curves);
  Report report("eval", options);
  curve_heads(report, path, which.degree);
  if (report.json()) report.write().key("points").begin_array();
  report.text("# edge t  x y z");
  std::size_t count = requests.size();
  naming(path, [&] {
    for (const Request& request : requests) {
      write_point(report, request, evaluate(*curves, request.edge, request.t));
    }
    if (!which.at.empty()) return;
    ProgressBar bar("evaluating " + path, options.quiet);
    const WorkMonitor monitor = bar.monitor();
    for (std::size_t e = 0; e < curves->edge_count(); ++e) {
      for (unsigned i = 0; i <= which.samples; ++i) {
        const Request request{EdgeId(e), i / static_cast<double>(which.samples)};
        write_point(report, request, evaluate(*curves, request.edge, request.t));
        ++count;
      }
      monitor.report(static_cast<double>(e + 1) / static_cast<double>(curves->edge_count()));
    }
  });
  if (report.json()) report.write().end_array().field("count", count);
  report.finish();
  return ExitStatus::answered;
}

}  // namespace snug::command
