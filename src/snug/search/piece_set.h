#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <snug/bounds/quadratic.h>
#include <snug/bvh/wide_bvh.h>
#include <snug/evaluate.h>
#include <snug/run.h>
#include <snug/surface/piece_name.h>
#include <support/blocks.h>
#include <support/contract.h>

namespace snug {

/// A set of points by its pieces, and a tree over them. Each piece is a quadratic triangle that stands for all points within its
/// error: of a surface, whose pieces can be made finer, or of sets that are given, such as triangles, which stay as they are. Copies
/// share pieces and tree. May be read by many threads once it is prepared.
class PieceSet {
 public:
  /// None.
  PieceSet() = default;
  /// Sets that stay as they are.
  /// Requires:  coordinates at most about 2; finite errors.
  explicit PieceSet(Blocks<QuadraticTriangle> given);
  /// Triangles of some points times `units`; none: each three points in a row. They are not copied.
  /// Requires:  the same; both outlive the set and its copies.
  explicit PieceSet(std::span<const Point3> points, std::span<const std::array<std::uint32_t, 3>> triangles,
                    PowerOfTwo units = {});
  /// Pieces that together are a surface, each split until its error is at most `error`. Where rounding or the last level ends that,
  /// the error is larger. None if these would be more than `most`; memory stays below what so many take. Coordinates are
  /// the surface's scaled ones times `units`.
  /// Guarantee: the same for any number of threads.
  /// Requires:  the surface outlives the set and its copies.
  /// Errors:    Interrupted.
  PieceSet(const LimitSurface& surface, double error, int threads, const WorkMonitor& monitor = {},
           std::uint64_t most = UINT64_MAX, PowerOfTwo units = {});
  /// Errors of single pieces that are less than that of the others.
  using FinerPieces = std::map<PieceName, double>;
  /// The same of some patches in their order, in the surface's units; where a piece that results is among `finer`, its parts instead.
  /// Requires:  has_patch() of each.
  PieceSet(const LimitSurface& surface, std::span<const PatchId> patches, double error,
           const FinerPieces& finer, int threads, const WorkMonitor& monitor, std::uint64_t most);

  [[nodiscard]] std::size_t size() const {
    return pieces_ ? pieces_->quadratics.size() : triangles_.empty() ? points_.size() / 3 : triangles_.size();
  }
  [[nodiscard]] bool is_surface() const { return surface_ != nullptr; }
  [[nodiscard]] QuadraticTriangle operator[](std::size_t piece) const;
  [[nodiscard]] double error(std::size_t piece) const { return pieces_ ? kept(piece)->error : 0; }
  /// The same where it lies; null for triangles, which are made.
  [[nodiscard]] const QuadraticTriangle* kept(std::size_t piece) const {
    return pieces_ ? &pieces_->quadratics[piece] : nullptr;
  }
  /// Of triangles.
  [[nodiscard]] Triangle facet(std::size_t piece) const {
    Triangle result;
    for (std::size_t k = 0; k < 3; ++k) {
      result[k] = units_.apply(points_[triangles_.empty() ? 3 * piece + k : triangles_[piece][k]]);
    }
    return result;
  }
  /// Of a piece of a surface.
  [[nodiscard]] const PieceName& name(std::size_t piece) const { return pieces_->names[piece]; }
  /// The point itself at a parameter of a piece, and where on the surface that is; nothing for sets that are given.
  [[nodiscard]] BoundedPoint point(std::size_t piece, TriangleParameter at) const;
  [[nodiscard]] std::optional<Place> place(std::size_t piece, TriangleParameter at) const;

  /// Splits those that `which` names until errors are at most `error`. Returns for each piece which former one it is a part of; none,
  /// and all as it was, for sets that are given, and where there would be more than `most`. To be prepared again.
  /// Requires:  which.size() == size().
  std::vector<std::uint32_t> refine(std::span<const std::uint8_t> which, double error, int threads,
                                    const WorkMonitor& monitor = {}, std::uint64_t most = UINT64_MAX);

