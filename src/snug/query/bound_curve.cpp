#include <snug/query/bound_curve.h>

#include <algorithm>

#include <snug/base/error.h>
#include <snug/bounds/curve_points.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/unscale.h>

namespace snug {
namespace {

class CurveBounder {
 public:
  CurveBounder(const CurveSet& curves, const BoundOptions& options,
               const std::function<void(const CurveEnclosure&)>& sink, const WorkMonitor& monitor)
      : options_(options), sink_(sink), monitor_(monitor), back_(curves.scale().inverse()) {}

  void visit(EdgeId edge, const CurvePiece& piece) {
    CurveEnclosure enclosure{edge, piece.path, {}, {}, {}};
    const Fit fit = fitted(piece, enclosure);
    const bool fine = !options_.tolerance || fit.radius <= *options_.tolerance / 2;
    const bool more = options_.tolerance ? !fine : piece.path.level() < options_.level;
    const bool useful = !options_.tolerance || !fit.stuck;
    if (more && useful && summary_.splits < options_.budget && piece.path.level() < PiecePath::max_level) {
      ++summary_.splits;
      monitor_.checkpoint();
      for (unsigned child = 0; child < 2; ++child) visit(edge, split(piece, child));
      return;
    }
    summary_.reached = summary_.reached && !more;
    ++summary_.count;
    summary_.max_radius = std::max(summary_.max_radius, fit.radius);
    sink_(enclosure);
  }

  [[nodiscard]] const BoundSummary& summary() const { return summary_; }

 private:
  struct Fit {
    double radius;  // in mesh units
    bool stuck;     // rounding alone makes it up: splitting does not help
  };

  Fit fitted(const CurvePiece& piece, CurveEnclosure& enclosure) {
    const std::array<LimitPoint, 2> limits = limit_ends(piece);
    const std::array<Vector3, 2> ends{limits[0].relative, limits[1].relative};
    for (std::size_t k = 0; k < 2; ++k) {
      enclosure.corners[k] = require_representable(back_.apply(piece.origin + ends[k]));
    }
    hull_points(piece, points_);
    const OffsetSegment offset = offset_simplex<2>(points_, ends);
    enclosure.offset = unscaled(offset, back_);
    enclosure.interval = unscaled(interval_simplex<2>(points_, ends), back_);
    return {enclosure.offset.radius, offset.radius <= 2 * offset.rounding};
  }

  const BoundOptions& options_;
  const std::function<void(const CurveEnclosure&)>& sink_;
  const WorkMonitor& monitor_;
  PowerOfTwo back_;
  HullPoints points_;
  BoundSummary summary_;
};

}  // namespace

BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const WorkMonitor& monitor) {
  require_value(options.method != BoundMethod::table, "bound: curves have no tables; give BoundMethod::rows");
  require_sound(options);
  CurveBounder bounder(curves, options, sink, monitor);
  const std::size_t edges = curves.edge_count(), stride = 1 + edges / 1000;
  for (std::size_t e = 0; e < edges; ++e) {
    if (e % stride == 0) monitor.report(static_cast<double>(e) / static_cast<double>(edges));
    bounder.visit(EdgeId(e), curves.piece(EdgeId(e)));
  }
  return bounder.summary();
}

}  // namespace snug
