// Trajectories against their definition in 160-bit intervals, and bounds of speed against what points move.

#include <snug/query/trajectory.h>

#include <gtest/gtest.h>
#include <oracle/contact_time_twin.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace snug::trajectory_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

oracle::Point plain(const Vector3& v) { return {v.x, v.y, v.z}; }

oracle::TwinScrew twin_of(const Trajectory::Piece& piece) {
  oracle::TwinScrew twin{piece.from.numbers(),  plain(piece.axis),    plain(piece.about - Point3{}),
                         plain(piece.velocity), plain(piece.turning), piece.radians,
                         std::nullopt};
  if (piece.ends) twin.to = piece.to.numbers();
  return twin;
}

// Of every kind, and of every size of rotation and of translation.
Trajectory any_motion(std::mt19937_64& random) {
  const double far = std::exp2(static_cast<double>(random() % 40) - 20);
  const Motion from = random_placement(random, random_vector(random, far));
  const double angle = std::exp2(-static_cast<double>(random() % 60)) * 3.1 * unit(random);
  const Vector3 axis = random_vector(random, 1), way = random_vector(random, far);
  switch (random() % 4) {
    case 0:
      return Trajectory::steady(from, {way, axis, random() % 2 ? angle : 40 * unit(random) - 20,
                                       Point3{} + random_vector(random, far)});
    case 1:
      return Trajectory::steady(from, {way, {0, 0, 1}, 0, {}});
    case 2: {
      const Motion turn = Motion::rotation(axis, angle);
      return Trajectory::screw(from, Motion::translation(way) * turn * from);
    }
    default:
      return Trajectory::screw(from, random_placement(random, way));
  }
}

// --- chains

oracle::TwinChain twin_chain(const Trajectory::Piece& piece) {
  oracle::TwinChain twin{{}, piece.tip.numbers(), piece.from.numbers(), piece.to.numbers()};
  for (const auto& path : piece.chain) {
    twin.joints.push_back(
        {path.joint.frame.numbers(), plain(path.joint.axis), path.joint.slides, path.from, path.to});
  }
  return twin;
}

// One to seven joints that turn, slide, or stay; with frames of any size, and on each other.
Trajectory any_chain(std::mt19937_64& random) {
  const double far = std::exp2(static_cast<double>(random() % 20) - 10);
  std::vector<ChainJoint> chain(1 + random() % 7);
  std::vector<std::vector<double>> positions(2);
  for (ChainJoint& joint : chain) {
    joint.frame = random() % 4 == 0 ? Motion() : random_placement(random, random_vector(random, far));
    joint.axis = random() % 3 == 0 ? Vector3{0, 0, 1} : random_vector(random, random() % 2 ? 1 : 1e-3);
    joint.slides = random() % 4 == 0;
    const double size = joint.slides ? far : std::array{3.0, 0.1, 1e-7, 40.0}[random() % 4];
    positions[0].push_back(random() % 4 == 0 ? 0 : size * (2 * unit(random) - 1));
    positions[1].push_back(random() % 4 == 0 ? positions[0].back() : size * (2 * unit(random) - 1));
  }
  return Trajectory::joints(
      chain, random() % 4 == 0 ? Motion() : random_placement(random, random_vector(random, far)), positions);
}

TEST(trajectory, poses_of_chains_are_as_near_to_the_exact_ones_as_they_say) {
  std::mt19937_64 random(11);
  double widest = 0, closing = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const Trajectory motion = any_chain(random);
    const PieceMotion piece(motion.pieces()[0]);
    const double s = random() % 8 == 0 ? static_cast<double>(random() % 2) : unit(random);
    const BoundedPose found = piece.at(s);
    const auto errors = oracle::placement_errors(twin_chain(motion.pieces()[0]), s, found.pose.numbers());
    double far = 1;
    for (std::size_t i = 0; i < 3; ++i) far = std::max(far, std::fabs(found.pose.numbers()[4 * i + 3]));
    for (std::size_t k = 0; k < 12; ++k) {
      ASSERT_LE(errors[k], found.error[k] + 1e-30) << trial << ' ' << k;
      widest = std::max(widest, found.error[k] / far);
    }
    closing = std::max(closing, piece.closing_growth());
  }
  EXPECT_LT(widest, 1e-10);   // slides of other sizes than places
  EXPECT_LT(closing, 1e-10);  // seven joints of up to six turns
}

