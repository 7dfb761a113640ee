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
  BoundMethod method = BoundMethod::rows;
  /// Split until each radius is at most half of this, in mesh units.
  std::optional<double> tolerance{};
  /// Without a tolerance: split every patch this often; the first split of a polygon that is no patch counts.
  unsigned level = 0;
  std::uint64_t budget = 10'000'000;  ///< most splits in all; spent patch by patch
  int threads = 0;
};

/// A patch of a surface. Loop: one a face, part 0. Catmull-Clark: two halves of a quad with corners c0 to c3, part 0 from c0 by c1
/// to c2 and part 1 from c2 by c3 to c0; of another face with n corners 2 n after its first split, parts 2 k and 2 k + 1 at
/// corner k. Dual schemes likewise, with the faces around a vertex as corners.
struct PatchPlace {
  std::uint32_t owner = 0;  ///< face, or vertex of a dual scheme
  std::uint32_t part = 0;
};

/// What encloses one piece of a limit surface, in mesh units.
struct PatchEnclosure {
  PatchPlace patch;
  /// Which piece of its patch: a digit a level, 0 to 2 the quarter at that corner, 3 the middle one; empty: all of it.
  std::string piece;
  unsigned level = 0;         ///< splits that made it; the first split of a face into quads counts
  Triangle corners;           ///< limit corners, in double precision
  OffsetTriangle offset;      ///< contains the piece
  IntervalTriangle interval;  ///< contains it, too
};

struct BoundSummary {
  std::uint64_t count = 0;
  double max_radius = 0;
  std::uint64_t splits = 0;
  /// Every piece meets the tolerance; else budget, levels or rounding stood in the way.
  bool reached = true;
};

/// Enclosures of the whole limit surface, passed to `sink` patch by patch.
///
/// Guarantee: every limit point of a patch lies in the union of its pieces' offset triangles, and of their interval triangles,
///            rounding included; also where `reached` is false. Same output for any number of threads.
/// Errors:    InputError: (value) for a tolerance that is not finite and positive or a level above 60, (unrepresentable) if a
///            result does not fit a double; whatever `sink` throws. Interrupted.
/// Cost:      a piece 3 to 5 microseconds on regular patches. Memory does not grow with the output.
SNUG_API BoundSummary bound(const Surface& surface, const BoundOptions& options,
                            const std::function<void(const PatchEnclosure&)>& sink,
                            const WorkMonitor& monitor = {});

/// Offset triangles of the whole patches of a surface, again and again while its control points move and its connectivity
/// stays: for animation, and the fastest way to bound a large mesh once.
///
/// Cost:      see bench/results/rows.txt. Memory: 4 bytes a control point and patch, 24 a vertex.
class SNUG_API PatchBounds {
 public:
  /// Works out what connectivity decides. Takes the surface's BoundMethod.
  explicit PatchBounds(const Surface& surface, int threads = 0);
  ~PatchBounds();
  PatchBounds(PatchBounds&&) noexcept;
  PatchBounds& operator=(PatchBounds&&) noexcept;

  /// The patches that update() answers for, in this order: all that the surface has.
  [[nodiscard]] std::span<const PatchPlace> patches() const;

  /// Bounds of all patches for these control points, in mesh units.
  ///
  /// Guarantee: every limit point of a patch is within its radius of its base, rounding included; results do not depend on
  ///            threads. One thread allocates nothing after its first call.
  /// Errors:    InputError: (value) unless there is a point for each vertex of the mesh and out.size() == patches().size();
  ///            (refused) if a point that a face uses is not finite, or a result no double. Then `out` is in no particular
  ///            state.
  void update(std::span<const Point3> points, std::span<OffsetTriangle> out, int threads = 1);

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace snug
