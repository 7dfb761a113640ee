#include <snug/patch/kind_cache.h>

#include <algorithm>
#include <map>
#include <utility>

#include <snug/scheme/refine.h>
#include <support/contract.h>

namespace snug {
namespace {

// The polynomial form of a kind, if every corner is regular: degree 4 for Loop and Doo-Sabin, 6 for the half
// of a bicubic Catmull-Clark quad, two quadratic parts for Midedge. Smooth boundaries and sharp corners of
// the regular sort are completed by ghost points, which reproduce them exactly.
// Source:    derivations/loop_bezier.md, tensor_bezier.md, midedge_bezier.md; [Stam98] gives the same basis
//            for Loop.
std::optional<BezierRows> polynomial_form(const KindKey& key) {
  const SchemeRules& rules = rules_of(key.scheme);
  const std::span<const CornerFan> fans(key.corners.data(), rules.corners);
  if (!key.plain() || key.polygon ||
      !std::all_of(fans.begin(), fans.end(), [&](const CornerFan& fan) { return rules.regular(fan); })) {
    return {};
  }
  return rules.bezier(rules.ring(key.corners), fans);
}

// Rows of new points in the order in which they are first asked for.
class NewPoints {
 public:
  explicit NewPoints(const RefinedTopology& refined)
      : refined_(refined.stencils), numbers_(refined.topology.vertex_count(), none) {}

  [[nodiscard]] std::vector<std::uint32_t> numbers(std::span<const VertexId> vertices) {
    std::vector<std::uint32_t> numbers;
    for (const VertexId v : vertices) {
      std::uint32_t& number = numbers_[v.index()];
      if (number == none) {
        number = static_cast<std::uint32_t>(rows_.row_count());
        rows_.append(refined_.row(v.index()));
      }
      numbers.push_back(number);
    }
    return numbers;
  }
  [[nodiscard]] Stencils take() { return std::move(rows_); }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;
  const Stencils& refined_;
  std::vector<std::uint32_t> numbers_;
  Stencils rows_;
};

std::vector<KindChild> make_children(KindCache& library, const KindKey& key) {
  const Neighbourhood around = neighbourhood(key);
  const RefinedTopology refined = refine(around.topology, around.options, around.sharpness);
  const SchemeRules& rules = rules_of(key.scheme);
  NewPoints points(refined);
  const std::vector<HalfEdge> starts = rules.child_starts(around.topology, refined.topology);
  std::vector<KindChild> children(starts.size());
  std::vector<VertexId> control;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const TurnedKey child =
        rules.triangular()
            ? kind_key(refined.topology, FaceId(k), around.options, refined.sharpness)
            : TurnedKey{kind_key_from(refined.topology, starts[k], around.options, refined.sharpness), 0};
    children[k].kind = &library.find(child.key);
    children[k].kind->control_vertices(refined.topology, starts[k] + child.first, control);
    children[k].first = child.first;
    children[k].control = points.numbers(control);
  }
  const auto step = std::make_shared<const Stencils>(points.take());
  for (KindChild& child : children) child.step = step;
  return children;
}

// Adds points of lattices that are no control points to a step: combinations of new points.
class Ghosts {
 public:
  explicit Ghosts(KindStep& step) : step_(step) {}

  // Pieces beside each other share them.
  std::uint32_t number(const Combination& weights, std::span<const std::uint32_t> of) {
    std::vector<std::pair<std::uint32_t, int>> name;
    for (std::size_t c = 0; c < weights.size(); ++c) {
      if (weights[c] != 0) name.emplace_back(of[c], weights[c]);
    }
    std::sort(name.begin(), name.end());
    const auto [it, added] = numbers_.try_emplace(name, static_cast<std::uint32_t>(step_.ghosts.row_count()));
    if (added) {
      RowBuilder row;
      for (const auto& [point, weight] : name) row.add(Interval(weight), step_.stencils.row(point));
      row.end_row(step_.ghosts);
    }
    return it->second;
  }

