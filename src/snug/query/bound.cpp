#include <snug/query/bound.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <snug/base/parallel.h>
#include <snug/bounds/table_triangle.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

// The pieces of one patch, and how many splits they took.
struct PatchPieces {
  std::vector<PieceEnclosure> pieces;
  std::uint64_t splits = 0;
  bool reached = true;
};

class PatchBounder {
 public:
  PatchBounder(const LimitSurface& surface, const BoundOptions& options, const WorkMonitor& monitor)
      : surface_(surface), options_(options), monitor_(monitor), back_(surface.scale().inverse()) {}

  PatchPieces run(PatchId root, std::uint64_t budget) {
    result_ = {};
    root_ = root;
    level_ = surface_.after_first_split(root) ? 1 : 0;
    budget_ = budget;
    if (surface_.has_patch(root)) visit(surface_.patch(root));
    return std::move(result_);
  }

 private:
  void visit(const Patch& patch) {
    const bool room = result_.splits < budget_ && patch.path.level() < PiecePath::max_level;
    PieceEnclosure piece;
    const bool fine = fit(patch, piece);
    const bool more = options_.tolerance ? !fine : level_ + patch.path.level() < options_.level;
    const bool useful = !options_.tolerance || !stuck_;
    if (more && useful && room) {
      visit_children(patch);
      return;
    }
    if (more) result_.reached = false;
    result_.pieces.push_back(std::move(piece));
  }

  void visit_children(const Patch& patch) {
    ++result_.splits;
    monitor_.checkpoint();
    for (unsigned child = 0; child < 4; ++child) visit(split(patch, child));
  }

  // Fits the enclosures of a piece; true if they meet the target.
  bool fit(const Patch& patch, PieceEnclosure& piece) {
    piece.patch = root_;
    piece.path = patch.path;
    const std::array<Vector3, 3> corners = limit_corners(patch);
    for (std::size_t k = 0; k < 3; ++k) {
      piece.corners[k] = require_representable(back_.apply(patch.origin + corners[k]));
    }
    OffsetTriangle offset;
    if (options_.method == BoundMethod::table) {
      const TableTriangle triangle = table_triangle(surface_.library().table(*patch.kind), patch);
      offset = offset_triangle(triangle);
      piece.interval = unscaled(triangle.interval, back_);
    } else {
      hull_points(surface_.library(), patch, points_);
      offset = offset_triangle(surface_.library(), points_, corners);
      piece.interval = unscaled(interval_simplex(points_, corners), back_);
    }
    piece.offset = unscaled(offset, back_);
    stuck_ = offset.radius <= 2 * offset.rounding;
    return !options_.tolerance || piece.offset.radius <= *options_.tolerance / 2;
  }

  const LimitSurface& surface_;
  const BoundOptions& options_;
  const WorkMonitor& monitor_;
  PowerOfTwo back_;
  PatchId root_;
  unsigned level_ = 0;  // of the whole patch
  std::uint64_t budget_ = 0;
  bool stuck_ = false;  // rounding alone makes up the last fit: splitting does not help
  HullPoints points_;
  PatchPieces result_;
};

}  // namespace

void require_sound(const BoundOptions& options) {
  require_value(!options.tolerance || (*options.tolerance > 0 && std::isfinite(*options.tolerance)),
                "bound: the tolerance must be finite and positive; leave it out to bound whole patches");
  require_value(options.level <= PiecePath::max_level, "bound: the level is too high; give at most 60");
}

BoundSummary bound(const LimitSurface& surface, const BoundOptions& options,
                   const std::function<void(const PieceEnclosure&)>& sink, const WorkMonitor& monitor) {
  require_sound(options);
  // Patches worked on at once: as many as their pieces are few, so that memory stays small and threads are busy.
  constexpr std::size_t most_patches = 1024, most_pieces = 1 << 16;
  std::size_t chunk = 1;
  BoundSummary summary;
  std::vector<PatchPieces> results;
  for (std::size_t begin = 0, count = 0; begin < surface.patch_count(); begin += count) {
    count = std::min(chunk, surface.patch_count() - begin);
    // A patch that needs more than its share of the memory is done again, alone.
    const std::uint64_t left = std::min<std::uint64_t>(
        options.budget - summary.splits, std::max<std::uint64_t>(64, most_pieces / (3 * count)));
    results.assign(count, {});
    parallel_for_with(
        count, options.threads, [&] { return PatchBounder(surface, options, monitor); },
        [&](PatchBounder& bounder, std::size_t from, std::size_t to) {
          for (std::size_t i = from; i < to; ++i) results[i] = bounder.run(PatchId(begin + i), left);
        });
    for (std::size_t i = 0; i < count; ++i) {
      // The budget is spent in the order of patches, whatever the threads did.
      const std::uint64_t rest = options.budget - summary.splits;
      if (results[i].splits > rest || (results[i].splits == left && left < rest)) {
        results[i] = PatchBounder(surface, options, monitor).run(PatchId(begin + i), rest);
      }
      summary.splits += results[i].splits;
      summary.reached = summary.reached && results[i].reached;
      for (const PieceEnclosure& piece : results[i].pieces) {
        ++summary.count;
        summary.max_radius = std::max(summary.max_radius, piece.offset.radius);
        sink(piece);
      }
    }
    std::size_t pieces = 0;
    for (const PatchPieces& patch : results) pieces += patch.pieces.size();
    chunk = std::clamp<std::size_t>(most_pieces * count / (pieces + 1), 1, std::min(4 * count, most_patches));
    monitor.report(static_cast<double>(begin + count) / static_cast<double>(surface.patch_count()));
  }
  return summary;
}

}  // namespace snug
