#include <cmath>

#include <snug/base/error.h>
#include <snug/base/parallel.h>
#include <snug/query/ray.h>
#include <snug/search/ray_caster.h>
#include <snug/search/surface_data.h>

namespace snug {

RayCaster::RayCaster(const Surface& surface, double tolerance, int threads, const WorkMonitor& monitor)
    : surface_(surface) {
  require_value(std::isfinite(tolerance) && tolerance > 0,
                "RayCaster: the tolerance must be positive; give the size of a pixel, for example");
  const LimitSurface& limit = surface.data()->limit();
  tree_ = std::make_shared<CasterTree>(limit, limit.scale().apply(tolerance), threads, monitor);
}

QuickHit RayCaster::cast(const Ray& ray) const {
  require_ray(ray);
  return tree_->cast(ray);
}

void RayCaster::cast(std::span<const Ray> rays, std::span<QuickHit> out, int threads) const {
  require_value(out.size() == rays.size(), "RayCaster: one hit for each ray");
  parallel_for(rays.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (const Ray& ray : rays.subspan(begin, end - begin)) require_ray(ray);
    tree_->cast(rays.subspan(begin, end - begin), out.subspan(begin, end - begin));
  });
}

std::size_t RayCaster::bytes() const { return tree_->bytes(); }

}  // namespace snug
