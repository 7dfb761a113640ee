#include "coarsen.h"

#include <meshoptimizer.h>
#include <snug/distance.h>
#include <snug/inspect.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

namespace snug::command {
namespace {

// Of the tolerance: those of the tessellations that are simplified. Above 1 for what tessellate() proves may be more than the
// deviation. The first is 1, of which there is a tessellation already.
constexpr std::array shares{1.0, 0.7, 0.5, 1.4, 2.0, 0.25};
// Of the tolerance: errors of meshoptimizer's own, which does not measure distances to the surface. They are halved in
// logarithms until two are so near to each other.
constexpr double min_share = 1.0 / 16, max_share = 8, near_share = 1.02;
// A tessellation of more triangles, where a comparison takes a second, is tried with the first shares alone, and coarser steps.
constexpr std::size_t large = 10'000, shares_if_large = 3;
constexpr double near_share_if_large = 1.1;

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

// Edges with three triangles or more. Where a waist closes, meshoptimizer may bring two edges together.
std::size_t many_sided_edges(const Tessellation& mesh) {
  ControlMesh facets;
  facets.points = mesh.positions;
  for (const auto& [a, b, c] : mesh.triangles)
    facets.add_face(std::array{VertexId(a), VertexId(b), VertexId(c)});
  return count_elements(facets, Scheme::flat).many_sided_edges;
}

}  // namespace

Tessellation coarsened(const Surface& surface, TessellateOptions how, const Run& run) {
  const double tolerance = how.error.value();
  const WorkMonitor quiet{.on_progress = {}, .stop = run.monitor->stop};
  Run silent = run;
  silent.monitor = &quiet;
  Tessellation best = tessellate(surface, how, silent);
  best.owners.clear();
  if (best.outcome != Outcome::complete) return best;

  const std::size_t many_sided = many_sided_edges(best);
  // Keeps it if it has fewer triangles and is near enough. Is it not farther than the tolerance, as far as known, and are no
  // more edges many-sided than before?
  const auto consider = [&](Tessellation mesh) {
    if (mesh.triangles.size() >= best.triangles.size()) return true;
    if (mesh.triangles.empty() || many_sided_edges(mesh) > many_sided) return false;
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    }
    const Deviation found =
        deviation(surface, triangles, {.absolute = tolerance / 64, .threshold = tolerance},
                  {.threads = run.threads, .monitor = &quiet});
    mesh.error_bound = std::max(found.from_surface.distance.upper, found.from_candidate.distance.upper);
    const bool near = mesh.error_bound <= tolerance;
    if (near) best = std::move(mesh);
    return near;
  };
  const bool is_large = best.triangles.size() > large;
  const std::span tried = std::span(shares).first(is_large ? shares_if_large : shares.size());
  const double near_enough = is_large ? near_share_if_large : near_share;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const double share = tried[i];
    how.error = share * tolerance;
    Tessellation fine;
    try {
      fine = share == 1 ? best : tessellate(surface, how, silent);
    } catch (const InputError&) {
      continue;  // too fine for the arithmetic
    }
    if (fine.outcome != Outcome::complete) continue;
    fine.owners.clear();
    const FloatMesh floats(fine);
    // Halving in logarithms: what is near enough goes below, what is not above.
    double low = min_share * tolerance, high = max_share * tolerance;
    if (share > 1 && !consider(fine)) high = low;
    while (high > near_enough * low) {
      run.monitor->report(
          (static_cast<double>(i + 1) - std::log(high / low) / std::log(max_share / min_share)) /
          static_cast<double>(tried.size()));
      const double error = std::sqrt(low * high);
      (consider(part_of(fine, floats.simplified(error))) ? low : high) = error;
    }
  }
  run.monitor->report(1);
  return best;
}

}  // namespace snug::command
