#include <snug/certificate/net_range.h>

#include <algorithm>
#include <utility>

#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

void keep_once(std::vector<std::uint32_t>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

}  // namespace

NetRange& NetRange::half(std::size_t which) {
  std::unique_ptr<NetRange>& half = halves_[which];
  if (!half) {
    const std::size_t middle = begin_ + size() / 2;
    half = std::make_unique<NetRange>(net_, options_, which == 0 ? begin_ : middle,
                                      which == 0 ? middle : end_, level_);
  }
  return *half;
}

std::unique_ptr<NetRange> NetRange::only(std::size_t owner) const {
  return std::make_unique<NetRange>(net_, options_, begin_ + owner, begin_ + owner + 1, level_);
}

bool NetRange::dual() const { return !rules_of(options_.scheme).primal; }
bool NetRange::triangular() const { return rules_of(options_.scheme).triangular(); }

std::size_t NetRange::corner_count() const {
  const Topology& topology = net_->topology;
  const std::uint32_t owner = net_->owners[begin_];
  return rules_of(options_.scheme).primal ? topology.face(FaceId(owner)).size()
                                          : topology.face_valence(topology.from(owner));
}

std::vector<HalfEdge> NetRange::faces_around(unsigned rings) const {
  const Topology& topology = net_->topology;
  const SchemeRules& rules = rules_of(options_.scheme);
  std::vector<std::uint32_t> faces, vertices;
  for (const std::uint32_t owner : owners()) {
    rules.primal ? faces.push_back(owner) : vertices.push_back(topology.from(owner).value());
  }
  keep_once(faces);
  for (rings = rules.local ? 0 : rings; rings > 0; --rings) {
    for (const std::uint32_t f : faces) {
      for (const VertexId v : topology.face(FaceId(f))) vertices.push_back(v.value());
    }
    keep_once(vertices);
    for (const std::uint32_t v : vertices) {
      walk_fans(topology, VertexId(v), [&](HalfEdge h) { faces.push_back(topology.face_of(h).value()); });
    }
    keep_once(faces);
  }
  std::vector<HalfEdge> firsts;
  for (const std::uint32_t f : faces) firsts.push_back(topology.first_of(FaceId(f)));
  return firsts;
}

Box3 NetRange::rough_box(const Motion& pose) const {
  const Topology& topology = net_->topology;
  Box3 box;
  const auto add_middle = [&](FaceId f) {
    Vector3 sum;
    for (const VertexId v : topology.face(f)) sum = sum + (net_->points[v.index()] - Point3{});
    box.add(pose.apply(Point3{} + (1.0 / static_cast<double>(topology.face(f).size())) * sum));
  };
  for (const std::uint32_t owner : owners()) {
    if (dual()) {
      topology.walk_fan(owner, [&](HalfEdge h) { add_middle(topology.face_of(h)); });
    } else {
      for (const VertexId v : topology.face(FaceId(owner))) box.add(pose.apply(net_->points[v.index()]));
    }
  }
  return box;
}

std::unique_ptr<NetRange> NetRange::some(std::span<const std::size_t> of) const {
  auto net = std::make_shared<CertifiedNet>(*net_);
  net->owners.clear();
  for (const std::size_t i : of) net->owners.push_back(owners()[i]);
  return std::make_unique<NetRange>(std::move(net), options_, 0, of.size(), level_);
}

std::vector<Point3> NetRange::hull(const Motion& pose) const {
  std::vector<VertexId> names;
  vertices_of(net_->topology, faces_around(1), names);
  std::vector<Point3> points;
  points.reserve(names.size());
  for (const VertexId v : names) points.push_back(pose.apply(net_->points[v.index()]));
  return points;
}

NetRange& NetRange::finer() {
  if (finer_) return *finer_;
  const SchemeRules& rules = rules_of(options_.scheme);
  const Topology& topology = net_->topology;
  // Chaikin's rule looks at the semi-sharp edges at the far ends of edges, too.
  const bool far = options_.creases == CreaseMethod::chaikin && !net_->sharpness.edges.empty();
  const PartOfMesh part = part_of(topology, net_->sharpness, options_.boundary, faces_around(far ? 2 : 1));
  const auto within = [&](FaceId f) {
    return FaceId(static_cast<std::size_t>(std::lower_bound(part.faces.begin(), part.faces.end(), f) -
                                           part.faces.begin()));
  };
  RefinedTopology refined = refine(part.topology, options_, part.sharpness);
  auto net = std::make_shared<CertifiedNet>();
  std::vector<Point3> points;
  for (const VertexId v : part.names) points.push_back(net_->points[v.index()]);
  for (std::size_t r = 0; r < refined.stencils.row_count(); ++r) {
    net->points.push_back(refined.stencils.apply<Point3>(r, points));
  }
  for (std::size_t i = begin_; i < end_; ++i) {
    const std::uint32_t owner = net_->owners[i];
    if (rules.primal) {
      const FaceId f = within(FaceId(owner));
      const HalfEdge first = part.topology.first_of(f);
      const std::uint32_t count =
          rules.triangular() ? 4 : static_cast<std::uint32_t>(part.topology.face(f).size());
      for (std::uint32_t k = 0; k < count; ++k) {
        net->owners.push_back(rules.triangular() ? 4 * f.value() + k : first + k);
      }
      continue;
    }
    topology.walk_fan(owner, [&](HalfEdge h) {
      const FaceId whole = topology.face_of(h), f = within(whole);
      net->owners.push_back(refined.topology.first_of(f) + (h - topology.first_of(whole)));
    });
  }
  net->topology = std::move(refined.topology);
  net->sharpness = std::move(refined.sharpness);
  const std::size_t count = net->owners.size();
  finer_ = std::make_unique<NetRange>(std::move(net), options_, 0, count, level_ + 1);
  return *finer_;
}

}  // namespace snug
