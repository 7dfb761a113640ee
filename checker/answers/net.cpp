#include "net.h"

#include <algorithm>
#include <tuple>

namespace answers {
namespace {

// Indices by keys: of each key below `count`, in rising order.
Lists grouped(std::span<const Index> keys, Index count) {
  Lists lists;
  lists.begin.assign(count + 1, 0);
  for (const Index key : keys) ++lists.begin[key + 1];
  for (Index k = 0; k < count; ++k) lists.begin[k + 1] += lists.begin[k];
  std::vector<Index> put(lists.begin.begin(), lists.begin.end() - 1);
  lists.items.resize(keys.size());
  for (Index i = 0; i < keys.size(); ++i) lists.items[put[keys[i]]++] = i;
  return lists;
}

}  // namespace

void Net::connect() {
  const auto corners = static_cast<Index>(faces.items.size());
  face.resize(corners);
  for (Index f = 0; f < faces.size(); ++f) {
    for (Index h = faces.begin[f]; h < faces.begin[f + 1]; ++h) face[h] = f;
  }
  std::vector<std::tuple<Index, Index, Index>> sides;  // both ends, the lower one first; the corner
  sides.reserve(corners);
  for (Index h = 0; h < corners; ++h) {
    const auto [low, high] = std::minmax({vertex(h), vertex(next(h))});
    sides.emplace_back(low, high, h);
  }
  std::sort(sides.begin(), sides.end());
  edge.resize(corners);
  Index edges = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto [low, high, h] = sides[i];
    if (i > 0 && (low != std::get<0>(sides[i - 1]) || high != std::get<1>(sides[i - 1]))) ++edges;
    edge[h] = edges;
  }
  if (corners > 0) ++edges;
  on_edge = grouped(edge, edges);
  at_vertex = grouped(faces.items, static_cast<Index>(points.size()));
}

std::vector<Index> hull_of(const Net& net, std::span<const Index> owners, const Rules& rules) {
  std::vector<Index> vertices, faces;
  for (const Index owner : owners) {
    if (rules.dual()) {
      vertices.push_back(net.vertex(owner));
    } else {
      vertices.insert(vertices.end(), net.faces[owner].begin(), net.faces[owner].end());
    }
  }
  const auto once = [](std::vector<Index>& all) {
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
  };
  once(vertices);
  if (rules.linear()) return vertices;
  for (const Index v : vertices) {
    for (const Index corner : net.at_vertex[v]) faces.push_back(net.face[corner]);
  }
  once(faces);
  vertices.clear();
  for (const Index f : faces) {
    vertices.insert(vertices.end(), net.faces[f].begin(), net.faces[f].end());
  }
  once(vertices);
  return vertices;
}

}  // namespace answers
