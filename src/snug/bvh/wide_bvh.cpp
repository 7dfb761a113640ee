#include <snug/bvh/wide_bvh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>

#include <snug/bvh/set_kernel.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>
#include <support/ordering.h>
#include <support/parallel.h>

namespace snug {
namespace {

constexpr std::size_t leaves_of_level(unsigned level) { return std::size_t{1} << 3 * level; }

}  // namespace

// A ball in single precision, for sorting and for boxes that need not be the tightest.
struct WideBvh::Item {
  std::array<float, 3> centre;  // from an origin
  float radius;
  std::uint32_t number;
};

struct WideBvh::Unmade {
  Fit fit;
  unsigned part_level;
  std::vector<Item> items;
  Point3 origin;
  double reach = 0;  // no coordinate of a ball is farther from the origin
  std::array<std::mutex, 16> locks;

  [[nodiscard]] std::vector<Obb> some_of(std::span<const Item> items, std::size_t most) const;
  [[nodiscard]] Obb box_around(std::span<const Item> items) const;
  [[nodiscard]] Ball ball_around_all() const;
};

namespace {

Vector3 wide(const std::array<float, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

// Eight parts by three halvings, each across the longest side of its box; all but the last are of `part` items.
template <class Item>
std::vector<std::span<Item>> split_by_eight(std::span<Item> items, std::size_t part) {
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
      ordering::nth_element(range.data(), middle, range.size(), [axis](const Item& a, const Item& b) {
        const float x = a.centre[axis], y = b.centre[axis];
        return x != y ? x < y : a.number < b.number;
      });
      finer.push_back(range.first(middle));
      finer.push_back(range.subspan(middle));
    }
    ranges = std::move(finer);
  }
  return ranges;
}

}  // namespace

// Boxes around some of the balls, about `most`, for choices that need no proof.
std::vector<Obb> WideBvh::Unmade::some_of(std::span<const Item> all, std::size_t most) const {
  std::vector<Obb> boxes;
  for (std::size_t i = 0; i < all.size(); i += (all.size() + most - 1) / most) {
    const auto r = static_cast<double>(all[i].radius);
    boxes.push_back({origin + wide(all[i].centre), Obb{}.axes, {r, r, r}});
  }
  return boxes;
}

Obb WideBvh::Unmade::box_around(std::span<const Item> all) const {
  const std::array<Vector3, 3> axes = merge(some_of(all, 64)).axes;
  std::array<Extent, 3> extents;
  for (const Item& item : all) {
    const Vector3 from = wide(item.centre);
    const auto r = static_cast<double>(item.radius);
    for (std::size_t k = 0; k < 3; ++k) {
      const double height = dot(axes[k], from);
      extents[k].add({height - r, height + r});
    }
  }
  // At most 64 roundings, and what axes lack of their length.
  const double error = 128 * unit_roundoff * (max_abs(origin - Point3{}) + reach);
  for (std::size_t k = 0; k < 3; ++k) {
    const double height = dot(axes[k], origin - Point3{});
    extents[k] = {extents[k].lower + height - error, extents[k].upper + height + error};
  }
  return box_of(axes, extents);
}

Ball WideBvh::Unmade::ball_around_all() const {
  const Vector3 centre = ball_around(some_of(items, 512)).centre - origin;
  double radius = 0;
  for (const Item& item : items) {
    radius = std::max(radius, length(wide(item.centre) - centre) + static_cast<double>(item.radius));
  }
  // The sum below is rounded once more.
  return {origin + centre,
          enlarged(radius) + 64 * unit_roundoff * (max_abs(origin - Point3{}) + reach) + 0x1p-480};
}

