#include <snug/bounds/bounding_rows.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
namespace {

// Dense rows over the control points of the root kind: middle and radius, the radius kept for a whole row as
// a bound of the sum of its entries' errors (interval arithmetic in midpoint-radius form).
struct DenseRows {
  std::size_t width = 0;
  std::vector<double> entries;   // row-major
  std::vector<double> errors;    // a row
  std::vector<double> abs_sums;  // a row: of the entries as stored
  [[nodiscard]] std::size_t count() const { return errors.size(); }
};

DenseRows identity(std::size_t count) {
  DenseRows rows{count, std::vector<double>(count * count, 0.0), std::vector<double>(count, 0.0),
                 std::vector<double>(count, 1.0)};
  for (std::size_t i = 0; i < count; ++i) rows.entries[i * count + i] = 1;
  return rows;
}

void append_all(const DenseRows& from, DenseRows& to) {
  for (const auto part : {&DenseRows::entries, &DenseRows::errors, &DenseRows::abs_sums}) {
    (to.*part).insert((to.*part).end(), (from.*part).begin(), (from.*part).end());
  }
}

void append(const DenseRows& from, std::size_t r, DenseRows& to) {
  const auto first = from.entries.begin() + static_cast<std::ptrdiff_t>(r * from.width);
  to.entries.insert(to.entries.end(), first, first + static_cast<std::ptrdiff_t>(from.width));
  to.errors.push_back(from.errors[r]);
  to.abs_sums.push_back(from.abs_sums[r]);
}

// The control net of a piece: rows of all new points of a step, and which of them are its own.
struct Net {
  const DenseRows& rows;
  std::span<const std::uint32_t> control;
};

// The chosen rows of stencils * net, appended to out.
//
// For a row sum_k a_k N_k with a_k off by d_k and N_k off by e_k:  the sum of entries' errors is at most
//   sum |a_k| e_k  +  sum d_k (|N_k| + e_k)  +  gamma(n) sum |a_k| |N_k|.
void append_product(const Stencils& stencils, std::size_t r, const Net& of, DenseRows& out) {
  const Stencils::Row row = stencils.row(r);
  const DenseRows& net = of.rows;
  const std::size_t begin = out.entries.size();
  out.entries.resize(begin + net.width);
  double* const target = out.entries.data() + begin;
  kernels::combine_rows({net.entries.data(), net.width, of.control, row.sources, row.weights}, target);
  double error = 0, largest = 0, magnitude = 0;
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    const std::size_t k = of.control[row.sources[i]];
    const double weight = row.weights[i];
    error += std::fabs(weight) * net.errors[k];
    magnitude += std::fabs(weight) * net.abs_sums[k];
    largest = std::max(largest, net.abs_sums[k] + net.errors[k]);
  }
  double abs_sum = 0;
  for (std::size_t c = 0; c < net.width; ++c) abs_sum += std::fabs(target[c]);
  const double tiny = static_cast<double>(net.width * row.sources.size()) * underflow_error;
  out.errors.push_back(
      enlarged(error + row.error * largest + gamma_bound(row.sources.size()) * magnitude + tiny));
  out.abs_sums.push_back(abs_sum * (1 + gamma_bound(net.width)));
}

// Writes stencils * net over `out`, which keeps its memory.
void multiply(const Stencils& stencils, const Net& net, DenseRows& out) {
  out.width = net.rows.width;
  for (std::vector<double>* part : {&out.entries, &out.errors, &out.abs_sums}) part->clear();
  out.entries.reserve(stencils.row_count() * out.width);
  for (std::size_t r = 0; r < stencils.row_count(); ++r) append_product(stencils, r, net, out);
}

// Edges of a piece, named by the corner they face, along which a polynomial neighbour's Bezier points are in
// the hull already: this piece's own there are convex combinations of those, as rows.
using CoveredEdges = std::array<bool, 3>;

// Place (i, j) lies on the edge that faces corner k when its k-th barycentric index is 0.
bool on_covered_edge(std::size_t degree, std::size_t i, std::size_t j, const CoveredEdges& covered) {
  return (covered[0] && i + j == degree) || (covered[1] && i == 0) || (covered[2] && j == 0);
}

