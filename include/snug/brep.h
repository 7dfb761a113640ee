#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/geometry.h>

namespace snug {

class Surface;

/// A B-spline curve: points.size() + degree + 1 knots in rising order, of which the first and the last degree + 1 are equal.
struct SplineCurve {
  unsigned degree = 0;
  std::vector<double> knots;
  std::vector<Point3> points;
};

/// A tensor-product B-spline surface of the same degree in u and v, knots likewise. Point (i, j) stands at i + columns() j.
struct SplineSurface {
  unsigned degree = 0;
  std::vector<double> u_knots, v_knots;
  std::vector<Point3> points;
  [[nodiscard]] std::size_t columns() const { return u_knots.size() - degree - 1; }
  [[nodiscard]] std::size_t rows() const { return v_knots.size() - degree - 1; }
};

/// Faces that share edges: a limit surface as B-spline surfaces, as CAD programs have them.
struct Brep {
  struct Edge {
    std::array<std::uint32_t, 2> vertices;  ///< where the curve begins and ends
    SplineCurve curve;
  };
  struct Side {
    std::uint32_t edge;
    bool reversed;  ///< runs against the curve
  };
  struct Face {
    SplineSurface surface;
    std::vector<Side> loop;  ///< all of its border, counter-clockwise seen from outside
    std::uint32_t owner;     ///< a face of the mesh that it lies over; in a dual scheme, a vertex
    double error_bound;      ///< proved: at every parameter, largest distance from the limit point there

    /// Has it three sides? It is then the half u >= v of a unit square of its surface's parameters, and the diagonal is its
    /// third side. Beyond it the surface goes on without a meaning.
    [[nodiscard]] bool triangle() const { return loop.size() == 3; }
  };
  /// Faces that edges join: faces[begin] to faces[end - 1].
  struct Shell {
    std::uint32_t begin, end;
    bool closed;
    std::optional<std::uint32_t> void_of{};  ///< of a void: the outer shell of the solid that it lies in
  };

  std::vector<Point3> vertices;
  std::vector<Edge> edges;
  std::vector<Face> faces;
  std::vector<Shell> shells;
  double error_bound = 0;  ///< proved: the largest one of the faces
  double gap_bound = 0;    ///< proved: largest distance of a face's border from the curves and vertices on it
  double break_angle =
      0;  ///< degrees: largest angle between faces measured across edges where the surface is smooth
  std::size_t spans = 0;                ///< polynomial pieces in all faces
  Outcome outcome = Outcome::complete;  ///< are error_bound and break_angle as small as requested?
};

struct BrepOptions {
  /// > 0, mesh units: largest distance of faces from the limit surface. Default: 0.01 % of its size.
  std::optional<double> error{};
  /// In (0, 90], degrees: largest angle of faces across smooth edges.
  std::optional<double> max_angle{};
};

/// A limit surface as B-spline faces: of schemes of quads exact, up to rounding, wherever it is polynomial; beside extraordinary
/// vertices and semi-sharp creases, and of Loop everywhere, approximated with as many spans as the error takes. Regular faces that
/// form a rectangle become one. Of Loop most faces are over two triangles; facets stay apart, as planes.
///
/// Guarantee: error_bound and gap_bound are proved for the doubles returned, whatever the outcome. Faces share their edges: an
///            edge belongs to two faces, on a border to one.
/// Not proved: break_angle, and which closed shells are voids (at most 2,000 shells are compared).
/// Budget:    10,000,000 spans; a kilobyte each. Of Loop 40,000 over two triangles.
/// Errors:    InputError: (value) for an error that is not finite and positive or too small for doubles, for an angle out of
///            range, and for a budget below one span a face; (refused) for Midedge, for an edge with more than two faces or with two that run along it in the same direction, and for a face that is its own neighbour;
///            (unrepresentable). Interrupted.
/// Cost:      10 microseconds a regular face, 200 beside an extraordinary vertex, up to 20 milliseconds beside creases of high
///            sharpness.
/// Source:    docs/derivations/brep.md.
[[nodiscard]] SNUG_API Brep to_brep(const Surface& surface, const BrepOptions& options = {},
                                    const Run& run = {});

/// Lengths of a STEP file.
enum class LengthUnit : std::uint8_t { millimetre, centimetre, metre, inch, foot, micron };

struct StepOptions {
  std::string name = "part";  ///< of the product
  LengthUnit unit = LengthUnit::millimetre;
  bool ap214 = false;  ///< an older protocol than AP242, for readers that know no other
};

/// A part as STEP text (ISO 10303-21): a solid for each closed shell that is not a void, a surface model for each open one.
/// Guarantee: coordinates are read back as the same doubles.
/// Errors:    Interrupted.
[[nodiscard]] SNUG_API std::string format_step(const Brep& brep, const StepOptions& options = {},
                                               const Run& run = {});
/// The same to a file, completely or not at all. Returns its bytes. Errors: InputError (unreadable). Interrupted.
SNUG_API std::size_t write_step(const Brep& brep, const std::string& path, const StepOptions& options = {},
                                const Run& run = {});

/// A shape of an assembly: a product of its own, with this name.
struct StepShape {
  std::string name;
  Brep brep;
};
/// An occurrence of a shape in an assembly.
struct StepPart {
  std::string name;
  std::uint32_t shape = 0;  ///< which of the shapes
  Motion pose;              ///< in the shape's units
};
/// An assembly as STEP text: a product named options.name, in which each part is a placed shape.
/// Guarantee: translations are read back as the same doubles; rotations are written as two directions, which readers make
///            orthogonal.
/// Errors:    InputError (value) for a part whose shape does not exist. Interrupted.
[[nodiscard]] SNUG_API std::string format_step(std::span<const StepShape> shapes,
                                               std::span<const StepPart> parts,
                                               const StepOptions& options = {}, const Run& run = {});

}  // namespace snug
