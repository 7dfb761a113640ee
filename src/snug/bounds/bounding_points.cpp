#include <snug/bounds/bounding_points.h>

#include <algorithm>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <support/contract.h>

namespace snug {
void BoundingPoints::restart(const Point3& new_origin) {
  origin = new_origin;
  error = largest = 0;
  count_ = tip_count_ = 0;
}

void BoundingPoints::reserve(std::size_t count) {
  if (count <= x_.size()) return;
  for (std::vector<double>* axis : {&x_, &y_, &z_}) axis->resize(count);
}

void BoundingPoints::assign(const BoundingPoints& other) {
  origin = other.origin;
  error = other.error;
  largest = other.largest;
  count_ = other.count_;
  tip_count_ = 0;
  for (const auto axis : {&BoundingPoints::x_, &BoundingPoints::y_, &BoundingPoints::z_}) {
    const double* const from = (other.*axis).data();
    (this->*axis).assign(from, from + count_);
  }
}

std::size_t BoundingPoints::extend(std::size_t by) {
  const std::size_t begin = count_;
  count_ += by;
  reserve(count_);
  return begin;
}

inline void BoundingPoints::set(std::size_t i, const Vector3& p) {
  x_[i] = p.x;
  y_[i] = p.y;
  z_[i] = p.z;
}

void BoundingPoints::widen(double of_error, double of_largest) {
  error = std::max(error, of_error);
  largest = std::max(largest, of_largest);
}

void BoundingPoints::add(std::span<const Vector3> points, double of_error, double of_largest) {
  std::size_t at = extend(points.size());
  for (const Vector3& p : points) set(at++, p);
  widen(of_error, of_largest);
}

void BoundingPoints::add(const BoundingRows& rows, const Patch& patch) {
  SNUG_EXPECT(rows.control_count() == patch.points.size());
  const std::size_t at = extend(rows.count());
  kernels::apply_rows(rows.column(0), rows.count(), patch.points, x_.data() + at, y_.data() + at,
                      z_.data() + at);
  widen(rows.result_error(patch.largest, patch.error),
        enlarged((rows.abs_sum() + rows.entry_error()) * patch.largest));
}

void BoundingPoints::add(const BoundingPoints& others) {
  const std::size_t at = extend(others.count_);
  for (const auto axis : {&BoundingPoints::x_, &BoundingPoints::y_, &BoundingPoints::z_}) {
    std::copy_n((others.*axis).begin(), others.count_, (this->*axis).begin() + at);
  }
  widen(others.error, others.largest);
}

void BoundingPoints::add(const Stencils& rows, const Patch& patch) {
  std::size_t at = extend(rows.row_count());
  for (std::size_t r = 0; r < rows.row_count(); ++r) set(at++, rows.apply<Vector3>(r, patch.points));
  widen(rows.result_error(patch.largest, patch.error), enlarged(rows.max_abs_sum() * patch.largest));
}

void BoundingPoints::take_net(const BoundingRows::Net& net, std::size_t begin, Patch& out) const {
  out.kind = net.kind;
  out.first = 0;
  out.origin = origin;
  out.points.resize(net.kind->control_count());
  double x = 0, y = 0, z = 0;  // three chains of maxima, not one
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    const Vector3 p = out.points[i] = at(begin + i);
    x = std::max(x, std::fabs(p.x));
    y = std::max(y, std::fabs(p.y));
    z = std::max(z, std::fabs(p.z));
  }
  out.largest = std::max({x, y, z});
  out.error = error;
}

void BoundingPoints::set_boxes(BoundsCache& library, std::size_t tip) {
  const TipBoxes boxes = library.tip_table(*tips_[tip].kind).boxes(tips_[tip]);
  std::size_t i = tip_size * tip;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector3 &low = boxes.lower[k], &high = boxes.upper[k];
    for (unsigned corner = 0; corner < 8; ++corner) {
      set(i++, {corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y, corner & 4 ? high.z : low.z});
    }
    widen(0, std::max(max_abs(low), max_abs(high)));
  }
}

void BoundingPoints::add_with_tips(BoundsCache& library, const Patch& patch) {
  SNUG_EXPECT(count_ == 0);
  const BoundingRows& rows = library.rows(*patch.kind);
  if (!rows.self_similar()) return add(rows, patch);
  tip_count_ = rows.nets().size();
  SNUG_EXPECT(tip_count_ <= tips_.size());
  const std::size_t begin = tips_end();
  extend(begin);
  add(rows, patch);
  for (std::size_t i = 0; i < tip_count_; ++i) {
    take_net(rows.nets()[i], begin + rows.nets()[i].begin, tips_[i]);
    set_boxes(library, i);
  }
  cut(begin + rows.bezier_count());
}

