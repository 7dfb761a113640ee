#include <snug/query/brep_maker.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/spline/hermite_face.h>
#include <snug/surface/unscale.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {
namespace {

constexpr double share_of_curves = 0.4;     // of the error, for curves of edges
constexpr std::size_t most_spans = 40'000;  // of a square of a face
constexpr std::uint32_t least_flat_triangles = 11;
constexpr unsigned most_flat_level = 40;
constexpr double budget_factor = 4;  // by which the error grows if spans do not suffice
constexpr double same_jet = 0x1p-42;
constexpr double least_span =
    0x1p-28;  // of an edge, between knots that are made where faces meet at an angle

// Faces of triangles of Loop's scheme.
class TriangleBrepMaker : public BrepMaker {
 public:
  TriangleBrepMaker(const LimitSurface& surface, const BrepOptions& options, const Run& run)
      : BrepMaker(surface, options, run), reached_(error_), curves_(surface.topology().edge_count()) {}

 private:
  void fit() override {
    surface_.find_kinds(run_.threads);
    drafts_ = layout_.packed([this](const QuadSide& a, const QuadSide& b) { return continues(a, b); });
    std::uint64_t least = 0;
    for (const FaceDraft& draft : drafts_) least += draft.width * draft.height;
    require_spans(least);
    fit_curves();
  }

  // The patch that has a side of a quad, and which of its own sides this is.
  struct PatchEdge {
    PatchId patch;
    unsigned side;
  };
  [[nodiscard]] PatchEdge edge_of(const QuadSide& s) const {
    const PairedTriangles& pair = *layout_.quads()[s.quad].pair;
    const auto side = static_cast<unsigned>(s.side);
    if (side < 2 || !pair.upper) return {pair.lower, (side + pair.turn) % 3};
    return {*pair.upper, (side - 1 + pair.upper_turn) % 3};
  }

