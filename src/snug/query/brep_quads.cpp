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

  // Makes the pieces of some quads, by their present depths.
  void fit(const std::vector<std::uint32_t>& quads, double done) {
    std::atomic<std::size_t> count{0};
    parallel_for_with(
        quads.size(), run_.threads, [] { return Patch(); },
        [&](Patch& patch, std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            surface_.patch(layout_.quads()[quads[i]].patch, patch);
            pieces_[quads[i]] = QuadPieces(patch, layout_.depths(quads[i]), share_of_fits * error_).take();
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
    for (const Break& there : breaks) sides.insert({there.quad, there.side});
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
                           piece.tip,
                           piece.distance});
        }
      }
    }
    return parts;
  }

  std::size_t degree_;
  std::vector<std::uint32_t> irregular_, changed_;  // quads
  std::vector<std::vector<QuadPiece>> pieces_;      // of quads
  std::vector<Point3> origins_;
};

}  // namespace

Brep brep_of_quads(const LimitSurface& surface, const BrepOptions& options, const Run& run) {
  return QuadBrepMaker(surface, options, run).run();
}

}  // namespace snug