WideBvh::WideBvh(std::size_t item_count) : items_(item_count) {
  SNUG_EXPECT(item_count > 0 && item_count < leaf_bit);
  std::iota(items_.begin(), items_.end(), 0u);
  begins_ = {0};
  std::size_t nodes = 0;
  while (leaves_of_level(whole().level) < leaf_count()) {
    begins_.push_back(static_cast<std::uint32_t>(nodes));
    const std::size_t leaves = leaves_of_level(whole().level);
    nodes += (leaf_count() + leaves - 1) / leaves;
  }
  whole_ = name_of(whole());
  nodes_.resize(nodes);
  made_ = std::vector<std::atomic<bool>>(nodes);
}

WideBvh::WideBvh(WideBvh&&) noexcept = default;
WideBvh& WideBvh::operator=(WideBvh&&) noexcept = default;
WideBvh::~WideBvh() = default;

std::vector<WideBvh::Item> WideBvh::items_at(std::span<const Point3> centres) {
  std::vector<Item> items;
  items.reserve(centres.size());
  for (std::size_t i = 0; i < centres.size(); ++i) {
    const Point3& p = centres[i];
    items.push_back({{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
                     0,
                     static_cast<std::uint32_t>(i)});
  }
  return items;
}

WideBvh::WideBvh(std::span<const Point3> centres, int threads, const Fit& fit) : WideBvh(centres.size()) {
  std::vector<Item> items = items_at(centres);
  sort(whole(), items, threads);
  const Fitted fitted = fit_upwards(whole(), threads, fit);
  finish(merge(fitted.below), ball_around(fitted.leaves), fitted.leaves);
}

// Splits sets in two, again and again, after a multiple of the sets of a leaf: across an axis of the last box that was fitted
// around them, which is that of their node or, where they are many, their own.
class WideBvh::Builder {
 public:
  // Items that lie together.
  struct Part {
    std::size_t begin, end;
    float cost = 0;  // number times surface; negative for a leaf
    std::optional<Obb> box{};
    [[nodiscard]] std::size_t size() const { return end - begin; }
  };

  Builder(std::span<const FittedSet> sets, std::span<std::uint32_t> items, std::vector<WideNode>& nodes,
          const WorkMonitor& monitor)
      : sets_(sets),
        items_(items),
        nodes_(nodes),
        monitor_(monitor),
        leaves_((items.size() + leaf_size - 1) / leaf_size),
        sides_(items.size()),
        moved_sides_(items.size()),
        moved_triangles_(items.size()),
        moved_items_(items.size()) {
    triangles_.reserve(sets.size());
    for (const FittedSet& set : sets) triangles_.push_back(kernels::triangle_of(set));
  }

  // Its box.
  void fit(Part& part) {
    monitor_.checkpoint();
    const std::span<const std::uint32_t> items = items_.subspan(part.begin, part.size());
    const Axes axes = axes_around(sets_, items);
    if (part.size() <= few) return fit_tightly(part, axes);
    const std::span<const kernels::SetTriangle> triangles =
        std::span(triangles_).subspan(part.begin, part.size());
    part.box = box_of(axes, kernels::extents_along(axes, triangles, sides_.data() + part.begin));
  }
  // Makes what is below a part that was fitted last; the name of it.
  std::uint32_t make(const Part& whole) {
    if (whole.size() <= leaf_size) {
      leaves_[whole.begin / leaf_size] = *whole.box;
      return static_cast<std::uint32_t>(whole.begin / leaf_size) | leaf_bit;
    }
    const std::size_t name = nodes_.size();
    nodes_.emplace_back();
    std::vector<Obb> boxes;
    std::vector<std::uint32_t> names;
    for (Part& part : parts_of(whole)) {
      if (!part.box) {
        fit(part);
      } else if (part.size() <= most_tight) {
        fit_tightly(part, part.box->axes);
      }
      boxes.push_back(*part.box);
      names.push_back(make(part));
    }
    nodes_[name] = WideNode(boxes, names);
    return static_cast<std::uint32_t>(name);
  }
  [[nodiscard]] std::span<const Obb> leaves() const { return leaves_; }

 private:
  void fit_tightly(Part& part, const Axes& axes) {
    part.box = box_of(axes, kernels::extents_along(axes, sets_, items_.subspan(part.begin, part.size()),
                                                   sides_.data() + part.begin));
  }

  // Parts of at most so many are split along the axes of their node; boxes of nodes of at most so many are as tight as is known.
  static constexpr std::size_t few = 64, most_tight = 512;
  // Of more bins than items most are empty.
  static constexpr std::size_t most_bins = 32;
  static std::size_t bins_for(std::size_t items) { return items > few ? most_bins : 16; }

  // Eight of them, the costliest halved first.
  std::vector<Part> parts_of(const Part& whole) {
    std::vector<Part> parts{whole};
    while (parts.size() < WideNode::width) {
      const auto costliest = std::max_element(parts.begin(), parts.end(),
                                              [](const Part& x, const Part& y) { return x.cost < y.cost; });
      if (!(costliest->cost >= 0)) break;
      auto [first, second] = halves(*costliest);
      if (parts.size() + 1 < WideNode::width) {
        for (Part* half : {&first, &second}) {
          if (half->size() > few) fit(*half);
        }
      }
      *costliest = first;
      parts.insert(std::next(costliest), second);
    }
    return parts;
  }

  // Items by their middles along an axis, in bins of one width.
  struct Bins {
    std::array<std::uint32_t, most_bins> counts{};
    std::array<kernels::SetSides, most_bins> sides{};
    float lower = INFINITY, scale = 0;
    std::size_t count = most_bins;
    void begin(std::size_t of, float from, float scaled_by) {
      count = of;
      lower = from;
      scale = scaled_by;
      std::fill_n(counts.begin(), count, 0u);
      std::fill_n(sides.begin(), count, kernels::SetSides{});
    }
    [[nodiscard]] std::size_t bin_of(float twice_middle) const {
      return std::min(static_cast<std::size_t>((twice_middle - lower) * scale), count - 1);
    }
  };
  static float twice_middle(const kernels::SetSides& sides, std::size_t axis) {
    return sides.upper(axis) + sides.lower(axis);
  }
  void fill_bins(const Part& part) {
    const std::size_t count = bins_for(part.size());
    std::array<float, 4> lower, upper, scale{};  // the last of no use, as in SetSides
    lower.fill(INFINITY);
    upper.fill(-INFINITY);
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const std::array<float, 8>& reach = sides_[i].reach;
      for (std::size_t k = 0; k < 4; ++k) {
        const float middle = reach[4 + k] - reach[k];
        lower[k] = std::min(lower[k], middle);
        upper[k] = std::max(upper[k], middle);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (upper[k] > lower[k])
        scale[k] = std::min(static_cast<float>(count) / (upper[k] - lower[k]), 0x1p100F);
      bins_[k].begin(count, lower[k], scale[k]);
    }
    for (std::size_t i = part.begin; i < part.end; ++i) {
      const std::array<float, 8>& reach = sides_[i].reach;
      std::array<std::int32_t, 4> place;
      for (std::size_t k = 0; k < 4; ++k)
        place[k] = static_cast<std::int32_t>((reach[4 + k] - reach[k] - lower[k]) * scale[k]);
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t bin = std::min(static_cast<std::size_t>(place[k]), count - 1);
        ++bins_[k].counts[bin];
        bins_[k].sides[bin].add(sides_[i]);
      }
    }
  }

  // Where number times surface is least between two bins, and from there to a multiple of the sets of a leaf.
  struct Cut {
    std::size_t axis = 0, count = 0;
    float first_surface = 0, second_surface = 0;
  };
  [[nodiscard]] Cut best_cut(std::size_t count) const {
    // An eighth at least on either side, so that trees are not deep.
    const std::size_t least_part = count > 8 * leaf_size ? count / 8 : 1;
    Cut best{.count = (count / leaf_size + 1) / 2 * leaf_size};
    float least = INFINITY;
    for (std::size_t k = 0; k < 3; ++k) {
      const Bins& bins = bins_[k];
      std::array<float, most_bins> left;
      kernels::SetSides first, last;
      for (std::size_t b = 0; b + 1 < bins.count; ++b) {
        first.add(bins.sides[b]);
        left[b] = first.surface();
      }
      std::size_t before = count;
      for (std::size_t b = bins.count - 1; b > 0; --b) {
        last.add(bins.sides[b]);
        before -= bins.counts[b];
        const std::size_t cut = (before + leaf_size / 2) / leaf_size * leaf_size;
        if (cut < least_part || count < cut + least_part || before == 0 || before == count) continue;
        const float right = last.surface(),
                    cost = left[b - 1] * static_cast<float>(cut) + right * static_cast<float>(count - cut);
        if (!(cost < least)) continue;
        least = cost;
        best = {k, cut, left[b - 1], right};
      }
    }
    return best;
  }

  std::pair<Part, Part> halves(const Part& part) {
    fill_bins(part);
    const Cut cut = best_cut(part.size());
    divide(part, cut);
    const auto half = [](std::size_t begin, std::size_t end, float surface) {
      return Part{begin, end, end - begin > leaf_size ? static_cast<float>(end - begin) * surface : -1};
    };
    const std::size_t middle = part.begin + cut.count;
    return {half(part.begin, middle, cut.first_surface), half(middle, part.end, cut.second_surface)};
  }

  // So many of the items come first, those that are lowest along an axis; either side keeps its order.
  void divide(const Part& part, const Cut& cut) {
    const Bins& bins = bins_[cut.axis];
    const auto key_of = [&](std::size_t i) {
      return std::pair{twice_middle(sides_[i], cut.axis), static_cast<std::uint32_t>(i)};
    };
    std::size_t before = 0, middle = 0;
    while (before + bins.counts[middle] <= cut.count) before += bins.counts[middle++];
    keys_.clear();
    for (std::size_t i = part.begin; i < part.end; ++i) {
      if (bins.bin_of(twice_middle(sides_[i], cut.axis)) == middle) keys_.push_back(key_of(i));
    }
    const auto less = [](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : a.second < b.second;
    };
    ordering::nth_element(keys_.data(), cut.count - before, keys_.size(), less);
    const auto first_beyond = keys_[cut.count - before];
    std::size_t first = part.begin, last = part.begin + cut.count;
    for (std::size_t i = part.begin; i < part.end; ++i) {
      std::size_t& to = less(key_of(i), first_beyond) ? first : last;
      moved_sides_[to] = sides_[i];
      moved_triangles_[to] = triangles_[i];
      moved_items_[to] = items_[i];
      ++to;
    }
    const auto back = [&](const auto& from, auto&& to) {
      std::copy(from.begin() + static_cast<std::ptrdiff_t>(part.begin),
                from.begin() + static_cast<std::ptrdiff_t>(part.end),
                to.begin() + static_cast<std::ptrdiff_t>(part.begin));
    };
    back(moved_sides_, sides_);
    back(moved_triangles_, triangles_);
    back(moved_items_, items_);
  }

  std::span<const FittedSet> sets_;
  // Of items, in their order; sides along the axes of the last box that was fitted around them.
  std::vector<kernels::SetTriangle> triangles_;
  std::span<std::uint32_t> items_;
  std::vector<WideNode>& nodes_;
  const WorkMonitor& monitor_;
  std::vector<Obb> leaves_;
  std::vector<kernels::SetSides> sides_;
  std::array<Bins, 3> bins_;
  std::vector<std::pair<float, std::uint32_t>> keys_;
  std::vector<kernels::SetSides> moved_sides_;
  std::vector<kernels::SetTriangle> moved_triangles_;
  std::vector<std::uint32_t> moved_items_;
};

