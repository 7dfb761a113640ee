#include "limit_weights.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include <snug/patch/limit_evaluator.h>

namespace snug::command {
namespace {

// Three unit nets at once, one in each coordinate: those of control points `first` to `first + 2`.
Patch unit_nets(const LimitSurface& surface, PatchId p, std::size_t count, std::size_t first) {
  const Kind* const polygon = surface.polygon_of(p);
  Patch nets;
  nets.kind = polygon ? polygon : &surface.kind(p);
  nets.first = polygon ? std::uint8_t{0} : surface.first(p);
  nets.points.assign(count, {});
  nets.largest = 1;
  nets.points[first].x = 1;
  if (first + 1 < count) nets.points[first + 1].y = 1;
  if (first + 2 < count) nets.points[first + 2].z = 1;
  return polygon ? split(nets, surface.place(p).part) : nets;
}

}  // namespace

Stencils limit_weights(const LimitSurface& surface, std::span<const Place> at, const WorkMonitor& monitor) {
  std::vector<std::size_t> order(at.size());  // those of one patch together
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto patch_of = [&](std::size_t i) { return std::tuple(at[i].owner, at[i].corner); };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return patch_of(a) < patch_of(b); });
  struct Entry {
    std::uint32_t source;
    double weight;
  };
  std::vector<std::vector<Entry>> rows(at.size());
  std::vector<VertexId> control;
  std::vector<Place> places;
  std::vector<BoundedPoint> values;
  LimitEvaluator evaluator;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    monitor.report(static_cast<double>(begin) / static_cast<double>(order.size()));
    places.clear();
    for (; end < order.size() && patch_of(order[end]) == patch_of(order[begin]); ++end) {
      places.push_back(at[order[end]]);
    }
    const Place& place = places.front();
    const PatchId p(surface.patches_of(place.owner).begin + 2 * std::size_t{place.corner});
    surface.control_vertices(p, control);
    values.resize(places.size());
    for (std::size_t first = 0; first < control.size(); first += 3) {
      evaluator.reset(unit_nets(surface, p, control.size(), first));
      evaluator.points(places, values);
      for (std::size_t i = 0; i < values.size(); ++i) {
        for (std::size_t k = 0; k < 3 && first + k < control.size(); ++k) {
          const double weight = values[i].position[k];
          if (weight != 0) rows[order[begin + i]].push_back({control[first + k].value(), weight});
        }
      }
    }
  }
  Stencils result;
  for (const std::vector<Entry>& row : rows) {
    for (const auto& [source, weight] : row) result.add(source, weight);
    result.end_row();
  }
  return result;
}

}  // namespace snug::command
