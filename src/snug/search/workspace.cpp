#include <snug/search/workspace.h>

#include <utility>

namespace snug {
namespace {

constexpr std::size_t max_bytes = std::size_t{256} << 20;

SplitNode split_node(const SurfaceBvh& model, const Patch& parent) {
  thread_local Patch child;
  std::array<PieceSketch, 4> pieces;
  for (unsigned i = 0; i < 4; ++i) {
    split(parent, i, child);
    pieces[i] = sketch(model.surface().library(), child, model.method());
  }
  return SplitNode(pieces);
}

}  // namespace

std::size_t SurfaceWorkspace::bytes() const {
  return splits_.size() * sizeof(Split) + patches_.size() * sizeof(Patch) + bytes_of_points_ +
         roots_.size() * 4 * sizeof(void*);
}

void SurfaceWorkspace::begin() {
  touched_ = 0;
  if (++query_ == 0 || bytes() > max_bytes) {
    roots_.clear();
    splits_.clear();
    patches_.clear();
    bytes_of_points_ = 0;
    query_ = 1;
  }
}

std::uint32_t SurfaceWorkspace::patch_place(const Node& node) {
  const bool whole = node.kind == Node::Kind::patch;
  std::uint32_t& place =
      whole ? roots_[root_of(node).value()].patch : splits_[node.owner].patches[node.place];
  if (place == none) {
    place = static_cast<std::uint32_t>(patches_.size());
    patches_.push_back(whole ? model_->surface().patch(root_of(node))
                             : split(patches_[splits_[node.owner].parent], node.place));
    bytes_of_points_ += patches_.back().points.capacity() * sizeof(Vector3);
  }
  return place;
}

const Patch& SurfaceWorkspace::patch(const Node& node) { return patches_[patch_place(node)]; }

Piece SurfaceWorkspace::piece(const Node& node, HullPoints& scratch) {
  return make_piece(model_->surface().library(), root_of(node), patch(node), scratch, model_->method());
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
    place = static_cast<std::uint32_t>(splits_.size());
    splits_.push_back({split_node(*model_, patches_[parent]),
                       root,
                       {none, none, none, none},
                       {none, none, none, none},
                       0,
                       parent});
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