WideBvh::WideBvh(std::span<const FittedSet> sets, const WorkMonitor& monitor) : WideBvh(sets.size()) {
  nodes_.clear();
  Builder builder(sets, items_, nodes_, monitor);
  Builder::Part whole{0, sets.size()};
  builder.fit(whole);
  whole_ = builder.make(whole);
  made_ = std::vector<std::atomic<bool>>(nodes_.size());
  for (auto& made : made_) made.store(true, std::memory_order_relaxed);
  finish(*whole.box, ball_around(builder.leaves()), builder.leaves());
}

WideBvh::WideBvh(std::span<const Ball> balls, Fit fit, unsigned part_level) : WideBvh(balls.size()) {
  SNUG_EXPECT(part_level >= 1);
  unmade_ = std::make_unique<Unmade>();
  unmade_->fit = std::move(fit);
  unmade_->part_level = part_level;
  Point3 lower = balls[0].centre, upper = lower;
  for (const Ball& ball : balls) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], ball.centre[k]);
      upper[k] = std::max(upper[k], ball.centre[k]);
    }
  }
  const Point3 origin = unmade_->origin = lower + 0.5 * (upper - lower);
  const double rounding = 16 * unit_roundoff * (max_abs(origin - Point3{}) + max_abs(upper - lower));
  unmade_->items.reserve(balls.size());
  for (const Ball& ball : balls) {
    const Vector3 from = ball.centre - origin;
    Item item{{}, 0, static_cast<std::uint32_t>(unmade_->items.size())};
    double moved = rounding;
    for (std::size_t k = 0; k < 3; ++k) {
      item.centre[k] = static_cast<float>(from[k]);
      moved += std::fabs(from[k] - static_cast<double>(item.centre[k]));
    }
    item.radius = static_cast<float>((ball.radius + moved) * (1 + 0x1p-22) + 0x1p-120);
    unmade_->reach = std::max(unmade_->reach, max_abs(from) + static_cast<double>(item.radius));
    unmade_->items.push_back(item);
  }
  // Two levels, for a k-DOP that is not too large.
  std::vector<Obb> parts{unmade_->box_around(unmade_->items)};
  const Obb box = parts[0];
  for (unsigned level = whole().level; level > part_level && level + 2 > whole().level; --level) {
    std::vector<Obb> finer;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const std::vector<Obb> children = open({level, i});
      finer.insert(finer.end(), children.begin(), children.end());
    }
    parts = std::move(finer);
  }
  finish(box, unmade_->ball_around_all(), parts);
}

