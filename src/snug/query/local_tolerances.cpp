#include <snug/query/local_tolerances.h>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace snug {
namespace {

constexpr unsigned max_level = 40;

// Bounds of u, v and u + v: triangles of the lattice are what is between two lines of each sort.
using Extents = std::array<std::array<double, 2>, 3>;

Extents extents_of(const std::array<TriangleParameter, 3>& at) {
  Extents extents;
  extents.fill({INFINITY, -INFINITY});
  for (const TriangleParameter& p : at) {
    const std::array<double, 3> values{p.u, p.v, p.u + p.v};
    for (std::size_t k = 0; k < 3; ++k)
      extents[k] = {std::min(extents[k][0], values[k]), std::max(extents[k][1], values[k])};
  }
  return extents;
}

bool overlap(const PiecePath& path, const Extents& part) {
  const double size = 1 / path.scale();
  const auto i = static_cast<double>(path.i()), j = static_cast<double>(path.j());
  const std::array<double, 3> from{i, j, i + j + (path.turned() ? 1 : 0)};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(part[k][1] > size * from[k] && part[k][0] < size * (from[k] + 1))) return false;
  }
  return true;
}

unsigned level_of(const Extents& part) {
  double longest = 0;
  for (const auto& [from, to] : part) longest = std::max(longest, to - from);
  return static_cast<unsigned>(std::clamp(-std::ilogb(longest), 0, static_cast<int>(max_level)));
}

}  // namespace

// Calls visit_leaf for the cells without children that overlap the part; those above `level` are split first.
template <class CellsOf, class Visit>
void LocalTolerances::visit(CellsOf& cells, const PatchPart& part, unsigned level, const Visit& visit_leaf) {
  const Extents extents = extents_of(part.at);
  const auto go = [&](const auto& self, std::uint32_t c, const PiecePath& at) -> void {
    if constexpr (!std::is_const_v<CellsOf>) {
      if (cells[c].first_child == 0 && at.level() < level) {
        Cell child = cells[c];
        cells[c].first_child = static_cast<std::uint32_t>(cells.size());
        cells.resize(cells.size() + 4, child);
      }
    }
    if (cells[c].first_child == 0) return visit_leaf(cells[c]);
    for (unsigned k = 0; k < 4; ++k) {
      if (const PiecePath of_child = at.child(k); overlap(of_child, extents))
        self(self, cells[c].first_child + k, of_child);
    }
  };
  go(go, 0, {});
}

LocalTolerances::LocalTolerances(const LimitSurface& surface, std::vector<double> of_owners)
    : surface_(surface),
      of_owners_(std::move(of_owners)),
      marked_owners_(of_owners_.size(), 0),
      least_(*std::min_element(of_owners_.begin(), of_owners_.end())) {}

std::optional<double> LocalTolerances::of_all(PatchId patch) const {
  if (!cells_.empty() && cells_.contains(patch.value())) return std::nullopt;
  return of_owners_[surface_.place(patch).owner];
}

double LocalTolerances::of(const PatchPart& part) const {
  if (const std::optional<double> all = of_all(part.patch)) return *all;
  const auto found = cells_.find(part.patch.value());
  double least = INFINITY;
  visit(found->second, part, 0, [&](const Cell& cell) { least = std::min(least, cell.tolerance); });
  return least;
}

void LocalTolerances::mark(const PatchPart& part, double least, double whole) {
  const std::uint32_t owner = surface_.place(part.patch).owner;
  if (of_owners_[owner] > whole) {
    if (of_owners_[owner] > least) marked_owners_[owner] = 1;
    return;
  }
  Cells& cells = cells_[part.patch.value()];
  if (cells.empty()) cells.push_back({of_owners_[owner]});
  visit(cells, part, level_of(extents_of(part.at)),
        [&](Cell& cell) { (cell.tolerance > least ? cell.marked : cell.at_least) = true; });
}

double LocalTolerances::refine() {
  double least = INFINITY;
  const auto halve = [&](double& tolerance) {
    tolerance /= 2;
    least = std::min(least, tolerance);
  };
  for (std::size_t owner = 0; owner < of_owners_.size(); ++owner) {
    if (std::exchange(marked_owners_[owner], std::uint8_t{0}) != 0) halve(of_owners_[owner]);
  }
  for (auto& [patch, cells] : cells_) {
    for (Cell& cell : cells) {
      if (cell.first_child != 0) continue;
      if (cell.marked) halve(cell.tolerance);
      cell.times = cell.at_least && !cell.marked ? cell.times + 1 : 0;
      cell.marked = cell.at_least = false;
    }
  }
  least_ = std::min(least_, least);
  return least;
}

int LocalTolerances::times_at_least(const PatchPart& part) const {
  const auto found = cells_.find(part.patch.value());
  int most = 0;
  if (found == cells_.end()) return most;
  visit(found->second, part, 0, [&](const Cell& cell) { most = std::max(most, cell.times); });
  return most;
}

}  // namespace snug
