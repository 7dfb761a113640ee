#include <snug/search/surface_data.h>
#include <support/run.h>

#include <atomic>
#include <mutex>
#include <utility>

namespace snug {
namespace {

// Kinds are never forgotten, so a cache that knows this many is left to the surfaces that have it.
constexpr std::size_t max_shared_kinds = 4096;

// The bounds cache of all surfaces; it lives as long as one of them does.
std::shared_ptr<BoundsCache> shared_bounds() {
  static std::mutex mutex;
  static std::weak_ptr<BoundsCache> kept;
  const std::lock_guard lock(mutex);
  std::shared_ptr<BoundsCache> cache = kept.lock();
  if (!cache || cache->kinds().size() >= max_shared_kinds) kept = cache = std::make_shared<BoundsCache>();
  return cache;
}

LimitSurface make_surface(ControlMesh mesh, const SurfaceOptions& options, const Run& run) {
  const SchemeOptions rules = rules_for(mesh, options.scheme, options.boundary);
  return {std::move(mesh), rules, shared_bounds(), monitor_of(run)};
}

std::uint64_t next_number() {
  static std::atomic<std::uint64_t> count{0};
  return ++count;
}

}  // namespace

SurfaceData::SurfaceData(ControlMesh mesh, const SurfaceOptions& options, const Run& run)
    : limit_(make_surface(std::move(mesh), options, run)),
      bvh_options_{.method = options.bounds, .tight = options.tight, .threads = run.threads},
      number_(next_number()),
      storage_(number_) {}

SurfaceData::SurfaceData(const SurfaceData& like, std::span<const Point3> points,
                         std::shared_ptr<SharedPlan> plan)
    : limit_(like.limit_, points),
      bvh_options_(like.bvh_options_),
      plan_(std::move(plan)),
      number_(next_number()),
      storage_(number_) {}

void SurfaceData::move(std::span<const Point3> points) {
  limit_.move(points);
  bvh_.expire();
  number_ = next_number();
}

const SurfaceBvh& SurfaceData::bvh(const WorkMonitor& monitor) const {
  if (!plan_) return bvh_.get([&] { return SurfaceBvh(limit_, bvh_options_, monitor); });
  return bvh_.get([&] { return SurfaceBvh(limit_, bvh_options_, *plan_); },
                  [&](SurfaceBvh& old) { old.refit(*plan_); });
}

std::size_t SurfaceData::bytes() const {
  const SurfaceBvh* const tree = bvh_.made();
  return 9 * limit_.patch_count() + (tree ? tree->bytes() : 0);
}

}  // namespace snug
