#include <snug/surface/limit_surface.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <snug/base/error.h>
#include <snug/base/parallel.h>

namespace snug {
LimitSurface::LimitSurface(ControlMesh mesh, const SchemeOptions& options,
                           std::shared_ptr<BoundsCache> library, int threads, const WorkMonitor& monitor)
    : mesh_(std::move(mesh)),
      options_(with_tags(options, mesh_.tags)),
      rules_(&rules_of(options.scheme)),
      library_(std::move(library)) {
  require_value(library_ != nullptr, "surface: the library is null; give std::make_shared<BoundsCache>()");
  topology_ = require_surface(mesh_, options_);
  monitor.checkpoint();
  const Box3 box = used_box(mesh_);
  size_ = longest_side(box);
  scale_ = PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  scaled_.reserve(mesh_.points.size());
  for (const Point3& p : mesh_.points) scaled_.push_back(scale_.apply(p));

  const bool primal = rules_->primal;
  const Sharpness sharpness = primal ? sharpness_of(mesh_, topology_) : Sharpness{};
  std::vector<bool> holes;
  if (primal && !mesh_.tags.holes.empty()) {
    holes.assign(mesh_.face_count(), false);
    for (const FaceId f : mesh_.tags.holes) holes[f.index()] = true;
  }
  lay_out_patches();
  parallel_for(owner_count(), threads, [&](std::size_t begin, std::size_t end) {
    monitor.checkpoint();
    for (std::size_t owner = begin; owner < end; ++owner) {
      if (has_surface(owner, sharpness, holes)) find_kinds(owner, sharpness);
    }
  });
}

void LimitSurface::lay_out_patches() {
  if (rules_->triangular()) {
    kinds_.assign(topology_.face_count(), nullptr);
    firsts_.assign(topology_.face_count(), 0);
    return;
  }
  const bool primal = rules_->primal;
  begins_.push_back(0);
  for (std::size_t owner = 0; owner < owner_count(); ++owner) {
    const std::size_t n =
        primal ? topology_.face(FaceId(owner)).size() : topology_.face_valence(VertexId(owner));
    const std::size_t parts = n == 4 ? 2 : 2 * n;
    owners_.insert(owners_.end(), parts, static_cast<std::uint32_t>(owner));
    begins_.push_back(static_cast<std::uint32_t>(owners_.size()));
    if (n != 4 && n > 0 && polygons_.empty()) polygons_.assign(owner_count(), nullptr);
  }
  kinds_.assign(owners_.size(), nullptr);
}

bool LimitSurface::has_surface(std::size_t owner, const Sharpness& sharpness,
                               const std::vector<bool>& holes) const {
  if (!rules_->primal) {
    const VertexId v(owner);
    return !topology_.isolated(v) && !topology_.on_boundary(v);
  }
  if (!holes.empty() && holes[owner]) return false;
  return options_.boundary != BoundaryRule::none || !loses_surface(topology_, sharpness, FaceId(owner));
}

HalfEdge LimitSurface::corner_at(std::size_t owner, std::size_t k) const {
  HalfEdge h = rules_->primal ? topology_.first_of(FaceId(owner)) : topology_.leaving(VertexId(owner));
  for (; k > 0; --k) h = rules_->primal ? topology_.next(h) : topology_.ccw(h);
  return h;
}

void LimitSurface::find_kinds(std::size_t owner, const Sharpness& sharpness) {
  if (rules_->triangular()) {
    const TurnedKey key = kind_key(topology_, FaceId(owner), options_, sharpness);
    kinds_[owner] = &library_->kinds().find(key.key);
    firsts_[owner] = key.first;
    return;
  }
  const HalfEdge start = corner_at(owner);
  const std::size_t begin = begins_[owner];
  const KindKey key = kind_key_from(topology_, start, options_, sharpness);
  const Kind& whole = library_->kinds().find(key);
  if (key.polygon) {
    polygons_[owner] = &whole;
    const auto& children = whole.children();
    for (std::size_t part = 0; part < children.size(); ++part) kinds_[begin + part] = children[part].kind;
    return;
  }
  kinds_[begin] = &whole;
  kinds_[begin + 1] =
      &library_->kinds().find(kind_key_from(topology_, corner_at(owner, 2), options_, sharpness));
}

LimitSurface::PatchRange LimitSurface::patches_of(std::size_t owner) const {
  if (begins_.empty()) return {owner, owner + 1};
  return {begins_[owner], begins_[owner + 1]};
}

PatchPlace LimitSurface::place(PatchId p) const {
  if (owners_.empty()) return {p.value(), 0};
  const std::uint32_t owner = owners_[p.index()];
  return {owner, p.value() - begins_[owner]};
}

const Kind* LimitSurface::polygon_of(PatchId p) const {
  return polygons_.empty() ? nullptr : polygons_[owners_[p.index()]];
}

void LimitSurface::control_vertices(PatchId p, std::vector<VertexId>& out) const {
  require_value(p.index() < patch_count() && has_patch(p),
                "surface: there is no such patch; has_patch() tells which are there");
  const PatchPlace at = place(p);
  if (const Kind* polygon = polygon_of(p)) {
    polygon->control_vertices(topology_, corner_at(at.owner), out);
  } else {
    kind(p).control_vertices(topology_, corner_at(at.owner, 2 * std::size_t{at.part}) + first(p), out);
  }
}

Point3 LimitSurface::middle(PatchId p) const {
  const std::uint32_t owner = place(p).owner;
  if (!rules_->primal) return scaled_[owner];
  const std::span<const VertexId> corners = topology_.face(FaceId(owner));
  Vector3 sum;
  for (const VertexId v : corners) sum = sum + (scaled_[v.index()] - Point3{});
  return Point3{} + (1.0 / static_cast<double>(corners.size())) * sum;
}

Patch LimitSurface::patch(PatchId p) const {
  Patch result;
  patch(p, result);
  return result;
}

void LimitSurface::patch(PatchId p, Patch& out) const {
  thread_local std::vector<VertexId> control;
  control_vertices(p, control);
  if (const Kind* polygon = polygon_of(p)) {
    split(make_patch(*polygon, 0, scaled_, control), place(p).part, out);
  } else {
    make_patch(kind(p), first(p), scaled_, control, out);
  }
}

std::size_t LimitSurface::corner_name_count() const {
  if (rules_->triangular()) return topology_.vertex_count();
  return topology_.vertex_count() + topology_.edge_count() + topology_.face_count();
}

// Vertices, then edges, then faces.
std::array<std::uint32_t, 3> LimitSurface::corner_names(PatchId p) const {
  const auto [owner, part] = place(p);
  const bool primal = rules_->primal;
  const std::size_t vertices = topology_.vertex_count(), edges = topology_.edge_count();
  const auto name = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  const auto corner = [&, place_owner = owner](std::size_t k) {
    const HalfEdge h = corner_at(place_owner, k);
    return primal ? topology_.from(h).value() : name(vertices + edges + topology_.face_of(h).index());
  };
  if (rules_->triangular()) return {corner(0), corner(1), corner(2)};
  if (!after_first_split(p)) {
    return part == 0 ? std::array{corner(0), corner(1), corner(2)}
                     : std::array{corner(2), corner(3), corner(0)};
  }
  const std::size_t k = part / 2;
  const HalfEdge h = corner_at(owner, k);
  const std::uint32_t centre = primal ? name(vertices + edges + owner) : owner;
  const auto edge = [&](HalfEdge g) { return name(vertices + topology_.edge_of(g).index()); };
  // Between corners k and k + 1, and between k - 1 and k.
  const std::uint32_t after = edge(primal ? h : topology_.prev(h)),
                      before = edge(primal ? topology_.prev(h) : h);
  return part % 2 == 0 ? std::array{corner(k), after, centre} : std::array{centre, before, corner(k)};
}

std::size_t LimitSurface::kind_count() const {
  std::unordered_set<const Kind*> distinct(kinds_.begin(), kinds_.end());
  distinct.erase(nullptr);
  return distinct.size();
}

}  // namespace snug
