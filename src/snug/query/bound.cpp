#include <snug/bound.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <snug/bounds/table_triangle.h>
#include <snug/patch/evaluate.h>
#include <snug/search/surface_data.h>
#include <snug/shape/normal_cone.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/unscale.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

// Of one piece of a surface or of a curve, in mesh units.
template <std::size_t N>
struct Enclosure {
  PiecePath path;
  std::array<Point3, N> corners;  // limit corners, in double precision
  OffsetSimplex<N> offset;
  IntervalSimplex<N> interval;
};
struct PieceEnclosure : Enclosure<3> {
  PatchId patch;
  std::optional<NormalCone> normals{};
};

// Returns whether rounding alone makes up the radius: then splitting does not help.
template <std::size_t N>
bool enclose(const std::array<Vector3, N>& corners, const Point3& origin, const OffsetSimplex<N>& offset,
             const IntervalSimplex<N>& interval, PowerOfTwo back, Enclosure<N>& out) {
  for (std::size_t k = 0; k < N; ++k) {
    out.corners[k] = require_representable(back.apply(origin + corners[k]));
  }
  out.offset = unscaled(offset, back);
  out.interval = unscaled(interval, back);
  return offset.radius <= 2 * offset.rounding;
}

class SurfacePieces {
 public:
  using Enclosure = PieceEnclosure;
  static constexpr unsigned children = 4;

  SurfacePieces(const LimitSurface& surface, BoundMethod method)
      : surface_(surface), method_(method), back_(surface.scale().inverse()) {}

  [[nodiscard]] std::optional<Patch> whole(std::size_t i) const {
    return surface_.has_patch(PatchId(i)) ? std::optional(surface_.patch(PatchId(i))) : std::nullopt;
  }
  [[nodiscard]] unsigned level(std::size_t i) const { return surface_.after_first_split(PatchId(i)) ? 1 : 0; }

  bool enclose(std::size_t i, const Patch& patch, PieceEnclosure& out) {
    out.patch = PatchId(i);
    const std::array<Vector3, 3> corners = limit_corners(patch);
    if (method_ == BoundMethod::table) {
      const TableTriangle triangle = table_triangle(surface_.library().table(*patch.kind), patch);
      return snug::enclose(corners, patch.origin, offset_triangle(triangle), triangle.interval, back_, out);
    }
    bounding_points(surface_.library(), patch, points_);
    const OffsetTriangle offset = offset_triangle(surface_.library(), points_, corners);
    return snug::enclose(corners, patch.origin, offset, interval_simplex(points_, corners), back_, out);
  }

  void add_normals(const Patch& patch, PieceEnclosure& out) { out.normals = normal_cone(patch); }

 private:
  const LimitSurface& surface_;
  BoundMethod method_;
  PowerOfTwo back_;
  BoundingPoints points_;
};

struct EdgeEnclosure : Enclosure<2> {
  EdgeId edge;
};

class CurvePieces {
 public:
  using Enclosure = EdgeEnclosure;
  static constexpr unsigned children = 2;

  explicit CurvePieces(const CurveSet::Edges& edges) : edges_(edges), back_(edges.scale().inverse()) {}

  [[nodiscard]] std::optional<CurvePiece> whole(std::size_t i) const { return edges_.piece(EdgeId(i)); }
  [[nodiscard]] unsigned level(std::size_t) const { return 0; }

  bool enclose(std::size_t i, const CurvePiece& piece, EdgeEnclosure& out) {
    out.edge = EdgeId(i);
    const std::array<RelativePoint, 2> limits = limit_ends(piece);
    const std::array<Vector3, 2> ends{limits[0].relative, limits[1].relative};
    bounding_points(piece, points_);
    return snug::enclose(ends, piece.origin, offset_segment(points_, ends), interval_simplex(points_, ends),
                         back_, out);
  }
  void add_normals(const CurvePiece&, EdgeEnclosure&) {}

 private:
  const CurveSet::Edges& edges_;
  PowerOfTwo back_;
  BoundingPoints points_;
};

// Result for one patch, or one edge.
template <class Pieces>
struct Bounded {
  std::vector<typename Pieces::Enclosure> enclosures;
  double max_radius = 0;
  std::uint64_t splits = 0;
  Outcome outcome = Outcome::complete;
};

template <class Pieces>
class Bounder {
 public:
  Bounder(const Pieces& pieces, const BoundOptions& options, const Run& run)
      : pieces_(pieces), options_(options), monitor_(monitor_of(run)) {}

  Bounded<Pieces> run(std::size_t i, std::uint64_t budget) {
    result_ = {};
    whole_ = i;
    level_ = pieces_.level(i);
    budget_ = budget;
    if (const auto piece = pieces_.whole(i)) visit(*piece);
    return std::move(result_);
  }

