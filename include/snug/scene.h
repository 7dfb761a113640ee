#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <snug/collide.h>
#include <snug/distance.h>

namespace snug {

/// Two parts of a scene, by their places in it; never a part with itself.
struct PartPair {
  std::uint32_t a = 0, b = 0;
  [[gnu::always_inline]] friend bool operator==(const PartPair&, const PartPair&) = default;
};

/// A margin for two parts, in place of CollideOptions::margin.
struct PairMargin {
  PartPair parts;     ///< in either order
  double margin = 0;  ///< >= 0, mesh units
};

/// Parts, and which of them are asked about. Parts that share a Surface share its preparation: 120 bytes a part.
struct Scene {
  std::vector<PlacedSurface> parts;
  std::optional<std::vector<PartPair>>
      pairs{};                        ///< default: every two parts, a < b, in the order of their places
  std::vector<PairMargin> margins{};  ///< at most one for any two parts
};

/// A pair of a scene.
struct ScenePair {
  PartPair parts;
  double margin = 0;
  /// Lower bound of the distance, by boxes around both parts.
  double gap = 0;
  [[nodiscard]] bool separated_by_boxes() const { return gap > margin; }
};

/// The broad phase: which pairs of a scene may be within their margins of each other? Deals out these pairs some at a time, in
/// the order of Scene::pairs.
///
/// Guarantee: a pair that is not dealt out is farther apart than its margin, in exact arithmetic for the given doubles, and so
///            are the solids that closed parts bound. Which ones are dealt out does not depend on threads.
/// Errors:    InputError: (value) naming the pair or margin for places beyond the parts, a part with itself, a second margin
///            for a pair, a margin that is negative or not finite; (refused) naming the part if no face of a mesh has a limit
///            surface. Interrupted.
/// Cost:      to make: the preparation of surfaces that have not been asked about, and one to four microseconds and 200 bytes a
///            part; then some hundred nanoseconds a part and a pair dealt out, on all threads (bench/results/scenes.txt).
class SNUG_API SceneBroadPhase {
 public:
  /// `margin`: of pairs that Scene::margins does not name; `all`: pairs separated by their boxes are dealt out too.
  /// Requires:  the scene outlives it and does not change.
  explicit SceneBroadPhase(const Scene& scene, double margin = 0, bool all = false, int threads = 0,
                           const WorkMonitor& monitor = {});
  ~SceneBroadPhase();
  SceneBroadPhase(const SceneBroadPhase&) = delete;
  SceneBroadPhase& operator=(const SceneBroadPhase&) = delete;

  /// At least `count` further pairs; fewer only at the end. One part's pairs come together, so there may be more.
  [[nodiscard]] std::vector<ScenePair> next(std::size_t count);
  /// How many pairs the scene asks about.
  [[nodiscard]] std::uint64_t pair_count() const;
  /// How much has been dealt out, in [0, 1].
  [[nodiscard]] double share() const;
  /// A box around a placed part; infinite where doubles do not reach.
  [[nodiscard]] const Box3& box(std::uint32_t part) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What became of the pairs of a scene.
struct SceneCounts {
  std::uint64_t pairs = 0;               ///< all that were asked about
  std::uint64_t separated_by_boxes = 0;  ///< proved by the broad phase alone, and not passed on
  /// Of those passed on, by verdict; distance() counts pairs beyond the limit, which it does not pass on, as separated, and
  /// proved contact as intersecting.
  std::uint64_t separated = 0, within = 0, intersecting = 0, undecided = 0;
};

struct PairCollision {
  PartPair parts;
  Collision answer;
};

/// Which parts of a scene touch?
///
/// Passes the pairs that boxes do not separate to `sink`, in the order of Scene::pairs, each as soon as all before it are
/// answered; on one thread at a time.
///
/// Guarantee: each answer has the same bits as collide() of the two parts; the same for any number of threads (0: all cores).
/// Errors:    those of SceneBroadPhase and collide(), which name the parts, and what `sink` throws. Pairs passed on before that
///            stand.
/// Cost:      SceneBroadPhase, and that of collide() a pair. Memory does not grow with the number of pairs, but with that of
///            one part.
SNUG_API SceneCounts collide(const Scene& scene, const CollideOptions& options,
                             const std::function<void(const PairCollision&)>& sink, int threads = 0,
                             const WorkMonitor& monitor = {});

struct PairDistance {
  PartPair parts;
  Distance answer;
};

/// All clearances of a scene up to `limit`: pairs that are not proved farther apart, as above. Scene::margins do not count.
///
/// Guarantee: each answer has the same bits as distance() of the two parts.
/// Errors:    those of SceneBroadPhase and distance(); InputError (value) for a limit that is negative or not finite.
SNUG_API SceneCounts distance(const Scene& scene, double limit, const DistanceOptions& options,
                              const std::function<void(const PairDistance&)>& sink, int threads = 0,
                              const WorkMonitor& monitor = {});

}  // namespace snug
