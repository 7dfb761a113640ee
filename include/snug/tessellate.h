#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// From where, and how exactly, triangles are looked at.
struct Viewpoint {
  Point3 eye;
  double angle = 0;  ///< in degrees: under which an error may be seen, such as a pixel's
};

struct TessellateOptions {
  /// Largest distance, in mesh units, between the limit surface and the triangles, either way.
  std::optional<double> tolerance{};
  std::optional<double> max_edge{};  ///< longest edge, in mesh units
  /// Largest angle between limit normals at corners of a triangle, in degrees: in double precision, and only of
  /// triangles with a side longer than the tolerance (without one, a millionth of the size).
  std::optional<double> max_angle{};
  /// A triangle at the distance d from the eye may have an error of d sin(angle): from there no error is seen under
  /// a larger angle.
  std::optional<Viewpoint> view{};
  /// Most of the thickness of pieces, in mesh units: the longest side of the three boxes of a piece's interval
  /// triangle [Wu05, sec. 5.3]. Pieces are then split in four, their neighbours cut as needed.
  std::optional<double> max_thickness{};
  /// Most triangles: the smallest error that is found for so many, but not below the tolerance if there is one.
  std::optional<std::uint64_t> max_triangles{};
  bool single_precision = false;  ///< coordinates are floats, for formats that hold no others
  bool normals = true;            ///< fill Tessellation::normals
  bool corners = false;           ///< fill Tessellation::corners
  /// Most triangles before refinement gives up, however many max_triangles allows; see Tessellation::reached.
  /// Memory: 300 bytes each.
  std::uint64_t budget = 5'000'000;
  int threads = 0;  ///< 0: all cores
};

/// Triangles near a limit surface, as doubles in mesh units.
struct Tessellation {
  std::vector<Point3> positions;
  /// Limit normals of length 1, 0 0 0 where there is none; at creases that of one of the faces there.
  std::vector<Vector3> normals;
  std::vector<SurfaceParameter> parameters;  ///< whose limit points the positions are
  double position_error = 0;                 ///< upper bound, per coordinate, of |position - limit point|
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< oriented as the faces
  std::vector<std::uint32_t> owners;  ///< of each triangle the face; in a dual scheme, the vertex
  /// Of each triangle the parameters of its corners on its own face (vertex), whatever `parameters` has: all with
  /// the same `corner`. Between them parameters are linear.
  std::vector<std::array<SurfaceParameter, 3>> corners;
  double error_bound = 0;  ///< proved, see tessellate()
  bool reached = true;     ///< false if the budget, or max_triangles, ended refinement before
};

/// Triangles that approximate the whole limit surface without cracks: adaptive, each edge split as its own bend
/// needs, and cut where a neighbour is.
///
/// Guarantee: over every triangle the limit surface at each parameter is at most error_bound from the triangle at
///            the same parameter (between the corners linear), for the doubles given. The triangles cover all
///            parameters of all patches. So neither the surface nor the triangles have a point farther than that
///            from the other, face by face, and boundaries and creases are as near to the edges along them.
///            error_bound <= tolerance if `reached`, and each triangle's own error is as small as `view` asks. An
///            edge belongs to as many triangles as the surface has sheets there: two inside, one at the boundary;
///            no vertex lies inside an edge, and two triangles have at most an edge in common. Results do not
///            depend on threads.
/// Holes, and faces without a surface, are left out. Triangles without area are kept: where control vertices
/// coincide, leaving them out would open the surface.
/// Errors:    InputError: (value) for options that are not finite and positive, without any, for a tolerance too
///            small for the arithmetic (it names the smallest that is taken) and for fewer max_triangles than the
///            patches need (it names the number, if the budget allows it); (unrepresentable) if a coordinate does not fit. Interrupted.
/// Cost:      0.5 to 2 microseconds a triangle on one core, most where patches are irregular; with max_triangles
///            some ten times that. 300 bytes a triangle.
/// Source:    derivations/tessellation.md.
[[nodiscard]] SNUG_API Tessellation tessellate(const Surface& surface, const TessellateOptions& options,
                                               const WorkMonitor& monitor = {});

}  // namespace snug
