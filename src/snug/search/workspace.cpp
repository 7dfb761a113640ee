#include <snug/search/workspace.h>

#include <algorithm>

namespace snug {
namespace {

constexpr std::uint32_t none = UINT32_MAX;
constexpr std::size_t max_bytes = std::size_t{256} << 20;

}  // namespace

SurfaceWorkspace::SurfaceWorkspace(const SurfaceBvh& model)
    : model_(&model), pieces_(model.surface(), model.method()), of_leaf_(model.tree().leaf_count(), none) {}

std::size_t SurfaceWorkspace::bytes() const {
  return pieces_.bytes() + piece_nodes_.bytes() + extents_.capacity() * sizeof(KnownExtent) +
         facts_.capacity() * sizeof(Facts) +
         (of_leaf_.capacity() + of_piece_.capacity() + stamps_.capacity()) * sizeof(std::uint32_t);
}

void SurfaceWorkspace::begin() {
  touched_ = 0;
  if (++query_ == 0 || bytes() > max_bytes) {
    pieces_.clear();
    piece_nodes_.clear();
    facts_.clear();
    std::fill(of_leaf_.begin(), of_leaf_.end(), none);
    of_piece_.clear();
    stamps_.clear();
    query_ = 1;
  }
}

SurfaceWorkspace::Opened SurfaceWorkspace::opened(std::uint32_t node) {
  if (stamps_[node] != query_) {
    stamps_[node] = query_;
    ++touched_;
  }
  return {piece_nodes_, node, true};
}

std::uint32_t SurfaceWorkspace::add_node(std::span<const PieceId> pieces) {
  std::array<Obb, WideNodes::width> boxes;
  std::array<std::uint32_t, WideNodes::width> names;
  Facts facts{};
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    boxes[i] = pieces_.box(pieces[i]);
    names[i] = pieces[i].value();
    // Rounded to nearest, then up by more than that.
    facts.radii[i] = static_cast<float>(pieces_[pieces[i]].offset.radius) * (1 + 0x1p-22F) + 0x1p-120F;
    if (pieces_.can_split(pieces[i])) facts.can_split |= static_cast<std::uint8_t>(1u << i);
  }
  facts_.push_back(facts);
  stamps_.push_back(0);
  return piece_nodes_.add(std::span(boxes).first(pieces.size()), std::span(names).first(pieces.size()));
}

SurfaceWorkspace::Opened SurfaceWorkspace::open(Node node) {
  std::array<PieceId, WideNodes::width> pieces;
  if (node.piece) {
    const std::size_t id = piece(node).index();
    if (id >= of_piece_.size()) of_piece_.resize(pieces_.size(), none);
    if (of_piece_[id] == none) {
      const PieceId first = pieces_.split(PieceId(id));
      for (std::size_t i = 0; i < 4; ++i) pieces[i] = PieceId(first.index() + i);
      of_piece_[id] = add_node(std::span(pieces).first(4));
    }
    return opened(of_piece_[id]);
  }
  const WideNodes& nodes = model_->tree().nodes();
  const std::uint32_t name = nodes.name(node.child());
  if ((name & WideBvh::leaf_bit) == 0) return {nodes, name, false};
  const std::size_t leaf = name & ~WideBvh::leaf_bit;
  if (of_leaf_[leaf] == none) {
    const std::span<const std::uint32_t> items = model_->tree().leaf(leaf);
    for (std::size_t i = 0; i < items.size(); ++i) pieces[i] = pieces_.root(model_->patch(items[i]));
    of_leaf_[leaf] = add_node(std::span(pieces).first(items.size()));
  }
  return opened(of_leaf_[leaf]);
}

}  // namespace snug
