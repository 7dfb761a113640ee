#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <opensubdiv/far/topologyRefiner.h>

#include <snug/surface.h>

/// Base meshes of OpenSubdiv 3 as control meshes of snug. Header only: snug itself neither needs nor links
/// OpenSubdiv.
namespace snug::opensubdiv {

/// The arguments of Surface.
struct MeshAndOptions {
  ControlMesh mesh;
  SurfaceOptions options;
};

namespace detail {

namespace Far = OpenSubdiv::Far;
namespace Sdc = OpenSubdiv::Sdc;

inline Scheme scheme_of(const Far::TopologyRefiner& refiner) {
  switch (refiner.GetSchemeType()) {
    case Sdc::SCHEME_LOOP:
      return Scheme::loop;
    case Sdc::SCHEME_CATMARK:
      return Scheme::catmark;
    case Sdc::SCHEME_BILINEAR:
      break;
  }
  return Scheme::bilinear;
}

inline BoundaryRule boundary_of(const Sdc::Options& options) {
  switch (options.GetVtxBoundaryInterpolation()) {
    case Sdc::Options::VTX_BOUNDARY_NONE:
      return BoundaryRule::none;
    case Sdc::Options::VTX_BOUNDARY_EDGE_ONLY:
      return BoundaryRule::edge_only;
    case Sdc::Options::VTX_BOUNDARY_EDGE_AND_CORNER:
      break;
  }
  return BoundaryRule::edge_and_corner;
}

inline void read_faces(const Far::TopologyLevel& level, ControlMesh& mesh) {
  mesh.face_offsets.reserve(static_cast<std::size_t>(level.GetNumFaces()) + 1);
  mesh.face_vertices.reserve(static_cast<std::size_t>(level.GetNumFaceVertices()));
  std::vector<VertexId> face;
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    const Far::ConstIndexArray vertices = level.GetFaceVertices(f);
    face.clear();
    for (int k = 0; k < vertices.size(); ++k) face.emplace_back(static_cast<std::size_t>(vertices[k]));
    mesh.add_face(face);
  }
}

// The refiner has made boundary and non-manifold edges infinitely sharp, whatever they were before.
inline void read_creases(const Far::TopologyLevel& level, std::vector<CreaseTag>& creases) {
  for (int e = 0; e < level.GetNumEdges(); ++e) {
    const float sharpness = level.GetEdgeSharpness(e);
    if (sharpness <= 0 || level.IsEdgeBoundary(e) || level.IsEdgeNonManifold(e)) continue;
    const Far::ConstIndexArray ends = level.GetEdgeVertices(e);
    const auto [a, b] = std::minmax(ends[0], ends[1]);
    creases.push_back({VertexId(static_cast<std::size_t>(a)), VertexId(static_cast<std::size_t>(b)),
                       static_cast<double>(sharpness)});
  }
  std::sort(creases.begin(), creases.end(),
            [](const CreaseTag& p, const CreaseTag& q) { return std::tie(p.a, p.b) < std::tie(q.a, q.b); });
}

// Has the refiner made the vertex infinitely sharp, whatever it was before?
inline bool sharpened(const Far::TopologyLevel& level, int v, BoundaryRule boundary) {
  const Far::ConstIndexArray edges = level.GetVertexEdges(v);
  const int faces = level.GetVertexFaces(v).size();
  if (faces == 1 && edges.size() == 2 && boundary == BoundaryRule::edge_and_corner) return true;
  if (!level.IsVertexNonManifold(v)) return false;
  // A crease where walls meet a closed surface passes through its vertices smoothly.
  int non_manifold = 0;
  for (int k = 0; k < edges.size(); ++k) non_manifold += level.IsEdgeNonManifold(edges[k]) ? 1 : 0;
  return non_manifold != 2 || level.IsVertexBoundary(v) || faces <= edges.size();
}

inline void read_corners(const Far::TopologyLevel& level, BoundaryRule boundary,
                         std::vector<CornerTag>& corners) {
  for (int v = 0; v < level.GetNumVertices(); ++v) {
    const float sharpness = level.GetVertexSharpness(v);
    if (sharpness <= 0 || sharpened(level, v, boundary)) continue;
    corners.push_back({VertexId(static_cast<std::size_t>(v)), static_cast<double>(sharpness)});
  }
}

inline bool at_boundary(const Far::TopologyLevel& level, int face) {
  const Far::ConstIndexArray vertices = level.GetFaceVertices(face);
  return std::any_of(vertices.begin(), vertices.end(), [&](int v) { return level.IsVertexBoundary(v); });
}

// With VTX_BOUNDARY_NONE the refiner has made holes of the faces at the boundary, as snug's `none` does,
// except where boundary edges were tagged infinitely sharp. Such a mesh is read as edge_only with all these
// holes.
inline void read_holes(const Far::TopologyLevel& level, BoundaryRule& boundary, std::vector<FaceId>& holes) {
  std::vector<FaceId> all, inner;
  bool bounded = false;  // has a face at the boundary a surface?
  for (int f = 0; f < level.GetNumFaces(); ++f) {
    const bool inside = !at_boundary(level, f);
    if (!level.IsFaceHole(f)) {
      bounded |= !inside;
      continue;
    }
    all.emplace_back(static_cast<std::size_t>(f));
    if (inside) inner.push_back(all.back());
  }
  if (boundary == BoundaryRule::none && bounded) boundary = BoundaryRule::edge_only;
  holes = boundary == BoundaryRule::none ? std::move(inner) : std::move(all);
}

// All but the points.
inline MeshAndOptions read_topology(const Far::TopologyRefiner& refiner) {
  MeshAndOptions result;
  auto& [mesh, options] = result;
  options.scheme = scheme_of(refiner);
  const Sdc::Options rules = refiner.GetSchemeOptions();
  options.boundary = boundary_of(rules);
  if (rules.GetCreasingMethod() == Sdc::Options::CREASE_CHAIKIN)
    mesh.tags.crease_method = CreaseMethod::chaikin;
  if (rules.GetTriangleSubdivision() == Sdc::Options::TRI_SUB_SMOOTH) {
    mesh.tags.smooth_triangles = SmoothTriangles::smooth;
  }
  const Far::TopologyLevel& level = refiner.GetLevel(0);
  read_faces(level, mesh);
  read_creases(level, mesh.tags.creases);
  read_corners(level, *options.boundary, mesh.tags.corners);
  read_holes(level, *options.boundary, mesh.tags.holes);
  mesh.tags.boundary = options.boundary;
  return result;
}

[[noreturn]] inline void refuse_too_few_points() {
  throw InputError(InputProblem::value,
                   "from_refiner: there are fewer points than vertices of the base level");
}

template <class Real>
MeshAndOptions read_strided(const Far::TopologyRefiner& refiner, std::span<const Real> values,
                            std::size_t stride) {
  MeshAndOptions result = read_topology(refiner);
  const auto count = static_cast<std::size_t>(refiner.GetLevel(0).GetNumVertices());
  if (stride < 3) {
    throw InputError(InputProblem::value, "from_refiner: the stride is less than three numbers");
  }
  if (count > 0 && (values.size() < 3 || (values.size() - 3) / stride < count - 1)) refuse_too_few_points();
  result.mesh.points.reserve(count);
  for (std::size_t v = 0; v < count; ++v) {
    const auto p = values.subspan(v * stride, 3);
    result.mesh.points.push_back(
        {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  }
  return result;
}

}  // namespace detail

/// The base level of a refiner, with these control points, as a control mesh with tags, and the rules of its
/// surface:
///
///     auto [mesh, options] = snug::opensubdiv::from_refiner(refiner, points);
///     const snug::Surface surface(std::move(mesh), options);
///
/// Guarantee: the limit surface is the refiner's. Vertices and faces keep their numbers, faces their first
///            vertex, points and sharpnesses their values. Creases are sorted with a < b; corners and holes
///            are ascending. Edges and vertices that the refiner made sharp by rule (boundaries, corners by
///            the boundary rule, non-manifold ones) get no tag. Nor do the holes that VTX_BOUNDARY_NONE
///            makes, since BoundaryRule::none makes them too; but if sharp boundary edges kept a face there,
///            the boundary is edge_only and all holes are tags. `mesh.tags.boundary` is `options.boundary`.
///            It does not matter whether and how the refiner was refined; face-varying data is not read.
///            Points beyond those of the base level, such as those of refined levels, are ignored.
/// Errors:    InputError (value) for too few points. Surface refuses meshes that snug does not support.
/// Cost:      linear, except for sorting the creases; copies the points.
[[nodiscard]] inline MeshAndOptions from_refiner(const OpenSubdiv::Far::TopologyRefiner& refiner,
                                                 std::span<const Point3> points) {
  MeshAndOptions result = detail::read_topology(refiner);
  const auto count = static_cast<std::size_t>(refiner.GetLevel(0).GetNumVertices());
  if (points.size() < count) detail::refuse_too_few_points();
  result.mesh.points.assign(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count));
  return result;
}

/// The same for x, y, z in an array of numbers, `stride` numbers from one point to the next. To skip leading
/// numbers, pass a subspan.
///
/// Errors:    those above, and InputError (value) for a stride below 3. Values may end at the last z.
[[nodiscard]] inline MeshAndOptions from_refiner(const OpenSubdiv::Far::TopologyRefiner& refiner,
                                                 std::span<const float> values, std::size_t stride = 3) {
  return detail::read_strided(refiner, values, stride);
}
[[nodiscard]] inline MeshAndOptions from_refiner(const OpenSubdiv::Far::TopologyRefiner& refiner,
                                                 std::span<const double> values, std::size_t stride = 3) {
  return detail::read_strided(refiner, values, stride);
}

}  // namespace snug::opensubdiv
