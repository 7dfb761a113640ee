#include <snug/surface/batch_bounds.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <snug/bounds/fit_kernels.h>
#include <snug/bounds/table_triangle.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/surface/unscale.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {
namespace {

constexpr std::size_t chunk_size = 256;

// Fits patches without an answer for this reason, a negative radius, once more: fit(control, answers).
template <class Fit>
void fit_rest(std::size_t controls, double reason, std::span<const VertexId> control,
              std::span<OffsetTriangle> answers, const Fit& fit) {
  thread_local std::vector<VertexId> rest;
  thread_local std::vector<OffsetTriangle> again;
  const auto is_rest = [reason](const OffsetTriangle& answer) { return answer.radius == reason; };
  rest.clear();
  rest.reserve(control.size());
  again.reserve(answers.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (!is_rest(answers[i])) continue;
    const auto own = control.subspan(i * controls, controls);
    rest.insert(rest.end(), own.begin(), own.end());
  }
  again.resize(rest.size() / controls);
  if (again.empty()) return;
  fit(std::span<const VertexId>(rest), std::span(again));
  auto next = again.begin();
  for (OffsetTriangle& answer : answers) {
    if (is_rest(answer)) answer = *next++;
  }
}

// One a thread; keeps its memory from call to call.
struct Scratch {
  Patch patch, polygon;
  BoundingPoints hull;
  std::array<OffsetTriangle, chunk_size> answers;
};

bool regular_inside(const Kind& kind) {
  const auto& corners = kind.key().corners;
  return kind.polynomial() &&
         std::all_of(corners.begin(), corners.end(), [](const CornerFan& fan) { return fan.closed; });
}

OffsetTriangle turned(const OffsetTriangle& fit, std::uint8_t first) {
  OffsetTriangle result;
  for (std::size_t k = 0; k < 3; ++k) result.base[k] = fit.base[(k + 3 - first) % 3];
  result.radius = fit.radius;
  result.rounding = fit.rounding;
  return result;
}

// unscaled(turned()) at a moderate power of two, straight to where it belongs: copies cost as much as fits.
void turn_and_scale(const OffsetTriangle& fit, std::uint8_t first, double factor, OffsetTriangle& out) {
  std::size_t from = (3 - first) % 3;
  for (Point3& corner : out.base) {
    const Point3& p = fit.base[from];
    corner.x = factor * p.x;
    corner.y = factor * p.y;
    corner.z = factor * p.z;
    from = from == 2 ? 0 : from + 1;
  }
  out.radius = enlarged(factor * fit.radius + 4 * underflow_error);
  out.rounding = enlarged(factor * fit.rounding + 4 * underflow_error);
}

std::vector<PatchId> all_patches(const LimitSurface& surface) {
  std::vector<PatchId> patches;
  for (std::size_t p = 0; p < surface.patch_count(); ++p) {
    if (surface.has_patch(PatchId(p))) patches.push_back(PatchId(p));
  }
  return patches;
}

// `unused`: vertices to pass over, in increasing order.
PowerOfTwo normalising(std::span<const Point3> points, std::span<const VertexId> unused) {
  double largest = 0, probe = 0;
  std::size_t begin = 0;
  const auto measure = [&](std::size_t end) {
    for (const Point3& p : points.subspan(begin, end - begin)) {
      largest = std::max(largest, max_abs(p - Point3{}));
      probe += (p.x - p.x) + (p.y - p.y) + (p.z - p.z);  // stays 0 unless one is not finite
    }
    begin = end + 1;
  };
  for (const VertexId v : unused) measure(v.index());
  measure(points.size());
  if (probe != 0) throw InputError(InputProblem::refused, "a control point is not finite");
  return PowerOfTwo::normalising(largest);
}

}  // namespace

std::size_t BatchBounds::control_count(const Group& group) {
  return (group.polygon ? group.polygon : group.kind)->control_count();
}

BatchBounds::BatchBounds(const LimitSurface& surface, BoundMethod method, int threads)
    : BatchBounds(surface, all_patches(surface), method, threads) {}

BatchBounds::BatchBounds(const LimitSurface& surface, std::vector<PatchId> patches, BoundMethod method,
                         int threads)
    : library_(&surface.library()), patches_(std::move(patches)) {
  for (const PatchId p : patches_) {
    require_value(p.index() < surface.patch_count() && surface.has_patch(p),
                  "patch bounds: there is no such patch; has_patch() tells which are there");
  }
  surface.find_kinds(threads);
  sort_by_kind(surface);
  collect_control(surface);
  parallel_for(groups_.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      Group& group = groups_[g];
      if (method == BoundMethod::table) {
        group.table = &library_->table(*group.kind);
      } else if (!group.polygon && kernels::has_rows_with_tips(*library_, *group.kind)) {
        group.rows.emplace(*library_, *group.kind, kernels::TipsBy::tables);
        group.exact_rows = std::make_unique<Lazy<kernels::RowsWithTips<double>>>();
      } else {
        prepare_bounding_points(*library_, *group.kind);
      }
      static_cast<void>(group.kind->corner_limits());
    }
  });
}

