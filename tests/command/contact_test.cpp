// contact, as people script it.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::contact_test {
namespace {

using nlohmann::json;

class contact : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(cube_) << cube(0); }
  // With so much added to x where it is not 1.
  static std::string cube(double x) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      text += "v " + std::to_string((i & 1) != 0 ? 1 : x) + " " + std::to_string(i >> 1 & 1) + " " +
              std::to_string(i >> 2) + "\n";
    }
    return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  [[nodiscard]] json answer(std::vector<std::string> arguments, int status = 0) const {
    arguments.insert(arguments.begin(), {"time-of-contact", cube_, cube_, "--scheme", "bilinear", "--json"});
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  [[nodiscard]] Outcome refused(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"time-of-contact", cube_, cube_, "--scheme", "bilinear"});
    return run_snug(arguments);
  }

  TemporaryFolder folder_;
  std::string cube_ = folder_.file("cube.obj");
};

TEST_F(contact, of_cubes_is_told_for_every_way_to_move) {
  // From x = 3 by -4 the faces meet at half the time; a little off the middle.
  const json steady = answer({"--move-b", "3 0.1 0.2", "--velocity-b", "-4 0 0", "--tolerance", "1e-3"});
  EXPECT_EQ(steady["verdict"], "intersecting");
  EXPECT_EQ(steady["outcome"], "complete");
  EXPECT_EQ(steady["duration"], 1);
  EXPECT_LE(steady["time"][0], 0.5);
  EXPECT_GE(steady["time"][1], 0.5 - 1e-12);
  EXPECT_LE(steady["time"][1], 0.501);
  EXPECT_EQ(steady["witness"].size(), 2);
  EXPECT_NEAR(steady["place_b"][3].get<double>(), 1, 1e-2);
  const json screw = answer({"--move-b", "3 0.1 0.2", "--to-b", "1 0 0 -1  0 1 0 0.1  0 0 1 0.2"});
  EXPECT_LE(screw["time"][0], 0.5);
  EXPECT_GE(screw["time"][1], 0.5 - 1e-3);
  std::ofstream(folder_.file("path.txt")) << "1 0 0 3 0 1 0 0.1 0 0 1 0.2\n1 0 0 2 0 1 0 0.1 0 0 1 0.2\n"
                                             "1 0 0 0 0 1 0 0.1 0 0 1 0.2\n";
  const json path = answer({"--path-b", folder_.file("path.txt")});
  EXPECT_EQ(path["duration"], 2);
  EXPECT_LE(path["time"][0], 1.5);
  EXPECT_GE(path["time"][1], 1.5 - 1e-3);
  const json both = answer({"--velocity-a", "2 0 0", "--move-b", "3 0.1 0.2", "--velocity-b", "-2 0 0"});
  EXPECT_LE(both["time"][0], 0.5);
  // Turned about z it sweeps past, two away.
  const json past = answer({"--move-b", "3 0 0", "--spin-b", "z 360", "--about-b", "3.5 0.5 0"});
  EXPECT_EQ(past["verdict"], "separated");
  EXPECT_EQ(past["time"], json({1, nullptr}));
  EXPECT_EQ(past["witness"], nullptr);
}

TEST_F(contact, of_solids_begins_inside) {
  EXPECT_EQ(answer({"--move-b", "0.1 0.2 0.3", "--velocity-b", "1 0 0", "--solid"})["time"][1], 0);
  const json out = answer({"--exit-code", "--move-b", "5 0 0", "--velocity-b", "1 0 0", "--solid"});
  EXPECT_EQ(out["verdict"], "separated");
  EXPECT_EQ(refused({"--exit-code", "--move-b", "3 0.1 0.2", "--velocity-b", "-4 0 0"}).status, 11);
}

