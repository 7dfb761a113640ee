#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <snug/base/motion.h>
#include <snug/surface/refinement.h>
#include <snug/tree/obb_tree.h>

namespace snug {

enum class Verdict : std::uint8_t {
  separated,  ///< proved: the limit surfaces are farther apart than the margin
  within,     ///< two witness points on the limit surfaces are at most margin + tolerance apart
  undecided,  ///< neither within the budget, or above the noise of rounding
};
[[nodiscard]] const char* name_of(Verdict verdict);

/// A surface made ready for queries: offset triangles of its patches, from hull rows or from the tables of a
/// layout, and a tree over them. Immutable.
///
/// Cost:      about 10 microseconds a patch, n log n for the tree; some 500 bytes a patch.
class CollisionModel {
 public:
  /// Requires:  the surface outlives the model.
  /// Errors:    InputError (refused) if no face has a patch.
  explicit CollisionModel(const Surface& surface, int threads = 0, const WorkMonitor& monitor = {},
                          std::optional<TableLayout> table = {});

  [[nodiscard]] const Surface& surface() const { return *surface_; }
  [[nodiscard]] std::optional<TableLayout> table() const { return table_; }
  [[nodiscard]] const ObbTree& tree() const { return tree_; }
  /// Patch and offset triangle of a leaf.
  [[nodiscard]] PatchId patch(std::uint32_t leaf) const { return patches_[leaf]; }
  [[nodiscard]] const OffsetTriangle& offset(std::uint32_t leaf) const { return offsets_[leaf]; }

 private:
  const Surface* surface_;
  std::optional<TableLayout> table_;
  std::vector<PatchId> patches_;
  std::vector<OffsetTriangle> offsets_;
  ObbTree tree_;
};

struct CollideOptions {
  double tolerance = 0;              ///< > 0, mesh units
  double margin = 0;                 ///< >= 0, mesh units
  std::uint64_t budget = 1'000'000;  ///< most splits of a pair
};

struct CollideStats {
  std::uint64_t box_tests = 0, triangle_tests = 0, evaluations = 0, splits = 0;
};

/// Answer to "do these surfaces touch?", in mesh units and world coordinates.
struct Collision {
  Verdict verdict = Verdict::undecided;
  double lower = 0;                              ///< proved lower bound of the distance
  std::optional<double> upper;                   ///< proved upper bound, where a pair of points was evaluated
  std::optional<std::array<Point3, 2>> witness;  ///< those points, on A and on B
  /// Upper bound, a coordinate, of how far a witness is from the limit point it stands for.
  double witness_error = 0;
  CollideStats stats;
};

/// Scratch memory of queries between two models, to be used again by the next one: one a thread.
struct CollideScratch {
  Refinement a, b;
  CollideScratch(const CollisionModel& model_a, const CollisionModel& model_b)
      : a(model_a.surface(), model_a.table()), b(model_b.surface(), model_b.table()) {}
};

/// Do two placed limit surfaces touch?
///
/// A pair of pieces is (a) dropped once its offset triangles are farther apart than the margin; (b) a witness
/// if the limit points at the nearest parameters of its base triangles are near enough; (c) else its larger
/// piece is split, below half the tolerance too.
///
/// Guarantee: `separated` means distance > margin, `within` means distance <= margin + tolerance, both in
///            exact arithmetic for these very doubles; lower and upper bound the distance. Where both
///            verdicts are true the choice depends on the input alone, not on threads or earlier queries.
/// Requires:  rigid placements (require_rigid); tolerance > 0.
/// Errors:    InputError if a result does not fit a double; Interrupted.
/// Cost:      a few microseconds for surfaces apart, tens of microseconds in contact.
/// Source:    [Wu05, sec. 5.1]; differs: the printed pair test is not sound, see derivations/leaf_rule.md.
[[nodiscard]] Collision collide(const CollisionModel& a, const Placement& place_a, const CollisionModel& b,
                                const Placement& place_b, const CollideOptions& options,
                                CollideScratch& scratch, const WorkMonitor& monitor = {});

}  // namespace snug
