#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/base/ids.h>
#include <snug/geometry/point.h>

namespace snug {

/// What the boundary of a mesh does, as in OpenSubdiv and USD.
enum class BoundaryRule : std::uint8_t {
  none,             ///< faces at a boundary vertex have no limit surface, but support their neighbours
  edge_only,        ///< boundary edges are infinitely sharp creases
  edge_and_corner,  ///< and boundary vertices with one face are infinitely sharp corners
};

enum class CreaseMethod : std::uint8_t { uniform, chaikin };

/// How Catmull-Clark treats triangles.
enum class SmoothTriangles : std::uint8_t { catmark, smooth };

/// Sharpness from here on is infinite, as in OpenSubdiv.
inline constexpr double infinite_sharpness = 10.0;

struct CreaseTag {
  VertexId a, b;  ///< ends of the edge
  double sharpness;
};

struct CornerTag {
  VertexId vertex;
  double sharpness;
};

/// Rules that a file attaches to parts of its mesh. Read and written as they stand.
struct MeshTags {
  std::vector<CreaseTag> creases;
  std::vector<CornerTag> corners;
  std::vector<FaceId> holes;
  std::optional<BoundaryRule> boundary;
  CreaseMethod crease_method = CreaseMethod::uniform;
  SmoothTriangles smooth_triangles = SmoothTriangles::catmark;
};

/// A polygonal control mesh: positions, faces as counter-clockwise vertex cycles, tags, and polylines, which
/// are the control polygons of curves: closed if the last vertex is the first. A plain value.
///
/// Guarantee: none beyond well-formed arrays: it holds defective meshes too, see validate.h.
/// Requires:  face_offsets has face_count() + 1 entries, starting at 0, not decreasing; polyline_offsets
///            likewise.
struct ControlMesh {
  std::vector<Point3> points;
  std::vector<std::uint32_t> face_offsets{0};
  std::vector<VertexId> face_vertices;
  MeshTags tags;
  std::vector<std::uint32_t> polyline_offsets{0};
  std::vector<VertexId> polyline_vertices;

  [[nodiscard]] std::size_t vertex_count() const { return points.size(); }
  [[nodiscard]] std::size_t face_count() const { return face_offsets.size() - 1; }
  [[nodiscard]] std::span<const VertexId> face(FaceId f) const {
    return {face_vertices.data() + face_offsets[f.index()],
            face_vertices.data() + face_offsets[f.index() + 1]};
  }
  void add_face(std::span<const VertexId> vertices) {
    face_vertices.insert(face_vertices.end(), vertices.begin(), vertices.end());
    face_offsets.push_back(static_cast<std::uint32_t>(face_vertices.size()));
  }
  [[nodiscard]] std::size_t polyline_count() const { return polyline_offsets.size() - 1; }
  [[nodiscard]] std::span<const VertexId> polyline(PolylineId p) const {
    return {polyline_vertices.data() + polyline_offsets[p.index()],
            polyline_vertices.data() + polyline_offsets[p.index() + 1]};
  }
  void add_polyline(std::span<const VertexId> vertices) {
    polyline_vertices.insert(polyline_vertices.end(), vertices.begin(), vertices.end());
    polyline_offsets.push_back(static_cast<std::uint32_t>(polyline_vertices.size()));
  }
};

/// Box of the vertices that faces use; the longest side of it is what percent lengths refer to.
[[nodiscard]] Box3 used_box(const ControlMesh& mesh);

}  // namespace snug
