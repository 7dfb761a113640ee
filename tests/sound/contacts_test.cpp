// The promises of contacts() for every scheme, tag and rule with each other one: points of both surfaces that are near
// each other are on a pair that is listed, points that both have in common are in a box, and curves are where they
// say, by a twin that refines by itself.
//
//   SNUG_PLACEMENTS=20000 build/release/bin/tests/sound_test --gtest_filter='contacts.*'
//
// runs so many placements; SNUG_FIRST=N begins with placement N, with SNUG_PLACEMENTS=1 one that failed alone, and
// SNUG_DUMP=FOLDER writes its meshes there.

#include <snug/contacts.h>
#include <snug/distance.h>
#include <snug/evaluate.h>

#include <gtest/gtest.h>
#include <oracle/limit_twin.h>
#include <snug/geometry/point_triangle.h>
#include <snug/search/surface_data.h>
#include <snug/surface/evaluate.h>
#include <support/point.h>
#include <testing/counts.h>
#include <testing/ground_trials.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <set>

namespace snug::contacts_test {
namespace {

using testing::GroundTrial;
using testing::unit;

oracle::Point point_of(const Point3& p) { return {p.x, p.y, p.z}; }

struct Sample {
  Place at;
  Point3 point;  // placed
};

class Checks {
 public:
  explicit Checks(GroundTrial& trial) : trial_(trial), size_(trial.size()) {
    for (std::size_t s = 0; s < 2; ++s) {
      pose_[s] = trial.placed(s).pose();
      far_ = std::max({far_, size_, max_abs(pose_[s].offset())});
    }
  }

