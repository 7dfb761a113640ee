#include <snug/robot.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <snug/distance.h>
#include <snug/surface.h>
#include <support/error.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>

namespace snug::robot_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

constexpr double pi = std::numbers::pi;

// Three links of 1, 0.2 thick, in a row along x; joints turn about z.
std::string arm_text(const std::string& more = "") {
  const auto link = [](const std::string& name) {
    return "<link name='" + name +
           "'><collision><origin xyz='0.5 0 0'/><geometry><box size='0.9 0.2 "
           "0.2'/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& name, const std::string& a, const std::string& b,
                        const std::string& rest) {
    return "<joint name='" + name + "' type='revolute'><parent link='" + a + "'/><child link='" + b +
           "'/><axis xyz='0 0 1'/><limit lower='-3.2' upper='3.2'/>" + rest + "</joint>";
  };
  return "<robot name='arm'>" + link("base") + link("upper") + link("lower") + link("hand") +
         joint("shoulder", "base", "upper", "<origin xyz='1 0 0'/>") +
         joint("elbow", "upper", "lower", "<origin xyz='1 0 0'/>") +
         joint("wrist", "lower", "hand", "<origin xyz='1 0 0'/>") + more + "</robot>";
}
Robot arm(const std::string& more = "") { return parse_robot(arm_text(more), "arm.urdf"); }

std::vector<double> at(const Robot& robot, double shoulder, double elbow, double wrist) {
  const std::vector<std::pair<std::string, double>> given{
      {"shoulder", shoulder}, {"elbow", elbow}, {"wrist", wrist}};
  return joint_positions(robot, given);
}

