#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <snug/geometry.h>
#include <snug/run.h>

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
inline constexpr std::array all_schemes{Scheme::loop,    Scheme::catmark,  Scheme::doo_sabin,
                                        Scheme::midedge, Scheme::bilinear, Scheme::flat};

struct SchemeTraits {
  const char* name;
  std::span<const char* const> other_names;  ///< those of USD and OpenSubdiv
  bool dual;                                 ///< patches belong to vertices, else to faces
  bool triangular;                           ///< a face is one patch; else patches are halves of quads
  bool creases;                              ///< does sharpness change the surface?
  bool local;                                ///< does the surface of a face depend on that face alone?
  std::size_t regular_valence;  ///< edges of a regular vertex; with a dual scheme, of a regular face
  [[nodiscard]] const char* owner() const { return dual ? "vertex" : "face"; }
};
[[nodiscard]] SNUG_API const SchemeTraits& traits_of(Scheme scheme);
[[nodiscard]] SNUG_API const char* name_of(Scheme scheme);
/// By any of its names.
[[nodiscard]] SNUG_API std::optional<Scheme> scheme_named(std::string_view name);

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

/// A polygonal control mesh: positions, faces as counter-clockwise vertex cycles, tags, and polylines, the control
/// polygons of curves, closed if the last vertex is the first. May hold a defective mesh; Surface checks it.
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
  /// The length of a unit, where the file says it: USD, 3MF; a metre in glTF. Nothing is scaled by it.
  std::optional<double> metres_per_unit{};

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

/// The scheme of a mesh for which nobody names one: its tag, else Loop if all faces are triangles, else Catmull-Clark.
[[nodiscard]] SNUG_API Scheme natural_scheme(const ControlMesh& mesh);

/// Receives one line for everything that a reader or writer drops although it changes the surface.
using Notes = std::function<void(const std::string& line)>;

struct ReadOptions {
  /// The distance to weld by, see weld(). `size` is the longest side of the bounding box of the vertices that
  /// faces or polylines use.
  std::function<double(double size)> weld{};
  Notes notes{};
  /// The bytes of a file that this one names, such as the buffer of a .gltf, by its path relative to the folder of this one,
  /// which it never leaves. Default: read_mesh() reads it there, parse_mesh() refuses.
  std::function<std::string(const std::string& path)> other_file{};
};

/// Reads a control mesh. The extension selects the format: .obj, .off, .ply, .stl, .glb, .gltf, .3mf or .usda (also .usd, if
/// it is text), in upper or lower case. Standard input ("-") and files without an extension are recognised as
/// PLY, OFF, USD, glTF or 3MF by their first bytes; otherwise they are read as OBJ. All meshes of a file are one.
///
/// Notes:     those of the parser, one line about what was welded, and one if creases name no edge of a face.
/// Errors:    InputError: (unreadable) for a file that cannot be read or parsed, naming the line; those of
///            weld(). Interrupted.
[[nodiscard]] SNUG_API ControlMesh read_mesh(const std::string& path, const ReadOptions& options = {},
                                             const Run& run = {});

/// The same for the bytes that such a file holds.
[[nodiscard]] SNUG_API ControlMesh parse_mesh(std::string_view bytes, const std::string& path,
                                              const ReadOptions& options = {});

/// The meshes of a file, and where it places them.
struct MeshAssembly {
  struct Part {
    std::string name;        ///< as in the file, with "#2" where another part has it; a number without one
    std::uint32_t mesh = 0;  ///< in `meshes`
    Motion pose{};
  };
  std::vector<ControlMesh> meshes;
  std::vector<Part> parts;
};

/// Reads a file of several meshes: nodes of .gltf and .glb, items of .3mf, prims of .usda. In other formats the mesh is one part.
///
/// Guarantee: a transform of the file that is a Motion up to rounding is the part's pose, and instances share their mesh;
///            any other moves the points of a mesh of its own.
/// Notes, errors: as read_mesh(), of each mesh; one note says how far rounding of the transforms moves a point.
[[nodiscard]] SNUG_API MeshAssembly read_assembly(const std::string& path, const ReadOptions& options = {},
                                                  const Run& run = {});
/// The same for the bytes that such a file holds.
[[nodiscard]] SNUG_API MeshAssembly parse_assembly(std::string_view bytes, const std::string& path,
                                                   const ReadOptions& options = {});

/// Contents of a file format, by its extension.
struct MeshFormat {
  bool polygons;  ///< faces other than triangles
  bool floats;    ///< coordinates in single precision only
  bool normals;   ///< of vertices
  bool scheme;    ///< a scheme is always named: without a tag, that of the faces
};
/// Errors:    InputError (unreadable) for an extension that write_mesh() does not know.
[[nodiscard]] SNUG_API MeshFormat format_of(const std::string& path);

struct WriteOptions {
  std::span<const Vector3> normals{};  ///< of vertices, where the format holds them
  Notes notes{};
};

