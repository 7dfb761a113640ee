#pragma once

#include <oracle/curve_twin.h>
#include <snug/surface/curve_set.h>
#include <testing/containment.h>

#include <random>
#include <string>
#include <vector>

/// Curves of the oracle as the library's own, and what tests ask of both.
namespace snug::testing {

[[nodiscard]] inline ControlMesh control_mesh(const std::vector<oracle::TwinPolyline>& twins) {
  ControlMesh mesh;
  for (const oracle::TwinPolyline& twin : twins) {
    std::vector<VertexId> line;
    for (const oracle::Point& p : twin.points) {
      line.emplace_back(mesh.points.size());
      mesh.points.push_back({p[0], p[1], p[2]});
    }
    if (twin.closed) line.push_back(line.front());
    mesh.add_polyline(line);
  }
  return mesh;
}

[[nodiscard]] inline CurveSet curve_set(const oracle::TwinPolyline& twin, int degree) {
  return CurveSet(control_mesh(std::vector{twin}), degree == 2 ? CurveDegree::quadratic : CurveDegree::cubic);
}

/// Open and closed ones of every small length, with repeated vertices among them.
[[nodiscard]] inline std::vector<oracle::TwinPolyline> assorted_polylines(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  std::vector<oracle::TwinPolyline> list;
  for (const bool closed : {false, true}) {
    for (std::size_t n = closed ? 1 : 2; n <= 9; ++n) {
      oracle::TwinPolyline line{{}, closed};
      for (std::size_t i = 0; i < n; ++i) {
        line.points.push_back({coordinate(random), coordinate(random), coordinate(random)});
      }
      if (n % 4 == 1 && n > 1) line.points[n / 2] = line.points[n / 2 - 1];
      list.push_back(line);
    }
  }
  return list;
}

/// Is the sample in both enclosures of a piece? A segment is a triangle with two corners in one place.
[[nodiscard]] inline bool contains(const OffsetSegment& offset, const IntervalSegment& interval,
                                   const oracle::CurveSample& s) {
  const Extended p{s.position[0], s.position[1], s.position[2]};
  const long double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
  const long double slack = 1.8L * s.error + 1e-17L * offset.radius + 1e-18L * size;
  return within_radius(p, {offset.base[0], offset.base[1], offset.base[1]}, offset.radius + slack) &&
         in_interval_triangle(p, {{interval.corner[0], interval.corner[1], interval.corner[1]}}, slack);
}

[[nodiscard]] inline bool contains(const Box3& box, const oracle::CurveSample& s) {
  for (std::size_t a = 0; a < 3; ++a) {
    if (s.position[a] < box.lower[a] - s.error || s.position[a] > box.upper[a] + s.error) return false;
  }
  return true;
}

/// The parameters of an edge's piece: [first, first + size].
struct Range {
  double first, size;
  [[nodiscard]] bool holds(double t) const { return t >= first && t <= first + size; }
};
[[nodiscard]] inline Range range_of(const std::string& piece) {
  Range range{0, 1};
  for (const char digit : piece) {
    range.size /= 2;
    range.first += (digit - '0') * range.size;
  }
  return range;
}

}  // namespace snug::testing
