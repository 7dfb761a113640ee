#include <snug/snug.h>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const snug::Surface a = snug::load(argv[1]), b = snug::load(argv[2]);
  const auto at = snug::Motion::translation({4, 0, 0});
  const snug::Collision hit = snug::collide(a, b.at(at), {.tolerance = 1e-3});
  const snug::Distance gap = snug::distance(a, b.at(at), {.relative = 1e-3});
  const snug::ClosestPoint near = snug::closest_point(a, {1, 2, 3});
  const snug::MeshCounts counts = snug::count_elements(a.mesh(), a.scheme());
  snug::ControlMesh line;
  line.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const snug::VertexId ends[] = {snug::VertexId(0), snug::VertexId(1), snug::VertexId(2)};
  line.add_polyline(ends);
  const snug::CurveSet curves(line);
  if (!snug::defects(a.mesh()).empty() || !counts.closed || curves.edge_count() != 2) return 1;
  if (snug::subdivided(curves, 1).vertex_count() != 5) return 1;
  std::printf("%s, distance in [%g, %g], (%g %g %g) is closest\n", snug::name_of(hit.verdict),
              gap.distance.lower, gap.distance.upper, near.point.x, near.point.y, near.point.z);
}
