#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <snug/geometry/motion.h>
#include <snug/search/piece_cache.h>
#include <snug/search/surface_bvh.h>

namespace snug {

/// A box in a surface's tree: of the tree itself, or around a piece that queries made.
struct Node {
  std::uint32_t parent;
  std::uint8_t place;
  bool piece;
  [[nodiscard]] Child child() const { return {parent, place}; }
};

/// What queries have touched of one surface: its pieces, and their boxes in nodes. One a thread. Dropped
/// between two queries when it has grown beyond 256 MiB.
/// Guarantee: a node opens to the same boxes whatever came before: no answer depends on earlier queries.
class SurfaceWorkspace {
 public:
  explicit SurfaceWorkspace(const SurfaceBvh& model);

  [[nodiscard]] const SurfaceBvh& model() const { return *model_; }
  [[nodiscard]] std::size_t bytes() const;

  /// For queries: to be called first.
  void begin();
  [[nodiscard]] Node root() const { return {model_->tree().root().parent, 0, false}; }
  [[nodiscard]] const WideNodes& nodes(bool of_pieces) const {
    return of_pieces ? piece_nodes_ : model_->tree().nodes();
  }
  [[nodiscard]] PieceId piece(Node node) const { return PieceId(piece_nodes_.name(node.child())); }
  [[nodiscard]] PieceCache& pieces() { return pieces_; }
  /// False for a piece that cannot be split.
  [[nodiscard]] bool can_open(Node node) const {
    return !node.piece || (facts_[node.parent].can_split >> node.place & 1u) != 0;
  }
  /// Does a node open to pieces?
  [[nodiscard]] bool opens_to_pieces(Node node) const {
    return node.piece || (model_->tree().nodes().name(node.child()) & WideBvh::leaf_bit) != 0;
  }
  /// Upper bound of the radius of a piece's offset triangle.
  [[nodiscard]] float radius(Node node) const { return facts_[node.parent].radii[node.place]; }
  /// What a node opens to, made if need be: the children of a node of pieces or of the tree.
  struct Opened {
    const WideNodes& nodes;
    std::uint32_t parent;
    bool pieces;
    [[nodiscard]] std::size_t count() const { return nodes.count(parent); }
    [[nodiscard]] Node child(std::size_t place) const {
      return {parent, static_cast<std::uint8_t>(place), pieces};
    }
  };
  /// Requires:  can_open(node).
  [[nodiscard]] Opened open(Node node);

  /// How far a piece reaches along the direction that a query looks along; NaN where that is not yet known.
  [[nodiscard]] double& extent(PieceId id) {
    if (id.index() >= extents_.size()) extents_.resize(id.index() + 1, {0, 0});
    KnownExtent& known = extents_[id.index()];
    if (known.direction != direction_) known = {NAN, direction_};
    return known.extent;
  }
  /// The query looks along another direction: no extent is known.
  void forget_extents() { ++direction_; }

  /// Has the query opened as many different nodes of pieces as one may? Bounds its memory.
  [[nodiscard]] bool full() const { return touched_ >= 50'000; }

 private:
  // What is asked for most of the pieces in a node.
  struct Facts {
    std::array<float, WideNodes::width> radii;
    std::uint8_t can_split;
  };

  struct KnownExtent {
    double extent;
    std::uint64_t direction;
  };

  std::uint32_t add_node(std::span<const PieceId> pieces);
  Opened opened(std::uint32_t node);

  const SurfaceBvh* model_;
  PieceCache pieces_;
  WideNodes piece_nodes_;
  std::vector<Facts> facts_;          // of piece_nodes_
  std::vector<KnownExtent> extents_;  // of pieces
  std::uint64_t direction_ = 1;
  // The nodes that leaves and pieces open to; `none` where not opened.
  std::vector<std::uint32_t> of_leaf_, of_piece_;
  std::vector<std::uint32_t> stamps_;  // of piece_nodes_: the query that opened them last
  std::uint32_t query_ = 0;
  std::size_t touched_ = 0;
};

/// A surface where a query is to see it.
struct PlacedBvh {
  const SurfaceBvh& model;
  SurfaceWorkspace& scratch;  ///< of this model and of no other one in the same query
  Motion pose;
};

}  // namespace snug
