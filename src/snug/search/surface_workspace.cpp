#include <snug/search/surface_workspace.h>

#include <algorithm>

namespace snug {
namespace {

constexpr std::size_t max_bytes = std::size_t{256} << 20;

SplitNode split_node(const SurfaceBvh& model, const Patch& parent) {
  thread_local Patch child;
  std::array<PieceBuild, 4> pieces;
  for (unsigned i = 0; i < 4; ++i) {
    split(parent, i, child);
    pieces[i] = build_piece(model.surface().library(), child, model.method());
  }
  return SplitNode(pieces);
}

}  // namespace

SurfaceWorkspace::Roots::Place& SurfaceWorkspace::Roots::place_of(std::uint32_t patch) {
  const std::size_t mask = places_.size() - 1;
  std::size_t at = (patch * 0x9e3779b97f4a7c15u >> 32) & mask;
  while (places_[at].round == round_ && places_[at].patch != patch) at = (at + 1) & mask;
  return places_[at];
}

SurfaceWorkspace::Root& SurfaceWorkspace::Roots::operator[](std::uint32_t patch) {
  if (2 * (count_ + 1) > places_.size()) {
    std::vector<Place> old(std::max<std::size_t>(64, 2 * places_.size()));
    old.swap(places_);
    for (const Place& place : old) {
      if (place.round == round_) place_of(place.patch) = place;
    }
  }
  Place& place = place_of(patch);
  if (place.round != round_) {
    place = {patch, round_, {}};
    ++count_;
  }
  return place.root;
}

void SurfaceWorkspace::Roots::clear() {
  count_ = 0;
  if (++round_ == 0) *this = {};
}

std::size_t SurfaceWorkspace::bytes() const {
  return splits_.size() * sizeof(Split) + patches_.size() * sizeof(Patch) + bytes_of_points_ +
         roots_.bytes() + waiting_.capacity() * sizeof(NodeGap);
}

void SurfaceWorkspace::begin() {
  touched_ = 0;
  if (++query_ == 0 || bytes() > max_bytes) {
    roots_ = {};
    splits_.clear();
    patches_.clear();
    split_count_ = patch_count_ = 0;
    bytes_of_points_ = 0;
    query_ = 1;
  }
}

void SurfaceWorkspace::renew(const SurfaceBvh& model) {
  model_ = &model;
  roots_.clear();
  split_count_ = patch_count_ = 0;
}

Patch& SurfaceWorkspace::next_patch() {
  if (patch_count_ == patches_.size()) patches_.emplace_back();
  return patches_[patch_count_];
}

std::uint32_t SurfaceWorkspace::patch_place(const Node& node) {
  const bool whole = node.kind == Node::Kind::patch;
  std::uint32_t& place =
      whole ? roots_[root_of(node).value()].patch : splits_[node.owner].patches[node.place];
  if (place == none) {
    Patch& next = next_patch();
    const std::size_t before = next.points.capacity();
    if (whole) {
      model_->surface().patch(root_of(node), next);
    } else {
      split(patches_[splits_[node.owner].parent], node.place, next);
    }
    bytes_of_points_ += (next.points.capacity() - before) * sizeof(Vector3);
    place = static_cast<std::uint32_t>(patch_count_++);
  }
  return place;
}

const Patch& SurfaceWorkspace::patch(const Node& node) { return patches_[patch_place(node)]; }

Piece SurfaceWorkspace::piece(const Node& node) {
  return make_piece(model_->surface().library(), root_of(node), patch(node), points_, model_->method());
}

std::uint32_t& SurfaceWorkspace::split_place(const Node& node) {
  return node.kind == Node::Kind::patch ? roots_[root_of(node).value()].split
                                        : splits_[node.owner].splits[node.place];
}

SurfaceWorkspace::Opened SurfaceWorkspace::open(const Node& node) {
  if (node.kind == Node::Kind::tree) {
    const std::uint32_t name = static_cast<const TreeNode*>(node.boxes)->names[node.place];
    if ((name & WideBvh::leaf_bit) == 0) return {&model_->tree().node(name), Node::Kind::tree, 0};
    const std::uint32_t leaf = name & ~WideBvh::leaf_bit;
    return {&model_->leaf(leaf), Node::Kind::patch, leaf};
  }
  std::uint32_t place = split_place(node);
  if (place == none) {
    const std::uint32_t parent = patch_place(node);
    const PatchId root = root_of(node);
    const Split made{split_node(*model_, patches_[parent]),
                     root,
                     {none, none, none, none},
                     {none, none, none, none},
                     0,
                     parent};
    if (split_count_ == splits_.size()) {
      splits_.push_back(made);
    } else {
      splits_[split_count_] = made;
    }
    place = static_cast<std::uint32_t>(split_count_++);
    split_place(node) = place;
  }
  Split& split = splits_[place];
  if (split.query != query_) {
    split.query = query_;
    ++touched_;
  }
  return {&split.pieces, Node::Kind::piece, place};
}

}  // namespace snug