TEST(trajectory, chains_begin_and_end_where_their_joints_take_them) {
  std::mt19937_64 random(12);
  // An elbow: two links of length 2 and 1 in a plane.
  const std::vector<ChainJoint> elbow{{}, {.frame = Motion::translation({2, 0, 0})}};
  const std::vector<std::vector<double>> path{
      {0, 0}, {std::numbers::pi / 2, 0}, {std::numbers::pi / 2, -std::numbers::pi / 2}};
  const Trajectory motion = Trajectory::joints(elbow, Motion::translation({1, 0, 0}), path);
  EXPECT_EQ(motion.duration(), 2);
  const auto at = [&](double time) { return motion.at(time).apply({0, 0, 0}); };
  EXPECT_NEAR(distance(at(0), {3, 0, 0}), 0, 1e-15);
  EXPECT_NEAR(distance(at(1), {0, 3, 0}), 0, 1e-15);
  EXPECT_NEAR(distance(at(2), {1, 2, 0}), 0, 1e-15);
  EXPECT_NEAR(distance(at(0.5), {3 * std::sqrt(0.5), 3 * std::sqrt(0.5), 0}), 0, 1e-15);
  EXPECT_EQ(motion.pieces()[0].to, motion.pieces()[1].from);
  // One joint is a steady rotation.
  const Motion tip = random_placement(random, {1, 2, 3});
  const Trajectory one = Trajectory::joints(std::vector<ChainJoint>{{.axis = {1, 2, -1}}}, tip,
                                            std::vector<std::vector<double>>{{0}, {1.5}}),
                   steady = Trajectory::steady(tip, {{}, {1, 2, -1}, 1.5, {}});
  for (double s = 0; s <= 1; s += 0.125) {
    for (std::size_t k = 0; k < 12; ++k)
      EXPECT_NEAR(one.at(s).numbers()[k], steady.at(s).numbers()[k], 1e-14);
  }
  // A single list of positions is a pose.
  EXPECT_EQ(Trajectory::joints(elbow, {}, std::vector<std::vector<double>>{{0.5, 1}}).duration(), 0);
}

TEST(trajectory, chains_that_are_none_are_refused) {
  const std::vector<ChainJoint> one(1), bad{{.axis = {0, 0, 0}}};
  using Lists = std::vector<std::vector<double>>;
  EXPECT_THROW(static_cast<void>(Trajectory::joints(one, {}, Lists{})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::joints(one, {}, Lists{{0}, {0, 1}})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::joints(one, {}, Lists{{0}, {NAN}})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::joints(one, {}, Lists{{0}, {1e10}})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::joints(bad, {}, Lists{{0}, {1}})), InputError);
}

// Differences of the twin's places against the bounds: nearly met where one joint moves.
TEST(trajectory, no_point_of_a_chain_is_faster_than_the_bound) {
  std::mt19937_64 random(13);
  double best = 0;
  for (int trial = 0; trial < 600; ++trial) {
    ControlMesh mesh =
        testing::turned(testing::box({-1, -1, -1}, {1.5, 2, 1}, true), random, false, 3 * unit(random));
    const LimitSurface surface(mesh, {Scheme::flat}, std::make_shared<BoundsCache>());
    const SurfaceBvh model(surface);
    const Trajectory motion = any_chain(random);
    const oracle::TwinChain twin = twin_chain(motion.pieces()[0]);
    const double bound = PieceMotion(motion.pieces()[0]).speed(model);
    const long double s = unit(random) * (1 - 1e-3L), ds = 1e-4L;
    const auto before = oracle::placement_of(twin, s), after = oracle::placement_of(twin, s + ds);
    double fastest = 0;
    for (const Point3& p : mesh.points) {
      long double sum = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        long double way = after[4 * i + 3] - before[4 * i + 3];
        for (std::size_t j = 0; j < 3; ++j) way += (after[4 * i + j] - before[4 * i + j]) * p[j];
        sum += way * way;
      }
      fastest = std::max(fastest, static_cast<double>(std::sqrt(sum) / ds));
    }
    ASSERT_LE(fastest, bound * (1 + 1e-9) + 1e-10) << trial;
    if (bound > 1e-6) best = std::max(best, fastest / bound);
  }
  EXPECT_GT(best, 0.98);
}

TEST(trajectory, poses_are_as_near_to_the_exact_ones_as_they_say) {
  std::mt19937_64 random(1);
  double widest = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Trajectory motion = any_motion(random);
    const PieceMotion piece(motion.pieces()[0]);
    const double s = random() % 8 == 0 ? static_cast<double>(random() % 2) : unit(random);
    const BoundedPose found = piece.at(s);
    const auto errors = oracle::placement_errors(twin_of(motion.pieces()[0]), s, found.pose.numbers());
    for (std::size_t k = 0; k < 12; ++k) {
      ASSERT_LE(errors[k], found.error[k] + 1e-30) << trial << ' ' << k;
      if (k % 4 != 3) widest = std::max(widest, found.error[k]);
    }
    // Points move by no more than the deviation of that reach.
    const double reach = std::exp2(static_cast<double>(random() % 20) - 10);
    double farthest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double off = (errors[4 * i] + errors[4 * i + 1] + errors[4 * i + 2]) * reach + errors[4 * i + 3];
      farthest += off * off;
    }
    ASSERT_LE(std::sqrt(farthest), found.deviation(reach) * (1 + 1e-12) + 1e-26);
  }
  EXPECT_LT(widest, 1e-13);  // twenty turns
}