WideBvh WideBvh::in_order(std::span<const Point3> centres, int threads) {
  WideBvh tree(centres.size());
  std::vector<Item> items = items_at(centres);
  tree.sort(tree.whole(), items, threads);
  return tree;
}

WideBvh WideBvh::in_order_of(const WideBvh& other) {
  WideBvh tree(other.items_.size());
  tree.items_ = other.items_;
  return tree;
}

WideBvh::LeafRange WideBvh::leaves_of(std::uint32_t name) const {
  const Subtree of = subtree(name);
  const std::size_t begin = of.number * leaves_of_level(of.level);
  return {begin, begin + leaves_below(of)};
}

// Level by level. A box is fitted to those two levels below it, which are tighter than those between.
void WideBvh::refit(std::span<const Obb> leaves, std::span<const Axes> axes) {
  SNUG_EXPECT(leaves.size() == leaf_count() && (axes.empty() || axes.size() == nodes_.size()) && !unmade_);
  node_boxes_.resize(nodes_.size());
  const std::span<Obb> boxes = node_boxes_;
  std::span<const Obb> below = leaves, two_below = leaves;
  std::size_t per_box = WideNode::width;  // of those two below
  for (unsigned level = 1; level <= whole().level; ++level) {
    const std::size_t count = (below.size() + WideNode::width - 1) / WideNode::width;
    const std::span<Obb> parents = boxes.subspan(begins_[level], count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t first = i * WideNode::width;
      keep({level, i}, below.subspan(first, std::min(WideNode::width, below.size() - first)));
      const std::size_t from = i * per_box;
      const std::span<const Obb> around = two_below.subspan(from, std::min(per_box, two_below.size() - from));
      parents[i] = axes.empty() ? merge(around) : merge(around, axes[begins_[level] + i]);
    }
    two_below = below;
    below = parents;
    per_box = WideNode::width * WideNode::width;
  }
  finish_refit(leaves);
}

