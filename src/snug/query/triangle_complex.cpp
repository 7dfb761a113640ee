#include <snug/query/triangle_complex.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <tuple>
#include <utility>

#include <snug/surface/patch_sides.h>
#include <support/contract.h>

namespace snug {
namespace {

using Index = TriangleComplex::Index;
using Local = std::array<std::uint8_t, 3>;

std::uint8_t corner(std::size_t k) { return static_cast<std::uint8_t>(k % 3); }
std::uint8_t middle_of(std::size_t side) { return static_cast<std::uint8_t>(3 + side % 3); }

// The side with the only bit, or the one before the other two.
std::size_t side_of_bit(unsigned bit) { return bit == 1 ? 0 : bit == 2 ? 1 : 2; }

// Calls visit(i) for the numbers of all keys that are there more than once. First entries are below `limit`.
template <std::size_t N, class Visit>
void for_each_repeated(const std::vector<std::array<Index, N>>& keys, std::size_t limit, const Visit& visit) {
  std::vector<Index> begins(limit + 1, 0), order(keys.size());
  for (const auto& key : keys) ++begins[key[0] + 1];
  for (std::size_t i = 1; i < begins.size(); ++i) begins[i] += begins[i - 1];
  std::vector<Index> next(begins.begin(), begins.end() - 1);
  for (Index i = 0; i < keys.size(); ++i) order[next[keys[i][0]]++] = i;
  for (std::size_t first = 0; first < limit; ++first) {
    const auto begin = order.begin() + begins[first], end = order.begin() + begins[first + 1];
    std::sort(begin, end, [&](Index a, Index b) { return std::tie(keys[a], a) < std::tie(keys[b], b); });
    for (auto it = begin; it < end; ++it) {
      const bool as_before = it != begin && keys[it[-1]] == keys[*it];
      if (as_before || (it + 1 < end && keys[it[1]] == keys[*it])) visit(*it);
    }
  }
}

}  // namespace

std::size_t split_count(unsigned marks) {
  const int bits = __builtin_popcount(marks);
  return bits == 1 ? 1 : bits == 2 ? 2 : 4;
}

TriangleSplit split_of(unsigned marks, std::size_t choice) {
  const int bits = __builtin_popcount(marks);
  if (bits == 1) {
    const std::size_t k = side_of_bit(marks);
    return {
        2,
        {Local{corner(k), middle_of(k), corner(k + 2)}, Local{middle_of(k), corner(k + 1), corner(k + 2)}}};
  }
  if (bits == 2) {
    const std::size_t k = (side_of_bit(7 - marks) + 1) % 3;  // marked: sides k and k + 1
    const std::uint8_t a = middle_of(k), b = middle_of(k + 1), before = corner(k), behind = corner(k + 2);
    const Local tip{a, corner(k + 1), b};
    if (choice == 0) return {3, {tip, Local{before, a, behind}, Local{a, b, behind}}};
    return {3, {tip, Local{before, a, b}, Local{before, b, behind}}};
  }
  TriangleSplit split{4, {Local{0, 3, 5}, Local{3, 1, 4}, Local{5, 4, 2}, Local{4, 5, 3}}};
  if (choice > 0) {
    const std::size_t k = choice - 1;
    split.triangles[k] = {corner(k), middle_of(k), middle_of(k + 1)};
    split.triangles[3] = {corner(k), middle_of(k + 1), middle_of(k + 2)};
  }
  return split;
}

TriangleComplex::TriangleComplex(const LimitSurface& surface)
    : vertex_count_(surface.corner_name_count()),
      whole_(surface.topology().edge_count(), none),
      inside_(surface.rules().triangular() ? 0 : surface.patch_count(), none) {
  std::vector<bool> in_halves(whole_.size(), false), in_one(whole_.size(), false);
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (!surface.has_patch(PatchId(p))) continue;
    root_patches_.emplace_back(p);
    for (const PatchSide& side : sides_of(surface, PatchId(p))) {
      if (side.part == PatchSide::Part::whole) in_one[side.number] = true;
      if (side.part == PatchSide::Part::first_half) in_halves[side.number] = true;
    }
  }
  for (std::size_t e = 0; e < whole_.size(); ++e) {
    if (!in_halves[e] && !in_one[e]) continue;
    whole_[e] = add_edge();
    if (!in_halves[e]) continue;
    const Index first = add_edge(), second = add_edge();
    states_[whole_[e]] = static_cast<Index>(splits_.size());
    splits_.push_back({first, second, ends_of(surface, EdgeId(e))[1], none});
  }
  for (const PatchId p : root_patches_) {
    const std::array<std::uint32_t, 3> names = surface.corner_names(p);
    const std::array<PatchSide, 3> sides = sides_of(surface, p);
    std::array<Index, 3> sites, numbers;
    for (std::size_t k = 0; k < 3; ++k) {
      sites[k] = add_site(names[k]);
      numbers[k] = 4 * edge_for(sides[k]) + (sides[k].reversed ? 1 : 0);
    }
    sites_.push_back(sites);
    sides_.push_back(numbers);
  }
  whole_ = {};
  inside_ = {};
}

Index TriangleComplex::edge_for(const PatchSide& side) {
  switch (side.part) {
    case PatchSide::Part::whole:
      return whole_[side.number];
    case PatchSide::Part::first_half:
      return splits_[states_[whole_[side.number]]].first;
    case PatchSide::Part::second_half:
      return splits_[states_[whole_[side.number]]].second;
    case PatchSide::Part::inside:
      break;
  }
  Index& known = inside_[side.number];
  if (known == none) known = add_edge();
  return known;
}

