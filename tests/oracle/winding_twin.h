#pragma once

#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace oracle {

/// Refinement of a closed mesh: a primal scheme's rules, or a dual scheme.
using WindingScheme = std::variant<Rules, DualScheme>;

/// How often the limit surface of a closed, oriented mesh winds around points, from a refined mesh and the
/// hulls of its one-rings.
///
/// The refined mesh is split into parts that lie each in the hull of some of its vertices, which holds the
/// part of the limit surface it goes to as well: faces with the faces that touch them (primal schemes),
/// corners of faces with the faces around their vertex (dual ones). Around a point in no box of such a hull
/// both wind alike: straight lines between them do not meet the point.
///
/// Requires:  a mesh whose edges have two faces each that run along them in opposite directions.
/// Errors:    std::invalid_argument, see TaggedMesh.
class WindingTwin {
 public:
  WindingTwin(const TaggedMesh& mesh, const WindingScheme& scheme, int levels);

  /// The winding number, by solid angles; nothing in a box of a hull.
  [[nodiscard]] std::optional<int> operator()(const Point& q) const;

  /// Lower bound of the distance of a point to the limit surface: that to the boxes of the hulls.
  [[nodiscard]] double distance_to_boxes(const Point& q) const;

  /// The refined mesh, with the orientation of the control mesh.
  [[nodiscard]] const TaggedMesh& mesh() const { return mesh_; }

 private:
  struct Box {
    Point lower, upper;
  };
  TaggedMesh mesh_;
  std::vector<Box> boxes_;
};

}  // namespace oracle
