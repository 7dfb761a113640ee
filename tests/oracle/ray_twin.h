#pragma once

#include <oracle/winding_twin.h>

#include <gmpxx.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace oracle {

/// Where a line meets a flat face, exactly.
struct ExactHit {
  mpq_class t;
  std::uint32_t face;
  int side = 0;         ///< +1 along the normal, -1 against it, 0 in the face's plane
  bool border = false;  ///< on an edge or a vertex, or in the plane
};

/// Flat convex faces with double coordinates, asked in exact rational arithmetic.
///
/// Requires:  faces that are flat exactly and convex, see is_flat_and_convex().
class FlatFaces {
 public:
  FlatFaces(const std::vector<Point>& points, std::vector<std::vector<std::uint32_t>> faces);

  /// All hits of the line origin + t direction, by t. Of a face that the line lies in, where it meets the
  /// edges.
  [[nodiscard]] std::vector<ExactHit> hits(const Point& origin, const Point& direction) const;

 private:
  using Vector = std::array<mpq_class, 3>;
  std::vector<Vector> points_;
  std::vector<std::vector<std::uint32_t>> faces_;
  std::vector<Vector> normals_;
};

/// Is the face flat, without rounding, convex, and larger than a line?
[[nodiscard]] bool is_flat_and_convex(const std::vector<Point>& points,
                                      const std::vector<std::uint32_t>& face);

/// Crosses it a line no edge and no vertex, and lies it in no face's plane?
[[nodiscard]] bool is_generic(const std::vector<ExactHit>& hits);

/// Where lines may meet the limit surface of a mesh of any scheme with any tags: the hulls of the refined
/// mesh's one-rings, see WindingTwin, which hold the surface and the refined mesh. A line meets some of their
/// boxes; between ranges of the line that these cover there is neither. Of the boxes in one range the border
/// lies in boxes that the line misses, so limit surface and refined mesh cross the line equally often there,
/// signs counted; but for borders of an open surface.
class RefinedRays {
 public:
  struct Range {
    double lower, upper;
    /// Of the refined mesh; nothing where an open edge is too near, or the line to an edge of the mesh.
    std::optional<int> crossings = 0;
  };

  /// Errors:    std::invalid_argument, see TaggedMesh.
  RefinedRays(const TaggedMesh& mesh, const WindingScheme& scheme, int levels);

  /// In order, apart from each other.
  /// Requires:  coordinates, and lengths of directions, between 1e-90 and 1e90, or zero.
  [[nodiscard]] std::vector<Range> ranges(const Point& origin, const Point& direction) const;

 private:
  struct Box {
    Point lower, upper;
    bool open;  // one of the edges in it
  };
  TaggedMesh mesh_;
  std::vector<Box> boxes_;
};

}  // namespace oracle
