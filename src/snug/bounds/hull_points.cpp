#include <snug/bounds/hull_points.h>

#include <algorithm>
#include <cmath>

#include <snug/base/contract.h>
#include <snug/bounds/fit_kernels.h>
#include <snug/geometry/rounding.h>

namespace snug {
namespace {

// The points of rows times patch take the place of out's points from `begin` on.
void apply(const BoundRows& rows, const Patch& patch, std::size_t begin, HullPoints& out) {
  SNUG_EXPECT(rows.control_count() == patch.points.size());
  out.resize(begin + rows.count());
  out.multiply(rows, patch.points);
  out.error = std::max(out.error, rows.result_error(patch.largest, patch.error));
  out.largest = std::max(out.largest, enlarged((rows.abs_sum() + rows.entry_error()) * patch.largest));
}

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

void HullPoints::reserve(std::size_t count) {
  if (count <= x_.size()) return;
  x_.resize(count);
  y_.resize(count);
  z_.resize(count);
}

void HullPoints::assign(const HullPoints& other) {
  origin = other.origin;
  error = other.error;
  largest = other.largest;
  tips = other.tips;
  count_ = other.count_;
  const auto copy = [&](const std::vector<double>& from) {
    return std::vector<double>(from.begin(), from.begin() + static_cast<std::ptrdiff_t>(count_));
  };
  x_ = copy(other.x_);
  y_ = copy(other.y_);
  z_ = copy(other.z_);
}

void HullPoints::resize(std::size_t count) {
  reserve(count);
  count_ = count;
}

void HullPoints::multiply(const BoundRows& rows, std::span<const Vector3> points) {
  const std::size_t begin = count_ - rows.count();
  kernels::apply_rows(rows.column(0), rows.count(), points, x_.data() + begin, y_.data() + begin,
                      z_.data() + begin);
}

void hull_points(const BoundRows& rows, const Patch& patch, HullPoints& out) {
  out.origin = patch.origin;
  out.error = out.largest = 0;
  apply(rows, patch, 0, out);
  out.tips = rows.tips();
}

namespace {

// Levels that a patch is split, before the nets of its pieces do: one of a passing kind, and at a crowded corner.
constexpr unsigned passing_levels = 5, crowded_levels = 12;

unsigned levels_of(const Kind& kind) { return kind.passing() ? passing_levels : crowded_levels; }

// Adds points whose hull holds the patch, which `level` splits have made; `scratch` has a patch for each of the next ones.
void collect(BoundsCache& library, const Patch& patch, unsigned level, std::span<Patch> scratch,
             HullPoints& out) {
  const Kind& kind = *patch.kind;
  if (kind.polynomial()) {
    const Stencils& rows = kind.bezier();
    std::size_t at = out.size();
    out.resize(at + rows.row_count());
    for (std::size_t r = 0; r < rows.row_count(); ++r) out.set(at++, rows.apply<Vector3>(r, patch.points));
    out.error = std::max(out.error, rows.result_error(patch.largest, patch.error));
    out.largest = std::max(out.largest, enlarged(rows.max_abs_sum() * patch.largest));
  } else if (kind.shared()) {
    apply(library.rows(kind), patch, out.size(), out);
  } else if (level >= levels_of(kind)) {
    std::size_t at = out.size();
    out.resize(at + patch.points.size());
    for (const Vector3& p : patch.points) out.set(at++, p);
    out.error = std::max(out.error, patch.error);
    out.largest = std::max(out.largest, patch.largest);
  } else {
    for (unsigned child = 0; child < 4; ++child) {
      split(patch, child, scratch[0]);
      collect(library, scratch[0], level + 1, scratch.subspan(1), out);
    }
  }
}

void prepare(BoundsCache& library, const Kind& kind, unsigned level) {
  if (kind.polynomial()) return;
  if (kind.shared()) {
    static_cast<void>(library.rows(kind));
  } else if (level < levels_of(kind)) {
    for (const KindChild& child : kind.children()) {
      if (child.kind != &kind) prepare(library, *child.kind, level + 1);
    }
  }
}

}  // namespace

void hull_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->shared()) {
    thread_local std::array<Patch, crowded_levels> scratch;
    out.origin = patch.origin;
    out.error = out.largest = 0;
    out.tips = {};
    out.resize(0);
    collect(library, patch, 0, scratch, out);
    return;
  }
  hull_points(library.rows(*patch.kind), patch, out);
  std::size_t most = out.size();
  for (std::size_t i = 0; i < 3 && out.tips[i].kind; ++i) {
    most += (most_tip_refinements + 1) * library.rows(*out.tips[i].kind).count();
  }
  out.reserve(most);
  if (out.tips[1].kind) refine_tips(library, {true, true, true}, out);
}

