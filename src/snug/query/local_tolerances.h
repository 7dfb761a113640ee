#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include <snug/surface/limit_surface.h>
#include <snug/surface/piece_name.h>

namespace snug {

/// A part of a root patch: a triangle of its parameters.
struct PatchPart {
  PatchId patch;
  std::array<TriangleParameter, 3> at;
};

/// Tolerances of a surface in mesh units, for each owner and for pieces of its patches in which they are made smaller.
class LocalTolerances {
 public:
  /// Requires:  finite, positive tolerances, one an owner.
  LocalTolerances(const LimitSurface& surface, std::vector<double> of_owners);

  /// The least one of pieces that a part may have a point in common with.
  [[nodiscard]] double of(const PatchPart& part) const;
  /// That of a whole patch, if all of its pieces have the same.
  [[nodiscard]] std::optional<double> of_all(PatchId patch) const;
  [[nodiscard]] double least() const { return least_; }

  /// Chooses where tolerances are halved that are larger than `least`: of the owner, while it is larger than `whole`; of pieces about
  /// as large as the part that it may have a point in common with, after that.
  void mark(const PatchPart& part, double least, double whole);
  /// Halves what is marked, and forgets the marks; the least of these, infinite if there is none.
  double refine();
  /// How often refine() found pieces of a part marked that were as small as they get, one time after the other: of any of them.
  [[nodiscard]] int times_at_least(const PatchPart& part) const;

 private:
  // A tree for each patch by the splits in four, from its whole on.
  struct Cell {
    double tolerance;
    std::uint32_t first_child = 0;  // 0: none; four in a row
    bool marked = false, at_least = false;
    int times = 0;
  };
  using Cells = std::vector<Cell>;
  template <class CellsOf, class Visit>
  static void visit(CellsOf& cells, const PatchPart& part, unsigned level, const Visit& visit_leaf);

  const LimitSurface& surface_;
  std::vector<double> of_owners_;
  std::vector<std::uint8_t> marked_owners_;
  std::unordered_map<std::uint32_t, Cells> cells_;  // of patches
  double least_;
};

}  // namespace snug
