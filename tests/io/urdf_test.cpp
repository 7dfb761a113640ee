#include <snug/robot.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <testing/files.h>

namespace snug::urdf_test {
namespace {

using testing::unreadable;

const std::string geometry = "<collision><geometry><box size='0.1 0.2 0.3'/></geometry></collision>";

std::string link(const std::string& name, const std::string& content = geometry) {
  return "<link name='" + name + "'>" + content + "</link>\n";
}
std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                  const std::string& content = "", const std::string& type = "continuous") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent + "'/><child link='" +
         child + "'/>" + content + "</joint>\n";
}
std::string robot(const std::string& content) {
  return "<?xml version='1.0'?>\n<robot name='r'>\n" + content + "</robot>\n";
}
Robot parse(const std::string& content, const RobotOptions& options = {}) {
  return parse_robot(robot(content), "dir/r.urdf", options);
}
std::string refusal(const std::string& content, const RobotOptions& options = {}) {
  return unreadable([&] { static_cast<void>(parse(content, options)); });
}

TEST(urdf, links_and_joints_are_a_tree) {
  const Robot arm = parse(joint("b", "one", "two", "<origin xyz='0 0 1' rpy='0 0 1.5'/><axis xyz='0 1 0'/>") +
                          link("two") + link("one") + link("base", "") +
                          joint("a", "base", "one", "<limit lower='-1' upper='2'/>", "prismatic") +
                          joint("c", "base", "fix", "", "fixed") + link("fix") +
                          "<transmission name='t'><link name='no'/></transmission>");
  ASSERT_EQ(arm.links.size(), 4u);
  EXPECT_EQ(arm.links[0].name, "base");
  EXPECT_FALSE(arm.links[0].joint);
  for (const Robot::Joint& own : arm.joints) EXPECT_LT(own.parent, own.child);
  EXPECT_EQ(arm.joints[0].axis.axis, (Vector3{0, 1, 0}));
  EXPECT_EQ(arm.joints[0].axis.frame.offset(), (Vector3{0, 0, 1}));
  EXPECT_NEAR(arm.joints[0].axis.frame.row(0).x, std::cos(1.5), 1e-15);
  EXPECT_TRUE(arm.joints[1].axis.slides);
  EXPECT_EQ(arm.joints[1].axis.axis, (Vector3{1, 0, 0}));
  EXPECT_EQ(arm.joints[1].upper, 2);
  EXPECT_TRUE(arm.joints[2].fixed);
  EXPECT_EQ(arm.meshes[0].metres_per_unit, 1.0);
}

TEST(urdf, a_scene_of_parts_is_sent_elsewhere) {
  for (const char* text : {"{\"parts\": []}", "\n v 0 0 0", "solid a"})
    EXPECT_EQ(unreadable([&] { static_cast<void>(parse_robot(text, "dir/r.urdf")); }),
              "dir/r.urdf: not a robot in URDF, which is XML; of parts in a scene file ask collide or "
              "distance, with --scene");
}

TEST(urdf, roll_pitch_and_yaw_turn_about_axes_that_stay) {
  const Robot one = parse(link("a") + link("b") + joint("j", "a", "b", "<origin rpy='0.3 0.4 0.5'/>"));
  const Motion wanted =
      Motion::rotation({0, 0, 1}, 0.5) * Motion::rotation({0, 1, 0}, 0.4) * Motion::rotation({1, 0, 0}, 0.3);
  for (std::size_t k = 0; k < 12; ++k)
    EXPECT_NEAR(one.joints[0].axis.frame.numbers()[k], wanted.numbers()[k], 1e-15);
}

