// Where meshes stand: --place, --rotate, --move, --nearest-rigid and --poses.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <testing/counts.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "run_snug.h"

namespace snug::testing::poses_test {
namespace {

using nlohmann::json;
using Words = std::vector<std::string>;

constexpr const char* octahedron =
    "t scheme 0/0/1 loop\nv 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string text_of(const std::array<double, 12>& matrix) {
  std::string text;
  for (const double x : matrix) text += number(x) + " ";
  return text;
}

using Quaternion = std::array<double, 4>;

std::array<double, 12> matrix_of(const Quaternion& q, const std::array<double, 3>& t) {
  const auto [w, x, y, z] = q;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),     t[0],
          2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),     t[1],
          2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y), t[2]};
}

class pose_options : public ::testing::Test {
 protected:
  pose_options() { std::ofstream(ball_) << octahedron; }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  Outcome run(const std::string& command, const Words& more, const std::string& input = "") {
    Words words{command, ball_, ball_};
    if (command == "collide") words.insert(words.end(), {"--tolerance", "0.01"});
    words.insert(words.end(), more.begin(), more.end());
    return run_snug(words, input);
  }
  json answer(const std::string& command, Words more, const std::string& input = "") {
    more.emplace_back("--json");
    const Outcome outcome = run(command, more, input);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    json result = json::parse(outcome.out);
    result.erase("seconds");
    return result;
  }
  // The error of a command line that is refused with this status.
  std::string refusal(const Words& more, int status, const std::string& input = "") {
    const Outcome outcome = run("collide", more, input);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }

  TemporaryFolder folder_;
  std::string ball_ = folder_.file("ball.obj");
};

bool says(const std::string& text, const std::string& what) { return text.find(what) != std::string::npos; }

TEST_F(pose_options, name_one_pose_in_many_ways) {
  const json placed = answer("distance", {"--place-b", "0 -1 0 3 1 0 0 1 0 0 1 0"});
  EXPECT_EQ(placed["place_b"], json::parse("[0,-1,0,3, 1,0,0,1, 0,0,1,0]"));
  EXPECT_EQ(placed["place_a"], json::parse("[1,0,0,0, 0,1,0,0, 0,0,1,0]"));
  for (const Words& same : {Words{"--place-b", "0,-1,0,3, 1,0,0,1, 0,0,1,0, 0,0,0,1"},
                            Words{"--rotate-b", "z 90", "--move-b", "3 1 0"},
                            Words{"--move-b", "3,1,0", "--rotate-b", "0 0 2 -270"},
                            Words{"--place-b", "0 -1 0 3 1 0 0 1 0 0 1 0", "--nearest-rigid"}}) {
    EXPECT_EQ(answer("distance", same), placed) << same[1];
  }
  const json turned = answer("distance", {"--rotate-a", "1 1 0 30", "--move-a", "-3 0 0"});
  EXPECT_NEAR(turned["place_a"][0].get<double>(), 0.5 + 0.5 * std::cos(std::acos(-1) / 6), 1e-15);
  EXPECT_EQ(turned["place_a"][3], -3);
  EXPECT_GT(turned["distance"][0], 0.5);
}

