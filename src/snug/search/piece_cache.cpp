#include <snug/search/piece_cache.h>

#include <algorithm>

namespace snug {
namespace {

SplitNode split_node(const SurfaceBvh& model, const Patch& parent) {
  thread_local std::array<Patch, 4> children;
  split_into_four(parent, children);
  std::array<PieceBuild, 4> pieces;
  build_pieces(model.surface().library(), children, model.method(), pieces);
  return SplitNode(pieces);
}

}  // namespace

PieceCache::Roots::Place& PieceCache::Roots::place_of(std::uint32_t patch) {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = (patch * 0x9e3779b97f4a7c15u >> 32) & mask;
  while (places_[at].round == round_ && places_[at].patch != patch) at = (at + 1) & mask;
  return places_[at];
}

std::uint32_t& PieceCache::Roots::operator[](std::uint32_t patch) {
  if (2 * (count_ + 1) > places_.size()) {
    std::vector<Place> old(std::max<std::size_t>(64, 2 * places_.size()));
    old.swap(places_);
    for (const Place& place : old) {
      if (place.round == round_) place_of(place.patch) = place;
    }
  }
  Place& place = place_of(patch);
  if (place.round != round_) {
    place = {patch, round_, none};
    ++count_;
  }
  return place.entry;
}

void PieceCache::Roots::clear() {
  count_ = 0;
  if (++round_ == 0) *this = {};
}

void PieceCache::Known::forget() {
  roots.clear();
  splits.forget();
  entries.forget();
  offsets.forget();
}

std::size_t PieceCache::bytes() const {
  return known_.bytes() + open_nodes_.bytes() + open_pairs_.bytes() + open_rays_.bytes();
}

void PieceCache::begin(std::size_t max_bytes) {
  touched_ = 0;
  if (++query_ == 0 || bytes() > max_bytes) {
    known_ = {};
    open_nodes_ = {};
    open_pairs_ = {};
    open_rays_ = {};
    query_ = 1;
  }
}

void PieceCache::renew(const SurfaceBvh& model) {
  model_ = &model;
  known_.forget();
}

template <class Make>
std::uint32_t PieceCache::add(PatchId root, const Make& make) {
  Entry& entry = known_.entries.add();
  const std::size_t before = entry.patch.points.capacity();
  entry.root = root;
  make(entry.patch);
  entry.children.fill(none);
  entry.offset = entry.split = none;
  known_.bytes_of_points += (entry.patch.points.capacity() - before) * sizeof(Vector3);
  return static_cast<std::uint32_t>(known_.entries.size() - 1);
}

std::uint32_t PieceCache::root_entry(PatchId root) {
  std::uint32_t& entry = known_.roots[root.value()];
  if (entry == none) entry = add(root, [&](Patch& patch) { model_->surface().patch(root, patch); });
  return entry;
}

std::uint32_t PieceCache::child_entry(std::uint32_t parent, unsigned child) {
  const Entry& whole = known_.entries[parent];
  if (whole.children[child] != none) return whole.children[child];
  const std::uint32_t made = add(whole.root, [&](Patch& patch) { split(whole.patch, child, patch); });
  known_.entries[parent].children[child] = made;
  return made;
}

std::uint32_t PieceCache::entry_of(const Node& node) {
  if (node.kind == Node::Kind::patch) return root_entry(model_->patch(node.owner, node.place));
  return child_entry(known_.splits[node.owner].parent, node.place);
}

std::uint32_t PieceCache::entry_of(const PieceName& name) {
  std::uint32_t entry = root_entry(name.patch);
  for (unsigned k = 0; k < name.path.level(); ++k) entry = child_entry(entry, name.path.digit(k));
  return entry;
}

PieceName PieceCache::name(const Node& node) {
  if (node.kind == Node::Kind::patch) return {model_->patch(node.owner, node.place), {}};
  const Entry& parent = known_.entries[known_.splits[node.owner].parent];
  return {parent.root, parent.patch.path.child(node.place)};
}

const OffsetTriangle& PieceCache::offset_of_entry(std::uint32_t i) {
  Entry& entry = known_.entries[i];
  if (entry.offset == none) {
    const BoundMethod method = always_rows_ ? BoundMethod::rows : model_->method();
    known_.offsets.add() = offset_of(model_->surface().library(), entry.patch, points_, method);
    entry.offset = static_cast<std::uint32_t>(known_.offsets.size() - 1);
  }
  return known_.offsets[entry.offset];
}

PieceCache::Opened PieceCache::open(const Node& node) {
  if (node.kind == Node::Kind::tree) {
    const std::uint32_t name = node.boxes->names[node.place];
    if ((name & WideBvh::leaf_bit) == 0) return {&model_->tree().node(name), Node::Kind::tree, 0};
    const std::uint32_t leaf = name & ~WideBvh::leaf_bit;
    return {&model_->leaf(leaf), Node::Kind::patch, leaf};
  }
  const std::uint32_t parent = entry_of(node);
  Entry& whole = known_.entries[parent];
  if (whole.split == none) {
    const Split made{split_node(*model_, whole.patch), parent, 0};
    known_.splits.add() = made;
    whole.split = static_cast<std::uint32_t>(known_.splits.size() - 1);
  }
  Split& split = known_.splits[whole.split];
  if (split.query != query_) {
    split.query = query_;
    ++touched_;
  }
  return {&split.pieces, Node::Kind::piece, whole.split};
}

}  // namespace snug
