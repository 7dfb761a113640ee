#include <snug/bvh/wide_bvh.h>

#include <algorithm>
#include <array>

#include <snug/base/contract.h>
#include <snug/base/parallel.h>

namespace snug {
namespace {

// Leaves under each of the eight children of a node with so many leaves: as even as full subtrees allow.
std::size_t child_capacity(std::size_t leaves) {
  std::size_t capacity = 1;
  while (capacity * WideNode::width < leaves) capacity *= WideNode::width;
  return capacity;
}

// A centre in single precision: enough to sort by.
struct Item {
  std::array<float, 3> centre;
  std::uint32_t number;
};

// Eight parts by three halvings, each across the longest side of its box; parts are of whole leaves, so that
// all but the last of these are full.
void sort_items(std::span<Item> items, int threads) {
  constexpr std::size_t leaf_size = WideBvh::leaf_size;
  const std::size_t part = child_capacity((items.size() + leaf_size - 1) / leaf_size) * leaf_size;
  std::vector<std::span<Item>> ranges{items};
  for (int halving = 0; halving < 3; ++halving) {
    std::vector<std::span<Item>> finer;
    for (const std::span<Item> range : ranges) {
      const std::size_t parts = (range.size() + part - 1) / part;
      if (parts <= 1) {
        finer.push_back(range);
        continue;
      }
      const std::size_t middle = (parts + 1) / 2 * part;
      std::array<float, 3> lower = range[0].centre, upper = lower, sides;
      for (const Item& item : range) {
        for (std::size_t k = 0; k < 3; ++k) {
          lower[k] = std::min(lower[k], item.centre[k]);
          upper[k] = std::max(upper[k], item.centre[k]);
        }
      }
      for (std::size_t k = 0; k < 3; ++k) sides[k] = upper[k] - lower[k];
      const auto axis =
          static_cast<std::size_t>(std::max_element(sides.begin(), sides.end()) - sides.begin());
      std::nth_element(range.begin(), range.begin() + static_cast<std::ptrdiff_t>(middle), range.end(),
                       [axis](const Item& a, const Item& b) {
                         const float x = a.centre[axis], y = b.centre[axis];
                         return x != y ? x < y : a.number < b.number;
                       });
      finer.push_back(range.first(middle));
      finer.push_back(range.subspan(middle));
    }
    ranges = std::move(finer);
  }
  if (part <= leaf_size) return;
  parallel_for(ranges.size(), items.size() > 4096 ? threads : 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sort_items(ranges[i], 1);
  });
}

}  // namespace

TreeNode::TreeNode(std::span<const Obb> boxes, std::span<const std::uint32_t> of_boxes) : WideNode(boxes) {
  std::copy(of_boxes.begin(), of_boxes.end(), names.begin());
}

WideBvh::WideBvh(std::span<const Point3> centres, int threads, const Fit& fit) {
  SNUG_EXPECT(!centres.empty() && centres.size() < leaf_bit);
  std::vector<Item> items;
  items.reserve(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Point3& p = centres[i];
    items.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                     static_cast<std::uint32_t>(i)});
  }
  sort_items(items, threads);
  items_.reserve(items.size());
  for (const Item& item : items) items_.push_back(item.number);

  // What each leaf is fitted to.
  std::vector<std::vector<Obb>> parts(leaf_count());
  std::vector<Obb> boxes(leaf_count());
  std::vector<std::uint32_t> names(leaf_count());
  parallel_for(boxes.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      fit(i, leaf(i), parts[i]);
      boxes[i] = parts[i].size() == 1 ? parts[i][0] : merge(parts[i]);
      names[i] = static_cast<std::uint32_t>(i) | leaf_bit;
    }
  });
  const std::vector<Obb> leaves = boxes;
  std::vector<Obb> below;         // of all leaves
  std::vector<std::size_t> ends;  // there, of each box
  for (const std::vector<Obb>& part : parts) {
    below.insert(below.end(), part.begin(), part.end());
    ends.push_back(below.size());
  }
  // Level by level: eight neighbours in a row make a node.
  while (boxes.size() > 1) {
    const std::size_t count = (boxes.size() + WideNode::width - 1) / WideNode::width;
    std::vector<Obb> parents(count);
    std::vector<std::uint32_t> parent_names(count);
    std::vector<std::size_t> parent_ends(count);
    const auto first_name = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + count);
    parallel_for(count, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t first = i * WideNode::width, n = std::min(WideNode::width, boxes.size() - first);
        const std::size_t from = first == 0 ? 0 : ends[first - 1];
        parents[i] = merge(std::span(below).subspan(from, ends[first + n - 1] - from));
        parent_names[i] = first_name + static_cast<std::uint32_t>(i);
        parent_ends[i] = ends[first + n - 1];
        nodes_[parent_names[i]] =
            TreeNode(std::span(boxes).subspan(first, n), std::span(names).subspan(first, n));
      }
    });
    boxes = std::move(parents);
    names = std::move(parent_names);
    ends = std::move(parent_ends);
  }
  nodes_.emplace_back(boxes, names);
  box_ = boxes[0];
  ball_ = ball_around(leaves);
  dop_ = Dop26(leaves, box_.centre);
}

std::span<const std::uint32_t> WideBvh::leaf(std::size_t i) const {
  const std::size_t begin = i * leaf_size;
  return std::span(items_).subspan(begin, std::min(leaf_size, items_.size() - begin));
}

std::size_t WideBvh::bytes() const {
  return nodes_.capacity() * sizeof(TreeNode) + items_.capacity() * sizeof(std::uint32_t);
}

}  // namespace snug