TEST_F(pose_options, that_are_wrong_say_how_far_off_and_what_to_do) {
  const auto place = [&](const std::string& text, int status) {
    return refusal({"--place-b", text}, status);
  };
  const std::string off = place("1 0 0 0 0 1 0 0 0 0 1.00000001 0", 4);
  EXPECT_TRUE(says(off, "--place-b") && says(off, "2e-08") && says(off, "--nearest-rigid")) << off;
  EXPECT_TRUE(says(place("10 0 0 0 0 10 0 0 0 0 10 0", 4), "scales lengths by 10"));
  EXPECT_TRUE(says(place("1 0 0 0 0 1 0 0 0 0 -1 0", 4), "mirrors"));
  EXPECT_TRUE(says(place("1 0 0 0 0 1 0 0 0 0 1 0 3 0 0 1", 4), "row by row"));
  EXPECT_TRUE(says(place("1 0 0", 2), "3 numbers"));
  EXPECT_TRUE(says(place("1 0 0 nan 0 1 0 0 0 0 1 0", 2), "not a finite number"));
  EXPECT_TRUE(says(refusal({"--move-b", "1 2"}, 2), "three numbers"));
  EXPECT_TRUE(says(refusal({"--move-b", "1 2 inf"}, 2), "not a finite number"));
  EXPECT_TRUE(says(refusal({"--rotate-b", "q 30"}, 2), "z 30"));
  EXPECT_TRUE(says(refusal({"--rotate-b", "z"}, 2), "z 30"));
  EXPECT_TRUE(says(refusal({"--rotate-b", "z thirty"}, 2), "not a number"));
  EXPECT_TRUE(says(refusal({"--rotate-b", "0 0 0 30"}, 4), "axis"));
  EXPECT_TRUE(says(refusal({"--rotate-b", "z 30", "--place-b", "1 0 0 0 0 1 0 0 0 0 1 0"}, 2), "exclude"));
  EXPECT_TRUE(says(refusal({"--poses", "-", "--exit-code"}, 2), "exclude"));
}

