#include "curve.h"

namespace snug::command {

bool is_curve(const ControlMesh& mesh, const std::string& scheme) {
  return scheme == "curve" || (scheme == "auto" && mesh.face_count() == 0 && mesh.polyline_count() > 0);
}

void refuse_curves(const ControlMesh& mesh, const std::string& scheme, const std::string& path) {
  const bool only_polylines = mesh.face_count() == 0 && mesh.polyline_count() > 0;
  if (scheme == "curve") {
    throw InputError(
        InputProblem::refused,
        path + ": --scheme curve is answered by bound, eval and subdivide only; give another scheme");
  }
  if (only_polylines) {
    throw InputError(
        InputProblem::refused,
        path +
            ": it has polylines and no faces; curves are answered by bound, eval and subdivide only, "
            "with --scheme curve or auto");
  }
}

void add_degree_option(OptionList& list, unsigned& degree) {
  list.add(Group::mesh, "--degree N", &degree, "Degree of B-spline curves").one_of({"2", "3"});
}

CurveDegree curve_degree(unsigned degree) {
  return degree == 2 ? CurveDegree::quadratic : CurveDegree::cubic;
}

void curve_heads(Report& report, const std::string& path, unsigned degree) {
  report.heads({path}, {"curve"});
  if (report.json()) report.write().field("degree", degree);
}

}  // namespace snug::command
