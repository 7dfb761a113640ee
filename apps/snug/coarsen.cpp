#include "coarsen.h"

#include <meshoptimizer.h>
#include <snug/query/deviation.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace snug::command {
namespace {

// Errors of meshoptimizer's own that are tried: it does not measure distances to the surface.
constexpr double least_share = 1.0 / 8, most_share = 8;
constexpr int most_attempts = 9;

// Indices and positions as meshoptimizer takes them: floats, about the middle.
struct FloatMesh {
  explicit FloatMesh(const Tessellation& mesh) {
    Box3 box;
    for (const Point3& p : mesh.positions) box.add(p);
    const Vector3 middle{box.lower.x / 2 + box.upper.x / 2, box.lower.y / 2 + box.upper.y / 2,
                         box.lower.z / 2 + box.upper.z / 2};
    for (std::size_t axis = 0; axis < 3; ++axis) size = std::max(size, box.upper[axis] - box.lower[axis]);
    positions.reserve(3 * mesh.positions.size());
    for (const Point3& p : mesh.positions) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        positions.push_back(static_cast<float>((p[axis] - middle[axis]) / size));
      }
    }
    indices.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  }
  [[nodiscard]] std::vector<unsigned int> simplified(double error) const {
    std::vector<unsigned int> simple(indices.size());
    simple.resize(meshopt_simplify(simple.data(), indices.data(), indices.size(), positions.data(),
                                   positions.size() / 3, 3 * sizeof(float), 0,
                                   static_cast<float>(error / size), 0, nullptr));
    return simple;
  }

  std::vector<float> positions;
  std::vector<unsigned int> indices;
  double size = 0;
};

// The vertices that are left, in the order in which triangles name them.
Tessellation part_of(const Tessellation& fine, const std::vector<unsigned int>& indices) {
  Tessellation part;
  part.position_error = fine.position_error;
  std::vector<std::uint32_t> place(fine.positions.size(), UINT32_MAX);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    auto& triangle = part.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const unsigned int v = indices[i + k];
      if (place[v] == UINT32_MAX) {
        place[v] = static_cast<std::uint32_t>(part.positions.size());
        part.positions.push_back(fine.positions[v]);
        part.parameters.push_back(fine.parameters[v]);
        if (!fine.normals.empty()) part.normals.push_back(fine.normals[v]);
      }
      triangle[k] = place[v];
    }
  }
  return part;
}

}  // namespace

Tessellation coarsened(const SurfaceBvh& surface, const Tessellation& fine, double tolerance, int threads,
                       const WorkMonitor& monitor) {
  // Upper bound of both distances.
  const auto judge = [&](const Tessellation& mesh) {
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    }
    const Deviation found = deviation(
        surface, triangles, {.absolute = tolerance / 64, .tolerance = tolerance, .threads = threads},
        {.on_progress = {}, .stop = monitor.stop});
    return std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper);
  };
  const FloatMesh floats(fine);
  Tessellation best = fine;
  best.owners.clear();
  // Halving in logarithms: what is near enough goes below, what is not above.
  double low = least_share * tolerance, high = most_share * tolerance;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    monitor.report(attempt / static_cast<double>(most_attempts));
    const double error = std::sqrt(low * high);
    Tessellation now = part_of(fine, floats.simplified(error));
    now.error_bound = now.triangles.empty() ? double{INFINITY} : judge(now);
    const bool near = now.error_bound <= tolerance;
    (near ? low : high) = error;
    if (near && now.triangles.size() < best.triangles.size()) best = std::move(now);
  }
  monitor.report(1);
  return best;
}

}  // namespace snug::command
