#include <snug/bound.h>

#include <vector>

#include <snug/query/bound.h>
#include <snug/search/surface_data.h>
#include <snug/surface/batch_bounds.h>

namespace snug {

BoundSummary bound(const Surface& surface, const BoundOptions& options,
                   const std::function<void(const PatchEnclosure&)>& sink, const WorkMonitor& monitor) {
  const LimitSurface& limit = surface.data()->limit();
  return bound(
      limit, options,
      [&](const PieceEnclosure& piece) {
        sink({limit.place(piece.patch), piece.path.text(),
              piece.path.level() + (limit.after_first_split(piece.patch) ? 1 : 0), piece.corners,
              piece.offset, piece.interval});
      },
      monitor, surface.data()->method());
}

struct PatchBounds::Inside {
  std::shared_ptr<const SurfaceData> surface;
  BatchBounds bounds;
  std::vector<PatchPlace> places;
};

PatchBounds::PatchBounds(const Surface& surface, int threads)
    : inside_(new Inside{
          surface.data(), BatchBounds(surface.data()->limit(), surface.data()->method(), threads), {}}) {
  for (const PatchId patch : inside_->bounds.patches()) {
    inside_->places.push_back(surface.data()->limit().place(patch));
  }
}

PatchBounds::~PatchBounds() = default;
PatchBounds::PatchBounds(PatchBounds&&) noexcept = default;
PatchBounds& PatchBounds::operator=(PatchBounds&&) noexcept = default;

std::span<const PatchPlace> PatchBounds::patches() const { return inside_->places; }

void PatchBounds::update(std::span<const Point3> points, std::span<OffsetTriangle> out, int threads) {
  inside_->bounds.update(points, out, threads);
}

}  // namespace snug
