#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "run_snug.h"
#include "scene_testing.h"

namespace snug::testing::robot_scene_test {
namespace {

// Three links in a row along x, 1 long and 0.2 thick; joints turn about z.
std::string arm(const TemporaryFolder& folder) {
  std::string text = "<robot name='arm'>";
  for (const std::string name : {"base", "upper", "lower"}) {
    text += "<link name='" + name +
            "'><collision><origin xyz='0.5 0 0'/><geometry><box size='0.9 0.2 "
            "0.2'/></geometry></collision></link>";
  }
  for (const auto& [name, a, b] : {std::tuple{"shoulder", "base", "upper"}, {"elbow", "upper", "lower"}}) {
    text += std::string("<joint name='") + name + "' type='revolute'><parent link='" + a +
            "'/><child link='" + b +
            "'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/><limit lower='-3.2' upper='3.2'/></joint>";
  }
  return write_text(folder.file("arm.urdf"), text + "</robot>");
}

TEST(robot_scene, links_meet_where_they_stand) {
  const TemporaryFolder folder;
  const std::string robot = arm(folder);
  const Outcome straight = run_snug({"scene", robot, "--exit-code"});
  EXPECT_EQ(straight.status, 0) << straight.err;
  EXPECT_NE(straight.out.find("1 pairs of shapes, 1 separated"), std::string::npos) << straight.out;
  const Outcome folded =
      run_snug({"scene", robot, "--joints", "shoulder=140deg elbow=140deg", "--exit-code"});
  EXPECT_EQ(folded.status, 11) << folded.out << folded.err;
  EXPECT_NE(folded.out.find("base lower intersecting"), std::string::npos) << folded.out;
}

TEST(robot_scene, first_contacts_along_a_path_have_times) {
  const TemporaryFolder folder;
  const std::string robot = arm(folder);
  const std::string path =
      write_text(folder.file("path.txt"), "# a fold\nshoulder elbow\n0 0\n70deg, 70deg\n140deg 140deg\n");
  const Outcome outcome = run_snug({"scene", robot, "--path", path, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json found = Json::parse(outcome.out);
  EXPECT_EQ(found["duration"], 2.0);
  EXPECT_EQ(found["joints"], (Json{"shoulder", "elbow"}));
  ASSERT_EQ(found["results"].size(), 1u);
  const Json& result = found["results"][0];
  EXPECT_EQ(result["frame"], "base");
  EXPECT_EQ(result["verdict"], "intersecting");
  EXPECT_GT(result["time"][0], 1.0);
  EXPECT_LT(result["time"][1], 2.0);
  const Json near = Json::parse(run_snug({"scene", robot, "--path", path, "--margin", "5cm", "--json"}).out);
  EXPECT_EQ(near["results"][0]["verdict"], "within");
  EXPECT_LT(near["results"][0]["time"][1], result["time"][0]);
  const std::string srdf = write_text(
      folder.file("arm.srdf"), "<robot name='arm'><disable_collisions link1='lower' link2='base'/></robot>");
  EXPECT_EQ(
      Json::parse(run_snug({"scene", robot, "--path", path, "--srdf", srdf, "--json"}).out)["results"].size(),
      0u);
  EXPECT_EQ(Json::parse(run_snug({"scene", robot, "--joined", "--json"}).out)["results"].size(), 3u);
}

TEST(robot_scene, contact_of_a_sphere_s_polyhedron_is_nearness) {
  const TemporaryFolder folder;
  const auto robot = [&](const std::string& shape) {
    return write_text(
        folder.file("r.urdf"),
        "<robot name='r'><link name='a'><collision><geometry><box size='1 1 "
        "1'/></geometry></collision></link><link name='m'/>"
        "<link name='b'><collision><origin xyz='0.9 0 0'/><geometry>" +
            shape +
            "</geometry></collision></link><joint name='i' type='continuous'><parent link='a'/><child "
            "link='m'/></joint><joint name='j' type='continuous'><parent link='m'/><child "
            "link='b'/></joint></robot>");
  };
  EXPECT_EQ(run_snug({"scene", robot("<sphere radius='0.5'/>"), "--exit-code"}).status, 10);
  EXPECT_EQ(run_snug({"scene", robot("<box size='1 0.5 0.5'/>"), "--exit-code"}).status, 11);
  EXPECT_EQ(run_snug({"scene", robot("<sphere radius='0.39'/>"), "--exit-code"}).status, 0);
}

TEST(robot_scene, faults_are_one_line) {
  const TemporaryFolder folder;
  const std::string robot = arm(folder);
  const auto refused = [](const std::vector<std::string>& arguments, int status, const std::string& text) {
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  };
  refused({"scene", robot, "--joints", "knee=1"}, 4, "no joint is called 'knee'");
  refused({"scene", robot, "--joints", "elbow"}, 2, "is not NAME=POSITION");
  refused({"scene", robot, "--joints", "elbow=4"}, 4, "beyond its limits");
  refused({"scene", robot, "--path", write_text(folder.file("a.txt"), "elbow\n1 2\n")}, 3,
          "a.txt:2: 2 positions for 1 joints");
  refused({"scene", robot, "--path", write_text(folder.file("b.txt"), "elbow\n1\n")}, 3, "two or more lines");
  refused({"scene", folder.file("none.urdf")}, 3, "none.urdf");
  refused({"scene", folder.file("assembly.json")}, 2, "take it by --scene; this command takes robots");
  const std::string missing = write_text(folder.file("m.urdf"),
                                         "<robot name='r'><link name='a'><collision><geometry><mesh "
                                         "filename='no.stl'/></geometry></collision></link></robot>");
  refused({"scene", missing}, 3, "no.stl");
}

}  // namespace
}  // namespace snug::testing::robot_scene_test
