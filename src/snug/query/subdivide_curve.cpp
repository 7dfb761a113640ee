#include <snug/query/subdivide_curve.h>

#include <string>

#include <snug/base/error.h>
#include <snug/geometry/scaling.h>
#include <snug/surface/curve_set.h>

namespace snug {

ControlMesh subdivide_curves(const ControlMesh& mesh, CurveDegree degree, unsigned level, bool limit,
                             const WorkMonitor& monitor) {
  const CurveSet curves(mesh, degree);  // refuses what has no curves
  if (level > 30 || (2 * mesh.polyline_vertices.size() << level) > (std::size_t{1} << 31)) {
    throw InputError(InputProblem::refused, "level " + std::to_string(level) + " of polylines with " +
                                                std::to_string(mesh.polyline_vertices.size()) +
                                                " vertices is more than 2^31 vertices: take a lower level");
  }
  const PowerOfTwo scale = curves.scale();
  ControlMesh result;
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    monitor.report(static_cast<double>(p) / static_cast<double>(mesh.polyline_count()));
    ControlPolygon polygon = control_polygon(mesh, PolylineId(p));
    for (Point3& point : polygon.points) point = scale.apply(point);
    for (unsigned step = 0; step < level; ++step) polygon = refine(polygon, degree);
    if (limit) polygon = limit_positions(polygon, degree);
    std::vector<VertexId> line;
    for (const Point3& point : polygon.points) {
      line.emplace_back(result.points.size());
      result.points.push_back(require_representable(scale.inverse().apply(point)));
    }
    if (polygon.closed) line.push_back(line.front());
    result.add_polyline(line);
  }
  return result;
}

}  // namespace snug
