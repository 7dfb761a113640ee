#include <snug/query/own_contacts.h>

#include <algorithm>
#include <utility>

#include <snug/evaluate.h>
#include <snug/query/self.h>
#include <snug/search/surface_data.h>
#include <support/run.h>

namespace snug {
namespace {

// Pairs of pieces.
constexpr std::uint64_t tests_a_patch = 4, tests_beside = 100'000;
// Of the angle between sheets that go through each other.
constexpr double least_sine = 0x1p-10;

// Do the two sheets lie across each other there? Where they only touch there may be a hull on one side.
bool goes_through(const Surface& surface, const SelfContactPair& pair) {
  const auto a = normal_at(surface, *pair.points[0].at), b = normal_at(surface, *pair.points[1].at);
  return !pair.touching && a && b && length(cross(a->direction, b->direction)) > least_sine;
}

}  // namespace

const std::vector<SurfacePlace>& OwnContacts::through() {
  find();
  return through_;
}

bool OwnContacts::touches_near(const Point3& p, double reach) {
  find();
  return std::any_of(touching_.begin(), touching_.end(),
                     [&](const Point3& touching) { return distance(touching, p) <= reach; });
}

void OwnContacts::find() {
  if (std::exchange(found_, true)) return;
  const WorkMonitor monitor = stop_only(run_);
  const SelfContact found = contact_far_apart(
      surface_,
      {.threads = run_.threads,
       .monitor = &monitor,
       .max_splits = tests_beside + tests_a_patch * surface_.data()->bvh().surface().patch_count()});
  if (found.verdict != SelfVerdict::intersecting) return;
  for (const SelfContactPair& pair : found.pairs) {
    if (goes_through(surface_, pair)) {
      through_.push_back({pair.points[0].point, pair.points[0].at->owner});
    } else {
      touching_.push_back(pair.points[0].point);
    }
  }
}

}  // namespace snug