TEST(robot, positions_have_names_limits_and_followers) {
  const Robot robot = arm(
      "<link name='finger'/><joint name='grip' type='continuous'><parent link='hand'/><child link='finger'/>"
      "<axis xyz='1 0 0'/><mimic joint='wrist' multiplier='-2' offset='0.5'/></joint>");
  const std::vector<double> found = at(robot, 0.1, 0.2, 0.3);
  EXPECT_EQ(found, (std::vector<double>{0.1, 0.2, 0.3, -2 * 0.3 + 0.5}));
  const auto refused = [&](const std::string& name, double value, const std::string& part) {
    const std::vector<std::pair<std::string, double>> given{{name, value}};
    try {
      static_cast<void>(joint_positions(robot, given));
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused("knee", 0, "no joint is called 'knee'");
  refused("elbow", 4, "is at 4, beyond its limits -3.2 to 3.2");
  refused("elbow", NAN, "not finite");
  refused("grip", 0, "follows another joint");
}

TEST(robot, wrong_lists_and_links_are_refused) {
  const Robot robot = arm();
  const std::vector<double> few{0.1}, all = at(robot, 0, 0, 0);
  EXPECT_THROW(static_cast<void>(link_poses(robot, few)), InputError);
  EXPECT_THROW(static_cast<void>(common_link(robot, 0, 4)), InputError);
  for (const auto& path : {std::vector{few, few}, std::vector{all, few}, std::vector<std::vector<double>>{}})
    EXPECT_THROW(static_cast<void>(link_motions(robot, {0, {}}, {3, {}}, path)), InputError);
  EXPECT_THROW(static_cast<void>(link_motions(robot, {0, {}}, {9, {}}, std::vector{all, all})), InputError);
}

TEST(robot, links_that_are_joined_are_left_out) {
  const Robot robot =
      arm("<link name='tool'><collision><geometry><box size='1 1 1'/></geometry></collision></link><joint "
          "name='mount' type='fixed'><parent link='hand'/><child link='tool'/></joint>");
  const auto names = [&](const std::vector<PartPair>& pairs) {
    std::string text;
    for (const PartPair& pair : pairs)
      text += robot.links[pair.a].name + '-' + robot.links[pair.b].name + ' ';
    return text;
  };
  EXPECT_EQ(names(pairs_to_check(robot)), "base-lower base-hand base-tool upper-hand upper-tool ");
  EXPECT_EQ(pairs_to_check(robot, true).size(), 9u);  // all but hand and tool
  Robot other = robot;
  allow_pairs(other, "<robot><disable_collisions link1='tool' link2='base'/></robot>", "a.srdf");
  EXPECT_EQ(names(pairs_to_check(other)), "base-lower base-hand upper-hand upper-tool ");
  allow_pairs(other, "<robot><group name='g'><link name='hand'/></group></robot>", "a.srdf");
  EXPECT_EQ(names(pairs_to_check(other, false, "g")), "base-hand upper-hand ");
  EXPECT_THROW(static_cast<void>(pairs_to_check(other, false, "h")), InputError);
}

TEST(robot, motions_in_a_common_frame_are_those_of_the_world) {
  std::mt19937_64 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    Robot robot;
    const std::size_t count = 3 + random() % 6;
    robot.links.resize(count);
    for (std::uint32_t l = 1; l < count; ++l) {
      const auto parent = static_cast<std::uint32_t>(random() % l);
      robot.links[l].joint = l - 1;
      Robot::Joint joint{.name = "j" + std::to_string(l), .parent = parent, .child = l};
      joint.axis = {random_placement(random, random_vector(random, 1)), random_vector(random, 1),
                    random() % 3 == 0};
      joint.fixed = random() % 4 == 0;
      robot.joints.push_back(joint);
    }
    std::vector<std::vector<double>> path(3, std::vector<double>(count - 1));
    for (auto& list : path) {
      for (double& x : list) x = 4 * unit(random) - 2;
    }
    const auto a = static_cast<std::uint32_t>(random() % count),
               b = static_cast<std::uint32_t>(random() % count);
    const Motion own_a = random_placement(random, random_vector(random, 1)),
                 own_b = random_placement(random, {});
    const auto [motion_a, motion_b] = link_motions(robot, {a, own_a}, {b, own_b}, path);
    for (const double time : {0.0, 0.25, 1.0, 1.7, 2.0}) {
      std::vector<double> positions(count - 1);
      const auto i = std::min<std::size_t>(static_cast<std::size_t>(time), 1);
      const double s = time - static_cast<double>(i);
      for (std::size_t j = 0; j + 1 < count; ++j) positions[j] = (1 - s) * path[i][j] + s * path[i + 1][j];
      const std::vector<Motion> poses = link_poses(robot, positions);
      const Motion common = poses[common_link(robot, a, b)];
      const Motion world_a = common * motion_a.at(motion_a.duration() > 0 ? time : 0),
                   world_b = common * motion_b.at(motion_b.duration() > 0 ? time : 0);
      for (std::size_t k = 0; k < 12; ++k) {
        ASSERT_NEAR(world_a.numbers()[k], (poses[a] * own_a).numbers()[k], 1e-12);
        ASSERT_NEAR(world_b.numbers()[k], (poses[b] * own_b).numbers()[k], 1e-12);
      }
    }
  }
}

// The hand folds back onto the base, whose end stands at x = 0.95: its own far corner comes there first.
TEST(robot, first_contacts_along_a_path_are_where_geometry_puts_them) {
  const Robot robot = arm();
  std::vector<Surface> surfaces;
  for (const ControlMesh& mesh : robot.meshes) surfaces.emplace_back(mesh);
  const auto ask = [&](const std::string& a, const std::string& b,
                       const std::vector<std::vector<double>>& path) {
    const LinkContactsOptions fine{.tolerance = [](double) { return 1e-6; }, .joined = true};
    for (const LinkContact& each : first_contacts(robot, surfaces, path, fine)) {
      if (each.a == a && each.b == b) return each.answer;
    }
    ADD_FAILURE() << a << ' ' << b;
    return TimeOfContact();
  };
  // The elbow turns the lower link over the upper one: a corner of the lower one, (0.05, -0.1) in its frame, never comes there,
  // but its side y = -0.1... turned by the angle t meets the corner (-0.05, 0.1) of the upper link, as that end is seen from
  // the elbow: the distance of the corner from the elbow is r, and it meets the side of height 0.1 where r sin(.) = 0.1.
  const TimeOfContact over = ask("upper", "lower", {at(robot, 0, 0, 0), at(robot, 0, pi, 0)});
  EXPECT_EQ(over.verdict, Verdict::intersecting);
  // From the elbow the corner of the upper link is at the angle pi - atan(2), the corner of the lower one at atan(2) turned by
  // t; both are as far away, so they meet where t = pi - 2 atan(2).
  const double wanted = (pi - 2 * std::atan2(0.1, 0.05)) / pi;
  EXPECT_LE(over.time.lower, wanted + 1e-9);
  EXPECT_GE(over.time.upper, wanted - 1e-9);
  EXPECT_LT(over.time.upper - over.time.lower, 1e-4);
  // All turn as one: links keep their places against each other.
  const TimeOfContact rigid = ask("upper", "hand", {at(robot, 0, 0.4, 0.3), at(robot, 3, 0.4, 0.3)});
  EXPECT_EQ(rigid.verdict, Verdict::separated);
  EXPECT_EQ(rigid.time.lower, 1);  // the path's end, as for links that move
  // Two joints, against looks at many times.
  const std::vector<std::vector<double>> path{at(robot, 0, 0, 0), at(robot, 0, 2.6, 2.2)};
  const TimeOfContact two = ask("base", "hand", path), one = ask("upper", "hand", path);
  for (const auto& [answer, name] : {std::pair{two, "base"}, {one, "upper"}}) {
    double first = INFINITY;
    for (int i = 0; i <= 2000; ++i) {
      std::vector<double> positions(3);
      for (std::size_t j = 0; j < 3; ++j) positions[j] = path[1][j] * i / 2000.0;
      const std::vector<Motion> poses = link_poses(robot, positions);
      const auto of = [&](const char* link_name) {
        const auto l = static_cast<std::size_t>(
            std::ranges::find(robot.links, link_name, &Robot::Link::name) - robot.links.begin());
        return surfaces[robot.links[l].shapes[0].mesh].at(poses[l] * robot.links[l].shapes[0].pose);
      };
      if (distance(of(name), of("hand")).distance.upper < 1e-7) {
        first = i / 2000.0;
        break;
      }
    }
    if (first == INFINITY) {
      EXPECT_NE(answer.verdict, Verdict::intersecting) << name;
    } else {
      EXPECT_LE(answer.time.lower, first) << name;
      EXPECT_GE(answer.time.upper, first - 1 / 1999.0) << name;
    }
  }
}

TEST(robot, first_contacts_of_all_pairs_are_those_of_each) {
  const auto link = [](const std::string& name, const std::string& shapes) {
    return "<link name='" + name + "'>" + shapes + "</link>";
  };
  const auto shape = [](double x, const std::string& geometry) {
    return "<collision><origin xyz='" + std::to_string(x) + " 0 0'/><geometry>" + geometry +
           "</geometry></collision>";
  };
  const std::string box = "<box size='0.9 0.2 0.2'/>";
  const Robot robot = parse_robot(
      "<robot name='arm'>" + link("base", shape(0.5, box)) + link("upper", shape(0.5, box)) +
          link("hand", shape(0.3, "<sphere radius='0.1'/>") + shape(0.7, "<box size='0.2 0.2 0.2'/>")) +
          "<joint name='shoulder' type='revolute'><parent link='base'/><child link='upper'/><origin xyz='1 0 "
          "0'/>"
          "<axis xyz='0 0 1'/><limit lower='-4' upper='4'/></joint><joint name='elbow' "
          "type='revolute'><parent "
          "link='upper'/><child link='hand'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/><limit lower='-4' "
          "upper='4'/></joint></robot>",
      "arm.urdf");
  std::vector<Surface> surfaces;
  for (const ControlMesh& mesh : robot.meshes) surfaces.emplace_back(mesh);
  const std::vector<std::vector<double>> path{{0, 0}, {2.3, 2.3}, {2.8, 1.9}};
  for (const auto& [threads, share] : {std::pair{1, 0.0}, {3, 0.05}}) {
    const LinkContactsOptions options{.margin = [share = share](double size) { return share * size; },
                                      .joined = true};
    std::atomic<int> reports{0};
    const WorkMonitor monitor{.on_progress = [&](double done) { reports += done > 0 && done <= 1; }};
    const std::vector<LinkContact> found =
        first_contacts(robot, surfaces, path, options, {.threads = threads, .monitor = &monitor});
    ASSERT_EQ(found.size(), 5u);
    EXPECT_EQ(reports, 5);
    EXPECT_EQ(found[1].a + ' ' + found[1].b + ' ' + found[1].frame, "base hand#1 base");
    EXPECT_EQ(found[4].a + ' ' + found[4].b + ' ' + found[4].frame, "upper hand#2 upper");
    const auto &base = robot.links[0].shapes[0], &ball = robot.links[2].shapes[0],
               &block = robot.links[2].shapes[1];
    // The ball is inside of its mesh, whose contact is nearness.
    for (const auto& [answer, own] : {std::pair{found[1], ball}, {found[2], block}}) {
      const auto [a, b] = link_motions(robot, {0, base.pose}, {2, own.pose}, path);
      const double size = std::max(surfaces[base.mesh].size(), surfaces[own.mesh].size());
      const TimeOfContact alone =
          time_of_contact(surfaces[base.mesh], a, surfaces[own.mesh], b, {.margin = share * size});
      EXPECT_EQ(alone.verdict, share == 0 ? Verdict::intersecting : Verdict::within);
      EXPECT_EQ(answer.answer.verdict, own.mesh == ball.mesh ? Verdict::within : alone.verdict);
      EXPECT_EQ(answer.answer.time, alone.time);
      EXPECT_EQ(answer.placed[1].pose(), b.at(alone.time.upper));
    }
  }
  EXPECT_EQ(first_contacts(robot, surfaces, path).size(), 2u);
  EXPECT_THROW(static_cast<void>(first_contacts(robot, {}, path)), InputError);
  EXPECT_THROW(static_cast<void>(first_contacts(robot, surfaces, {})), InputError);
}

TEST(robot, where_nothing_moves_contact_is_proved_too) {
  const Robot robot = arm();
  const Surface box(robot.meshes[0]);
  const Motion across = Motion::rotation({1, 0, 0}, 0.5) * Motion::rotation({0, 0, 1}, 1.2);
  EXPECT_EQ(time_of_contact(box, Motion(), box, across).verdict, Verdict::intersecting);
  EXPECT_EQ(time_of_contact(box, Motion(), box, across).time, Interval(0));
  EXPECT_EQ(time_of_contact(box, Motion(), box, across.with_offset({0, 0, 3})).verdict, Verdict::separated);
}

}  // namespace
}  // namespace snug::robot_test
