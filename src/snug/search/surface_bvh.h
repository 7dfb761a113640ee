#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/base/progress.h>
#include <snug/bvh/wide_bvh.h>
#include <snug/geometry/motion.h>
#include <snug/search/piece_cache.h>

namespace snug {

class Solid;

struct SurfaceBvhOptions {
  Volume volume = Volume::obb;
  std::optional<TableLayout> table{};  ///< pieces bounded by the dissertation's tables instead of hull rows
  /// Bound all patches when the model is made, some microseconds each: a tighter tree, for models that are asked thousands
  /// of times. Otherwise the tree is over the control net alone.
  bool tight = false;
  int threads = 0;  ///< that make it
};

/// A surface made ready for queries: a tree over its control net. Patches are bounded, and split, where and when a query
/// comes near them (SurfaceWorkspace). Immutable; may be read by many threads.
///
/// Cost:      about 0.3 microseconds and 15 bytes a patch; see bench/results/collide.txt.
class SurfaceBvh {
 public:
  /// Requires:  the surface outlives the model.
  /// Errors:    InputError (refused) if no face has a patch.
  explicit SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options = {},
                      const WorkMonitor& monitor = {});
  ~SurfaceBvh();
  SurfaceBvh(SurfaceBvh&&) noexcept;
  SurfaceBvh& operator=(SurfaceBvh&&) noexcept;

  [[nodiscard]] const LimitSurface& surface() const { return *surface_; }
  [[nodiscard]] std::optional<TableLayout> table() const { return table_; }
  [[nodiscard]] const WideBvh& tree() const { return tree_; }
  /// The patch that the tree calls item i.
  [[nodiscard]] PatchId patch(std::uint32_t item) const { return patches_[item]; }
  /// Around the surface, in mesh units; infinite where that does not fit a double.
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// The solid that the surface bounds, made on first use.
  /// Errors:    those of Solid: InputError (refused) for a surface that is not closed.
  [[nodiscard]] const Solid& solid() const;
  /// Without the surface.
  [[nodiscard]] std::size_t bytes() const;

 private:
  const LimitSurface* surface_;
  std::optional<TableLayout> table_;
  std::vector<PatchId> patches_;
  WideBvh tree_;
  Ball ball_;
  struct LazySolid;
  std::unique_ptr<LazySolid> solid_;
};

/// A set in a model's tree: of the tree itself, or of a piece that queries made.
struct Node {
  std::uint32_t block;
  std::uint8_t of_block;
  bool piece;
  [[nodiscard]] Lane lane() const { return {block, of_block}; }
};

/// What queries have touched of one model: its pieces, and their sets in blocks. Scratch memory, one a thread.
///
/// Guarantee: a node opens to the same sets whatever came before: no answer depends on earlier queries.
/// Cost:      about 1 KB a piece that was touched; dropped between two queries when it has grown beyond 256 MiB.
class SurfaceWorkspace {
 public:
  /// Requires:  the model outlives the scratch.
  explicit SurfaceWorkspace(const SurfaceBvh& model);

  [[nodiscard]] const SurfaceBvh& model() const { return *model_; }
  [[nodiscard]] std::size_t bytes() const;

  /// For queries: to be called first.
  void begin();
  [[nodiscard]] Node root() const { return {model_->tree().root().block, 0, false}; }
  [[nodiscard]] const Blocks& blocks(bool of_pieces) const {
    return of_pieces ? blocks_ : model_->tree().blocks();
  }
  [[nodiscard]] float size_of(Node node) const { return blocks(node.piece).size_of(node.lane()); }
  [[nodiscard]] PieceId piece(Node node) const { return PieceId(blocks_.name(node.lane())); }
  [[nodiscard]] PieceCache& pieces() { return refinement_; }
  /// False for a piece that cannot be split.
  [[nodiscard]] bool can_open(Node node) const {
    return !node.piece || (lanes_[node.block].can_split >> node.of_block & 1u) != 0;
  }
  /// Does a node open to pieces, which may have to be made?
  [[nodiscard]] bool opens_to_pieces(Node node) const {
    return node.piece || (model_->tree().blocks().name(node.lane()) & WideBvh::cluster_bit) != 0;
  }
  /// Upper bound of the radius of a piece's offset triangle.
  [[nodiscard]] float radius(Node node) const { return lanes_[node.block].radii[node.of_block]; }
  /// The block that a node opens to, which is made if need be; of pieces or of the tree.
  struct Opened {
    std::uint32_t block;
    bool piece;
  };
  /// Requires:  can_open(node).
  [[nodiscard]] Opened open(Node node);
  /// A number for each piece, for as long as a query likes; NaN for those that it has not given one.
  class Numbers {
   public:
    [[nodiscard]] double& operator[](std::size_t piece) {
      if (piece >= kept_.size()) kept_.resize(piece + 1, {0, 0});
      Number& number = kept_[piece];
      if (number.stamp != stamp_) number = {NAN, stamp_};
      return number.value;
    }
    void forget() { ++stamp_; }
    [[nodiscard]] std::size_t bytes() const { return kept_.capacity() * sizeof(Number); }

   private:
    struct Number {
      double value;
      std::uint64_t stamp;
    };
    std::vector<Number> kept_;
    std::uint64_t stamp_ = 1;
  };
  [[nodiscard]] Numbers& ends() { return ends_; }

  /// Has the query opened as many different blocks of pieces as one may? Bounds its memory.
  [[nodiscard]] bool full() const { return touched_ >= 50'000; }

 private:
  // What is asked for most of the pieces of a block.
  struct Lanes {
    std::array<float, Blocks::lanes> radii;
    std::uint8_t can_split;
  };

  std::uint32_t add_block(std::span<const PieceId> pieces);
  std::uint32_t touch(std::uint32_t block);

  const SurfaceBvh* model_;
  PieceCache refinement_;
  Blocks blocks_;
  std::vector<Lanes> lanes_;  // of blocks
  Numbers ends_;
  std::vector<std::uint32_t> cluster_blocks_,
      piece_blocks_;                   // of clusters and pieces; `none` where not opened
  std::vector<std::uint32_t> stamps_;  // of blocks: the query that opened them last
  std::uint32_t query_ = 0;
  std::size_t touched_ = 0;
};

/// A model where a query is to see it.
struct PlacedBvh {
  const SurfaceBvh& model;
  SurfaceWorkspace& scratch;  ///< of this model and of no other one in the same query
  Motion pose;
};

}  // namespace snug