// The ball's centre, a choice, from few boxes, its radius from all.
void WideBvh::finish_refit(std::span<const Obb> leaves) {
  constexpr std::size_t few = 64;
  std::span<const Obb> coarse = leaves;
  unsigned level = 0;
  while (coarse.size() > few && level < whole().level) {
    ++level;
    const std::size_t end = level == whole().level ? nodes_.size() : begins_[level + 1];
    coarse = std::span<const Obb>(node_boxes_).subspan(begins_[level], end - begins_[level]);
  }
  const Ball ball =
      leaves.size() > few ? ball_around(leaves, ball_around(coarse).centre) : ball_around(leaves);
  finish(nodes_.empty() ? leaves[0] : node_boxes_.back(), ball, leaves.size() > few ? coarse : leaves);
}

void WideBvh::finish(const Obb& box, const Ball& ball, std::span<const Obb> parts) {
  box_ = box;
  ball_ = ball;
  dop_ = Dop26(parts, box_.centre);
  set_root();
}

void WideBvh::set_root() { root_ = WideNode(std::span(&box_, 1), std::span(&whole_, 1)); }

void WideBvh::narrow(std::span<const Point3> hull) {
  dop_.narrow(hull);
  std::array<Extent, 3> extents;
  double largest = 0, radius_sq = 0;
  for (const Point3& point : hull) {
    for (std::size_t k = 0; k < 3; ++k) extents[k].add(dot(box_.axes[k], point - Point3{}));
    largest = std::max(largest, max_abs(point - Point3{}));
    radius_sq = std::max(radius_sq, length_sq(point - ball_.centre));
  }
  // Squares of what is shorter lose digits to the end of the range.
  const double radius = enlarged(std::sqrt(radius_sq)) + 0x1p-480;
  ball_.radius = std::min(ball_.radius, radius);
  // Products and sums of three, and what axes lack of their length.
  const double error = 64 * unit_roundoff * largest + 16 * underflow_error;
  const bool known = std::isfinite(box_.half.x + box_.half.y + box_.half.z);
  for (std::size_t k = 0; k < 3; ++k) {
    extents[k] = {extents[k].lower - error, extents[k].upper + error};
    if (!known) continue;
    const double middle = dot(box_.axes[k], box_.centre - Point3{}),
                 off = 64 * unit_roundoff * (max_abs(box_.centre - Point3{}) + box_.half[k]);
    extents[k].lower = std::max(extents[k].lower, middle - box_.half[k] - off);
    extents[k].upper = std::min(extents[k].upper, middle + box_.half[k] + off);
  }
  box_ = box_of(box_.axes, extents);
  set_root();
}

