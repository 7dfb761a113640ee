#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <snug/bound.h>
#include <snug/surface.h>

namespace snug {

enum class DefectKind : std::uint8_t {
  index_out_of_range,        ///< face uses a vertex that is not there
  coordinate_not_finite,     ///< vertex
  too_few_vertices,          ///< face with fewer than three corners
  repeated_vertex,           ///< face names a vertex twice
  duplicate_face,            ///< two faces with the same vertices
  edge_of_many_faces,        ///< edge with more than two faces
  inconsistent_orientation,  ///< two faces run along an edge in the same direction
  pinched_vertex,            ///< the faces around a vertex form more than one fan
  bad_tag,          ///< a tag names something that is not there, or a sharpness that is not a number >= 0
  isolated_vertex,  ///< no face uses it: legal, it has no surface
  zero_area_face,   ///< legal: the limit surface is defined all the same
};
[[nodiscard]] SNUG_API const char* name_of(DefectKind kind);

/// A fault of a mesh. The text is one line without a full stop that names the elements, such as "edge (12, 57) has 3
/// faces: 4, 9, 31".
struct Defect {
  DefectKind kind;
  std::string text;
};

/// All defects of a mesh, by kind, then by element.
///
/// Guarantee: a mesh without defects that are not legal is an oriented manifold, closed or with boundary, of finite
///            coordinates. zero_area_face is found in double precision.
/// Requires:  well-formed arrays. Indices out of range hide the defects that depend on neighbours.
/// Cost:      linear, times the logarithm of the largest valence.
[[nodiscard]] SNUG_API std::vector<Defect> defects(const ControlMesh& mesh);
/// Are questions about a mesh with such a defect answered all the same with this scheme? Loop and Catmull-Clark keep elements
/// that are not manifold, infinitely sharp, Loop no duplicate faces; flat and bilinear answer these, too; dual schemes answer
/// legal defects alone.
[[nodiscard]] SNUG_API bool scheme_answers(Scheme scheme, DefectKind kind);

/// Counts of a mesh, of a broken one too. Faces that use vertices which are not there are left out.
struct MeshCounts {
  std::size_t used_vertices = 0;
  std::size_t edges = 0;
  std::size_t boundary_edges = 0;    ///< edges with one face
  std::size_t borders = 0;           ///< sets of these joined by vertices
  std::size_t many_sided_edges = 0;  ///< edges with three faces or more
  std::size_t components = 0;        ///< sets of faces joined by vertices
  bool boxes_meet = false;           ///< do the boxes around two components have a point in common?
  std::size_t min_valence = 0;       ///< least number of edges at a used vertex
  std::size_t max_valence = 0;
  /// Used vertices unlike those of the scheme's regular lattice; with a dual scheme, faces, of which all count.
  std::size_t extraordinary = 0;
  std::size_t creases = 0;  ///< tags on edges of faces
  std::size_t needles =
      0;                ///< faces of some area narrower than a hundredth of their longest side, in doubles
  bool closed = false;  ///< it has faces, and along every edge as many run one way as the other
};
/// Cost:      linear, times the logarithm of the largest valence.
[[nodiscard]] SNUG_API MeshCounts count_elements(const ControlMesh& mesh, Scheme scheme);

/// Vertices and boundary edges that stand where others do and are not joined: faces meet there to the eye alone.
struct Coincidences {
  std::size_t vertices = 0;  ///< vertices of faces that stand exactly where another one stands
  std::size_t places = 0;    ///< where these stand
  std::size_t edges = 0;     ///< edges with one face whose ends stand where those of another such edge stand
  /// Further vertices on edges with one face that weld() would join if given `reach`, and the least and largest distance
  /// of one of them from the vertex that it would become.
  std::size_t near = 0;
  double nearest = 0, farthest = 0;
  /// Vertices of edges with one face that stand within `reach` of the inside of another such edge: T-junctions.
  std::size_t on_edges = 0;
  double reach = 0;  ///< 2^-17 of the longest side of the box of the vertices that faces use
};
/// Finds them; nothing is changed. Meshes with faces that name vertices which are not there, or with coordinates that are
/// not finite, have none.
/// Cost:      linear; on meshes with a boundary that of weld() on its vertices, and of their tree.
[[nodiscard]] SNUG_API Coincidences coincidences(const ControlMesh& mesh);

/// Most faces whose distance from the limit surface a note measures, which takes 0.2 seconds.
inline constexpr std::size_t max_measured_faces = 200'000;

/// The line that SurfaceOptions::notes receives of this surface if nobody named its scheme; empty if it is none of Loop, or its
/// mesh has tags. `option` is how the reader of the line gives a scheme, `apart` the result of limit_to_faces() if it is known.
[[nodiscard]] SNUG_API std::string smoothing_note(const Surface& surface, std::string_view option,
                                                  std::optional<double> apart = {}, const Run& run = {});

/// A face of a closed surface, with a dual scheme a vertex, beside which the surface winds around a point more than once: its
/// shell lies within another one that is turned the same way, or overlaps it.
/// Guarantee: what is named is so; nothing follows where nothing is: points beside 300 patches are asked.
/// Errors:    InputError (refused) unless the surface is closed. Interrupted.
[[nodiscard]] SNUG_API std::optional<std::uint32_t> overlapping_shell(const Surface& surface,
                                                                      const Run& run = {});

/// Which patch topology a patch has: patches with the same number share their bounds. The numbers are arbitrary, and may differ
/// from run to run. None: it is a polynomial.
/// Errors:    InputError (value) if the surface has no such patch.
[[nodiscard]] SNUG_API std::optional<std::uint32_t> topology_of(const Surface& surface,
                                                                const PatchPlace& patch);

/// The vector instructions that bounds use on this machine, such as "AVX2". They change no bit of an answer.
[[nodiscard]] SNUG_API const char* instruction_set();

}  // namespace snug
