#include <snug/query/containment.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/pair_frames.h>
#include <snug/search/solid.h>
#include <snug/search/winding.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// Of each surface, patches that are asked where the surfaces may meet.
constexpr std::size_t max_patches = 32;

// Is a placed point certainly outside of the ball around a placed model?
bool beyond(const PlacedFrame& frame, const Ball& ball, const BoundedPoint& placed) {
  const Point3 centre = frame.apply(ball.centre);
  const double between = distance(placed.position, centre) * (1 - 8 * unit_roundoff);
  return between > enlarged(frame.growth() * ball.radius +
                            spatial_error(placed.error + frame.apply_error(ball.centre)));
}

class Asking {
 public:
  Asking(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor)
      : side_{&a, &b}, frames_(a, b), monitor_(monitor) {}

  Nesting components() {
    return first_inside([&](std::size_t side) { return side_[side]->model.solid().components(); }, {0, 0});
  }
  // Middles of patches that are deepest in the box of the other one.
  Nesting deep_patches() {
    return first_inside([&](std::size_t side) { return deepest(side); }, {1.0 / 3, 1.0 / 3});
  }

 private:
  template <class PatchesOf>
  Nesting first_inside(const PatchesOf& patches_of, TriangleParameter at) {
    for (std::size_t side = 0; side < 2; ++side) {
      for (const PatchId p : patches_of(side)) {
        ask(side, p, at);
        if (found_.inner) return found_;
      }
    }
    return found_;
  }

  // Is a limit point of `side` in the other solid?
  void ask(std::size_t side, PatchId p, TriangleParameter at) {
    const LimitSurface& surface = side_[side]->model.surface();
    const Patch patch = surface.patch(p);
    const BoundedPoint sample = limit_point(patch, at).from(patch.origin);
    const PlacedBvh& other = *side_[1 - side];
    const BoundedPoint placed = frames_.frame(side).apply(sample);
    if (beyond(frames_.frame(1 - side), other.model.tree().ball(), placed)) return;
    const RelativeFrame& seen = frames_.view(1 - side).frame;
    std::optional<int> number;
    if (seen.comparable) {
      number = winding_number(other.scratch, seen.apply(sample.position),
                              enlarged(2 * seen.scale * spatial_error(sample.error)) + seen.slack, monitor_);
    }
    found_.certain = found_.certain && number.has_value();
    if (number.value_or(0) == 0) return;
    found_.inner = side;
    found_.point = unscaled(placed, frames_.to_mesh_units());
    found_.at = place_of(surface, p, at);
  }

  [[nodiscard]] std::vector<PatchId> deepest(std::size_t side) {
    const RelativeFrame& seen = frames_.view(1 - side).frame;
    if (!seen.comparable) return {};
    const LimitSurface& surface = side_[side]->model.surface();
    const Obb& box = side_[1 - side]->model.tree().box();
    std::vector<std::pair<double, PatchId>> inside;
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      const Vector3 from = seen.apply(surface.middle(PatchId(p))) - box.centre;
      double depth = INFINITY;
      for (std::size_t k = 0; k < 3; ++k) {
        depth = std::min(depth, box.half[k] - std::fabs(dot(box.axes[k], from)));
      }
      if (depth > 0) inside.emplace_back(depth, PatchId(p));
    }
    const std::size_t count = std::min(max_patches, inside.size());
    std::partial_sort(inside.begin(), inside.begin() + static_cast<std::ptrdiff_t>(count), inside.end(),
                      [](const auto& x, const auto& y) {
                        return x.first != y.first ? x.first > y.first : x.second.index() < y.second.index();
                      });
    std::vector<PatchId> patches;
    for (std::size_t i = 0; i < count; ++i) patches.push_back(inside[i].second);
    return patches;
  }

  std::array<const PlacedBvh*, 2> side_;
  PairFrames frames_;
  const WorkMonitor& monitor_;
  Nesting found_;
};

}  // namespace

void require_solids(const PlacedBvh& a, const PlacedBvh& b) {
  static_cast<void>(a.model.solid());
  static_cast<void>(b.model.solid());
}

Nesting nesting(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor) {
  require_solids(a, b);
  return Asking(a, b, monitor).components();
}

Nesting common_point(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor) {
  const Nesting found = nesting(a, b, monitor);
  return found.inner ? found : Asking(a, b, monitor).deep_patches();
}

}  // namespace snug
