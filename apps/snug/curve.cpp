#include "curve.h"

namespace snug::command {

bool is_curve(const ControlMesh& mesh, const std::string& scheme) {
  return scheme == "curve" || (scheme == "auto" && mesh.face_count() == 0 && mesh.polyline_count() > 0);
}

bool asks_for_curves(const std::string& command, const ControlMesh& mesh, const std::string& path,
                     const CommonOptions& options, Degree degree) {
  const bool curve = is_curve(mesh, options.scheme);
  if (curve && !options.boundary.empty()) {
    throw UsageError(command + ": --boundary is for surfaces; " + path + " is answered as curves");
  }
  if (!curve && degree) {
    throw UsageError(command + ": --degree is for curves; " + path + " is answered as a surface");
  }
  return curve;
}

void refuse_curves(const ControlMesh& mesh, const std::string& scheme, const std::string& path) {
  const bool only_polylines = mesh.face_count() == 0 && mesh.polyline_count() > 0;
  if (scheme == "curve") {
    throw InputError(
        InputProblem::refused,
        path + ": --scheme curve is answered by bound, eval, render and subdivide only; give another scheme");
  }
  if (only_polylines) {
    throw InputError(
        InputProblem::refused,
        path +
            ": it has polylines and no faces; curves are answered by bound, eval, render and subdivide "
            "only, with --scheme curve or auto");
  }
}

void add_degree_option(OptionList& list, Degree& degree) {
  list.add(Group::mesh, "--degree N", &degree, "Degree of B-spline curves, 2 or 3 (default 3)").between(2, 3);
}

CurveDegree curve_degree(Degree degree) { return degree == 2u ? CurveDegree::quadratic : CurveDegree::cubic; }

CurveSet make_curves(ControlMesh mesh, const std::string& path, CurveDegree degree) {
  std::optional<CurveSet> curves;
  naming(path, [&] { curves.emplace(std::move(mesh), degree); });
  return *std::move(curves);
}

void curve_heads(Report& report, const std::string& path, CurveDegree degree) {
  report.heads({path}, {"curve"});
  if (report.json()) report.write().field("degree", static_cast<int>(degree));
}

}  // namespace snug::command
