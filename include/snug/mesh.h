#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/geometry.h>
#include <snug/monitor.h>

namespace snug {

/// A typed index: a vertex index cannot be mixed up with a face index.
template <class Tag>
class Id {
 public:
  constexpr Id() = default;
  constexpr explicit Id(std::size_t value) : value_(static_cast<std::uint32_t>(value)) {}
  [[nodiscard]] constexpr std::uint32_t value() const noexcept { return value_; }
  /// For indexing arrays.
  [[nodiscard]] constexpr std::size_t index() const noexcept { return value_; }
  [[nodiscard]] constexpr bool valid() const noexcept { return value_ != UINT32_MAX; }
  friend constexpr auto operator<=>(Id, Id) = default;

 private:
  std::uint32_t value_ = UINT32_MAX;
};

using VertexId = Id<struct VertexTag>;
using EdgeId = Id<struct EdgeTag>;
using FaceId = Id<struct FaceTag>;
using PolylineId = Id<struct PolylineTag>;

enum class Scheme : std::uint8_t {
  loop,       ///< triangles
  catmark,    ///< Catmull-Clark: faces of any size
  doo_sabin,  ///< dual: patches belong to vertices
  midedge,    ///< dual
  bilinear,   ///< quads are bilinear patches, other faces are first split into quads, as in OpenSubdiv
  flat,       ///< triangles as they are
};
[[nodiscard]] SNUG_API const char* name_of(Scheme scheme);

/// How the boundary of a mesh is subdivided, as in OpenSubdiv and USD.
enum class BoundaryRule : std::uint8_t {
  none,             ///< faces at a boundary vertex have no limit surface, but support their neighbours
  edge_only,        ///< boundary edges are infinitely sharp creases
  edge_and_corner,  ///< the same, and boundary vertices with one face are infinitely sharp corners
};

enum class CreaseMethod : std::uint8_t { uniform, chaikin };

/// How Catmull-Clark treats triangles.
enum class SmoothTriangles : std::uint8_t { catmark, smooth };

/// Sharpness of this value or more is infinite, as in OpenSubdiv.
inline constexpr double infinite_sharpness = 10.0;

struct CreaseTag {
  VertexId a, b;  ///< ends of the edge
  double sharpness;
};

struct CornerTag {
  VertexId vertex;
  double sharpness;
};

/// Rules that a file attaches to its mesh or to elements of it. They are read and written unchanged.
struct MeshTags {
  std::vector<CreaseTag> creases;
  std::vector<CornerTag> corners;
  std::vector<FaceId> holes;
  std::optional<BoundaryRule> boundary;
  CreaseMethod crease_method = CreaseMethod::uniform;
  SmoothTriangles smooth_triangles = SmoothTriangles::catmark;
  /// None: that of the faces, see SurfaceOptions. Flat for what is read from STL and glTF files.
  std::optional<Scheme> scheme;
};

/// A polygonal control mesh: positions, faces as counter-clockwise vertex cycles, tags, and polylines.
/// Polylines are the control polygons of curves, closed if the last vertex is the first. A plain value, which
/// may hold a defective mesh; Surface checks it.
///
/// Requires:  face_offsets has face_count() + 1 entries that start at 0 and do not decrease; polyline_offsets
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

/// Receives one line for everything that a reader or writer drops although it changes the surface.
using Notes = std::function<void(const std::string& line)>;

struct ReadOptions {
  /// The distance to weld by, see weld(). `size` is the longest side of the bounding box of the vertices that
  /// faces or polylines use.
  std::function<double(double size)> weld{};
  Notes notes{};
  WorkMonitor monitor{};
};

/// Reads a control mesh. The extension selects the format: .obj, .off, .ply, .stl, .glb or .usda (also .usd, if
/// it is text), in upper or lower case. Standard input ("-") and files without an extension are recognised as
/// PLY, OFF, USD or glTF by their first bytes; otherwise they are read as OBJ.
///
/// Notes:     those of the parser, one line about what was welded, and one if creases name no edge of a face.
/// Errors:    InputError: (unreadable) for a file that cannot be read or parsed, naming the line; those of
///            weld(). Interrupted.
[[nodiscard]] SNUG_API ControlMesh read_mesh(const std::string& path, const ReadOptions& options = {});

/// Writes a control mesh, completely or not at all. The extension selects the format: .obj, .off, .ply
/// (binary, little endian), .stl (binary), .glb or .usda; "-" is OBJ on standard output.
///
/// Notes:     one line for tags and one for polylines that the format cannot hold, and those of the format's
///            writer. STL and glTF mean their triangles as they are, OFF and PLY do not: for these there is a
///            line if the mesh is tagged flat.
/// Errors:    InputError: (unreadable) for another extension, or if the file cannot be written; (refused) if
///            the format cannot hold the faces, such as STL those that are not triangles. Interrupted.
SNUG_API void write_mesh(const ControlMesh& mesh, const std::string& path, const Notes& notes = {},
                         const WorkMonitor& monitor = {});

/// What weld() did to a mesh.
struct Welded {
  std::size_t vertices = 0;   ///< vertices merged into an earlier one
  double farthest = 0;        ///< the largest distance of such a vertex from the earlier one
  std::size_t shortened = 0;  ///< faces that lost corners and still have at least three different ones
  std::size_t dropped = 0;    ///< faces that were removed, with fewer than three left
};

/// Merges vertices with equal coordinates (0 equals -0) or, given a distance, vertices at most that far
/// apart, measured in double precision. Chains of such vertices merge too, so the ends of a chain may be
/// farther apart.
///
/// Guarantee: the first of the merged vertices stays where it is. The remaining vertices, faces and polylines
///            keep their order. If consecutive corners of a face merge, it keeps one of them; a face left
///            with fewer than three different corners is removed. Other corners of a face may merge too, and
///            the face then names a vertex twice. Polylines keep all their points; one whose ends merge is
///            closed. Creases and corners move to the remaining vertices, and the sharpest counts where
///            several coincide. Creases whose ends merge and holes that are removed disappear.
/// Errors:    InputError: (value) for a distance that is negative or not finite; (refused) for a positive one
///            below 2^-40 of the largest coordinate, and for points that are not finite. The mesh is then
///            unchanged.
/// Cost:      linear without a distance; with one, points are also sorted and paired with neighbouring cells:
///            about a second for a million points.
SNUG_API Welded weld(ControlMesh& mesh, double distance = 0);

/// The default angle of sharpen(), in degrees.
inline constexpr double default_sharp_angle = 30;

/// What sharpen() did to a mesh.
struct Sharpened {
  std::size_t creases = 0;  ///< tags added, on edges that were not infinitely sharp
  std::size_t corners = 0;  ///< tags added
  /// Planar regions between sharp edges; their limit surface is now the region itself.
  std::size_t flat_regions = 0;
  /// Curved regions that stay faceted, because all their vertices are corners.
  std::size_t fixed_regions = 0;
  /// Non-convex faces of flat and fixed regions that were split into triangles.
  std::size_t split_faces = 0;
  /// Faces of these regions that cross or touch themselves and could not be split. Their limit surface may
  /// leave the polygon.
  std::size_t crossed_faces = 0;
  /// For each face that splitting appended: the face that it was a part of.
  std::vector<FaceId> parts_of;
};

/// Tags sharp edges by angle, for parts from CAD, whose facets are the intended shape.
///
/// - An edge of two faces whose normals differ by more than `angle` degrees becomes an infinitely sharp
///   crease. Boundary edges and non-manifold ones are sharp by rule and get no tag.
/// - A region of faces bounded by such edges, or by edges that were infinitely sharp before, is planar if its
///   vertices lie between two parallel planes at most 2 t apart. All its edges become infinitely sharp, and
///   all its vertices corners.
/// - A vertex where two sharp edges meet at a turn of more than `angle` becomes a corner. One with three or
///   more sharp edges is a corner by rule and gets no tag; one with a single sharp edge stays a dart.
/// - A curved region whose vertices are all corners, such as the wall of a hole with one row of facets, stays
///   faceted: all its edges become infinitely sharp.
/// - Non-convex faces of these regions are split into triangles. The first keeps the number of the face, the
///   others are appended after all faces. Holes are not split.
///
/// Here t is the assumed accuracy of coordinates: 2^-17 of the longest side of the bounding box of the used
/// vertices, or if that is more, 2^-22 (if all coordinates are floats, else 2^-48) of the largest coordinate.
/// A face narrower than t (twice its area over half its perimeter) has no reliable normal: for its edges, the
/// faces on the far sides of such faces are compared.
///
/// Guarantee: with Loop and Catmull-Clark the limit surface of a face whose edges are infinitely sharp and
///            whose vertices are corners lies in the convex hull of its vertices and ends at its edges. With
///            Loop it is the triangle itself, with Catmull-Clark the polygon, if that is planar and convex.
///            After sharpen() all faces of these regions are of this kind, except crossed_faces. Which edges
///            are sharp is decided in double precision and may depend on rounding; the limit surface of the
///            resulting tags does not. Existing tags are kept, and new ones, which take precedence, are
///            appended. Positions do not change. Faces keep their numbers.
///            Dual schemes ignore the tags.
/// Scheme:    who sharpens takes the mesh as a control mesh: the scheme of a mesh without one, or tagged flat,
///            is Loop from now on if all faces are triangles, else that of the faces.
/// Errors:    InputError (value) unless 0 <= angle < 180.
/// Cost:      linear, times the logarithm of the largest valence; splitting is quadratic in the corners of a
///            face. A mesh with faces of fewer than three vertices, references to missing vertices or
///            coordinates that are not finite is left unchanged; Surface refuses it.
/// Source:    derivations/sharp_parts.md; corners and rules: derivations/creases.md.
SNUG_API Sharpened sharpen(ControlMesh& mesh, double angle = default_sharp_angle);

}  // namespace snug

template <class Tag>
struct std::hash<snug::Id<Tag>> {
  std::size_t operator()(snug::Id<Tag> id) const noexcept { return id.value(); }
};