/// Writes a control mesh, completely or not at all. The extension selects the format: .obj, .off, .ply
/// (binary, little endian), .stl (binary), .glb, .gltf, .3mf or .usda; "-" is OBJ on standard output.
///
/// Notes:     one line for tags and one for polylines that the format cannot hold, and those of the format's
///            writer. STL and glTF mean their triangles as they are, OFF and PLY do not: for these there is a
///            line if the mesh is tagged flat.
/// Errors:    InputError: (unreadable) for another extension, or if the file cannot be written; (refused) if
///            the format cannot hold the faces, such as STL those that are not triangles. Interrupted.
SNUG_API void write_mesh(const ControlMesh& mesh, const std::string& path, const WriteOptions& options = {},
                         const Run& run = {});
/// The bytes of such a file. Errors likewise.
[[nodiscard]] SNUG_API std::string format_mesh(const ControlMesh& mesh, const std::string& path,
                                               const WriteOptions& options = {}, const Run& run = {});

/// Changes that weld() made to a mesh.
struct WeldReport {
  std::size_t vertices = 0;   ///< vertices merged into an earlier one
  double farthest = 0;        ///< the largest distance of such a vertex from the earlier one
  std::size_t shortened = 0;  ///< faces that lost corners and still have at least three different ones
  std::size_t dropped = 0;    ///< faces that were removed, with fewer than three left
};

/// Merges vertices with equal coordinates (0 equals -0) or, given a distance, vertices at most that far apart, in
/// double precision. Chains of such vertices merge too, so the ends of a chain may be farther apart.
///
/// Guarantee: the first of the merged vertices stays where it is, and what remains keeps its order. If consecutive
///            corners of a face merge, it keeps one of them; a face left with fewer than three different corners
///            is removed. Other corners of a face may merge too, and the face then names a vertex twice.
///            Polylines keep all their points. Tags move to the remaining vertices, and the sharpest counts.
/// Errors:    InputError: (value) for a distance that is negative or not finite; (refused) for a positive one
///            below 2^-40 of the largest coordinate, and for points that are not finite. The mesh is then
///            unchanged.
/// Cost:      linear without a distance; with one, points are also sorted and paired with neighbouring cells:
///            about a second for a million points.
SNUG_API WeldReport weld(ControlMesh& mesh, double distance = 0);

/// The default angle of sharpen(), in degrees.
inline constexpr double default_sharp_angle = 30;

/// Changes that sharpen() made to a mesh.
struct SharpenReport {
  std::size_t creases = 0;  ///< tags added, on edges that were not infinitely sharp
  std::size_t corners = 0;  ///< tags added
  std::size_t flat_regions =
      0;  ///< planar regions between sharp edges, which are now their own limit surface
  std::size_t fixed_regions =
      0;                        ///< curved regions that stay faceted, because all their vertices are corners
  std::size_t split_faces = 0;  ///< non-convex faces of both that were split into triangles
  /// Faces of these regions that cross or touch themselves and could not be split. Their limit surface may
  /// leave the polygon.
  std::size_t crossed_faces = 0;
  /// For each face that splitting appended: the face that it was a part of.
  std::vector<FaceId> parts_of;
};

/// Tags sharp edges by angle, for parts from CAD, whose facets are the intended shape: edges of two faces whose
/// normals differ by more than `angle` degrees become infinitely sharp creases; planar regions between them stay
/// planar, and their turns become corners; curved regions whose vertices are all corners stay faceted. Non-convex
/// faces of regions that stay are split into triangles, of which the first keeps the number of the face and the
/// others are appended. The rules in full, and the accuracy that coordinates are assumed to have: the source.
///
/// Guarantee: with Loop and Catmull-Clark the limit surface of a face whose edges are infinitely sharp and whose
///            vertices are corners lies in the convex hull of its vertices and ends at its edges; it is the face
///            itself if that is planar and convex. After sharpen() all faces of regions that stay are of this
///            kind, except crossed_faces. Which edges are sharp is decided in double precision and may depend on
///            rounding; the limit surface of the resulting tags does not. Existing tags are kept, and new ones,
///            which take precedence, are appended. Positions and numbers of faces do not change. Dual schemes
///            ignore the tags.
/// Scheme:    who sharpens takes the mesh as a control mesh: the scheme of a mesh without one, or tagged flat,
///            is Loop from now on if all faces are triangles, else that of the faces.
/// Errors:    InputError (value) unless 0 <= angle < 180.
/// Cost:      linear, times the logarithm of the largest valence; splitting is quadratic in the corners of a
///            face. A mesh with faces of fewer than three vertices, references to missing vertices or
///            coordinates that are not finite is left unchanged; Surface refuses it.
/// Source:    derivations/sharp_parts.md; corners and rules: derivations/creases.md.
SNUG_API SharpenReport sharpen(ControlMesh& mesh, double angle = default_sharp_angle);

}  // namespace snug

template <class Tag>
struct std::hash<snug::Id<Tag>> {
  std::size_t operator()(snug::Id<Tag> id) const noexcept { return id.value(); }
};