  void run(std::map<std::string, std::size_t>& counts) {
    // Half of the time with what is certainly in contact.
    double tolerance = trial_.tolerance;
    if (trial_.number % 2 == 0 && trial_.truth.upper < 0.5 * size_) {
      tolerance = std::max(tolerance, trial_.truth.upper * (1 + 2 * unit(trial_.random)));
    }
    const ContactsOptions options{.within = tolerance, .error = 0.01 * size_};
    Run run{.threads = 1, .max_splits = 60'000};
    if (trial_.number % 5 == 4) run.max_splits = 1 + trial_.random() % 3000;
    const Contacts found = contacts(trial_.placed(0), trial_.placed(1), options, run);
    ++counts["trials"];
    counts["with contacts"] += !found.regions.empty();
    counts["with curves"] += !found.curves.empty();
    counts["with proved closed curves"] +=
        std::any_of(found.curves.begin(), found.curves.end(),
                    [](const IntersectionCurve& c) { return c.closed && c.proved; });
    counts["with areas"] += !found.areas.empty();
    counts["with open boxes"] += !found.open.empty();
    counts["not complete"] += !found.exhaustive;
    counts["coarser than asked"] += found.outcome != Outcome::complete;
    check_shape(found);
    check_curves(found, counts);
    if (trial_.truth.lower > tolerance) {
      for (const ContactRegion& region : found.regions) EXPECT_EQ(region.verdict, Verdict::undecided);
      EXPECT_TRUE(found.curves.empty());
    }
    if (!found.exhaustive) {
      EXPECT_EQ(found.outcome, Outcome::budget_spent);
      return;
    }
    std::set<std::pair<std::uint32_t, std::uint32_t>> listed;
    for (const ContactRegion& region : found.regions) {
      for (const PatchContact& c : region.contacts) listed.emplace(c.patches[0].owner, c.patches[1].owner);
    }
    if (trial_.truth.upper <= tolerance * (1 - 1e-9)) {
      EXPECT_FALSE(listed.empty());
    }
    for (int i = 0; i < 12; ++i) check_near(found, listed, tolerance, counts);
  }

 private:
  [[nodiscard]] const testing::GroundSide& side(std::size_t s) const { return (*trial_.sides)[s]; }

  [[nodiscard]] Sample sample(std::size_t s, const Place& at) const {
    return {at, pose_[s].apply(evaluate(*side(s).surface, at).point)};
  }
  [[nodiscard]] Sample random_sample(std::size_t s) {
    const LimitSurface& surface = side(s).surface->data()->limit();
    while (true) {
      const PatchId p(trial_.random() % surface.patch_count());
      if (surface.has_patch(p))
        return sample(s, place_of(surface, p, testing::random_parameter(trial_.random)));
    }
  }
  // The nearest one on the other surface.
  [[nodiscard]] Sample opposite(std::size_t s, const Point3& to) {
    const ClosestPoint found = closest_point(*side(s).surface, pose_[s].inverse().apply(to),
                                             {.absolute = 1e-13 * size_}, {.max_splits = 3000});
    return sample(s, *found.at);
  }

  void check_near(const Contacts& found, const std::set<std::pair<std::uint32_t, std::uint32_t>>& listed,
                  double tolerance, std::map<std::string, std::size_t>& counts) {
    // From anywhere to where the surfaces are nearest, and back a little: many pairs about as far as the tolerance.
    Sample a = random_sample(0), b = opposite(1, a.point);
    for (int step = 0; step < 12; ++step) {
      const double apart = distance(a.point, b.point);
      if (apart <= tolerance - 1e-12 * far_) {
        ++counts["near points"];
        EXPECT_TRUE(listed.contains({a.at.owner, b.at.owner}))
            << testing::describe(trial_) << ": owners " << a.at.owner << ", " << b.at.owner << " are "
            << apart << " apart, tolerance " << tolerance;
        EXPECT_TRUE(in_region(found, a.point, b.point)) << testing::describe(trial_);
      }
      if (apart <= 1e-12 * size_) {
        ++counts["common points"];
        EXPECT_TRUE(in_box(found, a.point)) << testing::describe(trial_) << ": " << apart;
        break;
      }
      a = opposite(0, b.point);
      b = opposite(1, a.point);
    }
  }

  [[nodiscard]] bool holds(const Box3& box, const Point3& p, double slack) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!(p[axis] >= box.lower[axis] - slack && p[axis] <= box.upper[axis] + slack)) return false;
    }
    return true;
  }
  [[nodiscard]] bool in_region(const Contacts& found, const Point3& a, const Point3& b) const {
    return std::any_of(found.regions.begin(), found.regions.end(), [&](const ContactRegion& region) {
      return holds(region.box, a, 1e-11 * far_) && holds(region.box, b, 1e-11 * far_);
    });
  }
  // A point that both surfaces nearly have is as near to one that they have as the angle between them says.
  [[nodiscard]] bool in_box(const Contacts& found, const Point3& p) const {
    const double slack = 1e-7 * far_;
    for (const IntersectionCurve& curve : found.curves) {
      for (const CurveBox& b : curve.boxes) {
        if (holds(b.box, p, slack)) return true;
      }
    }
    return std::any_of(found.areas.begin(), found.areas.end(),
                       [&](const ContactArea& area) { return holds(area, p, slack); }) ||
           std::any_of(found.open.begin(), found.open.end(),
                       [&](const OpenBox& b) { return holds(b.box, p, slack); });
  }
  [[nodiscard]] static bool holds(const ContactArea& area, const Point3& p, double slack) {
    const std::size_t n = area.points.size();
    for (std::size_t k = 0; k == 0 || k + 2 < n; ++k) {
      const Triangle t{area.points[0], area.points[std::min(k + 1, n - 1)],
                       area.points[std::min(k + 2, n - 1)]};
      if (distance_between(p, t, 1).lower <= slack) return true;
    }
    return false;
  }

