#include <snug/certificate/net_range.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include <snug/certificate/text.h>
#include <snug/scheme/refine.h>
#include <snug/scheme/rules.h>

namespace snug {
namespace {

template <class T>
void add_count(std::string& text, const char* what, const std::vector<T>& all) {
  text += what;
  text += ' ';
  append_integer(text, all.size());
  text += '\n';
}

const char* word_for(BoundaryRule rule) {
  return rule == BoundaryRule::none        ? "none"
         : rule == BoundaryRule::edge_only ? "edge-only"
                                           : "edge-and-corner";
}

}  // namespace

CertifiedSurface::CertifiedSurface(const Surface& surface)
    : surface_(surface),
      options_(with_tags({.scheme = surface.scheme(), .boundary = surface.boundary()}, surface.mesh().tags)),
      net_(std::make_shared<CertifiedNet>()) {
  const ControlMesh& mesh = surface.mesh();
  net_->topology = Topology(mesh);
  if (rules_of(options_.scheme).primal) net_->sharpness = sharpness_of(mesh, net_->topology);
  net_->points = mesh.points;
  find_owners();
  all_ = std::make_unique<NetRange>(net_, options_, 0, order_.size(), 0);
}

std::string CertifiedSurface::refusal(const Surface& surface) {
  if (surface.boundary() != BoundaryRule::none) return {};
  const ControlMesh& mesh = surface.mesh();
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::vector<VertexId> corners(mesh.face(FaceId(f)).begin(), mesh.face(FaceId(f)).end());
    std::sort(corners.begin(), corners.end());
    if (std::adjacent_find(corners.begin(), corners.end()) != corners.end()) {
      return "anything, because face " + std::to_string(f) +
             " names a vertex twice and the boundary rule is none";
    }
  }
  return {};
}

void CertifiedSurface::find_owners() {
  const Topology& topology = net_->topology;
  const bool primal = rules_of(options_.scheme).primal;
  const std::size_t count = primal ? topology.face_count() : topology.vertex_count();
  std::vector<bool> has_none(count);
  if (primal) {
    for (const FaceId hole : surface_.mesh().tags.holes) has_none[hole.index()] = true;
  }
  std::vector<Point3> middles(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (primal) {
      const FaceId f(i);
      if (options_.boundary == BoundaryRule::none && loses_surface(topology, net_->sharpness, f))
        has_none[i] = true;
      const std::span<const VertexId> corners = topology.face(f);
      for (const VertexId v : corners) {
        middles[i] =
            middles[i] + (1.0 / static_cast<double>(corners.size())) * (net_->points[v.index()] - Point3{});
      }
    } else {
      has_none[i] = topology.isolated(VertexId(i)) || topology.on_boundary(VertexId(i));
      middles[i] = net_->points[i];
    }
    if (!has_none[i]) order_.push_back(static_cast<std::uint32_t>(i));
  }
  sort_in_halves(order_, middles);
  positions_.assign(count, order_.size());
  for (std::size_t i = 0; i < order_.size(); ++i) positions_[order_[i]] = i;
  net_->owners = order_;
  if (primal) return;
  for (std::uint32_t& owner : net_->owners) {
    HalfEdge lowest = topology.leaving(VertexId(owner));
    topology.walk_fan(lowest, [&](HalfEdge h) { lowest = std::min(lowest, h); });
    owner = lowest;
  }
}

void sort_in_halves(std::span<std::uint32_t> order, std::span<const Point3> middles) {
  if (order.size() < 2) return;
  Box3 box;
  for (const std::uint32_t i : order) box.add(middles[i]);
  const Vector3 sides = box.upper - box.lower;
  const std::size_t axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  const std::size_t middle = order.size() / 2;
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(middle), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) {
                     return std::pair(middles[a][axis], a) < std::pair(middles[b][axis], b);
                   });
  sort_in_halves(order.first(middle), middles);
  sort_in_halves(order.subspan(middle), middles);
}