// The middle one has the edges between it and others in the hull.
constexpr std::array<std::size_t, 4> order_of_children{3, 0, 1, 2};

// In the child's kind's order. In the parent's order, child c keeps corner c: its edges that face the other corners lie on the
// parent's.
CoveredEdges covered_of_child(const Kind& kind, std::size_t c, const CoveredEdges& covered) {
  const auto& children = kind.children();
  CoveredEdges inherited = c < 3 ? covered : CoveredEdges{};
  if (c < 3) inherited[c] = children[3].kind->polynomial();
  CoveredEdges own;
  for (std::size_t k = 0; k < 3; ++k) own[k] = inherited[(k + children[c].first) % 3];
  return own;
}

// each(row of the form, its indices i and j, weights of a quadratic over the whole); a plane's points are no Bezier points of a higher degree.
template <class Each>
void for_each_bezier(const BezierRows& form, const CoveredEdges& covered, const ParameterTriangle& place,
                     const Each& each) {
  for (std::size_t part = 0; part < form.parts; ++part) {
    const RaisedQuadratic quadratic(form.parts == 1 ? place : part_of(place, part),
                                    std::max<std::size_t>(form.degree, 2));
    for (std::size_t j = 0; j <= form.degree; ++j) {
      for (std::size_t i = 0; i + j <= form.degree; ++i) {
        if (form.parts == 1 && on_covered_edge(form.degree, i, j, covered)) continue;
        each(part * bezier_count(form.degree) + bezier_index(form.degree, i, j), i, j,
             form.degree < 2 ? QuadraticWeights{} : quadratic.point(i, j));
      }
    }
  }
}

// Kinds that few patches share have rows of few levels, for tables alone.
constexpr unsigned few_levels = 3;
bool has_few_levels(const Kind& kind) { return kind.transient() || kind.high_valence_beside_creases(); }

class Collector {
 public:
  Collector(const Kind& kind, unsigned max_levels) : max_levels_(max_levels) {
    rows_.width = kind.control_count();
    // At most: four pieces, three a ring, the nets of the tips.
    std::size_t most = 112;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!kind.regular_corner(i)) most += 70 * std::size_t{levels(kind, i)} + kind.corner(i).faces() + 20;
    }
    if (!has_few_levels(kind)) rows_.entries.reserve(most * rows_.width);
  }

  // Rows of one piece; `covered` counts corners as the kind does.
  void collect(const Kind& kind, const Net& net, unsigned depth, const CoveredEdges& covered,
               const ParameterTriangle& place) {
    // A split brings Bezier points nearer, but for a plane.
    if (kind.polynomial() && (depth > 0 || kind.form().degree == 1)) {
      for_each_bezier(kind.form(), covered, place,
                      [&](std::size_t row, std::size_t, std::size_t, const QuadraticWeights& quadratic) {
                        append_product(kind.form().rows, row, net, rows_);
                        quadratic_.push_back(quadratic);
                      });
      return;
    }
    if (depth >= depth_limit(kind, depth)) {
      nets_found_.push_back({&kind, tips_.count(), place});
      for (const std::uint32_t r : net.control) append(net.rows, r, tips_);
      return;
    }
    const auto& children = kind.children();
    multiply(*children[0].step, net, nets_[depth]);
    for (const bool polynomial : {true, false}) {
      for (const std::size_t c : order_of_children) {
        const KindChild& child = children[c];
        if (child.kind->polynomial() != polynomial) continue;
        collect(*child.kind, {nets_[depth], child.control}, depth + 1, covered_of_child(kind, c, covered),
                turned(child_of(place, c), child.first));
      }
    }
  }

  // Of all rows but those of nets.
  [[nodiscard]] const std::vector<QuadraticWeights>& quadratic() const { return quadratic_; }

  // Where they are among all rows.
  [[nodiscard]] std::vector<BoundingRows::Net> nets() const {
    std::vector<BoundingRows::Net> nets = nets_found_;
    for (BoundingRows::Net& net : nets) net.begin += quadratic_.size();
    return nets;
  }

  // Nets last.
  [[nodiscard]] DenseRows take() {
    append_all(tips_, rows_);
    return std::move(rows_);
  }

 private:
  [[nodiscard]] unsigned levels(const Kind& kind, std::size_t corner) const {
    return std::min(max_levels_, tip_depth(kind.corner(corner), kind.scheme()));
  }
  [[nodiscard]] unsigned depth_limit(const Kind& kind, unsigned depth) const {
    if (has_few_levels(kind)) return std::min(max_levels_, few_levels);
    unsigned limit = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (!kind.regular_corner(i)) limit = std::max(limit, levels(kind, i));
    }
    // Half a quad whose far corner alone is irregular: its children are polynomial.
    return limit > 0 ? limit : depth + 1;
  }

  unsigned max_levels_;
  DenseRows rows_, tips_;
  std::vector<QuadraticWeights> quadratic_;
  std::vector<BoundingRows::Net> nets_found_;
  std::array<DenseRows, deepest_tip + 2> nets_;  // new points of the piece at work, a depth each
};

