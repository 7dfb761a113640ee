#include <snug/tree/obb_tree.h>

#include <algorithm>

#include <snug/base/contract.h>

namespace snug {
namespace {

Point3 centroid(const OffsetTriangle& triangle) {
  const Vector3 sum =
      (triangle.base[0] - Point3{}) + (triangle.base[1] - Point3{}) + (triangle.base[2] - Point3{});
  return Point3{} + (1.0 / 3.0) * sum;
}

// A half with less than this share (1/32) of the members would let the depth grow with their number.
constexpr std::size_t lopsided = 32;

// Splits members in two non-empty halves along the longest axis of the box.
std::size_t partition(std::span<const OffsetTriangle*> members, const Obb& box) {
  const std::size_t axis =
      box.half.x >= box.half.y ? (box.half.x >= box.half.z ? 0u : 2u) : (box.half.y >= box.half.z ? 1u : 2u);
  const auto height = [&](const OffsetTriangle* t) { return dot(box.axes[axis], centroid(*t) - box.centre); };
  double mean = 0;
  for (const OffsetTriangle* member : members) mean += height(member);
  mean /= static_cast<double>(members.size());
  const auto middle = std::stable_partition(members.begin(), members.end(),
                                            [&](const OffsetTriangle* t) { return height(t) < mean; });
  const auto count = static_cast<std::size_t>(middle - members.begin());
  if (std::min(count, members.size() - count) * lopsided >= members.size()) return count;
  const std::size_t half = members.size() / 2;
  std::nth_element(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(half), members.end(),
                   [&](const OffsetTriangle* a, const OffsetTriangle* b) {
                     const double x = height(a), y = height(b);
                     return x != y ? x < y : a < b;
                   });
  return half;
}

}  // namespace

ObbTree::ObbTree(std::span<const OffsetTriangle> triangles) {
  SNUG_EXPECT(triangles.size() < (std::size_t{1} << 31));
  if (triangles.empty()) return;
  std::vector<const OffsetTriangle*> members;
  for (const OffsetTriangle& t : triangles) members.push_back(&t);
  nodes_.reserve(2 * triangles.size() - 1);
  struct Task {
    std::uint32_t node;
    std::size_t begin, end;
  };
  std::vector<Task> tasks{{0, 0, members.size()}};
  nodes_.emplace_back();
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    const std::span<const OffsetTriangle*> mine(members.data() + task.begin, task.end - task.begin);
    nodes_[task.node].box = outer_obb(mine);
    if (mine.size() == 1) {
      nodes_[task.node].leaf = static_cast<std::uint32_t>(mine[0] - triangles.data());
      continue;
    }
    const std::size_t middle = task.begin + partition(mine, nodes_[task.node].box);
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    nodes_[task.node].first_child = first;
    nodes_.resize(nodes_.size() + 2);
    tasks.push_back({first + 1, middle, task.end});
    tasks.push_back({first, task.begin, middle});
  }
}

}  // namespace snug