TEST(trajectory, screws_and_paths_begin_and_end_exactly_where_they_say) {
  std::mt19937_64 random(2);
  std::vector<Motion> poses;
  for (int i = 0; i < 6; ++i) poses.push_back(random_placement(random, random_vector(random, 3)));
  const Trajectory path = Trajectory::through(poses);
  EXPECT_EQ(path.duration(), 5);
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(path.at(static_cast<double>(i)), poses[i]);
  // Loosely rigid poses are met exactly, too, and what is between is rigid.
  Motion loose = Motion::from_3x4({1 + 4e-10, 0, 0, 1, 0, 1 - 4e-10, 0, 0, 0, 0, 1, 0});
  const Trajectory to_loose = Trajectory::screw(loose, poses[0]);
  EXPECT_EQ(to_loose.at(0), loose);
  EXPECT_EQ(to_loose.at(1), poses[0]);
  for (double s = 0; s <= 1; s += 1.0 / 64) EXPECT_LE(to_loose.at(s).defect(), 1e-9);
}

TEST(trajectory, screws_have_a_constant_twist_and_the_shorter_rotation) {
  std::mt19937_64 random(3);
  for (int trial = 0; trial < 200; ++trial) {
    const Motion from = random_placement(random, random_vector(random, 2)),
                 to = random_placement(random, random_vector(random, 2));
    const Trajectory motion = Trajectory::screw(from, to);
    EXPECT_LE(motion.pieces()[0].radians, std::numbers::pi);
    // Of a quarter of the time it is the same motion of space, whenever that quarter begins.
    const Motion first = motion.at(0.25) * motion.at(0).inverse();
    for (const double s : {0.25, 0.5, 0.75}) {
      const Motion later = motion.at(std::min(1.0, s + 0.25)) * motion.at(s).inverse();
      for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(first.numbers()[k], later.numbers()[k], 1e-13);
    }
  }
}

TEST(trajectory, half_a_turn_is_refused_and_a_little_less_is_not) {
  const auto turn = [](double degrees) { return Motion::rotation_degrees({1, 2, -1}, degrees); };
  EXPECT_THROW(static_cast<void>(Trajectory::screw({}, turn(180))), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::through(std::vector<Motion>{{}, turn(90), turn(270)})),
               InputError);
  for (const double degrees : {179.999, -179.999, 179.99999, 1e-7, 0.0}) {
    const Trajectory motion = Trajectory::screw({}, turn(degrees));
    EXPECT_NEAR(motion.pieces()[0].radians, std::fabs(degrees) * std::numbers::pi / 180, 1e-12);
    const Motion half = motion.at(0.5), expected = turn(degrees / 2);
    for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(half.numbers()[k], expected.numbers()[k], 1e-10);
  }
}

TEST(trajectory, what_is_no_motion_is_refused) {
  EXPECT_THROW(static_cast<void>(Trajectory::through({})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::steady({}, {{NAN, 0, 0}})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::steady({}, {{}, {0, 0, 0}, 1})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::steady({}, {{}, {0, 0, 1}, INFINITY})), InputError);
  EXPECT_THROW(static_cast<void>(Trajectory::steady({}, {}).at(1.5)), InputError);
  EXPECT_EQ(Trajectory(Motion::translation({1, 2, 3})).at(17), Motion::translation({1, 2, 3}));
}

TEST(trajectory, no_point_is_faster_than_the_bound_and_some_are_nearly_as_fast) {
  std::mt19937_64 random(4);
  double best = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const Point3 high{0.1 + unit(random), 0.1 + 3 * unit(random), 0.1 + unit(random)};
    ControlMesh mesh =
        testing::turned(testing::box({-1, -1, -1}, high, true), random, false, 3 * unit(random));
    const LimitSurface surface(mesh, {Scheme::flat}, std::make_shared<BoundsCache>());
    const SurfaceBvh model(surface);
    const Trajectory motion = any_motion(random);
    const PieceMotion piece(motion.pieces()[0]);
    const double bound = piece.speed(model);
    const double s = std::min(unit(random), 1 - 1.0 / 64), ds = 1.0 / 64;
    const Motion before = motion.at(s), after = motion.at(s + ds);
    double fastest = 0;
    for (const Point3& p : mesh.points) {
      fastest = std::max(fastest, distance(before.apply(p), after.apply(p)) / ds);
    }
    const double noise = 1e-13 * (1 + max_abs(before.offset()) + max_abs(after.offset())) / ds;
    ASSERT_LE(fastest, bound * (1 + 1e-12) + noise) << trial;
    if (bound > 1e3 * noise) best = std::max(best, fastest / bound);
  }
  EXPECT_GT(best, 0.99);
}

}  // namespace
}  // namespace snug::trajectory_test
