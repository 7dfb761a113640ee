#include <snug/surface/evaluate.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/patch/net_kernels.h>
#include <snug/surface/curve_set.h>
#include <snug/surface/unscale.h>
#include <support/direction.h>
#include <support/error.h>
#include <support/parallel.h>

namespace snug {

namespace {

SurfacePoint in_mesh_units(const LimitFrame& frame, const Point3& origin, PowerOfTwo back) {
  const BoundedPoint point = unscaled(frame.point.from(origin), back);
  SurfacePoint result{
      {point.position, point.error, {}}, {}, frame.differentiable, frame.normal, frame.normal_error};
  for (std::size_t t = 0; t < 2; ++t) {
    const Vector3 tangent = back.apply(frame.tangents[t]);
    // At most 2^66 before.
    result.tangents[t] = back.moderate() ? tangent : require_representable(tangent);
  }
  return result;
}

// The patch, or the first half of the quad, that a place lies on; checks all but u and v.
PatchId first_patch(const LimitSurface& surface, const Place& at) {
  const bool triangular = surface.rules().triangular();
  bool there = at.owner < surface.owner_count() && (!triangular || at.corner == 0);
  std::size_t patch = 0;
  if (there) {
    const LimitSurface::PatchRange range = surface.patches_of(at.owner);
    patch = range.begin + 2 * std::size_t{at.corner};
    there = patch < range.end && surface.has_patch(PatchId(patch));
  }
  require_value(there, "evaluate: the surface has no such face or corner; give one that it has");
  return PatchId(patch);
}

bool on_one_patch(const Place& a, const Place& b) { return a.owner == b.owner && a.corner == b.corner; }

// Numbers of points such that those of one face, or quad, follow each other. Empty where most do already, by some
// pairs that are looked at, or where there are so few that hardly two lie on one face.
std::vector<std::size_t> grouped_by_patch(const LimitSurface& surface, std::span<const Place> at) {
  if (at.size() < 2) return {};
  // Spread by the golden ratio, which no period of the places follows.
  const std::size_t pairs = std::min<std::size_t>(at.size() - 1, 1024);
  std::size_t changes = 0;
  for (std::size_t k = 0; k < pairs; ++k) {
    const double part = std::fmod(0.618033988749895 * static_cast<double>(k), 1);
    const auto i = static_cast<std::size_t>(part * static_cast<double>(at.size() - 1));
    changes += !on_one_patch(at[i], at[i + 1]);
  }
  if (8 * changes <= pairs || at.size() < surface.patch_count() / 8) return {};
  std::vector<std::size_t> begins(surface.patch_count() + 1, 0), order(at.size());
  for (const Place& a : at) ++begins[first_patch(surface, a).index() + 1];
  for (std::size_t p = 1; p < begins.size(); ++p) begins[p] += begins[p - 1];
  for (std::size_t i = 0; i < at.size(); ++i) order[begins[first_patch(surface, at[i]).index()]++] = i;
  return order;
}

// Writes positions in single precision; returns the largest error.
double write_rounded(std::span<const BoundedPoint> points, const std::size_t* numbers, float* out) {
  const double error = kernels::round_points(points, numbers, out);
  if (!(error < INFINITY)) {
    throw InputError(InputProblem::unrepresentable,
                     "a result does not fit a float: the coordinates are too large; scale the mesh down");
  }
  return error;
}

// A thread's evaluator, with some points of one face, or quad, and their numbers.
struct Worker {
  explicit Worker(const LimitSurface& surface) : evaluator(surface) {}

