#include <snug/independence/exact_surface.h>

#include <algorithm>
#include <string>
#include <unordered_map>

#include <snug/independence/exact_step.h>
#include <snug/patch/neighbourhood.h>
#include <snug/run.h>
#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

bool is_regular(const KindKey& key, const SchemeRules& rules) {
  return key.plain() && !key.polygon &&
         std::all_of(key.corners.begin(), key.corners.begin() + static_cast<std::ptrdiff_t>(rules.corners),
                     [&](const CornerFan& fan) { return rules.regular(fan); });
}

// Box splines and tensor products of B-splines are independent on a patch; with Midedge all but the alternating combination:
// that of the vertex, less that of the ends of its edges, plus that of the vertices across its faces.
std::vector<std::vector<std::pair<std::uint32_t, int>>> functionals_of(const KindKey& key,
                                                                       const SchemeRules& rules) {
  if (key.scheme == Scheme::midedge) {
    std::vector<std::vector<std::pair<std::uint32_t, int>>> sums;
    for (std::uint32_t i = 1; i <= 8; ++i) sums.push_back({{0, 1}, {i, i <= 4 ? 1 : -1}});
    return sums;
  }
  std::vector<std::vector<std::pair<std::uint32_t, int>>> places;
  const std::span<const CornerFan> fans(key.corners.data(), rules.corners);
  for (const Combination& weights : rules.lattice(rules.ring(key.corners), fans)) {
    auto& place = places.emplace_back();
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (weights[i] != 0) place.emplace_back(static_cast<std::uint32_t>(i), weights[i]);
    }
  }
  return places;
}

// Where the parts of a patch begin in its refined neighbourhood: each a triangle or a whole quad.
std::vector<HalfEdge> parts_of(const KindKey& key, const SchemeRules& rules, const Topology& ring,
                               const Topology& refined) {
  std::vector<HalfEdge> starts;
  if (key.polygon) {  // two halves a quad
    const std::vector<HalfEdge> halves = rules.child_starts(ring, refined);
    for (std::size_t k = 0; k < halves.size(); k += 2) starts.push_back(halves[k]);
    return starts;
  }
  if (rules.triangular()) return rules.child_starts(ring, refined);
  for (std::size_t k = 0; k < 4; ++k) starts.push_back(rules.quarter_start(ring, refined, k));
  return starts;
}

class Builder {
 public:
  Builder(ExactSurface& out, const SchemeRules& rules) : out_(out), rules_(rules) {}

  // The patch that begins at a half-edge: its kind, and its control vertices.
  std::uint32_t find(const RuledMesh& mesh, HalfEdge start, std::vector<VertexId>& control) {
    KindKey key = kind_key_from(mesh.topology, start, mesh.options, mesh.sharpness);
    const auto [it, added] = numbers_.try_emplace(key, static_cast<std::uint32_t>(keys_.size()));
    if (added) {
      const Neighbourhood around = neighbourhood(key);
      orders_.emplace_back(key, around.topology);
      out_.kinds.push_back({static_cast<std::uint32_t>(around.topology.vertex_count()), {}, {}});
      keys_.push_back(std::move(key));
    }
    orders_[it->second](mesh.topology, start, control);
    return it->second;
  }

  // Gives the next kind what it is made of; false: there is none left.
  bool finish_next() {
    if (next_ == keys_.size()) return false;
    const std::size_t number = next_++;
    const KindKey key = keys_[number];
    if (is_regular(key, rules_)) {
      out_.kinds[number].functionals = functionals_of(key, rules_);
      return true;
    }
    const Neighbourhood around = neighbourhood(key);
    const RefinedTopology refined = refine(around.topology, around.options, around.sharpness);
    const ExactStep step(around.ruled(), out_.order);
    std::vector<VertexId> control;
    std::vector<ExactKind::Child> children;
    std::unordered_map<std::uint32_t, WeightRow> rows;
    for (const HalfEdge start : parts_of(key, rules_, around.topology, refined.topology)) {
      ExactKind::Child child;
      child.kind = find({refined.topology, around.options, refined.sharpness}, start, control);
      for (const VertexId v : control) {
        const auto [row, added] = rows.try_emplace(v.value());
        if (added) row->second = step.row(v);
        child.rows.push_back(row->second);
      }
      children.push_back(std::move(child));
    }
    out_.kinds[number].children = std::move(children);
    return true;
  }

 private:
  ExactSurface& out_;
  const SchemeRules& rules_;
  std::unordered_map<KindKey, std::uint32_t, KindKeyHash> numbers_;
  std::vector<KindKey> keys_;
  std::vector<ControlOrder> orders_;
  std::size_t next_ = 0;
};

}  // namespace

ExactSurface exact_surface(const RuledMesh& mesh, const std::vector<bool>& without_surface,
                           std::uint32_t order, const WorkMonitor& monitor) {
  ExactSurface surface{order, {}, {}};
  const SchemeRules& rules = rules_of(mesh.options.scheme);
  Builder builder(surface, rules);
  std::vector<VertexId> control;
  for (std::size_t owner = 0; owner < without_surface.size(); ++owner) {
    monitor.checkpoint();
    if (without_surface[owner]) continue;
    const HalfEdge start =
        rules.primal ? mesh.topology.first_of(FaceId(owner)) : mesh.topology.leaving(VertexId(owner));
    const std::uint32_t kind = builder.find(mesh, start, control);
    auto& patch = surface.patches.emplace_back(ExactSurface::Patch{kind, {}});
    for (const VertexId v : control) patch.control.push_back(v.value());
  }
  double done = 0;
  for (std::size_t finished = 0; builder.finish_next(); ++finished) {
    monitor.checkpoint();
    if (surface.kinds.size() > max_exact_kinds) {
      throw InputError(InputProblem::refused,
                       "the rank of the mesh is not computed: its patches have more than " +
                           std::to_string(max_exact_kinds) +
                           " different surroundings; give fewer different sharpnesses, or a part of it");
    }
    if (finished % 64 != 0) continue;
    done = std::max(done, 0.5 * static_cast<double>(finished) / static_cast<double>(surface.kinds.size()));
    monitor.report(done);
  }
  return surface;
}

}  // namespace snug