void CertifiedSurface::write(std::string& text) const {
  const ControlMesh& mesh = surface_.mesh();
  text += "surface ";
  text += name_of(options_.scheme);
  text += ' ';
  text += word_for(options_.boundary);
  text += options_.creases == CreaseMethod::chaikin ? " chaikin" : " uniform";
  text += options_.triangles == SmoothTriangles::smooth ? " smooth\n" : " catmark\n";
  add_count(text, "points", mesh.points);
  for (const Point3& p : mesh.points) {
    append_point(text, p);
    text += '\n';
  }
  text += "faces ";
  append_integer(text, mesh.face_count());
  text += '\n';
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    append_integer(text, mesh.face(FaceId(f)).size());
    for (const VertexId v : mesh.face(FaceId(f))) append_words(text, v.index());
    text += '\n';
  }
  add_count(text, "creases", mesh.tags.creases);
  for (const CreaseTag& tag : mesh.tags.creases) {
    append_integer(text, tag.a.value());
    append_words(text, tag.b.index(), std::min(tag.sharpness, infinite_sharpness));
    text += '\n';
  }
  add_count(text, "corners", mesh.tags.corners);
  for (const CornerTag& tag : mesh.tags.corners) {
    append_integer(text, tag.vertex.value());
    append_words(text, std::min(tag.sharpness, infinite_sharpness));
    text += '\n';
  }
  add_count(text, "holes", mesh.tags.holes);
  for (const FaceId f : mesh.tags.holes) {
    append_integer(text, f.value());
    text += '\n';
  }
  text += "order";
  for (const std::uint32_t owner : order_) append_words(text, std::size_t{owner});
  text += '\n';
}

std::vector<std::uint32_t> CertifiedSurface::owner_of_each_component() const {
  const Topology& topology = net_->topology;
  std::vector<std::uint32_t> root(topology.vertex_count());
  std::iota(root.begin(), root.end(), 0U);
  const auto root_of = [&](VertexId of) {
    std::uint32_t v = of.value();
    while (root[v] != v) v = root[v] = root[root[v]];
    return v;
  };
  for (std::size_t f = 0; f < topology.face_count(); ++f) {
    for (const VertexId v : topology.face(FaceId(f))) root[root_of(v)] = root_of(topology.face(FaceId(f))[0]);
  }
  std::vector<bool> seen(root.size());
  std::vector<std::uint32_t> owners;
  for (const std::uint32_t owner : order_) {
    const bool primal = rules_of(options_.scheme).primal;
    const std::uint32_t v = root_of(primal ? topology.face(FaceId(owner))[0] : VertexId(owner));
    if (!seen[v]) owners.push_back(owner);
    seen[v] = true;
  }
  return owners;
}

std::vector<std::size_t> CertifiedSurface::steps_to(const Place& at, std::size_t count) const {
  const SchemeRules& rules = rules_of(options_.scheme);
  std::vector<std::size_t> steps;
  double u = at.u, v = at.v;
  if (!rules.triangular() && all_->only(positions_[at.owner])->corner_count() != 4)
    steps.push_back(at.corner);
  while (steps.size() < count) {
    if (rules.triangular()) {
      const std::size_t k = u >= 0.5 ? 1 : v >= 0.5 ? 2 : u + v <= 0.5 ? 0 : 3;
      steps.push_back(k);
      u = k == 3 ? 1 - 2 * u : 2 * u - (k == 1 ? 1 : 0);
      v = k == 3 ? 1 - 2 * v : 2 * v - (k == 2 ? 1 : 0);
      continue;
    }
    const bool right = u >= 0.5, above = v >= 0.5;
    const std::size_t k = right ? (above ? 2 : 1) : above ? 3 : 0;
    steps.push_back(k);
    const double x = 2 * u - (right ? 1 : 0), y = 2 * v - (above ? 1 : 0);
    // Pieces of a dual scheme count from the corner that they keep.
    const std::array<std::pair<double, double>, 4> turned{{{x, y}, {y, 1 - x}, {1 - x, 1 - y}, {1 - y, x}}};
    std::tie(u, v) = turned[rules.primal ? 0 : k];
  }
  return steps;
}

}  // namespace snug