WideBvh::Subtree WideBvh::subtree(std::uint32_t name) const {
  unsigned level = whole().level;
  while (begins_[level] > name) --level;
  return {level, name - begins_[level]};
}

std::uint32_t WideBvh::name_of(Subtree of) const {
  return of.level == 0 ? static_cast<std::uint32_t>(of.number) | leaf_bit
                       : begins_[of.level] + static_cast<std::uint32_t>(of.number);
}

std::size_t WideBvh::leaves_below(Subtree of) const {
  const std::size_t leaves = leaves_of_level(of.level);
  return std::min(leaves, leaf_count() - of.number * leaves);
}

std::span<WideBvh::Item> WideBvh::items_below(Subtree of, std::span<Item> all) const {
  const std::size_t items = leaves_of_level(of.level) * leaf_size, first = of.number * items;
  return all.subspan(first, std::min(items, all.size() - first));
}

// Down to the leaves.
void WideBvh::sort(Subtree of, std::span<Item> all, int threads) const {
  const std::span<Item> items = items_below(of, all);
  if (of.level > 1) {
    const std::size_t parts = split_by_eight(items, leaves_of_level(of.level - 1) * leaf_size).size();
    parallel_for(parts, items.size() > 4096 ? threads : 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) sort({of.level - 1, of.number * 8 + i}, all, 1);
    });
    return;
  }
  if (of.level == 1) split_by_eight(items, leaf_size);
  const auto first = static_cast<std::size_t>(items.data() - all.data());
  for (std::size_t i = 0; i < items.size(); ++i) items_[first + i] = items[i].number;
}

