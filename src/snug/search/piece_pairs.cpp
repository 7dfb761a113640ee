#include <snug/search/piece_pairs.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/search/gap.h>
#include <support/direction.h>

namespace snug {

PiecePair PiecePairs::nearest(const NodePair& pair) {
  std::array<OffsetTriangle, 2> offsets;
  for (std::size_t s = 0; s < 2; ++s) {
    const PieceBounds& record = PieceCache::bounds_of(pair.nodes[s]);
    offsets[s] = {record.base(pair.nodes[s].boxes->origin()), record.radius()};
  }
  PiecePair pieces = nearest(pair, offsets);
  set_points(pieces);
  return pieces;
}

bool PiecePairs::at_single_precision(const NodePair& pair) {
  const auto& [a, b] = pair.nodes;
  const bool can_a = PieceCache::can_open(a), can_b = PieceCache::can_open(b);
  if (can_a == can_b) return !can_a;
  const double fixed = PieceCache::bounds_of(can_a ? b : a).radius(),
               other = PieceCache::bounds_of(can_a ? a : b).radius();
  return other <= fixed;
}

PiecePair PiecePairs::nearest_in_double(const NodePair& pair) {
  std::array<OffsetTriangle, 2> offsets;
  for (std::size_t s = 0; s < 2; ++s) {
    offsets[s] = frames_.cache(s).offset(pair.nodes[s]);
  }
  PiecePair pieces = nearest(pair, offsets);
  const Witness exact = witness(pieces);
  pieces.points = exact.points;
  pieces.between = exact.points[1] - exact.points[0];
  pieces.error = exact.error;
  pieces.near_distance = exact.distance;
  return pieces;
}

PiecePair PiecePairs::nearest(const NodePair& pair, const std::array<OffsetTriangle, 2>& offsets) {
  ++stats_.triangle_tests;
  PiecePair pieces;
  pieces.nodes = pair.nodes;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frames_.frame(s);
    for (std::size_t k = 0; k < 3; ++k) pieces.base[s][k] = frame.apply(offsets[s].base[k]);
    pieces.radii[s] = enlarged(offsets[s].radius * frame.growth() + spatial_error(placing_error_[s]));
  }
  pieces.near = snug::nearest(pieces.base[0], pieces.base[1]);
  const double gap = gap_of(pieces.near, pieces.radii[0], pieces.radii[1]);
  pieces.gap = std::max({gap, static_cast<double>(pair.gap), 0.0});

  pieces.at = {clamped(pieces.near.on_a), clamped(pieces.near.on_b)};
  return pieces;
}

Point3 PiecePairs::quadratic_point(const PiecePair& pieces, std::size_t side, TriangleParameter at) const {
  const Node& node = pieces.nodes[side];
  return frames_.frame(side).apply(node.boxes->origin() + PieceCache::bounds_of(node).at(at));
}

void PiecePairs::set_points(PiecePair& pieces) const {
  double errors = 0;
  pieces.error = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    const PlacedFrame& frame = frames_.frame(s);
    pieces.points[s] = quadratic_point(pieces, s, pieces.at[s]);
    // The sum with the origin is rounded once, too.
    const double error = enlarged(frame.growth() * PieceCache::bounds_of(pieces.nodes[s]).error() +
                                  2 * spatial_error(placing_error_[s]));
    pieces.error = std::max(pieces.error, error);
    errors += error;
  }
  pieces.between = pieces.points[1] - pieces.points[0];
  pieces.near_distance = distance_at_most(pieces.between, enlarged(errors));
}

void PiecePairs::approach(PiecePair& pieces) const {
  // Triangles between points of the quadratics, smaller each time, around what was nearest.
  for (const double part : {0.25, 0.0625}) {
    std::array<Triangle, 2> around;
    const auto inwards = [part](TriangleParameter middle, double u, double v) {
      return TriangleParameter{middle.u + part * (u - middle.u), middle.v + part * (v - middle.v)};
    };
    for (std::size_t s = 0; s < 2; ++s) {
      around[s] = {quadratic_point(pieces, s, inwards(pieces.at[s], 0, 0)),
                   quadratic_point(pieces, s, inwards(pieces.at[s], 1, 0)),
                   quadratic_point(pieces, s, inwards(pieces.at[s], 0, 1))};
    }
    const NearestTriangles near = snug::nearest(around[0], around[1]);
    const std::array<Barycentric, 2> found{near.on_a, near.on_b};
    for (std::size_t s = 0; s < 2; ++s) {
      const TriangleParameter at = inwards(pieces.at[s], found[s].b, found[s].c);
      pieces.at[s] = clamped({at.u, at.v});
    }
  }
  set_points(pieces);
}

