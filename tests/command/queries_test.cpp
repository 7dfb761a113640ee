// collide, distance and closest as people script them: bad placements, lengths at the ends of the doubles,
// shapes without thickness.

#include <gtest/gtest.h>

#include <testing/counts.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::queries_test {
namespace {

using nlohmann::json;

constexpr const char* octahedron_faces =
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

std::string number(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

/// Corners at +-x, +-y and +-z.
std::string octahedron(double x, double y, double z) {
  std::string obj;
  for (const double s : {1.0, -1.0}) obj += "v " + number(s * x) + " 0 0\n";
  for (const double s : {1.0, -1.0}) obj += "v 0 " + number(s * y) + " 0\n";
  for (const double s : {1.0, -1.0}) obj += "v 0 0 " + number(s * z) + "\n";
  return obj + octahedron_faces;
}

class queries : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  static std::string moved(double x) { return "1 0 0 " + number(x) + " 0 1 0 0 0 0 1 0"; }
  static json answer(std::vector<std::string> arguments, int status = 0) {
    arguments.emplace_back("--json");
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return json::parse(outcome.out);
  }

  TemporaryFolder folder_;
};

TEST_F(queries, bad_placements_are_refused_and_leave_no_file) {
  const std::string star = model("star.obj");
  struct Case {
    const char* placement;
    int status;
  };
  for (const auto& [placement, status] :
       {Case{"1 0 0 0 0 1 0 0 0 0 1.00000001 0", 4},  // off by 1e-8
        Case{"1 1e-8 0 0 0 1 0 0 0 0 1 0", 4}, Case{"-1 0 0 0 0 1 0 0 0 0 1 0", 4},
        Case{"0 0 0 0 0 0 0 0 0 0 0 0", 4}, Case{"1e200 0 0 0 0 1 0 0 0 0 1 0", 4},
        Case{"nan 0 0 0 0 1 0 0 0 0 1 0", 2}, Case{"1 0 0 inf 0 1 0 0 0 0 1 0", 2},
        Case{"1 0 0 1e999 0 1 0 0 0 0 1 0", 2}, Case{"1 0 0 0 0 1 0 0 0 0 1 0 0", 2}, Case{"", 0}}) {
    for (const char* option : {"--place-a", "--place-b"}) {
      const std::string out = folder_.file("answer.json");
      const Outcome outcome =
          run_snug({"collide", star, star, "--tolerance", "1%", option, placement, "-o", out});
      EXPECT_EQ(outcome.status, status) << placement << ": " << outcome.err;
      if (status == 0) continue;
      EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
      EXPECT_TRUE(outcome.err.starts_with("snug: ")) << outcome.err;
      EXPECT_TRUE(folder_.empty()) << placement;
    }
  }
}

TEST_F(queries, placements_off_by_less_than_1e_9_are_taken_as_they_stand) {
  const std::string low = write("low.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
                    high = write("high.obj", "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
  // The second lies 1 above the first, or by 1e-10 more where z is stretched; the margin is half of that
  // more.
  const auto verdict = [&](const char* placement) {
    return answer({"collide", low, high, "--tolerance", "1e-12", "--margin", "1.00000000005", "--place-b",
                   placement})["verdict"];
  };
  EXPECT_EQ(verdict("1 0 0 0 0 1 0 0 0 0 1.0000000001 0"), "separated");
  EXPECT_EQ(verdict("1 0 0 0 0 1 0 0 0 0 1 0"), "within");
}

TEST_F(queries, tolerance_zero_proves_separation_and_contact) {
  const std::string ball = write("ball.obj", octahedron(1, 1, 1));
  EXPECT_EQ(answer({"collide", ball, ball, "--tolerance", "0", "--place-b", moved(0.9)})["verdict"],
            "separated");
  const json crossing = answer({"collide", ball, ball, "--tolerance", "0", "--place-b", moved(0.3)});
  EXPECT_EQ(crossing["verdict"], "intersecting");
  EXPECT_EQ(crossing["distance"][0], 0);
  EXPECT_EQ(
      run_snug({"collide", ball, ball, "--tolerance", "0", "--place-b", moved(0.3), "--exit-code"}).status,
      11);
  // The same surface twice has contact that no crossing shows.
  const json same = answer({"collide", ball, ball, "--tolerance", "0", "--max-splits", "2000"}, 5);
  EXPECT_EQ(same["verdict"], "undecided");
  EXPECT_EQ(
      run_snug({"collide", ball, ball, "--tolerance", "0", "--max-splits", "2000", "--exit-code"}).status,
      12);
  for (const char* tolerance : {"-1", "nan", "inf", "1e999", ""})
    EXPECT_EQ(run_snug({"collide", ball, ball, "--tolerance", tolerance}).status, 2) << tolerance;
}

TEST_F(queries, verdicts_do_not_depend_on_the_unit) {
  for (const double place : {0.3, 0.8, 0.9, 2.0}) {
    json plain;
    for (const int exponent : {0, 664, -664, 1000, -1000}) {
      const double unit = std::ldexp(1.0, exponent);
      const std::string ball = write("ball.obj", octahedron(unit, unit, unit));
      json found = answer(
          {"collide", ball, ball, "--tolerance", number(0.01 * unit), "--place-b", moved(place * unit)});
      for (json& x : found["distance"])
        if (!x.is_null()) x = std::ldexp(x.get<double>(), -exponent);
      if (exponent == 0) plain = found;
      EXPECT_EQ(found["verdict"], plain["verdict"]) << place << ", 2^" << exponent;
      EXPECT_EQ(found["distance"][1].is_null(), plain["distance"][1].is_null());
      EXPECT_NEAR(found["distance"][0].get<double>(), plain["distance"][0].get<double>(), 1e-12);
      if (!found["distance"][1].is_null()) {
        EXPECT_NEAR(found["distance"][1].get<double>(), plain["distance"][1].get<double>(), 1e-12);
      }
    }
  }
}

// Whatever its shape, it gets an answer with an interval.
TEST_F(queries, flat_and_needle_shapes_are_answered) {
  const std::string ball = write("ball.obj", octahedron(1, 1, 1));
  for (const auto& shape :
       {octahedron(1, 1, 0), octahedron(1, 1e-9, 1e-7), octahedron(1, 0, 0), octahedron(0, 0, 0),
        octahedron(1, 1, 1e-300), std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"),
        std::string("v 0 0 0\nv 1 1e-12 0\nv 2 0 0\nf 1 2 3\n")}) {
    const std::string file = write("shape.obj", shape);
    for (const double place : {0.0, 0.4, 5.0}) {
      if (testing::fewer(2) == 1 && place == 0) continue;  // tips that touch take long
      const Outcome outcome =
          run_snug({"collide", file, ball, "--tolerance", "1%", "--place-b", moved(place), "--json"});
      ASSERT_EQ(outcome.status, 0) << shape << outcome.err;
      const json found = json::parse(outcome.out);
      if (place == 5.0) {
        EXPECT_EQ(found["verdict"], "separated");
      } else {
        EXPECT_TRUE(found["verdict"] != "undecided") << shape << place;
      }
      if (!found["distance"][1].is_null()) {
        EXPECT_LE(found["distance"][0].get<double>(), found["distance"][1].get<double>());
      }
    }
  }
}

TEST_F(queries, solids_hold_what_is_inside_of_them) {
  const std::string ball = write("ball.obj", octahedron(1, 1, 1)),
                    seed = write("seed.obj", octahedron(0.1, 0.1, 0.1)),
                    sheet = write("sheet.obj", "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 3\n");
  const auto with = [&](const std::string& a, const std::string& b, std::vector<std::string> more) {
    more.insert(more.begin(), {"collide", a, b, "--tolerance", "0.001"});
    return more;
  };
  EXPECT_EQ(answer(with(ball, seed, {}))["verdict"], "separated");
  for (const auto& [a, b] : {std::pair{ball, seed}, std::pair{seed, ball}})
    EXPECT_EQ(answer(with(a, b, {"--solid"}))["verdict"], "intersecting");
  EXPECT_EQ(answer(with(ball, seed, {"--solid", "--place-b", moved(2)}))["verdict"], "separated");
  // Open surfaces bound nothing.
  EXPECT_EQ(run_snug(with(ball, sheet, {"--solid"})).status, 4);
}

TEST_F(queries, distances_do_not_depend_on_the_unit) {
  const double gap = 3 - 48.0 / 55;  // tip to tip
  for (const int exponent : {0, 664, -664}) {
    const double unit = std::ldexp(1.0, exponent);
    const std::string ball = write("ball.obj", octahedron(unit, unit, unit)),
                      points = write("points.txt", number(3 * unit) + " 0 0\n");
    const std::vector<std::string> precise{"--absolute", number(1e-6 * unit)};
    std::vector<std::string> apart{"distance", ball, ball, "--place-b", moved(3 * unit)};
    apart.insert(apart.end(), precise.begin(), precise.end());
    const json found = answer(apart);
    EXPECT_LE(std::ldexp(found["distance"][0].get<double>(), -exponent), gap);
    EXPECT_GE(std::ldexp(found["distance"][1].get<double>(), -exponent), gap);
    EXPECT_NEAR(std::ldexp(found["distance"][0].get<double>(), -exponent), gap, 1.1e-6);
    std::vector<std::string> closest{"closest", ball, "--points", points};
    closest.insert(closest.end(), precise.begin(), precise.end());
    const json nearest = answer(closest)["results"][0];
    EXPECT_LE(std::ldexp(nearest["distance"][0].get<double>(), -exponent), 3 - 24.0 / 55);
    EXPECT_GE(std::ldexp(nearest["distance"][1].get<double>(), -exponent), 3 - 24.0 / 55);
    EXPECT_NEAR(std::ldexp(nearest["point"][0].get<double>(), -exponent), 24.0 / 55, 1e-2);
  }
}

TEST_F(queries, distance_and_closest_refuse_bad_input_and_leave_no_file) {
  const std::string star = model("star.obj");
  const TemporaryFolder out;
  const std::string file = out.file("answer.json");
  for (const auto& [placement, status] :
       {std::pair{"1 0 0 0 0 1 0 0 0 0 1.00000001 0", 4}, std::pair{"nan 0 0 0 0 1 0 0 0 0 1 0", 2}})
    EXPECT_EQ(run_snug({"distance", star, star, "--place-b", placement, "-o", file}).status, status);
  EXPECT_EQ(run_snug({"distance", star, star, "--absolute", "-1", "-o", file}).status, 2);
  // The same surface twice: its distance is 0, but no proof ends at that.
  EXPECT_EQ(run_snug({"distance", star, star, "--absolute", "0", "--max-splits", "200"}).status, 5);
  for (const char* line : {"1 2", "1 2 3 4", "nan 0 0", "1 2 x", "1e999 0 0"}) {
    const Outcome outcome = run_snug(
        {"closest", star, "--points", write("bad.txt", std::string("0 0 0\n") + line + "\n"), "-o", file});
    EXPECT_EQ(outcome.status, 3) << line;
    EXPECT_NE(outcome.err.find("bad.txt:2"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_snug({"closest", star, "--points", write("far.txt", "1e200 0 0\n"), "-o", file}).status, 4);
  EXPECT_TRUE(out.empty());
}

TEST_F(queries, witnesses_say_where_they_lie) {
  const std::string ball = write("ball.obj", octahedron(1, 1, 1)), points = write("points.txt", "3 0 0\n");
  // B is turned a quarter about z.
  const std::string turned = "0 -1 0 3 1 0 0 0 0 0 1 0";
  for (const std::string scheme : {"loop", "catmark", "doo-sabin"}) {
    const bool loop = scheme == "loop", dual = scheme == "doo-sabin";
    const auto expect_place = [&](const json& at) {
      EXPECT_EQ(at.contains("face"), !dual) << at;
      EXPECT_EQ(at.contains("vertex"), dual) << at;
      EXPECT_EQ(at.contains("corner"), !loop) << at;
      for (const char* name : {"u", "v"}) EXPECT_TRUE(at[name] >= 0 && at[name] <= 1) << at;
      EXPECT_TRUE(at.contains("normal") && at.contains("normal_error")) << at;
    };
    for (const std::string command : {"collide", "distance"}) {
      const json found = answer({command, ball, ball, "--scheme", scheme, "--place-b", turned});
      ASSERT_EQ(found["witness_at"].size(), 2u) << found;
      for (const json& at : found["witness_at"]) expect_place(at);
      const double lower = found["distance"][0], upper = found["distance"][1];
      EXPECT_GE(2 * lower, upper) << found;
      // Nearest along x: the normals face each other.
      for (std::size_t s = 0; s < 2 && command == "distance"; ++s) {
        const json& normal = found["witness_at"][s]["normal"];
        if (normal.is_null()) continue;
        EXPECT_NEAR(normal[0].get<double>(), s == 0 ? 1 : -1, 0.05) << found;
      }
    }
    const json nearest = answer({"closest", ball, "--scheme", scheme, "--points", points})["results"][0];
    expect_place(nearest);
    const Outcome text = run_snug({"distance", ball, ball, "--scheme", scheme, "--place-b", turned});
    EXPECT_NE(text.out.find(dual ? " vertex " : " face "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("place"), std::string::npos) << text.out;
    const Outcome table = run_snug({"closest", ball, "--scheme", scheme, "--points", points});
    EXPECT_EQ(table.out.substr(0, 2), "# ") << table.out;
  }
}

TEST_F(queries, surfaces_at_any_distance_are_separated_at_once) {
  const std::string star = model("star.obj");
  for (const double far : {1e20, 1e80, 1e150, 1e200, 1e300}) {
    for (const char* side : {"--place-a", "--place-b"}) {
      const json found = answer({"collide", star, star, side, moved(far)});
      EXPECT_EQ(found["verdict"], "separated") << far;
      EXPECT_EQ(found["stats"]["splits"], 0) << far;
      EXPECT_GE(found["distance"][0].get<double>(), far * (1 - 2e-14)) << far;
      const json apart = answer({"distance", star, star, side, moved(far), "--relative", "1e-13"});
      EXPECT_GE(apart["distance"][0].get<double>(), far * (1 - 2e-14)) << far;
      EXPECT_LE(apart["distance"][1].get<double>(), far * (1 + 2e-14)) << far;
      EXPECT_LE(apart["seconds"].get<double>(), 1) << far;
    }
  }
}

TEST_F(queries, interruption_leaves_no_file) {
  const TemporaryFolder out;
  const Outcome outcome =
      interrupt_snug({"collide", model("bust.obj"), model("bust.obj"), "--tolerance", "0", "--max-splits",
                      "1000000000000", "--quiet", "-o", out.file("answer.json")},
                     200);
  // Either it was still at work, or it had given up: nothing half written in any case.
  if (outcome.status == 130) {
    EXPECT_TRUE(out.empty());
  } else {
    EXPECT_EQ(outcome.status, 5) << outcome.err;
  }
}

}  // namespace
}  // namespace snug::testing::queries_test
