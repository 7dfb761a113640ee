#include <snug/bounds/hull_points.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// The net of a tip that begins at point `begin`, as a patch.
void take_net(const HullPoints& points, const Kind& kind, std::size_t begin, Patch& net) {
  net.kind = &kind;
  net.origin = points.origin;
  net.points.resize(kind.control_count());
  double x = 0, y = 0, z = 0;  // three chains of maxima, not one
  for (std::size_t i = 0; i < net.points.size(); ++i) {
    const Vector3 p = net.points[i] = points.at(begin + i);
    x = std::max(x, std::fabs(p.x));
    y = std::max(y, std::fabs(p.y));
    z = std::max(z, std::fabs(p.z));
  }
  net.largest = std::max({x, y, z});
  net.error = points.error;
}

}  // namespace

void HullPoints::restart(const Point3& new_origin) {
  origin = new_origin;
  error = largest = 0;
  tips = {};
  count_ = 0;
}

void HullPoints::reserve(std::size_t count) {
  if (count <= x_.size()) return;
  for (std::vector<double>* axis : {&x_, &y_, &z_}) axis->resize(count);
}

void HullPoints::assign(const HullPoints& other) {
  origin = other.origin;
  error = other.error;
  largest = other.largest;
  tips = other.tips;
  count_ = other.count_;
  for (const auto axis : {&HullPoints::x_, &HullPoints::y_, &HullPoints::z_}) {
    const double* const from = (other.*axis).data();
    (this->*axis).assign(from, from + count_);
  }
}

std::size_t HullPoints::extend(std::size_t by) {
  const std::size_t begin = count_;
  count_ += by;
  reserve(count_);
  return begin;
}

inline void HullPoints::set(std::size_t i, const Vector3& p) {
  x_[i] = p.x;
  y_[i] = p.y;
  z_[i] = p.z;
}

void HullPoints::widen(double of_error, double of_largest) {
  error = std::max(error, of_error);
  largest = std::max(largest, of_largest);
}

void HullPoints::add(std::span<const Vector3> points, double of_error, double of_largest) {
  std::size_t at = extend(points.size());
  for (const Vector3& p : points) set(at++, p);
  widen(of_error, of_largest);
}

void HullPoints::add(const BoundRows& rows, const Patch& patch) {
  SNUG_EXPECT(rows.control_count() == patch.points.size());
  const std::size_t at = extend(rows.count());
  kernels::apply_rows(rows.column(0), rows.count(), patch.points, x_.data() + at, y_.data() + at,
                      z_.data() + at);
  widen(rows.result_error(patch.largest, patch.error),
        enlarged((rows.abs_sum() + rows.entry_error()) * patch.largest));
}

void HullPoints::add(const Stencils& rows, const Patch& patch) {
  std::size_t at = extend(rows.row_count());
  for (std::size_t r = 0; r < rows.row_count(); ++r) set(at++, rows.apply<Vector3>(r, patch.points));
  widen(rows.result_error(patch.largest, patch.error), enlarged(rows.max_abs_sum() * patch.largest));
}

void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out) {
  out.restart(patch.origin);
  out.add(rows, patch);
  out.tips = rows.tips();
}

namespace {

// Levels that a patch is split, before the nets of its pieces do: one of a passing kind, and at a crowded
// corner.
constexpr unsigned passing_levels = 5, crowded_levels = 12;

// The points of the parts of a patch of a kind that few share; `scratch` has a patch a level below.
void add_parts(BoundsCache& library, const Patch& patch, unsigned level, std::span<Patch> scratch,
               HullPoints& out) {
  const Kind& kind = *patch.kind;
  if (kind.polynomial()) return out.add(kind.bezier(), patch);
  if (kind.shared()) return out.add(library.rows(kind), patch);
  if (level >= (kind.passing() ? passing_levels : crowded_levels)) {
    return out.add(patch.points, patch.error, patch.largest);
  }
  for (unsigned child = 0; child < 4; ++child) {
    split(patch, child, scratch[0]);
    add_parts(library, scratch[0], level + 1, scratch.subspan(1), out);
  }
}

}  // namespace

void hull_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->shared()) {
    thread_local std::array<Patch, crowded_levels> scratch;
    out.restart(patch.origin);
    return add_parts(library, patch, 0, scratch, out);
  }
  hull_points(library.rows(*patch.kind), patch, out);
  std::size_t count = out.size();
  for (std::size_t i = 0; i < 3 && out.tips[i].kind; ++i) {
    count += (max_tip_refinements + 1) * library.rows(*out.tips[i].kind).count();
  }
  out.reserve(count);
  if (out.tips[1].kind) refine_tips(library, {true, true, true}, out);
}

void hull_points(const CurvePiece& piece, HullPoints& out) {
  out.restart(piece.origin);
  CurvePiece whole = piece;
  whole.path = {};  // a path may have no room for two more digits
  for (const unsigned half : {0u, 1u}) {
    const CurvePiece parent = split(whole, half);
    for (const unsigned child : {0u, 1u}) {
      const CurveBezier bezier = bezier_points(split(parent, child));
      out.add({bezier.points.data(), bezier.count}, bezier.error, bezier.largest);
    }
  }
}

void close_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->polynomial()) return hull_points(library, patch, out);
  out.restart(patch.origin);
  out.add(patch.kind->bezier(), patch);
}

// A patch of the kind asks for all that the others will.
void prepare_hull_points(BoundsCache& library, const Kind& kind) {
  Patch patch;
  patch.kind = &kind;
  patch.points.resize(kind.control_count());
  HullPoints points;
  hull_points(library, patch, points);
  for (std::size_t i = 0; i < max_tip_refinements && points.tips[0].kind; ++i) {
    refine_tips(library, {true, true, true}, points);
  }
}

void refine_tips(BoundsCache& library, const std::array<bool, 3>& which, HullPoints& points) {
  thread_local std::array<Patch, 3> nets;
  std::size_t tips = 0;
  for (; tips < 3 && points.tips[tips].kind; ++tips) {
    take_net(points, *points.tips[tips].kind, points.tips[tips].begin, nets[tips]);
  }
  // What is no tip is written one after the other; the new net behind it is taken out first.
  std::size_t count = points.tips_begin();
  for (std::size_t i = 0; i < tips; ++i) {
    if (!which[i]) continue;
    const BoundRows& rows = library.rows(*nets[i].kind);
    const Kind* const deeper = rows.tips()[0].kind;
    SNUG_EXPECT(deeper && !rows.tips()[1].kind);
    points.cut(count);
    points.add(rows, nets[i]);
    count += rows.tips_begin();
    take_net(points, *deeper, count, nets[i]);
  }
  points.cut(count);
  for (std::size_t i = 0; i < tips; ++i) {
    points.tips[i] = {nets[i].kind, points.size()};
    points.add(nets[i].points, nets[i].error, nets[i].largest);
  }
}

Slab outer_slab(const HullPoints& points, const Vector3& normal) {
  const kernels::Range range = kernels::heights(points.coordinates(), Vector3{}, normal);
  const double sum = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  const double error = enlarged(sum * (points.error + gamma_bound(8) * points.largest)) + 8 * underflow_error;
  if (!std::isfinite(error)) return {normal, -INFINITY, INFINITY};
  return {normal, range.lower - error, range.upper + error};
}

}  // namespace snug
