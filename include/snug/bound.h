#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <snug/surface.h>

namespace snug {

struct BoundOptions {
  /// Split until each radius is at most half of this, in mesh units: then no set is thicker than it.
  std::optional<double> error{};
  /// Without `error`: split every patch this many times. The first split of a face into quads counts.
  unsigned level = 0;
  bool normals = false;  ///< fill PatchEnclosure::normals
};

/// A patch of a surface; every patch is a triangle. Triangle schemes have one patch for each face, part 0. The
/// other schemes have two for each quad c0 c1 c2 c3: part 0 is c0 c1 c2, part 1 is c2 c3 c0. A face with n != 4
/// corners is first split into n quads; parts 2 k and 2 k + 1 belong to the quad at corner k. In a dual scheme
/// the same holds for a vertex, with the faces around it as corners.
struct PatchPlace {
  std::uint32_t owner = 0;  ///< face, or vertex of a dual scheme
  std::uint32_t part = 0;
};

/// All directions at an angle of at most `angle`, in radians and below pi/2, from `axis`.
struct NormalCone {
  Vector3 axis;  ///< of length 1 up to rounding
  double angle = 0;
};

/// Two sets that contain one piece of a limit surface, in mesh units.
struct PatchEnclosure {
  PatchPlace patch;
  /// Which piece of its patch, one digit for each split: 0 to 2 for the quarter at that corner, 3 for the
  /// middle one. Empty for the whole patch.
  std::string piece;
  unsigned level = 0;         ///< number of splits; the first split of a face into quads counts
  Triangle corners;           ///< limit corners, in double precision
  OffsetTriangle offset;      ///< contains the piece
  IntervalTriangle interval;  ///< contains the piece, too
  /// With BoundOptions::normals: contains all normals of the piece, on the side from which faces look
  /// counter-clockwise. Empty if no cone is proved: then the piece may have points without a normal.
  std::optional<NormalCone> normals{};
};

struct BoundSummary {
  std::uint64_t count = 0;
  double max_radius = 0;
  std::uint64_t splits = 0;
  Outcome outcome = Outcome::complete;  ///< `at_rounding` also at 60 levels
};

/// Enclosures of the whole limit surface, made by its SurfaceOptions::bounds and passed to `sink` patch by patch.
///
/// Guarantee: every limit point of a patch lies in the union of its pieces' offset triangles, and in the union
///            of their interval triangles, rounding included, whatever the outcome. At every point of a
///            piece with a cone the limit surface has a normal, and the cone contains it.
/// Budget:    1,000,000 splits in total, spent patch by patch; 2 kB each in the patches that are in work.
/// Errors:    InputError: (value) for an error that is not finite and positive or a level above 60,
///            (unrepresentable) if a result does not fit a double; whatever `sink` throws. Interrupted.
/// Cost:      3 to 5 microseconds per piece of a regular patch, twice that with normals; a tenth to half a
///            millisecond more beside extraordinary vertices. Memory does not grow with the number of patches.
SNUG_API BoundSummary bound(const Surface& surface, const BoundOptions& options,
                            const std::function<void(const PatchEnclosure&)>& sink, const Run& run = {});

/// Offset triangles of whole patches, updated as control points move while connectivity stays the same. Also the
/// fastest way to bound a large mesh once.
///
/// Cost:      see bench/results/refit.txt. Memory: 4 bytes for each control point of each patch, 24 per vertex.
class SNUG_API PatchBounds {
 public:
  /// Prepares everything that depends only on connectivity. Uses the surface's BoundMethod.
  explicit PatchBounds(const Surface& surface, const Run& run = {});
  ~PatchBounds();
  PatchBounds(PatchBounds&&) noexcept;
  PatchBounds& operator=(PatchBounds&&) noexcept;

  /// All patches of the surface, in the order of update()'s output.
  [[nodiscard]] std::span<const PatchPlace> patches() const;

  /// Bounds of all patches for these control points, in mesh units.
  ///
  /// Guarantee: every limit point of a patch is in its offset triangle, rounding included. With one thread only the
  ///            first call allocates memory.
  /// Errors:    InputError: (value) unless points.size() is the number of vertices of the mesh and
  ///            out.size() == patches().size(); (refused) if a point that a face uses is not finite or a
  ///            result does not fit a double, and the contents of `out` are then unspecified.
  void update(std::span<const Point3> points, std::span<OffsetTriangle> out, const Run& run = {.threads = 1});

  /// Boxes of all patches for motion blur: every limit point of a patch is in its box while the control points
  /// move along lines from `begin` to `end`, both ends and rounding included. Errors likewise.
  /// Cost:      that of two calls of the other update(). Memory: 96 bytes per patch from the first call on.
  /// Source:    docs/derivations/moving.md.
  void update(std::span<const Point3> begin, std::span<const Point3> end, std::span<Box3> out,
              const Run& run = {.threads = 1});

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace snug
