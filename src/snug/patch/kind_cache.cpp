#include <snug/patch/kind_cache.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <snug/base/contract.h>
#include <snug/scheme/limits.h>
#include <snug/scheme/refine.h>
#include <snug/scheme/row_builder.h>

namespace snug {
namespace {

// Where a child begins in a refined neighbourhood.
using Start = HalfEdge;

std::vector<Start> loop_starts() { return {0, 3, 6, 9}; }

// Half a quad c0 c1 c2 splits into halves of the quarters at its corners, and the other half of the one at c1. In each
// quarter of a quad all corners are in their places.
std::vector<Start> catmark_starts(const KindKey& key, std::size_t size) {
  if (!key.polygon) return {0, 4, 8, 4 + 2};
  std::vector<Start> starts;
  for (HalfEdge corner = 0; corner < size; ++corner) {
    starts.push_back(4 * corner);
    starts.push_back(4 * corner + 2);
  }
  return starts;
}

// New vertex k lies in face k, near the patch's own vertex. Its faces counter-clockwise: k, the one of the edge between k
// and k + 1, the patch's own, the one of the edge before.
std::vector<Start> dual_starts(const KindKey& key, const Topology& topology, const Topology& refined) {
  const auto around = [&](std::size_t k, std::size_t step) {
    HalfEdge h = refined.first_of(FaceId(k));
    SNUG_EXPECT(refined.from(h).index() == topology.first_of(FaceId(k)));
    for (; step > 0; --step) h = refined.ccw(h);
    return h;
  };
  if (!key.polygon) return {around(0, 0), around(1, 3), around(2, 2), around(1, 1)};
  std::vector<Start> starts;
  for (std::size_t k = 0; k < key.details.size(); ++k) {
    starts.push_back(around(k, 0));
    starts.push_back(around(k, 2));
  }
  return starts;
}

std::vector<KindChild> make_children(KindCache& library, const KindKey& key) {
  const Neighbourhood around = neighbourhood(key);
  const RefinedTopology refined = refine(around.topology, around.options, around.sharpness);
  std::vector<Start> starts;
  if (key.scheme == Scheme::loop) {
    starts = loop_starts();
  } else if (key.scheme == Scheme::catmark) {
    starts = catmark_starts(key, around.topology.face(FaceId(0)).size());
  } else {
    starts = dual_starts(key, around.topology, refined.topology);
  }
  std::vector<KindChild> children(starts.size());
  std::vector<VertexId> control;
  std::vector<std::uint32_t> same_names(around.topology.vertex_count());
  std::iota(same_names.begin(), same_names.end(), 0u);
  for (std::size_t k = 0; k < starts.size(); ++k) {
    TurnedKey child;
    if (key.scheme == Scheme::loop) {
      child = kind_key(refined.topology, FaceId(k), around.options, refined.sharpness);
    } else {
      child.key = kind_key_from(refined.topology, starts[k], around.options, refined.sharpness);
    }
    control_vertices(refined.topology, starts[k] + child.first, child.key, control);
    children[k].kind = &library.find(child.key);
    children[k].first = child.first;
    std::size_t entries = 0;
    for (const VertexId v : control) entries += refined.stencils.row(v.index()).sources.size();
    children[k].stencils.reserve(control.size(), entries);
    for (const VertexId v : control) children[k].stencils.append(refined.stencils.row(v.index()), same_names);
  }
  return children;
}

bool is_passing(const Neighbourhood& around, const KindKey& key) {
  if (key.plain()) return false;
  const auto semi = [](const std::vector<double>& all) {
    return std::any_of(all.begin(), all.end(), is_semi_sharp);
  };
  if (semi(around.sharpness.edges) || semi(around.sharpness.vertices)) return true;
  if (key.scheme == Scheme::loop) return false;
  for (std::size_t f = 0; f < around.topology.face_count(); ++f) {
    if (around.topology.face(FaceId(f)).size() != 4) return true;
  }
  return false;
}

void add_mean(const Topology& topology, FaceId f, Stencils& out) {
  const auto face = topology.face(f);
  const Interval each =
      face.size() == 4 ? Interval(0.25) : Interval(1) / Interval(static_cast<double>(face.size()));
  for (const VertexId v : face) out.add(v.value(), each);
  out.end_row();
}

// First Fourier modes of a face, counter-clockwise.
void add_face_tangents(const Topology& topology, FaceId f, Stencils& out) {
  const auto face = topology.face(f);
  const auto n = static_cast<unsigned>(face.size());
  for (const unsigned turn : {0u, 3 * n}) {  // sin x = cos(x - pi/2), in quarters of a step
    for (unsigned i = 0; i < n; ++i) out.add(face[i].value(), cos_of_turn((4 * i + turn) % (4 * n), 4 * n));
    out.end_row();
  }
}

}  // namespace

Kind::Kind(KindCache& library, KindId id, const KindKey& key)
    : library_(library), id_(id), key_(key), form_(polynomial_form(key)) {
  const Neighbourhood around = neighbourhood(key);
  control_count_ = around.topology.vertex_count();
  passing_ = is_passing(around, key);
}

std::size_t Kind::inner_count() const {
  if (!key_.plain()) return 0;
  return !is_primal(key_.scheme) ? 1 : key_.scheme == Scheme::loop ? 3 : 4;
}

namespace {

// Upper bound over the patch of the function with these control values, which are accurate to far less than what is added
// in the end: in x, as stencils are applied to points.
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
    child_values.resize(child.stencils.row_count());
    for (std::size_t r = 0; r < child_values.size(); ++r) {
      child_values[r] = child.stencils.apply<Vector3>(r, values);
    }
    largest = std::max(largest, largest_value(*child.kind, child_values, levels - 1));
  }
  return largest;
}

}  // namespace