 private:
  KindStep& step_;
  std::map<std::vector<std::pair<std::uint32_t, int>>, std::uint32_t> numbers_;
};

// Is the combination one of the points itself?
bool is_unit(const Combination& weights, std::size_t& which) {
  const auto it = std::find_if(weights.begin(), weights.end(), [](int w) { return w != 0; });
  which = static_cast<std::size_t>(it - weights.begin());
  return *it == 1 && std::all_of(it + 1, weights.end(), [](int w) { return w == 0; });
}

Lattice lattice_of(const KindKey& key) {
  const SchemeRules& rules = rules_of(key.scheme);
  const std::span<const CornerFan> fans(key.corners.data(), rules.corners);
  return rules.lattice(rules.ring(key.corners), fans);
}

// Of quads, whose quarters are no children.
void make_quarters(KindCache& library, const KindKey& key, KindStep& step) {
  const Neighbourhood around = neighbourhood(key);
  const RefinedTopology refined = refine(around.topology, around.options, around.sharpness);
  NewPoints points(refined);
  std::vector<VertexId> control;
  for (std::size_t k = 0; k < 4; ++k) {
    const HalfEdge start = rules_of(key.scheme).quarter_start(around.topology, refined.topology, k);
    KindStep::Piece& piece = step.pieces[k];
    piece.kind = &library.find(kind_key_from(refined.topology, start, around.options, refined.sharpness));
    piece.first = 0;
    piece.kind->control_vertices(refined.topology, start, control);
    piece.control = points.numbers(control);
  }
  step.stencils = points.take();
}

KindStep make_step(KindCache& library, const Kind& kind) {
  KindStep step;
  if (kind.rules().triangular()) {
    const std::vector<KindChild>& children = kind.children();
    for (std::size_t k = 0; k < 4; ++k) {
      step.pieces[k] = {children[k].kind, children[k].first, children[k].control, {}};
    }
    step.stencils = *children[0].step;
  } else {
    make_quarters(library, kind.key(), step);
  }
  const auto count = static_cast<std::uint32_t>(step.stencils.row_count());
  Ghosts ghosts(step);
  for (KindStep::Piece& piece : step.pieces) {
    if (!piece.kind->polynomial()) continue;
    for (const Combination& weights : lattice_of(piece.kind->key())) {
      std::size_t which = 0;
      piece.lattice.push_back(is_unit(weights, which) ? piece.control[which]
                                                      : count + ghosts.number(weights, piece.control));
    }
  }
  return step;
}

bool is_transient(const Neighbourhood& around, const KindKey& key) {
  if (key.plain()) return false;
  const auto semi = [](const std::vector<double>& all) {
    return std::any_of(all.begin(), all.end(), is_semi_sharp);
  };
  if (semi(around.sharpness.edges) || semi(around.sharpness.vertices)) return true;
  const std::size_t corners = rules_of(key.scheme).corners;
  for (std::size_t f = 0; f < around.topology.face_count(); ++f) {
    if (around.topology.face(FaceId(f)).size() != corners) return true;
  }
  return false;
}

// Upper bound over the patch of the function with these control values, which are accurate to far less than
// what is added in the end: in x, as stencils are applied to points.
double largest_value(const Kind& kind, const std::vector<Vector3>& values, unsigned levels) {
  double largest = 0;
  if (kind.polynomial()) {
    for (std::size_t r = 0; r < kind.bezier().row_count(); ++r) {
      largest = std::max(largest, kind.bezier().apply<Vector3>(r, values).x);
    }
    return largest;
  }
  if (levels == 0) {
    for (const Vector3& value : values) largest = std::max(largest, value.x);
    return largest;
  }
  std::vector<Vector3> child_values;
  for (const KindChild& child : kind.children()) {
    child_values.clear();
    for (const std::uint32_t r : child.control) child_values.push_back(child.step->apply<Vector3>(r, values));
    largest = std::max(largest, largest_value(*child.kind, child_values, levels - 1));
  }
  return largest;
}

}  // namespace

Stencils KindChild::stencils() const {
  Stencils own;
  for (const std::uint32_t r : control) own.append(step->row(r));
  return own;
}

Kind::Kind(KindCache& library, KindId id, const KindKey& key) : Kind(library, id, key, neighbourhood(key)) {}

Kind::Kind(KindCache& library, KindId id, const KindKey& key, const Neighbourhood& around)
    : library_(library),
      rules_(rules_of(key.scheme)),
      id_(id),
      key_(key),
      order_(key, around.topology),
      form_(polynomial_form(key)) {
  control_count_ = around.topology.vertex_count();
  transient_ = is_transient(around, key);
}

