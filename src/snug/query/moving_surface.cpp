#include <algorithm>
#include <utility>

#include <snug/search/surface_data.h>
#include <snug/surface.h>

namespace snug {

MovingSurface::MovingSurface(const Surface& first) : now_(first), plan_(std::make_shared<SharedPlan>()) {}
MovingSurface::~MovingSurface() = default;
MovingSurface::MovingSurface(MovingSurface&&) noexcept = default;
MovingSurface& MovingSurface::operator=(MovingSurface&&) noexcept = default;

const Surface& MovingSurface::move(std::span<const Point3> points) {
  const auto free =
      std::find_if(frames_.begin(), frames_.end(), [](const auto& frame) { return frame.use_count() == 1; });
  if (free == frames_.end()) {
    auto frame = std::make_shared<SurfaceData>(*now_.data(), points, plan_);
    frames_.push_back(frame);
    now_ = Surface(std::move(frame));
    return now_;
  }
  // Nobody else has a handle to it, nor can get one. Counting once more makes what the last of them did in
  // another thread come before what is done here.
  static_cast<void>(std::shared_ptr<SurfaceData>(*free));
  (*free)->move(points);
  now_ = Surface(*free);
  return now_;
}

}  // namespace snug