double Kind::outer_weight() const {
  SNUG_EXPECT(!key_.polygon);
  std::call_once(outer_weight_made_, [&] {
    const std::size_t inner = inner_count();
    if (inner == 0 || crowded()) return;
    std::vector<Vector3> values(control_count_, Vector3{1, 0, 0});
    std::fill_n(values.begin(), inner, Vector3{});
    outer_weight_ = std::min(1.0, largest_value(*this, values, 4) + 1e-9);
  });
  return outer_weight_;
}

const Stencils& Kind::corner_limits() const {
  SNUG_EXPECT(!key_.polygon);
  std::call_once(limits_made_, [&] {
    const Neighbourhood around = neighbourhood(key_);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_primal(key_.scheme)) {
        add_mean(around.topology, FaceId(i), corner_limits_);
        continue;
      }
      const VertexId v = around.topology.face(FaceId(0))[i];
      if (add_settled_limit_row(around.topology, v, around.options, around.sharpness, corner_limits_))
        continue;
      if (passing_) {  // the child at the corner shares the work with other patches
        const KindChild& child = children()[i];
        add_product(child.kind->corner_limits().row((3 + i - child.first) % 3), child.stencils, {},
                    corner_limits_);
      } else {
        add_limit_row(around.topology, v, around.options, around.sharpness, corner_limits_);
      }
    }
  });
  return corner_limits_;
}

bool Kind::crowded() const {
  constexpr std::size_t many = 16;
  return std::any_of(key_.corners.begin(), key_.corners.end(),
                     [](const CornerFan& fan) { return fan.faces() > many && (!fan.closed || fan.odd); });
}

const Stencils& Kind::corner_tangents() const {
  SNUG_EXPECT(!key_.polygon);
  std::call_once(tangents_made_, [&] {
    const Neighbourhood around = neighbourhood(key_);
    std::vector<std::uint32_t> same_names(control_count_);
    std::iota(same_names.begin(), same_names.end(), 0u);
    for (std::size_t i = 0; i < 3; ++i) {
      if (!is_primal(key_.scheme)) {
        add_face_tangents(around.topology, FaceId(i), corner_tangents_);
        continue;
      }
      const TangentRows tangents = tangent_rows(around.topology, around.topology.face(FaceId(0))[i],
                                                around.options, around.sharpness, static_cast<HalfEdge>(i));
      for (std::size_t t = 0; t < 2; ++t) corner_tangents_.append(tangents.rows.row(t), same_names);
    }
  });
  return corner_tangents_;
}

const std::vector<KindChild>& Kind::children() const {
  std::call_once(children_made_, [&] { children_ = make_children(library_, key_); });
  return children_;
}

const Kind& KindCache::find(const KindKey& key) {
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = kinds_.find(key); it != kinds_.end()) return *it->second;
  }
  const std::unique_lock lock(mutex_);
  std::unique_ptr<Kind>& place = kinds_[key];
  if (!place) place = std::make_unique<Kind>(*this, KindId(kinds_.size() - 1), key);
  return *place;
}

std::size_t KindCache::size() const {
  const std::shared_lock lock(mutex_);
  return kinds_.size();
}

}  // namespace snug