// Groups, chunks and places: a counting sort.
void BatchBounds::sort_by_kind(const LimitSurface& surface) {
  constexpr std::uint32_t none = UINT32_MAX;
  std::vector<std::uint32_t> group_of_kind(library_->kinds().size(), none), group_of(patches_.size()), sizes;
  std::map<std::pair<KindId, std::uint32_t>, std::uint32_t> group_of_part;
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    const Kind& kind = surface.kind(patches_[i]);
    const Kind* const polygon = surface.polygon_of(patches_[i]);
    const std::uint32_t part = polygon ? surface.place(patches_[i]).part : 0;
    std::uint32_t& group = polygon ? group_of_part.try_emplace({polygon->id(), part}, none).first->second
                                   : group_of_kind[kind.id().index()];
    if (group == none) {
      group = static_cast<std::uint32_t>(groups_.size());
      groups_.push_back({&kind, polygon, part, nullptr, 0, 0, std::nullopt, nullptr});
      sizes.push_back(0);
    }
    ++sizes[group];
    group_of[i] = group;
  }
  std::size_t place = 0, control = 0;
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    groups_[g].first_place = place;
    groups_[g].first_control = control;
    control += sizes[g] * control_count(groups_[g]);
    const std::size_t end = place + sizes[g];
    for (; place < end; place = std::min(end, place + chunk_size)) {
      chunks_.push_back({static_cast<std::uint32_t>(g), static_cast<std::uint32_t>(place),
                         static_cast<std::uint32_t>(std::min(end, place + chunk_size))});
    }
  }
  control_.resize(control);
  places_.resize(place);
  std::vector<std::size_t> next;
  for (const Group& group : groups_) next.push_back(group.first_place);
  for (std::size_t i = 0; i < patches_.size(); ++i) {
    places_[next[group_of[i]]++] = {static_cast<std::uint32_t>(i), surface.first(patches_[i])};
  }
}

void BatchBounds::collect_control(const LimitSurface& surface) {
  std::vector<bool> used(surface.mesh().vertex_count());
  std::vector<VertexId> vertices;
  auto to = control_.begin();
  for (const Place& place : places_) {
    surface.control_vertices(patches_[place.position], vertices);
    to = std::copy(vertices.begin(), vertices.end(), to);
    for (const VertexId v : vertices) used[v.index()] = true;
  }
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v]) unused_.push_back(VertexId(v));
  }
  scaled_.resize(surface.mesh().vertex_count());
}

void BatchBounds::update(std::span<const Point3> points, std::span<OffsetTriangle> out, int threads) {
  require_value(points.size() == scaled_.size(), "patch bounds: give a point for each vertex of the mesh");
  require_value(out.size() == patches_.size(), "patch bounds: give room for an answer for each of patches()");
  const PowerOfTwo scale = normalising(points, unused_), back = scale.inverse();
  for (std::size_t v = 0; v < points.size(); ++v) scaled_[v] = scale.apply(points[v]);
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) fit(chunks_[c], back, out);
  };
  if (threads == 1) {
    work(0, chunks_.size());
  } else {
    parallel_for(chunks_.size(), threads, work);
  }
}

void BatchBounds::fit_by_rows(const Group& group, std::span<const VertexId> control,
                              std::span<OffsetTriangle> answers) const {
  // Where tips stick out, more levels.
  constexpr unsigned levels = 3, more_levels = 5;
  const std::size_t controls = control_count(group);
  kernels::fit_rows<float>(*group.rows, levels, scaled_, control, answers);
  fit_rest(controls, -1, control, answers, [&](std::span<const VertexId> of, auto out) {
    kernels::fit_rows<float>(*group.rows, more_levels, scaled_, of, out);
  });
  fit_rest(controls, kernels::needs_digits, control, answers, [&](std::span<const VertexId> of, auto out) {
    const auto& rows = group.exact_rows->get(
        [&] { return kernels::RowsWithTips<double>(*library_, *group.kind, kernels::TipsBy::tables); });
    kernels::fit_rows<double>(rows, more_levels, scaled_, of, out);
  });
}

void BatchBounds::fit(const Chunk& chunk, PowerOfTwo back, std::span<OffsetTriangle> out) const {
  thread_local Scratch scratch;
  const Group& group = groups_[chunk.group];
  const Kind& kind = *group.kind;
  const std::size_t count = chunk.end - chunk.begin, controls = control_count(group);
  const std::span<const VertexId> control(
      control_.data() + group.first_control + (chunk.begin - group.first_place) * controls, count * controls);
  const std::span<OffsetTriangle> answers(scratch.answers.data(), count);
  const bool by_rows = !group.table && !group.polygon && regular_inside(kind);
  if (group.table && !group.polygon) {
    kernels::fit_table(*group.table, kind, scaled_, control, answers);
  } else if (by_rows && kind.rules().kernel == RegularKernel::box_spline) {
    kernels::fit_regular(scaled_, control, answers);
  } else if (by_rows && kind.rules().kernel == RegularKernel::bicubic) {
    kernels::fit_bicubic(scaled_, control, answers);
  } else if (group.rows) {
    fit_by_rows(group, control, answers);
  } else {
    for (OffsetTriangle& answer : answers) answer.radius = -1;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Place& place = places_[chunk.begin + i];
    if (answers[i].radius >= 0) {
      if (back.moderate() && answers[i].radius <= 0x1p50) {
        turn_and_scale(answers[i], place.first, back.factor(), out[place.position]);
      } else {
        out[place.position] = unscaled(turned(answers[i], place.first), back);
      }
      continue;
    }
    Patch& patch = scratch.patch;
    const std::span<const VertexId> own = control.subspan(i * controls, controls);
    if (group.polygon) {
      make_patch(*group.polygon, 0, scaled_, own, scratch.polygon);
      split(scratch.polygon, group.part, patch);
    } else {
      make_patch(kind, place.first, scaled_, own, patch);
    }
    if (group.table) {
      out[place.position] = unscaled(offset_triangle(table_triangle(*group.table, patch)), back);
      continue;
    }
    bounding_points(*library_, patch, scratch.hull);
    out[place.position] = unscaled(offset_triangle(*library_, scratch.hull, limit_corners(patch)), back);
  }
}

}  // namespace snug
