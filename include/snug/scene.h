#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <snug/distance.h>

namespace snug {

/// Two different parts of a scene, by their indices in Scene::parts.
struct PartPair {
  std::uint32_t a = 0, b = 0;
  [[gnu::always_inline]] friend bool operator==(const PartPair&, const PartPair&) = default;
};

/// A margin for two parts, in place of CollideOptions::margin.
struct PairMargin {
  PartPair parts;     ///< in either order
  double margin = 0;  ///< >= 0, mesh units
};

/// Parts, and the pairs of them to query. Parts that share a Surface share its preparation and take 120 bytes each.
struct Scene {
  std::vector<PlacedSurface> parts;
  std::optional<std::vector<PartPair>> pairs{};  ///< default: all, a < b, in the order of their indices
  std::vector<PairMargin> margins{};             ///< at most one for any two parts
};

/// A pair of a scene.
struct ScenePair {
  PartPair parts;
  double margin = 0;
  double gap = 0;  ///< lower bound of the distance, from boxes around both parts
  [[nodiscard]] bool separated_by_boxes() const { return gap > margin; }
};

/// Parts where they are placed, as the bytes of a 3MF file, which read_assembly() reads as the same parts, poses and doubles.
/// Notes, errors: as format_mesh(); InputError also for another extension (unreadable), meshes in different units (refused), and
///            a part whose mesh does not exist (value).
[[nodiscard]] SNUG_API std::string format_assembly(const MeshAssembly& assembly, const std::string& path,
                                                   const WriteOptions& options = {}, const Run& run = {});

/// The broad phase: the pairs of a scene that may be within their margins of each other, in the order of Scene::pairs.
///
/// Guarantee: a pair that is not returned is farther apart than its margin, in exact arithmetic, and so are the solids.
/// Errors:    InputError: (value) for an index that no part has, a part paired with itself, a second or a bad margin;
///            (refused) for a part without a limit surface; each is named. Interrupted.
/// Cost:      Surface::prepare(), some microseconds and 200 bytes per part; then less per pair (bench/results/scenes.txt).
class SNUG_API SceneBroadPhase {
 public:
  /// `margin`: for pairs that Scene::margins does not name; `all`: also return pairs that boxes separate.
  /// Requires:  the scene outlives this object and does not change.
  explicit SceneBroadPhase(const Scene& scene, double margin = 0, bool all = false, const Run& run = {});
  ~SceneBroadPhase();
  SceneBroadPhase(const SceneBroadPhase&) = delete;
  SceneBroadPhase& operator=(const SceneBroadPhase&) = delete;

  /// At least `count` further pairs, all those of a part together; fewer only at the end.
  [[nodiscard]] std::vector<ScenePair> next(std::size_t count);
  /// Number of pairs that the scene queries.
  [[nodiscard]] std::uint64_t pair_count() const;
  /// Progress: the share of the work that is done, in [0, 1].
  [[nodiscard]] double share() const;
  /// A box around a placed part; infinite where it does not fit doubles.
  [[nodiscard]] const Box3& box(std::uint32_t part) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Numbers of pairs of a scene, by outcome.
struct SceneCounts {
  std::uint64_t pairs = 0;               ///< all pairs queried
  std::uint64_t separated_by_boxes = 0;  ///< proved by the broad phase alone, and not passed on
  /// Of the others, by verdict; distance() counts pairs beyond the limit as separated, proved contact as intersecting.
  std::uint64_t separated = 0, within = 0, intersecting = 0, undecided = 0;
};

/// collide() of one pair, for callers that share out pairs themselves. The margin is that of the pair; errors name the parts.
[[nodiscard]] SNUG_API Collision collide(const Scene& scene, const ScenePair& pair,
                                         CollideOptions options = {}, const Run& run = {});
/// distance() of one pair, likewise; empty if it is farther apart than the margin.
[[nodiscard]] SNUG_API std::optional<Distance> distance(const Scene& scene, const ScenePair& pair,
                                                        const DistanceOptions& options = {},
                                                        const Run& run = {});

struct PairCollision {
  PartPair parts;
  Collision answer;
};
/// Run::certificate, for callers that share out pairs; others are farther apart than their margins. InputError (value): no such part.
SNUG_API void certify(const Scene& scene, const CollideOptions& options,
                      std::span<const PairCollision> answers, const Run& run);

/// Which parts touch? Passes pairs that boxes do not separate to `sink`, in order and on one thread at a time.
///
/// Guarantee: each answer is bit-identical to that of collide() for the two parts.
/// Errors:    those of SceneBroadPhase and collide(), naming the parts, and whatever `sink` throws.
/// Cost:      that of SceneBroadPhase, plus collide() for each pair. Memory: in proportion to the pairs of one part.
SNUG_API SceneCounts collide(const Scene& scene, const CollideOptions& options,
                             const std::function<void(const PairCollision&)>& sink, const Run& run = {});

struct PairDistance {
  PartPair parts;
  Distance answer;
};
/// The same of distances. Pairs without an answer are farther apart than `limit`.
SNUG_API void certify(const Scene& scene, double limit, const DistanceOptions& options,
                      std::span<const PairDistance> answers, const Run& run);

/// All clearances of a scene up to `limit`, passed on likewise. Ignores Scene::margins.
/// Guarantee: each answer is bit-identical to that of distance() for the two parts.
/// Errors:    those of SceneBroadPhase and distance(); InputError (value) for a limit that is negative or not finite.
SNUG_API SceneCounts distance(const Scene& scene, double limit, const DistanceOptions& options,
                              const std::function<void(const PairDistance&)>& sink, const Run& run = {});

}  // namespace snug
