#include <algorithm>
#include <cmath>

#include <snug/caster/caster_tree.h>
#include <snug/query/ray.h>
#include <snug/search/surface_data.h>
#include <support/error.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {

RayCaster::RayCaster(const Surface& surface, double error, const Run& run) : surface_(surface) {
  require_value(std::isfinite(error) && error > 0,
                "RayCaster: the error must be positive; give the size of a pixel, for example");
  const LimitSurface& limit = surface.data()->limit();
  tree_ = std::make_shared<CasterTree>(limit, limit.scale().apply(error), run.threads, monitor_of(run));
}

QuickHit RayCaster::cast(const Ray& ray) const {
  require_ray(ray);
  return tree_->cast(ray);
}

bool RayCaster::blocked(const Ray& ray) const {
  require_ray(ray);
  return tree_->blocked(ray);
}

void RayCaster::cast(std::span<const Ray> rays, std::span<QuickHit> out, const Run& run) const {
  require_value(out.size() == rays.size(), "RayCaster: one hit for each ray");
  // A block is searched in groups that begin with its first ray: hits do not depend on threads.
  constexpr std::size_t block = 256;
  const auto cast_blocks = [&](std::size_t begin, std::size_t end) {
    const std::size_t first = begin * block, count = std::min(end * block, rays.size()) - first;
    for (const Ray& ray : rays.subspan(first, count)) require_ray(ray);
    tree_->cast(rays.subspan(first, count), out.subspan(first, count));
  };
  if (rays.size() <= block) return cast_blocks(0, 1);
  parallel_for((rays.size() + block - 1) / block, run.threads, cast_blocks);
}

std::size_t RayCaster::bytes() const { return tree_->bytes(); }

}  // namespace snug