// Is the piece at a corner, from the third level on, of a kind that comes again? Its other corners are
// regular then, and vertices of the ring that are the same by accident of few faces have come apart.
bool lasts(const KindChild& child, std::size_t corner) {
  const KindChild* piece = &child;
  const Kind* last = nullptr;
  std::size_t own = corner;
  for (int level = 0; level < 3; ++level) {
    last = piece->kind;
    own = (3 + own - piece->first) % 3;
    piece = &last->children()[own];
  }
  return piece->kind == last;
}

}  // namespace

double BoundingRows::result_error(double largest, double error) const {
  return enlarged((gamma_bound(control_count_) * abs_sum_ + entry_error_) * largest +
                  (abs_sum_ + entry_error_) * error) +
         3 * static_cast<double>(control_count_) * underflow_error;
}

bool has_self_similar_tips(const Kind& kind) {
  if (has_few_levels(kind)) return false;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    const KindChild& child = kind.children()[corner];
    if (!child.kind->polynomial() && !lasts(child, corner)) return false;
  }
  return true;
}

unsigned tip_depth(const CornerFan& fan, Scheme scheme) {
  if (fan.sharp && !fan.closed && fan.faces() == 1)
    return 4;  // the net of a lone corner is the corner of a polygon: no overhang
  const std::size_t n = fan.closed ? fan.faces() : 2 * fan.faces();
  double shrink = rules_of(scheme).shrink_factor(fan);
  // Corners that are sharp or darts shrink by 1/2 and more along their edges, and by up to 2/3 within.
  if (fan.sharp || fan.odd) shrink = std::max(shrink, 2.0 / 3);
  const double width =
      std::min(1.0, 2 * std::sin(std::numbers::pi / static_cast<double>(std::max<std::size_t>(n, 3))));
  const double levels = std::log(0.01 * width) / std::log(shrink);
  return std::clamp(static_cast<unsigned>(std::ceil(levels)), 3u, deepest_tip);
}

BoundingRows make_bounding_rows(const Kind& kind, unsigned max_levels) {
  SNUG_EXPECT(!kind.key().polygon);
  Collector collector(kind, max_levels);
  const DenseRows control = identity(kind.control_count());
  std::vector<std::uint32_t> all(kind.control_count());
  std::iota(all.begin(), all.end(), 0u);
  collector.collect(kind, {control, all}, 0, {}, whole_patch);
  const DenseRows rows = collector.take();
  BoundingRows result;
  result.count_ = rows.count();
  result.control_count_ = rows.width;
  result.weights_.resize(rows.entries.size());
  for (std::size_t r = 0; r < rows.count(); ++r) {
    for (std::size_t c = 0; c < rows.width; ++c)
      result.weights_[c * rows.count() + r] = rows.entries[r * rows.width + c];
    result.entry_error_ = std::max(result.entry_error_, rows.errors[r]);
    result.abs_sum_ = std::max(result.abs_sum_, rows.abs_sums[r]);
  }
  const std::vector<QuadraticWeights>& quadratic = collector.quadratic();
  result.bezier_count_ = quadratic.size();
  for (std::size_t k = 0; k < 6; ++k) {
    for (const QuadraticWeights& row : quadratic) result.quadratic_.push_back(row[k]);
  }
  result.nets_ = collector.nets();
  result.self_similar_ = !kind.polynomial() && has_self_similar_tips(kind);
  return result;
}

