#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "snug/bounds/rows_kernel.cpp"
#include <snug/geometry/vector_code-inl.h>
// After it.
#include <snug/bounds/lanes-inl.h>
#include <snug/bounds/planar_triangle-inl.h>
#include <snug/bounds/table_boxes-inl.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include <snug/bounds/rows_kernel.h>
#include <snug/geometry/rounding.h>
#include <support/contract.h>

HWY_BEFORE_NAMESPACE();
namespace snug::kernels::HWY_NAMESPACE {
namespace {

// How much tips may add to the radius of the rest, and to its height.
constexpr double max_excess = 0.15;

// Boxes of a tip in the frame, [axis][corner of the table], with all errors.
template <class V>
struct TipBoxes {
  V middle[3][3], half[3][3];
};

// A control net among the points of a step.
struct NetLanes {
  Lanes points;
  std::span<const std::uint32_t> control;
  [[nodiscard]] const double* at(std::size_t i, std::size_t axis) const {
    return points.at(control[i], axis);
  }
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE TipBoxes<V> boxes_of(D d, const FlatTable& table, const NetLanes& net, V net_error) {
  const std::size_t count = net.control.size();
  LinearV<V> linear[3];
  begin_linear(d, table, net, linear);
  if (table.first == 0) add_to_linear(d, table, net, 0, count, linear);
  TipBoxes<V> boxes;
  V largest;
  begin_boxes(d, table, linear, boxes.middle, boxes.half, largest);
  add_to_boxes(d, table, net, 0, count, linear, boxes.middle, boxes.half, largest);
  const V error = hn::Add(hn::Add(hn::Mul(hn::Set(d, table.error_of_largest), largest),
                                  hn::Mul(hn::Set(d, table.gain), net_error)),
                          hn::Set(d, table.error_at_least));
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t k = 0; k < 3; ++k) {
      boxes.middle[a][k] = hn::Add(linear[a].origin, boxes.middle[a][k]);
      const V half = hn::Add(boxes.half[a][k], error);
      const V size = hn::Add(hn::Abs(boxes.middle[a][k]), half);
      boxes.half[a][k] = hn::Add(half, hn::Mul(hn::Set(d, 8 * unit_roundoff), size));
    }
  }
  return boxes;
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V farthest_of(D d, const PlanarTriangle<V>& t, const TipBoxes<V>& boxes, V middle) {
  V farthest = hn::Zero(d);
  for (std::size_t k = 0; k < 3; ++k) {
    const V height = hn::Add(hn::Abs(hn::Sub(boxes.middle[2][k], middle)), boxes.half[2][k]);
    for (const double side_x : {-1.0, 1.0}) {
      for (const double side_y : {-1.0, 1.0}) {
        const V x = hn::Add(boxes.middle[0][k], hn::Mul(hn::Set(d, side_x), boxes.half[0][k]));
        const V y = hn::Add(boxes.middle[1][k], hn::Mul(hn::Set(d, side_y), boxes.half[1][k]));
        farthest = hn::Max(farthest, distance_sq(d, t, foot_of(d, t, x, y, height)));
      }
    }
  }
  return farthest;
}

// Control points relative to the first, then in the frame. The largest |coordinate| relative to the first
// corner; not a number where a point is not finite.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V into_frame(D d, const PlanarTriangle<V>& t, const Lanes& control, std::size_t count) {
  V largest = hn::Zero(d), probe = hn::Zero(d);
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3<V> r = sub(load(d, control, k), t.a);
    largest = hn::Max(largest, max3(hn::Abs(r.x), hn::Abs(r.y), hn::Abs(r.z)));
    probe = hn::Add(probe, hn::Add(hn::Sub(r.x, r.x), hn::Add(hn::Sub(r.y, r.y), hn::Sub(r.z, r.z))));
    store(d, Vec3<V>{dot(t.t1, r), dot(t.t2, r), dot(t.n, r)}, control, k);
  }
  return hn::Add(largest, probe);
}

