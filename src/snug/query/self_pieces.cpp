#include <snug/query/self_pieces.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/search/quadratic_bvh.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {
namespace {

// That a thread keeps between two pairs or stars.
constexpr std::size_t max_kept = 20'000;

}  // namespace

const Patch& SelfPieces::patch(const PieceName& name) {
  if (const auto it = patches_.find(name); it != patches_.end()) return it->second;
  Patch made =
      name.splits == 0 ? surface_->patch(PatchId(name.patch)) : split(patch(name.parent()), name.digit());
  return patches_.emplace(name, std::move(made)).first->second;
}

const Piece& SelfPieces::piece(const PieceName& name) {
  if (const auto it = pieces_.find(name); it != pieces_.end()) return it->second;
  Piece made = make_piece(surface_->library(), PatchId(name.patch), patch(name), scratch_);
  return pieces_.emplace(name, std::move(made)).first->second;
}

bool SelfPieces::drop_many() {
  if (patches_.size() + pieces_.size() < max_kept) return false;
  patches_.clear();
  pieces_.clear();
  return true;
}

std::vector<QuadraticTriangle> enclosures_of(const LimitSurface& surface, std::span<const PieceName> pieces,
                                             int threads, const WorkMonitor& monitor) {
  std::vector<QuadraticTriangle> sets(pieces.size());
  parallel_for_with(
      pieces.size(), threads, [&] { return SelfPieces(surface); },
      [&](SelfPieces& kept, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          monitor.checkpoint();
          kept.drop_many();
          const OffsetTriangle& offset = kept.piece(pieces[i]).offset;
          sets[i] = flat_quadratic(offset.base);
          sets[i].error = enlarged(sets[i].error + offset.radius);
        }
      });
  for (const QuadraticTriangle& set : sets) {
    if (!std::isfinite(set.error)) {
      throw InputError(InputProblem::unrepresentable,
                       "a bound of a patch does not fit a double; move the mesh nearer to the origin");
    }
  }
  return sets;
}

bool share_corner(const LevelComplex& complex, const PieceName& a, const PieceName& b) {
  const auto x = complex.vertices(a), y = complex.vertices(b);
  return std::any_of(x.begin(), x.end(),
                     [&](const LevelVertex& v) { return std::find(y.begin(), y.end(), v) != y.end(); });
}

std::vector<LevelVertex> common_corners(const LevelComplex& complex, const PieceName& a, const PieceName& b) {
  const auto x = complex.vertices(a), y = complex.vertices(b);
  std::vector<LevelVertex> common;
  for (const LevelVertex& v : x) {
    if (std::find(y.begin(), y.end(), v) != y.end()) common.push_back(v);
  }
  return common;
}

}  // namespace snug
