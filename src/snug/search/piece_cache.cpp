#include <snug/search/piece_cache.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <snug/base/contract.h>
#include <snug/bounds/table_triangle.h>
#include <snug/geometry/direction.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>

namespace snug {

Piece make_piece(BoundsCache& library, PatchId root, Patch patch, HullPoints& scratch, BoundMethod method) {
  Piece piece;
  piece.root = root;
  if (method == BoundMethod::table) {
    piece.offset = offset_triangle(table_triangle(library.table(*patch.kind), patch));
  } else {
    hull_points(library, patch, scratch);
    piece.offset = offset_triangle(library, scratch, limit_corners(patch));
  }
  piece.patch = std::move(patch);
  return piece;
}

LimitTriangle limit_triangle(const Patch& patch) {
  LimitTriangle result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const BoundedPoint corner = corner_point(patch, k).from(patch.origin);
    result.corners[k] = corner.position;
    result.error = std::max(result.error, spatial_error(corner.error));
  }
  return result;
}

Vector3 unit_normal(const Triangle& triangle) {
  const Vector3 a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  // Sides of about 1, so that the product neither underflows nor overflows.
  const double size = std::max(max_abs(a), max_abs(b));
  if (!(size > 0) || !std::isfinite(1 / size)) return {};
  const Vector3 normal = cross((1 / size) * a, (1 / size) * b);
  const double area = length(normal);
  if (!(area > 1e-12)) return {};
  return (1 / area) * normal;
}

Extent extent_of(const HullPoints& hull, const Vector3& direction, const Point3& from) {
  const Slab slab = outer_slab(hull, direction);
  if (std::isnan(slab.lower) || std::isnan(slab.upper)) return unbounded;
  const double sum = std::fabs(direction.x) + std::fabs(direction.y) + std::fabs(direction.z);
  const Vector3 between = hull.origin - from;
  const double height = dot(direction, between);
  const double error =
      enlarged(8 * unit_roundoff * sum * (max_abs(between) + hull.largest)) + 8 * underflow_error;
  return {height + slab.lower - error, height + slab.upper + error};
}

Extent extent_of(const OffsetTriangle& triangle, const Vector3& direction) {
  Extent extent;
  double largest = 0;
  for (const Point3& p : triangle.base) {
    extent.add(dot(direction, p - Point3{}));
    largest = std::max(largest, max_abs(p - Point3{}));
  }
  const double reach =
      enlarged(triangle.radius * length(direction) + 16 * unit_roundoff * largest) + 8 * underflow_error;
  if (!std::isfinite(reach)) return unbounded;
  return {extent.lower - reach, extent.upper + reach};
}

namespace {

// Of the points that the piece was fitted to.
Heights heights_of(const Piece& piece, const HullPoints& points) {
  const Vector3 normal = unit_normal(piece.offset.base);
  const Vector3 from = piece.offset.base[0] - points.origin;
  const kernels::Range range = kernels::heights(points.coordinates(), from, normal);
  // Differences to `from`, which is rounded once, and a dot product of a vector of length 1.
  const double error =
      enlarged(2 * spatial_error(points.error) + gamma_bound(8) * 2 * (points.largest + max_abs(from))) +
      8 * underflow_error;
  return {rounded_down(range.lower - error), rounded_up(range.upper + error)};
}

// Of all that the offset triangle holds. On needles the computed normal is off by far more than a rounding,
// so that the corners have heights, too.
Heights heights_of(const OffsetTriangle& offset) {
  const Vector3 normal = unit_normal(offset.base);
  Heights heights{0, 0};
  double largest = 0;
  for (const Point3& corner : offset.base) {
    const Vector3 from = corner - offset.base[0];
    const double height = dot(normal, from);
    heights = {std::min(heights.lower, height), std::max(heights.upper, height)};
    largest = std::max(largest, max_abs(from));
  }
  // The normal's length is 1 up to 8 roundings; differences and products of the corners', gamma(8).
  const double reach =
      enlarged(offset.radius * (1 + 16 * unit_roundoff) + gamma_bound(8) * 2 * largest) + 8 * underflow_error;
  return {rounded_down(heights.lower - reach), rounded_up(heights.upper + reach)};
}

// Along the longest edge, across it in the triangle's plane, and along the normal.
std::array<Vector3, 3> box_axes(const Triangle& base) {
  const Vector3 normal = unit_normal(base);
  if (normal == Vector3{}) return Obb{}.axes;
  Vector3 along;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 edge = base[(k + 1) % 3] - base[k];
    if (max_abs(edge) > max_abs(along)) along = edge;
  }
  along = (1 / max_abs(along)) * along;
  along = normalized(along - dot(along, normal) * normal);
  return {along, cross(normal, along), normal};
}

}  // namespace

