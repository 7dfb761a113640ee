#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include <snug/geometry/motion.h>
#include <snug/search/surface_bvh.h>

namespace snug {

/// A box in a surface's tree: of the tree itself, of a leaf, which is a whole patch, or of pieces that a patch
/// was split into.
struct Node {
  enum class Kind : std::uint8_t { tree, patch, piece };
  const WideNode* boxes;
  std::uint8_t place;
  Kind kind;
  std::uint32_t owner;  ///< of patches the leaf, of pieces the split that made them

  [[nodiscard]] bool bounded() const { return kind != Kind::tree; }
  [[nodiscard]] float size() const { return boxes->size_of(place); }
};

/// A node, and a lower bound of how far it is.
struct NodeGap {
  Node node;
  float gap;
};

/// Extents of the latest pieces, by a hash of the piece, each along a direction that has a number of its own.
class KnownExtents {
 public:
  [[nodiscard]] std::uint64_t next_direction() { return ++last_direction_; }
  /// The extent of a piece along a direction: make(), unless it is known.
  template <class Make>
  [[nodiscard]] double of(const Node& node, std::uint64_t direction, const Make& make) {
    const auto hash = (reinterpret_cast<std::uintptr_t>(node.boxes) >> 6) * 5 + node.place;
    Known& known = known_[hash % known_.size()];
    if (known.boxes != node.boxes || known.place != node.place || known.direction != direction) {
      known = {node.boxes, node.place, direction, make()};
    }
    return known.extent;
  }

 private:
  struct Known {
    const WideNode* boxes = nullptr;
    std::uint32_t place = 0;
    std::uint64_t direction = 0;
    double extent = 0;
  };
  std::array<Known, 128> known_{};
  std::uint64_t last_direction_ = 0;
};

/// Pieces of one surface that queries have split. One a thread. Dropped between two queries when it has grown beyond
/// 256 MiB.
/// Guarantee: a node opens to the same boxes whatever came before: no answer depends on earlier queries.
class SurfaceWorkspace {
 public:
  /// A query splits at most this many different pieces, which bounds its memory.
  explicit SurfaceWorkspace(const SurfaceBvh& model, std::size_t max_pieces = 50'000)
      : model_(&model), max_pieces_(max_pieces) {}

  [[nodiscard]] const SurfaceBvh& model() const { return *model_; }
  [[nodiscard]] std::size_t bytes() const;

  /// For queries: to be called first.
  void begin();
  /// Forgets all that was split, when the surface has moved. Keeps its memory.
  void renew(const SurfaceBvh& model);
  [[nodiscard]] Node root() const { return {&model_->tree().root(), 0, Node::Kind::tree, 0}; }
  /// Bounds of a patch or a piece.
  /// Requires:  node.bounded(), here and below.
  [[nodiscard]] static const PieceBounds& bounds_of(const Node& node) {
    return node.kind == Node::Kind::patch ? static_cast<const LeafNode*>(node.boxes)->bounds[node.place]
                                          : static_cast<const SplitNode*>(node.boxes)->bounds[node.place];
  }
  /// Its control points, which stay where they are until begin().
  [[nodiscard]] const Patch& patch(const Node& node);
  /// The whole patch that it belongs to.
  [[nodiscard]] PatchId root_of(const Node& node) const {
    return node.kind == Node::Kind::patch ? model_->patch(node.owner, node.place) : splits_[node.owner].root;
  }
  /// The piece with its offset triangle, made anew.
  [[nodiscard]] Piece piece(const Node& node);
  /// Its bounding points, until the next call, where the model is bounded by rows.
  [[nodiscard]] const BoundingPoints& points() const { return points_; }
  /// False for a piece that need not be split: at the last level, or where rounding makes up its radius.
  [[nodiscard]] static bool can_open(const Node& node) {
    if (node.kind == Node::Kind::tree) return true;
    const std::uint8_t can_split = node.kind == Node::Kind::patch
                                       ? static_cast<const LeafNode*>(node.boxes)->can_split
                                       : static_cast<const SplitNode*>(node.boxes)->can_split;
    return (can_split >> node.place & 1u) != 0;
  }

  /// Children of a node, made if need be.
  struct Opened {
    const WideNode* boxes;
    Node::Kind kind;
    std::uint32_t owner;
    [[nodiscard]] std::size_t count() const { return boxes->count(); }
    [[nodiscard]] Node child(std::size_t place) const {
      return {boxes, static_cast<std::uint8_t>(place), kind, owner};
    }
  };
  /// Requires:  can_open(node), or a piece above the last level.
  [[nodiscard]] Opened open(const Node& node);

  /// For a query that asks for extents of pieces along one direction many times.
  [[nodiscard]] KnownExtents& extents() { return extents_; }
  /// Memory for nodes that wait in a query that goes down one tree.
  [[nodiscard]] std::vector<NodeGap>& waiting() { return waiting_; }

  /// Has this query reached the limit of distinct splits?
  [[nodiscard]] bool full() const { return touched_ >= max_pieces_; }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;
  // The pieces of a patch or a piece.
  struct Split {
    SplitNode pieces;
    PatchId root;
    std::array<std::uint32_t, 4> splits{none, none, none, none};   // of these pieces
    std::array<std::uint32_t, 4> patches{none, none, none, none};  // in patches_
    std::uint32_t query = 0;                                       // that opened it last
    std::uint32_t parent;                                          // in patches_
  };
  struct Root {
    std::uint32_t split = none, patch = none;
  };
  // Of whole patches, by number; open addressing.
  class Roots {
   public:
    // Valid until the next call.
    [[nodiscard]] Root& operator[](std::uint32_t patch);
    // Keeps its memory.
    void clear();
    [[nodiscard]] std::size_t bytes() const { return places_.capacity() * sizeof(Place); }

   private:
    struct Place {
      std::uint32_t patch = 0, round = 0;
      Root root;
    };
    [[nodiscard]] Place& place_of(std::uint32_t patch);

    std::vector<Place> places_;  // a power of two of them, at most half in use
    std::size_t count_ = 0;
    std::uint32_t round_ = 1;  // places of earlier ones are free
  };
  [[nodiscard]] std::uint32_t patch_place(const Node& node);
  [[nodiscard]] std::uint32_t& split_place(const Node& node);
  [[nodiscard]] Patch& next_patch();

  const SurfaceBvh* model_;
  std::size_t max_pieces_;
  BoundingPoints points_;
  KnownExtents extents_;
  std::vector<NodeGap> waiting_;
  Roots roots_;
  // Elements beyond the counts are spare memory.
  std::deque<Split> splits_;
  std::deque<Patch> patches_;
  std::size_t split_count_ = 0, patch_count_ = 0;
  std::size_t bytes_of_points_ = 0;
  std::uint32_t query_ = 0;
  std::size_t touched_ = 0;
};

/// A surface where a query is to see it.
struct PlacedBvh {
  const SurfaceBvh& model;
  SurfaceWorkspace& scratch;  ///< of this model and of no other one in the same query
  Motion pose;
  /// Upper bound, in mesh units, of how far from there the place that is meant of a point may be. Crossings and
  /// points inside of solids are proved for that place too; distances are those of `pose` itself.
  double deviation = 0;
};

}  // namespace snug
