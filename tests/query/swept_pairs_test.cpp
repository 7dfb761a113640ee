// Parts that slide, turn and screw past each other at a small clearance, against separating axes at many times.

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <oracle/contact_time_twin.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace snug::swept_pairs_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

struct Box {
  Point3 low, high;
};
// A part made of boxes.
struct Part {
  explicit Part(const std::vector<Box>& in_boxes)
      : boxes(in_boxes), surface(mesh_of(boxes), {.scheme = Scheme::flat}) {}

  static ControlMesh mesh_of(const std::vector<Box>& boxes) {
    ControlMesh mesh;
    for (const Box& box : boxes) {
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

  std::vector<Box> boxes;
  Surface surface;
};

// How deep boxes of the parts overlap at a time, at most; negative: how far they are apart.
long double overlap(const Part& a, const Motion& pose_a, const Part& b, const Motion& pose_b) {
  long double most = -INFINITY;
  for (const Box& one : a.boxes) {
    for (const Box& other : b.boxes) {
      const auto placed = [](const Box& box, const Motion& pose) {
        const Vector3 middle = 0.5 * ((box.low - Point3{}) + (box.high - Point3{}));
        return (pose * Motion::translation(middle)).numbers();
      };
      const auto half = [](const Box& box) {
        const Vector3 h = 0.5 * (box.high - box.low);
        return oracle::Point{h.x, h.y, h.z};
      };
      most = std::max(
          most, -oracle::separation(half(one), placed(one, pose_a), half(other), placed(other, pose_b)));
    }
  }
  return most;
}

// Moving pieces, their paths and a clearance, in a frame of its own.
struct Scene {
  std::string name;
  std::vector<Box> still, moving;
  Motion from;
  SteadyMotion motion;
};

constexpr double turn = 2 * std::numbers::pi;

Scene slab_along_plate(std::mt19937_64& random, double c) {
  const Vector3 way{20 * (unit(random) + 0.2), 4 * unit(random) - 2, 0};
  return {"slab along a plate",
          {{{-10, -10, -1}, {10, 10, 0}}},
          {{{-1, -1, 0}, {1, 1, 0.1}}},
          Motion::translation({-0.5 * way.x, -0.5 * way.y, c}),
          {way, {0, 0, 1}, 0, {}}};
}

Scene slab_turns_on_plate(std::mt19937_64& random, double c) {
  Scene scene = slab_along_plate(random, c);
  scene.name = "slab turns along a plate";
  scene.motion.radians = turn * (random() % 2 ? unit(random) : 12 * unit(random));
  scene.motion.about = Point3{} + scene.from.offset() + Vector3{unit(random), unit(random), 0};
  if (random() % 2) scene.motion.velocity.z = 2 * unit(random);  // away
  return scene;
}

std::vector<Box> frame(double hole) {
  return {{{-3, -3, -0.5}, {-hole, 3, 0.5}},
          {{hole, -3, -0.5}, {3, 3, 0.5}},
          {{-hole, -3, -0.5}, {hole, -hole, 0.5}},
          {{-hole, hole, -0.5}, {hole, 3, 0.5}}};
}

Scene shaft_turns_in_frame(std::mt19937_64& random, double c) {
  const double side = (1 - c) / std::numbers::sqrt2;
  const Vector3 along{0, 0, random() % 2 ? 0 : 2 * unit(random) - 1};
  return {"shaft turns in a frame",
          frame(1),
          {{{-side, -side, -2}, {side, side, 2}}},
          Motion::rotation({0, 0, 1}, 0.3 * unit(random)),
          {along, {0, 0, 1}, turn * (random() % 2 ? unit(random) : 10 * unit(random)), {}}};
}

Scene shaft_slides_in_frame(std::mt19937_64& random, double c) {
  return {"shaft slides in a frame",
          frame(1),
          {{{-1 + c, -1 + c, -1}, {1 - c, 1 - c, 1}}},
          {},
          {{0, 0, 3 * unit(random)}, {0, 0, 1}, 0, {}}};
}

Scene rod_over_post(std::mt19937_64& random, double c) {
  return {"rod over a post",
          {{{2, -0.1, -1}, {2.2, 0.1, 1}}},
          {{{-0.1, -0.1, -0.1}, {4, 0.1, 0.1}}},
          Motion::translation({0, 0, 1.1 + c}) * Motion::rotation({0, 0, 1}, turn * unit(random)),
          {{}, {0, 0, 1}, turn * 8 * unit(random), {0, 0, 0}}};
}

Scene rod_past_wall(std::mt19937_64& random, double c) {
  const double tip = std::hypot(4.0, 0.1), z = 0.3 * unit(random);
  return {"tip of a rod past a wall",
          {{{tip + c, -5, -5}, {tip + c + 1, 5, 5}}},
          {{{-1, -0.1, -0.1}, {4, 0.1, 0.1}}},
          Motion::rotation({0, 0, 1}, turn * unit(random)),
          {{0, unit(random), z}, {0, 0, 1}, turn * (2 * unit(random) - 1) * (random() % 2 ? 1 : 5), {}}};
}

Scene scene_of(std::mt19937_64& random, std::size_t kind, double c) {
  switch (kind) {
    case 0:
      return slab_along_plate(random, c);
    case 1:
      return slab_turns_on_plate(random, c);
    case 2:
      return shaft_turns_in_frame(random, c);
    case 3:
      return shaft_slides_in_frame(random, c);
    case 4:
      return rod_over_post(random, c);
    default:
      return rod_past_wall(random, c);
  }
}
constexpr std::size_t kinds = 6;

// The scene in a place of its own, as one motion, as a path, as the motion of the other part, or of both.
struct Motions {
  std::string name;
  Trajectory still, moving;
};

Motions moved(std::mt19937_64& random, const Scene& scene, std::size_t way) {
  const Motion at = random() % 4 == 0 ? Motion() : random_placement(random, random_vector(random, 3));
  SteadyMotion motion = scene.motion;
  motion.velocity = at.rotate(motion.velocity);
  motion.axis = at.rotate(motion.axis);
  motion.about = at.apply(motion.about);
  const Trajectory along = Trajectory::steady(at * scene.from, motion);
  const auto through = [](const Trajectory& whole, const Trajectory& other) {
    // As seen from the other one at first, whose motion it is brought into.
    std::vector<Motion> poses;
    constexpr int pieces = 12;
    for (int i = 0; i <= pieces; ++i) {
      const double t = static_cast<double>(i) / pieces;
      poses.push_back(other.at(t) * other.at(0).inverse() * whole.at(t));
    }
    return Trajectory::through(poses);
  };
  // Screws between samples of a motion are the same motion only where it turns by less than half between them.
  const bool steps = std::fabs(scene.motion.radians) < 12 * 3 && scene.motion.velocity.x == 0 &&
                     scene.motion.velocity.y == 0;
  if (way == 1 && (steps || scene.motion.radians == 0))
    return {"path", Trajectory(at), through(along, Trajectory(at))};
  if (way == 2 && scene.motion.radians == 0) {
    // Both fly together, one faster.
    const Vector3 both = random_vector(random, 5);
    SteadyMotion faster = motion;
    faster.velocity = motion.velocity + both;
    return {"both", Trajectory::steady(at, {both, {0, 0, 1}, 0, {}}),
            Trajectory::steady(at * scene.from, faster)};
  }
  if (way == 3) {
    // The still part turns the other way, about the same axis, and flies along.
    SteadyMotion back{motion.velocity, motion.axis, scene.motion.radians == 0 ? 0 : 0.3, motion.about};
    SteadyMotion with = motion;
    if (scene.motion.radians != 0 && scene.motion.velocity == Vector3{}) {
      with.radians += 0.3;
      return {"both turn", Trajectory::steady(at, back), Trajectory::steady(at * scene.from, with)};
    }
  }
  return {"one", Trajectory(at), along};
}

struct Tally {
  int separated = 0, met = 0, undecided = 0;
  std::vector<std::uint64_t> work;
};

void check(std::mt19937_64& random, std::size_t trial, int samples, bool by_default, Tally& tally) {
  const bool meets = random() % 4 == 0;
  const double clearance = std::pow(10.0, -1 - 5 * unit(random)), c = meets ? -clearance : clearance;
  const Scene scene = scene_of(random, trial % kinds, c);
  const Motions motions = moved(random, scene, trial / kinds % 4);
  const std::string what = scene.name + ", " + motions.name + ", trial " + std::to_string(trial) +
                           ", clearance " + std::to_string(std::log10(clearance));
  Part still(scene.still), moving(scene.moving);
  TimeOfContactOptions options;
  if (!by_default) options.tolerance = 0.05 * clearance;
  const bool swapped = random() % 2;
  const TimeOfContact found =
      swapped ? time_of_contact(moving.surface, motions.moving, still.surface, motions.still, options)
              : time_of_contact(still.surface, motions.still, moving.surface, motions.moving, options);
  tally.separated += found.verdict == Verdict::separated;
  tally.met += found.verdict == Verdict::intersecting || found.verdict == Verdict::within;
  tally.undecided += found.verdict == Verdict::undecided;
  tally.work.push_back(found.stats.box_tests + found.stats.triangle_tests);
  EXPECT_NE(found.verdict, Verdict::undecided) << what << " from " << found.time.lower;
  EXPECT_LT(tally.work.back(), 100'000u) << what;
  const double end = std::max(motions.still.duration(), motions.moving.duration());
  long double most = -INFINITY;
  for (int i = 0; i <= samples; ++i) {
    const double t = end * i / samples;
    const long double depth =
        overlap(still, motions.still.duration() > 0 ? motions.still.at(t) : motions.still.start(), moving,
                motions.moving.at(t));
    most = std::max(most, depth);
    if (depth > 1e-13L) {
      ASSERT_NE(found.verdict, Verdict::separated) << what << ": overlap at " << t;
      ASSERT_LE(found.time.lower, t) << what;
      break;
    }
  }
  if (!meets && !by_default) {
    ASSERT_LT(most, -0.9L * static_cast<long double>(clearance)) << "the test's own scene: " << what;
    EXPECT_EQ(found.verdict, Verdict::separated) << what;
  }
}

void check_many(std::size_t trials, int samples, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Tally tally;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    check(random, trial, samples, random() % 4 == 0, tally);
    if (::testing::Test::HasFatalFailure()) return;
  }
  std::sort(tally.work.begin(), tally.work.end());
  std::cout << "  " << tally.separated << " separated, " << tally.met << " met, " << tally.undecided
            << " undecided; pairs compared " << tally.work[tally.work.size() / 2] << " in the median, "
            << tally.work[tally.work.size() * 9 / 10] << " at nine tenths, " << tally.work.back()
            << " at most\n";
}

TEST(swept_pairs, is_decided_and_never_late) { check_many(240, 500, 5); }

}  // namespace
}  // namespace snug::swept_pairs_test