void BoundingPoints::refine_tip(BoundsCache& library, std::size_t tip) {
  Patch& net = tips_[tip];
  const BoundingRows& rows = library.level_rows(*net.kind);
  SNUG_EXPECT(rows.self_similar() && rows.nets().size() == 1);
  const std::size_t begin = count_;
  add(rows, net);
  take_net(rows.nets()[0], begin + rows.bezier_count(), net);
  set_boxes(library, tip);
  cut(begin + rows.bezier_count());
}

void bounding_points(const BoundingRows& rows, const Patch& patch, BoundingPoints& out) {
  out.restart(patch.origin);
  out.add(rows, patch);
}

namespace {

// The points of the parts of a patch of a kind that few share; `scratch` has four patches a level below.
void add_parts(BoundsCache& library, const Patch& patch, unsigned level, std::span<Patch> scratch,
               BoundingPoints& out) {
  const Kind& kind = *patch.kind;
  if (kind.polynomial()) return out.add(kind.bezier(), patch);
  if (kind.cacheable()) {
    thread_local BoundingPoints part;
    part.restart(patch.origin);
    part.add_with_tips(library, patch);
    return out.add(part);
  }
  // A split brings Bezier points nearer.
  const BoundingRows* const creased = level > 0 ? library.direct_rows(kind) : nullptr;
  if (creased) return out.add(*creased, patch);
  if (level >= (kind.transient() ? transient_split_levels : high_valence_split_levels)) {
    return out.add(patch.points, patch.error, patch.largest);
  }
  const std::span<Patch, 4> parts = scratch.first<4>();
  split_into_four(patch, parts);
  for (const Patch& part : parts) add_parts(library, part, level + 1, scratch.subspan(4), out);
}

}  // namespace

void bounding_points(BoundsCache& library, const Patch& patch, BoundingPoints& out) {
  if (!patch.kind->cacheable()) {
    thread_local std::array<Patch, 4 * high_valence_split_levels> scratch;
    thread_local Patch whole;
    whole = patch;
    whole.path = {};  // a path may have no room for so many more digits
    out.restart(patch.origin);
    return add_parts(library, whole, 0, scratch, out);
  }
  out.restart(patch.origin);
  out.add_with_tips(library, patch);
  std::size_t count = out.size();
  for (const Patch& tip : out.tips()) {
    count += max_tip_refinements * library.level_rows(*tip.kind).count();
  }
  out.reserve(count);
}

void bounding_points(const CurvePiece& piece, BoundingPoints& out) {
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

namespace {

// All that add_with_tips() and refine_tip() will ask for: a tip's kind stays from level to level.
void prepare_tips(BoundsCache& library, const Kind& kind) {
  for (const BoundingRows::Net& net : library.rows(kind).nets()) {
    static_cast<void>(library.tip_table(*net.kind));
    static_cast<void>(library.level_rows(*net.kind));
  }
}

// All that add_parts() will ask for.
void prepare_parts(BoundsCache& library, const Kind& kind, unsigned level) {
  if (kind.polynomial()) return;
  if (kind.cacheable()) {
    if (library.rows(kind).self_similar()) prepare_tips(library, kind);
    return;
  }
  if (level > 0 && library.direct_rows(kind)) return;
  if (level >= (kind.transient() ? transient_split_levels : high_valence_split_levels)) return;
  for (const KindChild& child : kind.children()) prepare_parts(library, *child.kind, level + 1);
}

}  // namespace

void prepare_bounding_points(BoundsCache& library, const Kind& kind) {
  prepare_parts(library, kind, 0);
  if (kind.polynomial()) static_cast<void>(library.rows(kind));
}

Slab outer_slab(const BoundingPoints& points, const Vector3& normal) {
  const kernels::Range range = kernels::heights(points.coordinates(), Vector3{}, normal);
  const double sum = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  const double error = enlarged(sum * (points.error + gamma_bound(8) * points.largest)) + 8 * underflow_error;
  if (!std::isfinite(error)) return {normal, -INFINITY, INFINITY};
  return {normal, range.lower - error, range.upper + error};
}

}  // namespace snug