  /// Makes the tree, if there is none.
  /// Requires:  one piece or more, here and below.
  void prepare(int threads);
  [[nodiscard]] bool prepared() const { return tree_ != nullptr; }
  /// A box around all pieces.
  [[nodiscard]] Box3 box() const;
  /// Calls visit(piece) for those whose boxes are at most `reach` from p, about the nearest first, until it returns true; a visit may
  /// make `reach` smaller. Did one return true?
  /// Requires:  prepared().
  template <class Visit>
  bool visit_near(const Point3& p, double& reach, const Visit& visit) const {
    return visit_by([&](const WideNode& node, WideNode::Distances& gaps) { node.distances(p, 0, gaps); },
                    reach, visit);
  }
  /// The same for those whose boxes may meet another box.
  /// Requires:  a box that is finite.
  template <class Visit>
  bool visit_near(const Obb& box, const Visit& visit) const {
    const SlackBox seen(box);
    double reach = 0;
    return visit_by(
        [&](const WideNode& node, WideNode::Distances& gaps) {
          static_cast<void>(node.distances(seen.box, seen.slack, 0, gaps));
        },
        reach, visit);
  }

 private:
  // In single precision, and what that may lose.
  struct SlackBox {
    explicit SlackBox(const Obb& of);
    PlacedBox box;
    double slack;
  };
  template <class Gaps, class Visit>
  bool visit_by(const Gaps& find_gaps, double& reach, const Visit& visit) const;

  struct Tree {
    WideBvh nodes;
    std::vector<WideNode> leaves;  // boxes around the pieces of each leaf
  };
  struct Pieces {
    Blocks<QuadraticTriangle> quadratics;
    Blocks<PieceName> names;
  };
  struct Made;
  struct FewMade;
  template <class Make>
  static Made made_in_order(std::size_t count, std::uint64_t most, int threads, const WorkMonitor& monitor,
                            const Make& make);
  void take(Made&& made);

  const LimitSurface* surface_ = nullptr;
  std::span<const Point3> points_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  PowerOfTwo units_;
  std::shared_ptr<const Pieces> pieces_;
  std::shared_ptr<const Tree> tree_;
};

/// Items in an order in which those beside each other mostly lie together.
/// Requires:  that of WideBvh::in_order().
[[nodiscard]] std::vector<std::uint32_t> in_order_of_place(std::span<const Point3> centres, int threads);
/// Have two boxes a point in common?
[[nodiscard]] bool overlap(const Box3& a, const Box3& b);

template <class Gaps, class Visit>
bool PieceSet::visit_by(const Gaps& find_gaps, double& reach, const Visit& visit) const {
  struct Near {
    float gap;
    std::uint32_t name;
  };
  // Seven children a level wait at most, of eleven levels.
  std::array<Near, 12 * WideNode::width> stack;
  std::size_t waiting = 0;
  const auto is_near = [&](float gap) { return static_cast<double>(gap) <= reach; };
  const auto open = [&](const WideNode& node) {
    WideNode::Distances gaps;
    find_gaps(node, gaps);
    const std::size_t begin = waiting;
    for (std::size_t i = 0; i < node.count(); ++i) {
      if (!is_near(gaps[i])) continue;
      // The nearest last, to be taken first.
      SNUG_EXPECT(waiting < stack.size());
      std::size_t k = waiting++;
      for (; k > begin && stack[k - 1].gap < gaps[i]; --k) stack[k] = stack[k - 1];
      stack[k] = {gaps[i], node.names[i]};
    }
  };
  open(tree_->nodes.root());
  while (waiting > 0) {
    const Near near = stack[--waiting];
    if (!is_near(near.gap)) continue;
    if ((near.name & WideBvh::leaf_bit) == 0) {
      open(tree_->nodes.node(near.name));
      continue;
    }
    const std::uint32_t leaf = near.name & ~WideBvh::leaf_bit;
    const std::span<const std::uint32_t> items = tree_->nodes.leaf(leaf);
    WideNode::Distances gaps;
    find_gaps(tree_->leaves[leaf], gaps);
    for (std::uint32_t left = (1u << items.size()) - 1; left != 0;) {
      auto next = static_cast<std::size_t>(std::countr_zero(left));
      for (std::size_t i = next + 1; i < items.size(); ++i) {
        if ((left >> i & 1u) != 0 && gaps[i] < gaps[next]) next = i;
      }
      if (!is_near(gaps[next])) break;
      left &= ~(1u << next);
      if (visit(items[next])) return true;
    }
  }
  return false;
}

}  // namespace snug
