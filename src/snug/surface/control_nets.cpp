#include <snug/surface/control_nets.h>

#include <algorithm>

#include <snug/geometry/rounding.h>
#include <snug/surface/net_extents.h>

namespace snug {

void ControlNets::add(const ControlHull& hull) {
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(vertices_, hull.vertices_);
  append(rings_, hull.ring_);
  append(ring_ends_, hull.ring_ends_);
  append(patch_, hull.patch_);
  append(patch_ends_, hull.patch_ends_);
  append(weights_, hull.weights_);
  begins_.push_back({vertices_.size(), ring_ends_.size(), rings_.size(), patch_.size(), weights_.size()});
}

std::span<const VertexId> ControlNets::corners(std::size_t net) const {
  return std::span(vertices_).subspan(begins_[net].vertices, begins_[net + 1].corners - begins_[net].corners);
}

ControlNets::Fit ControlNets::fit(std::size_t net, const LimitSurface& surface, const Axes& axes) const {
  const Begin &begin = begins_[net], &end = begins_[net + 1];
  const kernels::ControlNet lists{
      vertices_.data() + begin.vertices,  end.vertices - begin.vertices,   rings_.data() + begin.rings,
      ring_ends_.data() + begin.corners,  end.corners - begin.corners,     patch_.data() + begin.places,
      patch_ends_.data() + begin.patches, weights_.data() + begin.patches, end.patches - begin.patches};
  thread_local std::vector<double> memory;
  const std::size_t needed = 4 * lists.vertex_count + 8 * lists.corner_count;
  if (memory.size() < needed) memory.resize(needed);
  const kernels::PerAxis along[3] = {{axes[0].x, axes[1].x, axes[2].x, 0},
                                     {axes[0].y, axes[1].y, axes[2].y, 0},
                                     {axes[0].z, axes[1].z, axes[2].z, 0}};
  kernels::NetExtents found;
  kernels::net_extents(lists, surface.scaled_points().data(), along, memory.data(), found);
  const double largest = std::max({found.largest[0], found.largest[1], found.largest[2]});
  // No coordinate is larger than the root of three times the largest height; 32 roundings of one.
  const double error = enlarged(64 * unit_roundoff * largest) + 8 * underflow_error;
  std::array<Extent, 3> extents;
  for (std::size_t k = 0; k < 3; ++k) extents[k] = {found.lower[k] - error, found.upper[k] + error};
  return {box_of(axes, extents), found.squares[0] + found.squares[1] + found.squares[2]};
}

std::size_t ControlNets::bytes() const {
  return begins_.capacity() * sizeof(Begin) + vertices_.capacity() * sizeof(VertexId) +
         (rings_.capacity() + ring_ends_.capacity() + patch_.capacity() + patch_ends_.capacity()) *
             sizeof(std::uint32_t) +
         weights_.capacity() * sizeof(double);
}

}  // namespace snug
