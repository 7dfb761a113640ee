#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/surface.h>

namespace snug {

/// The points origin + t direction with from <= t <= to: a ray, or a segment.
struct Ray {
  Point3 origin;
  Vector3 direction;  ///< of any length but 0; t counts in its lengths
  double from = 0;
  double to = std::numeric_limits<double>::infinity();
};

/// Which hits are looked for.
enum class RayQuery : std::uint8_t {
  nearest,  ///< the first one
  any,      ///< some one: is anything in the way?
  all,
};

struct RayOptions {
  RayQuery query = RayQuery::nearest;
  /// Aimed-at length of a hit's interval, in mesh units; default: 1e-6 of the surface's size.
  std::optional<double> precision{};
  std::uint64_t budget = 20'000;  ///< most splits for each ray
};

/// A place where a ray meets a limit surface, or may do so.
struct RayHit {
  Interval t;
  /// Is it proved that the ray meets the surface within `t`? Else it may touch it there: it is tangent, passes
  /// the border of an open surface, or begins or ends, as nearly as can be told.
  bool certified = false;
  /// +1 where the ray passes to the side that the normal shows, -1 against it; 0 where that is not known, and where
  /// hits of both sorts cannot be told apart.
  int side = 0;
  Point3 point;            ///< in the middle of `t`
  double point_error = 0;  ///< upper bound, per coordinate, of |point - p| for the ray's points p in `t`
  SurfaceParameter at;     ///< close to where it is on the surface; no bound is proved
  std::optional<Vector3> normal;  ///< of the surface at `at`, of length 1; empty where there is none
};

/// The hits of one ray, by t.
struct RayHits {
  /// With RayQuery::nearest the last one is certified, if any is: those before it may be hits. With `any`, one
  /// that is certified, or all that are not.
  std::vector<RayHit> hits;
  /// False where the budget ended first: then there may be hits elsewhere, too.
  bool complete = true;

  /// Is it proved that there is a hit; that there is none? Neither where it cannot be told.
  [[nodiscard]] bool certain_hit() const { return !hits.empty() && hits.back().certified; }
  [[nodiscard]] bool certain_miss() const { return hits.empty() && complete; }
};

/// Where a ray meets a limit surface: the surface itself, not triangles near it.
///
/// Guarantee: if `complete`, every hit on [from, to] that the query is about lies in the `t` of one of the
///            answers; in particular nothing slips through between faces. In the interval of a certified
///            answer there is a hit. With `all`, certified answers of a surface have as many signs as the ray
///            crosses it, but for even numbers of crossings nearer to each other than they can be told apart.
///            The result depends on the input alone.
/// Errors:    InputError: (value) for a number that is not finite where it must be, a direction of length 0,
///            from > to, a precision that is negative or not finite; (refused) if no face of the mesh has a
///            limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      some microseconds; ten times that where a ray is aimed at an edge or a vertex
///            (bench/results/rays.txt).
/// Source:    derivations/rays.md.
[[nodiscard]] SNUG_API RayHits trace(const Surface& surface, const Ray& ray, const RayOptions& options = {},
                                     const WorkMonitor& monitor = {},
                                     Workspace& workspace = Workspace::of_this_thread());
/// The same for many rays, in the same order; results do not depend on threads. Faster where rays that follow
/// one another are close.
[[nodiscard]] SNUG_API std::vector<RayHits> trace(const Surface& surface, std::span<const Ray> rays,
                                                  const RayOptions& options = {}, int threads = 0,
                                                  const WorkMonitor& monitor = {});

/// What a ray of a picture hits.
struct QuickHit {
  double t = std::numeric_limits<double>::infinity();  ///< infinite: nothing
  SurfaceParameter at;
  Vector3 normal;  ///< roughly, of length 1 or 0
};

/// A surface made ready for many rays that need no proof: pictures and picking.
///
/// Guarantee: a hit is within the tolerance of a point of the surface, or 2^-14 of the surface's size if that is
///            more: places are kept in 16 bits. That it is the first one, and that none is
///            missed, is not proved; trace() does that.
class SNUG_API RayCaster {
 public:
  /// `tolerance`: in mesh units, such as the size of a pixel there.
  /// Errors:    InputError: (value) for a tolerance that is not finite and positive; (refused) if no face of the
  ///            mesh has a limit surface. Interrupted.
  /// Cost:      a microsecond a patch, more where the tolerance is small; 100 bytes a piece.
  RayCaster(const Surface& surface, double tolerance, int threads = 0, const WorkMonitor& monitor = {});

  /// The first hit.
  /// Errors:    those of trace() on rays.
  /// Cost:      half a microsecond.
  [[nodiscard]] QuickHit cast(const Ray& ray) const;
  /// The same for many rays, in the same order.
  void cast(std::span<const Ray> rays, std::span<QuickHit> out, int threads = 0) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  std::shared_ptr<const class CasterTree> tree_;
  Surface surface_;
};

}  // namespace snug
