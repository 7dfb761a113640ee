#include "patch_lattice.h"

#include <algorithm>
#include <cmath>

#include <support/run.h>

namespace snug::command {
namespace {

// The place at (u, v) of the patch's triangle, see PatchPlace.
Place place_on(const PatchPlace& patch, bool triangular, double u, double v) {
  if (triangular) return {patch.owner, 0, u, v};
  const std::uint32_t corner = patch.part / 2;
  return patch.part % 2 == 0 ? Place{patch.owner, corner, u + v, v}
                             : Place{patch.owner, corner, 1 - u - v, 1 - v};
}

}  // namespace

PatchLattice::PatchLattice(const Surface& surface, std::uint32_t steps)
    : triangular_(surface.traits().triangular), steps_(steps) {
  for (std::uint32_t owner = 0; owner < surface.owner_count(); ++owner) {
    begins_.push_back(ranks_.size());
    const auto parts = static_cast<std::uint32_t>(triangular_ ? 1 : 2 * surface.corner_count(owner));
    for (std::uint32_t part = 0; part < parts; ++part) {
      ranks_.push_back(patches_.size());
      if (surface.has(place_on({owner, part}, triangular_, 0.25, 0.25))) patches_.push_back({owner, part});
    }
  }
}

void PatchLattice::evaluate(const Surface& surface, const Run& run,
                            const std::function<void(const Place&, std::vector<Place>&)>& ask,
                            const std::function<void(std::span<const SurfacePoint>)>& take) const {
  constexpr std::size_t batch = 16384;
  std::vector<Place> places;
  for (std::size_t rank = 0; rank < patches_.size(); ++rank) {
    for (std::uint32_t j = 0; j <= steps_; ++j) {
      for (std::uint32_t i = 0; i + j <= steps_; ++i) {
        // The far edge is met exactly: u + v rounds to at most 1.
        const double v = static_cast<double>(j) / steps_,
                     u = std::fmin(static_cast<double>(i) / steps_, 1 - v);
        ask(place_on(patches_[rank], triangular_, u, v), places);
      }
    }
    if (places.size() < batch && rank + 1 < patches_.size()) continue;
    monitor_of(run).checkpoint();
    take(snug::evaluate(surface, places, run));
    places.clear();
  }
}

double PatchLattice::interpolated(const std::vector<double>& values, const QuickHit& hit) const {
  const double* const own = values.data() + rank(hit.patch) * (std::size_t{steps_ + 1} * (steps_ + 2) / 2);
  const auto [owner, corner, along, across] = hit.at;
  const bool first = hit.patch.part % 2 == 0;
  const double x = steps_ * (triangular_ ? along
                             : first     ? along - across
                                         : across - along),
               y = steps_ * (triangular_ || first ? across : 1 - across);
  auto i = static_cast<std::uint32_t>(std::clamp(x, 0.0, steps_ - 1.0)),
       j = static_cast<std::uint32_t>(std::clamp(y, 0.0, steps_ - 1.0));
  while (i + j >= steps_) --(i > j ? i : j);
  const double u = x - i, v = y - j;
  const double a = own[at(i + 1, j)], b = own[at(i, j + 1)];
  if (u + v <= 1) return (1 - u - v) * own[at(i, j)] + u * a + v * b;
  if (i + j + 2 > steps_) return (u * a + v * b) / (u + v);
  return (u + v - 1) * own[at(i + 1, j + 1)] + (1 - v) * a + (1 - u) * b;
}

}  // namespace snug::command