TEST_F(pose_options, nearest_rigid_takes_matrices_in_single_precision_and_says_so) {
  const std::string off = text_of(
      matrix_of({static_cast<float>(std::sqrt(0.5)), 0, 0, static_cast<float>(std::sqrt(0.5))}, {3, 0, 0}));
  const Outcome outcome = run("distance", {"--place-b", off, "--nearest-rigid", "--json"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(says(outcome.err, "note: --place-b: off from rigid by")) << outcome.err;
  const json found = json::parse(outcome.out);
  const auto m = found["place_b"].get<std::array<double, 12>>();
  EXPECT_NEAR(m[0] * m[0] + m[4] * m[4], 1, 1e-15);
  EXPECT_NEAR(m[0], 0, 1e-7);
  EXPECT_EQ(run("distance", {"--place-b", off, "--nearest-rigid", "--quiet"}).err, "");
  EXPECT_TRUE(says(refusal({"--nearest-rigid", "--place-b", "1 0 0 0 0 1 0 0 0 0 -1 0"}, 4), "mirrors"));
  EXPECT_TRUE(says(refusal({"--nearest-rigid", "--place-b", "1 0 0 0 0 1 0 0 0 0 0 0"}, 4), "singular"));
}

TEST_F(pose_options, of_render_are_read_alike) {
  const std::string out = folder_.file("picture.png");
  const Words words{"render", ball_, "--size", "20", "--samples", "1", "-o", out, "--place"};
  const auto status = [&](const std::string& place, const Words& more = {}) {
    Words all = words;
    all.push_back(place);
    all.insert(all.end(), more.begin(), more.end());
    return run_snug(all).status;
  };
  EXPECT_EQ(status("1 0 0 3 0 1 0 0 0 0 1 0 0 0 0 1"), 0);
  EXPECT_EQ(status("1 0 0 3 0 1 0 0 0 0 1.0001 0"), 4);
  EXPECT_EQ(status("1 0 0 3 0 1 0 0 0 0 1.0001 0", {"--nearest-rigid"}), 0);
  EXPECT_EQ(status("1 0 0 3 0 1 0 0 0 0 -1 0"), 4);
}

class pose_files : public pose_options {
 protected:
  // The same poses in the several forms that lines may have.
  void fill(std::size_t count) {
    std::mt19937_64 random(71);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> shift(-1.2, 1.2);
    for (std::size_t i = 0; i < count; ++i) {
      Quaternion q{normal(random), normal(random), normal(random), normal(random)};
      const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
      for (double& x : q) x /= n;
      const std::array<double, 3> t{shift(random), shift(random), shift(random)};
      const std::array<double, 12> matrix = matrix_of(q, t);
      switch (i % 4) {
        case 0:
          text_ += text_of(matrix) + "\n";
          break;
        case 1:
          text_ += "# by the way\n\n" + json(matrix).dump() + "\r\n";
          break;
        case 2:
          text_ += text_of(matrix) + " 0 0 0 1\n";
          break;
        default:
          text_ +=
              json{{"b", {{"quaternion", q}, {"translation", t}}}, {"a", matrix_of({0, 1, 0, 0}, t)}}.dump() +
              "\n";
      }
    }
    file_ = write("poses.txt", text_);
  }

  std::string text_, file_;
};

TEST_F(pose_files, are_answered_as_single_poses_for_any_number_of_threads) {
  fill(40);
  for (const char* command : {"collide", "distance"}) {
    const json all = answer(command, {"--poses", file_, "--threads", "1"});
    ASSERT_EQ(all["count"], 40);
    ASSERT_EQ(all["results"].size(), 40u);
    for (const char* threads : {"2", "3", "8"})
      EXPECT_EQ(answer(command, {"--poses", file_, "--threads", threads}), all);
    EXPECT_EQ(answer(command, {"--poses", "-"}, text_), all);
    EXPECT_EQ(all["results"][1]["line"], 4);
    for (std::size_t i = 0; i < 40; i += testing::fewer(4) == 4 ? 3 : 13) {
      const json& one = all["results"][i];
      const auto text = [&](const char* key) { return text_of(one[key].get<std::array<double, 12>>()); };
      const json alone = answer(command, {"--place-a", text("place_a"), "--place-b", text("place_b")});
      for (const char* key :
           {"verdict", "outcome", "distance", "witness", "witness_error", "stats", "place_a", "place_b"})
        EXPECT_EQ(alone.value(key, json()), one.value(key, json())) << key << ' ' << i;
    }
  }
}

TEST_F(pose_files, print_a_header_and_a_row_each) {
  fill(8);
  const Outcome outcome = run("collide", {"--poses", file_});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "# line verdict lower upper ax ay az bx by bz");
  const json all = answer("collide", {"--poses", file_});
  std::size_t i = 0;
  for (; std::getline(lines, line); ++i) {
    std::istringstream words(line);
    std::string verdict, word;
    int number = 0, columns = 2;
    words >> number >> verdict;
    EXPECT_EQ(number, all["results"][i]["line"]);
    EXPECT_EQ(verdict, all["results"][i]["verdict"]);
    while (words >> word) ++columns;
    EXPECT_EQ(columns, 10);
  }
  EXPECT_EQ(i, 8u);
}

TEST_F(pose_files, take_what_a_line_does_not_say_from_the_options) {
  const std::string line = R"({"a": [1,0,0,-2, 0,1,0,0, 0,0,1,0]})";
  const json found = answer("distance", {"--poses", "-", "--move-b", "3 0 0"}, line);
  EXPECT_EQ(found["results"][0]["place_a"][3], -2);
  EXPECT_EQ(found["results"][0]["place_b"][3], 3);
}

TEST_F(pose_files, may_be_empty) {
  for (const char* text : {"", "\n\n# nothing\n", "# no line feed"}) {
    const json found = answer("collide", {"--poses", "-"}, text);
    EXPECT_EQ(found["count"], 0);
    EXPECT_TRUE(found["results"].empty());
  }
}

TEST_F(pose_files, with_bad_lines_are_refused_by_line) {
  struct Case {
    const char* line;
    int status;
    const char* says;
  };
  const std::string good = "1 0 0 3 0 1 0 0 0 0 1 0\n";
  for (const auto& [line, status, what] :
       {Case{"1 2 3", 3, "3 numbers"},
        Case{"1 0 0 x 0 1 0 0 0 0 1 0", 3, "'x' is not a number"},
        Case{"1 0 0 nan 0 1 0 0 0 0 1 0", 3, "not a finite number"},
        Case{"{", 3, "'\"' is missing at the end"},
        Case{"[1e999,0,0,0,0,1,0,0,0,0,1,0]", 3, "'1e999'"},
        Case{"[]", 3, "0 numbers"},
        Case{"{}", 3, "no pose"},
        Case{R"({"c": []})", 3, "'c' is neither"},
        Case{R"({"a": {"quaternion": [1,0,0]}})", 3, "a: quaternion has 3 numbers"},
        Case{R"({"a": {"translation": [1,0,0]}})", 3, "no quaternion"},
        Case{R"({"b": {"quaternion": [1,0,0,0], "angle": 1}})", 3, "'angle'"},
        Case{R"({"b": {"quaternion": [0,0,0,0]}})", 4, "b: pose: the quaternion is zero"},
        Case{R"({"b": "here"})", 3, "b: '[' is missing"},
        Case{R"({"b": [1,null,3]})", 3, "'null' is not a number"},
        Case{R"({"b": [1,0,0,3,0,1,0,0,0,0,1,0]} 7)", 3, "something follows"},
        Case{R"({"b": {"quaternion": [1,0,0,0]}, "b": {"quaternion": [1,0,0,0]}})", 3, "b appears twice"},
        Case{R"({"b": {"quaternion": [1,0,0,0)", 3, "']' is missing"},
        Case{R"({"b)", 3, "does not end"},
        Case{"1 0 0 0 0 1 0 0 0 0 -1 0", 4, "mirrors"},
        Case{"1 0 0 0 0 1 0 0 0 0 1.00000001 0", 4, "--nearest-rigid"},
        Case{"1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2", 4, "last row"}}) {
    const std::string file = write("bad.txt", good + "\n" + line + "\n" + good);
    const Outcome outcome = run("collide", {"--poses", file});
    EXPECT_EQ(outcome.status, status) << line << outcome.err;
    EXPECT_TRUE(says(outcome.err, file + ":3: ") && says(outcome.err, what)) << line << ": " << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2)
        << outcome.out;  // header, first answer
    const std::string out = folder_.file("answers.json");
    EXPECT_EQ(run("distance", {"--poses", file, "-o", out}).status, status);
    EXPECT_FALSE(std::ifstream(out).good());
  }
  EXPECT_TRUE(says(refusal({"--poses", folder_.file("none.txt")}, 3), "none.txt"));
  EXPECT_TRUE(says(refusal({"--poses", folder_.file(".")}, 3), "cannot be read"));
  const std::string endless = refusal({"--poses", "/dev/zero"}, 3);
  EXPECT_TRUE(says(endless, "/dev/zero:1: a line of more than 256 KiB")) << endless;
}

