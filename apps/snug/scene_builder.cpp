#include "scene_builder.h"

#include <algorithm>
#include <cmath>

#include <picture/palette.h>
#include <support/direction.h>
#include <support/parallel.h>

#include "patch_lattice.h"

namespace snug::command {

PictureUnits::PictureUnits(std::span<const PlacedMesh> parts) {
  double largest = 0;
  for (const PlacedMesh& part : parts) {
    if (part.used.empty()) continue;
    largest = std::max(largest, max_abs(part.pose.offset()));
    for (const VertexId v : part.used) {
      largest = std::max(largest, max_abs(part.mesh->points[v.index()] - Point3{}));
    }
  }
  // Two halvings: sums of a rotated point and a translation stay small.
  scale_ = PowerOfTwo::normalising(largest) * PowerOfTwo(-2);
  Box3 box;
  for (const PlacedMesh& part : parts) {
    for (const VertexId v : part.used) box.add(placed(part.pose, scale_.apply(part.mesh->points[v.index()])));
  }
  if (box.empty()) return;
  centre_ = box.lower + 0.5 * (box.upper - box.lower);
  if (const double zoom = 1 / longest_side(box); std::isfinite(zoom)) zoom_ = zoom;
}

namespace {

Rows3 rows_of(const Motion& pose) { return {pose.row(0), pose.row(1), pose.row(2)}; }

}  // namespace

// The turn's inverse is its transpose: it is rigid but for what a picture does not show.
Rows3 PictureUnits::to_mesh(const Motion& pose) const {
  const Rows3 turn = rows_of(pose);
  Rows3 rows;
  for (std::size_t k = 0; k < 3; ++k)
    rows[k] = {to_mesh(turn[0][k]), to_mesh(turn[1][k]), to_mesh(turn[2][k])};
  return rows;
}

Point3 PictureUnits::origin_in_mesh(const Motion& pose) const {
  const Vector3 from = centre_ - (Point3{} + scale_.apply(pose.offset()));
  return Point3{} + scale_.inverse().apply(transposed_times(rows_of(pose), from));
}

std::vector<Point3> limit_points(const PlacedSurface& part, const PictureUnits& units, std::uint32_t steps,
                                 int threads, const WorkMonitor& monitor) {
  std::vector<Point3> points;
  const PatchLattice lattice(part.surface(), steps);
  lattice.evaluate(
      part.surface(), {.threads = threads, .monitor = &monitor},
      [](const Place& at, std::vector<Place>& asked) { asked.push_back(at); },
      [&](std::span<const SurfacePoint> found) {
        for (const SurfacePoint& x : found) points.push_back(units(part.pose(), x.point));
      });
  return points;
}

SceneSurface scene_surface(const RayCaster& caster, const Motion& pose, const PictureUnits& units,
                           std::uint32_t material) {
  return {&caster, units.to_mesh(pose), units.origin_in_mesh(pose), rows_of(pose), material, {}};
}

std::vector<Polyhedron> enclosure_hulls(std::span<const IntervalTriangle> enclosures, const Motion& pose,
                                        const PictureUnits& units, int threads, const WorkMonitor& monitor) {
  std::vector<Polyhedron> hulls(enclosures.size());
  parallel_for(enclosures.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      monitor.checkpoint();
      IntervalTriangle scaled = enclosures[i];
      for (Box3& box : scaled.corner) box = {units.scale().apply(box.lower), units.scale().apply(box.upper)};
      hulls[i] = hull_of_boxes(scaled);
      for (Point3& p : hulls[i].points) p = units.from_scaled(pose, p);
    }
  });
  return hulls;
}

void add_polyhedron(PictureScene& scene, const Polyhedron& solid, Point3 eye, const SolidStyle& style) {
  const auto& points = solid.points;
  const std::size_t count = points.size();
  std::vector<bool> bordered(count * count, false);  // half-edges of facets towards the eye
  for (const std::vector<std::uint32_t>& facet : solid.facets) {
    // Twice its area: for slivers, too, better than the cross product of two sides.
    Vector3 normal;
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      normal = normal + cross(points[facet[i]] - points[facet[0]], points[facet[i + 1]] - points[facet[0]]);
    }
    if (!(dot(normal, eye - points[facet[0]]) > 0)) continue;
    for (std::size_t i = 0; i < facet.size(); ++i) {
      const std::uint32_t from = facet[i], to = facet[(i + 1) % facet.size()];
      bordered[from * count + to] = true;
      if (i == 0 || i + 1 == facet.size()) continue;
      ShadedTriangle& triangle = scene.triangles.emplace_back();
      triangle.corner[0] = points[facet[0]];
      triangle.corner[1] = points[from];
      triangle.corner[2] = points[to];
      triangle.material = style.material;
    }
  }
  for (std::size_t from = 0; from < count; ++from) {
    for (std::size_t to = 0; to < count; ++to) {
      const bool inner = bordered[to * count + from];
      if (!bordered[from * count + to] || (inner && to < from)) continue;
      scene.lines.push_back(
          {points[from], points[to], (inner ? 0.5 : 1) * style.line_width, style.line_colour});
    }
  }
}

void add_witness(PictureScene& scene, const std::array<Point3, 2>& points, const PictureUnits& units,
                 double scale) {
  std::array<Point3, 2> drawn;
  for (std::size_t i = 0; i < 2; ++i) {
    drawn[i] = units.from_scaled(Motion{}, units.scale().apply(points[i]));
    if (!(max_abs(drawn[i] - Point3{}) < 1e6)) {
      throw InputError(InputProblem::value,
                       "--witness: a point is too far away for a picture of these meshes");
    }
  }
  scene.lines.push_back({drawn[0], drawn[1], palette::witness_width * scale, palette::signal});
  for (const Point3& p : drawn) scene.lines.push_back({p, p, palette::witness_dot * scale, palette::signal});
}

CutPlane cut_plane(const std::array<Point3, 2>& points, const PictureUnits& units) {
  const auto place = [&](const Point3& p) { return units.from_scaled(Motion{}, units.scale().apply(p)); };
  const Point3 from = place(points[0]);
  const Vector3 normal = normalized(place(points[1]) - from);
  return {normal, dot(normal, from - Point3{})};
}

void add_cage(PictureScene& scene, const PlacedSurface& part, const PictureUnits& units, double line_width,
              Colour line_colour) {
  const ControlMesh& mesh = part.surface().mesh();
  std::vector<std::pair<VertexId, VertexId>> edges;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      edges.push_back(std::minmax(face[k], face[k + 1 == face.size() ? 0 : k + 1]));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const auto place = [&](VertexId v) { return units(part.pose(), mesh.points[v.index()]); };
  for (const auto& [a, b] : edges) scene.lines.push_back({place(a), place(b), line_width, line_colour});
}

}  // namespace snug::command
