#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <snug/bound.h>
#include <snug/evaluate.h>
#include <snug/ray.h>

namespace snug::command {

/// A lattice of so many steps a side on every patch of a surface that has one.
class PatchLattice {
 public:
  PatchLattice(const Surface& surface, std::uint32_t steps);

  /// Patches with a limit surface.
  [[nodiscard]] const std::vector<PatchPlace>& patches() const { return patches_; }
  /// Which of these a patch is.
  /// Requires:  it has a surface.
  [[nodiscard]] std::size_t rank(const PatchPlace& patch) const {
    return ranks_[begins_[patch.owner] + patch.part];
  }
  /// Evaluates at the places of the lattice, patch by patch: at those that `ask` adds for each, and hands the points to
  /// `take`, those of one place after those of another.
  /// Errors:    Interrupted; whatever evaluate(), `ask` and `take` throw.
  /// Cost:      that of evaluate(). Memory: of some thousand points at a time.
  void evaluate(const Surface& surface, const Run& run,
                const std::function<void(const Place&, std::vector<Place>&)>& ask,
                const std::function<void(std::span<const SurfacePoint>)>& take) const;
  /// Linear interpolation of numbers at the places, in the order of evaluate(), at a hit.
  [[nodiscard]] double interpolated(const std::vector<double>& values, const QuickHit& hit) const;

 private:
  [[nodiscard]] std::size_t at(std::uint32_t i, std::uint32_t j) const {
    return std::size_t{j} * (steps_ + 1) - std::size_t{j} * (j - std::size_t{1}) / 2 + i;
  }

  bool triangular_;
  std::uint32_t steps_;
  std::vector<PatchPlace> patches_;
  std::vector<std::size_t> begins_;  // of the patches of each owner
  std::vector<std::size_t> ranks_;
};

}  // namespace snug::command