double Kind::outer_weight() const {
  SNUG_EXPECT(!key_.polygon);
  return outer_weight_.get([&] {
    if (!key_.plain() || high_valence()) return 1.0;
    const std::size_t inner = rules().primal ? rules().corners : 1;
    if (inner == control_count_) return 0.0;
    std::vector<Vector3> values(control_count_, Vector3{1, 0, 0});
    std::fill_n(values.begin(), inner, Vector3{});
    return std::min(1.0, largest_value(*this, values, 4) + 1e-9);
  });
}

const Stencils& Kind::corner_limits() const {
  SNUG_EXPECT(!key_.polygon);
  return corner_limits_.get([&] {
    const Neighbourhood around = neighbourhood(key_);
    Stencils limits;
    for (std::size_t i = 0; i < 3; ++i) {
      const HalfEdge corner = rules().corner_of(around.topology, i);
      if (rules().add_corner_limit(around.ruled(), corner, limits)) continue;
      if (transient_) {  // the child at the corner shares the work with other patches
        const KindChild& child = children()[i];
        add_product(child.kind->corner_limits().row((3 + i - child.first) % 3), child.stencils(), {}, limits);
      } else {
        rules().add_limit_row(around.ruled(), around.topology.from(corner), limits);
      }
    }
    return limits;
  });
}

namespace {
constexpr std::size_t many_faces = 64, many_beside_creases = 16;
}

bool Kind::high_valence() const {
  if (high_valence_beside_creases()) return true;
  return !rules_.full_step && std::any_of(key_.corners.begin(), key_.corners.end(),
                                          [](const CornerFan& fan) { return fan.faces() > many_faces; });
}

bool Kind::high_valence_beside_creases() const {
  return std::any_of(key_.corners.begin(), key_.corners.end(), [](const CornerFan& fan) {
    return fan.faces() > many_beside_creases && (!fan.closed || fan.odd);
  });
}

const Stencils& Kind::corner_tangents() const {
  SNUG_EXPECT(!key_.polygon);
  return corner_tangents_.get([&] {
    const Neighbourhood around = neighbourhood(key_);
    Stencils tangents;
    for (std::size_t i = 0; i < 3; ++i) {
      rules().add_corner_tangents(around.ruled(), rules().corner_of(around.topology, i), tangents);
    }
    return tangents;
  });
}

const KindLattice& Kind::lattice() const {
  SNUG_EXPECT(polynomial());
  return lattice_.get([&] {
    KindLattice lattice;
    for (const Combination& weights : lattice_of(key_)) {
      std::size_t which = 0;
      if (!is_unit(weights, which)) {
        which = control_count_ + lattice.ghosts.row_count();
        add_fractions(weights, 1, lattice.ghosts, 0);
      }
      lattice.places.push_back(static_cast<std::uint32_t>(which));
    }
    return lattice;
  });
}

const KindStep& Kind::step() const {
  SNUG_EXPECT(!key_.polygon && !polynomial());
  return step_.get([&] { return make_step(library_, *this); });
}

const Kind::FarCorner& Kind::far_corner() const {
  SNUG_EXPECT(!key_.polygon && !rules().triangular());
  return far_corner_.get([&] {
    const Neighbourhood around = neighbourhood(key_);
    const HalfEdge corner = rules().corner_of(around.topology, 3);
    FarCorner far;
    rules().add_corner_tangents(around.ruled(), corner, far.tangents);
    if (rules().add_corner_limit(around.ruled(), corner, far.limit)) return far;
    if (!transient_) {
      rules().add_limit_row(around.ruled(), around.topology.from(corner), far.limit);
      return far;
    }
    const KindStep::Piece& piece = step().pieces[3];
    Stencils inner;
    for (const std::uint32_t p : piece.control) inner.append(step().stencils.row(p));
    add_product(piece.kind->far_corner().limit.row(0), inner, {}, far.limit);
    return far;
  });
}

const std::vector<KindChild>& Kind::children() const {
  return children_.get([&] { return make_children(library_, key_); });
}

const Kind& KindCache::find(const KindKey& key) {
  const std::lock_guard lock(mutex_);
  const auto it = kinds_.find(key);
  if (it != kinds_.end()) return *it->second;
  // Whole before others find it: making one may run out of memory.
  auto made = std::make_unique<Kind>(*this, KindId(kinds_.size()), key);
  return *kinds_.emplace(key, std::move(made)).first->second;
}

std::size_t KindCache::size() const {
  const std::lock_guard lock(mutex_);
  return kinds_.size();
}

}  // namespace snug
