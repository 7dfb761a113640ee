#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bvh/walk_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include <snug/bvh/box_gaps-inl.h>
#include <snug/bvh/walk_kernel.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// The boxes that may be within a distance, a bit each; the one that overlaps most deeply; the least gap of the others.
struct Deepest {
  std::uint32_t places, deepest;
  float others;
};

// The boxes of a node against a box of the other tree, all placed in single precision.
HWY_INLINE Deepest compare(const WalkedTree& tree, const NodeBoxes& node, const WalkedBox& other) {
  const std::uint32_t all = (1u << node.box_count) - 1;
  const TreeView& view = tree.view;
  const float* const column = other.boxes->rows + other.place;
  const double* const origin = other.boxes->reference;
  const float from[3] = {static_cast<float>(node.reference[0]), static_cast<float>(node.reference[1]),
                         static_cast<float>(node.reference[2])};
  const float to[3] = {static_cast<float>(origin[0]), static_cast<float>(origin[1]),
                       static_cast<float>(origin[2])};
  // The other box, less this node's origin.
  const hn::CappedTag<float, 4> d4;
  HWY_ALIGN float placed[4][4];
  for (std::size_t at = 0; at < 4; at += hn::Lanes(d4)) {
    const auto turned = [&](float x, float y, float z) HWY_ATTR {
      return hn::Add(hn::Add(hn::Mul(hn::Load(d4, view.columns[0] + at), hn::Set(d4, x)),
                             hn::Mul(hn::Load(d4, view.columns[1] + at), hn::Set(d4, y))),
                     hn::Mul(hn::Load(d4, view.columns[2] + at), hn::Set(d4, z)));
    };
    hn::Store(hn::Add(turned(column[0] + to[0], column[8] + to[1], column[16] + to[2]),
                      hn::Load(d4, view.translation + at)),
              d4, placed[3] + at);
    for (std::size_t k = 0; k < 3; ++k) {
      const float* const axis = column + 8 * (6 + 3 * k);
      hn::Store(hn::Mul(turned(axis[0], axis[8], axis[16]), hn::Set(d4, view.inverse_scale)), d4,
                placed[k] + at);
    }
  }
  float centre[3], half[3];
  float own = node.reach, others = other.boxes->reach;
  for (std::size_t k = 0; k < 3; ++k) {
    own += std::fabs(from[k]);
    others += std::fabs(to[k]);
    centre[k] = placed[3][k] - from[k];
    half[k] = view.scale * column[8 * (3 + k)];
  }
  const float size = own + 2 * view.scale * others + view.reach;
  // NaN counts as near.
  if (!(size < 1e18F)) return {all, 0, INFINITY};
  const float doubt = walk_roundings * size + view.slack, limit = tree.distance + doubt;
  const Tag d;
  const auto row = [&](std::size_t r) {
    return hn::Set(d, r < 3 ? centre[r] : r < 6 ? half[r - 3] : placed[(r - 6) / 3][r % 3]);
  };
  HWY_ALIGN float found[8];
  Near near{0, INFINITY};
  for (std::size_t at = 0; at < 8; at += hn::Lanes(d)) {
    store(gaps<false>(node.rows, at, row, hn::Zero(d), limit), limit, at, found, near);
  }
  const std::uint32_t places = near.places & all;
  // The least of no gaps is not the same on every instruction set.
  Deepest result{places, 0, places == all ? INFINITY : near.others - doubt};
  float least = INFINITY;
  for (std::uint32_t rest = places; rest != 0; rest &= rest - 1) {
    const auto p = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (found[p] < least) least = found[p], result.deepest = p;
  }
  return result;
}

Walk::Halt walk_on(Walk& walk) {
  const float ratio = walk.trees[0].view.scale;
  WalkedPair* top = walk.waiting + walk.waiting_count;
  WalkedPair* const room = walk.waiting + walk.capacity - node_width;
  const auto halt = [&](Walk::Halt why) {
    walk.waiting_count = static_cast<std::size_t>(top - walk.waiting);
    walk.has_pair = why != Walk::Halt::end && why != Walk::Halt::patches;
    return why;
  };
  WalkedPair pair = walk.at_hand;
  if (!walk.has_pair) {
    if (top == walk.waiting) return halt(Walk::Halt::end);
    pair = *--top;
  }
  for (;;) {
    const WalkedBox &a = pair[0], &b = pair[1];
    if (a.is_patch() && b.is_patch()) {
      walk.at_hand = pair;
      return halt(Walk::Halt::patches);
    }
    // The larger one is opened, so that no large box is compared with many small ones.
    const bool first =
        b.is_patch() || (!a.is_patch() && a.boxes->sizes[a.place] >= ratio * b.boxes->sizes[b.place]);
    const std::size_t side = first ? 0 : 1;
    const WalkedTree& tree = walk.trees[side];
    const WalkedBox mine = pair[side], other = pair[1 - side];
    const std::uint32_t name = mine.boxes->names[mine.place];
    std::uint32_t leaf = WalkedBox::not_patch;
    const NodeBoxes* node;
    if ((name & leaf_bit) != 0) {
      leaf = name & ~leaf_bit;
      node = tree.leaves[leaf].load(std::memory_order_acquire);
    } else {
      node = tree.made[name].load(std::memory_order_acquire) ? tree.nodes + name : nullptr;
    }
    if (node == nullptr || top > room) {
      walk.at_hand = pair;
      walk.side = side;
      walk.name = name;
      return halt(node == nullptr ? Walk::Halt::not_made : Walk::Halt::full);
    }
    const Deepest near = compare(tree, *node, other);
    walk.box_tests += node->box_count;
    // Less what products lose where they underflow.
    walk.others = std::min(walk.others, near.others * tree.to_query - 0x1p-125F);
    if (near.places == 0) {
      if (top == walk.waiting) return halt(Walk::Halt::end);
      pair = *--top;
      continue;
    }
    for (std::uint32_t rest = near.places & ~(1u << near.deepest); rest != 0; rest &= rest - 1, ++top) {
      (*top)[side] = {node, static_cast<std::uint32_t>(std::countr_zero(rest)), leaf};
      (*top)[1 - side] = other;
    }
    pair[side] = {node, near.deepest, leaf};
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(walk_on);

Walk::Halt go_on(Walk& walk) { return HWY_DYNAMIC_DISPATCH(walk_on)(walk); }

}  // namespace snug::kernels
#endif
