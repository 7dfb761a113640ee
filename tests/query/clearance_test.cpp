// Clearances, and first times within a margin, of parts made of boxes that slide, turn, screw and grow: against distances at many
// times, found from their definition in long doubles.

#include <snug/clearance.h>
#include <snug/distance.h>

#include <gtest/gtest.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

namespace snug::clearance_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

using Long = std::array<long double, 3>;
struct Box {
  Point3 low, high;
};

Long placed(const Motion& pose, const Long& p) {
  const auto& m = pose.numbers();
  Long q;
  for (std::size_t i = 0; i < 3; ++i)
    q[i] = m[4 * i] * p[0] + m[4 * i + 1] * p[1] + m[4 * i + 2] * p[2] + m[4 * i + 3];
  return q;
}
Long back(const Motion& pose, const Long& p) {
  const auto& m = pose.numbers();
  Long q;
  for (std::size_t i = 0; i < 3; ++i)
    q[i] = m[i] * (p[0] - m[3]) + m[4 + i] * (p[1] - m[7]) + m[8 + i] * (p[2] - m[11]);
  return q;
}
Long corner(const Box& box, std::size_t k) {
  return {k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y, k & 4 ? box.high.z : box.low.z};
}
// Of a point in the frame of the box.
long double apart(const Box& box, const Long& p) {
  long double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const long double d = std::max({box.low[i] - p[i], p[i] - box.high[i], 0.0L});
    sum += d * d;
  }
  return std::sqrt(sum);
}
// Corners and edges of one against the other, along edges by golden sections of a convex function.
long double apart(const Box& a, const Motion& pose_a, const Box& b, const Motion& pose_b) {
  long double least = INFINITY;  // at most 1e-8 of an edge too large
  for (std::size_t k = 0; k < 8; ++k) {
    least = std::min(least, apart(b, back(pose_b, placed(pose_a, corner(a, k)))));
    for (std::size_t axis = 1; axis < 8; axis *= 2) {
      if (k & axis) continue;
      const Long p = back(pose_a, placed(pose_b, corner(b, k))),
                 q = back(pose_a, placed(pose_b, corner(b, k | axis)));
      const auto at = [&](long double s) {
        return apart(a, {p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2])});
      };
      long double from = 0, to = 1;
      for (int i = 0; i < 42; ++i) {
        const long double s = from + 0.382L * (to - from), t = from + 0.618L * (to - from);
        if (at(s) < at(t)) {
          to = t;
        } else {
          from = s;
        }
      }
      least = std::min({least, at(from), at(0), at(1)});
    }
  }
  return least;
}

Point3 between(const Point3& p, const Point3& q, double s) {
  return {(1 - s) * p.x + s * q.x, (1 - s) * p.y + s * q.y, (1 - s) * p.z + s * q.z};
}

// Boxes that are apart, where they are at time 1, and how they move.
struct Part {
  std::vector<Box> boxes, later{};
  Trajectory motion = Motion();

  [[nodiscard]] static ControlMesh mesh_of(const std::vector<Box>& list) {
    ControlMesh mesh;
    for (const Box& box : list) {
      const ControlMesh more = testing::box(box.low, box.high, true);
      const auto first = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
      for (std::size_t f = 0; f < more.face_count(); ++f) {
        const auto face = more.face(FaceId(f));
        testing::add_face(mesh, {first + face[0].value(), first + face[1].value(), first + face[2].value()});
      }
    }
    return mesh;
  }
  [[nodiscard]] Box at(std::size_t i, double time) const {
    if (later.empty()) return boxes[i];
    return {between(boxes[i].low, later[i].low, time), between(boxes[i].high, later[i].high, time)};
  }
};

struct Pair {
  std::string name;
  Part a, b;
  [[nodiscard]] double duration() const {
    return std::max(
        {a.motion.duration(), b.motion.duration(), a.later.empty() && b.later.empty() ? 0.0 : 1.0});
  }
  [[nodiscard]] long double apart(double time) const {
    const Motion pose_a = a.motion.at(a.motion.duration() == 0 ? 0 : time),
                 pose_b = b.motion.at(b.motion.duration() == 0 ? 0 : time);
    long double least = INFINITY;
    for (std::size_t i = 0; i < a.boxes.size(); ++i)
      for (std::size_t j = 0; j < b.boxes.size(); ++j)
        least = std::min(least, clearance_test::apart(a.at(i, time), pose_a, b.at(j, time), pose_b));
    return least;
  }
};

