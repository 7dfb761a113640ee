#include <snug/query/nesting.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/pair_frames.h>
#include <snug/search/solid.h>
#include <snug/search/winding.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>

namespace snug {
namespace {

// Of each surface, patches that are asked where the surfaces may meet.
constexpr std::size_t max_patches = 32;

// Of each surface, patches beside which points are asked, and how far inward, in radii of the surface.
constexpr std::size_t max_inward = 8;
constexpr double inward = 0x1p-7;
// Of one surface that may wind twice: components, patches of all of it, and a share of that way for small shells.
constexpr std::size_t max_components = 100, max_spread = 200;
constexpr double near_by = 0x1p-6;

// Is a placed point certainly outside of the ball around a placed model?
bool beyond(const PlacedFrame& frame, const Ball& ball, const BoundedPoint& placed) {
  const Point3 centre = frame.apply(ball.centre);
  const double between = distance(placed.position, centre) * (1 - 8 * unit_roundoff);
  return between > enlarged(frame.growth() * ball.radius +
                            spatial_error(placed.error + frame.apply_error(ball.centre)));
}

// The middle of a patch, moved across it by a share of the surface's radius.
Point3 beside(const SurfaceBvh& model, PatchId p, double way) {
  const Patch patch = model.surface().patch(p);
  std::array<Point3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = corner_point(patch, k).from(patch.origin).position;
  const Vector3 across = normalized(cross(corners[1] - corners[0], corners[2] - corners[0]));
  return limit_point(patch, {1.0 / 3, 1.0 / 3}).from(patch.origin).position +
         way * model.tree().ball().radius * across;
}

class NestingTest {
 public:
  NestingTest(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor)
      : side_{&a, &b}, frames_(a, b), monitor_(monitor) {}

  Nesting components() {
    return first_inside([&](std::size_t side) { return side_[side]->model.solid().components(); }, {0, 0});
  }
  // Is a point a little inward of one of some patches in both solids?
  bool inner_points() {
    for (std::size_t side = 0; side < 2; ++side) {
      const LimitSurface& surface = side_[side]->model.surface();
      const std::size_t count = std::min(max_inward, surface.patch_count());
      for (std::size_t i = 0; i < count; ++i) {
        const PatchId p(i * surface.patch_count() / count);
        for (const double way : {-inward, inward}) {
          if (is_inside_both(side, beside(side_[side]->model, p, way))) return true;
        }
      }
    }
    return false;
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
    const RelativeFrame& seen = frames_.seen_from(1 - side);
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

  // Of a point in the frame of `side`, taken as it is.
  [[nodiscard]] bool is_inside_both(std::size_t side, const Point3& point) {
    const RelativeFrame& seen = frames_.seen_from(1 - side);
    const Point3 other = seen.apply(point);
    if (!seen.comparable || !(depth_in_box(1 - side, other) > 0)) return false;
    return winding_number(side_[side]->scratch, point, 0, monitor_).value_or(0) != 0 &&
           winding_number(side_[1 - side]->scratch, other, seen.slack, monitor_).value_or(0) != 0;
  }

  // Of a point in the frame of `side`; negative outside.
  [[nodiscard]] double depth_in_box(std::size_t side, const Point3& point) const {
    const Obb& box = side_[side]->model.tree().box();
    double depth = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      depth = std::min(depth, box.half[k] - std::fabs(dot(box.axes[k], point - box.centre)));
    }
    return depth;
  }

  [[nodiscard]] std::vector<PatchId> deepest(std::size_t side) {
    const RelativeFrame& seen = frames_.seen_from(1 - side);
    if (!seen.comparable) return {};
    const LimitSurface& surface = side_[side]->model.surface();
    std::vector<std::pair<double, PatchId>> inside;
    for (std::size_t p = 0; p < surface.patch_count(); ++p) {
      const double depth = depth_in_box(1 - side, seen.apply(surface.middle(PatchId(p))));
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
  return NestingTest(a, b, monitor).components();
}

Nesting common_point(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor) {
  const Nesting found = nesting(a, b, monitor);
  return found.inner ? found : NestingTest(a, b, monitor).deep_patches();
}

bool have_inner_point_in_common(const PlacedBvh& a, const PlacedBvh& b, const WorkMonitor& monitor) {
  require_solids(a, b);
  return NestingTest(a, b, monitor).inner_points();
}

std::optional<PatchId> wound_twice(const SurfaceBvh& model, const WorkMonitor& monitor) {
  const LimitSurface& surface = model.surface();
  std::vector<PatchId> patches = model.solid().components();
  patches.resize(std::min(patches.size(), max_components));
  const std::size_t spread = std::min(max_spread, surface.patch_count());
  for (std::size_t i = 0; i < spread; ++i) patches.emplace_back(i * surface.patch_count() / spread);
  PieceCache workspace(model);
  for (const PatchId p : patches) {
    for (const double way : {-inward, inward}) {
      for (const double share : {1.0, near_by}) {
        const Point3 point = beside(model, p, share * way);
        if (std::abs(winding_number(workspace, point, 0, monitor).value_or(0)) > 1) return p;
      }
    }
  }
  return {};
}

}  // namespace snug