namespace {

void append_renamed(const Stencils::Row& row, std::span<const std::uint32_t> names, Stencils& out) {
  for (std::size_t i = 0; i < row.sources.size(); ++i) {
    out.add(names[row.sources[i]], row.weights[i], i == 0 ? row.error : 0.0);
  }
  out.end_row();
}

}  // namespace

std::size_t LevelStep::bytes() const {
  std::size_t bytes = points.bytes() + bezier.bytes() + quadratic.size() * sizeof(QuadraticWeights);
  for (const Net& net : nets) bytes += sizeof(Net) + net.control.size() * sizeof(std::uint32_t);
  return bytes;
}

LevelStep make_level_step(const Kind& kind) {
  const std::vector<KindChild>& children = kind.children();
  LevelStep step;
  step.points = *children[0].step;
  CoveredEdges facing{};
  for (std::size_t c = 0; c < children.size(); ++c) {
    if (children[c].kind->polynomial()) continue;
    step.nets.push_back({children[c].kind, children[c].control, c, (3 + c - children[c].first) % 3});
    if (c < 3) facing[c] = true;
  }
  if (step.nets.size() != 1) facing = {};
  for (const bool inner : {true, false}) {
    for (const std::size_t c : order_of_children) {
      const KindChild& child = children[c];
      if (!child.kind->polynomial()) continue;
      const BezierRows& form = child.kind->form();
      const CoveredEdges own = covered_of_child(kind, c, {}), beyond = covered_of_child(kind, c, facing);
      for_each_bezier(form, own, turned(child_of(whole_patch, c), child.first),
                      [&](std::size_t row, std::size_t i, std::size_t j, const QuadraticWeights& quadratic) {
                        const bool faces = form.parts == 1 && on_covered_edge(form.degree, i, j, beyond);
                        if (faces == inner) return;
                        append_renamed(form.rows.row(row), child.control, step.bezier);
                        step.quadratic.push_back(quadratic);
                      });
    }
    if (inner) step.inner = step.bezier.row_count();
  }
  return step;
}

BoundingRows polynomial_rows(std::size_t control_count, std::span<const double> weights, double entry_error,
                             std::span<const QuadraticWeights> quadratic) {
  const std::size_t count = quadratic.size();
  SNUG_EXPECT(weights.size() == count * control_count);
  BoundingRows result;
  result.count_ = result.bezier_count_ = count;
  result.control_count_ = control_count;
  result.entry_error_ = entry_error;
  result.weights_.resize(weights.size());
  for (std::size_t r = 0; r < count; ++r) {
    double sum = 0;
    for (std::size_t c = 0; c < control_count; ++c) {
      const double weight = weights[r * control_count + c];
      result.weights_[c * count + r] = weight;
      sum += std::fabs(weight);
    }
    result.abs_sum_ = std::max(result.abs_sum_, sum * (1 + gamma_bound(control_count)));
  }
  for (std::size_t k = 0; k < 6; ++k) {
    for (const QuadraticWeights& row : quadratic) result.quadratic_.push_back(row[k]);
  }
  return result;
}

BoundingRows polynomial_rows(const Kind& kind) {
  const BezierRows& form = kind.form();
  const std::size_t count = form.rows.row_count(), width = kind.control_count();
  std::vector<double> weights(count * width, 0.0);
  for (std::size_t r = 0; r < count; ++r) {
    const Stencils::Row row = form.rows.row(r);
    for (std::size_t i = 0; i < row.sources.size(); ++i)
      weights[r * width + row.sources[i]] += row.weights[i];
  }
  std::vector<QuadraticWeights> quadratic;
  for (std::size_t part = 0; part < form.parts; ++part) {
    const RaisedQuadratic piece(form.parts == 1 ? whole_patch : part_of(whole_patch, part), form.degree);
    for (std::size_t j = 0; j <= form.degree; ++j) {
      for (std::size_t i = 0; i + j <= form.degree; ++i) quadratic.push_back(piece.point(i, j));
    }
  }
  return polynomial_rows(width, weights, form.rows.max_error(), quadratic);
}

}  // namespace snug
