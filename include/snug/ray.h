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
  std::optional<double> absolute{};
};

/// A place where a ray meets a limit surface, or may do so. `point` is in the middle of `t`, and `error` bounds, per coordinate, its
/// distance from the ray's points in `t`. `at` is close to the parameters of the hit; no bound is proved.
struct RayHit : LimitPoint {
  Interval t{};
  /// True if it is proved that the ray meets the surface within `t`. Else it may meet the surface there: it is
  /// tangent, passes through the border of an open surface, or begins or ends there, or is too close to one of
  /// these cases to tell.
  bool certified = false;
  /// +1 where the ray leaves the surface on the side of its normal, -1 on the other side; 0 where that is not known,
  /// and where hits of both directions cannot be told apart.
  int side = 0;
  std::optional<Vector3> normal{};  ///< of the surface at `at`, of length 1; empty where there is none
};

/// The hits of one ray, sorted by the lower ends of t. Uncertified intervals may begin before `from` and end behind `to`.
struct RayHits {
  /// With RayQuery::nearest the last one is certified, if any is; those before it may be hits. With `any`: one
  /// certified hit, or else all hits that are not certified.
  std::vector<RayHit> hits;
  /// `budget_spent`: there may be other hits, too. `at_rounding`: the `t` of a certified hit stays wider than requested, where a
  /// ray glances or hits cannot be told apart; not with `any`.
  Outcome outcome = Outcome::complete;

  /// Is it proved that there is a hit, or that there is none? Both are false where neither is proved.
  [[nodiscard]] bool certain_hit() const { return !hits.empty() && hits.back().certified; }
  [[nodiscard]] bool certain_miss() const { return hits.empty() && outcome != Outcome::budget_spent; }
};

/// Where a ray meets the limit surface itself, rather than triangles near it.
///
/// Guarantee: unless `budget_spent`, every hit on [from, to] that the query asks for lies in the `t` of one of the
///            answers; in particular no ray slips through between faces. The interval of a certified answer
///            contains a hit. With `all`, certified answers of a surface have as many signs as the ray crosses
///            it, except for even numbers of crossings that are too close to each other to be told apart.
/// Budget:    20,000 splits for each ray; 200 bytes each.
/// Errors:    InputError: (value) for a number that is not finite where it must be, a direction of length 0,
///            from > to, a precision that is negative or not finite; (refused) if no face of the mesh has a
///            limit surface; (unrepresentable) for a result that does not fit a double. Interrupted.
/// Cost:      some microseconds; ten times that where a ray is aimed at an edge or a vertex (bench/results/rays.txt).
/// Source:    derivations/rays.md.
[[nodiscard]] SNUG_API RayHits ray(const Surface& surface, const Ray& ray, const RayOptions& options = {},
                                   const Run& run = {});
/// The same for many rays, in the same order. Faster if consecutive rays are close to each other.
[[nodiscard]] SNUG_API std::vector<RayHits> ray(const Surface& surface, std::span<const Ray> rays,
                                                const RayOptions& options = {}, const Run& run = {});

/// A hit of a ray without proof, for pictures.
struct QuickHit {
  double t = std::numeric_limits<double>::infinity();  ///< infinite: nothing
  Place at;
  PatchPlace patch;    ///< that `at` lies on
  unsigned level = 0;  ///< number of splits of the piece that was hit
  Vector3 normal;      ///< approximate, of length 1 or 0
};

/// A surface prepared for many rays that need no proof, such as for pictures and picking.
///
/// Guarantee: a hit is within `error` of a point of the surface, or within 2^-14 of the surface's size if
///            that is more, since coordinates are stored in 16 bits. It is not proved that the hit is the first
///            one, or that none is missed; ray() proves that.
class SNUG_API RayCaster {
 public:
  /// `error`: in mesh units, such as the size of a pixel there.
  /// Errors:    InputError: (value) unless the error is finite and positive; (refused) if no face has a limit surface. Interrupted.
  /// Cost:      a microsecond per patch, more if the error is small; 100 bytes per piece.
  RayCaster(const Surface& surface, double error, const Run& run = {});

  /// The first hit, in half a microsecond. Errors: those of ray() on rays.
  [[nodiscard]] QuickHit cast(const Ray& ray) const;
  /// Is there a hit? Sooner than the first one is found: for shadows.
  [[nodiscard]] bool blocked(const Ray& ray) const;
  /// The same for many rays, in the same order; hits do not depend on threads.
  void cast(std::span<const Ray> rays, std::span<QuickHit> out, const Run& run = {}) const;

  [[nodiscard]] std::size_t bytes() const;

 private:
  std::shared_ptr<const class CasterTree> tree_;
  Surface surface_;
};

}  // namespace snug