// The nodes of a whole subtree, from what its leaves are fitted to upwards.
WideBvh::Fitted WideBvh::fit_upwards(Subtree of, int threads, const Fit& fit) const {
  const std::size_t first_leaf = of.number * leaves_of_level(of.level);
  std::vector<std::vector<Obb>> parts(leaves_below(of));
  Fitted result;
  result.leaves.resize(parts.size());
  parallel_for(parts.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      fit(first_leaf + i, leaf(first_leaf + i), parts[i]);
      result.leaves[i] = parts[i].size() == 1 ? parts[i][0] : merge(parts[i]);
    }
  });
  std::vector<std::size_t> ends;  // among those below, of each box
  for (const std::vector<Obb>& part : parts) {
    result.below.insert(result.below.end(), part.begin(), part.end());
    ends.push_back(result.below.size());
  }
  std::vector<Obb> boxes = result.leaves;
  for (unsigned level = 1; level <= of.level; ++level) {
    const std::size_t count = (boxes.size() + WideNode::width - 1) / WideNode::width,
                      first_node = first_leaf / leaves_of_level(level);
    std::vector<Obb> parents(count);
    std::vector<std::size_t> parent_ends(count);
    parallel_for(count, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const std::size_t first = i * WideNode::width, n = std::min(WideNode::width, boxes.size() - first);
        const std::size_t from = first == 0 ? 0 : ends[first - 1];
        parent_ends[i] = ends[first + n - 1];
        parents[i] = merge(std::span(result.below).subspan(from, parent_ends[i] - from));
        keep({level, first_node + i}, std::span(boxes).subspan(first, n));
      }
    });
    boxes = std::move(parents);
    ends = std::move(parent_ends);
  }
  return result;
}

// A node by what is known of its items before they are fitted.
std::vector<Obb> WideBvh::open(Subtree of) const {
  std::vector<Obb> boxes;
  for (const std::span<Item> part :
       split_by_eight(items_below(of, unmade_->items), leaves_of_level(of.level - 1) * leaf_size)) {
    boxes.push_back(unmade_->box_around(part));
  }
  keep(of, boxes);
  return boxes;
}

void WideBvh::make(std::uint32_t name) const {
  const std::lock_guard lock(unmade_->locks[name % unmade_->locks.size()]);
  if (made_[name].load(std::memory_order_relaxed)) return;
  const Subtree of = subtree(name);
  if (of.level > unmade_->part_level) {
    open(of);
  } else {
    sort(of, unmade_->items, 1);
    fit_upwards(of, 1, unmade_->fit);
  }
}

void WideBvh::keep(Subtree of, std::span<const Obb> boxes) const {
  std::array<std::uint32_t, WideNode::width> names;
  for (std::size_t i = 0; i < boxes.size(); ++i) names[i] = name_of({of.level - 1, of.number * 8 + i});
  const std::uint32_t name = name_of(of);
  nodes_[name] = WideNode(boxes, std::span(names).first(boxes.size()));
  made_[name].store(true, std::memory_order_release);
}

std::span<const std::uint32_t> WideBvh::leaf(std::size_t i) const {
  const std::size_t begin = i * leaf_size;
  return std::span(items_).subspan(begin, std::min(leaf_size, items_.size() - begin));
}

std::size_t WideBvh::bytes() const {
  return nodes_.capacity() * (sizeof(WideNode) + 1) + node_boxes_.capacity() * sizeof(Obb) +
         items_.capacity() * sizeof(std::uint32_t) + (unmade_ ? unmade_->items.capacity() * sizeof(Item) : 0);
}

}  // namespace snug
