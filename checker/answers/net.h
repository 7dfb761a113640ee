#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "../real.h"

namespace answers {

using checker::Real;
using Index = std::uint32_t;
using Point = std::array<Real, 3>;

enum class Scheme : std::uint8_t { loop, catmark, doo_sabin, midedge, bilinear, flat };
enum class Boundary : std::uint8_t { none, edge_only, edge_and_corner };

struct Rules {
  Scheme scheme = Scheme::loop;
  Boundary boundary = Boundary::edge_and_corner;
  bool chaikin = false, smooth_triangles = false;

  /// Does a piece of the surface belong to a vertex? Else to a face.
  [[nodiscard]] bool dual() const {
    return scheme == Scheme::doo_sabin || scheme == Scheme::midedge;
  }
  /// Does a piece depend on its own face alone?
  [[nodiscard]] bool linear() const { return scheme == Scheme::bilinear || scheme == Scheme::flat; }
  [[nodiscard]] bool triangles() const { return scheme == Scheme::loop || scheme == Scheme::flat; }
};

/// Sharpness of this value or more is infinite.
inline constexpr double infinite_sharpness = 10;
[[nodiscard]] constexpr bool is_semi_sharp(double s) { return s > 0 && s < infinite_sharpness; }

/// Rows of different lengths.
struct Lists {
  std::vector<Index> begin{0}, items;
  [[nodiscard]] std::span<const Index> operator[](Index i) const {
    return {items.data() + begin[i], items.data() + begin[i + 1]};
  }
  [[nodiscard]] Index size() const { return static_cast<Index>(begin.size() - 1); }
  void close_row() { begin.push_back(static_cast<Index>(items.size())); }
};

/// A control mesh, or what a step of subdivision makes of a part of one. A corner is a vertex in a
/// face, and stands for the edge from it to the next corner, too.
struct Net {
  std::vector<Point> points;
  Lists faces;                           ///< their vertices, counter-clockwise; items are corners
  std::vector<double> sharpness;         ///< of the edge of a corner
  std::vector<double> vertex_sharpness;  ///< empty in linear and dual schemes, as above
  /// With Chaikin's rule: sharpnesses of the semi-sharp edges at each vertex, rising.
  std::vector<std::vector<double>> semi_sharp;
  /// Whose pieces make the surface: faces; of a dual scheme corners, one at each vertex, in the
  /// face that is counted first around it.
  std::vector<Index> owners;

  // Made from those above.
  std::vector<Index> face, edge;  ///< of a corner
  Lists at_vertex, on_edge;       ///< corners
  void connect();

  [[nodiscard]] Index vertex(Index corner) const { return faces.items[corner]; }
  [[nodiscard]] Index next(Index corner) const {
    return corner + 1 == faces.begin[face[corner] + 1] ? faces.begin[face[corner]] : corner + 1;
  }
  [[nodiscard]] Index prev(Index corner) const {
    return corner == faces.begin[face[corner]] ? faces.begin[face[corner] + 1] - 1 : corner - 1;
  }
  /// The corner of the same edge in its other face.
  /// Requires:  an edge of two faces.
  [[nodiscard]] Index twin(Index corner) const {
    const std::span<const Index> both = on_edge[edge[corner]];
    return both[0] == corner ? both[1] : both[0];
  }
  [[nodiscard]] std::pair<Index, Index> ends(Index e) const {
    const Index corner = on_edge[e][0];
    return {vertex(corner), vertex(next(corner))};
  }
};

/// The vertices whose hull contains the surface of these owners.
[[nodiscard]] std::vector<Index> hull_of(const Net& net, std::span<const Index> owners,
                                         const Rules& rules);

/// One step of subdivision of all that determines the surface of these owners. The pieces of an
/// owner follow each other: of a triangle those at its corners and the middle, of other faces those
/// at their corners, of a vertex those in its faces, counter-clockwise from the first. In a piece
/// of a triangle or quad the corner that it keeps is the same one; of other faces it is the first;
/// the face that is counted first around a new vertex of a dual scheme is that inside of the face
/// before.
[[nodiscard]] Net refined(const Net& net, std::span<const Index> owners, const Rules& rules);

}  // namespace answers
