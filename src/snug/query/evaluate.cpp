#include <snug/evaluate.h>

#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <support/error.h>

namespace snug {

SurfacePoint evaluate(const Surface& surface, const Place& at) {
  return evaluate(surface.data()->limit(), at);
}

std::vector<SurfacePoint> evaluate(const Surface& surface, std::span<const Place> at, const Run& run) {
  return evaluate(surface.data()->limit(), at, run.threads);
}

double evaluate(const Surface& surface, std::span<const Place> at, const FloatPoints& out, const Run& run) {
  return evaluate(surface.data()->limit(), at, out, run.threads);
}

std::optional<SurfaceNormal> normal_at(const PlacedSurface& surface, const Place& at) {
  const LimitSurface& inside = surface.surface().data()->limit();
  require_value(patch_at(inside, at).has_value(),
                "normal_at: the surface has no such face, corner or parameter; give one that it has");
  return normal_at(inside, at, surface.pose());
}

}  // namespace snug
