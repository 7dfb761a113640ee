#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// A limit point in mesh units with its tangents and normal; `at` is the place asked for.
struct SurfacePoint : LimitPoint {
  /// Derivatives in u and v where they exist, else two limit tangents of no particular length.
  std::array<Vector3, 2> tangents;
  bool differentiable;
  std::optional<Vector3> normal;  ///< of length 1; empty where there is none
  /// Upper bound of |normal - exact normal|, where one is proved.
  std::optional<double> normal_error;
};

/// The limit point at these parameters, with derivatives in u and v.
///
/// Guarantee: `error` and `normal_error` are upper bounds. Tangents are in double precision, without a bound.
/// Errors:    InputError: (value) if the surface has no such owner, corner or parameter, NaN included;
///            (unrepresentable) if a coordinate does not fit a double.
/// Cost:      half a microsecond; about 2 near extraordinary corners.
[[nodiscard]] SNUG_API SurfacePoint evaluate(const Surface& surface, const Place& at);
/// The same for many points, in the same order.
/// Cost:      0.1 to 0.3 microseconds a point where a face has many, in any order.
[[nodiscard]] SNUG_API std::vector<SurfacePoint> evaluate(const Surface& surface, std::span<const Place> at,
                                                          const Run& run = {});

/// Where evaluate() writes in single precision: three floats x, y, z a point.
struct FloatPoints {
  std::span<float> positions;
  std::span<float> normals{};  ///< of length 1, 0 0 0 where there is none; an empty span: they are not wanted
};
/// The same points in single precision, without allocations where the points of a face come together.
///
/// Returns:   an upper bound of the errors of all coordinates of positions, rounding to float included.
/// Guarantee: a normal is that of the double-precision answer, and at most 2^-24 farther from the exact one.
/// Errors:    likewise; (value) unless `out` has room for three floats a point; (unrepresentable) also if a
///            coordinate does not fit a float. `out` is partly written then.
/// Cost:      positions 30 ns a point where a face has many, with normals 100 ns.
SNUG_API double evaluate(const Surface& surface, std::span<const Place> at, const FloatPoints& out,
                         const Run& run = {});

/// A unit normal and its error.
struct SurfaceNormal {
  Vector3 direction;
  std::optional<double> error;  ///< upper bound of |direction - exact normal|, where one is proved
};
/// The normal of a placed surface at exactly these parameters; empty where there is none.
/// Errors, Cost: those of evaluate().
[[nodiscard]] SNUG_API std::optional<SurfaceNormal> normal_at(const PlacedSurface& surface, const Place& at);

/// How far the limit surface may be from the faces of its control mesh, in mesh units.
///
/// Guarantee: every limit point of a face is at most this far from the convex hull of the face's corners,
///            rounding included. 0 if every face with a surface has only infinitely sharp edges and corners, see
///            sharpen(). Empty with a dual scheme, whose patches do not belong to faces.
/// Tightness: 1.02 to 1.43 times the largest distance sampled on seven models.
/// Errors:    InputError (unrepresentable) if a result does not fit a double.
/// Cost:      1 microsecond a patch.
/// Source:    derivations/sharp_parts.md.
[[nodiscard]] SNUG_API std::optional<double> limit_to_faces(const Surface& surface, const Run& run = {});

/// A control mesh after `level` steps of subdivision, with the scheme and the boundary rule that a Surface with these
/// options has; other options have no effect. With `limit` the limit positions of its vertices, in double precision. Also of
/// meshes that have no limit surface.
///
/// With `limit`, faces without a limit surface are left out, and so are vertices that only they use. In a dual
/// scheme the limit position of a vertex is the middle of its patch.
///
/// Guarantee: positions are within a few units in the last place of the largest coordinate, per level. The
///            sharpness of tags is reduced by the number of steps.
/// Errors:    InputError: (refused) for a mesh that these rules cannot subdivide, and for a result of more than 2^31 faces;
///            (unrepresentable) if a coordinate does not fit a double. Interrupted.
/// Cost:      linear in the result.
[[nodiscard]] SNUG_API ControlMesh subdivided(ControlMesh mesh, unsigned level, bool limit = false,
                                              const SurfaceOptions& options = {}, const Run& run = {});

}  // namespace snug
