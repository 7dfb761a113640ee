#include <snug/mesh/half_edges.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace snug {

HalfEdgeGroups::HalfEdgeGroups(std::span<const std::uint32_t> face_offsets,
                               std::span<const VertexId> face_vertices, std::size_t vertex_count) {
  const auto count = static_cast<HalfEdge>(face_vertices.size());
  faces_.resize(count);
  std::vector<VertexId> low(count), high(count);  // ends of the edge of each half-edge
  std::vector<std::uint32_t> begins(vertex_count + 1, 0);
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    for (HalfEdge h = face_offsets[f]; h < face_offsets[f + 1]; ++h) {
      faces_[h] = FaceId(f);
      const HalfEdge next = next_in_face(face_offsets, FaceId(f), h);
      std::tie(low[h], high[h]) = std::minmax({face_vertices[h], face_vertices[next]});
      ++begins[low[h].index()];
    }
  }
  // By lower end first: the ends of these groups, which become their beginnings as they are filled.
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  members_.resize(count);
  for (HalfEdge h = count; h-- > 0;) members_[--begins[low[h].index()]] = h;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto begin = members_.begin() + begins[v], end = members_.begin() + begins[v + 1];
    std::sort(begin, end,
              [&](HalfEdge g, HalfEdge h) { return std::tie(high[g], g) < std::tie(high[h], h); });
    for (auto it = begin; it != end; ++it) {
      if (it != begin && high[*it] == high[*(it - 1)]) continue;
      offsets_.push_back(static_cast<std::uint32_t>(it - members_.begin()));
    }
  }
  offsets_.push_back(count);
}

}  // namespace snug
