#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/surface/net_extents.cpp"
#include <snug/geometry/vector_code-inl.h>

#include <limits>

#include <snug/surface/net_extents.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

constexpr hn::CappedTag<double, 4> tag;
using V = hn::Vec<decltype(tag)>;
constexpr std::size_t at_once = hn::MaxLanes(tag);

// An axis a lane, as many as there are lanes, from axis `k` on.
void some_axes(const ControlNet& net, const Point3* points, const PerAxis axes[3], std::size_t k,
               double* memory, NetExtents& out) {
  double* const heights = memory;
  double* const rings = memory + at_once * net.vertex_count;  // lower and upper of each corner
  const V along_x = hn::LoadU(tag, axes[0] + k), along_y = hn::LoadU(tag, axes[1] + k),
          along_z = hn::LoadU(tag, axes[2] + k);
  V largest = hn::Zero(tag);
  for (std::size_t i = 0; i < net.vertex_count; ++i) {
    const Point3& p = points[net.vertices[i].index()];
    const V height =
        hn::Add(hn::Add(hn::Mul(along_x, hn::Set(tag, p.x)), hn::Mul(along_y, hn::Set(tag, p.y))),
                hn::Mul(along_z, hn::Set(tag, p.z)));
    hn::StoreU(height, tag, heights + at_once * i);
    largest = hn::Max(largest, hn::Abs(height));
  }
  std::size_t at = 0;
  for (std::size_t c = 0; c < net.corner_count; ++c) {
    V lower = hn::LoadU(tag, heights + at_once * c), upper = lower;
    for (const std::size_t end = net.ring_ends[c]; at < end; ++at) {
      const V height = hn::LoadU(tag, heights + at_once * net.rings[at]);
      lower = hn::Min(lower, height);
      upper = hn::Max(upper, height);
    }
    hn::StoreU(lower, tag, rings + 2 * at_once * c);
    hn::StoreU(upper, tag, rings + 2 * at_once * c + at_once);
  }
  const V infinite = hn::Set(tag, std::numeric_limits<double>::infinity());
  V lower = infinite, upper = hn::Neg(infinite), squares = hn::Zero(tag);
  at = 0;
  for (std::size_t p = 0; p < net.patch_count; ++p) {
    V inner_lower = infinite, inner_upper = hn::Neg(infinite), outer_lower = infinite,
      outer_upper = hn::Neg(infinite);
    for (const std::size_t end = net.patch_ends[p]; at < end; ++at) {
      const std::size_t c = net.patch[at];
      const V height = hn::LoadU(tag, heights + at_once * c);
      inner_lower = hn::Min(inner_lower, height);
      inner_upper = hn::Max(inner_upper, height);
      outer_lower = hn::Min(outer_lower, hn::LoadU(tag, rings + 2 * at_once * c));
      outer_upper = hn::Max(outer_upper, hn::LoadU(tag, rings + 2 * at_once * c + at_once));
    }
    const V weight = hn::Set(tag, net.weights[p]), extent = hn::Sub(inner_upper, inner_lower);
    lower = hn::Min(lower, hn::Add(inner_lower, hn::Mul(weight, hn::Sub(outer_lower, inner_lower))));
    upper = hn::Max(upper, hn::Add(inner_upper, hn::Mul(weight, hn::Sub(outer_upper, inner_upper))));
    squares = hn::Add(squares, hn::Mul(extent, extent));
  }
  hn::StoreU(lower, tag, out.lower + k);
  hn::StoreU(upper, tag, out.upper + k);
  hn::StoreU(largest, tag, out.largest + k);
  hn::StoreU(squares, tag, out.squares + k);
}

void NetExtentsOf(const ControlNet& net, const Point3* points, const PerAxis axes[3], double* memory,
                  NetExtents& out) {
  for (std::size_t k = 0; k < 3; k += at_once) some_axes(net, points, axes, k, memory, out);
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(NetExtentsOf);

void net_extents(const ControlNet& net, const Point3* points, const PerAxis axes[3], double* memory,
                 NetExtents& out) {
  HWY_DYNAMIC_DISPATCH(NetExtentsOf)(net, points, axes, memory, out);
}

}  // namespace snug::kernels
#endif