TEST(urdf, meshes_are_found_scaled_and_shared) {
  std::vector<std::string> asked;
  RobotOptions options;
  options.packages = {{"arm", "packages/arm"}, {"", "all"}};
  options.file = [&](const std::string& path) {
    asked.push_back(path);
    return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  };
  const auto mesh = [](const std::string& file, const std::string& more = "") {
    return "<collision><origin xyz='1 2 3'/><geometry><mesh filename='" + file + "' " + more +
           "/></geometry></collision>";
  };
  const Robot arm = parse(
      link("a", mesh("package://arm/meshes/a.obj", "scale='0.001 0.001 -0.001'") +
                    mesh("package://arm/meshes/a.obj")) +
          link("b", mesh("package://other/b.obj") + mesh("m/c.obj") + mesh("package://arm/meshes/a.obj")) +
          joint("j", "a", "b"),
      options);
  EXPECT_EQ(asked, (std::vector<std::string>{"packages/arm/meshes/a.obj", "packages/arm/meshes/a.obj",
                                             "all/other/b.obj", "dir/m/c.obj"}));
  ASSERT_EQ(arm.meshes.size(), 4u);
  EXPECT_EQ(arm.links[1].shapes[2].mesh, arm.links[0].shapes[1].mesh);
  EXPECT_EQ(arm.meshes[0].points[1], (Point3{0.001, 0, 0}));
  EXPECT_EQ(arm.meshes[0].face(FaceId(0))[1], VertexId(2));  // mirrored
  EXPECT_EQ(arm.meshes[0].tags.scheme, Scheme::flat);        // of an OBJ file, too
  EXPECT_EQ(arm.links[0].shapes[0].pose, Motion::translation({1, 2, 3}));
}

TEST(urdf, paths_outside_are_refused) {
  const auto of = [](const std::string& file) {
    return link("a", "<collision><geometry><mesh filename='" + file + "'/></geometry></collision>");
  };
  RobotOptions options;
  options.packages = {{"arm", "packages/arm"}};
  options.file = [](const std::string&) -> std::string {
    throw InputError(InputProblem::unreadable, "was read");
  };
  for (const char* file : {"../a.obj", "/etc/a.obj", "file:///etc/a.obj", "m/../../a.obj"})
    EXPECT_NE(refusal(of(file), options).find("leads out of the folder of the robot"), std::string::npos)
        << file;
  for (const char* file :
       {"package://arm/../b.obj", "package://arm/a/../../b.obj", "package://../b.obj", "package://../a/b.obj",
        "package:///b.obj", "http://a/b.obj", "package://arm", "", "package://arm/%2e%2e/b.obj"}) {
    const std::string message = refusal(of(file), options);
    EXPECT_TRUE(message.starts_with("dir/r.urdf: URDF: line 3: ")) << message;
  }
  EXPECT_EQ(refusal(of("package://leg/b.obj"), options),
            "dir/r.urdf: URDF: line 3: 'package://leg/b.obj' is in a package whose folder is not known: give "
            "--package leg=FOLDER, or in Python packages={'leg': FOLDER}");
  EXPECT_EQ(refusal(of("m/a.obj"), options), "dir/r.urdf:3: was read");
  const auto beside = [&](const char* file) {  // of a robot without a folder
    return unreadable([&] { static_cast<void>(parse_robot(robot(of(file)), "r.urdf", options)); });
  };
  EXPECT_EQ(beside("m/a.obj"), "r.urdf:3: was read");
  EXPECT_NE(beside("../a.obj").find("leads out"), std::string::npos);
  options.root = ".";
  EXPECT_EQ(refusal(of("../a.obj"), options), "dir/r.urdf:3: was read");
  EXPECT_NE(refusal(of("../../a.obj"), options).find("leads out"), std::string::npos);
}

TEST(urdf, primitives_are_exact_or_outside) {
  std::vector<std::string> lines;
  RobotOptions options;
  options.notes = [&](const std::string& line) { lines.push_back(line); };
  const Robot arm = parse(
      link("a", geometry + "<collision><geometry><sphere radius='2'/></geometry></collision>"
                           "<collision><geometry><cylinder radius='1' length='3'/></geometry></collision>"),
      options);
  ASSERT_EQ(arm.links[0].shapes.size(), 3u);
  EXPECT_EQ(arm.meshes[0].points[7], (Point3{0.05, 0.1, 0.15}));
  ASSERT_EQ(arm.outward.size(), 3u);
  EXPECT_EQ(arm.outward[0], 0);
  EXPECT_GT(arm.outward[1], 1e-4);
  EXPECT_LT(arm.outward[1], 4e-3);
  EXPECT_GT(arm.outward[2], 1e-4);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_TRUE(lines[0].starts_with("dir/r.urdf: cylinders and spheres (2) are inside polyhedra")) << lines[0];
  options.visual = true;
  EXPECT_TRUE(parse(link("a"), options).links[0].shapes.empty());
}

