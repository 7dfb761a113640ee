#include <snug/query/self_pieces.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/search/feet.h>
#include <support/error.h>

namespace snug {

std::vector<StarSector> sectors_of(PieceCache& pieces, const LevelStar& star) {
  std::vector<StarSector> sectors;
  for (const auto& sector : star.sectors)
    sectors.push_back({&pieces.patch(sector.piece), sector.centre, sector.mirrored});
  return sectors;
}

PieceSet enclosures_of(const SurfaceBvh& model, std::span<const PieceName> pieces, int threads,
                       const WorkMonitor& monitor) {
  Blocks<QuadraticTriangle> sets(pieces.size());
  for_each_with_pieces(model, pieces.size(), threads, monitor, [&](PieceCache& kept, std::size_t i) {
    const OffsetTriangle& offset = kept.offset(pieces[i]);
    sets[i] = flat_quadratic(offset.base);
    sets[i].error = enlarged(sets[i].error + offset.radius);
  });
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (!std::isfinite(sets[i].error)) {
      throw InputError(InputProblem::unrepresentable,
                       "a bound of a patch does not fit a double; move the mesh nearer to the origin");
    }
  }
  PieceSet result(std::move(sets));
  result.prepare(threads);
  return result;
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

MarkedVertices::MarkedVertices(std::vector<LevelVertex> vertices) : vertices_(std::move(vertices)) {
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
  marks_.assign(vertices_.size(), 0);
}

bool MarkedVertices::any(const std::vector<LevelVertex>& of) const {
  return std::any_of(of.begin(), of.end(), [this](const LevelVertex& v) {
    return marks_[static_cast<std::size_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) -
                                           vertices_.begin())] != 0;
  });
}

}  // namespace snug
