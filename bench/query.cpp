#include "query.h"

#include <cstdio>

namespace snug::bench {
namespace {

SurfaceBvhOptions one_thread(SurfaceBvhOptions options) {
  options.threads = 1;
  return options;
}

}  // namespace

Queries::Queries(const LimitSurface& a, const LimitSurface& b, const SurfaceBvhOptions& options)
    : a_(a, one_thread(options)), b_(b, one_thread(options)), scratch_a_(a_), scratch_b_(b_) {}

Collision Queries::collide(const PosePair& at, double tolerance, double margin, WitnessKind witness) {
  const CollideOptions options{.tolerance = tolerance, .margin = margin, .witness = witness};
  return snug::collide({a_, scratch_a_, at.a}, {b_, scratch_b_, at.b}, options);
}

std::optional<bool> Queries::meet(const PosePair& at) {
  const CollideOptions options{.tolerance = 1e-7, .prove_contact = true};
  switch (snug::collide({a_, scratch_a_, at.a}, {b_, scratch_b_, at.b}, options).verdict) {
    case Verdict::separated:
      return false;
    case Verdict::intersecting:
      return true;
    case Verdict::within:
    case Verdict::undecided:
      break;
  }
  return {};
}

Distance Queries::distance(const PosePair& at, double precision) {
  DistanceOptions options;
  options.absolute = precision;
  return snug::distance({a_, scratch_a_, at.a}, {b_, scratch_b_, at.b}, options);
}

std::size_t Queries::bytes() const {
  return a_.bytes() + b_.bytes() + scratch_a_.bytes() + scratch_b_.bytes();
}

PointQueries::PointQueries(const LimitSurface& surface, const SurfaceBvhOptions& options)
    : model_(surface, one_thread(options)), scratch_(model_) {}

ClosestPoint PointQueries::closest(const Point3& to, double precision, WitnessKind witness) {
  return closest_point(scratch_, to, {.absolute = precision, .witness = witness});
}

void Work::add(const SearchStats& stats) {
  queries_ += 1;
  box_tests_ += static_cast<double>(stats.box_tests);
  triangle_tests_ += static_cast<double>(stats.triangle_tests);
  evaluations_ += static_cast<double>(stats.evaluations);
  splits_ += static_cast<double>(stats.splits);
}

void Work::print(const char* name) const {
  std::printf("# %s, a query: %.1f box tests, %.2f triangle tests, %.2f evaluations, %.2f splits\n", name,
              box_tests_ / queries_, triangle_tests_ / queries_, evaluations_ / queries_, splits_ / queries_);
}

}  // namespace snug::bench