std::vector<Box> any_boxes(std::mt19937_64& random) {
  std::vector<Box> list;
  for (std::size_t i = 0; i <= random() % 3; ++i) {
    const Point3 low{3 * static_cast<double>(i) + unit(random), unit(random), unit(random)};
    list.push_back(
        {low, {low.x + 0.2 + unit(random), low.y + 0.2 + unit(random), low.z + 0.1 + unit(random)}});
  }
  return list;
}

Trajectory any_motion(std::mt19937_64& random, std::size_t kind, double size) {
  const Vector3 side = random_vector(random, 2 * size), past = random_vector(random, size);
  const Motion from = random_placement(random, side + past), to = random_placement(random, past - side);
  switch (kind) {
    case 0:
      return from;
    case 1:
      return Trajectory::steady(from, {-2 * side, {0, 0, 1}, 0, {}});
    case 2:
      return Trajectory::steady(from, {random() % 2 ? -2 * side : Vector3{}, random_vector(random, 1),
                                       4 * unit(random) - 2, Point3{} + past});
    case 3:
      return Trajectory::steady(
          from, {-1 * side, random_vector(random, 1), 40 * unit(random), Point3{} + from.offset()});
    case 4:
      return Trajectory::screw(from, to);
    case 5:
      return Trajectory::through(std::vector<Motion>{from, random_placement(random, side), to});
    default:  // the way past a wall, at a gap
      return Trajectory::steady(Motion::translation({-4 * size, 0, 0.001 + 0.1 * unit(random)}),
                                {{8 * size, 0, 0}, {0, 0, 1}, random() % 2 ? 0.0 : 3 * unit(random), {}});
  }
}
constexpr std::size_t kinds = 7;

Pair any_pair(std::mt19937_64& random, std::size_t of_a, std::size_t of_b, bool grows) {
  Pair pair{std::to_string(of_a) + " with " + std::to_string(of_b) + (grows ? ", growing" : ""),
            {any_boxes(random)},
            {any_boxes(random)}};
  if (of_a == 6 || of_b == 6) {
    pair.a.boxes = {{{-20, -20, -1}, {20, 20, 0}}};
    pair.b.boxes = {{{0, 0, 0}, {1, 1, 0.2}}};
    of_a = 0;
    of_b = 6;
    pair.b.motion = any_motion(random, of_b, 1);
    return pair;
  }
  pair.a.motion = any_motion(random, of_a, 2);
  pair.b.motion = any_motion(random, of_b, 2);
  if (pair.a.motion.duration() != pair.b.motion.duration() &&
      pair.a.motion.duration() * pair.b.motion.duration() != 0)
    pair.a.motion = Motion();
  if (grows && pair.duration() <= 1) {
    pair.b.later = pair.b.boxes;
    for (Box& box : pair.b.later) {
      const Vector3 by = random_vector(random, 2);
      box = {box.low + by, box.high + by + Vector3{unit(random), 0, unit(random)}};
    }
  }
  return pair;
}

// Both as they are asked for.
struct Moving {
  explicit Moving(const Pair& pair)
      : end_a(Part::mesh_of(pair.a.later).points),
        end_b(Part::mesh_of(pair.b.later).points),
        a{Surface(Part::mesh_of(pair.a.boxes), {.scheme = Scheme::flat}), end_a, pair.a.motion},
        b{Surface(Part::mesh_of(pair.b.boxes), {.scheme = Scheme::flat}), end_b, pair.b.motion} {}
  std::vector<Point3> end_a, end_b;
  DeformingSurface a, b;
};

struct Count {
  int complete = 0, met = 0, checked = 0, steps = 0;
  std::size_t spans = 0;
};

