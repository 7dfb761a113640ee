#pragma once

#include <oracle/twin_mesh.h>
#include <snug/patch/patch.h>

#include <vector>

namespace snug::testing {

[[nodiscard]] inline CornerFan inside(std::size_t n) {
  return {0, static_cast<std::uint16_t>(n - 1), true, false};
}

/// The rule under which a twin of the kind's neighbourhood refines as the kind does.
[[nodiscard]] inline oracle::Boundary boundary_of(const KindKey& key) {
  for (const CornerFan& fan : key.corners) {
    if (fan.sharp) return oracle::Boundary::edge_and_corner;
  }
  return oracle::Boundary::edge_only;
}

/// A patch of the kind with these control points.
[[nodiscard]] inline Patch patch_of(const Kind& kind, std::span<const Point3> points) {
  std::vector<VertexId> which;
  for (std::size_t i = 0; i < points.size(); ++i) which.emplace_back(i);
  return make_patch(kind, 0, points, which);
}

/// Kinds with one and three extraordinary corners, at boundaries, with sharp corners.
[[nodiscard]] inline std::vector<KindKey> assorted_kinds() {
  std::vector<KindKey> keys;
  for (const std::size_t n : {3u, 4u, 5u, 6u, 7u, 8u, 12u, 40u}) {
    keys.push_back({Scheme::loop, {inside(6), inside(6), inside(n)}});
    keys.push_back({Scheme::loop, {inside(5), inside(n), inside(9)}});
  }
  for (const std::uint16_t before : {std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{3}}) {
    // A boundary along edge 20; edge 01 too where nothing lies before corner 0.
    const CornerFan next = before == 0 ? CornerFan{2, 0, false, false} : inside(7);
    keys.push_back({Scheme::loop, {CornerFan{before, 0, false, false}, next, CornerFan{0, 2, false, false}}});
  }
  const CornerFan lone{0, 0, false, true};
  keys.push_back({Scheme::loop, {lone, CornerFan{2, 0, false, false}, CornerFan{0, 4, false, false}}});
  keys.push_back({Scheme::loop, {lone, lone, lone}});
  return keys;
}

}  // namespace snug::testing
