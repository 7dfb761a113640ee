#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <snug/surface/piece_name.h>

namespace snug {

/// A vertex of the surface's triangulation of some level. Equal names, equal limit points.
struct LevelVertex {
  std::uint64_t where = 0;  ///< a corner of root patches, an edge of them, or a patch
  std::uint64_t place = 0;  ///< there
  friend auto operator<=>(const LevelVertex&, const LevelVertex&) = default;
};
struct LevelVertexHash {
  std::size_t operator()(const LevelVertex& v) const noexcept;
};

/// The pieces around a vertex, counter-clockwise.
struct LevelStar {
  struct Sector {
    PieceName piece;
    std::uint8_t centre;  ///< corner of the piece at the vertex
    bool mirrored =
        false;  ///< Are the piece's corners clockwise around the vertex, in a fan of faces that do not run the same way?
  };
  std::vector<Sector> sectors;
  bool closed = false;
  bool fan = false;  ///< Do the sectors follow each other, once around or from one border to another?
};

/// A surface's pieces of each level as a triangulation, by names alone: what is beside what.
///
/// Level 0 are the root patches, if no owner has a first split; else the levels begin at 1, with the patches of
/// first splits and the children of others.
class LevelComplex {
 public:
  explicit LevelComplex(const LimitSurface& surface);

  [[nodiscard]] unsigned first_level() const { return first_level_; }
  static constexpr unsigned max_level = 24;
  [[nodiscard]] unsigned level_of(const PieceName& piece) const {
    return piece.path.level() + offset(piece.patch);
  }
  /// All pieces of the first level.
  [[nodiscard]] std::vector<PieceName> pieces() const;
  /// The names of a piece's corners, at its level.
  [[nodiscard]] std::array<LevelVertex, 3> vertices(const PieceName& piece) const;
  /// Requires:  a vertex of a piece of that level.
  [[nodiscard]] LevelStar star(const LevelVertex& vertex, unsigned level) const;
  /// Puts sectors at one vertex in order, if they are a fan: sets `fan` and `closed`.
  void put_in_order(LevelStar& star) const;
  /// The sectors of a star as fans, each as large as it can be: across an edge that two of them alone are
  /// at, which run along it opposite ways.
  [[nodiscard]] std::vector<LevelStar> fans(const LevelStar& star) const;

 private:
  // An edge of a root patch from its corner k to k + 1, on the whole edge that it is a half of or all: in
  // halves, from 0 to 2.
  struct Side {
    std::uint64_t edge;
    std::uint8_t begin, end;
  };
  struct Incidence {
    PatchId patch;
    std::uint8_t corner;  // or side
  };
  [[nodiscard]] unsigned offset(PatchId patch) const { return surface_->after_first_split(patch) ? 1u : 0u; }
  [[nodiscard]] std::array<Side, 3> sides_of(PatchId patch) const;
  [[nodiscard]] LevelVertex vertex(PatchId patch, unsigned splits, std::uint64_t i, std::uint64_t j) const;
  // The middles of a sector's edges at its centre: they identify edges.
  struct Ends {
    LevelVertex begin, end;
  };
  [[nodiscard]] Ends ends_of(const LevelStar::Sector& sector) const;
  void add_pieces(PatchId patch, unsigned splits, std::uint64_t i, std::uint64_t j,
                  std::vector<LevelStar::Sector>& out) const;

  const LimitSurface* surface_;
  unsigned first_level_ = 0;
  std::vector<std::array<std::uint32_t, 3>> names_;
  std::vector<std::array<Side, 3>> sides_;
  std::unordered_map<std::uint64_t, std::vector<Incidence>> at_corner_, at_edge_;
};

}  // namespace snug