TEST_F(contact, of_meshes_that_deform_is_told) {
  const std::string longer = folder_.file("longer.obj");
  std::ofstream(longer) << cube(-3);
  // B's left side goes from x = 3 to 0: it meets x = 1 at two thirds of the time.
  const json deforms = answer({"--move-b", "3 0.1 0.2", "--deform-b", longer, "--tolerance", "1e-3"});
  EXPECT_EQ(deforms["verdict"], "intersecting");
  EXPECT_EQ(deforms["duration"], 1);
  EXPECT_LE(deforms["time"][0], 2.0 / 3);
  EXPECT_GE(deforms["time"][1], 2.0 / 3 - 1e-12);
  EXPECT_LE(deforms["time"][1], 2.0 / 3 + 1e-3);
  EXPECT_NEAR(deforms["witness"][1][0].get<double>(), 1, 1e-2);
  // And while it moves away, never.
  EXPECT_EQ(answer({"--move-b", "3 0.1 0.2", "--velocity-b", "3 0 0", "--deform-b", longer})["verdict"],
            "separated");
  // Both move: A's left side goes to x = -3, and A by 2.
  const json both =
      answer({"--move-b", "3 0.1 0.2", "--deform-b", longer, "--deform-a", longer, "--velocity-a", "2 0 0"});
  EXPECT_LE(both["time"][0], 0.4);
  EXPECT_GE(both["time"][1], 0.4 - 1e-3);
  const auto message = [&](const std::string& text) {
    std::ofstream(folder_.file("other.obj")) << text;
    const Outcome outcome = refused({"--deform-b", folder_.file("other.obj")});
    EXPECT_EQ(outcome.status, 4);
    return outcome.err;
  };
  const std::string same = cube(0);
  EXPECT_NE(message("v 0 0 0\n" + same).find("9 vertices, not the 8 of"), std::string::npos);
  EXPECT_NE(message(same.substr(0, same.find("f 2 4"))).find("5 faces, not the 6 of"), std::string::npos);
  EXPECT_NE(message(same.substr(0, same.find("f 2 4")) + "f 4 8 6 2\n").find("face 5 has other vertices"),
            std::string::npos);
}

// Following what each message advises decides the question.
TEST_F(contact, that_is_undecided_names_what_decides_it) {
  const auto output = [&](std::vector<std::string> more, const std::string& tolerance,
                          const std::string& budget) {
    more.insert(more.end(), {"--tolerance", tolerance, "--max-splits", budget});
    const Outcome outcome = refused(more);
    EXPECT_EQ(outcome.status, outcome.out.find("undecided") == std::string::npos ? 0 : 5) << outcome.out;
    return outcome.out;
  };
  // Along the other one, 1e-5 above it.
  const std::vector<std::string> close{"--move-b", "-5 0 1.00001", "--velocity-b", "10 0 0"};
  EXPECT_NE(output(close, "1e-7", "4000").find("give a larger --max-splits\n"), std::string::npos);
  EXPECT_NE(output(close, "1e-7", "1000000").find("separated: proved"), std::string::npos);
  // On it.
  const std::vector<std::string> on{"--move-b", "-0.5 0 1", "--velocity-b", "1 0 0"};
  EXPECT_NE(output(on, "0", "1000000").find("give a larger --tolerance\n"), std::string::npos);
  EXPECT_NE(output(on, "1e-7", "1000000").find("within: "), std::string::npos);
}

TEST_F(contact, refusals_name_the_option_and_the_next_step) {
  EXPECT_NE(refused({}).err.find("nothing moves; give --to-b"), std::string::npos);
  EXPECT_EQ(refused({}).status, 2);
  EXPECT_EQ(refused({"--poses", "poses.txt", "--velocity-b", "1 0 0"}).status, 2);
  EXPECT_EQ(refused({"--velocity-b", "1 0"}).status, 2);
  EXPECT_EQ(refused({"--about-b", "1 0 0", "--velocity-b", "1 0 0"}).status, 2);
  const Outcome half = refused({"--to-b", "-1 0 0 0  0 -1 0 0  0 0 1 0"});
  EXPECT_EQ(half.status, 4);
  EXPECT_NE(half.err.find("--to-b: trajectory: the second pose is half a turn away"), std::string::npos)
      << half.err;
  std::ofstream(folder_.file("path.txt")) << "1 0 0 3 0 1 0 0.1 0 0 1 0.2\n\n1 0 0 2 0 1 0 0.1 0 0 1\n";
  const Outcome bad = refused({"--path-b", folder_.file("path.txt")});
  EXPECT_EQ(bad.status, 3);
  EXPECT_NE(bad.err.find("path.txt:3: 11 numbers"), std::string::npos) << bad.err;
}

}  // namespace
}  // namespace snug::testing::contact_test
