#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <snug/independence/exact_surface.h>
#include <snug/independence/real_field.h>
#include <snug/run.h>

namespace snug {

/// Shows that control values make the function 0, by exact arithmetic.
///
/// For each kind it keeps a space of control values. A requested value joins the space of its kind, unless it lies there; then
/// so do its images in the children. Once nothing is left to ask, all spaces together are closed under splitting, and 0 on
/// regular patches: so all functions are 0 on regular pieces of each depth, which are dense.
class ZeroProof {
 public:
  /// Weights of another order than the field's are multiples of its cosines; others are not proved.
  /// Requires:  both outlive it.
  ZeroProof(const ExactSurface& surface, const RealField& field);

  using Values = std::vector<std::pair<std::uint32_t, FieldNumber>>;  ///< by vertex, in rising order
  /// Is the function 0? False also where it needs cosines that the field has not.
  [[nodiscard]] bool vanishes(const Values& values, const WorkMonitor& monitor);

 private:
  using Vector = std::vector<FieldNumber>;
  struct Space {
    std::vector<Vector> basis;  // 1 at the pivot; later ones are 0 at pivots of earlier ones
    std::vector<std::size_t> pivots;
  };
  struct Image {
    std::vector<std::vector<std::pair<std::uint32_t, FieldNumber>>> rows;
    std::vector<std::uint32_t> foreign;  // control values that have weights out of the field
  };

  bool join(Space& space, Vector v) const;
  [[nodiscard]] bool is_zero_on(const ExactKind& kind, const Vector& v) const;
  const std::vector<Image>& images(std::uint32_t kind);

  const ExactSurface& surface_;
  const RealField& field_;
  std::vector<std::vector<std::uint32_t>> users_;  // patches, by vertex
  std::vector<Space> spaces_;
  std::vector<std::vector<Image>> images_;  // of children; empty until asked for
};

}  // namespace snug