  static constexpr std::size_t most = 128;
  SurfaceEvaluator evaluator;
  std::span<const Place> places;
  std::array<std::size_t, most> numbers;
  std::array<Place, most> gathered;       // room for places that do not follow each other
  std::array<BoundedPoint, most> points;  // and for answers
};

// Calls visit(worker) with some points until all have had their turn.
template <class Visit>
void evaluate_all(const LimitSurface& surface, std::span<const Place> at, int threads, const Visit& visit) {
  constexpr std::size_t worth_a_thread = 2048;
  const std::vector<std::size_t> order = grouped_by_patch(surface, at);
  parallel_for_with(
      at.size(), at.size() < worth_a_thread ? 1 : threads, [&] { return Worker(surface); },
      [&](Worker& worker, std::size_t begin, std::size_t end) {
        const auto number = [&](std::size_t i) { return order.empty() ? i : order[i]; };
        for (std::size_t first = begin; first < end;) {
          const Place& place = at[number(first)];
          std::size_t count = 0;
          for (std::size_t i = first; i < end && count < Worker::most; ++i) {
            const std::size_t n = number(i);
            if (!on_one_patch(place, at[n])) break;
            if (!order.empty()) worker.gathered[count] = at[n];
            worker.numbers[count++] = n;
          }
          worker.places = order.empty() ? at.subspan(first, count) : std::span(worker.gathered).first(count);
          visit(worker);
          first += count;
        }
      });
}

// Both return the largest error of a position.
double write_positions(Worker& worker, const FloatPoints& out) {
  const std::span<BoundedPoint> points = std::span(worker.points).first(worker.places.size());
  worker.evaluator.positions(worker.places, points);
  return write_rounded(points, worker.numbers.data(), out.positions.data());
}

double write_with_normals(Worker& worker, const FloatPoints& out) {
  const std::span<BoundedPoint> points = std::span(worker.points).first(worker.places.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::size_t first = 3 * worker.numbers[k];
    const SurfacePoint point = worker.evaluator(worker.places[k]);
    points[k] = {point.point, point.error};
    const Vector3 normal = point.normal.value_or(Vector3{});
    for (std::size_t a = 0; a < 3; ++a) out.normals[first + a] = static_cast<float>(normal[a]);
  }
  return write_rounded(points, worker.numbers.data(), out.positions.data());
}

}  // namespace

void SurfaceEvaluator::turn_to(const Place& at) {
  if (last_ && owner_ == at.owner && corner_ == at.corner) return;
  last_.reset();
  const PatchId patch = first_patch(*surface_, at);
  surface_->patch(patch, patch_);
  evaluator_.reset(patch_);
  last_ = patch;
  owner_ = at.owner;
  corner_ = at.corner;
}

SurfacePoint SurfaceEvaluator::operator()(const Place& at) {
  turn_to(at);
  SurfacePoint point = in_mesh_units(evaluator_.frame(at), evaluator_.origin(), back_);
  point.at = at;
  return point;
}

void SurfaceEvaluator::positions(std::span<const Place> at, std::span<BoundedPoint> out) {
  if (at.empty()) return;
  turn_to(at.front());
  evaluator_.points(at, out);
  const PowerOfTwo back = back_;  // answers cannot overlap it
  for (BoundedPoint& point : out) point = unscaled(point, back);
}

SurfacePoint evaluate(const LimitSurface& surface, const Place& at) { return SurfaceEvaluator(surface)(at); }

std::vector<SurfacePoint> evaluate(const LimitSurface& surface, std::span<const Place> at, int threads) {
  std::vector<SurfacePoint> points(at.size());
  evaluate_all(surface, at, threads, [&](Worker& worker) {
    for (std::size_t k = 0; k < worker.places.size(); ++k) {
      points[worker.numbers[k]] = worker.evaluator(worker.places[k]);
    }
  });
  return points;
}

double evaluate(const LimitSurface& surface, std::span<const Place> at, const FloatPoints& out, int threads) {
  const bool normals = !out.normals.empty();
  require_value(out.positions.size() == 3 * at.size() && (!normals || out.normals.size() == 3 * at.size()),
                "evaluate: there must be room for three floats a point");
  std::atomic<double> largest = 0;
  evaluate_all(surface, at, threads, [&](Worker& worker) {
    const double error = normals ? write_with_normals(worker, out) : write_positions(worker, out);
    double met = largest.load(std::memory_order_relaxed);
    while (error > met && !largest.compare_exchange_weak(met, error, std::memory_order_relaxed)) {
    }
  });
  return largest;
}

PatchEvaluator::PatchEvaluator(const LimitSurface& surface, PatchId p)
    : patch_(surface.patch(p)), back_(surface.scale().inverse()) {}

SurfacePoint PatchEvaluator::operator()(TriangleParameter at) const {
  return in_mesh_units(limit_frame(patch_, at), patch_.origin, back_);
}

Place place_of(const LimitSurface& surface, PatchId patch, TriangleParameter at) {
  const auto [owner, part] = surface.place(patch);
  if (surface.rules().triangular()) {
    const double u = std::clamp(at.u, 0.0, 1.0);
    return {owner, 0, u, std::clamp(at.v, 0.0, 1 - u)};
  }
  // Half a quad: from (0,0) by (1,0) to (1,1), or from (1,1) by (0,1) to (0,0).
  const double u = part % 2 == 0 ? at.u + at.v : 1 - at.u - at.v, v = part % 2 == 0 ? at.v : 1 - at.v;
  return {owner, part / 2, std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0)};
}

std::optional<PatchId> patch_at(const LimitSurface& surface, const Place& at) {
  const double u = at.u, v = at.v;
  if (at.owner >= surface.owner_count() || !(u >= 0 && v >= 0 && u <= 1 && v <= 1)) return {};
  const LimitSurface::PatchRange range = surface.patches_of(at.owner);
  std::size_t patch = range.begin;
  if (surface.rules().triangular()) {
    if (!(u + v <= 1) || at.corner != 0) return {};
  } else {
    patch += 2 * std::size_t{at.corner} + (v <= u ? 0 : 1);
  }
  if (patch >= range.end || !surface.has_patch(PatchId(patch))) return {};
  return PatchId(patch);
}

std::optional<SurfaceNormal> normal_at(const LimitSurface& surface, const Place& at, const Motion& pose) {
  const SurfacePoint point = evaluate(surface, at);
  if (!point.normal) return std::nullopt;
  const bool turned =
      pose.row(0) != Vector3{1, 0, 0} || pose.row(1) != Vector3{0, 1, 0} || pose.row(2) != Vector3{0, 0, 1};
  if (!turned) return SurfaceNormal{*point.normal, point.normal_error};
  SurfaceNormal result{normalized(pose.rotate(*point.normal)), {}};
  // derivations/rounding.md, "Normals".
  const double defect = pose.defect();
  if (point.normal_error) {
    result.error = enlarged((1 + 2 * defect) * *point.normal_error + 8 * defect + 32 * unit_roundoff);
  }
  return result;
}

CurvePoint evaluate(const CurveSet& curves, EdgeId edge, double t) {
  const PowerOfTwo back = curves.edges().scale().inverse();
  const CurvePiece piece = curves.edges().piece(edge);
  const CurvePiecePoint found = curve_point(piece, t);
  const BoundedPoint point = unscaled(found.point.from(piece.origin), back);
  return {point.position, point.error, require_representable(back.apply(found.tangent))};
}

}  // namespace snug