// The derivatives of both quadratics by their parameters, A's negated: three equations for four unknowns, whose shortest
// solution is J' (J J')^-1 (-between).
void PiecePairs::step_together(PiecePair& pieces, const Vector3& between) const {
  std::array<Vector3, 4> by;
  for (std::size_t s = 0; s < 2; ++s) {
    const PieceBounds& record = PieceCache::bounds_of(pieces.nodes[s]);
    const PlacedFrame& frame = frames_.frame(s);
    const double factor = (s == 0 ? -1 : 1) * frame.scale;
    const std::array<Vector3, 2> own = record.derivatives(pieces.at[s]);
    for (std::size_t k = 0; k < 2; ++k) by[2 * s + k] = factor * times(frame.rows, own[k]);
  }
  std::array<Vector3, 3> square;
  for (const Vector3& column : by) {
    for (std::size_t k = 0; k < 3; ++k) square[k] = square[k] + column[k] * column;
  }
  const std::array<Vector3, 3> adjugate{cross(square[1], square[2]), cross(square[2], square[0]),
                                        cross(square[0], square[1])};
  const double determinant = dot(square[0], adjugate[0]);
  if (!(determinant > 0)) return;
  const Vector3 solution = (-1 / determinant) * times(adjugate, between);
  if (!is_finite(solution)) return;
  for (std::size_t s = 0; s < 2; ++s) {
    TriangleParameter& at = pieces.at[s];
    at = clamped({at.u + dot(by[2 * s], solution), at.v + dot(by[2 * s + 1], solution)});
  }
  set_points(pieces);
}

double PiecePairs::placed_extent(std::size_t side, const Node& node, const Vector3& w) const {
  const PlacedFrame& frame = frames_.frame(side);
  const PieceBounds& record = PieceCache::bounds_of(node);
  const Point3 origin = frame.apply(node.boxes->origin());
  // w . (scale R x) = scale (R' w) . x
  const Vector3 there = transposed_times(frame.rows, w);
  const double own = frame.scale * record.extent(there);
  const double placed = dot(w, origin - Point3{});
  // `there` is R' w itself, so what the rows lack of rigidity is in its length; its roundings are the second term.
  const double error = enlarged(frame.scale * (record.error_along(there) + 0x1p-47 * record.error())) +
                       4 * placing_error_[side] +
                       40 * unit_roundoff * (std::fabs(own) + max_abs(origin - Point3{})) +
                       8 * underflow_error;
  return placed + own + error;
}

double PiecePairs::gap_along(const std::array<Node, 2>& nodes, const Vector3& direction) const {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return 0;
  const double taken = placed_extent(0, nodes[0], w) + placed_extent(1, nodes[1], -w);
  return std::max(0.0, gap_of_planes(taken));
}

void PiecePairs::look_along(const Vector3& direction) {
  along_ = normalized(direction);
  for (std::size_t s = 0; s < 2; ++s) directions_[s] = frames_.cache(s).extents().next_direction();
  frames_.look_along(along_);
}

double PiecePairs::gap_along(const std::array<Node, 2>& nodes) {
  if (along_ == Vector3{}) return 0;
  double taken = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    taken += frames_.cache(s).extents().of(
        nodes[s], directions_[s], [&] { return placed_extent(s, nodes[s], s == 0 ? along_ : -along_); });
  }
  return std::max(0.0, gap_of_planes(taken));
}

Witness PiecePairs::witness(const PiecePair& pieces) {
  ++stats_.evaluations;
  Witness found;
  found.at = pieces.at;
  for (std::size_t s = 0; s < 2; ++s) {
    const Patch& patch = frames_.cache(s).patch(pieces.nodes[s]);
    found.nodes[s] = pieces.nodes[s];
    const BoundedPoint point = frames_.frame(s).apply(limit_point(patch, found.at[s]).from(patch.origin));
    found.points[s] = point.position;
    found.error = std::max(found.error, point.error);
  }
  found.distance = distance_at_most(found.points[1] - found.points[0], 2 * spatial_error(found.error));
  return found;
}

Witness PiecePairs::approximate_witness(const PiecePair& pieces) {
  return {.points = pieces.points,
          .error = pieces.error,
          .distance = pieces.near_distance,
          .nodes = pieces.nodes,
          .at = pieces.at};
}

WitnessPoints PiecePairs::limit_points(const Witness& witness) const {
  const PowerOfTwo back = frames_.to_mesh_units();
  WitnessPoints points;
  for (std::size_t s = 0; s < 2; ++s) {
    PieceCache& cache = frames_.cache(s);
    points[s] = {require_representable(back.apply(witness.points[s])),
                 unscaled_up(witness.error, back) + underflow_error,
                 place_of(cache.model().surface(), cache.name(witness.nodes[s]), witness.at[s])};
  }
  return points;
}

}  // namespace snug