void check(const Pair& pair, const ClearanceOptions& options, const std::string& what, Count& count) {
  const Moving moving(pair);
  const Clearance found = clearance(moving.a, moving.b, options);
  const double size = std::max(moving.a.surface.size(), moving.b.surface.size()), doubt = 1e-12 * (size + 50);
  ASSERT_FALSE(found.spans.empty()) << what;
  double time = 0, least = INFINITY, most = INFINITY;
  for (const ClearanceSpan& span : found.spans) {
    ASSERT_EQ(span.time.lower, time) << what;
    time = span.time.upper;
    ASSERT_LE(span.distance.lower, span.distance.upper) << what;
    least = std::min(least, span.distance.lower);
    most = std::min(most, span.distance.upper);
    // Of many some forty.
    if (static_cast<std::size_t>(&span - found.spans.data()) % (1 + found.spans.size() / 40) != 0) continue;
    const long double at_end = std::min(pair.apart(span.time.lower), pair.apart(span.time.upper)) - 1e-7L;
    // Surfaces that are one in the other are farther apart than their solids.
    if (options.solid || at_end > 1e-3L) {
      ASSERT_LE(at_end, span.distance.upper + doubt) << what;
    }
    static constexpr std::array<double, 3> shares{0.2, 0.5, 0.9};
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double then = span.time.lower + (span.time.upper - span.time.lower) * shares[i];
      const long double truth = pair.apart(then);
      if (!options.solid && truth == 0) continue;
      ++count.checked;
      ASSERT_GE(truth, span.distance.lower - doubt) << what << " at " << then;
    }
  }
  ASSERT_EQ(time, pair.duration()) << what;
  EXPECT_EQ(found.distance, Interval(least, most)) << what;
  if (options.solid || pair.apart(found.time) > 0) {
    EXPECT_LE(pair.apart(found.time), found.distance.upper + 1e-7) << what;
  }
  const double far = length(found.witness[1].point - found.witness[0].point);
  if (found.distance.upper > 0) {
    EXPECT_LE(far, found.distance.upper + doubt + 4 * (found.witness[0].error + found.witness[1].error))
        << what;
  }
  if (found.outcome == Outcome::complete) {
    ++count.complete;
    for (const ClearanceSpan& span : found.spans) {
      const double wanted =
          std::max(options.absolute.value_or(options.relative ? 0 : 1e-3 * size),
                   options.relative.value_or(options.absolute ? 0 : 0.1) * span.distance.upper);
      EXPECT_LE(span.distance.upper - span.distance.lower, wanted) << what;
    }
  }
  if (found.outcome != Outcome::complete) std::cout << "  " << what << ": " << found.steps << " steps\n";
  count.met += found.distance.upper == 0;
  count.steps += found.steps;
  count.spans += found.spans.size();
}

TEST(clearance, holds_the_distance_at_every_time) {
  std::mt19937_64 random(59);
  Count count;
  int trials = 0;
  for (std::uint64_t trial = 0; trial < testing::share(kinds * kinds); ++trial, ++trials) {
    const Pair pair = any_pair(random, trial % kinds, trial / kinds % kinds, trial % 5 == 0);
    ClearanceOptions options;
    if (trial % 3 == 1) options.absolute = 0.02;
    if (trial % 4 == 1) options.relative = 0.3;
    options.solid = trial % 2 == 0;
    check(pair, options, "trial " + std::to_string(trial) + ": " + pair.name, count);
    if (::testing::Test::HasFatalFailure()) return;
  }
  std::cout << "  " << count.complete << " of " << trials << " complete, " << count.met << " in contact; "
            << count.spans << " spans, " << count.steps << " steps, " << count.checked << " distances\n";
  EXPECT_GT(count.complete, trials * 9 / 10);
  EXPECT_TRUE(trials < 16 || count.met > 0);
}

// A slab 1e-3 above a plate, 40 times its size: samples alone would take 20,000 of them.
TEST(clearance, of_a_slide_takes_few_steps) {
  Pair pair{"slide", {{{{-30, -30, -1}, {30, 30, 0}}}}, {{{{0, 0, 0}, {1, 1, 0.1}}}}};
  pair.b.motion = Trajectory::steady(Motion::translation({-20, 0, 1e-3}), {{40, 0, 0}, {0, 0, 1}, 0, {}});
  Count count;
  check(pair, {.relative = 0.1}, "slide", count);
  EXPECT_EQ(count.complete, 1);
  EXPECT_LT(count.steps, 200);
  pair.b.motion = Trajectory::steady(Motion::translation({-20, 0, 1e-3}), {{40, 0, 0}, {0, 0, 1}, 3, {}});
  check(pair, {.relative = 0.1}, "slide and turn", count);
  EXPECT_EQ(count.complete, 2);
}

// Curved surfaces: not below distances at samples, and as near as is asked for.
TEST(clearance, of_curved_surfaces_is_not_above_distances_at_samples) {
  const Surface a = Surface(testing::box({-1, -1, -1}, {1, 1, 1}, false)),
                b = Surface(testing::l_prism(false));
  const Trajectory path = Trajectory::through(std::vector<Motion>{
      Motion::translation({4, 0, 0}), Motion::rotation({0, 1, 1}, 1).with_offset({1.5, 1.5, 0.5}),
      Motion::translation({-3, 2, 2})});
  for (const double absolute : {0.1, 0.01}) {
    const Clearance found = clearance(a, Motion(), b, path, {.absolute = absolute});
    EXPECT_EQ(found.outcome, Outcome::complete);
    for (const ClearanceSpan& span : found.spans) {
      for (const double s : {0.0, 0.3, 0.5, 0.9}) {
        const double time = span.time.lower + s * (span.time.upper - span.time.lower);
        EXPECT_LE(span.distance.lower, distance(a, b.at(path.at(time)), {.relative = 1e-4}).distance.upper);
      }
    }
    EXPECT_LE(found.distance.upper - found.distance.lower, absolute);
    EXPECT_LE(distance(a, b.at(path.at(found.time))).distance.lower, found.distance.upper);
  }
}

