#include <snug/query/hull_vertices.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <snug/geometry/nearest_to_origin.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle.h>
#include <snug/search/piece.h>
#include <snug/search/precision.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

// How much longer than the shortest a displacement may be that goes the way the surface faces.
constexpr double longest_detour = 1.25;
// Vertices of facets that turn over: means over neighbours of the way they go, of the error that is left there how far they may go, and how
// often they are looked for.
constexpr int smoothing_passes = 4, max_steered = 4;
constexpr double room_share = 0.95;
// Of the tolerance of a triangle: how much farther off its plane than its error its facet is kept.
constexpr double clearance = 0.1;

}  // namespace

TrianglesAround::TrianglesAround(const Tessellation& mesh)
    : begins_(mesh.positions.size() + 1), triangles_(3 * mesh.triangles.size()) {
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++begins_[v + 1];
  }
  for (std::size_t v = 1; v < begins_.size(); ++v) begins_[v] += begins_[v - 1];
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) triangles_[next[v]++] = static_cast<std::uint32_t>(t);
  }
}

HullVertices::HullVertices(const HullTriangles& triangles, const HullOptions& options, const Run& run)
    : triangles_(triangles),
      options_(options),
      run_(run),
      planes_(make_planes()),
      positions_(triangles.mesh.positions),
      moved_(positions_.size()) {
  move_all();
}

bool HullVertices::is_turned(std::size_t t) const {
  return triangles_.sign * dot(unit_normal(scaled(positions_, t)), planes_.normals[t]) < 0;
}

// How far a vertex of a hull is at most moved when it becomes a float.
double HullVertices::float_loss() const {
  if (!options_.single_precision) return 0;
  const double largest = triangles_.scale.inverse().apply(2) + *options_.error;
  return 2 * (0x1p-24 * largest + 0x1p-150);
}

Point3 HullVertices::as_written(Point3 p) const {
  for (std::size_t a = 0; a < 3 && options_.single_precision; ++a) {
    const auto rounded = static_cast<float>(p[a]);
    if (!std::isfinite(rounded)) {
      throw InputError(InputProblem::unrepresentable,
                       "hull: a coordinate does not fit a float; scale the mesh down, or write a format that "
                       "holds doubles");
    }
    p[a] = static_cast<double>(rounded);
  }
  return require_representable(p);
}

Triangle HullVertices::scaled(const std::vector<Point3>& points, std::size_t t) const {
  const auto& [a, b, c] = triangles_.mesh.triangles[t];
  return {triangles_.scale.apply(points[a]), triangles_.scale.apply(points[b]),
          triangles_.scale.apply(points[c])};
}

HullVertices::Planes HullVertices::make_planes() const {
  const std::size_t count = triangles_.mesh.triangles.size();
  const double float_loss = this->float_loss();
  Planes planes{std::vector<Vector3>(count), std::vector<Vector3>(count), std::vector<double>(count)};
  parallel_for(count, run_.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle triangle = scaled(triangles_.mesh.positions, t);
      planes.areas[t] = triangles_.sign * cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
      planes.normals[t] = triangles_.sign * unit_normal(triangle);
      planes.offsets[t] = triangles_.errors[t] + clearance * triangles_.allowed[t] + float_loss;
    }
  });
  return planes;
}

// The way that the triangles around each vertex face together.
std::vector<Vector3> HullVertices::facings() const {
  std::vector<Vector3> facing(positions_.size());
  for (std::size_t v = 0; v < facing.size(); ++v) {
    for (const std::uint32_t t : triangles_.around[v]) facing[v] = facing[v] + planes_.areas[t];
    facing[v] = normalized(facing[v]);
  }
  return facing;
}

// Mean over the vertex and its neighbours, several times.
std::vector<Vector3> HullVertices::smoothed(std::vector<Vector3> facing) const {
  std::vector<Vector3> mean(facing.size());
  for (int pass = 0; pass < smoothing_passes; ++pass) {
    parallel_for(mean.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        Vector3 sum;
        for (const std::uint32_t t : triangles_.around[v]) {
          for (const std::uint32_t w : triangles_.mesh.triangles[t]) sum = sum + facing[w];
        }
        mean[v] = normalized(sum);
      }
    });
    facing.swap(mean);
  }
  return facing;
}

// A place about as near as possible to where the vertex was, beyond the planes of the triangles around it. The way that it faces goes before
// the shortest one: beside a narrow triangle, whose normal may be anything, that leads past the next vertex. That way it may go `room`
// however short the other one is. Nothing if there is no such place.
std::optional<Vector3> HullVertices::displacement(std::size_t v, const Vector3& facing, double room) const {
  const auto& [areas, normals, offsets] = planes_;
  std::vector<Vector3> planes;
  double largest = 0, along = 0;
  for (const std::uint32_t t : triangles_.around[v]) largest = std::max(largest, offsets[t]);
  for (const std::uint32_t t : triangles_.around[v]) {
    if (normals[t] == Vector3{}) continue;
    planes.push_back((largest / offsets[t]) * normals[t]);
    const double cosine = dot(facing, normals[t]);
    along = cosine > 0 ? std::max(along, offsets[t] / cosine) : INFINITY;
  }
  // A point of needles only: it stays, and is found to be on the surface.
  if (planes.empty()) return Vector3{};
  if (along <= room) return along * facing;
  const Vector3 z = nearest_to_origin(planes);
  const double square = length_sq(z);
  if (!(square > 1e-16)) return std::nullopt;
  // The shortest is largest / |z| long; lengths in mesh units have no squares.
  return along * std::sqrt(square) <= longest_detour * largest ? along * facing : (largest / square) * z;
}

// Returns how far it goes, scaled.
double HullVertices::move_vertex(std::uint32_t v, const Vector3& facing, double share_of_room) {
  const Point3& from = triangles_.mesh.positions[v];
  Point3& p = positions_[v];
  p = from;
  double error = 0;
  for (const std::uint32_t t : triangles_.around[v]) error = std::max(error, triangles_.errors[t]);
  const std::optional<Vector3> by = displacement(v, facing, share_of_room * (*options_.error - error));
  if (!by) return INFINITY;
  p = as_written(p + *by);
  return enlarged(distance(triangles_.scale.apply(p), triangles_.scale.apply(from)));
}

// Vertices of facets that are turned, which are not steered yet, and now are.
std::vector<std::uint32_t> HullVertices::steer(std::vector<std::uint8_t>& steered) const {
  std::vector<std::uint32_t> vertices;
  for (std::size_t t = 0; t < triangles_.mesh.triangles.size(); ++t) {
    if (!is_turned(t)) continue;
    for (const std::uint32_t v : triangles_.mesh.triangles[t]) {
      if (std::exchange(steered[v], std::uint8_t{1}) == 0) vertices.push_back(v);
    }
  }
  return vertices;
}

void HullVertices::move_all() {
  std::vector<Vector3> facing = facings();
  std::vector<std::uint8_t> steered(positions_.size());
  std::vector<std::uint32_t> vertices(positions_.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  for (int time = 0; !vertices.empty(); ++time) {
    if (time == 1) facing = smoothed(std::move(facing));
    parallel_for(vertices.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      monitor_of(run_).checkpoint();
      for (const std::uint32_t v : std::span(vertices).subspan(begin, end - begin))
        moved_[v] = move_vertex(v, facing[v], time == 0 ? 0 : room_share);
    });
    if (time == max_steered) break;
    vertices = steer(steered);
  }
}

}  // namespace snug