PieceCache::PieceCache(const LimitSurface& surface, BoundMethod method)
    : surface_(surface), method_(method), roots_(surface.patch_count()) {}

PieceId PieceCache::add(PatchId root, Patch patch) {
  Piece piece = make_piece(surface_.library(), root, std::move(patch), scratch_, method_);
  const bool by_table = method_ == BoundMethod::table;
  Heights heights = by_table ? heights_of(piece.offset) : heights_of(piece, scratch_);
  if (!std::isfinite(heights.lower) || !std::isfinite(heights.upper)) heights = {-INFINITY, INFINITY};
  const Obb box = fit_box(box_axes(piece.offset.base), [&](const Vector3& d) {
    return by_table ? extent_of(piece.offset, d) : extent_of(scratch_, d);
  });
  bytes_ += sizeof(Piece) + sizeof(Around) + piece.patch.points.capacity() * sizeof(Vector3);
  pieces_.push_back(std::move(piece));
  around_.push_back({heights, box});
  return PieceId(pieces_.size() - 1);
}

void PieceCache::clear() {
  std::fill(roots_.begin(), roots_.end(), PieceId());
  pieces_.clear();
  hulls_.clear();
  around_.clear();
  hull_places_.clear();
  bytes_ = 0;
}

const HullPoints& PieceCache::hull(PieceId id) {
  if (id.index() >= hull_places_.size()) hull_places_.resize(pieces_.size(), 0);
  std::uint32_t& place = hull_places_[id.index()];
  if (place == 0) {
    // Scratch memory is several times as large as what it is needed for.
    close_points(surface_.library(), pieces_[id.index()].patch, scratch_);
    HullPoints& points = hulls_.emplace_back();
    points.assign(scratch_);
    place = static_cast<std::uint32_t>(hulls_.size());
    bytes_ += sizeof(HullPoints) + 3 * points.size() * sizeof(double);
  }
  return hulls_[place - 1];
}

PieceId PieceCache::root(PatchId patch) {
  PieceId& id = roots_[patch.index()];
  if (!id.valid()) id = add(patch, surface_.patch(patch));
  return id;
}

Piece PieceCache::child_of(const Piece& piece, unsigned child) {
  return make_piece(surface_.library(), piece.root, snug::split(piece.patch, child), scratch_, method_);
}

bool PieceCache::can_split(PieceId id) const {
  const Piece& piece = (*this)[id];
  return piece.patch.path.level() < PiecePath::max_level && piece.offset.radius > 2 * piece.offset.rounding;
}

PieceId PieceCache::split(PieceId id) {
  Piece& parent = pieces_[id.index()];  // stays where it is while others are added
  if (parent.first_child.valid()) return parent.first_child;
  SNUG_EXPECT(parent.patch.path.level() < PiecePath::max_level);
  const PieceId first(pieces_.size());
  for (unsigned child = 0; child < 4; ++child) {
    static_cast<void>(add(parent.root, snug::split(parent.patch, child)));
  }
  parent.first_child = first;
  return first;
}

}  // namespace snug
