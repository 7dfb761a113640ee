#include <snug/query/subdivide.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <snug/base/scaling.h>
#include <snug/scheme/refine.h>

namespace snug {
namespace {

// Keeps the descendants of the faces that are `kept`, 4^level a face in a row, then drops vertices without a face.
ControlMesh only_descendants(const ControlMesh& mesh, const std::vector<bool>& kept, unsigned level) {
  ControlMesh result;
  std::vector<VertexId> renamed(mesh.vertex_count());
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!kept[f >> (2 * level)]) continue;
    std::vector<VertexId> corners;
    for (const VertexId v : mesh.face(FaceId(f))) {
      if (!renamed[v.index()].valid()) {
        renamed[v.index()] = VertexId(result.points.size());
        result.points.push_back(mesh.points[v.index()]);
      }
      corners.push_back(renamed[v.index()]);
    }
    result.add_face(corners);
  }
  result.tags = mesh.tags;
  return result;
}

// The faces that have a limit surface with BoundaryRule::none.
std::vector<bool> away_from_boundary(const Topology& topology) {
  std::vector<bool> away(topology.face_count());
  for (std::size_t f = 0; f < away.size(); ++f) {
    const auto face = topology.face(FaceId(f));
    away[f] = std::none_of(face.begin(), face.end(), [&](VertexId v) { return topology.on_boundary(v); });
  }
  return away;
}

}  // namespace

ControlMesh subdivide(ControlMesh mesh, const SchemeOptions& options, unsigned level, bool limit,
                      const WorkMonitor& monitor) {
  require_subdividable(mesh, options);
  if (level > 15 || (mesh.face_count() << (2 * level)) > (std::size_t{1} << 31)) {
    throw InputError(InputProblem::refused, "level " + std::to_string(level) + " of " +
                                                std::to_string(mesh.face_count()) +
                                                " faces is more than 2^31 faces: take a lower level");
  }
  std::vector<bool> kept;
  if (limit && options.boundary == BoundaryRule::none) kept = away_from_boundary(Topology(mesh));
  const Box3 box = used_box(mesh);
  const PowerOfTwo scale =
      PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  // Isolated vertices stay as they are, however large.
  std::vector<bool> used(mesh.vertex_count(), false);
  for (const VertexId v : mesh.face_vertices) used[v.index()] = true;
  std::vector<std::pair<std::size_t, Point3>> isolated;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (!used[v]) isolated.emplace_back(v, std::exchange(mesh.points[v], Point3{}));
  }
  for (Point3& p : mesh.points) p = scale.apply(p);
  for (unsigned step = 0; step < level; ++step) {
    monitor.report(static_cast<double>(step) / (level + 1.0));
    mesh = refine(mesh, options);
  }
  if (limit) {
    const Topology topology(mesh);
    const Stencils rows = limit_stencils(topology, options);
    std::vector<Point3> positions;
    positions.reserve(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v)
      positions.push_back(rows.apply<Point3>(v, mesh.points));
    mesh.points = std::move(positions);
    if (!kept.empty()) mesh = only_descendants(mesh, kept, level);
  }
  for (Point3& p : mesh.points) p = require_representable(scale.inverse().apply(p));
  if (kept.empty()) {
    for (const auto& [v, point] : isolated) mesh.points[v] = point;
  }
  return mesh;
}

}  // namespace snug
