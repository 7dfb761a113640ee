#include <snug/query/printed_hierarchy.h>

#include <algorithm>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/error.h>
#include <snug/query/printed_pair_test.h>
#include <snug/surface/refinement.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

bool has_one_extraordinary(const Kind& kind) {
  return kind.regular_corner(0) + kind.regular_corner(1) + kind.regular_corner(2) >= 2;
}

class LeafMaker {
 public:
  LeafMaker(const Surface& surface, const LeafOptions& options, std::vector<OffsetTriangle>& out)
      : surface_(surface), options_(options), back_(surface.scale().inverse()), out_(out) {}

  void visit(PatchId root, Patch patch) {
    const Piece piece = make_piece(surface_.library(), root, std::move(patch), scratch_, options_.table);
    OffsetTriangle leaf = unscaled(piece.offset, back_);
    const bool one = !options_.one_extraordinary || has_one_extraordinary(*piece.patch.kind);
    if (one && leaf.radius <= options_.tolerance / 2) {
      out_.push_back(leaf);
      return;
    }
    if (piece.patch.path.level() >= PiecePath::max_level ||
        piece.offset.radius <= 2 * piece.offset.rounding) {
      throw InputError(InputProblem::refused,
                       "the tolerance is below what rounding leaves; take a larger one");
    }
    for (unsigned child = 0; child < 4; ++child) visit(root, split(piece.patch, child));
  }

 private:
  const Surface& surface_;
  const LeafOptions& options_;
  PowerOfTwo back_;
  HullPoints scratch_;
  std::vector<OffsetTriangle>& out_;
};

PlacedFrame frame_of(const Placement& placement) {
  PlacedFrame frame;
  frame.rows = {placement.row(0), placement.row(1), placement.row(2)};
  frame.translation = placement.translation();
  frame.defect = rigidity_defect(placement);
  return frame;
}

// Radii are those of rigid motions exactly: nothing is proved here.
OffsetTriangle placed(const OffsetTriangle& leaf, const Placement& placement) {
  OffsetTriangle result = leaf;
  for (Point3& p : result.base) p = placement.apply(p);
  return result;
}

}  // namespace

std::vector<OffsetTriangle> leaves(const Surface& surface, const LeafOptions& options,
                                   const WorkMonitor& monitor) {
  SNUG_EXPECT(options.tolerance > 0);
  std::vector<OffsetTriangle> result;
  LeafMaker maker(surface, options, result);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    monitor.checkpoint();
    if (surface.has_patch(PatchId(p))) maker.visit(PatchId(p), surface.patch(PatchId(p)));
  }
  return result;
}

PrintedHierarchy::PrintedHierarchy(const Surface& surface, const LeafOptions& options,
                                   const WorkMonitor& monitor)
    : leaves_(leaves(surface, options, monitor)), tree_(leaves_) {}

bool PrintedHierarchy::says_separated(const PrintedHierarchy& a, const Placement& place_a,
                                      const PrintedHierarchy& b, const Placement& place_b, double epsilon) {
  const PlacedFrame frame_a = frame_of(place_a), frame_b = frame_of(place_b);
  const double defect = frame_a.defect + frame_b.defect;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> stack{{0, 0}};
  while (!stack.empty()) {
    const auto [i, j] = stack.back();
    stack.pop_back();
    const ObbTree::Node &node_a = a.tree_.node(i), &node_b = b.tree_.node(j);
    const double gap =
        certain_gap(snug::placed(node_a.box, frame_a), snug::placed(node_b.box, frame_b), defect);
    if (gap > epsilon) continue;
    if (node_a.is_leaf() && node_b.is_leaf()) {
      if (!printed_test_says_separated(placed(a.leaves_[node_a.leaf], place_a),
                                       placed(b.leaves_[node_b.leaf], place_b), epsilon)) {
        return false;
      }
    } else if (node_b.is_leaf() ||
               (!node_a.is_leaf() && max_abs(node_a.box.half) >= max_abs(node_b.box.half))) {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(node_a.first_child + child, j);
    } else {
      for (const std::uint32_t child : {0u, 1u}) stack.emplace_back(i, node_b.first_child + child);
    }
  }
  return true;
}

}  // namespace snug
