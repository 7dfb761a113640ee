// How far heights of moving points bend in a step of time, against those of the exact motions at many times.

#include <snug/query/swept_motion.h>

#include <gtest/gtest.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

#include <array>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace snug::swept_motion_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

// Pieces of each kind: still, straight, turning, turning and moving, screws, screws of little rotation, many turns.
constexpr std::size_t motion_kinds = 9;

// One to six joints, of both sorts, some of which stay.
PieceMotion chain_of(std::mt19937_64& random) {
  std::vector<ChainJoint> chain(1 + random() % 6);
  std::vector<std::vector<double>> positions(2);
  for (ChainJoint& joint : chain) {
    joint.frame = random_placement(random, random_vector(random, static_cast<double>(random() % 3)));
    joint.axis = random_vector(random, 1);
    joint.slides = random() % 3 == 0;
    positions[0].push_back(3 * unit(random));
    positions[1].push_back(random() % 3 == 0 ? positions[0].back() : 3 * unit(random) - 1);
  }
  return PieceMotion(
      Trajectory::joints(chain, random_placement(random, random_vector(random, 1)), positions).pieces()[0]);
}

PieceMotion motion_of(std::mt19937_64& random, std::size_t kind) {
  const Motion from = random_placement(random, random_vector(random, 2));
  const double radians = std::array{1.0, -2.0, 30.0, 1e-5}[random() % 4] * (0.5 + unit(random));
  const Vector3 axis = random_vector(random, 1), by = random_vector(random, 2);
  const Point3 about = Point3{} + random_vector(random, 2);
  const auto steady = [&](const Vector3& velocity, double turn) {
    return PieceMotion(Trajectory::steady(from, {velocity, axis, turn, about}).pieces()[0]);
  };
  const auto screw = [&](const Motion& turn) {
    return PieceMotion(Trajectory::screw(from, (turn * from).with_offset(from.offset() + by)).pieces()[0]);
  };
  switch (kind) {
    case 0:
      return PieceMotion(from);
    case 1:
      return steady(by, 0);
    case 2:
      return steady({}, radians);
    case 3:
      return steady(by, radians);
    case 4:
      return steady({0.5 * axis.x, 0.5 * axis.y, 0.5 * axis.z}, radians);
    case 5:
      return screw(Motion::rotation(axis, 3 * unit(random)));
    case 6:
      return screw(Motion::rotation(axis, 1e-6));
    case 7:
      return screw(Motion());
    default:
      return steady(40 * by, 100 * unit(random));
  }
}

Vector3 unit_vector(std::mt19937_64& random) {
  const Vector3 v = random_vector(random, 1);
  return (1 / length(v)) * v;
}

// A direction of any sort: also along the axis of a motion, and across both.
Vector3 direction_of(std::mt19937_64& random, const std::array<PieceMotion, 2>& motions) {
  switch (random() % 4) {
    case 0:
      return motions[random() % 2].axis();
    case 1: {
      const Vector3 across = cross(motions[0].axis(), motions[1].axis());
      return length(across) > 0.01 ? (1 / length(across)) * across : unit_vector(random);
    }
    default:
      return unit_vector(random);
  }
}

struct Drawn {
  std::array<PieceMotion, 2> motions;
  std::array<OwnBall, 2> balls;
  std::array<Point3, 2> points;  // in the balls
  double first, half;
  Vector3 w;  // in the middle

  Drawn(std::mt19937_64& random, std::size_t kinds)
      : motions{motion_of(random, kinds % motion_kinds),
                motion_of(random, kinds / motion_kinds % motion_kinds)},
        half(0.5 * std::exp2(-12 * unit(random))) {
    first = (1 - 2 * half) * unit(random);
    for (std::size_t s = 0; s < 2; ++s) {
      balls[s] = {Point3{} + random_vector(random, 1), random() % 2 ? 0.0 : unit(random)};
      points[s] = balls[s].centre + balls[s].radius * 0.999 * unit_vector(random);
    }
    w = direction_of(random, motions);
  }

  [[nodiscard]] double bound(std::size_t turns) const {
    const std::array<SweptMotion, 2> swept{SweptMotion(motions[0]), SweptMotion(motions[1])};
    SweptHeights heights{.motions = {&swept[0], &swept[1]},
                         .balls = balls,
                         .centres = {},
                         .levers = {swept[0].lever(balls[0]), swept[1].lever(balls[1])},
                         .time = first + half,
                         .half_step = half};
    for (std::size_t s = 0; s < 2; ++s)
      heights.centres[s] = motions[s].at(first + half).pose.apply(balls[s].centre);
    return turns == 2 ? heights.bending(w, 1e-14) : heights.bending(w, 1e-14, turns);
  }