TEST_F(pose_files, off_from_rigid_are_mended_on_request_with_one_note) {
  const std::string off = "1 0 0 3 0 1 0 0 0 0 1.00000001 0\n", good = "1 0 0 3 0 1 0 0 0 0 1 0\n";
  const Outcome outcome =
      run("distance", {"--poses", "-", "--nearest-rigid", "--json"}, good + off + good + off);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(says(outcome.err, "standard input: 2 lines") && says(outcome.err, "2e-08") &&
              says(outcome.err, "line 2"))
      << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["results"][1]["place_b"], found["results"][0]["place_b"]);
}

TEST_F(pose_files, end_with_5_if_one_answer_was_not_reached) {
  const Outcome outcome =
      run("distance", {"--poses", "-", "--max-splits", "0", "--absolute", "1e-9", "--json"},
          "1 0 0 3 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(outcome.status, 5);
  EXPECT_EQ(json::parse(outcome.out)["results"][0]["outcome"], "budget-spent");
}

TEST_F(pose_files, longer_than_the_buffer_are_answered_in_order) {
  const std::size_t count = 20'000;
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += "1 0 0 " + number(4 + static_cast<double>(i)) + " 0 1 0 0 0 0 1 0\n";
  const Outcome outcome = run("collide", {"--poses", "-"}, text);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::istringstream lines(outcome.out);
  std::string line;
  std::getline(lines, line);
  std::size_t i = 0;
  while (std::getline(lines, line))
    ASSERT_TRUE(line.starts_with(std::to_string(++i) + " separated ")) << line;
  EXPECT_EQ(i, count);
}

TEST_F(pose_files, that_do_not_come_can_be_interrupted) {
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string out = folder_.file("answers.json");
  const Outcome outcome =
      interrupt_snug({"distance", ball_, ball_, "--poses", pipe, "--quiet", "-o", out}, 300);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_FALSE(std::ifstream(out).good());
}

}  // namespace
}  // namespace snug::testing::poses_test
