#include <algorithm>
#include <array>
#include <cmath>

#include <snug/caster/caster_tree.h>
#include <snug/query/ray.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {

RayCaster::RayCaster(const Surface& surface, double tolerance, int threads, const WorkMonitor& monitor)
    : surface_(surface) {
  require_value(std::isfinite(tolerance) && tolerance > 0,
                "RayCaster: the tolerance must be positive; give the size of a pixel, for example");
  const LimitSurface& limit = surface.data()->limit();
  tree_ = std::make_shared<CasterTree>(limit, limit.scale().apply(tolerance), threads, monitor);
}

namespace {

QuickHit handed_out(const LimitSurface& surface, const PatchHit& hit) {
  if (!std::isfinite(hit.t)) return {};
  return {hit.t, place_of(surface, hit.patch, hit.at), hit.normal};
}

}  // namespace

QuickHit RayCaster::cast(const Ray& ray) const {
  require_ray(ray);
  return handed_out(tree_->surface(), tree_->cast(ray));
}

void RayCaster::cast(std::span<const Ray> rays, std::span<QuickHit> out, int threads) const {
  require_value(out.size() == rays.size(), "RayCaster: one hit for each ray");
  parallel_for(rays.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (const Ray& ray : rays.subspan(begin, end - begin)) require_ray(ray);
    std::array<PatchHit, 256> hits;
    for (std::size_t first = begin; first < end; first += hits.size()) {
      const std::size_t count = std::min(hits.size(), end - first);
      tree_->cast(rays.subspan(first, count), std::span(hits).first(count));
      for (std::size_t i = 0; i < count; ++i) out[first + i] = handed_out(tree_->surface(), hits[i]);
    }
  });
}

std::size_t RayCaster::bytes() const { return tree_->bytes(); }

}  // namespace snug
