#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <snug/hull.h>
#include <snug/tessellate.h>
#include <support/scaling.h>

namespace snug {

/// Triangles around each vertex.
class TrianglesAround {
 public:
  explicit TrianglesAround(const Tessellation& mesh);
  [[nodiscard]] std::span<const std::uint32_t> operator[](std::size_t v) const {
    return std::span(triangles_).subspan(begins_[v], begins_[v + 1] - begins_[v]);
  }

 private:
  std::vector<std::uint32_t> begins_, triangles_;
};

/// Triangles of a surface, and what their vertices are moved by.
struct HullTriangles {
  const Tessellation& mesh;
  const TrianglesAround& around;
  PowerOfTwo scale;                 ///< of the surface
  double sign;                      ///< 1: the way that the triangles face; -1: the other way
  std::span<const double> errors;   ///< of each triangle, at most
  std::span<const double> allowed;  ///< that it may have
};

/// Vertices of triangles, moved beyond the planes of the triangles around them: each by itself at first. Where triangles are narrower
/// than they move, and the surface has ripples, facets turn over: vertices of these go the way that the surface faces on the whole,
/// about as those beside them go. No proof rests on it.
class HullVertices {
 public:
  /// Requires:  what it reads outlives it; of the options only `error`, which must be set, and `single_precision` count.
  /// Errors:    InputError (unrepresentable). Interrupted.
  HullVertices(const HullTriangles& triangles, const HullOptions& options, const Run& run);

  /// The coordinates that are handed out.
  [[nodiscard]] const std::vector<Point3>& positions() const { return positions_; }
  [[nodiscard]] std::vector<Point3> take_positions() { return std::move(positions_); }
  /// How far a vertex is moved, at most, scaled: infinite if it has no place.
  [[nodiscard]] double moved(std::size_t v) const { return moved_[v]; }
  /// Does a facet lie the other way round than its triangle: did corners move sideways past each other?
  [[nodiscard]] bool is_turned(std::size_t t) const;

 private:
  // The planes of triangles that their vertices are moved beyond.
  struct Planes {
    std::vector<Vector3> areas, normals;  // outward; area vectors, scaled, and of length 1
    std::vector<double> offsets;          // how far beyond
  };
  [[nodiscard]] double float_loss() const;
  [[nodiscard]] Point3 as_written(Point3 p) const;
  [[nodiscard]] Triangle scaled(const std::vector<Point3>& points, std::size_t t) const;
  [[nodiscard]] Planes make_planes() const;
  [[nodiscard]] std::vector<Vector3> facings() const;
  [[nodiscard]] std::vector<Vector3> smoothed(std::vector<Vector3> facing) const;
  [[nodiscard]] std::optional<Vector3> displacement(std::size_t v, const Vector3& facing, double room) const;
  double move_vertex(std::uint32_t v, const Vector3& facing, double share_of_room);
  [[nodiscard]] std::vector<std::uint32_t> steer(std::vector<std::uint8_t>& steered) const;
  void move_all();

  HullTriangles triangles_;
  const HullOptions& options_;
  const Run& run_;
  Planes planes_;
  std::vector<Point3> positions_;
  std::vector<double> moved_;
};

}  // namespace snug
