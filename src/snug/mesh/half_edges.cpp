#include <snug/mesh/half_edges.h>

#include <algorithm>
#include <numeric>

namespace snug {

HalfEdgeGroups::HalfEdgeGroups(std::span<const std::uint32_t> face_offsets,
                               std::span<const VertexId> face_vertices, std::size_t vertex_count) {
  const auto count = static_cast<HalfEdge>(face_vertices.size());
  faces_.resize(count);
  members_.resize(count);
  std::vector<std::uint32_t> ends(vertex_count + 1, 0);
  const auto edge_of = [&](FaceId f, HalfEdge h) {
    return std::minmax({face_vertices[h], face_vertices[next_in_face(face_offsets, f, h)]});
  };
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    for (HalfEdge h = face_offsets[f]; h < face_offsets[f + 1]; ++h) {
      faces_[h] = FaceId(f);
      ++ends[edge_of(FaceId(f), h).first.index() + 1];
    }
  }
  // By lower end first: the beginnings of these groups, which become their ends as they are filled. Then by
  // higher end, and by number.
  std::partial_sum(ends.begin(), ends.end(), ends.begin());
  std::vector<std::uint64_t> by_ends(count);
  for (HalfEdge h = 0; h < count; ++h) {
    const auto [low, high] = edge_of(faces_[h], h);
    by_ends[ends[low.index()]++] = std::uint64_t{high.value()} << 32 | h;
  }
  std::uint32_t at = 0;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    std::sort(by_ends.begin() + at, by_ends.begin() + ends[v]);
    for (const std::uint32_t begin = at; at < ends[v]; ++at) {
      members_[at] = static_cast<HalfEdge>(by_ends[at]);
      if (at == begin || by_ends[at] >> 32 != by_ends[at - 1] >> 32) offsets_.push_back(at);
    }
  }
  offsets_.push_back(count);
}

}  // namespace snug
