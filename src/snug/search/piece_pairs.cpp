#include <snug/search/piece_pairs.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>

namespace snug {

double PiecePairs::radii(const NodePair& pair) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    sum += frames_.frame(s).growth() * SurfaceWorkspace::record(pair.nodes[s]).radius();
  }
  return sum;
}

double PiecePairs::errors(const NodePair& pair) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    sum += frames_.frame(s).growth() * SurfaceWorkspace::record(pair.nodes[s]).error();
  }
  return sum;
}

PiecePair PiecePairs::nearest(const NodePair& pair) {
  ++stats_.triangle_tests;
  PiecePair pieces;
  pieces.nodes = pair.nodes;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frames_.frame(s);
    const PieceRecord& record = SurfaceWorkspace::record(pair.nodes[s]);
    const Triangle base = record.base(pair.nodes[s].boxes->origin());
    double error = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      pieces.base[s][k] = frame.apply(base[k]);
      error = std::max(error, frame.apply_error(base[k]));
    }
    pieces.radii[s] = enlarged(record.radius() * frame.growth() + spatial_error(error));
  }
  pieces.near = snug::nearest(pieces.base[0], pieces.base[1]);
  const double gap = rounded_down(pieces.near.certain_distance - enlarged(pieces.radii[0] + pieces.radii[1]));
  pieces.gap = std::max({gap, static_cast<double>(pair.gap), 0.0});

  const std::array<Barycentric, 2> at{pieces.near.on_a, pieces.near.on_b};
  std::array<Point3, 2> points;
  double error = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frames_.frame(s);
    const PieceRecord& record = SurfaceWorkspace::record(pair.nodes[s]);
    // Rounding of the sum errs by as much as that of the placement at most.
    const Point3 own = pair.nodes[s].boxes->origin() + record.at(clamped(at[s]));
    points[s] = frame.apply(own);
    error += frame.growth() * record.error() + 2 * spatial_error(frame.apply_error(own));
  }
  pieces.between = points[1] - points[0];
  pieces.near_distance =
      (std::sqrt(length_sq(pieces.between) + 8 * underflow_error) + 8 * unit_roundoff * max_abs(pieces.between)) *
          (1 + 16 * unit_roundoff) +
      enlarged(error);
  return pieces;
}

double PiecePairs::placed_extent(std::size_t side, const Node& node, const Vector3& w) const {
  const PlacedFrame& frame = frames_.frame(side);
  const PieceRecord& record = SurfaceWorkspace::record(node);
  const Point3 origin = frame.apply(node.boxes->origin());
  // w . (scale R x) = scale (R' w) . x
  const double own = frame.scale * record.extent(transposed_times(frame.rows, w));
  const double placed = dot(w, origin - Point3{});
  const double error = enlarged(frame.growth() * record.error()) +
                       4 * frame.apply_error(node.boxes->origin()) +
                       40 * unit_roundoff * (std::fabs(own) + max_abs(origin - Point3{})) +
                       8 * underflow_error;
  return placed + own + error;
}

double PiecePairs::gap_along(const std::array<Node, 2>& nodes, const Vector3& direction) const {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return 0;
  const double gap = -placed_extent(1, nodes[1], -w) - placed_extent(0, nodes[0], w);
  return std::max(0.0, gap * (1 - 16 * unit_roundoff));
}

Witness PiecePairs::witness(const PiecePair& pieces) {
  ++stats_.evaluations;
  Witness found;
  const std::array<Barycentric, 2> at{pieces.near.on_a, pieces.near.on_b};
  for (std::size_t s = 0; s < 2; ++s) {
    const Patch& patch = frames_.workspace(s).patch(pieces.nodes[s]);
    found.nodes[s] = pieces.nodes[s];
    found.at[s] = clamped(at[s]);
    const BoundedPoint point = frames_.frame(s).apply(limit_point(patch, found.at[s]).from(patch.origin));
    found.points[s] = point.position;
    found.error = std::max(found.error, point.error);
  }
  const Vector3 between = found.points[1] - found.points[0];
  // Not enlarged(): of surfaces far apart that would be more than all else.
  found.distance = (std::sqrt(length_sq(between) + 8 * underflow_error) + 2 * spatial_error(found.error) +
                    8 * unit_roundoff * max_abs(between)) *
                   (1 + 16 * unit_roundoff);
  return found;
}

WitnessPlaces PiecePairs::places(const Witness& witness) const {
  WitnessPlaces places;
  for (std::size_t s = 0; s < 2; ++s) {
    SurfaceWorkspace& workspace = frames_.workspace(s);
    const Patch& patch = workspace.patch(witness.nodes[s]);
    places[s] = place_of(workspace.model().surface(), workspace.root_of(witness.nodes[s]),
                         to_face(patch.path, witness.at[s]));
  }
  return places;
}

}  // namespace snug
