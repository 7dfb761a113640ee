#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/bound.h>

namespace snug {

/// The points origin + t direction with from <= t <= to: a ray, or a segment. `from` may be negative.
struct Ray {
  Point3 origin;
  Vector3 direction;  ///< of any length but 0; t is in units of its length
  double from = 0;
  double to = std::numeric_limits<double>::infinity();
};

/// Which hits to find.
enum class RayQuery : std::uint8_t {
  nearest,  ///< the first one
  any,      ///< any one: is the ray blocked?
  all,
};

struct RayOptions {
  RayQuery query = RayQuery::nearest;
  /// Intended length of the interval of a hit, in mesh units; default: 1e-6 of the surface's size. With `any` the
  /// first hit that is proved is the answer, however wide.
  std::optional<double> precision{};
  std::uint64_t budget = 20'000;  ///< most splits for each ray; memory: 200 bytes each
};

/// A place where a ray meets a limit surface, or may do so.
struct RayHit {
  Interval t;
  /// True if it is proved that the ray meets the surface within `t`. Else it may meet the surface there: it is
  /// tangent, passes through the border of an open surface, or begins or ends there, or is too close to one of
  /// these cases to tell.
  bool certified = false;
  /// Is `t`, as a length, at most the precision? False where rounding, a glancing ray, hits that cannot be told
  /// apart or the budget leave it wider, and where `any` asks for no more.
  bool reached = false;
  /// +1 where the ray leaves the surface on the side of its normal, -1 on the other side; 0 where that is not known,
  /// and where hits of both directions cannot be told apart.
  int side = 0;
  Point3 point;            ///< in the middle of `t`
  double point_error = 0;  ///< upper bound, per coordinate, of |point - p| for the ray's points p in `t`
  SurfaceParameter at;     ///< close to the parameters of the hit; no bound is proved
  std::optional<Vector3> normal;  ///< of the surface at `at`, of length 1; empty where there is none
};

/// The hits of one ray, sorted by the lower ends of t. Uncertified intervals may begin before `from` and end behind `to`.
struct RayHits {
  /// With RayQuery::nearest the last one is certified, if any is; those before it may be hits. With `any`: one
  /// certified hit, or else all hits that are not certified.
  std::vector<RayHit> hits;
  /// False if the budget ran out first: then there may be other hits, too.
  bool complete = true;

  /// Is it proved that there is a hit, or that there is none? Both are false where neither is proved.
  [[nodiscard]] bool certain_hit() const { return !hits.empty() && hits.back().certified; }
  [[nodiscard]] bool certain_miss() const { return hits.empty() && complete; }
};

/// Where a ray meets the limit surface itself, rather than triangles near it.
///
/// Guarantee: if `complete`, every hit on [from, to] that the query asks for lies in the `t` of one of the
///            answers; in particular no ray slips through between faces. The interval of a certified answer
///            contains a hit. With `all`, certified answers of a surface have as many signs as the ray crosses
///            it, except for even numbers of crossings that are too close to each other to be told apart.
/// Errors:    InputError: (value) for a number that is not finite where it must be, a direction of length 0,
///            from > to, a precision that is negative or not finite; (refused) if no face of the mesh has a
///            limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      some microseconds; ten times that where a ray is aimed at an edge or a vertex
///            (bench/results/rays.txt).
/// Source:    derivations/rays.md.
[[nodiscard]] SNUG_API RayHits trace(const Surface& surface, const Ray& ray, const RayOptions& options = {},
                                     const WorkMonitor& monitor = {},
                                     Workspace& workspace = Workspace::of_this_thread());
/// The same for many rays, in the same order. Faster if consecutive rays are close to each other.
[[nodiscard]] SNUG_API std::vector<RayHits> trace(const Surface& surface, std::span<const Ray> rays,
                                                  const RayOptions& options = {}, int threads = 0,
                                                  const WorkMonitor& monitor = {});

/// A hit of a ray without proof, for pictures.
struct QuickHit {
  double t = std::numeric_limits<double>::infinity();  ///< infinite: nothing
  SurfaceParameter at;
  PatchPlace patch;    ///< that `at` lies on
  unsigned level = 0;  ///< number of splits of the piece that was hit
  Vector3 normal;      ///< approximate, of length 1 or 0
};

/// A surface prepared for many rays that need no proof, such as for pictures and picking.
///
/// Guarantee: a hit is within the tolerance of a point of the surface, or within 2^-14 of the surface's size if
///            that is more, since coordinates are stored in 16 bits. It is not proved that the hit is the first
///            one, or that none is missed; trace() proves that.
class SNUG_API RayCaster {
 public:
  /// `tolerance`: in mesh units, such as the size of a pixel there.
  /// Errors:    InputError: (value) for a tolerance that is not finite and positive; (refused) if no face of the
  ///            mesh has a limit surface. Interrupted.
  /// Cost:      a microsecond per patch, more if the tolerance is small; 100 bytes per piece.
  RayCaster(const Surface& surface, double tolerance, int threads = 0, const WorkMonitor& monitor = {});

  /// The first hit, in half a microsecond. Errors: those of trace() on rays.
  [[nodiscard]] QuickHit cast(const Ray& ray) const;
  /// The same for many rays, in the same order; hits do not depend on threads.
  void cast(std::span<const Ray> rays, std::span<QuickHit> out, int threads = 0) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  std::shared_ptr<const class CasterTree> tree_;
  Surface surface_;
};

}  // namespace snug
