#include <snug/search/crossing.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/descent.h>
#include <snug/patch/evaluate.h>
#include <support/direction.h>

namespace snug {
namespace {

// Levels that a piece near an extraordinary corner is split, if it can be, before its whole net stands for its
// edge.
constexpr unsigned edge_levels = 8;
// Levels from the given piece to one that is small enough to pass between the strips.
constexpr unsigned probe_levels = 16;
// Least sine of the angle between the normal of a base triangle and an edge of the limit triangle: they are
// across each other but for what the planes of the two triangles differ.
constexpr double min_edge_sine = 0.5;

// Bezier points of the polynomial `part` whose hull holds its edge from corner k to k + 1.
template <class Visit>
void visit_bezier_edge(const Patch& patch, std::size_t part, std::size_t edge, const Visit& visit) {
  const BezierRows& form = patch.kind->form();
  const std::size_t degree = form.degree, first = part * bezier_count(degree);
  const double error = form.rows.result_error(patch.largest, patch.error);
  for (std::size_t t = 0; t <= degree; ++t) {
    const std::size_t at = edge == 0   ? bezier_index(degree, t, 0)
                           : edge == 1 ? bezier_index(degree, degree - t, t)
                                       : bezier_index(degree, 0, t);
    visit(form.rows.apply<Vector3>(first + at, patch.points), error);
  }
}

// Points with their errors, relative to the patch's origin, whose hull holds the curve from corner k to k +
// 1.
template <class Visit>
void visit_edge(const Patch& patch, std::size_t edge, unsigned level, const Visit& visit) {
  if (!patch.kind->polynomial()) {
    if (level == edge_levels || patch.path.level() == PiecePath::max_level) {
      for (const Vector3& p : patch.points) visit(p, patch.error);
      return;
    }
    visit_edge(split(patch, static_cast<unsigned>(edge)), edge, level + 1, visit);
    visit_edge(split(patch, static_cast<unsigned>((edge + 1) % 3)), edge, level + 1, visit);
    return;
  }
  const std::size_t own = patch.to_kind(edge);  // corner of the kind that the edge begins at
  // Two parts are 0, 1, m and m, 1, 2.
  const bool halves = patch.kind->form().parts > 1;
  visit_bezier_edge(patch, halves && own == 1 ? 1 : 0, own, visit);
  if (halves && own == 2) visit_bezier_edge(patch, 1, own, visit);
}

}  // namespace

CrossingTest::CrossingTest(const Piece& piece, const Heights& heights) {
  const OffsetTriangle& offset = piece.offset;
  normal_ = unit_normal(offset.base);
  if (normal_ == Vector3{} || !std::isfinite(heights.lower) || !std::isfinite(heights.upper)) return;
  from_ = offset.base[0];
  lower_ = heights.lower;
  upper_ = heights.upper;
  const Patch& patch = piece.patch;
  const auto [corners, corner_error] = limit_triangle(patch);
  for (std::size_t k = 0; k < 3; ++k) {
    Strip& strip = strips_[k];
    const Vector3 edge = corners[(k + 1) % 3] - corners[k];
    // Of an edge nearly along the normal the product is mostly rounding: then it is not across either.
    const Vector3 along = normalized(edge), inward = cross(normal_, along);
    if (!(length(inward) > min_edge_sine)) return;
    strip.inward = normalized(inward);
    strip.from = corners[k];
    // Both ends of the edge belong to its curve: the exact corners are within their error of these.
    double widest = std::max(0.0, dot(strip.inward, edge)) + 2 * corner_error;
    const Vector3 from = strip.from - patch.origin;
    double largest = max_abs(from);
    visit_edge(patch, k, 0, [&](const Vector3& p, double error) {
      widest = std::max(widest, dot(strip.inward, p - from) + 2 * spatial_error(error));
      largest = std::max(largest, max_abs(p));
    });
    strip.width = enlarged(widest + gamma_bound(64) * largest);
    // Nothing is free unless the opposite corner lies beyond the strip.
    if (!(dot(strip.inward, corners[(k + 2) % 3] - strip.from) > strip.width)) return;
  }
  possible_ = true;
}

double CrossingTest::rounding(const Triangle& points) const {
  double largest = 0;
  for (const Point3& p : points) largest = std::max(largest, max_abs(p - from_));
  return gamma_bound(32) * (largest + 4);
}

bool CrossingTest::holds(const Triangle& around, double radius) const {
  const double reach = enlarged(radius) + rounding(around);
  for (const Strip& strip : strips_) {
    for (const Point3& p : around) {
      if (!(dot(strip.inward, p - strip.from) - reach > strip.width)) return false;
    }
  }
  return true;
}

CrossingTest::Sides CrossingTest::sides(const Triangle& points, double error) const {
  const double reach = enlarged(error) + rounding(points);
  Sides found;
  for (const Point3& p : points) {
    const double height = dot(normal_, p - from_);
    found.below = found.below || height + reach < lower_;
    found.above = found.above || height - reach > upper_;
  }
  return found;
}

namespace {

// Cache and method that bound pieces.
struct BoundedBy {
  BoundsCache& library;
  BoundMethod method;
};

// A piece, not kept, since surfaces that nearly lie in each other ask at every pair; and a parameter of it.
struct Probe {
  Piece piece;
  TriangleParameter at;
};

// The parameter in the middle child; nothing if it rounds.
std::optional<TriangleParameter> in_middle_child(TriangleParameter p) {
  const TriangleParameter turned{1 - 2 * p.u, 1 - 2 * p.v};
  // In [0, 1]; a difference that was rounded does not lead back.
  if (1 - turned.u != 2 * p.u || 1 - turned.v != 2 * p.v) return std::nullopt;
  return turned;
}

// Adds the children whose closed triangles hold the parameter: all have its limit point in common, so
// together they are connected. False, with the child that descend() names alone, where its parameter there
// rounds: what holds that need not hold the others'.
bool add_children(const BoundedBy& by, const Probe& probe, std::vector<Probe>& out) {
  thread_local BoundingPoints scratch;
  const auto [u, v] = probe.at;
  const Descent certain = descend(probe.at);
  const auto add = [&](unsigned child, TriangleParameter at) {
    out.push_back({child_of(by.library, probe.piece, child, scratch, by.method), at});
  };
  if (certain.child == 3) {
    const bool exact = in_middle_child(probe.at).has_value();
    if (!exact) out.clear();
    add(3, certain.at);
    return exact;
  }
  // Doubling and subtracting 1 from [1, 2] are exact.
  if (sum_at_most(u, v, 0.5)) add(0, {2 * u, 2 * v});
  if (u >= 0.5) add(1, {2 * u - 1, 2 * v});
  if (v >= 0.5) add(2, {2 * u, 2 * v - 1});
  const bool on_far_edge = sum_at_most(u, v, 0.5) && u + v == 0.5;
  if (u <= 0.5 && v <= 0.5 && (on_far_edge || !sum_at_most(u, v, 0.5))) {
    if (const auto at = in_middle_child(probe.at)) add(3, *at);
  }
  return true;
}

// Do pieces of `whole` around a parameter cross, those that meet there together? Splits some levels down, and
// keeps nothing. seen: the pieces' frame as seen from that of the crossed piece.
bool crosses_near(const BoundedBy& by, const Piece& whole, TriangleParameter at, const CrossingTest& crossed,
                  const RelativeFrame& seen) {
  if (!seen.comparable) return false;
  std::vector<Probe> probes{{whole, on_triangle(at)}}, children;
  for (unsigned level = 0;; ++level) {
    // seen.slack covers the mapping; lengths grow by its scale.
    const double growth = seen.scale * (1 + 0x1p-20);
    double extent = 0;
    bool inside = true, below = false, above = false, last = false;
    for (const Probe& probe : probes) {
      const Piece& piece = probe.piece;
      const LimitTriangle limit = limit_triangle(piece.patch);
      Triangle around, corners;
      for (std::size_t k = 0; k < 3; ++k) {
        around[k] = seen.apply(piece.offset.base[k]);
        corners[k] = seen.apply(limit.corners[k]);
        extent = std::max(extent, length(corners[k] - corners[0]));
      }
      inside = inside && crossed.holds(around, growth * piece.offset.radius + seen.slack);
      const CrossingTest::Sides sides = crossed.sides(corners, growth * limit.error + seen.slack);
      below = below || sides.below;
      above = above || sides.above;
      last = last || piece.patch.path.level() == PiecePath::max_level;
    }
    if (inside && below && above) return true;
    if (2 * extent < crossed.thickness() || level == probe_levels || last) return false;
    children.clear();
    for (const Probe& probe : probes) {
      if (!add_children(by, probe, children)) break;
    }
    probes.swap(children);
  }
}

}  // namespace

bool proves_crossing(PairFrames& frames, const PiecePair& pieces) {
  const std::optional<PairOfPoints> middle = middle_of_contact(pieces.base[0], pieces.base[1]);
  if (!middle) return false;
  const std::array<Barycentric, 2> at{middle->on_a, middle->on_b};
  thread_local BoundingPoints points;
  std::array<Piece, 2> whole;
  std::array<Heights, 2> heights;
  for (std::size_t s = 0; s < 2; ++s) {
    PieceCache& cache = frames.cache(s);
    const SurfaceBvh& model = cache.model();
    const PatchId root = cache.name(pieces.nodes[s]).patch;
    whole[s] =
        make_piece(model.surface().library(), root, cache.patch(pieces.nodes[s]), points, model.method());
    heights[s] =
        model.method() == BoundMethod::table ? heights_of(whole[s].offset) : heights_of(whole[s], points);
  }
  for (std::size_t s = 0; s < 2; ++s) {
    const CrossingTest crossed(whole[s], heights[s]);
    const SurfaceBvh& other = frames.cache(1 - s).model();
    if (crossed.possible() && crosses_near({other.surface().library(), other.method()}, whole[1 - s],
                                           clamped(at[1 - s]), crossed, frames.seen_from(s))) {
      return true;
    }
  }
  return false;
}

std::optional<PairOfPoints> proved_crossing(BoundsCache& library, const Piece& a, const Piece& b) {
  const std::optional<PairOfPoints> middle = middle_of_contact(a.offset.base, b.offset.base);
  if (!middle) return std::nullopt;
  const std::array<const Piece*, 2> pieces{&a, &b};
  const std::array<Barycentric, 2> at{middle->on_a, middle->on_b};
  thread_local BoundingPoints points;
  RelativeFrame same;
  same.rows = {Vector3{1, 0, 0}, Vector3{0, 1, 0}, Vector3{0, 0, 1}};
  for (std::size_t s = 0; s < 2; ++s) {
    const Piece whole = make_piece(library, pieces[s]->root, pieces[s]->patch, points);
    const CrossingTest crossed(whole, heights_of(whole, points));
    if (crossed.possible() &&
        crosses_near({library, BoundMethod::rows}, *pieces[1 - s], clamped(at[1 - s]), crossed, same)) {
      return middle;
    }
  }
  return std::nullopt;
}

}  // namespace snug
