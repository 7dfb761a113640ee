#include <snug/patch/kind_library.h>

#include <snug/patch/polynomial.h>
#include <snug/scheme/refine.h>

namespace snug {
namespace {

std::array<KindChild, 4> make_children(KindLibrary& library, const KindKey& key) {
  const SchemeOptions options = neighbourhood_options(key);
  const RefinedTopology refined = refine(neighbourhood(key), options);
  std::array<KindChild, 4> children;
  std::vector<VertexId> control;
  std::vector<std::uint32_t> same_names(refined.topology.vertex_count());
  for (std::size_t i = 0; i < same_names.size(); ++i) same_names[i] = static_cast<std::uint32_t>(i);
  for (std::size_t k = 0; k < 4; ++k) {
    const TurnedKey child = kind_key(refined.topology, FaceId(k), options);
    control_vertices(refined.topology, FaceId(k), child.first, control);
    children[k].kind = &library.find(child.key);
    children[k].first = child.first;
    for (const VertexId v : control) children[k].stencils.append(refined.stencils.row(v.index()), same_names);
  }
  return children;
}

}  // namespace

Kind::Kind(KindLibrary& library, KindId id, const KindKey& key)
    : library_(library), id_(id), key_(key), polynomial_(is_polynomial(key)) {
  const Topology topology = neighbourhood(key);
  const SchemeOptions options = neighbourhood_options(key);
  control_count_ = topology.vertex_count();
  if (polynomial_) bezier_ = bezier_rows(key);
  for (std::size_t i = 0; i < 3; ++i) add_limit_row(topology, VertexId(i), options, corner_limits_);
}

const Stencils& Kind::corner_tangents() const {
  std::call_once(tangents_made_, [&] {
    const Topology topology = neighbourhood(key_);
    const SchemeOptions options = neighbourhood_options(key_);
    std::vector<std::uint32_t> same_names(control_count_);
    for (std::size_t i = 0; i < control_count_; ++i) same_names[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < 3; ++i) {
      const TangentRows tangents = tangent_rows(topology, VertexId(i), options);
      for (std::size_t t = 0; t < 2; ++t) corner_tangents_.append(tangents.rows.row(t), same_names);
    }
  });
  return corner_tangents_;
}

const std::array<KindChild, 4>& Kind::children() const {
  std::call_once(children_made_, [&] {
    children_ = std::make_unique<std::array<KindChild, 4>>(make_children(library_, key_));
  });
  return *children_;
}

const Kind& KindLibrary::find(const KindKey& key) {
  {
    const std::shared_lock lock(mutex_);
    if (const auto it = kinds_.find(key); it != kinds_.end()) return *it->second;
  }
  const std::unique_lock lock(mutex_);
  std::unique_ptr<Kind>& place = kinds_[key];
  if (!place) place = std::make_unique<Kind>(*this, KindId(kinds_.size() - 1), key);
  return *place;
}

std::size_t KindLibrary::size() const {
  const std::shared_lock lock(mutex_);
  return kinds_.size();
}

}  // namespace snug
