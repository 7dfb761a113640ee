#include <snug/bound.h>

#include <algorithm>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/search/surface_data.h>
#include <snug/surface/batch_bounds.h>
#include <support/error.h>
#include <support/run.h>
#include <support/scaling.h>

namespace snug {

struct PatchBounds::Inside {
  std::shared_ptr<const SurfaceData> surface;
  BatchBounds bounds;
  std::vector<PatchPlace> places;
  std::vector<OffsetTriangle> triangles;  // of boxes in motion
};

PatchBounds::PatchBounds(const Surface& surface, const Run& run)
    : inside_(new Inside{surface.data(),
                         BatchBounds(surface.data()->limit(), surface.data()->method(), run.threads),
                         {},
                         {}}) {
  for (const PatchId patch : inside_->bounds.patches()) {
    inside_->places.push_back(surface.data()->limit().place(patch));
  }
}

PatchBounds::~PatchBounds() = default;
PatchBounds::PatchBounds(PatchBounds&&) noexcept = default;
PatchBounds& PatchBounds::operator=(PatchBounds&&) noexcept = default;

std::span<const PatchPlace> PatchBounds::patches() const { return inside_->places; }

void PatchBounds::update(std::span<const Point3> points, std::span<OffsetTriangle> out, const Run& run) {
  inside_->bounds.update(points, out, run.threads);
}

namespace {

// The set around a triangle goes no farther along an axis than its corners and the radius do.
void add_box(const OffsetTriangle& offset, Box3& box) {
  Box3 corners;
  for (const Point3& corner : offset.base) corners.add(corner);
  for (std::size_t k = 0; k < 3; ++k) {
    box.lower[k] = std::min(box.lower[k], rounded_down(corners.lower[k] - offset.radius));
    box.upper[k] = std::max(box.upper[k], rounded_up(corners.upper[k] + offset.radius));
  }
}

}  // namespace

void PatchBounds::update(std::span<const Point3> begin, std::span<const Point3> end, std::span<Box3> out,
                         const Run& run) {
  std::vector<OffsetTriangle>& triangles = inside_->triangles;
  require_value(out.size() == inside_->places.size(),
                "patch bounds: give room for an answer for each of patches()");
  triangles.resize(out.size());
  std::fill(out.begin(), out.end(), Box3{});
  for (const std::span<const Point3> points : {begin, end}) {
    update(points, triangles, run);
    for (std::size_t i = 0; i < out.size(); ++i) add_box(triangles[i], out[i]);
  }
  for (const Box3& box : out) {
    static_cast<void>(require_representable(box.lower));
    static_cast<void>(require_representable(box.upper));
  }
}

}  // namespace snug
