#include <picture/hierarchy.h>

#include <numeric>

#include <support/error.h>

namespace snug {
namespace {

constexpr std::uint32_t leaf_size = 4;
constexpr std::size_t bin_count = 16;

double half_area(const Box3& box) {
  if (box.empty()) return 0;
  const Vector3 d = box.upper - box.lower;
  return d.x * d.y + d.y * d.z + d.z * d.x;
}

// Twice the centre: only compared.
double centre(const Box3& box, std::size_t axis) { return box.lower[axis] + box.upper[axis]; }

// Moves the ids whose boxes go to the first child to the front and returns how many. The cut across the
// longest extent of the centres minimises area times count over 16 bins [Wald07]; when it separates nothing,
// the ids are halved.
std::uint32_t split(std::span<const Box3> boxes, std::span<std::uint32_t> ids) {
  Box3 centres;
  for (const std::uint32_t id : ids)
    centres.add(Point3{centre(boxes[id], 0), centre(boxes[id], 1), centre(boxes[id], 2)});
  const Vector3 extent = centres.upper - centres.lower;
  const std::size_t axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::uint32_t half = static_cast<std::uint32_t>(ids.size() / 2);
  if (!(extent[axis] > 0)) return half;

  const auto bin_of = [&](std::uint32_t id) {
    const double share = (centre(boxes[id], axis) - centres.lower[axis]) / extent[axis];
    return std::min(static_cast<std::size_t>(share * bin_count), bin_count - 1);
  };
  struct Bin {
    Box3 box;
    std::uint32_t count = 0;
  } bins[bin_count];
  for (const std::uint32_t id : ids) {
    Bin& bin = bins[bin_of(id)];
    bin.box.add(boxes[id]);
    ++bin.count;
  }
  double cost_behind[bin_count];
  Bin sum;
  for (std::size_t i = bin_count - 1; i > 0; --i) {
    sum.box.add(bins[i].box);
    sum.count += bins[i].count;
    cost_behind[i] = half_area(sum.box) * sum.count;
  }
  sum = {};
  std::size_t best = 0;
  double best_cost = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < bin_count; ++i) {
    sum.box.add(bins[i - 1].box);
    sum.count += bins[i - 1].count;
    const double cost = half_area(sum.box) * sum.count + cost_behind[i];
    if (sum.count > 0 && sum.count < ids.size() && cost < best_cost) {
      best = i;
      best_cost = cost;
    }
  }
  const auto middle =
      std::partition(ids.begin(), ids.end(), [&](std::uint32_t id) { return bin_of(id) < best; });
  const auto front = static_cast<std::uint32_t>(middle - ids.begin());
  return front > 0 && front < ids.size() ? front : half;
}

}  // namespace

BeamHierarchy::BeamHierarchy(std::span<const Box3> boxes) : ids_(boxes.size()) {
  require_value(boxes.size() < (std::size_t{1} << 31),
                "picture: more than 2^31 triangles and lines; show fewer meshes");
  if (boxes.empty()) return;
  std::iota(ids_.begin(), ids_.end(), 0U);
  Box3 all;
  for (const Box3& box : boxes) all.add(box);
  const Point3 origin;
  const double growth = 1e-12 * std::max(max_abs(all.lower - origin), max_abs(all.upper - origin));
  const Vector3 grown{growth, growth, growth};

  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(boxes.size())});
  for (std::size_t next = 0; next < nodes_.size(); ++next) {
    Node node = nodes_[next];
    const std::span<std::uint32_t> ids(ids_.data() + node.first, node.count);
    for (const std::uint32_t id : ids) node.box.add(boxes[id]);
    if (node.count > leaf_size) {
      const std::uint32_t front = split(boxes, ids), first = node.first, count = node.count;
      node.first = static_cast<std::uint32_t>(nodes_.size());
      node.count = 0;
      nodes_.push_back({{}, first, front});
      nodes_.push_back({{}, first + front, count - front});
    }
    node.box = {node.box.lower - grown, node.box.upper + grown};
    nodes_[next] = node;
  }
}

}  // namespace snug