TEST(clearance, says_what_it_cannot_do) {
  const Surface a = Surface(testing::box({0, 0, 0}, {1, 1, 1}, true), {.scheme = Scheme::flat});
  const Trajectory path = Trajectory::through(
      std::vector<Motion>{Motion::translation({3, 0, 0}), Motion::translation({2, 0, 0}), {}});
  const Trajectory once = Trajectory::screw(Motion::translation({3, 0, 0}), Motion::translation({2, 0, 0}));
  EXPECT_THROW(static_cast<void>(clearance(a, once, a, path)), InputError);
  EXPECT_THROW(static_cast<void>(clearance(a, Motion(), a, path, {.absolute = -1})), InputError);
  EXPECT_THROW(static_cast<void>(clearance(a, Motion(), a, path, {.relative = NAN})), InputError);
  EXPECT_THROW(static_cast<void>(time_of_contact(a, Motion(), a, path, {.margin = -1})), InputError);
  // Without motion it is the distance; without budget it still holds.
  const Clearance still = clearance(a, Motion(), a, Motion::translation({3, 0, 0}));
  EXPECT_EQ(still.spans.size(), 1u);
  EXPECT_LE(still.distance.lower, 2);
  EXPECT_GE(still.distance.upper, 2);
  const Trajectory turned = Trajectory::steady(Motion::translation({3, 0, 0}), {{}, {0, 1, 1}, 9, {3, 0, 0}});
  const Clearance poor = clearance(a, Motion(), a, turned, {.relative = 1e-6}, {.max_splits = 0});
  EXPECT_EQ(poor.outcome, Outcome::budget_spent);
  EXPECT_EQ(poor.spans.size(), 1u);
  EXPECT_EQ(poor.distance.lower, 0);
  // The same again, and by any thread.
  EXPECT_EQ(clearance(a, Motion(), a, path).distance, clearance(a, Motion(), a, path).distance);
}

// One box in another one, which moves inside; and one that comes from outside.
TEST(clearance, of_solids_counts_what_is_inside) {
  const Surface outer = Surface(testing::box({-4, -4, -4}, {4, 4, 4}, true), {.scheme = Scheme::flat}),
                inner = Surface(testing::box({-1, -1, -1}, {1, 1, 1}, true), {.scheme = Scheme::flat});
  const Trajectory inside = Trajectory::steady({}, {{2, 0, 0}, {0, 0, 1}, 0, {}});
  const Clearance surfaces = clearance(outer, Motion(), inner, inside, {.absolute = 1e-3});
  EXPECT_LE(surfaces.distance.lower, 1);
  EXPECT_GE(surfaces.distance.upper, 1);
  EXPECT_EQ(surfaces.contained, std::nullopt);
  const Clearance solids = clearance(outer, Motion(), inner, inside, {.absolute = 1e-3, .solid = true});
  EXPECT_EQ(solids.distance, Interval(0));
  EXPECT_EQ(solids.contained, 1u);
  const Trajectory in = Trajectory::steady(Motion::translation({9, 0, 0}), {{-9, 0, 0}, {0, 0, 1}, 0, {}});
  const Clearance entered = clearance(outer, Motion(), inner, in, {.absolute = 1e-2, .solid = true});
  EXPECT_EQ(entered.distance, Interval(0));
  for (const ClearanceSpan& span : entered.spans) {
    EXPECT_LE(span.distance.lower, std::max(0.0, 4 - 9 * span.time.upper) + 1e-12);
  }
}

// The first time at which surfaces are within a margin.
void check_margin(const Pair& pair, const TimeOfContactOptions& options, const std::string& what,
                  std::array<int, 4>& verdicts) {
  const Moving moving(pair);
  const TimeOfContact found = time_of_contact(moving.a, moving.b, options);
  const double doubt = 1e-11 * (std::max(moving.a.surface.size(), moving.b.surface.size()) + 50);
  ++verdicts[static_cast<std::size_t>(found.verdict)];
  const double end = found.verdict == Verdict::separated ? pair.duration() : found.time.lower;
  for (int i = 0; i <= 36; ++i) {
    const double time = i < 30 ? end * i / 30 : end * (1 - std::exp2(-4 * (i - 29)));
    const long double truth = pair.apart(time);
    if (time == found.time.lower && found.verdict != Verdict::separated) continue;
    if (!options.solid && truth == 0) continue;
    ASSERT_GT(truth, options.margin - doubt) << what << " at " << time;
  }
  if (found.verdict == Verdict::within) {
    EXPECT_LE(pair.apart(found.time.upper), options.margin + *options.tolerance + doubt) << what;
  } else if (found.verdict == Verdict::intersecting && options.solid) {
    EXPECT_LE(pair.apart(found.time.upper), doubt) << what;
  }
}

