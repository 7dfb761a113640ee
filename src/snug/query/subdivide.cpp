#include <snug/evaluate.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>
#include <snug/surface/curve_set.h>
#include <support/run.h>
#include <support/scaling.h>

namespace snug {
namespace {

// The mesh with some of its faces, and the vertices of these.
ControlMesh only(const ControlMesh& mesh, const std::vector<bool>& kept) {
  ControlMesh result;
  std::vector<VertexId> renamed(mesh.vertex_count());
  std::vector<VertexId> corners;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (!kept[f]) continue;
    corners.clear();
    for (const VertexId v : mesh.face(FaceId(f))) {
      if (!renamed[v.index()].valid()) {
        renamed[v.index()] = VertexId(result.points.size());
        result.points.push_back(mesh.points[v.index()]);
      }
      corners.push_back(renamed[v.index()]);
    }
    result.add_face(corners);
  }
  result.tags.scheme = mesh.tags.scheme;
  result.tags.boundary = mesh.tags.boundary;
  return result;
}

bool touches_boundary(const Topology& topology, FaceId f) {
  const auto face = topology.face(f);
  return std::any_of(face.begin(), face.end(), [&](VertexId v) { return topology.on_boundary(v); });
}

// Turns the faces at the boundary into holes, which their descendants inherit.
void drop_boundary(ControlMesh& mesh, const Topology& topology) {
  const Sharpness sharpness = sharpness_of(mesh, topology);
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (loses_surface(topology, sharpness, FaceId(f))) mesh.tags.holes.emplace_back(f);
  }
}

// Faces of a refined mesh that have limit positions at all corners.
std::vector<bool> faces_with_limit(const ControlMesh& mesh, const Topology& topology,
                                   const SchemeRules& rules) {
  std::vector<bool> kept(mesh.face_count(), true);
  if (rules.primal) {
    for (const FaceId hole : mesh.tags.holes) kept[hole.index()] = false;
  } else {
    for (std::size_t f = 0; f < kept.size(); ++f) kept[f] = !touches_boundary(topology, FaceId(f));
  }
  return kept;
}

// Faces after `level` steps, about.
double face_count_after(const ControlMesh& mesh, const SchemeRules& rules, unsigned level) {
  if (level == 0) return static_cast<double>(mesh.face_count());
  const double first = rules.triangular() ? 4.0 * static_cast<double>(mesh.face_count())
                       : rules.primal     ? static_cast<double>(mesh.face_vertices.size())
                                          : 2.0 * static_cast<double>(mesh.face_vertices.size());
  return first * std::ldexp(1.0, 2 * static_cast<int>(level - 1));
}

}  // namespace

ControlMesh subdivided(ControlMesh mesh, unsigned level, bool limit, const SurfaceOptions& options,
                       const Run& run) {
  const SchemeOptions rules = with_tags(rules_for(mesh, options.scheme, options.boundary), mesh.tags);
  require_subdividable(mesh, rules);
  if (mesh.tags.scheme) mesh.tags.scheme = rules.scheme;
  if (level > 60 || face_count_after(mesh, rules_of(rules.scheme), level) > 0x1p31) {
    throw InputError(InputProblem::refused, "level " + std::to_string(level) + " of " +
                                                std::to_string(mesh.face_count()) +
                                                " faces is more than 2^31 faces: take a lower level");
  }
  const bool primal = rules_of(rules.scheme).primal;
  if (limit && primal && rules.boundary == BoundaryRule::none) drop_boundary(mesh, Topology(mesh));
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
  Topology topology(mesh);
  Sharpness sharpness = primal ? sharpness_of(mesh, topology) : Sharpness{};
  for (unsigned step = 0; step < level; ++step) {
    monitor_of(run).report(static_cast<double>(step) / (level + 1.0));
    RefinedTopology refined = refine(topology, rules, sharpness, monitor_of(run));
    mesh = refined_mesh(mesh, rules, topology, refined, monitor_of(run));
    topology = std::move(refined.topology);
    sharpness = std::move(refined.sharpness);
  }
  monitor_of(run).checkpoint();
  bool dropped = !primal && level > 0;
  if (limit) {
    const Stencils rows = limit_stencils(topology, rules, sharpness, monitor_of(run));
    std::vector<Point3> positions;
    positions.reserve(mesh.points.size());
    for (std::size_t v = 0; v < mesh.points.size(); ++v) {
      monitor_of(run).checkpoint();
      positions.push_back(rows.apply<Point3>(v, mesh.points));
    }
    mesh.points = std::move(positions);
    const std::vector<bool> kept = faces_with_limit(mesh, topology, rules_of(rules.scheme));
    if (std::find(kept.begin(), kept.end(), false) != kept.end()) {
      mesh = only(mesh, kept);
      dropped = true;
    }
  }
  for (Point3& p : mesh.points) p = require_representable(scale.inverse().apply(p));
  if (!dropped) {
    for (const auto& [v, point] : isolated) mesh.points[v] = point;
  }
  return mesh;
}

ControlMesh subdivided(const CurveSet& curves, unsigned level, bool limit, const Run& run) {
  const ControlMesh& mesh = curves.mesh();
  const CurveDegree degree = curves.degree();
  if (level > 30 || (2 * mesh.polyline_vertices.size() << level) > (std::size_t{1} << 31)) {
    throw InputError(InputProblem::refused, "level " + std::to_string(level) + " of polylines with " +
                                                std::to_string(mesh.polyline_vertices.size()) +
                                                " vertices is more than 2^31 vertices: take a lower level");
  }
  const PowerOfTwo scale = curves.edges().scale();
  ControlMesh result;
  for (std::size_t p = 0; p < mesh.polyline_count(); ++p) {
    monitor_of(run).report(static_cast<double>(p) / static_cast<double>(mesh.polyline_count()));
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
