#include <snug/search/point_batch.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include <support/run.h>

namespace snug {
namespace {

// The low 10 bits, two zeros before each.
std::uint32_t spread(std::uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

struct OrderedPoint {
  std::uint32_t along, point;
};

// The points in the order of the curve.
std::vector<OrderedPoint> spatial_order(std::span<const Point3> points) {
  Box3 box;
  for (const Point3& p : points) box.add(p);
  std::vector<OrderedPoint> places;
  places.reserve(points.size());
  for (const Point3& p : points) {
    std::uint32_t code = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double share = (p[k] - box.lower[k]) / (box.upper[k] - box.lower[k]);
      const double cell = share >= 0 && share <= 1 ? 1023 * share : 0;
      code |= spread(static_cast<std::uint32_t>(cell)) << k;
    }
    places.push_back({code, static_cast<std::uint32_t>(places.size())});
  }
  std::sort(places.begin(), places.end(), [](const OrderedPoint& x, const OrderedPoint& y) {
    return x.along != y.along ? x.along < y.along : x.point < y.point;
  });
  return places;
}

}  // namespace

void for_each_point(const Surface& surface, std::span<const Point3> points, const Run& run,
                    const std::function<void(PieceCache&, std::size_t)>& ask) {
  const std::vector<OrderedPoint> order = spatial_order(points);
  const std::size_t step = 1 + points.size() / 1000;
  std::atomic<std::size_t> done{0};
  workers_of(run).for_each(points.size(), [&](Workspace& workspace, std::size_t i) {
    ask(workspace.pieces().of(surface), order[i].point);
    if (++done % step == 0)
      monitor_of(run).report(static_cast<double>(done) / static_cast<double>(points.size()));
  });
}

}  // namespace snug
