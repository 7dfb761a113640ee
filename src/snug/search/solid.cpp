#include <snug/search/solid.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include <snug/base/error.h>
#include <snug/geometry/rounding.h>
#include <snug/mesh/disjoint_sets.h>
#include <snug/patch/evaluate.h>

namespace snug {
namespace {

std::vector<PatchId> component_patches(const LimitSurface& surface) {
  DisjointSets components(surface.corner_name_count());
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const auto names = surface.corner_names(PatchId(p));
    for (std::size_t k = 1; k < 3; ++k) components.join(names[0], names[k]);
  }
  std::vector<bool> seen(surface.corner_name_count());
  std::vector<PatchId> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    const std::uint32_t component = components.least(surface.corner_names(PatchId(p))[0]);
    if (!seen[component]) patches.emplace_back(p);
    seen[component] = true;
  }
  return patches;
}

// Calls visit(first, second, edge) for each edge of an owner that its first split cuts in two: the patches on
// the first and on the second half of it. Their corners there are 0 and 1, and 1 and 2.
template <class Visit>
void for_each_cut_edge(const LimitSurface& surface, const Visit& visit) {
  for (std::size_t owner = 0; owner < surface.owner_count(); ++owner) {
    const auto [begin, end] = surface.patches_of(owner);
    if (begin == end || !surface.after_first_split(PatchId(begin))) continue;
    for (std::size_t first = begin; first < end; first += 2) {
      const std::size_t second = first + 2 < end ? first + 3 : begin + 1;
      visit(PatchId(first), PatchId(second), surface.corner_names(PatchId(first))[1]);
    }
  }
}

LimitTriangle make_filler(const LimitSurface& surface, PatchId first, PatchId second) {
  LimitTriangle filler{};
  const auto set = [&](std::size_t place, const Patch& patch, std::size_t corner) {
    const BoundedPoint limit = corner_point(patch, corner).from(patch.origin);
    filler.corners[place] = limit.position;
    filler.error = std::max(filler.error, spatial_error(limit.error));
  };
  const Patch patch = surface.patch(first);
  set(0, patch, 0);
  set(2, patch, 1);
  set(1, surface.patch(second), 2);
  return filler;
}

}  // namespace

std::optional<std::string> open_reason(const LimitSurface& surface) {
  const Topology& topology = surface.topology();
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    if (!topology.ends_fans(EdgeId(e))) continue;
    const HalfEdge h = topology.half_of(EdgeId(e));
    return "edge (" + std::to_string(topology.from(h).value()) + ", " +
           std::to_string(topology.to(h).value()) + ") of face " +
           std::to_string(topology.face_of(h).value()) +
           " does not have two faces that run along it in opposite directions";
  }
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) continue;
    return "face " + std::to_string(surface.place(PatchId(p)).owner) + " is a hole";
  }
  return {};
}

Solid::Solid(const LimitSurface& surface) {
  if (const auto reason = open_reason(surface)) {
    throw InputError(InputProblem::refused, "solids are bounded by closed surfaces, and " + *reason +
                                                "; close the mesh or ask about its surface");
  }
  components_ = component_patches(surface);
  // Where both sides of an edge are cut, their fillers cancel.
  std::vector<std::uint8_t> cuts(surface.corner_name_count());
  for_each_cut_edge(surface, [&](PatchId, PatchId, std::uint32_t edge) { ++cuts[edge]; });
  for_each_cut_edge(surface, [&](PatchId first, PatchId second, std::uint32_t edge) {
    if (cuts[edge] == 1) fillers_.push_back(make_filler(surface, first, second));
  });
  if (fillers_.empty()) return;
  std::vector<Point3> centres;
  centres.reserve(fillers_.size());
  for (const LimitTriangle& filler : fillers_) centres.push_back(filler.corners[2]);
  tree_ = std::make_unique<WideBvh>(
      centres, 1, [&](std::size_t, std::span<const std::uint32_t> items, std::vector<Obb>& boxes) {
        std::vector<OffsetTriangle> triangles;
        std::vector<Point3> spread;
        for (const std::uint32_t i : items) {
          triangles.push_back({fillers_[i].corners, fillers_[i].error});
          spread.insert(spread.end(), fillers_[i].corners.begin(), fillers_[i].corners.end());
        }
        boxes.push_back(box_around(principal_axes(spread), triangles));
      });
}

}  // namespace snug