// Points of patches as they come to be, level by level.
struct Memory {
  Lanes control, patch, tip[2], middle, bezier;
  Memory(double* at, std::size_t lanes, const RowsWithTips& rows) {
    for (Lanes* const part : {&control, &patch, &tip[0], &tip[1], &middle, &bezier}) {
      *part = {at, lanes};
      at += 3 * lanes * (part == &control ? rows.kind().control_count() : rows.most_points());
    }
  }
  [[nodiscard]] static std::size_t size(const RowsWithTips& rows, unsigned levels) {
    return 3 * (rows.kind().control_count() + 4 * rows.most_points() + rows.bezier_count(levels));
  }
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE void fit_lanes(D d, const RowsWithTips& rows, unsigned levels, const Memory& memory,
                          std::span<OffsetTriangle> out) {
  const Lanes& control = memory.control;
  const std::size_t count = rows.kind().control_count();
  const V zero = hn::Zero(d), infinite = hn::Set(d, INFINITY);
  const Vec3<V> origin = load(d, control, 0);
  for (std::size_t k = 0; k < count; ++k) store(d, sub(load(d, control, k), origin), control, k);
  Vec3<V> corner[3];
  for (std::size_t k = 0; k < 3; ++k) corner[k] = product(d, rows.kind().corner_limits(), k, control);
  const PlanarTriangle<V> t = planar_triangle(d, corner[0], corner[1], corner[2]);
  const V largest = into_frame(d, t, control, count);
  const V point_error = hn::Mul(hn::Set(d, rows.error_of_largest()), largest);

  std::size_t bezier = 0;
  V lower = infinite, upper = hn::Sub(zero, infinite);
  const auto add_level = [&](const LevelStep& step, std::size_t bezier_rows, const Lanes& points) HWY_ATTR {
    for (std::size_t r = 0; r < bezier_rows; ++r, ++bezier) {
      const Vec3<V> p = product(d, step.bezier, r, points);
      store(d, p, memory.bezier, bezier);
      lower = hn::Min(lower, p.z);
      upper = hn::Max(upper, p.z);
    }
  };
  const auto add_middle = [&](const RowsWithTips::Level& level, const Lanes& points) HWY_ATTR {
    if (level.middle == nullptr) return;
    const auto name = [&](std::uint32_t source) { return level.middle_control[source]; };
    for (std::size_t r = 0; r < level.middle->points.row_count(); ++r) {
      store(d, product(d, level.middle->points, r, points, name), memory.middle, r);
    }
    add_level(*level.middle, level.middle->bezier.row_count(), memory.middle);
  };
  const LevelStep& first = *rows.first().step;
  for (std::size_t r = 0; r < first.points.row_count(); ++r) {
    store(d, product(d, first.points, r, control), memory.patch, r);
  }
  add_level(first, first.bezier.row_count(), memory.patch);
  add_middle(rows.first(), memory.patch);
  TipBoxes<V> boxes[RowsWithTips::most_tips];
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    const RowsWithTips::Tip& tip = rows.tips()[i];
    NetLanes net{memory.patch, tip.control};
    for (unsigned level = 1; level < levels; ++level) {
      const LevelStep& step = *tip.levels[level].step;
      const Lanes& next = memory.tip[level % 2];
      const auto name = [&](std::uint32_t source) { return net.control[source]; };
      for (std::size_t r = 0; r < step.points.row_count(); ++r) {
        store(d, product(d, step.points, r, net.points, name), next, r);
      }
      // The piece beyond is the middle one of the step before.
      add_level(step, step.inner, next);
      add_middle(tip.levels[level], next);
      net = {next, tip.levels[level].tip_control};
    }
    boxes[i] = boxes_of(d, tip.table, net, point_error);
  }
  const V low = lower, high = upper;
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      lower = hn::Min(lower, hn::Sub(boxes[i].middle[2][k], boxes[i].half[2][k]));
      upper = hn::Max(upper, hn::Add(boxes[i].middle[2][k], boxes[i].half[2][k]));
    }
  }
  // No -0: which of two zeros is the least depends on their order.
  const V middle = hn::Mul(hn::Set(d, 0.5), hn::Add(hn::Add(lower, upper), zero));

  V rest = zero, tips = zero;
  for (std::size_t r = 0; r < bezier; ++r) {
    const Vec3<V> p = load(d, memory.bezier, r);
    rest = hn::Max(rest, distance_sq(d, t, foot_of(d, t, p.x, p.y, hn::Sub(p.z, middle))));
  }
  for (std::size_t i = 0; i < rows.tips().size(); ++i) {
    tips = hn::Max(tips, farthest_of(d, t, boxes[i], middle));
  }
  auto good = hn::And(well_shaped(d, t), hn::Lt(largest, infinite));
  good = hn::And(good, hn::Le(tips, hn::Mul(hn::Set(d, (1 + max_excess) * (1 + max_excess)), rest)));
  const V sticks_out = hn::Max(hn::Sub(low, lower), hn::Sub(upper, high));
  good = hn::And(good, hn::Le(sticks_out, hn::Mul(hn::Set(d, max_excess), hn::Sub(high, low))));

  const ReachV<V> reach = reach_of(d, t, hn::Max(rest, tips), hn::Mul(t.stretch, hn::Abs(middle)));
  const Vec3<V> shift = scaled(middle, t.n);
  V placed = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = add(origin, add(corner[k], shift));
    placed = hn::Max(placed, max3(hn::Abs(corner[k].x), hn::Abs(corner[k].y), hn::Abs(corner[k].z)));
  }
  const V place_error =
      hn::Add(hn::Mul(hn::Set(d, unit_roundoff * (1 + 0x1p-42)), placed), hn::Set(d, 4096 * underflow_error));
  const V given = hn::Mul(hn::Set(d, spatial_error(1)), hn::Add(point_error, place_error));
  const V radius = hn::Add(reach.distance, given);
  const V widened = hn::Add(hn::Mul(radius, hn::Set(d, 1 + 0x1p-42)), hn::Set(d, underflow_error));
  good = hn::And(good, hn::Lt(widened, infinite));
  hand_out(d, corner, hn::IfThenElse(good, widened, hn::Set(d, -1.0)), hn::Add(reach.rounding, given), out);
}