TEST(urdf, faults_are_one_line) {
  const std::string two = link("a") + link("b");
  const std::string front = "dir/r.urdf";
  EXPECT_EQ(refusal(""), front + ": URDF: the robot has no links");
  EXPECT_EQ(refusal(link("a") + link("a")), front + ":4: URDF: the link 'a' appears twice");
  EXPECT_EQ(refusal(two),
            front + ": URDF: the links 'a' and 'b' both hang on no joint: a robot has one root");
  EXPECT_EQ(refusal(two + joint("j", "a", "c")), front + ":5: URDF: joint 'j': its child 'c' is no link");
  EXPECT_EQ(refusal(two + "<joint name='j' type='fixed'><child link='b'/></joint>"),
            front + ":5: URDF: joint 'j' has no parent");
  EXPECT_EQ(refusal(two + joint("j", "a", "b") + joint("k", "a", "b")),
            front + ":6: URDF: the link 'b' hangs on two joints, 'j' and 'k': cut one of them");
  EXPECT_EQ(refusal(link("c") + two + joint("j", "a", "b") + joint("k", "b", "a")),
            front + ": URDF: links hang on each other in a cycle: 'a', 'b': cut a joint of it");
  EXPECT_EQ(refusal(two + joint("j", "a", "b") + joint("k", "b", "a")),
            front + ": URDF: links hang on each other in a cycle: 'a', 'b': cut a joint of it");
  EXPECT_EQ(refusal(link("a") + joint("j", "a", "a")),
            front + ": URDF: links hang on each other in a cycle: 'a': cut a joint of it");
  EXPECT_EQ(
      refusal(two + joint("j", "a", "b", "", "floating")),
      front +
          ":5: URDF: joint 'j': the type 'floating' is not one of fixed, revolute, continuous and prismatic");
  EXPECT_EQ(refusal(two + joint("j", "a", "b", "<axis xyz='0 0 0'/>")),
            front + ":5: URDF: joint 'j': its axis has no length");
  EXPECT_EQ(refusal(two + joint("j", "a", "b", "<limit lower='2' upper='1'/>", "revolute")),
            front + ":5: URDF: joint 'j': its limits are reversed");
  EXPECT_EQ(refusal(two + joint("j", "a", "b", "<mimic joint='no'/>")),
            front + ":5: URDF: joint 'j' follows 'no', which is no joint");
  EXPECT_EQ(refusal(two + joint("j", "a", "b", "<mimic joint='j'/>")),
            front + ":5: URDF: joint 'j' follows a joint that is fixed or follows another one itself");
  EXPECT_EQ(refusal(two + joint("j", "a", "b", "<origin xyz='1 2'/>")),
            front + ":5: xyz has 2 numbers, not 3");
  EXPECT_EQ(refusal(link("a", "<collision><geometry><cone/></geometry></collision>")),
            front + ":3: URDF: 'cone' is not one of mesh, box, cylinder and sphere");
  EXPECT_EQ(refusal(link("a", "<collision><geometry><sphere radius='-1'/></geometry></collision>")),
            front + ":3: radius is not a positive length");
  EXPECT_EQ(refusal(link("a", "<collision/>")),
            front + ":3: URDF: the link 'a' has a shape without geometry");
  EXPECT_EQ(refusal("<xacro:macro name='a'/>"),
            front + ":3: URDF: macros are not expanded: xacro robot.xacro > robot.urdf");
  EXPECT_EQ(
      unreadable([&] { static_cast<void>(parse_robot("<!DOCTYPE r [<!ENTITY a 'b'>]><robot/>", "r.urdf")); }),
      "r.urdf:1: XML: a document type, as in <!DOCTYPE>: entities are not read; take it out");
  EXPECT_EQ(unreadable([&] { static_cast<void>(parse_robot("<sdf/>", "r.urdf")); }),
            "r.urdf:1: URDF: 'robot' is missing: this is no robot");
}

TEST(urdf, names_of_meshes_are_shown_printable) {
#ifdef _WIN32
  const std::string shown = "m/\\xef\\xbf\\xbd.xyz";  // names are UTF-8 there
#else
  const std::string shown = "m/\\xfd.xyz";
#endif
  RobotOptions options;
  options.file = [](const std::string&) { return std::string(); };
  const std::string message = refusal(
      link("a", "<collision><geometry><mesh filename='m/\xfd.xyz'/></geometry></collision>"), options);
  EXPECT_NE(message.find(shown + ": meshes are read"), std::string::npos) << message;
}

