#pragma once

#include <oracle/twin_mesh.h>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace oracle {

/// Triangles, asked in exact arithmetic what they have in common with each other, with segments and with points.
///
/// Requires:  finite coordinates from 1e-90 to 1e90 in size, or zero.
/// Cost:      signs of determinants are decided in double precision where its error allows it, else in rationals.
class HullTwin {
 public:
  HullTwin(std::vector<Point> points, std::vector<Triangle> triangles);

  /// Pairs of triangles that have more in common than the vertices that both name and the edge between two of these. A
  /// triangle without area is paired with itself.
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> contacts() const;
  /// Edges that are not run along once in each direction.
  [[nodiscard]] std::size_t open_edges() const;

  /// A triangle that has a point in common with the segment from p to q.
  [[nodiscard]] std::optional<std::size_t> met_by(const Point& p, const Point& q) const;
  /// A triangle of this mesh and one of another that have a common point.
  [[nodiscard]] std::optional<std::pair<std::size_t, std::size_t>> met_by(const HullTwin& other) const;
  /// How often closed triangles wind around a point; nothing on them.
  [[nodiscard]] std::optional<int> winding(const Point& q) const;
  /// The distance of a point to the nearest triangle, in double precision.
  [[nodiscard]] double distance(const Point& q) const;

 private:
  struct Box {
    Point lower, upper;
  };
  [[nodiscard]] const Point& corner(std::size_t t, std::size_t k) const { return points_[triangles_[t][k]]; }
  [[nodiscard]] bool has_area(std::size_t t) const;
  [[nodiscard]] bool meets(const Point& p, const Point& q, std::size_t t) const;
  [[nodiscard]] bool share_too_much(std::size_t s, std::size_t t) const;

  std::vector<Point> points_;
  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
};

}  // namespace oracle
