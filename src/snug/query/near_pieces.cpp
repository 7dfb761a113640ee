#include <snug/query/near_pieces.h>

namespace snug {
namespace {

// Most quadratics: of the budget, and beside a few triangles.
constexpr std::uint64_t pieces_a_triangle = 16, pieces_beside = 1u << 17;

std::uint64_t max_pieces(const LimitSurface& surface, const Run& run) {
  const std::uint64_t triangles =
      std::max<std::uint64_t>(run.max_splits.value_or(default_splits::hull), surface.patch_count());
  return pieces_beside + pieces_a_triangle * std::min(triangles, std::uint64_t{1} << 40);
}

}  // namespace

NearPieces::NearPieces(const LimitSurface& surface, double error, const Run& run)
    : surface_(surface), error_(error), run_(run), max_(max_pieces(surface, run)) {
  std::vector<PatchId> there;
  std::vector<Point3> centres;
  for (std::size_t i = 0; i < surface.patch_count(); ++i) {
    const PatchId patch(i);
    if (!surface.has_patch(patch)) continue;
    there.push_back(patch);
    centres.push_back(surface.patch(patch).origin);
  }
  for (const std::uint32_t i : in_order_of_place(centres, run.threads)) patches_.push_back(there[i]);
  boxes_.resize(std::min(patches_.size(), max_blocks));
}

void NearPieces::mark(const std::vector<PieceName>& pieces) {
  marked_.insert(marked_.end(), pieces.begin(), pieces.end());
}

const std::vector<PieceName>& NearPieces::marked() {
  std::sort(marked_.begin(), marked_.end());
  return marked_;
}

void NearPieces::refine(double error) {
  for (const PieceName& name : marked_) finer_[name] = error;
  marked_.clear();
}

}  // namespace snug
