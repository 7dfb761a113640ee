#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/surface/limit_surface.h>

namespace snug {

/// How a triangle is cut whose sides are marked. Local numbers: 0 to 2 the corners, 3 to 5 the middles of the
/// sides 01, 12, 20.
struct TriangleSplit {
  std::uint8_t count = 0;
  std::array<std::array<std::uint8_t, 3>, 4> triangles{};  ///< oriented as the whole
};

/// Cuts that go with these marks, bit k for side k: one for one mark, two for two (by either diagonal of what
/// is left beside the corner between them), four for three: in quarters, number k as child k of a piece
/// (piece_path.h), or with the line between the middles beside corner k - 1 replaced by the one from that
/// corner to the middle across.
[[nodiscard]] std::size_t split_count(unsigned marks);
/// Requires:  0 < marks < 8, choice < split_count(marks).
[[nodiscard]] TriangleSplit split_of(unsigned marks, std::size_t choice);

/// Triangles that share edges by number, so that whatever is split stays closed: an edge has one middle for
/// all triangles on it. Knows no positions.
///
/// Guarantee: triangles on an edge are those of the surface there, however many. The halves of a split edge
///            replace it in all triangles at once: there are no T-junctions.
class TriangleComplex {
 public:
  using Index = std::uint32_t;
  static constexpr Index none = UINT32_MAX;

  struct Edge {
    Index from, to;
    Index halves = none;  ///< once it is split: two edges in a row, from `from` to the middle, and from there
  };
  /// Side k runs from corner k to the next.
  struct Sides {
    std::array<Index, 3> of;  ///< twice the edge, and one more where the side runs against it
  };

  /// One triangle a root patch that is there, in their order; vertices are corner names. Edges between faces
  /// of which one is split first are split where all of these are, else marked.
  explicit TriangleComplex(const LimitSurface& surface);

  [[nodiscard]] std::size_t triangle_count() const { return corners_.size(); }
  [[nodiscard]] std::size_t edge_count() const { return edges_.size(); }
  /// One more than the largest number of a vertex.
  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  [[nodiscard]] const std::array<Index, 3>& corners(std::size_t t) const { return corners_[t]; }
  [[nodiscard]] Index edge_of(std::size_t t, std::size_t side) const { return sides_[t].of[side] / 2; }
  [[nodiscard]] const Edge& edge(Index e) const { return edges_[e]; }
  [[nodiscard]] const std::vector<PatchId>& root_patches() const { return root_patches_; }

  /// An edge that the next step is to split. Marking may be done by many threads at once.
  void mark(Index e);
  [[nodiscard]] bool marked(Index e) const { return marks_[e] != 0; }
  /// The marks of a triangle's sides, bit by bit.
  [[nodiscard]] unsigned marks(std::size_t t) const {
    const std::array<Index, 3>& s = sides_[t].of;
    return static_cast<unsigned>(marks_[s[0] / 2] | (marks_[s[1] / 2] << 1) | (marks_[s[2] / 2] << 2));
  }
  /// Marks edges that others with the same ends have beside them, edges from a vertex to itself, and sides of
  /// triangles with the same sides. Did it mark any? After few steps there are none, and later steps make none:
  /// parts of triangles that their corners distinguish are distinguished by theirs.
  bool mark_what_is_not_simple();

  /// Gives the middles of marked edges that have none the next vertex numbers, in the order in which triangles
  /// name them; calls new_middle(triangle, side) for each. Edges without triangles are left out.
  template <class NewMiddle>
  void number_middles(NewMiddle&& new_middle);
  /// Cuts one triangle: the first part takes its number, the others those from `first_new` on; inner edges are
  /// numbered from `first_edge` on. Triangles may be cut by many threads at once, each once.
  void cut(std::size_t t, const TriangleSplit& split, std::size_t first_new, Index first_edge);
  /// Makes room for so many more triangles and edges, as cut() wants them.
  void extend(std::size_t triangles, std::size_t edges);
  /// Number of edges inside a triangle that is cut so.
  [[nodiscard]] static std::size_t inner_edges(const TriangleSplit& split) { return split.count - 1u; }
  /// Forgets all marks.
  void clear_marks();
  /// The corners of all triangles; nothing else may be asked afterwards.
  [[nodiscard]] std::vector<std::array<Index, 3>> take_corners();

 private:
  Index middle(Index side) const { return edges_[edges_[side / 2].halves].to; }
  Index half(Index side, bool second) const;
  Index add_edge(Index from, Index to);
  void split_edge(Index e, Index middle);
  Index edge_for(const LimitSurface& surface, const struct PatchSide& side, Index from, Index to);

  std::size_t vertex_count_ = 0;
  std::vector<Edge> edges_;
  std::vector<std::uint8_t> marks_;  // of edges
  std::vector<std::array<Index, 3>> corners_;
  std::vector<Sides> sides_;
  std::vector<PatchId> root_patches_;
  std::vector<Index> whole_, inside_;  // edges by PatchSide while roots are made
};

template <class NewMiddle>
void TriangleComplex::number_middles(NewMiddle&& new_middle) {
  for (std::size_t t = 0; t < corners_.size(); ++t) {
    if (marks(t) == 0) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const Index e = edge_of(t, k);
      if (marks_[e] == 0 || edges_[e].halves != none) continue;
      split_edge(e, static_cast<Index>(vertex_count_++));
      new_middle(t, k);
    }
  }
}

}  // namespace snug
