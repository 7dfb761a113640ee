#include <snug/search/piece_leaf.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <snug/bounds/piece_fit.h>
#include <snug/bounds/table_triangle.h>
#include <snug/geometry/rounding.h>
#include <snug/geometry/triangle_distance.h>
#include <snug/patch/evaluate.h>

namespace snug {

PieceBounds::PieceBounds(const OffsetTriangle& offset, const QuadraticTriangle& quadratic,
                         const Point3& origin) {
  const auto single = [](const Vector3& v) {
    return Single3{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  };
  double largest = 0, moved = 0, base_moved = 0;
  bool finite = true;  // maxima pass over what is not a number
  for (std::size_t k = 0; k < 6; ++k) {
    const Vector3 exact = (k < 3 ? quadratic.corners[k] : quadratic.middles[k - 3]) - origin;
    net_[k] = single(exact);
    finite = finite && is_finite(exact);
    largest = std::max(largest, max_abs(exact));
    moved = std::max(moved, max_abs(wide(net_[k]) - exact));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 exact = offset.base[k] - origin;
    base_[k] = single(exact);
    finite = finite && is_finite(exact);
    largest = std::max(largest, max_abs(exact));
    base_moved = std::max(base_moved, max_abs(wide(base_[k]) - exact));
  }
  // Differences to the origin, evaluations of a sum of six products, and directions that were turned.
  const double rounding = 128 * unit_roundoff * largest + 8 * underflow_error;
  // base() rounds a sum.
  base_moved += 2 * unit_roundoff * (max_abs(origin - Point3{}) + largest);
  // Between parameters of a quarter of the edges, second differences are a sixteenth; a parabola is off its chords' triangle by two
  // thirds of them at most.
  double bend = 0, spread = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 a = wide(net_[k]), b = wide(net_[(k + 1) % 3]), m = wide(net_[3 + k]);
    bend = std::max(bend, length((m - a) + (m - b)));
  }
  for (std::size_t k = 1; k < 6; ++k) {
    const Vector3 v = wide(net_[k]) - wide(net_[0]);
    spread = std::max(spread, std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z));
  }
  flattening_ = float_up(enlarged(bend / 48));
  spread_ = float_up(enlarged(2 * spread));
  radius_ = float_up(enlarged(offset.radius + spatial_error(base_moved + rounding)));
  const double net_moved = spatial_error(moved + rounding);
  error_ = float_up(enlarged(quadratic.error + net_moved));
  keep_normal(quadratic, net_moved);
  // Not a number is not less.
  if (finite && radius_ < INFINITY && error_ < INFINITY) return;
  *this = {};
  radius_ = error_ = INFINITY;
}

// Of a normal that is turned by rounding a difference d has a part larger by at most as much of |d|.
void PieceBounds::keep_normal(const QuadraticTriangle& quadratic, double net_moved) {
  if (!(quadratic.normal_error < quadratic.error)) return;
  for (std::size_t k = 0; k < 3; ++k) {
    normal_[k] = static_cast<std::int8_t>(std::lround(127 * std::clamp(quadratic.normal[k], -1.0, 1.0)));
  }
  const double turned = length(normal() - quadratic.normal) * quadratic.error;
  const double along = enlarged(quadratic.normal_error + turned + 1.02 * net_moved);
  const double share = std::ceil(255 * (1 + 0x1p-40) * along / error());
  if (share <= 255) {
    normal_share_ = static_cast<std::uint8_t>(share);
  } else {
    normal_ = {};
  }
}

Triangle PieceBounds::base(const Point3& origin) const {
  return {origin + wide(base_[0]), origin + wide(base_[1]), origin + wide(base_[2])};
}

Vector3 PieceBounds::at(TriangleParameter at) const {
  const double r = 1 - at.u - at.v, u = at.u, v = at.v;
  return (r * r) * wide(net_[0]) + (u * u) * wide(net_[1]) + (v * v) * wide(net_[2]) +
         (2 * r * u) * wide(net_[3]) + (2 * u * v) * wide(net_[4]) + (2 * r * v) * wide(net_[5]);
}

std::array<Vector3, 2> PieceBounds::derivatives(TriangleParameter at) const {
  const double u = at.u, v = at.v, r = 1 - u - v;
  std::array<Vector3, 6> net;
  for (std::size_t k = 0; k < 6; ++k) net[k] = wide(net_[k]);
  return {2 * (r * (net[3] - net[0]) + u * (net[1] - net[3]) + v * (net[4] - net[5])),
          2 * (r * (net[5] - net[0]) + u * (net[4] - net[3]) + v * (net[2] - net[5]))};
}

