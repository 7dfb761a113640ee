#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include <snug/geometry/motion.h>
#include <snug/search/frontier.h>
#include <snug/search/surface_bvh.h>
#include <snug/surface/piece_name.h>

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

/// A node, and which of some rays may meet it, a bit each.
struct NodeRays {
  Node node;
  float gap;  ///< the least of `begins`
  std::uint32_t rays;
  std::array<float, 8> begins;  ///< lower bounds of where, as distances along each
};

/// Two nodes, of A and of B.
struct NodePair {
  std::array<Node, 2> nodes;
  /// Lower bound of their distance where positive, in the query's units, and not below that of what they are
  /// parts of; else the more negative the deeper they overlap.
  float gap;

  /// Are both patches, or pieces of patches?
  [[nodiscard]] bool bounded() const { return nodes[0].bounded() && nodes[1].bounded(); }
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

/// Pieces of one surface that queries came to: nodes below the tree, and patches and pieces by their names. One a thread.
/// Guarantee: a node opens to the same boxes, and a piece has the same bounds, whatever came before: no answer depends on earlier
///            queries.
class PieceCache {
 public:
  /// A query splits at most this many different nodes, which bounds its memory. Offset triangles are by the model's method, or by
  /// rows.
  explicit PieceCache(const SurfaceBvh& model, std::size_t max_pieces = 50'000, bool always_rows = false)
      : model_(&model), max_pieces_(max_pieces), always_rows_(always_rows) {}

  [[nodiscard]] const SurfaceBvh& model() const { return *model_; }
  [[nodiscard]] std::size_t bytes() const;

  /// For queries: to be called first. Drops all where it has grown beyond so many bytes.
  void begin(std::size_t max_bytes = std::size_t{256} << 20);
  /// Forgets all that was split, when the surface has moved. Keeps its memory.
  void renew(const SurfaceBvh& model);
  [[nodiscard]] Node root() const { return {&model_->tree().root(), 0, Node::Kind::tree, 0}; }
  /// Bounds of a patch or a piece.
  /// Requires:  node.bounded(), here and below.
  [[nodiscard]] static const PieceBounds& bounds_of(const Node& node) {
    return node.kind == Node::Kind::patch ? static_cast<const LeafNode*>(node.boxes)->bounds[node.place]
                                          : static_cast<const SplitNode*>(node.boxes)->bounds[node.place];
  }
  /// Its control points. What is referred to here and below stays where it is until begin() or renew().
  [[nodiscard]] const Patch& patch(const Node& node) { return known_.entries[entry_of(node)].patch; }
  /// Its offset triangle, in double precision.
  [[nodiscard]] const OffsetTriangle& offset(const Node& node) { return offset_of_entry(entry_of(node)); }
  [[nodiscard]] PieceName name(const Node& node);
  /// Of a piece by its name, be it a node or not.
  [[nodiscard]] const Patch& patch(const PieceName& name) { return known_.entries[entry_of(name)].patch; }
  [[nodiscard]] const OffsetTriangle& offset(const PieceName& name) {
    return offset_of_entry(entry_of(name));
  }
  /// False for a piece that need not be split: at the last level, or where rounding makes up its radius.
  [[nodiscard]] static bool can_open(const Node& node) {
    if (node.kind == Node::Kind::tree) return true;
    return node.boxes->names[node.place] != 0;
  }
  /// Also true for pieces above the last level that are as flat as doubles can resolve: their bounds are in single precision,
  /// relative to their size.
  [[nodiscard]] bool can_open_further(const Node& node) {
    return can_open(node) || patch(node).path.level() < PiecePath::max_level;
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
  /// For a query that goes down one tree, and for one about a pair, of which this is A.
  [[nodiscard]] Frontier<NodeGap>& open_nodes() { return open_nodes_; }
  [[nodiscard]] Frontier<NodePair>& open_pairs() { return open_pairs_; }
  /// For one about some rays at once.
  [[nodiscard]] Frontier<NodeRays>& open_rays() { return open_rays_; }

  /// Has this query reached the limit of distinct splits?
  [[nodiscard]] bool full() const { return touched_ >= max_pieces_; }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;
  // A patch or a piece.
  struct Entry {
    Patch patch;
    PatchId root;
    std::uint32_t offset = none;  // in offsets_
    std::uint32_t split = none;
    std::array<std::uint32_t, 4> children{none, none, none, none};
  };
  // The nodes that an entry opens to.
  struct Split {
    SplitNode pieces;
    std::uint32_t parent = none;  // the entry
    std::uint32_t query = 0;      // that opened it last
  };
  // Entries of whole patches, by number; open addressing.
  class Roots {
   public:
    // None for a new one. Valid until the next call.
    [[nodiscard]] std::uint32_t& operator[](std::uint32_t patch);
    // Keeps its memory.
    void clear();
    [[nodiscard]] std::size_t bytes() const { return places_.capacity() * sizeof(Place); }

   private:
    struct Place {
      std::uint32_t patch = 0, round = 0, entry = none;
    };
    [[nodiscard]] Place& place_of(std::uint32_t patch);

    std::vector<Place> places_;  // a power of two of them, at most half in use
    std::size_t count_ = 0;
    std::uint32_t round_ = 1;  // places of earlier ones are free
  };
  // Elements that stay where they are, with their memory when they are forgotten.
  template <class T>
  class Store {
   public:
    [[nodiscard]] T& operator[](std::size_t i) { return items_[i]; }
    [[nodiscard]] std::size_t size() const { return size_; }
    // One more, as it was left when it was forgotten.
    T& add() {
      if (size_ == made_) {
        items_.emplace_back();
        ++made_;
      }
      return items_[size_++];
    }
    void forget() { size_ = 0; }
    [[nodiscard]] std::size_t bytes() const { return made_ * sizeof(T); }

   private:
    std::deque<T> items_;
    std::size_t size_ = 0, made_ = 0;
  };
  [[nodiscard]] std::uint32_t entry_of(const Node& node);
  [[nodiscard]] std::uint32_t entry_of(const PieceName& name);
  [[nodiscard]] std::uint32_t root_entry(PatchId root);
  [[nodiscard]] std::uint32_t child_entry(std::uint32_t parent, unsigned child);
  // Writes the control points of a new entry by make(patch).
  template <class Make>
  [[nodiscard]] std::uint32_t add(PatchId root, const Make& make);
  [[nodiscard]] const OffsetTriangle& offset_of_entry(std::uint32_t entry);

  // All that was found out of the surface.
  struct Known {
    Roots roots;
    Store<Split> splits;
    Store<Entry> entries;
    Store<OffsetTriangle> offsets;
    std::size_t bytes_of_points = 0;  // of entries

    // Keeps its memory.
    void forget();
    [[nodiscard]] std::size_t bytes() const {
      return splits.bytes() + entries.bytes() + offsets.bytes() + bytes_of_points + roots.bytes();
    }
  };

  const SurfaceBvh* model_;
  std::size_t max_pieces_;
  bool always_rows_;
  Known known_;
  BoundingPoints points_;  // of the piece at hand
  KnownExtents extents_;
  Frontier<NodeGap> open_nodes_;
  Frontier<NodePair> open_pairs_;
  Frontier<NodeRays> open_rays_;
  std::uint32_t query_ = 0;
  std::size_t touched_ = 0;  // by this query
};

/// A surface where a query is to see it.
struct PlacedBvh {
  const SurfaceBvh& model;
  PieceCache& scratch;  ///< of this model and of no other one in the same query
  Motion pose;
  /// Upper bound, in mesh units, of how far from there the place that is meant of a point may be. Crossings and
  /// points inside of solids are proved for that place too; distances are those of `pose` itself.
  double deviation = 0;
};

}  // namespace snug
