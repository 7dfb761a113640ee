// Maps control points, query points and closest points as Eigen matrices, without copies.
//
//   05_with_eigen MESH

#include <cstddef>
#include <cstdio>
#include <utility>
#include <vector>

#include <snug/snug.h>
#include <Eigen/Core>

// A Point3 is three doubles, so an array of them is a matrix with a column for each point.
static_assert(sizeof(snug::Point3) == 3 * sizeof(double));
static Eigen::Map<Eigen::Matrix3Xd> columns(std::vector<snug::Point3>& points) {
  return {points.empty() ? nullptr : &points.front().x, 3, static_cast<Eigen::Index>(points.size())};
}

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  // Move the mesh to the origin and scale it to size 1.
  snug::ControlMesh mesh = snug::read_mesh(argv[1]);
  Eigen::Map<Eigen::Matrix3Xd> vertices = columns(mesh.points);
  const Eigen::Vector3d lower = vertices.rowwise().minCoeff(), upper = vertices.rowwise().maxCoeff();
  vertices.colwise() -= 0.5 * (lower + upper);
  vertices /= (upper - lower).maxCoeff();
  const snug::Surface surface(std::move(mesh));

  // Random points around it, and the limit points closest to them.
  std::vector<snug::Point3> probes(1000), closest;
  columns(probes).setRandom();
  for (const snug::ClosestPoint& answer : snug::closest_point(surface, probes, {.relative = 1e-6}))
    closest.push_back(answer.point);
  const Eigen::RowVectorXd distances = (columns(closest) - columns(probes)).colwise().norm();
  std::printf("%ld points, their mean distance from the surface is %g, the largest %g\n",
              static_cast<long>(distances.size()), distances.mean(), distances.maxCoeff());
  return 0;
}
