#include <snug/query/brep_maker.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include <snug/spline/quad_pieces.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double level_factor = 2.5;  // by which a split brings a tip nearer, cautiously
constexpr std::uint8_t most_depth = 24;
constexpr std::uint32_t least_flat_quads = 8;
constexpr unsigned first_flat_level = 2, most_flat_splits = 4;

// How many spans the B-spline surface of a quad has: knots run across all of it.
std::uint64_t spans_of(const std::vector<QuadPiece>& pieces) {
  std::set<double> u, v;
  for (const QuadPiece& piece : pieces) {
    u.insert(piece.box().u0);
    v.insert(piece.box().v0);
  }
  return std::uint64_t{u.size()} * v.size();
}

// Faces of quads.
class QuadBrepMaker : public BrepMaker {
 public:
  QuadBrepMaker(const LimitSurface& surface, const BrepOptions& options, const Run& run)
      : BrepMaker(surface, options, run), degree_(tensor_degree(surface.rules().basis)) {
    for (std::uint32_t q = 0; q < layout_.quads().size(); ++q) {
      if (!surface.kind(layout_.quads()[q].patch).polynomial()) irregular_.push_back(q);
    }
    pieces_.resize(layout_.quads().size());
  }

 private:
  void fit() override {
    std::vector<std::uint32_t> all(pieces_.size());
    for (std::uint32_t q = 0; q < all.size(); ++q) all[q] = q;
    if (max_angle_ && degree_ == 3) find_flats();
    fit(all, 0);
    require_spans(spans());
    refine_tips();
    origins_.resize(pieces_.size());
    parallel_for(pieces_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      Patch patch;
      for (std::size_t q = begin; q < end; ++q) {
        surface_.patch(layout_.quads()[q].patch, patch);
        origins_[q] = patch.origin;
      }
    });
    drafts_ = layout_.packed([this](const QuadSide& a, const QuadSide& b) { return continues(a, b); });
  }

  // Are both one polynomial each, whose lattices overlap?
  [[nodiscard]] bool continues(const QuadSide& s, const QuadSide& t) const {
    if (degree_ == 1 || pieces_[s.quad].size() != 1 || pieces_[t.quad].size() != 1) return false;
    const TensorPiece a = turned(pieces_[s.quad][0].piece, (s.side + 3) % 4),
                      b = turned(pieces_[t.quad][0].piece, (t.side + 1) % 4);
    const Vector3 apart = origins_[t.quad] - origins_[s.quad];
    const double tolerance = 0x1p-46 * (a.largest + b.largest + max_abs(apart));
    for (std::size_t j = 0; j <= a.degree; ++j) {
      for (std::size_t i = 0; i < a.degree; ++i) {
        if (max_abs(a.at(i + 1, j) - (b.at(i, j) + apart)) > tolerance) return false;
      }
    }
    return true;
  }

  // The limit surface about a corner of a quad, level by level: points whose larger parameter is 2^-level of the side.
  struct Ring {
    double nearest = INFINITY, farthest = 0, highest = 0;  // from the corner; over the tangent plane
  };
  [[nodiscard]] static Ring ring_at(LimitEvaluator& evaluator, std::size_t corner, unsigned level) {
    const double x = corner == 1 || corner == 2 ? 1 : 0, y = corner >= 2 ? 1 : 0;
    const LimitFrame center = evaluator.frame({0, 0, x, y});
    const double size = std::ldexp(1.0, -static_cast<int>(level));
    Ring ring;
    for (int k = 0; k <= 16; ++k) {
      const double a = size * std::min(1.0, k / 8.0), b = size * std::min(1.0, 2 - k / 8.0);
      const Vector3 d =
          evaluator.frame({0, 0, std::fabs(x - a), std::fabs(y - b)}).point.relative - center.point.relative;
      ring.nearest = std::min(ring.nearest, length(d));
      ring.farthest = std::max(ring.farthest, length(d));
      ring.highest = std::max(ring.highest, std::fabs(dot(*center.normal, d)));
    }
    return ring;
  }

  // Vertices about which faces become flat, and how far: as brep_triangles.cpp does for Loop's scheme.
  void find_flats() {
    std::vector<std::uint32_t> valences(layout_.name_count());
    for (const std::uint32_t q : irregular_) {
      for (const std::uint32_t name : layout_.quads()[q].corners) ++valences[name];
    }
    std::vector<std::optional<Vector3>> normals(valences.size());
    flats_.assign(valences.size(), {INFINITY, most_depth, 1});
    changed_flats_.assign(valences.size(), false);
    const auto each_corner = [&](const auto& visit) {
      for (const std::uint32_t q : irregular_) {
        const SurfaceQuad& quad = layout_.quads()[q];
        const Patch patch = surface_.patch(quad.patch);
        LimitEvaluator evaluator(patch);
        for (std::size_t k = 0; k < 4; ++k) {
          if (valences[quad.corners[k]] >= least_flat_quads && flats_[quad.corners[k]].radius > 0)
            visit(patch, evaluator, quad, q, k);
        }
      }
    };
    each_corner([&](const Patch& patch, LimitEvaluator& evaluator, const SurfaceQuad& quad, std::uint32_t,
                    std::size_t k) {
      QuadFlat& flat = flats_[quad.corners[k]];
      const auto here = evaluator.frame({0, 0, k == 1 || k == 2 ? 1.0 : 0.0, k >= 2 ? 1.0 : 0.0}).normal;
      std::optional<Vector3>& normal = normals[quad.corners[k]];
      if (!normal) normal = here;
      if (!here || patch.kind->transient() || length(cross(*here, *normal)) > same_plane) {
        flat.radius = 0;
        return;
      }
      Ring ring;
      for (unsigned level = first_flat_level; level < most_depth; ++level) {
        ring = ring_at(evaluator, k, level - (quad.half ? 1 : 0));
        if (ring.highest <= share_of_flats * error_) break;
      }
      flat.radius = std::min(flat.radius, ring.nearest);
    });
    // Levels of pieces in the ball; tips are in its inner part.
    each_corner([&](const Patch&, LimitEvaluator& evaluator, const SurfaceQuad& quad, std::uint32_t q,
                    std::size_t k) {
      QuadFlat& flat = flats_[quad.corners[k]];
      unsigned level = first_flat_level;
      const unsigned less = quad.half ? 1 : 0;
      while (level < most_depth && ring_at(evaluator, k, level - less).nearest >= flat.radius) ++level;
      flat.first = std::min(flat.first, level);
      while (level < most_depth &&
             ring_at(evaluator, k, level - less).farthest > FlatBall::inner * flat.radius)
        ++level;
      QuadPiece tip;
      tip.level = level - less;
      const std::uint32_t end = (std::uint32_t{1} << tip.level) - 1;
      tip.i = k == 1 || k == 2 ? end : 0;
      tip.j = k >= 2 ? end : 0;
      layout_.deepen(q, tip, 0, most_depth);
    });
    static_cast<void>(layout_.take_changed({}));
  }
  [[nodiscard]] bool is_flat(std::uint32_t name) const {
    return !flats_.empty() && flats_[name].radius > 0 && std::isfinite(flats_[name].radius);
  }
  [[nodiscard]] std::array<QuadFlat, 4> flats_of(std::uint32_t q) const {
    std::array<QuadFlat, 4> flats{};
    const SurfaceQuad& quad = layout_.quads()[q];
    for (std::size_t k = 0; k < 4; ++k) {
      if (!is_flat(quad.corners[k])) continue;
      flats[k] = flats_[quad.corners[k]];
      flats[k].first -= quad.half ? 1 : 0;
    }
    return flats;
  }
  void split_flat(std::uint32_t name) {
    if (flats_[name].splits == most_flat_splits) return;
    ++flats_[name].splits;
    changed_flats_[name] = true;
  }

  // Makes the pieces of some quads, by their present depths.
  void fit(const std::vector<std::uint32_t>& quads, double done) {
    std::atomic<std::size_t> count{0};
    parallel_for_with(
        quads.size(), run_.threads, [] { return Patch(); },
        [&](Patch& patch, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            surface_.patch(layout_.quads()[quads[i]].patch, patch);
            pieces_[quads[i]] =
                QuadPieces(patch, layout_.depths(quads[i]), share_of_fits * error_, flats_of(quads[i]))
                    .take();
          }
          count += end - begin;
          monitor_.report(
              std::max(done, 0.7 * static_cast<double>(count) / static_cast<double>(quads.size())));
        });
  }

  [[nodiscard]] std::uint64_t spans() const {
    std::uint64_t sum = 0;
    for (const std::vector<QuadPiece>& pieces : pieces_) sum += spans_of(pieces);
    return sum;
  }

  // The same for quads whose depths have changed. If the budget does not allow it they keep their pieces, and the result is false.
  bool fit_changed() {
    changed_ = layout_.take_changed(irregular_);
    for (const std::uint32_t q : irregular_) {
      const auto& corners = layout_.quads()[q].corners;
      if (!flats_.empty() && std::any_of(corners.begin(), corners.end(),
                                         [&](std::uint32_t name) { return changed_flats_[name]; }))
        changed_.push_back(q);
    }
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    std::fill(changed_flats_.begin(), changed_flats_.end(), false);
    std::vector<std::vector<QuadPiece>> before;
    for (const std::uint32_t q : changed_) before.push_back(pieces_[q]);
    fit(changed_, 0.7);
    if (spans() <= budget_) return true;
    for (std::size_t k = 0; k < changed_.size(); ++k) pieces_[changed_[k]] = std::move(before[k]);
    spent_ = true;
    return false;
  }

  // Splits at tips that are too far from the surface, until none is or the budget is spent.
  void refine_tips() {
    changed_ = irregular_;
    while (!changed_.empty() && !spent_) {
      for (const std::uint32_t q : changed_) {
        for (const QuadPiece& piece : pieces_[q]) {
          if (piece.tip && piece.corners() == 0) layout_.join_depths(q, piece);
          if (piece.bent && piece.distance > share_of_fits * error_) {
            const ParameterBox box = piece.box();
            const bool right = box.u0 >= 0.5, upper = box.v0 >= 0.5;
            split_flat(layout_.quads()[q].corners[upper ? (right ? 2 : 3) : (right ? 1 : 0)]);
          }
          if (!piece.tip || piece.distance <= share_of_fits * error_) continue;
          const double levels = std::log(piece.distance / (share_of_fits * error_)) / std::log(level_factor);
          const double more = std::clamp(std::floor(levels), 1.0, 8.0);
          layout_.deepen(q, piece, static_cast<std::uint8_t>(more), most_depth);
        }
      }
      layout_.level_depths();
      fit_changed();
    }
  }

  bool deepen_at_breaks(const std::vector<Break>& breaks) override {
    std::set<std::pair<std::uint32_t, std::size_t>> sides;
    std::set<std::uint32_t> names;
    for (const Break& there : breaks) {
      const std::uint32_t name =
          layout_.quads()[there.quad].corners[(there.side + (there.at < 0.5 ? 0 : 1)) % 4];
      if (is_flat(name)) {
        names.insert(name);
      } else {
        sides.insert({there.quad, there.side});
      }
    }
    for (const std::uint32_t name : names) split_flat(name);
    for (const auto& [q, side] : sides) {
      for (const QuadPiece& piece : pieces_[q]) {
        if (piece.tip && (piece.sides() >> side) % 2 == 1) layout_.deepen(q, piece, 1, most_depth);
      }
    }
    if (!fit_changed() || changed_.empty()) return false;
    refine_tips();
    return true;
  }

  [[nodiscard]] bool may_break(const FaceDraft& draft) const override {
    const auto& pieces = pieces_[draft.at(0, 0).quad];
    return draft.width * draft.height == 1 &&
           std::any_of(pieces.begin(), pieces.end(), [](const QuadPiece& piece) { return piece.tip; });
  }

  void make_face(const FaceDraft& draft, Brep::Face& face) const override {
    take_parts(parts_of(draft), degree_, face);
  }
  [[nodiscard]] std::vector<FacePart> parts_of(const FaceDraft& draft) const {
    std::vector<FacePart> parts;
    for (std::size_t y = 0; y < draft.height; ++y) {
      for (std::size_t x = 0; x < draft.width; ++x) {
        const PlacedQuad& placed = draft.at(x, y);
        const Point3 origin = origins_[placed.quad];
        for (const QuadPiece& piece : pieces_[placed.quad]) {
          const ParameterBox box = piece.box();
          const double u = static_cast<double>(x), v = static_cast<double>(y);
          parts.push_back({{u + box.u0, u + box.u1, v + box.v0, v + box.v1},
                           placed.turn == 0 ? piece.piece : turned(piece.piece, placed.turn),
                           origin,
                           piece.tip || piece.bent,
                           piece.distance});
        }
      }
    }
    return parts;
  }

  std::size_t degree_;
  std::vector<std::uint32_t> irregular_, changed_;  // quads
  std::vector<std::vector<QuadPiece>> pieces_;      // of quads
  std::vector<QuadFlat> flats_;                     // of corners, by name; levels as of whole quads
  std::vector<bool> changed_flats_;
  std::vector<Point3> origins_;
};

}  // namespace

Brep brep_of_quads(const LimitSurface& surface, const BrepOptions& options, const Run& run) {
  return QuadBrepMaker(surface, options, run).run();
}

}  // namespace snug
