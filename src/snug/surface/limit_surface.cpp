#include <snug/surface/limit_surface.h>

#include <algorithm>
#include <string>
#include <unordered_set>
#include <utility>

#include <support/error.h>
#include <support/parallel.h>

namespace snug {

LimitSurface::Layout::Layout(const ControlMesh& mesh, const SchemeOptions& scheme,
                             std::shared_ptr<BoundsCache> cache, const WorkMonitor& monitor)
    : options(with_tags(scheme, mesh.tags)), rules(&rules_of(scheme.scheme)), library(std::move(cache)) {
  require_value(library != nullptr, "surface: the library is null; give std::make_shared<BoundsCache>()");
  topology = require_surface(mesh, options);
  monitor.checkpoint();
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    if (topology.isolated(VertexId(v))) isolated.emplace_back(v);
  }
  if (rules->primal) sharpness = sharpness_of(mesh, topology);
  lay_out_patches();
  find_owners_without_surface(mesh);
}

LimitSurface::LimitSurface(ControlMesh mesh, const SchemeOptions& options,
                           std::shared_ptr<BoundsCache> library, const WorkMonitor& monitor)
    : mesh_(std::move(mesh)),
      layout_(std::make_shared<const Layout>(mesh_, options, std::move(library), monitor)) {
  scaled_.resize(mesh_.points.size());
  set_scale();
}

LimitSurface::LimitSurface(const LimitSurface& like, std::span<const Point3> points)
    : mesh_(like.mesh_), layout_(like.layout_), scaled_(like.scaled_.size()) {
  move(points);
}

void LimitSurface::move(std::span<const Point3> points) {
  if (points.size() != mesh_.points.size()) {
    throw InputError(InputProblem::value, "the mesh has " + std::to_string(mesh_.points.size()) +
                                              " vertices, not " + std::to_string(points.size()) +
                                              ": give a point for each");
  }
  double probe = 0;
  for (const Point3& p : points) probe += (p.x - p.x) + (p.y - p.y) + (p.z - p.z);  // 0 unless not finite
  if (probe != 0) {
    const auto bad =
        std::find_if(points.begin(), points.end(), [](const Point3& p) { return !is_finite(p); });
    throw InputError(InputProblem::refused, "vertex " + std::to_string(bad - points.begin()) +
                                                " has a coordinate that is not finite; mend these elements");
  }
  std::copy(points.begin(), points.end(), mesh_.points.begin());
  set_scale();
}

void LimitSurface::set_scale() {
  Box3 box;
  const std::span<const Point3> points = mesh_.points;
  std::size_t begin = 0;
  const auto add_up_to = [&](std::size_t end) {
    for (const Point3& p : points.subspan(begin, end - begin)) box.add(p);
    begin = end + 1;
  };
  for (const VertexId v : layout_->isolated) add_up_to(v.index());
  if (begin < points.size()) add_up_to(points.size());
  size_ = longest_side(box);
  scale_ = PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  for (std::size_t v = 0; v < points.size(); ++v) scaled_[v] = scale_.apply(points[v]);
}

void LimitSurface::Layout::lay_out_patches() {
  if (rules->triangular()) {
    patch_count = topology.face_count();
    firsts = std::vector<std::atomic<std::uint8_t>>(patch_count);
  } else {
    const bool primal = rules->primal;
    bool any_polygons = false;
    begins.push_back(0);
    for (std::size_t owner = 0; owner < owner_count(); ++owner) {
      const std::size_t n =
          primal ? topology.face(FaceId(owner)).size() : topology.face_valence(VertexId(owner));
      const std::size_t parts = n == 4 ? 2 : 2 * n;
      owners.insert(owners.end(), parts, static_cast<std::uint32_t>(owner));
      begins.push_back(static_cast<std::uint32_t>(owners.size()));
      any_polygons = any_polygons || (n != 4 && n > 0);
    }
    patch_count = owners.size();
    if (any_polygons) polygons = std::vector<std::atomic<const Kind*>>(owner_count());
  }
  kinds = std::vector<std::atomic<const Kind*>>(patch_count);
}

void LimitSurface::Layout::find_owners_without_surface(const ControlMesh& mesh) {
  const auto leave_out = [this](std::size_t owner) {
    if (without_surface.empty()) without_surface.assign(owner_count(), false);
    without_surface[owner] = true;
  };
  if (!rules->primal) {
    for (std::size_t owner = 0; owner < owner_count(); ++owner) {
      const VertexId v(owner);
      if (topology.isolated(v) || topology.on_boundary(v)) leave_out(owner);
    }
    return;
  }
  for (const FaceId f : mesh.tags.holes) leave_out(f.index());
  if (options.boundary != BoundaryRule::none) return;
  for (std::size_t owner = 0; owner < owner_count(); ++owner) {
    if (loses_surface(topology, sharpness, FaceId(owner))) leave_out(owner);
  }
}