Index TriangleComplex::add_edge() {
  SNUG_EXPECT(states_.size() < none / 4);
  states_.push_back(none);
  return static_cast<Index>(states_.size() - 1);
}

Index TriangleComplex::add_site(Index vertex) {
  vertices_.push_back(vertex);
  return static_cast<Index>(vertices_.size() - 1);
}

void TriangleComplex::mark(Index e) {
  std::atomic_ref<Index> state(states_[e]);
  if (state.load(std::memory_order_relaxed) == none) state.store(marked, std::memory_order_relaxed);
}

void TriangleComplex::clear_marks() {
  for (std::size_t e = 0; e < states_.size(); ++e) states_[e] = none;
  splits_ = {};
}

bool TriangleComplex::mark_what_is_not_simple() {
  bool any = false;
  const auto mark_edge = [&](Index e) {
    mark(e);
    any = true;
  };
  std::vector<Index> live;
  std::vector<bool> used(states_.size(), false);
  std::vector<std::array<Index, 2>> ends;
  std::vector<std::array<Index, 3>> triples;
  for (std::size_t t = 0; t < triangle_count(); ++t) {
    triples.push_back({edge_of(t, 0), edge_of(t, 1), edge_of(t, 2)});
    std::sort(triples.back().begin(), triples.back().end());
    for (std::size_t k = 0; k < 3; ++k) {
      const Index e = edge_of(t, k), from = corner(t, k), to = corner(t, (k + 1) % 3);
      if (used[e]) continue;
      used[e] = true;
      live.push_back(e);
      ends.push_back({std::min(from, to), std::max(from, to)});
      if (from == to) mark_edge(e);
    }
  }
  for_each_repeated(ends, vertex_count_, [&](Index i) { mark_edge(live[i]); });
  for_each_repeated(triples, states_.size(), [&](Index t) {
    for (std::size_t k = 0; k < 3; ++k) mark_edge(edge_of(t, k));
  });
  return any;
}

// The site of a marked side's middle for the next triangle on it. The first half takes the number of the edge.
Index TriangleComplex::middle_site(Index side, bool& is_new) {
  const Index e = side / 4;
  if (states_[e] == marked) {
    const Index second = add_edge();
    states_[e] = static_cast<Index>(splits_.size());
    splits_.push_back({e, second, static_cast<Index>(vertex_count_++), none});
  }
  Split& split = splits_[states_[e]];
  if (split.site != none) return split.site;
  is_new = true;
  const Index site = add_site(split.vertex);
  if (inside(side)) split.site = site;
  return site;
}

void TriangleComplex::make_room(std::vector<Cut>& cuts) {
  for (Cut& cut : cuts) cut.first_edge += static_cast<Index>(states_.size());
  std::size_t parts = 0;
  for (const Cut& cut : cuts) parts += static_cast<std::size_t>(std::popcount(marks(cut.triangle)));
  const std::size_t edges = states_.size();
  SNUG_EXPECT(edges + parts < none / 4);
  states_.resize(edges + parts);
  for (std::size_t e = edges; e < states_.size(); ++e) states_[e] = none;
  sites_.resize(sites_.size() + parts);
  sides_.resize(sides_.size() + parts);
}

// The first or second half of a side, along it.
Index TriangleComplex::half(Index side, bool second) const {
  const Split& split = splits_[states_[side / 4]];
  const bool reversed = side % 2 != 0;
  return 4 * (second != reversed ? split.second : split.first) + side % 4;
}

Blocks<std::array<TriangleComplex::Index, 3>> TriangleComplex::take_sites() {
  states_ = {};
  sides_ = {};
  return std::move(sites_);
}

void TriangleComplex::cut(const Cut& cut, const TriangleSplit& split) {
  const std::array<Index, 3> old = sides_[cut.triangle], whole = sites_[cut.triangle];
  const auto site = [&](std::size_t local) { return local < 3 ? whole[local] : cut.middles[local - 3]; };
  std::array<std::array<std::uint8_t, 2>, 3> inner{};
  std::size_t inner_count = 0;
  const auto side_between = [&](std::uint8_t p, std::uint8_t q) -> Index {
    if (p < 3 && q < 3) return old[p];
    if (p < 3 && q == 3 + p) return half(old[p], false);
    if (p < 3 && q == 3 + (p + 2) % 3) return half(old[(p + 2) % 3], true) ^ 1;
    if (q < 3 && p == 3 + q) return half(old[q], false) ^ 1;
    if (q < 3 && p == 3 + (q + 2) % 3) return half(old[(q + 2) % 3], true);
    for (std::size_t i = 0; i < inner_count; ++i) {
      if (inner[i][0] == q && inner[i][1] == p) return 4 * (cut.first_edge + static_cast<Index>(i)) + 3;
    }
    inner[inner_count] = {p, q};
    return 4 * (cut.first_edge + static_cast<Index>(inner_count++)) + 2;
  };
  for (std::size_t i = 0; i < split.count; ++i) {
    const std::size_t number = i == 0 ? cut.triangle : cut.first_new + i - 1;
    const Local& local = split.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      sites_[number][k] = site(local[k]);
      sides_[number][k] = side_between(local[k], local[(k + 1) % 3]);
    }
  }
}

}  // namespace snug
