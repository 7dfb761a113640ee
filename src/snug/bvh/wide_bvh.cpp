#include <snug/bvh/wide_bvh.h>

#include <algorithm>
#include <array>

#include <snug/base/contract.h>
#include <snug/base/parallel.h>

namespace snug {
namespace {

// Clusters under each of the eight children of a node with so many clusters: as even as full subtrees allow.
std::size_t child_capacity(std::size_t clusters) {
  std::size_t capacity = 1;
  while (capacity * Blocks::lanes < clusters) capacity *= Blocks::lanes;
  return capacity;
}

}  // namespace

namespace {

// A centre in single precision: enough to sort by.
struct Item {
  std::array<float, 3> centre;
  std::uint32_t number;
};

// Eight parts by three halvings, each across the longest side of its box; parts are of whole clusters, so that all but the
// last of these are full.
void sort_items(std::span<Item> items, int threads) {
  constexpr std::size_t cluster_size = WideBvh::cluster_size;
  const std::size_t part = child_capacity((items.size() + cluster_size - 1) / cluster_size) * cluster_size;
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
      const std::size_t axis =
          sides[0] >= sides[1] ? (sides[0] >= sides[2] ? 0u : 2u) : (sides[1] >= sides[2] ? 1u : 2u);
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
  if (part <= cluster_size) return;
  parallel_for(ranges.size(), items.size() > 4096 ? threads : 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sort_items(ranges[i], 1);
  });
}

}  // namespace

WideBvh::WideBvh(Volume volume, std::span<const Point3> centres, int threads,
                 const std::function<BoundingVolume(std::span<const std::uint32_t>)>& fit)
    : blocks_(volume) {
  SNUG_EXPECT(!centres.empty() && centres.size() < cluster_bit);
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

  std::vector<BoundingVolume> volumes(cluster_count());
  std::vector<std::uint32_t> names(cluster_count());
  parallel_for(volumes.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      volumes[i] = fit(cluster(i));
      names[i] = static_cast<std::uint32_t>(i) | cluster_bit;
    }
  });
  const std::vector<BoundingVolume> clusters = volumes;
  // Level by level: eight neighbours in a row make a block.
  while (volumes.size() > 1) {
    std::vector<BoundingVolume> parents;
    std::vector<std::uint32_t> parent_names;
    for (std::size_t i = 0; i < volumes.size(); i += Blocks::lanes) {
      const std::size_t n = std::min(Blocks::lanes, volumes.size() - i);
      const std::span<const BoundingVolume> children = std::span(volumes).subspan(i, n);
      parents.push_back(merge(volume, children));
      parent_names.push_back(blocks_.add(children, std::span(names).subspan(i, n)));
    }
    volumes = std::move(parents);
    names = std::move(parent_names);
  }
  blocks_.add(volumes, names);
  ball_ = ball_around(volume, volumes[0]);
  box_ = box_around(volume, volumes[0]);
  dop_ = Dop26(volume, clusters, box_.centre);
}

std::span<const std::uint32_t> WideBvh::cluster(std::size_t i) const {
  const std::size_t begin = i * cluster_size;
  return std::span(items_).subspan(begin, std::min(cluster_size, items_.size() - begin));
}

std::size_t WideBvh::bytes() const { return blocks_.bytes() + items_.capacity() * sizeof(std::uint32_t); }

}  // namespace snug