void close_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->polynomial()) {
    hull_points(library, patch, out);
    return;
  }
  out.origin = patch.origin;
  out.error = out.largest = 0;
  out.tips = {};
  out.resize(0);
  collect(library, patch, 0, {}, out);
}

void prepare_hull_points(BoundsCache& library, const Kind& kind) {
  if (!kind.shared()) {
    prepare(library, kind, 0);
    return;
  }
  for (const BoundRows::Tip& tip : library.rows(kind).tips()) {
    if (!tip.kind) continue;
    for (const BoundRows::Tip& deeper : library.rows(*tip.kind).tips()) {
      if (deeper.kind) static_cast<void>(library.rows(*deeper.kind));
    }
  }
}

void refine_tips(BoundsCache& library, const std::array<bool, 3>& which, HullPoints& points) {
  thread_local std::array<Patch, 3> nets;
  std::size_t tips = 0;
  for (; tips < 3 && points.tips[tips].kind; ++tips) {
    take_net(points, *points.tips[tips].kind, points.tips[tips].begin, nets[tips]);
  }
  // What is no tip is written one after the other; the new net behind it is taken out before the next one comes.
  std::size_t count = points.tips_begin();
  for (std::size_t i = 0; i < tips; ++i) {
    if (!which[i]) continue;
    const BoundRows& rows = library.rows(*nets[i].kind);
    const Kind* const deeper = rows.tips()[0].kind;
    SNUG_EXPECT(deeper && !rows.tips()[1].kind);
    apply(rows, nets[i], count, points);
    count += rows.tips_begin();
    take_net(points, *deeper, count, nets[i]);
  }
  for (std::size_t i = 0; i < tips; ++i) {
    points.tips[i] = {nets[i].kind, count};
    points.resize(count + nets[i].points.size());
    for (const Vector3& p : nets[i].points) points.set(count++, p);
  }
}

void control_points(const Patch& patch, HullPoints& out) {
  out.origin = patch.origin;
  out.resize(patch.points.size());
  for (std::size_t i = 0; i < patch.points.size(); ++i) out.set(i, patch.points[i]);
  out.largest = patch.largest;
  out.error = patch.error;
  out.tips = {};
}

Box3 outer_box(const HullPoints& points) {
  Box3 box;
  const kernels::Coordinates all = points.coordinates();
  const std::array<const double*, 3> axes{all.x, all.y, all.z};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto [low, high] = std::minmax_element(axes[a], axes[a] + all.count);
    const double o = points.origin[a];
    box.lower[a] = rounded_down(o + rounded_down(*low - points.error));
    box.upper[a] = rounded_up(o + rounded_up(*high + points.error));
  }
  return box;
}

Slab outer_slab(const HullPoints& points, const Vector3& normal) {
  const kernels::Range range = kernels::heights(points.coordinates(), Vector3{}, normal);
  const double sum = std::fabs(normal.x) + std::fabs(normal.y) + std::fabs(normal.z);
  const double error = enlarged(sum * (points.error + gamma_bound(8) * points.largest)) + 8 * underflow_error;
  if (!std::isfinite(error)) return {normal, -INFINITY, INFINITY};
  return {normal, range.lower - error, range.upper + error};
}

}  // namespace snug
