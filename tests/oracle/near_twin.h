#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace oracle {

/// Distances along the edges of a fine mesh: of points of a smooth surface between that along the surface and some
/// 1.2 times that, where faces are about as wide as long and finer than all that is looked at.
class EdgeWays {
 public:
  using Point = std::array<double, 3>;
  /// Edges and the two diagonals of quads that pairs of triangles, or faces, make.
  EdgeWays(std::span<const Point> points, const std::vector<std::vector<std::uint32_t>>& faces);

  /// To all points; infinite where no way leads, or none up to `most`.
  [[nodiscard]] std::vector<double> from(std::uint32_t point, double most) const;
  [[nodiscard]] double straight(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] std::uint32_t nearest(const Point& p) const;
  [[nodiscard]] std::size_t size() const { return points_.size(); }
  [[nodiscard]] double longest_edge() const { return longest_; }

  /// Longest way, in this sense, between one of every `step` points and others within `chord` of it; infinite
  /// for more than `most`.
  [[nodiscard]] double longest_way(double chord, double most, std::uint32_t step) const;

 private:
  std::vector<Point> points_;
  std::vector<std::vector<std::uint32_t>> next_;
  double longest_ = 0;
};

}  // namespace oracle
