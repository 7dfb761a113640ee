#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <snug/surface/limit_surface.h>
#include <support/blocks.h>

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

  /// One triangle a root patch that is there, in their order; vertices are corner names. Edges between faces
  /// of which one is split first are split where all of these are, else marked.
  explicit TriangleComplex(const LimitSurface& surface);

  [[nodiscard]] std::size_t triangle_count() const { return sites_.size(); }
  [[nodiscard]] std::size_t edge_count() const { return states_.size(); }
  /// One more than the largest number of a vertex.
  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }
  /// A vertex as one patch has it, so that it is at one parameter there: corners of root patches, middles of edges inside of a
  /// patch, and of others one for each triangle on them. Those of a vertex come after the first.
  [[nodiscard]] std::size_t site_count() const { return vertices_.size(); }
  [[nodiscard]] Index vertex_at(Index site) const { return vertices_[site]; }
  [[nodiscard]] const std::array<Index, 3>& sites(std::size_t t) const { return sites_[t]; }
  [[nodiscard]] Index corner(std::size_t t, std::size_t k) const { return vertices_[sites_[t][k]]; }
  [[nodiscard]] Index edge_of(std::size_t t, std::size_t side) const { return sides_[t][side] / 4; }
  [[nodiscard]] const std::vector<PatchId>& root_patches() const { return root_patches_; }

  /// An edge that the next step is to split. Marking may be done by many threads at once.
  void mark(Index e);
  /// The marks of a triangle's sides, bit by bit.
  [[nodiscard]] unsigned marks(std::size_t t) const {
    const std::array<Index, 3>& s = sides_[t];
    const auto bit = [&](Index side) { return states_[side / 4] != none ? 1u : 0u; };
    return bit(s[0]) | (bit(s[1]) << 1) | (bit(s[2]) << 2);
  }
  /// Marks edges that others with the same ends have beside them, edges from a vertex to itself, and sides of
  /// triangles with the same sides. Did it mark any? After few steps there are none, and later steps make none:
  /// parts of triangles that their corners distinguish are distinguished by theirs.
  bool mark_what_is_not_simple();

  /// A triangle with marks that is to be cut.
  struct Cut {
    Index triangle;
    std::array<Index, 3> middles;  ///< sites, of the sides that are marked
    Index first_new;               ///< number of the second part; the first keeps that of the whole
    Index first_edge;              ///< of the first inner edge
  };
  /// Splits the marked edges of triangles, and makes room for the parts. `new_site(triangle, side)` is called for each new site,
  /// a middle, in their order. A vertex that is new with it follows those before.
  template <class NewSite>
  [[nodiscard]] std::vector<Cut> split_edges(NewSite&& new_site);
  /// The vertex in the middle of a marked side, once it is split.
  [[nodiscard]] Index middle(std::size_t t, std::size_t side) const {
    return splits_[states_[edge_of(t, side)]].vertex;
  }
  /// Triangles may be cut by many threads at once, each once.
  void cut(const Cut& cut, const TriangleSplit& split);
  /// Forgets all marks, once all triangles with marks are cut.
  void clear_marks();
  /// Of all triangles; of these and of edges nothing may be asked afterwards.
  [[nodiscard]] Blocks<std::array<Index, 3>> take_sites();

 private:
  // An edge that is split: its halves along it, the middle, and the site of that where all triangles on the edge share it.
  struct Split {
    Index first, second, vertex, site;
  };
  // A side is four times the edge, and two more inside of a root patch, and one more where it runs against the edge.
  static constexpr Index marked = none - 1;
  [[nodiscard]] static bool inside(Index side) { return side / 2 % 2 != 0; }
  Index half(Index side, bool second) const;
  Index add_edge();
  Index add_site(Index vertex);
  Index edge_for(const struct PatchSide& side);
  Index middle_site(Index side, bool& is_new);
  void make_room(std::vector<Cut>& cuts);

  std::size_t vertex_count_ = 0;
  Blocks<Index> states_;  // of edges: none, `marked` or where they are in splits_
  std::vector<Split> splits_;
  Blocks<Index> vertices_;  // of sites
  Blocks<std::array<Index, 3>> sites_, sides_;
  std::vector<PatchId> root_patches_;
  std::vector<Index> whole_, inside_;  // edges by PatchSide while roots are made
};

template <class NewSite>
std::vector<TriangleComplex::Cut> TriangleComplex::split_edges(NewSite&& new_site) {
  std::vector<Cut> cuts;
  std::size_t triangles = triangle_count(), edges = 0;
  for (std::size_t t = 0; t < triangle_count(); ++t) {
    const unsigned bits = marks(t);
    if (bits == 0) continue;
    Cut& cut = cuts.emplace_back(Cut{
        static_cast<Index>(t), {none, none, none}, static_cast<Index>(triangles), static_cast<Index>(edges)});
    for (std::size_t k = 0; k < 3; ++k) {
      if ((bits >> k) % 2 == 0) continue;
      bool is_new = false;
      cut.middles[k] = middle_site(sides_[t][k], is_new);
      if (is_new) new_site(t, k);
      ++triangles;
      ++edges;
    }
  }
  make_room(cuts);
  return cuts;
}

}  // namespace snug
