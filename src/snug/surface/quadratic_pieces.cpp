#include <snug/surface/quadratic_pieces.h>

#include <algorithm>
#include <atomic>
#include <cstddef>

#include <support/parallel.h>

namespace snug {
namespace {

// Below this error, in scaled units, roundings are what is left.
constexpr double min_error = 0x1p-46;

// How many pieces there are, for all threads.
class Count {
 public:
  explicit Count(std::uint64_t most) : max_(most) {}
  void add() { count_.fetch_add(1, std::memory_order_relaxed); }
  [[nodiscard]] bool too_many() const { return count_.load(std::memory_order_relaxed) > max_; }

 private:
  std::uint64_t max_;
  std::atomic<std::uint64_t> count_{0};
};

// Stops, with some of the pieces, once there are too many.
void add_pieces(const LimitSurface& surface, PatchId root, const Patch& patch, double error, Count& count,
                std::vector<QuadraticPiece>& out) {
  if (count.too_many()) return;
  const QuadraticTriangle quadratic = quadratic_triangle(surface.library(), patch);
  if (quadratic.error <= error || quadratic.error <= min_error ||
      patch.path.level() >= PiecePath::max_level) {
    count.add();
    out.push_back({quadratic, root, patch.path});
    return;
  }
  for (unsigned child = 0; child < 4; ++child) {
    add_pieces(surface, root, split(patch, child), error, count, out);
  }
}

// The pieces that make(i, counted, out) adds for each i, in their order.
template <class Make>
RefinedPieces in_order(std::size_t count, std::uint64_t most, int threads, const WorkMonitor& monitor,
                       const Make& make) {
  Count counted(most);
  constexpr std::size_t block = 64;
  std::vector<RefinedPieces> parts((count + block - 1) / block);
  parallel_for(parts.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      monitor.checkpoint();
      for (std::size_t i = b * block; i < std::min(count, (b + 1) * block); ++i) {
        make(i, counted, parts[b].pieces);
        parts[b].origins.resize(parts[b].pieces.size(), static_cast<std::uint32_t>(i));
      }
    }
  });
  RefinedPieces all;
  if (counted.too_many()) return all;
  for (const RefinedPieces& part : parts) {
    all.pieces.insert(all.pieces.end(), part.pieces.begin(), part.pieces.end());
    all.origins.insert(all.origins.end(), part.origins.begin(), part.origins.end());
  }
  return all;
}

}  // namespace

std::vector<QuadraticPiece> quadratic_pieces(const LimitSurface& surface, double error, int threads,
                                             const WorkMonitor& monitor, std::uint64_t most) {
  return in_order(surface.patch_count(), most, threads, monitor,
                  [&](std::size_t p, Count& count, auto& out) {
                    const PatchId root(p);
                    if (!surface.has_patch(root) || count.too_many()) return;
                    add_pieces(surface, root, surface.patch(root), error, count, out);
                  })
      .pieces;
}

RefinedPieces refined(const LimitSurface& surface, std::span<const QuadraticPiece> pieces,
                      std::span<const std::uint8_t> which, double error, int threads,
                      const WorkMonitor& monitor, std::uint64_t most) {
  return in_order(pieces.size(), most, threads, monitor, [&](std::size_t i, Count& count, auto& out) {
    if (count.too_many()) return;
    const QuadraticPiece& piece = pieces[i];
    if (which[i] == 0) {
      count.add();
      out.push_back(piece);
      return;
    }
    Patch patch = surface.patch(piece.root);
    for (unsigned level = 0; level < piece.path.level(); ++level) {
      patch = split(patch, piece.path.digit(level));
    }
    add_pieces(surface, piece.root, patch, error, count, out);
  });
}

}  // namespace snug
