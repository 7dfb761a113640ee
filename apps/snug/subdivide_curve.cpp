#include <snug/query/subdivide_curve.h>

#include <algorithm>

#include <fmt/core.h>
#include <snug/io/atomic_file.h>
#include <snug/io/mesh_file.h>

#include "curve.h"
#include "progress_bar.h"

namespace snug::command {

ExitStatus subdivide_curve(const ControlMesh& mesh, const std::string& path, const CommonOptions& options,
                           const CurveLevel& which) {
  std::string ending =
      options.output == "-" ? ".obj" : options.output.substr(options.output.find_last_of('.'));
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (ending != ".obj") {
    throw UsageError("subdivide: -o " + options.output + ": polylines are written to .obj files only");
  }
  ControlMesh result;
  naming(path, [&] {
    ProgressBar bar("subdividing " + path, options.quiet);
    result = subdivide_curves(mesh, which.degree, which.level, which.limit, bar.monitor());
  });
  AtomicFile file(options.output);
  write_mesh(result, file, options.output, notes_for(options), stopped_by_interrupts());
  CommonOptions to_standard_output = options;
  to_standard_output.output.clear();
  Report report("subdivide", to_standard_output);
  curve_heads(report, path, which.degree);
  if (report.json()) {
    report.write().field("vertices", result.vertex_count()).field("faces", result.face_count());
    report.write().field("polylines", result.polyline_count());
    report.write().field("level", which.level).field("limit", which.limit);
  }
  if (options.output != "-") {
    report.text(fmt::format("{}: {} vertices, {} polylines{}", options.output, result.vertex_count(),
                            result.polyline_count(), which.limit ? ", at their limit positions" : ""));
  }
  report.finish(&file);
  return ExitStatus::answered;
}

}  // namespace snug::command
