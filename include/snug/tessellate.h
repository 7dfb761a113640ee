#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// Eye point, and the largest visible error as an angle.
struct Viewpoint {
  Point3 eye;
  double angle = 0;  ///< degrees: largest angle that an error may subtend, such as a pixel's
};

struct TessellateOptions {
  /// Largest distance, in mesh units, between the limit surface and the triangles, either way.
  std::optional<double> error{};
  std::optional<double> max_edge{};  ///< longest edge, in mesh units
  /// Largest angle between limit normals at the corners of a triangle, in degrees: in double precision, and only
  /// for triangles with a side longer than `error` (without one, a millionth of the size).
  std::optional<double> max_angle{};
  /// A triangle at distance d from the eye may have an error of d sin(angle).
  std::optional<Viewpoint> view{};
  /// Largest thickness of a piece, in mesh units: the longest side of its interval triangle's boxes [Wu05, sec. 5.3].
  std::optional<double> max_thickness{};
  /// Most triangles: finds the smallest error it can with that many, but not below `error`, if given.
  std::optional<std::uint64_t> max_triangles{};
  bool single_precision = false;  ///< round coordinates to floats, for formats that store floats
  bool normals = true;            ///< fill Tessellation::normals
  bool corners = false;           ///< fill Tessellation::corners
};

/// Triangles near a limit surface, as doubles in mesh units.
struct Tessellation {
  std::vector<Point3> positions;
  /// Unit limit normals, 0 0 0 where there is none; at a crease, that of one of the faces there.
  std::vector<Vector3> normals;
  std::vector<Place> parameters;  ///< positions are the limit points at these
  double position_error = 0;      ///< upper bound, per coordinate, of |position - limit point|
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< oriented as the faces
  std::vector<std::uint32_t> owners;  ///< the face of each triangle; in a dual scheme, the vertex
  /// For each triangle, the parameters of its corners on its own face (vertex), whatever `parameters` holds; all
  /// have the same `corner`. Between them parameters are linear.
  std::vector<std::array<Place, 3>> corners;
  double error_bound = 0;               ///< proved, see tessellate()
  Outcome outcome = Outcome::complete;  ///< `budget_spent` also if max_triangles ended refinement early
};

/// Adaptive triangles that approximate the whole limit surface without cracks: each edge is split as its own
/// curvature requires, and cut where its neighbour is.
///
/// Guarantee: over every triangle the limit surface at each parameter is at most error_bound from the triangle at
///            the same parameter (linear between the corners), for the returned doubles. The triangles cover all
///            parameters of all patches. So, face by face, surface and triangles are nowhere farther than that
///            from each other, nor are boundaries and creases and the edges along them. If `complete`,
///            error_bound <= error, and each triangle's own error is as small as `view` requires. An edge
///            belongs to as many triangles as the surface has sheets there, and no vertex lies inside an edge.
/// Holes and faces without a surface are omitted. Triangles without area are kept: where control vertices
/// coincide, omitting them would open the surface.
/// Budget:    5,000,000 triangles, even if max_triangles allows more; 200 bytes each.
/// Errors:    InputError: (value) for options that are not finite and positive, if none is given, for an error
///            below the precision of doubles (names the smallest allowed), and for fewer max_triangles than the
///            patches need (names the number, if the budget allows it); (unrepresentable) if a coordinate does not fit. Interrupted.
/// Cost:      0.5 to 2 microseconds a triangle on one core, most for irregular patches; with max_triangles about
///            ten times that. 200 bytes a triangle.
/// Source:    derivations/tessellation.md.
[[nodiscard]] SNUG_API Tessellation tessellate(const Surface& surface, const TessellateOptions& options,
                                               const Run& run = {});

}  // namespace snug
