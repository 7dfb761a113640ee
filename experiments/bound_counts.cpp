#include <experiments/bound_counts.h>

#include <algorithm>
#include <cmath>

#include <experiments/control_box.h>
#include <snug/bounds/enclosure.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/unscale.h>
#include <support/error.h>

namespace snug {
namespace {

// How large a piece is, in mesh units, and whether rounding alone makes it so.
struct Size {
  double radius;
  bool stuck;
};

// `children`: pieces that a split makes.
template <class Piece>
class Counter {
 public:
  Counter(const CountOptions& options, unsigned children, std::function<Size(const Piece&)> size_of,
          const WorkMonitor& monitor)
      : options_(options), children_(children), size_of_(std::move(size_of)), monitor_(monitor) {
    require_value(!options.tolerance || (*options.tolerance > 0 && std::isfinite(*options.tolerance)),
                  "pieces: the tolerance must be finite and positive");
    require_value(options.level <= PiecePath::max_level, "pieces: the level is too high; give at most 60");
  }

  // `begin`: the level that the whole piece counts as. Calls passes(piece) to learn whether a piece is split
  // whatever its size.
  template <class Passes, class Sink>
  void visit(const Piece& piece, unsigned begin, const Passes& passes, const Sink& sink) {
    const bool room = count_.splits < options_.budget && piece.path.level() < PiecePath::max_level;
    const bool forced = passes(piece);
    bool more = forced, useful = true;
    Size size{};
    if (!forced || !room) {
      size = size_of_(piece);
      more = more || (options_.tolerance ? !(size.radius <= *options_.tolerance / 2)
                                         : begin + piece.path.level() < options_.level);
      useful = !options_.tolerance || !size.stuck;
    }
    if (more && useful && room) {
      ++count_.splits;
      monitor_.checkpoint();
      for (unsigned child = 0; child < children_; ++child) visit(split(piece, child), begin, passes, sink);
      return;
    }
    count_.reached = count_.reached && !more;
    ++count_.count;
    count_.largest = std::max(count_.largest, size.radius);
    sink(piece, size.radius);
  }

  [[nodiscard]] const PieceCount& count() const { return count_; }

 private:
  const CountOptions& options_;
  unsigned children_;
  std::function<Size(const Piece&)> size_of_;
  const WorkMonitor& monitor_;
  PieceCount count_;
};

Size size_of_box(const Box3& box, double error, PowerOfTwo back) {
  const double side = longest_side(box);
  return {unscaled_up(enlarged(side / 2), back), side <= 4 * error};
}

BoundSource source_of(BoundWay way) {
  if (way == BoundWay::ngon) return BoundSource::ngon;
  return way == BoundWay::characteristic ? BoundSource::characteristic : BoundSource::rows;
}

}  // namespace

const char* name_of(BoundWay way) {
  switch (way) {
    case BoundWay::rows:
      return "rows";
    case BoundWay::ngon:
      return "table, ngon";
    case BoundWay::characteristic:
      return "table, characteristic";
    case BoundWay::control_box:
      return "control-box";
    default:
      return "rows, split first";
  }
}

PieceCount count_pieces(const LimitSurface& surface, LayoutTables& tables, BoundWay way,
                        const CountOptions& options,
                        const std::function<void(PatchId, const Patch&, double)>& sink,
                        const WorkMonitor& monitor) {
  const PowerOfTwo back = surface.scale().inverse();
  BoundingPoints scratch;
  const auto size_of = [&](const Patch& patch) -> Size {
    if (way == BoundWay::control_box) return size_of_box(control_box(patch, scratch), patch.error, back);
    const OffsetTriangle offset = tables.offset(patch, source_of(way), scratch);
    return {unscaled(offset, back).radius, offset.radius <= 2 * offset.rounding};
  };
  const auto passes = [&](const Patch& patch) { return way == BoundWay::split && patch.kind->transient(); };
  Counter<Patch> counter(options, 4, size_of, monitor);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const PatchId root(p);
    if (!surface.has_patch(root)) continue;
    counter.visit(surface.patch(root), surface.after_first_split(root) ? 1 : 0, passes,
                  [&](const Patch& piece, double radius) {
                    if (sink) sink(root, piece, radius);
                  });
    monitor.report(static_cast<double>(p + 1) / static_cast<double>(surface.patch_count()));
  }
  return counter.count();
}

PieceCount count_pieces(const CurveSet& curves, BoundWay way, const CountOptions& options,
                        const WorkMonitor& monitor) {
  require_value(way == BoundWay::rows || way == BoundWay::control_box,
                "pieces: curves have bounding rows and control boxes only");
  const PowerOfTwo back = curves.edges().scale().inverse();
  BoundingPoints scratch;
  const auto size_of = [&](const CurvePiece& piece) -> Size {
    if (way == BoundWay::control_box) return size_of_box(control_box(piece, scratch), piece.error, back);
    const std::array<RelativePoint, 2> ends = limit_ends(piece);
    bounding_points(piece, scratch);
    const OffsetSegment offset = offset_segment(scratch, {ends[0].relative, ends[1].relative});
    return {unscaled(offset, back).radius, offset.radius <= 2 * offset.rounding};
  };
  Counter<CurvePiece> counter(options, 2, size_of, monitor);
  for (std::size_t e = 0; e < curves.edge_count(); ++e) {
    counter.visit(
        curves.edges().piece(EdgeId(e)), 0, [](const CurvePiece&) { return false; },
        [](const CurvePiece&, double) {});
  }
  return counter.count();
}

}  // namespace snug
