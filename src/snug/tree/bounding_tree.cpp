#include <snug/tree/bounding_tree.h>

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

// Eight parts by three halvings, each across the longest side of its box; parts are of whole clusters, so that all but the
// last of these are full.
void BoundingTree::sort(std::span<const Point3> centres, std::size_t begin, std::size_t end, int threads) {
  struct Range {
    std::size_t begin, end;
  };
  std::vector<Range> ranges{{begin, end}};
  const std::size_t clusters = (end - begin + cluster_size - 1) / cluster_size;
  const std::size_t part = child_capacity(clusters) * cluster_size;
  for (int halving = 0; halving < 3; ++halving) {
    std::vector<Range> finer;
    for (const Range& range : ranges) {
      const std::size_t parts = (range.end - range.begin + part - 1) / part;
      if (parts <= 1) {
        finer.push_back(range);
        continue;
      }
      const std::size_t middle = range.begin + (parts + 1) / 2 * part;
      Box3 box;
      for (std::size_t i = range.begin; i < range.end; ++i) box.add(centres[items_[i]]);
      const Vector3 sides = box.upper - box.lower;
      const std::size_t axis =
          sides.x >= sides.y ? (sides.x >= sides.z ? 0u : 2u) : (sides.y >= sides.z ? 1u : 2u);
      const auto at = [&](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
      std::nth_element(at(range.begin), at(middle), at(range.end), [&](std::uint32_t a, std::uint32_t b) {
        const double x = centres[a][axis], y = centres[b][axis];
        return x != y ? x < y : a < b;
      });
      finer.push_back({range.begin, middle});
      finer.push_back({middle, range.end});
    }
    ranges = std::move(finer);
  }
  if (part <= cluster_size) return;
  const int below = end - begin > 4096 ? threads : 1;
  parallel_for(ranges.size(), below, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) sort(centres, ranges[i].begin, ranges[i].end, 1);
  });
}

BoundingTree::BoundingTree(Volume volume, std::span<const Point3> centres, int threads,
                           const std::function<BoundingVolume(std::span<const std::uint32_t>)>& fit)
    : blocks_(volume) {
  SNUG_EXPECT(!centres.empty() && centres.size() < cluster_bit);
  items_.resize(centres.size());
  for (std::size_t i = 0; i < items_.size(); ++i) items_[i] = static_cast<std::uint32_t>(i);
  sort(centres, 0, items_.size(), threads);

  std::vector<BoundingVolume> volumes(cluster_count());
  std::vector<std::uint32_t> names(cluster_count());
  parallel_for(volumes.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      volumes[i] = fit(cluster(i));
      names[i] = static_cast<std::uint32_t>(i) | cluster_bit;
    }
  });
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
}

std::span<const std::uint32_t> BoundingTree::cluster(std::size_t i) const {
  const std::size_t begin = i * cluster_size;
  return std::span(items_).subspan(begin, std::min(cluster_size, items_.size() - begin));
}

std::size_t BoundingTree::bytes() const {
  return blocks_.bytes() + items_.capacity() * sizeof(std::uint32_t);
}

}  // namespace snug
