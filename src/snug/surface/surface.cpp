#include <snug/surface/surface.h>

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <snug/base/contract.h>
#include <snug/base/parallel.h>

namespace snug {
namespace {

bool touches_boundary(const Topology& topology, FaceId f) {
  const auto corners = topology.face(f);
  return std::any_of(corners.begin(), corners.end(), [&](VertexId v) { return topology.on_boundary(v); });
}

}  // namespace

Surface::Surface(ControlMesh mesh, const SchemeOptions& options, std::shared_ptr<BoundLibrary> library,
                 int threads, const WorkMonitor& monitor)
    : mesh_(std::move(mesh)), options_(options), library_(std::move(library)) {
  SNUG_EXPECT(library_ != nullptr);
  require_subdividable(mesh_, options_);
  monitor.checkpoint();
  topology_ = Topology(mesh_);
  const Box3 box = used_box(mesh_);
  size_ = box.longest_side();
  scale_ = PowerOfTwo::normalising(std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{})));
  scaled_.reserve(mesh_.points.size());
  for (const Point3& p : mesh_.points) scaled_.push_back(scale_.apply(p));

  kinds_.assign(topology_.face_count(), nullptr);
  firsts_.assign(topology_.face_count(), 0);
  parallel_for(topology_.face_count(), threads, [&](std::size_t begin, std::size_t end) {
    monitor.checkpoint();
    for (std::size_t f = begin; f < end; ++f) {
      if (options_.boundary == BoundaryRule::none && touches_boundary(topology_, FaceId(f))) continue;
      const TurnedKey key = kind_key(topology_, FaceId(f), options_);
      kinds_[f] = &library_->kinds().find(key.key);
      firsts_[f] = key.first;
    }
  });
}

void Surface::control_vertices(FaceId f, std::vector<VertexId>& out) const {
  SNUG_EXPECT(has_patch(f));
  snug::control_vertices(topology_, f, firsts_[f.index()], out);
}

Patch Surface::patch(FaceId f) const {
  thread_local std::vector<VertexId> control;
  control_vertices(f, control);
  return make_patch(*kinds_[f.index()], firsts_[f.index()], scaled_, control);
}

std::size_t Surface::kind_count() const {
  std::unordered_set<const Kind*> distinct(kinds_.begin(), kinds_.end());
  distinct.erase(nullptr);
  return distinct.size();
}

}  // namespace snug