  // Regions and curves are consistent.
  void check_shape(const Contacts& found) {
    for (const ContactRegion& region : found.regions) {
      EXPECT_FALSE(region.contacts.empty());
      EXPECT_LE(region.distance.lower, region.distance.upper);
      const double between = distance(region.witness[0].point, region.witness[1].point);
      const double error = 4 * std::max(region.witness[0].error, region.witness[1].error) + 1e-15 * far_;
      EXPECT_GE(between + error, region.distance.lower);
      if (region.verdict == Verdict::within) {
        EXPECT_LE(between, region.distance.upper * (1 + 1e-9) + error);
      }
      for (std::size_t s = 0; s < 2; ++s) {
        ASSERT_TRUE(region.witness[s].at);
        EXPECT_LE(distance(sample(s, *region.witness[s].at).point, region.witness[s].point), 2e-9 * far_);
      }
    }
    for (const IntersectionCurve& curve : found.curves) {
      ASSERT_GE(curve.points.size(), 2u - curve.closed);
      EXPECT_EQ(curve.boxes.size(), curve.points.size() - (curve.closed ? 0 : 1));
      EXPECT_LT(curve.region, found.regions.size());
      EXPECT_EQ(curve.proved, std::all_of(curve.boxes.begin(), curve.boxes.end(),
                                          [](const CurveBox& b) { return b.one_arc; }));
      EXPECT_EQ(found.regions[curve.region].verdict, Verdict::intersecting);
      for (std::size_t i = 0; i < curve.boxes.size(); ++i) {
        EXPECT_TRUE(holds(curve.boxes[i].box, curve.points[i], 1e-9 * far_));
        EXPECT_TRUE(holds(curve.boxes[i].box, curve.points[(i + 1) % curve.points.size()], 1e-9 * far_));
      }
    }
    for (const OpenBox& open : found.open) EXPECT_LT(open.region, found.regions.size());
    for (const ContactArea& area : found.areas) {
      ASSERT_LT(area.region, found.regions.size());
      EXPECT_EQ(found.regions[area.region].verdict, Verdict::intersecting);
    }
  }

  // By the twin: points of curves, and the middles between them, are as near to both surfaces as is said.
  void check_curves(const Contacts& found, std::map<std::string, std::size_t>& counts) {
    for (const IntersectionCurve& curve : found.curves) {
      if (!curve.proved) continue;
      for (int k = 0; k < 3; ++k) {
        const std::size_t i = trial_.random() % curve.boxes.size();
        const Point3 &p = curve.points[i], &q = curve.points[(i + 1) % curve.points.size()];
        const Point3 middle = p + unit(trial_.random) * (q - p);
        for (std::size_t s = 0; s < 2; ++s) {
          oracle::ContactGoal goal;
          goal.effort = 2000;
          goal.precision = {1e-3 * curve.error + 1e-12 * far_, 1e-3};
          const oracle::ContactBounds at_point =
              side(s).twin->distance_to(trial_.places[s], point_of(p), goal);
          EXPECT_LE(at_point.lower, 1e-11 * far_) << testing::describe(trial_);
          const oracle::ContactBounds at_middle =
              side(s).twin->distance_to(trial_.places[s], point_of(middle), goal);
          EXPECT_LE(at_middle.lower, curve.error + 1e-12 * far_) << testing::describe(trial_);
          ++counts["points of curves"];
        }
      }
    }
  }

  GroundTrial& trial_;
  double size_, far_ = 0;
  std::array<Motion, 2> pose_;
};

TEST(contacts, hold_for_every_scheme_tag_and_rule_with_each_other) {
  constexpr std::uint64_t of_each_row = 1;
  const std::uint64_t count = testing::number_of("SNUG_PLACEMENTS", testing::row_count() * of_each_row),
                      first = testing::number_of("SNUG_FIRST", 0);
  testing::GroundTrials trials(of_each_row);
  std::map<std::string, std::size_t> counts;
  for (std::uint64_t i = first; i < first + count; ++i) {
    GroundTrial trial = trials.make(i);
    // Bounds of patches at such vertices take seconds, whatever the query.
    const bool long_one = (*trial.sides)[0].has_many() || (*trial.sides)[1].has_many();
    if (long_one && i % 16 != 0 && count > 1) continue;
    Checks(trial).run(counts);
    if (HasFailure()) {
      std::printf("  trial %llu failed\n", static_cast<unsigned long long>(i));
      break;
    }
  }
  for (const auto& [name, number] : counts) std::printf("  %-32s %8zu\n", name.c_str(), number);
  if (count < testing::row_count() * of_each_row) return;
  // The trials are worth something.
  EXPECT_GT(counts["near points"], count);
  EXPECT_GT(counts["common points"], count / 4);
  EXPECT_GT(counts["points of curves"], count / 4);
}

}  // namespace
}  // namespace snug::contacts_test