HalfEdge LimitSurface::corner_at(std::size_t owner, std::size_t k) const {
  HalfEdge h = layout_->rules->primal ? layout_->topology.first_of(FaceId(owner))
                                      : layout_->topology.leaving(VertexId(owner));
  for (; k > 0; --k) h = layout_->rules->primal ? layout_->topology.next(h) : layout_->topology.ccw(h);
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
    layout_->kinds[patch].store(&kind, std::memory_order_release);
    return kind;
  };
  if (layout_->rules->triangular()) {
    const TurnedKey key = kind_key(layout_->topology, FaceId(owner), layout_->options, layout_->sharpness);
    layout_->firsts[owner].store(key.first, std::memory_order_relaxed);
    return keep(owner, layout_->library->kinds().find(key.key));
  }
  if (!after_first_split(p)) {
    const HalfEdge start = corner_at(owner, 2 * std::size_t{part});
    return keep(p.index(), layout_->library->kinds().find(kind_key_from(
                               layout_->topology, start, layout_->options, layout_->sharpness)));
  }
  const Kind& whole = layout_->library->kinds().find(
      kind_key_from(layout_->topology, corner_at(owner), layout_->options, layout_->sharpness));
  layout_->polygons[owner].store(&whole, std::memory_order_relaxed);
  const std::vector<KindChild>& children = whole.children();
  for (std::size_t k = 0; k < children.size(); ++k) keep(layout_->begins[owner] + k, *children[k].kind);
  return *children[part].kind;
}

LimitSurface::PatchRange LimitSurface::patches_of(std::size_t owner) const {
  if (layout_->begins.empty()) return {owner, owner + 1};
  return {layout_->begins[owner], layout_->begins[owner + 1]};
}

PatchPlace LimitSurface::place(PatchId p) const {
  if (layout_->owners.empty()) return {p.value(), 0};
  const std::uint32_t owner = layout_->owners[p.index()];
  return {owner, p.value() - layout_->begins[owner]};
}

bool LimitSurface::after_first_split(PatchId p) const {
  if (layout_->polygons.empty()) return false;
  const PatchRange range = patches_of(layout_->owners[p.index()]);
  return range.end - range.begin != 2;
}

const Kind* LimitSurface::polygon_of(PatchId p) const {
  if (!after_first_split(p)) return nullptr;
  static_cast<void>(kind(p));  // refuses it
  return layout_->polygons[layout_->owners[p.index()]].load(std::memory_order_relaxed);
}

void LimitSurface::control_vertices(PatchId p, std::vector<VertexId>& out) const {
  require_value(p.index() < patch_count() && has_patch(p),
                "surface: there is no such patch; has_patch() tells which are there");
  const PatchPlace at = place(p);
  if (const Kind* polygon = polygon_of(p)) {
    polygon->control_vertices(layout_->topology, corner_at(at.owner), out);
  } else {
    kind(p).control_vertices(layout_->topology, corner_at(at.owner, 2 * std::size_t{at.part}) + first(p),
                             out);
  }
}

Point3 LimitSurface::middle(PatchId p) const {
  const std::uint32_t owner = place(p).owner;
  if (!layout_->rules->primal) return scaled_[owner];
  const std::span<const VertexId> corners = layout_->topology.face(FaceId(owner));
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
  if (layout_->rules->triangular()) return layout_->topology.vertex_count();
  return layout_->topology.vertex_count() + layout_->topology.edge_count() + layout_->topology.face_count();
}

// Vertices, then edges, then faces.
std::array<std::uint32_t, 3> LimitSurface::corner_names(PatchId p) const {
  const auto [owner, part] = place(p);
  const bool primal = layout_->rules->primal;
  const std::size_t vertices = layout_->topology.vertex_count(), edges = layout_->topology.edge_count();
  const auto name = [](std::size_t n) { return static_cast<std::uint32_t>(n); };
  const auto corner = [&, place_owner = owner](std::size_t k) {
    const HalfEdge h = corner_at(place_owner, k);
    return primal ? layout_->topology.from(h).value()
                  : name(vertices + edges + layout_->topology.face_of(h).index());
  };
  if (layout_->rules->triangular()) return {corner(0), corner(1), corner(2)};
  if (!after_first_split(p)) {
    return part == 0 ? std::array{corner(0), corner(1), corner(2)}
                     : std::array{corner(2), corner(3), corner(0)};
  }
  const std::size_t k = part / 2;
  const HalfEdge h = corner_at(owner, k);
  const std::uint32_t centre = primal ? name(vertices + edges + owner) : owner;
  const auto edge = [&](HalfEdge g) { return name(vertices + layout_->topology.edge_of(g).index()); };
  // Between corners k and k + 1, and between k - 1 and k.
  const std::uint32_t after = edge(primal ? h : layout_->topology.prev(h)),
                      before = edge(primal ? layout_->topology.prev(h) : h);
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
