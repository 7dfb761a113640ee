#include <snug/search/piece_pairs.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>

namespace snug {
namespace {

// The gap between a lower bound in B and an upper one in A; zero where there is none.
double gap_between(double upper_of_a, double lower_of_b) {
  return std::max(0.0, (lower_of_b - upper_of_a) * (1 - 16 * unit_roundoff));
}

}  // namespace

Vector3 PiecePair::direction() const {
  const auto at = [](const Triangle& t, Barycentric p) {
    return t[0] + (p.b * (t[1] - t[0]) + p.c * (t[2] - t[0]));
  };
  return at(base[1], near.on_b) - at(base[0], near.on_a);
}

double PiecePairs::radii(const NodePair& pair) const {
  double sum = 0;
  for (std::size_t s = 0; s < 2; ++s) {
    sum += frames_.frame(s).growth() * static_cast<double>(frames_.workspace(s).radius(pair.nodes[s]));
  }
  return sum;
}

PiecePair PiecePairs::nearest(const NodePair& pair) {
  ++stats_.triangle_tests;
  PiecePair pieces;
  for (std::size_t s = 0; s < 2; ++s) {
    pieces.ids[s] = piece(pair, s);
    const PlacedFrame& frame = frames_.frame(s);
    const OffsetTriangle& offset = frames_.workspace(s).pieces()[pieces.ids[s]].offset;
    double error = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      pieces.base[s][k] = frame.apply(offset.base[k]);
      error = std::max(error, frame.apply_error(offset.base[k]));
    }
    pieces.radii[s] = enlarged(offset.radius * frame.growth() + spatial_error(error));
  }
  pieces.near = snug::nearest(pieces.base[0], pieces.base[1]);
  const double gap = rounded_down(pieces.near.certain_distance - enlarged(pieces.radii[0] + pieces.radii[1]));
  pieces.gap = std::max({gap, static_cast<double>(pair.gap), 0.0});
  return pieces;
}

double PiecePairs::placed_extent(std::size_t side, PieceId piece, const Vector3& w) {
  const PlacedFrame& frame = frames_.frame(side);
  const HullPoints& hull = frames_.workspace(side).pieces().hull(piece);
  // w . (scale R x + t) = scale (R' w) . x + w . t
  const Extent own = extent_of(hull, transposed_times(frame.rows, w));
  const double moved = dot(w, frame.translation);
  const double reach =
      frame.scale * (max_abs(hull.origin - Point3{}) + hull.largest) + max_abs(frame.translation);
  // |w| <= 1 + 4 u; R' w is off by 4 roundings of its rows' sums, which multiply coordinates.
  const double error = 40 * unit_roundoff * reach + 8 * underflow_error;
  return side == 0 ? frame.scale * own.upper + moved + error : frame.scale * own.lower + moved - error;
}

double PiecePairs::hull_gap(const NodePair& pair, const Vector3& direction) {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return 0;
  return gap_between(placed_extent(0, piece(pair, 0), w), placed_extent(1, piece(pair, 1), w));
}

void PiecePairs::look_along(const Vector3& direction) {
  const Vector3 w = normalized(direction);
  if (w == Vector3{}) return;
  along_ = w;
  for (std::size_t s = 0; s < 2; ++s) frames_.workspace(s).forget_extents();
  frames_.look_along(w);
}

double PiecePairs::gap_along(const NodePair& pair) {
  if (along_ == Vector3{}) return 0;
  std::array<double, 2> extents;
  for (std::size_t s = 0; s < 2; ++s) {
    const PieceId id = piece(pair, s);
    double& known = frames_.workspace(s).extent(id);
    if (std::isnan(known)) known = placed_extent(s, id, along_);
    extents[s] = known;
  }
  return gap_between(extents[0], extents[1]);
}

Witness PiecePairs::witness(const PiecePair& pieces) {
  ++stats_.evaluations;
  Witness found;
  const std::array<Barycentric, 2> at{pieces.near.on_a, pieces.near.on_b};
  for (std::size_t s = 0; s < 2; ++s) {
    const Patch& patch = frames_.workspace(s).pieces()[pieces.ids[s]].patch;
    found.pieces[s] = pieces.ids[s];
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
    const Piece& piece = workspace.pieces()[witness.pieces[s]];
    places[s] = place_of(workspace.model().surface(), piece.root, to_face(piece.patch.path, witness.at[s]));
  }
  return places;
}

}  // namespace snug
