#include "masks.h"

#include <map>

namespace answers {
namespace {

Real whole(std::size_t n) { return {static_cast<double>(n)}; }

}  // namespace

Point loop_vertex(const Net& net, Index v, std::span<const Spoke> spokes) {
  const auto n = static_cast<unsigned>(spokes.size());
  thread_local std::map<unsigned, std::array<Real, 2>>
      masks;  // of the vertex and of each in its ring
  const auto [mask, made] = masks.try_emplace(n);
  if (made) {
    const Real wave = Real(3.0) + Real(2.0) * Real::cos_of_turn(n);
    const Real share = Real(0.625) - wave * wave / Real(64.0);
    mask->second = {Real(1.0) - share, share / whole(n)};
  }
  Sum ring;
  for (const Spoke& spoke : spokes) ring.add(net.points[spoke.end]);
  ring.scale(mask->second[1]);
  ring.add(mask->second[0], net.points[v]);
  return ring.value;
}

Point loop_edge(const Net& net, Index edge) {
  const auto [a, b] = net.ends(edge);
  Sum ends, across;
  for (const Index end : {a, b}) ends.add(net.points[end]);
  for (const Index corner : net.on_edge[edge]) across.add(net.points[net.vertex(net.prev(corner))]);
  ends.scale(Real(0.375));
  ends.add(Real(0.125), across.value);
  return ends.value;
}

Point mean_of_face(const Net& net, Index face) {
  Sum sum;
  for (const Index v : net.faces[face]) sum.add(net.points[v]);
  sum.scale(Real(1.0) / whole(net.faces[face].size()));
  return sum.value;
}

Point catmark_vertex(const Net& net, Index v, std::span<const Spoke> spokes,
                     const std::vector<const Point*>& means) {
  const Real n = whole(means.size());
  Sum around;
  for (const Spoke& spoke : spokes) around.add(net.points[spoke.end]);
  for (const Point* mean : means) around.add(*mean);
  around.scale(Real(1.0) / (n * n));
  around.add((n - Real(2.0)) / n, net.points[v]);
  return around.value;
}

Point catmark_edge(const Net& net, Index edge, const std::array<const Point*, 2>& means,
                   bool smooth_triangles) {
  Real share = 0.25;  // of each face's mean
  if (smooth_triangles) {
    share = Real(0.0);
    for (const Index corner : net.on_edge[edge]) {
      const bool triangle = net.faces[net.face[corner]].size() == 3;
      share += triangle ? Real(47.0) / Real(200.0) : Real(0.125);
    }
  }
  const auto [a, b] = net.ends(edge);
  Sum ends;
  for (const Index end : {a, b}) ends.add(net.points[end]);
  ends.scale((Real(1.0) - Real(2.0) * share) / Real(2.0));
  for (const Point* mean : means) ends.add(share, *mean);
  return ends.value;
}

Point dual_vertex(const Net& net, Index corner, Scheme scheme) {
  const auto n = static_cast<unsigned>(net.faces[net.face[corner]].size());
  Sum sum;
  if (scheme == Scheme::midedge) {
    sum.add(Real(0.5), net.points[net.vertex(corner)]);
    for (const Index beside : {net.prev(corner), net.next(corner)}) {
      sum.add(Real(0.25), net.points[net.vertex(beside)]);
    }
    return sum.value;
  }
  thread_local std::map<unsigned, std::vector<Real>> masks;
  std::vector<Real>& mask = masks[n];
  if (mask.empty()) {
    const Real quarter = Real(4.0) * whole(n);
    mask.push_back(Real(0.25) + Real(5.0) / quarter);
    for (unsigned i = 1; i < n; ++i) {
      mask.push_back((Real(3.0) + Real(2.0) * Real::cos_of_turn(n, i)) / quarter);
    }
  }
  for (const Real& weight : mask) {
    sum.add(weight, net.points[net.vertex(corner)]);
    corner = net.next(corner);
  }
  return sum.value;
}

}  // namespace answers