  // The curves of edges, each from the first quad that has it.
  void fit_curves() {
    std::vector<QuadSide> owners(curves_.size(), {UINT32_MAX, 0});
    for (std::uint32_t q = 0; q < layout_.quads().size(); ++q) {
      const SurfaceQuad& quad = layout_.quads()[q];
      for (std::size_t k = 0; k < quad.side_count(); ++k) {
        QuadSide& owner = owners[quad.sides[k].number];
        if (owner.quad == UINT32_MAX) owner = {q, k};
      }
    }
    if (max_angle_) find_flats();
    parallel_for(owners.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t e = begin; e < end; ++e) {
        monitor_.checkpoint();
        if (owners[e].quad == UINT32_MAX) continue;
        TriangleTree tree = tree_along(owners[e]);
        put_curve(owners[e], curve_near(tree, share_of_curves * reached_));
      }
      monitor_.report(0.2 * static_cast<double>(end) / static_cast<double>(owners.size()));
    });
    owners_ = std::move(owners);
  }
  [[nodiscard]] TriangleTree tree_along(const QuadSide& s) const {
    const PatchEdge edge = edge_of(s);
    return tree_of(edge.patch, edge.side, SquareHalf::lower);
  }
  [[nodiscard]] TriangleTree tree_of(PatchId patch, unsigned turn, SquareHalf half) const {
    TriangleTree tree(surface_.patch(patch), turn, half);
    if (flats_.empty()) return tree;
    const auto names = surface_.corner_names(patch);
    for (std::size_t k = 0; k < 3; ++k) {
      const double radius = flats_[names[(k + turn) % 3]];
      if (radius > 0 && std::isfinite(radius)) tree.flatten(k, radius);
    }
    return tree;
  }

  // Vertices about which faces become flat, and how far: as far as the surface is near enough to its tangent plane. Where valences are high
  // normals change by a factor close to 1 with each halving, and bicubics cannot follow them.
  void find_flats() {
    std::vector<PatchId> patches;
    std::vector<std::uint32_t> valences(surface_.corner_name_count());
    for (const SurfaceQuad& quad : layout_.quads()) {
      for (const auto& patch : {std::optional(quad.pair->lower), quad.pair->upper}) {
        if (!patch || surface_.kind(*patch).polynomial()) continue;
        patches.push_back(*patch);
        for (const std::uint32_t name : surface_.corner_names(*patch)) ++valences[name];
      }
    }
    flats_.assign(valences.size(), INFINITY);
    std::vector<std::optional<Vector3>> normals(valences.size());
    for (const PatchId patch : patches) {
      const auto names = surface_.corner_names(patch);
      for (unsigned k = 0; k < 3; ++k) {
        if (valences[names[k]] < least_flat_triangles) continue;
        TriangleTree tree(surface_.patch(patch), k, SquareHalf::lower);
        const auto here = tree.normal(0);
        std::optional<Vector3>& normal = normals[names[k]];
        if (!normal) normal = here;
        const bool plane = here && length(cross(*here, *normal)) <= same_plane;
        double& radius = flats_[names[k]];
        radius = plane ? std::min(radius, flat_radius(tree, *here)) : 0;
      }
    }
  }
  // Around corner 0.
  [[nodiscard]] double flat_radius(TriangleTree& tree, const Vector3& normal) const {
    const Vector3 center = tree.limit(0, 0);
    double t = 0.25;
    for (unsigned level = 2; level <= most_flat_level; ++level, t *= 0.5) {
      double least = INFINITY, highest = 0;
      for (int k = 0; k <= 8; ++k) {
        const Vector3 d = tree.limit(t, 0.125 * k * t) - center;
        least = std::min(least, length(d));
        highest = std::max(highest, std::fabs(dot(normal, d)));
      }
      if (highest <= share_of_flats * reached_) return least;
    }
    return t;
  }
  [[nodiscard]] const PatchSide& side_of_mesh(const QuadSide& s) const {
    return layout_.quads()[s.quad].sides[s.side];
  }
  void put_curve(const QuadSide& s, HermiteCurve curve) {
    const PatchSide& side = side_of_mesh(s);
    curves_[side.number] = side.reversed ? curve.reversed() : std::move(curve);
  }
  [[nodiscard]] HermiteCurve curve_along(const QuadSide& s) const {
    const PatchSide& side = side_of_mesh(s);
    return side.reversed ? curves_[side.number].reversed() : curves_[side.number];
  }

  // The two triangles of a quad that is turned by none or two quarters. Corner k of the lower half is then that of the upper one at
  // k + 1.
  [[nodiscard]] FaceSquare square_of(const PlacedQuad& placed) const {
    const PairedTriangles& pair = *layout_.quads()[placed.quad].pair;
    if (!pair.upper) return {tree_of(pair.lower, pair.turn, SquareHalf::lower), {}};
    if (placed.turn == 0) {
      return {tree_of(pair.lower, pair.turn, SquareHalf::lower),
              tree_of(*pair.upper, pair.upper_turn, SquareHalf::upper)};
    }
    return {tree_of(*pair.upper, pair.upper_turn + 1u, SquareHalf::lower),
            tree_of(pair.lower, pair.turn + 2u, SquareHalf::upper)};
  }

  // Are all four triangles polynomials, with the same derivatives at both ends of the side?
  [[nodiscard]] bool continues(const QuadSide& s, const QuadSide& t) const {
    for (const std::uint32_t q : {s.quad, t.quad}) {
      const PairedTriangles& pair = *layout_.quads()[q].pair;
      if (!pair.upper || !surface_.kind(pair.lower).polynomial() || !surface_.kind(*pair.upper).polynomial())
        return false;
    }
    const std::size_t turn = (t.side + 6 - s.side) % 4;
    if (turn % 2 != 0) return false;
    FaceSquare a = square_of({s.quad, 0}), b = square_of({t.quad, static_cast<std::uint8_t>(turn)});
    // In the parameters of the first: its corners of the side, and those of the other square.
    constexpr std::array<std::array<double, 2>, 4> corners{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    const std::array<double, 2> beyond{s.side == 1   ? 1.0
                                       : s.side == 3 ? -1.0
                                                     : 0.0,
                                       s.side == 2   ? 1.0
                                       : s.side == 0 ? -1.0
                                                     : 0.0};
    for (const std::size_t k : {s.side, (s.side + 1) % 4}) {
      const double u = corners[k][0], v = corners[k][1], x = u - beyond[0], y = v - beyond[1];
      TriangleTree &p = v <= u ? a.lower : *a.upper, &q = y <= x ? b.lower : *b.upper;
      const auto i = p.jet(u, v), j = q.jet(x, y);
      if (!i || !j) return false;
      const double size = max_abs(i->point) + max_abs(j->point) + max_abs(q.origin() - p.origin()) +
                          max_abs(i->along_u) + max_abs(i->along_v) + max_abs(i->twist);
      for (const Vector3& off : {i->point - (j->point + (q.origin() - p.origin())), i->along_u - j->along_u,
                                 i->along_v - j->along_v, i->twist - j->twist}) {
        if (max_abs(off) > same_jet * size) return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::vector<HermiteCurve> border_of(const FaceDraft& draft) const {
    const std::size_t w = draft.width, h = draft.height;
    std::vector<HermiteCurve> border;
    const auto add = [&](const PlacedQuad& placed, std::size_t side) {
      border.push_back(curve_along({placed.quad, (side + placed.turn) % 4}));
    };
    for (std::size_t k = 0; k < w; ++k) add(draft.at(k, 0), 0);
    for (std::size_t k = 0; k < h; ++k) add(draft.at(w - 1, k), 1);
    for (std::size_t k = w; k-- > 0;) add(draft.at(k, h - 1), 2);
    if (layout_.quads()[draft.at(0, 0).quad].side_count() == 3) return border;
    for (std::size_t k = h; k-- > 0;) add(draft.at(0, k), 3);
    return border;
  }

  // If the spans of all faces exceed the budget, the error grows.
  bool prepare(bool again) override {
    for (;;) {
      faces_.assign(drafts_.size(), {});
      std::atomic<std::uint64_t> spans{0};
      std::atomic<std::size_t> count{0};
      std::atomic<bool> far{false};
      parallel_for(drafts_.size(), run_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t f = begin; f < end && spans <= budget_; ++f) {
          monitor_.checkpoint();
          const FaceDraft& draft = drafts_[f];
          std::vector<FaceSquare> squares;
          for (const PlacedQuad& placed : draft.quads) squares.push_back(square_of(placed));
          HermiteFace face(draft.width, draft.height, std::move(squares), border_of(draft));
          if (!face.refine(share_of_fits * reached_, most_spans * draft.quads.size())) far = true;
          spans += face.spans();
          faces_[f] = face.parts();
        }
        count += end - begin;
        monitor_.report(0.2 + 0.5 * static_cast<double>(count) / static_cast<double>(drafts_.size()));
      });
      spent_ = spent_ || far || spans > budget_;
      if (again && spent_) return false;
      if (spans <= budget_) return true;
      reached_ *= budget_factor;
      fit_curves();
    }
  }

  void make_face(const FaceDraft& draft, Brep::Face& face) const override {
    take_parts(faces_[static_cast<std::size_t>(&draft - drafts_.data())], 3, face);
  }
  [[nodiscard]] bool may_break(const FaceDraft&) const override { return true; }

  // Knots of the edge's curve there, which both faces then have: one, or at an end of the edge, where angles fall slowly, several.
  bool deepen_at_breaks(const std::vector<Break>& breaks) override {
    bool any = false;
    std::vector<std::vector<std::pair<double, double>>> more(curves_.size());
    for (const Break& there : breaks) {
      const PatchSide& side = side_of_mesh({there.quad, there.side});
      more[side.number].emplace_back(side.reversed ? 1 - there.at : there.at, there.angle);
    }
    for (std::size_t e = 0; e < curves_.size(); ++e) {
      if (more[e].empty()) continue;
      std::vector<double> knots;
      for (const HermiteCurve::Node& node : curves_[e].nodes) knots.push_back(node.t);
      for (const auto& [t, angle] : more[e]) any = split_at(t, angle, knots) || any;
      TriangleTree tree = tree_along(owners_[e]);
      const PatchSide& side = side_of_mesh(owners_[e]);
      if (side.reversed) {
        for (double& t : knots) t = 1 - t;
        std::reverse(knots.begin(), knots.end());
      }
      put_curve(owners_[e], curve_with(tree, knots));
    }
    return any && !spent_;
  }

  static bool split_at(double t, double angle, std::vector<double>& knots) {
    const auto next = std::upper_bound(knots.begin(), knots.end(), t);
    if (next == knots.begin() || next == knots.end() || *(next - 1) == t) return false;
    const double begin = *(next - 1), end = *next;
    if (end - begin <= least_span) return false;
    const bool first = begin == 0, last = end == 1;
    const double halvings = first == last ? 1 : std::clamp(std::floor(std::log2(angle)), 1.0, 8.0);
    std::vector<double> between;
    double length = end - begin;
    for (double k = 0; k < halvings && length > least_span; ++k) {
      length *= 0.5;
      between.push_back(last ? end - length : begin + length);
    }
    if (!last) std::reverse(between.begin(), between.end());
    knots.insert(next, between.begin(), between.end());
    return true;
  }

  double reached_;
  std::vector<double> flats_;         // radii about corners, by name; 0 or infinite where faces are not flat
  std::vector<HermiteCurve> curves_;  // of edges, in their own direction
  std::vector<QuadSide> owners_;      // likewise, by which they were made
  std::vector<std::vector<FacePart>> faces_;
};

// Facets: bilinear faces, whose lower half is the facet.
class FacetBrepMaker : public BrepMaker {
 public:
  using BrepMaker::BrepMaker;

 private:
  void fit() override {
    drafts_ = layout_.packed([](const QuadSide&, const QuadSide&) { return false; });
    require_spans(drafts_.size());
  }
  void make_face(const FaceDraft& draft, Brep::Face& face) const override {
    const SurfaceQuad& quad = layout_.quads()[draft.at(0, 0).quad];
    std::array<Point3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = back_.apply(surface_.scaled_point(VertexId(quad.corners[k])));
    face.surface = {1, {0, 0, 1, 1}, {0, 0, 1, 1}, {p[0], p[1], p[0] + (p[2] - p[1]), p[2]}};
    // The fourth point is rounded, and weighs a quarter where u = v at most.
    double largest = 0;
    for (const Point3& q : face.surface.points) largest = std::max(largest, max_abs(q - Point3{}));
    require_representable(face.surface.points[2]);
    face.error_bound = spatial_error(enlarged(4 * unit_roundoff * largest));
  }
  [[nodiscard]] bool may_break(const FaceDraft&) const override { return false; }
  bool deepen_at_breaks(const std::vector<Break>&) override { return false; }
};

}  // namespace

Brep brep_of_triangles(const LimitSurface& surface, const BrepOptions& options, const Run& run) {
  if (surface.rules().basis == RegularBasis::linear) return FacetBrepMaker(surface, options, run).run();
  return TriangleBrepMaker(surface, options, run).run();
}

}  // namespace snug