void FitRows(const RowsWithTips& rows, unsigned levels, std::span<const Point3> points,
             const VertexId* control, std::span<OffsetTriangle> out) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d), count = rows.kind().control_count();
  const Memory memory(aligned_memory(lanes * Memory::size(rows, levels)), lanes, rows);
  for (std::size_t begin = 0; begin < out.size(); begin += lanes) {
    const std::size_t here = std::min(lanes, out.size() - begin);
    gather_lanes(points, control + count * begin, count, 0, count, here, lanes, memory.control.first);
    fit_lanes(d, rows, levels, memory, out.subspan(begin, here));
  }
}

}  // namespace
}  // namespace snug::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace snug::kernels {

HWY_EXPORT(FitRows);

namespace {

// The nets that a step leaves beside polynomials: at most one a corner, and a middle child that is made of polynomials after another.
struct Nets {
  std::vector<const LevelStep::Net*> tips;
  const LevelStep::Net* middle = nullptr;
};
std::optional<Nets> nets_of(BoundsCache& library, const std::vector<LevelStep::Net>& nets) {
  Nets result;
  for (const LevelStep::Net& net : nets) {
    if (net.corner < 3) {
      result.tips.push_back(&net);
    } else {
      if (!library.level_step(*net.kind).nets.empty()) return std::nullopt;
      result.middle = &net;
    }
  }
  return result;
}

// each(level, kind) from a net at a corner on, as long as the only tip is at that corner.
template <class Each>
bool follow(BoundsCache& library, const LevelStep::Net& net, const Each& each) {
  const Kind* kind = net.kind;
  std::size_t corner = net.own;
  for (unsigned level = 1; level < RowsWithTips::most_levels; ++level) {
    const std::vector<LevelStep::Net> own = library.level_step(*kind).nets;
    const std::optional<Nets> nets = nets_of(library, own);
    if (!nets || nets->tips.size() != 1 || nets->tips.front()->corner != corner) return false;
    each(level, *kind);
    kind = nets->tips.front()->kind;
    corner = nets->tips.front()->own;
  }
  return true;
}

}  // namespace