  [[nodiscard]] double height(double time, std::size_t turns) const {
    const Motion a = motions[0].at(time).pose, b = motions[1].at(time).pose;
    Vector3 then = w;
    if (turns != 2) {
      const Motion middle = motions[turns].at(first + half).pose;
      then = (turns == 0 ? a : b).rotate(middle.inverse().rotate(w));
    }
    return dot(then, b.apply(points[1]) - a.apply(points[0]));
  }
};

TEST(swept_heights, bend_no_more_than_their_bound_for_each_pair_of_motions_and_sort_of_direction) {
  std::mt19937_64 random(7);
  std::array<double, 3> nearest{};
  std::size_t straight = 0;
  for (std::size_t trial = 0; trial < 3 * motion_kinds * motion_kinds * 40; ++trial) {
    const std::size_t turns = trial % 3;
    const Drawn drawn(random, trial / 3);
    const double bound = drawn.bound(turns);
    const std::string what = "trial " + std::to_string(trial) + ", turns with " + std::to_string(turns);
    // The chord from one end to the other.
    const double start = drawn.height(drawn.first, turns),
                 end = drawn.height(drawn.first + 2 * drawn.half, turns);
    const double rounding = 1e-11;  // places are 100 large at most
    for (const double part : {0.1, 0.25, 0.5, 0.8}) {
      const double chord = start + part * (end - start);
      const double off = std::fabs(drawn.height(drawn.first + part * 2 * drawn.half, turns) - chord);
      const double room = bound * 4 * drawn.half * drawn.half * part * (1 - part) / 2;
      ASSERT_LE(off, room * (1 + 1e-9) + rounding) << what;
      if (off > 1e-6) nearest[turns] = std::max(nearest[turns], off / room);
    }
    straight += bound < 1e-300;
  }
  std::cout << "  off by up to " << nearest[0] << ", " << nearest[1] << " and " << nearest[2]
            << " of the bounds; straight " << straight << '\n';
  // Of what moves alone the bound is met.
  for (const double share : nearest) EXPECT_GT(share, 0.9);
  EXPECT_GT(straight, 100u);
}

// Of chains against chains and against all other motions, for a direction that stays.
TEST(swept_heights, bend_no_more_than_their_bound_where_chains_move) {
  std::mt19937_64 random(8);
  double nearest = 0;
  for (std::size_t trial = 0; trial < 4000; ++trial) {
    std::array<PieceMotion, 2> motions{chain_of(random), chain_of(random)};
    if (trial % 2 == 0) motions[trial / 2 % 2] = motion_of(random, trial / 4 % motion_kinds);
    std::array<OwnBall, 2> balls;
    std::array<Point3, 2> points;
    for (std::size_t s = 0; s < 2; ++s) {
      balls[s] = {Point3{} + random_vector(random, 1), random() % 2 ? 0.0 : unit(random)};
      points[s] = balls[s].centre + balls[s].radius * 0.999 * unit_vector(random);
    }
    const Vector3 w = unit_vector(random);
    const double half = 0.5 * std::exp2(-12 * unit(random)), first = (1 - 2 * half) * unit(random);
    const std::array<SweptMotion, 2> swept{SweptMotion(motions[0]), SweptMotion(motions[1])};
    SweptHeights heights{.motions = {&swept[0], &swept[1]},
                         .balls = balls,
                         .centres = {},
                         .levers = {swept[0].lever(balls[0]), swept[1].lever(balls[1])},
                         .time = first + half,
                         .half_step = half};
    for (std::size_t s = 0; s < 2; ++s) {
      heights.centres[s] = motions[s].at(first + half).pose.apply(balls[s].centre);
      if (swept[s].is_chain()) heights.accelerations[s] = swept[s].moved(balls[s]).acceleration;
    }
    const double bound = heights.bending(w, 1e-14);
    const auto height = [&](double time) {
      return dot(w, motions[1].at(time).pose.apply(points[1]) - motions[0].at(time).pose.apply(points[0]));
    };
    const double start = height(first), end = height(first + 2 * half);
    for (const double part : {0.1, 0.25, 0.5, 0.8}) {
      const double off = std::fabs(height(first + part * 2 * half) - (start + part * (end - start)));
      const double room = bound * 4 * half * half * part * (1 - part) / 2;
      ASSERT_LE(off, room * (1 + 1e-9) + 1e-11) << trial;
      if (off > 1e-6) nearest = std::max(nearest, off / room);
    }
  }
  std::cout << "  chains: off by up to " << nearest << " of the bound\n";
  EXPECT_GT(nearest, 0.5);
}

}  // namespace
}  // namespace snug::swept_motion_test