PieceBounds::QuadraticDistance PieceBounds::distance(const Vector3& point) const {
  const float seen[3] = {static_cast<float>(point.x), static_cast<float>(point.y),
                         static_cast<float>(point.z)};
  const auto [low, far, at] = flattened_distance(net_[0].data(), seen);
  const double lower = static_cast<double>(low), upper = static_cast<double>(far);
  const double sizes = std::fabs(point.x) + std::fabs(point.y) + std::fabs(point.z) + 2 * upper +
                       8 * static_cast<double>(spread_);
  // 64 roundings to single precision, and what underflows.
  const double rounding = enlarged(0x1p-18 * sizes) + 0x1p-55,
               doubt = enlarged(static_cast<double>(flattening_) + rounding);
  return {lower - doubt, upper + doubt, clamped({at.u, at.v}), rounding};
}

// Over the Bezier points of the four parts after a split, those that are no means of others.
double PieceBounds::extent(const Vector3& w) const {
  std::array<double, 6> f;
  for (std::size_t k = 0; k < 6; ++k) f[k] = dot(w, wide(net_[k]));
  double most = std::max({f[0], f[1], f[2]});
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const double corner = f[k] + f[3 + k] + f[3 + last] + f[3 + next];
    most = std::max({most, (std::max(f[k], f[next]) + f[3 + k]) / 2, corner / 4});
  }
  return most;
}

FittedSet fitted_set(const PieceBuild& piece) {
  const auto& [c, m, error, normal, normal_error] = piece.quadratic;
  return {piece.box, {c[0], c[1], c[2], m[0], m[1], m[2]}, error, normal, normal_error};
}

namespace {

PieceBuild built(const PieceFit& fit, const Patch& patch) {
  std::array<Extent, 3> extents;
  for (std::size_t k = 0; k < 3; ++k) extents[k] = {fit.lower[k], fit.upper[k]};
  return {box_of(fit.axes, extents), fit.offset, fit.quadratic, can_split(patch, fit.offset)};
}

// Of a kind that fit_pieces() does not fit, and what it has no answer for.
PieceBuild build_alone(BoundsCache& library, const Patch& patch, BoundMethod method) {
  thread_local BoundingPoints points;
  PieceBuild result;
  if (method == BoundMethod::table) {
    result.quadratic = quadratic_triangle(library, patch);
    result.offset = offset_triangle(table_triangle(library.table(*patch.kind), patch));
  } else {
    bounding_points(library, patch, points);
    result.quadratic = quadratic_triangle(library, patch, points);
    // Refines tips, which the box profits from.
    result.offset = offset_triangle(library, points, limit_corners(patch));
  }
  result.box = box_around(result.offset, points, method);
  result.can_split = can_split(patch, result.offset);
  return result;
}

void build_by(decltype(fit_pieces)& fit, BoundsCache& library, std::span<const Patch> patches,
              BoundMethod method, std::span<PieceBuild> out) {
  thread_local std::vector<PieceFit> fits;
  fits.resize(patches.size());
  if (method == BoundMethod::rows) fit(library, patches, fits);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const bool fitted = method == BoundMethod::rows && fits[i].offset.radius >= 0;
    out[i] = fitted ? built(fits[i], patches[i]) : build_alone(library, patches[i], method);
  }
}

}  // namespace

void build_pieces(BoundsCache& library, std::span<const Patch> patches, BoundMethod method,
                  std::span<PieceBuild> out) {
  build_by(fit_pieces, library, patches, method, out);
}

void build_sorted_pieces(BoundsCache& library, std::span<const Patch> patches, BoundMethod method,
                         std::span<PieceBuild> out) {
  build_by(fit_sorted_pieces, library, patches, method, out);
}

PieceBuild build_piece(BoundsCache& library, const Patch& patch, BoundMethod method) {
  PieceBuild result;
  build_pieces(library, {&patch, 1}, method, {&result, 1});
  return result;
}

template <std::size_t N>
PieceLeaf<N>::PieceLeaf(std::span<const PieceBuild> pieces) {
  std::array<Obb, N> boxes;
  std::array<std::uint32_t, N> can_split;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    boxes[i] = pieces[i].box;
    can_split[i] = pieces[i].can_split ? 1 : 0;
  }
  static_cast<WideNode&>(*this) =
      WideNode(std::span(boxes).first(pieces.size()), std::span(can_split).first(pieces.size()));
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    bounds[i] = PieceBounds(pieces[i].offset, pieces[i].quadratic, origin());
  }
}

template struct PieceLeaf<WideNode::width>;
template struct PieceLeaf<4>;

}  // namespace snug
