#pragma once

#include <oracle/dual_twin.h>
#include <oracle/polygon_net.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

/// The effect of a split on the control points of a patch, for every scheme and tag. Internal
/// to limit_twin.
namespace oracle::detail {

/// Weights of the control points of one patch for a point of another; each control point once.
struct WeightRow {
  std::vector<std::pair<std::uint32_t, double>> weights;
  [[nodiscard]] Point apply(const Point* points) const {
    Point sum{};
    for (const auto& [i, w] : weights)
      for (std::size_t x = 0; x < 3; ++x) sum[x] += w * points[i][x];
    return sum;
  }
};

/// The Bezier form of a regular patch.
enum class Polynomial : std::uint8_t { none, biquadratic, bicubic, quartic };

/// Patches of the same connectivity, rules and sharpness. A patch lies in the convex hull of its control
/// points.
struct PatchKind {
  struct Child {
    std::uint32_t kind;
    std::vector<WeightRow> rows;                            // its control points
    std::optional<std::uint32_t> corner_of_parent, corner;  // a corner that it has in common with its parent
  };
  std::uint32_t point_count = 0;
  std::vector<std::optional<WeightRow>> corners;  // limits of the corners, where a closed formula is known
  Polynomial polynomial = Polynomial::none;
  std::vector<WeightRow> hull;  // its Bezier points, once they are asked for
  bool split = false;
  std::vector<Child> children;
};

/// A patch of a control mesh: its kind, and the control vertices that are its control points.
struct RootPatch {
  std::uint32_t kind, owner;
  std::vector<std::uint32_t> vertices;
};

/// Kinds of one scheme and its rules, each made once and split when that is asked for.
class PatchKinds {
 public:
  virtual ~PatchKinds() = default;
  /// The patches of a mesh, those without a surface left out.
  [[nodiscard]] virtual std::vector<RootPatch> roots(const TaggedMesh& mesh) = 0;
  [[nodiscard]] const PatchKind& operator[](std::uint32_t kind) const { return kinds_[kind]; }
  const PatchKind& split(std::uint32_t kind) {
    if (!kinds_[kind].split) {
      make_children(kind);
      kinds_[kind].split = true;
    }
    return kinds_[kind];
  }
  /// Bezier points of a polynomial, whose hull holds the patch; none for others.
  /// Guarantee: exact to a rounding.
  [[nodiscard]] const std::vector<WeightRow>& hull(std::uint32_t kind);

 protected:
  virtual void make_children(std::uint32_t kind) = 0;
  std::vector<PatchKind> kinds_;
};

[[nodiscard]] std::unique_ptr<PatchKinds> primal_kinds(const Rules& rules);
[[nodiscard]] std::unique_ptr<PatchKinds> dual_kinds(DualScheme scheme);

}  // namespace oracle::detail
