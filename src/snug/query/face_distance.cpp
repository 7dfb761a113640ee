#include <algorithm>
#include <vector>

#include <snug/evaluate.h>
#include <snug/geometry/rounding.h>
#include <snug/search/surface_data.h>
#include <snug/surface/batch_bounds.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

/// Which faces are their own limit surface, or hold it: with infinitely sharp edges and corners alone.
std::vector<bool> sharp_faces(const LimitSurface& surface) {
  const Topology& topology = surface.topology();
  const Sharpness sharpness = sharpness_of(surface.mesh(), topology);
  std::vector<bool> edge_sharp(topology.edge_count());
  std::vector<std::uint32_t> sharp_edges(topology.vertex_count(), 0);
  for (std::size_t e = 0; e < edge_sharp.size(); ++e) {
    edge_sharp[e] = edge_sharpness(topology, sharpness, EdgeId(e)) >= infinite_sharpness;
    if (!edge_sharp[e]) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    ++sharp_edges[topology.from(h).index()];
    ++sharp_edges[topology.to(h).index()];
  }
  const auto is_corner = [&](VertexId v) {
    return sharp_edges[v.index()] > 2 ||
           vertex_sharpness(topology, sharpness, v, surface.options().boundary) >= infinite_sharpness;
  };
  std::vector<bool> sharp(surface.face_count());
  for (std::size_t f = 0; f < sharp.size(); ++f) {
    const auto face = topology.face(FaceId(f));
    const HalfEdge first = topology.first_of(FaceId(f));
    bool all = true;
    for (std::size_t k = 0; k < face.size() && all; ++k) {
      all = edge_sharp[topology.edge_of(first + static_cast<HalfEdge>(k)).index()] && is_corner(face[k]);
    }
    sharp[f] = all;
  }
  return sharp;
}

/// At least the distance of a point from a triangle; all coordinates at most about 4.
double distance_at_most(const Point3& p, const Point3& a, const Point3& b, const Point3& c) {
  const TriangleFoot foot(a - Point3{}, b - Point3{}, c - Point3{});
  const Barycentric weights = foot(p - Point3{});
  const Point3 on = a + (weights.b * foot.edge_b() + weights.c * foot.edge_c());
  // Some twenty roundings of numbers below 16.
  return enlarged(distance(p, on)) + 0x1p-44;
}

/// At least the distance of a point from the hull of a face: that of the nearest of some triangles in it.
double distance_at_most(const Point3& p, const LimitSurface& surface, std::span<const VertexId> face) {
  const auto corner = [&](std::size_t k) { return surface.scaled_point(face[k]); };
  double least = INFINITY;
  for (std::size_t k = 1; k + 1 < face.size(); ++k) {
    least = std::min(least, distance_at_most(p, corner(0), corner(k), corner(k + 1)));
  }
  if (face.size() == 4) {
    least = std::min({least, distance_at_most(p, corner(0), corner(1), corner(3)),
                      distance_at_most(p, corner(1), corner(2), corner(3))});
  }
  return least;
}

}  // namespace

std::optional<double> limit_to_faces(const Surface& handle, const Run& run) {
  const LimitSurface& surface = handle.data()->limit();
  if (!surface.rules().primal) return {};
  if (surface.rules().local) return 0.0;
  const std::vector<bool> sharp = sharp_faces(surface);
  std::vector<PatchId> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p)) && !sharp[surface.place(PatchId(p)).owner]) patches.emplace_back(p);
  }
  if (patches.empty()) return 0.0;
  BatchBounds bounds(surface, patches, {}, run.threads);
  std::vector<OffsetTriangle> offsets(patches.size());
  bounds.update(surface.mesh().points, offsets, run.threads);
  double most = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const auto face = surface.topology().face(FaceId(surface.place(bounds.patches()[i]).owner));
    double from_base = 0;
    for (const Point3& corner : offsets[i].base) {
      from_base = std::max(from_base, distance_at_most(surface.scale().apply(corner), surface, face));
    }
    most = std::max(most, enlarged(from_base + surface.scale().apply(offsets[i].radius)));
  }
  return require_representable(unscaled_up(most, surface.scale().inverse()));
}

}  // namespace snug
