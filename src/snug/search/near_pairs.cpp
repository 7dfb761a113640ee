#include <snug/search/near_pairs.h>

#include <algorithm>
#include <bit>
namespace snug {
namespace {

// Beyond, in units of a surface that is about 2 large, a walk passes over too little.
constexpr float max_doubt = 0x1p-7F;

}  // namespace

NearPairs::NearPairs(PairFrames& frames, SearchStats& stats, double distance)
    : stats_(stats), model_{&frames.cache(0).model(), &frames.cache(1).model()} {
  for (std::size_t s = 0; s < 2; ++s) {
    const RelativeFrame& seen = frames.seen_from(s);
    usable_ = usable_ && seen.comparable;
    if (!usable_) return;
    view_[s] = TreeView(seen);
    distance_[s] = static_cast<float>(distance * seen.from_world);
    // Rounded down: by one rounding of the factor and two of products.
    to_query_[s] = static_cast<float>(seen.to_world) * (1 - 4 * 0x1p-24F);
    usable_ = usable_ && view_[s].doubt(2) < max_doubt;
    stack_[0][s] = {&model_[s]->tree().root(), 0, none};
  }
  ratio_ = view_[0].scale;
  waiting_ = 1;
}

bool NearPairs::next(NodePair& pair) {
  while (waiting_ > 0) {
    Names names = pop();
    bool near = true;
    while (near) {
      const Name &a = names[0], &b = names[1];
      if (a.is_patch() && b.is_patch()) {
        pair = {{a.node(), b.node()}, 0};
        return true;
      }
      // The larger one, so that no large box is compared with many small ones.
      near = open(names, b.is_patch() || (!a.is_patch() && a.size() >= ratio_ * b.size()) ? 0 : 1);
    }
  }
  return false;
}

void NearPairs::push_beyond(const Names& pair) {
  more_.push_back(pair);
  ++waiting_;
}

NearPairs::Names NearPairs::pop() {
  --waiting_;
  if (waiting_ < stack_.size()) return stack_[waiting_];
  const Names pair = more_.back();
  more_.pop_back();
  return pair;
}

bool NearPairs::open(Names& pair, std::size_t side) {
  const SurfaceBvh& model = *model_[side];
  const Name mine = pair[side], other = pair[1 - side];
  const std::uint32_t name = static_cast<const TreeNode*>(mine.boxes)->names[mine.place];
  const WideNode* boxes;
  std::uint32_t leaf = none;
  if ((name & WideBvh::leaf_bit) == 0) {
    boxes = &model.tree().node(name);
  } else {
    leaf = name & ~WideBvh::leaf_bit;
    boxes = &model.leaf(leaf);
  }
  stats_.box_tests += boxes->count();
  const kernels::Deepest near = boxes->near_boxes(*other.boxes, other.place, view_[side], distance_[side]);
  // Less what products lose where they underflow.
  others_ = std::min(others_, near.others * to_query_[side] - 0x1p-125F);
  if (near.places == 0) return false;
  for (std::uint32_t rest = near.places & ~(1u << near.deepest); rest != 0; rest &= rest - 1) {
    Names waiting;
    waiting[side] = {boxes, static_cast<std::uint32_t>(std::countr_zero(rest)), leaf};
    waiting[1 - side] = other;
    push(waiting);
  }
  pair[side] = {boxes, near.deepest, leaf};
  return true;
}

}  // namespace snug
