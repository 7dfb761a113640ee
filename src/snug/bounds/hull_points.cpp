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

// What a patch is bounded by as it is; nothing where it has to be split first.
enum class Source : std::uint8_t { bezier, rows, net, none };

// Levels that a patch is split, before the nets of its pieces do: one of a passing kind, and at a crowded corner.
constexpr unsigned passing_levels = 5, crowded_levels = 12;

Source source_of(const Kind& kind, unsigned level) {
  if (kind.polynomial()) return Source::bezier;
  if (kind.shared()) return Source::rows;
  return level >= (kind.passing() ? passing_levels : crowded_levels) ? Source::net : Source::none;
}

// Calls visit(part, source) for the parts of a patch that `level` splits have made; `scratch` has a patch for each of the
// next ones.
template <class Visit>
void for_each_part(const Patch& patch, unsigned level, std::span<Patch> scratch, const Visit& visit) {
  const Source source = source_of(*patch.kind, level);
  if (source != Source::none) return visit(patch, source);
  for (unsigned child = 0; child < 4; ++child) {
    split(patch, child, scratch[0]);
    for_each_part(scratch[0], level + 1, scratch.subspan(1), visit);
  }
}

void clear(const Patch& patch, HullPoints& out) {
  out.origin = patch.origin;
  out.error = out.largest = 0;
  out.tips = {};
  out.resize(0);
}

void add_bezier_points(const Patch& patch, HullPoints& out) {
  const Stencils& rows = patch.kind->bezier();
  std::size_t at = out.size();
  out.resize(at + rows.row_count());
  for (std::size_t r = 0; r < rows.row_count(); ++r) out.set(at++, rows.apply<Vector3>(r, patch.points));
  out.error = std::max(out.error, rows.result_error(patch.largest, patch.error));
  out.largest = std::max(out.largest, enlarged(rows.max_abs_sum() * patch.largest));
}

void add_net(const Patch& patch, HullPoints& out) {
  std::size_t at = out.size();
  out.resize(at + patch.points.size());
  for (const Vector3& p : patch.points) out.set(at++, p);
  out.error = std::max(out.error, patch.error);
  out.largest = std::max(out.largest, patch.largest);
}

// The points of a kind that few patches share: those of its parts.
void points_of_parts(BoundsCache& library, const Patch& patch, HullPoints& out) {
  thread_local std::array<Patch, crowded_levels> scratch;
  clear(patch, out);
  for_each_part(patch, 0, scratch, [&](const Patch& part, Source source) {
    if (source == Source::bezier) {
      add_bezier_points(part, out);
    } else if (source == Source::rows) {
      apply(library.rows(*part.kind), part, out.size(), out);
    } else {
      add_net(part, out);
    }
  });
}

}  // namespace

void hull_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->shared()) return points_of_parts(library, patch, out);
  hull_points(library.rows(*patch.kind), patch, out);
  std::size_t count = out.size();
  for (std::size_t i = 0; i < 3 && out.tips[i].kind; ++i) {
    count += (max_tip_refinements + 1) * library.rows(*out.tips[i].kind).count();
  }
  out.reserve(count);
  if (out.tips[1].kind) refine_tips(library, {true, true, true}, out);
}

void close_points(BoundsCache& library, const Patch& patch, HullPoints& out) {
  if (!patch.kind->polynomial()) return hull_points(library, patch, out);
  clear(patch, out);
  add_bezier_points(patch, out);
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