bool RowsWithTips::fit(BoundsCache& library, const Kind& kind) {
  if (!kind.cacheable() || kind.polynomial() || !has_self_similar_tips(kind)) return false;
  const std::vector<LevelStep::Net> own = library.level_step(kind).nets;
  const std::optional<Nets> nets = nets_of(library, own);
  return nets && std::all_of(nets->tips.begin(), nets->tips.end(), [&](const LevelStep::Net* net) {
           return follow(library, *net, [](unsigned, const Kind&) {});
         });
}

// Errors in units of the largest coordinate: derivations/rounding.md, "Batches".
RowsWithTips::RowsWithTips(BoundsCache& library, const Kind& kind) : kind_(&kind) {
  std::map<const Kind*, const LevelStep*> known;
  const auto keep = [&](const Kind& of) {
    const LevelStep*& own = known[&of];
    if (!own) own = steps_.emplace_back(std::make_unique<const LevelStep>(library.level_step(of))).get();
    most_points_ = std::max(most_points_, own->points.row_count());
    return own;
  };
  const auto pass_on = [&](const LevelStep& step, double& size, double& error) {
    error = step.points.result_error(size, error);
    size *= std::max(1.0, step.points.max_abs_sum());
    error_of_largest_ = std::max(error_of_largest_, step.bezier.result_error(size, error));
  };
  // A level of a kind, whose points are of this size and off by this error afterwards.
  const auto level_of = [&](const Kind& of, double& size, double& error) {
    Level level{keep(of), {}, nullptr, {}};
    pass_on(*level.step, size, error);
    for (const LevelStep::Net& net : level.step->nets) {
      if (net.corner < 3) {
        level.tip_control = net.control;
        continue;
      }
      level.middle = keep(*net.kind);
      level.middle_control = net.control;
      double size_there = size, error_there = error;
      pass_on(*level.middle, size_there, error_there);
    }
    return level;
  };
  double first_size = 2, first_error = enlarged(3 * gamma_bound(16));
  first_ = level_of(kind, first_size, first_error);
  for (const LevelStep::Net& net : first_.step->nets) {
    if (net.corner == 3) continue;
    Tip& tip = tips_.emplace_back(Tip{net.control, {first_}, {}, {}});
    const Kind* last = net.kind;
    double size = first_size, error = first_error;
    follow(library, net, [&](unsigned level, const Kind& of) {
      tip.levels[level] = level_of(of, size, error);
      last = &of;
    });
    tip.table = flatten(library.tip_table(*last), *last, tip.columns);
    error_of_largest_ = std::max(error_of_largest_, error);
  }
}

std::size_t RowsWithTips::bezier_count(unsigned levels) const {
  const auto count_of = [](const Level& level) {
    return level.step->bezier.row_count() + (level.middle != nullptr ? level.middle->bezier.row_count() : 0);
  };
  std::size_t count = count_of(first_);
  for (const Tip& tip : tips_) {
    for (unsigned level = 1; level < levels; ++level) count += count_of(tip.levels[level]);
  }
  return count;
}

void fit_rows(const RowsWithTips& rows, unsigned levels, std::span<const Point3> points,
              std::span<const VertexId> control, std::span<OffsetTriangle> out) {
  SNUG_EXPECT(levels >= RowsWithTips::least_levels && levels <= RowsWithTips::most_levels);
  HWY_DYNAMIC_DISPATCH(FitRows)(rows, levels, points, control.data(), out);
}

}  // namespace snug::kernels
#endif
