#include <snug/search/refit_plan.h>

#include <utility>

namespace snug {
namespace {

// Only compared: half a box's surface.
double surface_of(const Obb& box) {
  const Vector3& h = box.half;
  return h.x * h.y + h.y * h.z + h.z * h.x;
}

std::vector<Point3> middles(const LimitSurface& surface, std::span<const PatchId> patches) {
  std::vector<Point3> points;
  points.reserve(patches.size());
  for (const PatchId p : patches) points.push_back(surface.middle(p));
  return points;
}

}  // namespace

RefitPlan::Carried RefitPlan::carry(const LimitSurface& surface, const Axes& axes,
                                    std::span<const VertexId> by) {
  std::vector<Point3> points;
  for (const VertexId v : by) points.push_back(surface.scaled_point(v));
  const std::array<std::size_t, 3> chosen = spread_points(points);
  return {CarriedAxes(axes, {points[chosen[0]], points[chosen[1]], points[chosen[2]]}),
          {by[chosen[0]], by[chosen[1]], by[chosen[2]]}};
}

Axes RefitPlan::axes_of(const LimitSurface& surface, const Carried& carried) {
  const Carriers& by = carried.by;
  return carried.axes.at(
      {surface.scaled_point(by[0]), surface.scaled_point(by[1]), surface.scaled_point(by[2])});
}

RefitPlan::RefitPlan(const LimitSurface& surface, std::vector<PatchId> patches, int threads,
                     const WorkMonitor& monitor)
    : patches_(std::move(patches)), order_(WideBvh::in_order(middles(surface, patches_), threads)) {
  surface.find_kinds(threads);
  ControlHull hull;
  std::vector<Obb> boxes;
  std::vector<PatchId> members;
  for (std::size_t leaf = 0; leaf < order_.leaf_count(); ++leaf) {
    if (leaf % 1024 == 0) monitor.checkpoint();
    members.clear();
    for (const std::uint32_t item : order_.leaf(leaf)) members.push_back(patches_[item]);
    hull.assign(surface, members);
    nets_.add(hull);
    boxes.push_back(hull.box());
    leaves_.push_back(carry(surface, boxes.back().axes, nets_.corners(leaf)));
  }
  WideBvh tree = WideBvh::in_order_of(order_);
  tree.refit(boxes);
  std::vector<VertexId> by;
  for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
    const WideBvh::LeafRange range = tree.leaves_of(node);
    by.clear();
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf) {
      by.insert(by.end(), leaves_[leaf].by.begin(), leaves_[leaf].by.end());
    }
    nodes_.push_back(carry(surface, tree.node_boxes()[node].axes, by));
  }
  looseness_ = refit(surface, tree);
}

double RefitPlan::refit(const LimitSurface& surface, WideBvh& tree) const {
  thread_local std::vector<Obb> boxes;
  thread_local std::vector<Axes> axes;
  boxes.resize(leaves_.size());
  axes.resize(nodes_.size());
  double all = 0, patches = 0;
  for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
    const ControlNets::Fit fit = nets_.fit(leaf, surface, axes_of(surface, leaves_[leaf]));
    boxes[leaf] = fit.box;
    all += surface_of(fit.box);
    patches += fit.patch_sizes;
  }
  for (std::size_t node = 0; node < nodes_.size(); ++node) axes[node] = axes_of(surface, nodes_[node]);
  tree.refit(boxes, axes);
  for (const Obb& box : tree.node_boxes()) all += surface_of(box);
  return patches > 0 ? all / patches : 0;
}

std::size_t RefitPlan::bytes() const {
  return patches_.capacity() * sizeof(PatchId) + order_.bytes() + nets_.bytes() +
         (leaves_.capacity() + nodes_.capacity()) * sizeof(Carried);
}

}  // namespace snug
