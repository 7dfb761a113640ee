#include <snug/mesh/half_edges.h>

#include <algorithm>

namespace snug {
namespace {

// Few elements are inserted one by one: std::stable_sort takes memory for as few as two.
template <class Iterator, class Less>
void stable_sort_few(Iterator begin, Iterator end, Less less) {
  if (end - begin > 16) {
    std::stable_sort(begin, end, less);
    return;
  }
  for (Iterator it = begin; it != end; ++it) {
    std::rotate(std::upper_bound(begin, it, *it, less), it, it + 1);
  }
}

}  // namespace

HalfEdgeGroups::HalfEdgeGroups(std::span<const std::uint32_t> face_offsets,
                               std::span<const VertexId> face_vertices, std::size_t vertex_count) {
  const std::size_t count = face_vertices.size();
  faces_.resize(count);
  std::vector<VertexId> far(
      count);  // the end of a half-edge with the larger id; the smaller one is its bucket
  std::vector<std::uint32_t> bucket_start(vertex_count + 1, 0);
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    for (HalfEdge h = face_offsets[f]; h < face_offsets[f + 1]; ++h) {
      const VertexId a = face_vertices[h];
      const VertexId b = face_vertices[next_in_face(face_offsets, FaceId(f), h)];
      faces_[h] = FaceId(f);
      far[h] = std::max(a, b);
      ++bucket_start[std::min(a, b).index() + 1];
    }
  }
  for (std::size_t v = 0; v < vertex_count; ++v) bucket_start[v + 1] += bucket_start[v];
  std::vector<HalfEdge> buckets(count);
  std::vector<std::uint32_t> fill(bucket_start.begin(), bucket_start.end() - 1);
  for (HalfEdge h = 0; h < count; ++h) {
    const VertexId a = face_vertices[h];
    const VertexId b = face_vertices[next_in_face(face_offsets, faces_[h], h)];
    buckets[fill[std::min(a, b).index()]++] = h;
  }

  members_.reserve(count);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto begin = buckets.begin() + bucket_start[v], end = buckets.begin() + bucket_start[v + 1];
    // Half-edges come in rising order; a stable sort by the far end keeps that order inside an edge.
    stable_sort_few(begin, end, [&](HalfEdge g, HalfEdge h) { return far[g] < far[h]; });
    for (auto it = begin; it != end; ++it) {
      if (it != begin && far[*it] != far[*(it - 1)])
        offsets_.push_back(static_cast<std::uint32_t>(members_.size()));
      members_.push_back(*it);
    }
    if (begin != end) offsets_.push_back(static_cast<std::uint32_t>(members_.size()));
  }
}

}  // namespace snug