TEST(clearance, margins_of_first_times_are_kept) {
  std::mt19937_64 random(60);
  std::array<int, 4> verdicts{};
  for (std::uint64_t trial = 0; trial < testing::share(kinds * kinds); ++trial) {
    const Pair pair = any_pair(random, trial % kinds, trial / kinds % kinds, trial % 3 == 0);
    if (pair.duration() == 0) continue;
    TimeOfContactOptions options;
    options.tolerance = trial % 4 == 0 ? 0.05 : 1e-3;
    options.solid = trial % 2 == 0;
    options.margin = std::array{0.3, 0.05, 1e-3, 2.0}[random() % 4];
    check_margin(pair, options, "trial " + std::to_string(trial) + ": " + pair.name, verdicts);
    if (::testing::Test::HasFatalFailure()) return;
  }
  std::cout << "  " << verdicts[0] << " separated, " << verdicts[1] << " within, " << verdicts[2]
            << " intersecting, " << verdicts[3] << " undecided\n";
  EXPECT_GT(verdicts[0], static_cast<int>(testing::share(8)));
  EXPECT_GT(verdicts[1], static_cast<int>(testing::share(8)));
  EXPECT_LT(verdicts[3], 10);
}

// Control points that come down to 1 above a plate: near it, though nothing meets.
TEST(clearance, of_control_points_that_come_near_is_known) {
  const Surface a = Surface(testing::box({-5, -5, -1}, {5, 5, 0}, true), {.scheme = Scheme::flat});
  const ControlMesh above = testing::box({0, 0, 4}, {1, 1, 5}, true),
                    below = testing::box({0, 0, 1}, {1, 1, 2}, true);
  const DeformingSurface b{Surface(above, {.scheme = Scheme::flat}), below.points};
  const TimeOfContact found = time_of_contact({a}, b, {.tolerance = 1e-6, .margin = 2});
  EXPECT_EQ(found.verdict, Verdict::within);
  EXPECT_LE(found.time.lower, 2.0 / 3);
  EXPECT_GE(found.time.lower, 2.0 / 3 - 1e-5);
  EXPECT_EQ(time_of_contact({a}, b, {.margin = 0.9}).verdict, Verdict::separated);
  const Clearance room = clearance({a}, b, {.absolute = 1e-3});
  EXPECT_LE(room.distance.lower, 1);
  EXPECT_GE(room.distance.upper, 1);
}

// A box that comes down on a plate is within the margin when it is so far above.
TEST(clearance, of_a_fall_is_known) {
  const Surface a = Surface(testing::box({-5, -5, -1}, {5, 5, 0}, true), {.scheme = Scheme::flat}),
                b = Surface(testing::box({0, 0, 0}, {1, 1, 1}, true), {.scheme = Scheme::flat});
  const Trajectory fall =
      Trajectory::steady(Motion::translation({0, 0, 4}), {{0, 0, -3.5}, {0, 0, 1}, 0, {}});
  for (const double margin : {0.75, 2.0, 3.999}) {
    const TimeOfContact found = time_of_contact(a, Motion(), b, fall, {.tolerance = 1e-6, .margin = margin});
    EXPECT_EQ(found.verdict, Verdict::within);
    EXPECT_LE(found.time.lower, (4 - margin) / 3.5);
    EXPECT_GE(found.time.lower, (4 - margin) / 3.5 - 1e-5);
    EXPECT_LE(found.time.upper, (4 - margin) / 3.5 + 1e-5);
  }
  EXPECT_EQ(time_of_contact(a, Motion(), b, fall, {.margin = 0.4}).verdict, Verdict::separated);
  const TimeOfContact at_once = time_of_contact(a, Motion(), b, fall, {.margin = 5});
  EXPECT_EQ(at_once.verdict, Verdict::within);
  EXPECT_EQ(at_once.time, Interval(0, 0));
  const Clearance found = clearance(a, Motion(), b, fall, {.absolute = 1e-3});
  EXPECT_LE(found.distance.lower, 0.5);
  EXPECT_GE(found.distance.upper, 0.5);
  EXPECT_EQ(found.time, 1);
}

}  // namespace
}  // namespace snug::clearance_test
