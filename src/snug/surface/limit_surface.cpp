#include <snug/surface/limit_surface.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <snug/base/error.h>
#include <snug/base/parallel.h>

namespace snug {
LimitSurface::LimitSurface(ControlMesh mesh, const SchemeOptions& options,
                           std::shared_ptr<BoundsCache> library, const WorkMonitor& monitor)
    : mesh_(std::move(mesh)),
      options_(with_tags(options, mesh_.tags)),
      rules_(&rules_of(options.scheme)),
      library_(std::move(library)) {
  require_value(library_ != nullptr, "surface: the library is null; give std::make_shared<BoundsCache>()");
  topology_ = require_surface(mesh_, options_);
  monitor.checkpoint();
  Box3 box;
  for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
    if (!topology_.isolated(VertexId(v))) box.add(mesh_.points[v]);
  }
  size_ = longest_side(box);
  scale_ = PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  scaled_.reserve(mesh_.points.size());
  for (const Point3& p : mesh_.points) scaled_.push_back(scale_.apply(p));

  if (rules_->primal) sharpness_ = sharpness_of(mesh_, topology_);
  lay_out_patches();
  find_bare_owners();
}

void LimitSurface::lay_out_patches() {
  if (rules_->triangular()) {
    patch_count_ = topology_.face_count();
    firsts_ = std::vector<std::atomic<std::uint8_t>>(patch_count_);
  } else {
    const bool primal = rules_->primal;
    bool polygons = false;
    begins_.push_back(0);
    for (std::size_t owner = 0; owner < owner_count(); ++owner) {
      const std::size_t n =
          primal ? topology_.face(FaceId(owner)).size() : topology_.face_valence(VertexId(owner));
      const std::size_t parts = n == 4 ? 2 : 2 * n;
      owners_.insert(owners_.end(), parts, static_cast<std::uint32_t>(owner));
      begins_.push_back(static_cast<std::uint32_t>(owners_.size()));
      polygons = polygons || (n != 4 && n > 0);
    }
    patch_count_ = owners_.size();
    if (polygons) polygons_ = std::vector<std::atomic<const Kind*>>(owner_count());
  }
  kinds_ = std::vector<std::atomic<const Kind*>>(patch_count_);
}

void LimitSurface::find_bare_owners() {
  const auto leave_out = [this](std::size_t owner) {
    if (bare_.empty()) bare_.assign(owner_count(), false);
    bare_[owner] = true;
  };
  if (!rules_->primal) {
    for (std::size_t owner = 0; owner < owner_count(); ++owner) {
      const VertexId v(owner);
      if (topology_.isolated(v) || topology_.on_boundary(v)) leave_out(owner);
    }
    return;
  }
  for (const FaceId f : mesh_.tags.holes) leave_out(f.index());
  if (options_.boundary != BoundaryRule::none) return;
  for (std::size_t owner = 0; owner < owner_count(); ++owner) {
    if (loses_surface(topology_, sharpness_, FaceId(owner))) leave_out(owner);
  }
}

HalfEdge LimitSurface::corner_at(std::size_t owner, std::size_t k) const {
  HalfEdge h = rules_->primal ? topology_.first_of(FaceId(owner)) : topology_.leaving(VertexId(owner));
  for (; k > 0; --k) h = rules_->primal ? topology_.next(h) : topology_.ccw(h);
  return h;
}

void LimitSurface::find_kinds(int threads) const {
  parallel_for(patch_count(), threads, [this](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      if (has_patch(PatchId(p))) static_cast<void>(kind(PatchId(p)));
    }
  });
}

// Several threads may find the same at once.
const Kind& LimitSurface::find_kind(PatchId p) const {
  const auto [owner, part] = place(p);
  const auto keep = [this](std::size_t patch, const Kind& kind) -> const Kind& {
    kinds_[patch].store(&kind, std::memory_order_release);
    return kind;
  };
  if (rules_->triangular()) {
    const TurnedKey key = kind_key(topology_, FaceId(owner), options_, sharpness_);
    firsts_[owner].store(key.first, std::memory_order_relaxed);
    return keep(owner, library_->kinds().find(key.key));
  }
  if (!after_first_split(p)) {
    const HalfEdge start = corner_at(owner, 2 * std::size_t{part});
    return keep(p.index(), library_->kinds().find(kind_key_from(topology_, start, options_, sharpness_)));
  }
  const Kind& whole =
      library_->kinds().find(kind_key_from(topology_, corner_at(owner), options_, sharpness_));
  polygons_[owner].store(&whole, std::memory_order_relaxed);
  const std::vector<KindChild>& children = whole.children();
  for (std::size_t k = 0; k < children.size(); ++k) keep(begins_[owner] + k, *children[k].kind);
  return *children[part].kind;
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

bool LimitSurface::after_first_split(PatchId p) const {
  if (polygons_.empty()) return false;
  const PatchRange range = patches_of(owners_[p.index()]);
  return range.end - range.begin != 2;
}

const Kind* LimitSurface::polygon_of(PatchId p) const {
  if (!after_first_split(p)) return nullptr;
  static_cast<void>(kind(p));  // tells it
  return polygons_[owners_[p.index()]].load(std::memory_order_relaxed);
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
  std::unordered_set<const Kind*> distinct;
  for (std::size_t p = 0; p < patch_count(); ++p) {
    if (has_patch(PatchId(p))) distinct.insert(&kind(PatchId(p)));
  }
  return distinct.size();
}

}  // namespace snug
