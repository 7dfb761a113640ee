#include <snug/search/near_pairs.h>

#include <algorithm>
#include <utility>

namespace snug {
namespace {

// Beyond, in units of a surface that is about 2 large, a walk passes over too little.
constexpr float max_doubt = 0x1p-7F;

Node patch_at(const kernels::WalkedBox& box) {
  return {static_cast<const WideNode*>(box.boxes), static_cast<std::uint8_t>(box.place), Node::Kind::patch,
          box.leaf};
}

}  // namespace

NearPairs::NearPairs(PairFrames& frames, SearchStats& stats, double distance)
    : stats_(stats), model_{&frames.cache(0).model(), &frames.cache(1).model()} {
  for (std::size_t s = 0; s < 2; ++s) {
    const RelativeFrame& seen = frames.seen_from(s);
    usable_ = usable_ && seen.comparable;
    if (!usable_) return;
    kernels::WalkedTree& tree = walk_.trees[s];
    tree = model_[s]->walked();
    const TreeView view(seen);
    tree.view = view;
    tree.distance = static_cast<float>(distance * seen.from_world);
    // Rounded down: by one rounding of the factor and two of products.
    tree.to_query = static_cast<float>(seen.to_world) * (1 - 4 * 0x1p-24F);
    usable_ = usable_ && view.doubt(2) < max_doubt;
    walk_.at_hand[s] = {&model_[s]->tree().root(), 0, kernels::WalkedBox::not_patch};
  }
  walk_.has_pair = true;
  walk_.waiting = waiting_.data();
  walk_.capacity = waiting_.size();
}

bool NearPairs::next(NodePair& pair) {
  for (;;) {
    const kernels::Walk::Halt why = go_on(walk_);
    const SurfaceBvh& model = *model_[walk_.side];
    switch (why) {
      case kernels::Walk::Halt::patches:
      case kernels::Walk::Halt::end:
        stats_.box_tests += std::exchange(walk_.box_tests, 0);
        if (why == kernels::Walk::Halt::end) return false;
        pair = {{patch_at(walk_.at_hand[0]), patch_at(walk_.at_hand[1])}, 0};
        return true;
      case kernels::Walk::Halt::not_made:
        if ((walk_.name & WideBvh::leaf_bit) != 0) {
          static_cast<void>(model.leaf(walk_.name & ~WideBvh::leaf_bit));
        } else {
          static_cast<void>(model.tree().node(walk_.name));
        }
        break;
      case kernels::Walk::Halt::full:
        make_room();
    }
  }
}

void NearPairs::make_room() {
  std::vector<kernels::WalkedPair> larger(2 * walk_.capacity);
  std::copy_n(walk_.waiting, walk_.waiting_count, larger.begin());
  more_waiting_ = std::move(larger);
  walk_.waiting = more_waiting_.data();
  walk_.capacity = more_waiting_.size();
}

}  // namespace snug