 private:
  template <class Piece>
  void visit(const Piece& piece) {
    const bool room = result_.splits < budget_ && piece.path.level() < PiecePath::max_level;
    typename Pieces::Enclosure enclosure;
    enclosure.path = piece.path;
    const bool stuck = pieces_.enclose(whole_, piece, enclosure);
    const double radius = enclosure.offset.radius;
    const bool more =
        options_.error ? radius > *options_.error / 2 : level_ + piece.path.level() < options_.level;
    if (!more || !room || (options_.error && stuck)) {
      const bool spent = result_.splits >= budget_ && !(options_.error && stuck);
      result_.outcome = worse(result_.outcome, outcome_of(!more, spent));
      result_.max_radius = std::max(result_.max_radius, radius);
      if (options_.normals) pieces_.add_normals(piece, enclosure);
      result_.enclosures.push_back(std::move(enclosure));
      return;
    }
    ++result_.splits;
    monitor_.checkpoint();
    for (unsigned child = 0; child < Pieces::children; ++child) visit(split(piece, child));
  }

  Pieces pieces_;
  const BoundOptions& options_;
  const WorkMonitor& monitor_;
  std::size_t whole_ = 0;
  unsigned level_ = 0;  // of the whole piece
  std::uint64_t budget_ = 0;
  Bounded<Pieces> result_;
};

template <class Pieces>
BoundSummary bound_all(const Pieces& wholes, std::size_t all, const BoundOptions& options,
                       const std::function<void(const typename Pieces::Enclosure&)>& sink, const Run& run) {
  require_value(!options.error || (*options.error > 0 && std::isfinite(*options.error)),
                "bound: the error must be finite and positive; leave it out to bound whole patches");
  require_value(options.level <= PiecePath::max_level, "bound: the level is too high; give at most 60");
  // Patches or edges worked on at once: as many as their pieces are few, so that memory stays small and
  // threads are busy.
  constexpr std::size_t max_wholes = 1024, max_pieces = 1 << 16;
  std::size_t chunk = 1;
  const std::uint64_t max_splits = run.max_splits.value_or(default_splits::bound);
  BoundSummary summary;
  std::vector<Bounded<Pieces>> results;
  for (std::size_t begin = 0, count = 0; begin < all; begin += count) {
    count = std::min(chunk, all - begin);
    // One that needs more than its share of the memory is done again, alone.
    const std::uint64_t left = std::min<std::uint64_t>(max_splits - summary.splits,
                                                       std::max<std::uint64_t>(64, max_pieces / (3 * count)));
    results.assign(count, {});
    parallel_for_with(
        count, run.threads, [&] { return Bounder<Pieces>(wholes, options, run); },
        [&](Bounder<Pieces>& bounder, std::size_t from, std::size_t to) {
          for (std::size_t i = from; i < to; ++i) results[i] = bounder.run(begin + i, left);
        });
    std::size_t pieces = 0;
    for (std::size_t i = 0; i < count; ++i) {
      // The budget is spent in order, whatever the threads did.
      Bounded<Pieces>& result = results[i];
      const std::uint64_t rest = max_splits - summary.splits;
      if (result.splits > rest || (result.splits == left && left < rest)) {
        result = Bounder<Pieces>(wholes, options, run).run(begin + i, rest);
      }
      summary.splits += result.splits;
      summary.outcome = worse(summary.outcome, result.outcome);
      summary.max_radius = std::max(summary.max_radius, result.max_radius);
      summary.count += result.enclosures.size();
      for (const auto& enclosure : result.enclosures) sink(enclosure);
      pieces += result.enclosures.size();
    }
    chunk = std::clamp<std::size_t>(max_pieces * count / (pieces + 1), 1, std::min(4 * count, max_wholes));
    monitor_of(run).report(static_cast<double>(begin + count) / static_cast<double>(all));
  }
  return summary;
}

}  // namespace

BoundSummary bound(const CurveSet& curves, const BoundOptions& options,
                   const std::function<void(const CurveEnclosure&)>& sink, const Run& run) {
  return bound_all(
      CurvePieces(curves.edges()), curves.edge_count(), options,
      [&](const EdgeEnclosure& piece) {
        sink(
            {piece.edge, piece.path.text(), piece.path.level(), piece.corners, piece.offset, piece.interval});
      },
      run);
}

BoundSummary bound(const Surface& surface, const BoundOptions& options,
                   const std::function<void(const PatchEnclosure&)>& sink, const Run& run) {
  const LimitSurface& limit = surface.data()->limit();
  return bound_all(
      SurfacePieces(limit, surface.data()->method()), limit.patch_count(), options,
      [&](const PieceEnclosure& piece) {
        sink({limit.place(piece.patch), piece.path.text(),
              piece.path.level() + (limit.after_first_split(piece.patch) ? 1 : 0), piece.corners,
              piece.offset, piece.interval, piece.normals});
      },
      run);
}

}  // namespace snug