TEST(urdf, srdf_names_pairs_that_may_touch) {
  Robot arm = parse(link("a") + link("b") + joint("j", "a", "b"));
  allow_pairs(arm,
              "<robot name='r'><group name='g'><link name='a'/></group><disable_collisions link1='b' "
              "link2='a' reason='Adjacent'/></robot>",
              "r.srdf");
  ASSERT_EQ(arm.allowed.size(), 1u);
  EXPECT_EQ(arm.allowed[0], (PartPair{1, 0}));
  EXPECT_EQ(unreadable([&] {
              allow_pairs(arm, "<robot><disable_collisions link1='c' link2='a'/></robot>", "r.srdf");
            }),
            "r.srdf:1: SRDF: the robot has no link 'c'");
}

TEST(urdf, srdf_disables_links_and_has_groups) {
  const Robot plain = parse(link("a") + link("b") + link("c") + link("d") + joint("ab", "a", "b") +
                            joint("bc", "b", "c") + joint("ad", "a", "d"));
  const auto with = [&](const std::string& body) {
    Robot robot = plain;
    allow_pairs(robot, "<robot>" + body + "</robot>", "r.srdf");
    return robot;
  };
  const auto index = [&](const char* name) {
    return static_cast<std::uint32_t>(std::ranges::find(plain.links, name, &Robot::Link::name) -
                                      plain.links.begin());
  };
  Robot robot = with("<disable_default_collisions link='c'/><enable_collisions link1='d' link2='c'/>");
  EXPECT_EQ(robot.allowed.size(), 2u);
  for (const PartPair& pair : robot.allowed) {
    EXPECT_EQ(pair.a, index("c"));
    EXPECT_NE(pair.b, index("d"));
  }
  robot = with(
      "<group name='all'><group name='arm'/><link name='d'/></group>"
      "<group name='arm'><chain base_link='a' tip_link='c'/></group><group name='one'><joint "
      "name='ad'/></group>"
      "<group_state name='home' group='arm'><joint name='ab' value='0'/></group_state>");
  ASSERT_EQ(robot.groups.size(), 3u);
  EXPECT_EQ(robot.groups["arm"], (std::vector{index("b"), index("c")}));
  EXPECT_EQ(robot.groups["all"].size(), 3u);
  EXPECT_EQ(robot.groups["one"], std::vector{index("d")});
  const auto refusal_of = [&](const std::string& body) {
    return unreadable([&] { static_cast<void>(with(body)); });
  };
  EXPECT_EQ(refusal_of("<group name='g'><link name='x'/></group>"),
            "r.srdf:1: SRDF: the robot has no link 'x'");
  EXPECT_EQ(refusal_of("<group name='g'><joint name='x'/></group>"),
            "r.srdf:1: SRDF: the robot has no joint 'x'");
  EXPECT_EQ(refusal_of("<group name='g'><group name='x'/></group>"), "r.srdf:1: SRDF: there is no group 'x'");
  EXPECT_EQ(refusal_of("<group name='g'><group name='h'/></group><group name='h'><group name='g'/></group>"),
            "r.srdf:1: SRDF: the group 'g' contains itself");
  EXPECT_EQ(refusal_of("<group name='g'><chain base_link='d' tip_link='c'/></group>"),
            "r.srdf:1: SRDF: no chain leads from 'd' down to 'c'");
  std::string bomb;
  for (int k = 0; k < 300; ++k) {
    bomb += "<group name='g" + std::to_string(k) + "'>";
    for (int twice = 0; twice < 2 && k < 299; ++twice)
      bomb += "<group name='g" + std::to_string(k + 1) + "'/>";
    bomb += "<link name='a'/></group>";
  }
  EXPECT_EQ(with(bomb).groups.size(), 300u);
  for (int k = 300; k < 1001; ++k) bomb += "<group name='g" + std::to_string(k) + "'/>";
  EXPECT_EQ(refusal_of(bomb), "r.srdf:1: SRDF: more than 1000 groups");
}

}  // namespace
}  // namespace snug::urdf_test
