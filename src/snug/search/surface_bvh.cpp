#include <snug/search/surface_bvh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/surface/control_hull.h>

namespace snug {
namespace {

Obb tight_box(const LimitSurface& surface, std::span<const PatchId> patches, BoundMethod method) {
  // For their memory.
  thread_local HullPoints scratch;
  thread_local std::array<HullPoints, WideBvh::leaf_size> hulls;
  std::vector<OffsetTriangle> triangles;
  std::vector<Point3> spread;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Piece piece = make_piece(surface.library(), patches[i], surface.patch(patches[i]), scratch, method);
    triangles.push_back(piece.offset);
    spread.insert(spread.end(), piece.offset.base.begin(), piece.offset.base.end());
    if (method == BoundMethod::rows) close_points(surface.library(), piece.patch, hulls[i]);
  }
  const std::array<Vector3, 3> axes = principal_axes(spread);
  return method == BoundMethod::table ? box_around(axes, triangles)
                                      : box_around(axes, std::span(hulls).first(patches.size()));
}

std::vector<PatchId> existing_patches(const LimitSurface& surface) {
  std::vector<PatchId> patches;
  patches.reserve(surface.patch_count());
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.emplace_back(p);
  }
  if (patches.size() >= WideBvh::leaf_bit) {
    throw InputError(InputProblem::refused, "more than 2^31 patches: split the mesh");
  }
  if (patches.empty()) {
    throw InputError(
        InputProblem::refused,
        "no face has a limit surface: all are holes or touch the boundary; use another boundary rule");
  }
  return patches;
}

WideBvh make_tree(const LimitSurface& surface, std::span<const PatchId> patches,
                  const SurfaceBvhOptions& options, const WorkMonitor& monitor) {
  std::vector<Point3> centres;
  centres.reserve(patches.size());
  for (const PatchId p : patches) centres.push_back(surface.middle(p));
  return {centres, options.threads, [&](std::span<const std::uint32_t> items) {
            monitor.checkpoint();
            thread_local ControlHull hull;
            std::array<PatchId, WideBvh::leaf_size> members;
            for (std::size_t i = 0; i < items.size(); ++i) members[i] = patches[items[i]];
            const std::span<const PatchId> here = std::span(members).first(items.size());
            if (options.tight) return tight_box(surface, here, options.method);
            hull.assign(surface, here);
            return hull.box();
          }};
}

}  // namespace

SurfaceBvh::SurfaceBvh(const LimitSurface& surface, const SurfaceBvhOptions& options,
                       const WorkMonitor& monitor)
    : surface_(&surface),
      method_(options.method),
      patches_(existing_patches(surface)),
      tree_(make_tree(surface, patches_, options, monitor)),
      solid_(std::make_unique<Lazy<Solid>>()) {
  const PowerOfTwo back = surface.scale().inverse();
  const Ball scaled = tree_.ball();
  ball_ = {back.apply(scaled.centre), enlarged(back.apply(scaled.radius))};
  // Beyond these sizes products lose digits to the ends of the range.
  if (!is_finite(ball_.centre) || !(ball_.radius < 0x1p500) || std::abs(back.exponent()) > 500) {
    ball_ = {Point3{}, INFINITY};
  }
}

const Solid& SurfaceBvh::solid() const {
  return solid_->get([&] { return Solid(*surface_); });
}

std::size_t SurfaceBvh::bytes() const { return patches_.capacity() * sizeof(PatchId) + tree_.bytes(); }

}  // namespace snug
