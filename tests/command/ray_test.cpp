// ray, and the options of render that concern surfaces, as people script them.

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::ray_test {
namespace {

using nlohmann::json;

constexpr const char* box =
    "v 0 0 0\nv 2 0 0\nv 0 3 0\nv 2 3 0\nv 0 0 4\nv 2 0 4\nv 0 3 4\nv 2 3 4\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

class ray_command : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  json answer(const std::string& rays, std::vector<std::string> more = {}, int status = 0) {
    more.insert(more.begin(), {"ray", write("box.obj", box), "--sharp", "auto", "--rays",
                               write("rays.txt", rays), "--json"});
    const Outcome outcome = run_snug(more);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    const json document = json::parse(outcome.out, nullptr, false);
    return document["results"];
  }
  static std::string bytes(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  TemporaryFolder folder_;
};

TEST_F(ray_command, tells_the_hits_of_each_line) {
  const std::string rays = "# three rays\n1 1 9 0 0 -1\n\n1 1 9 0 0 1\n1 1 9 0 0 -2 3 inf\n";
  const json nearest = answer(rays);
  ASSERT_EQ(nearest.size(), 3);
  const json& hit = nearest[0]["hits"][0];
  EXPECT_LE(hit["t"][0], 5.0);
  EXPECT_GE(hit["t"][1], 5.0);
  EXPECT_EQ(hit["certified"], true);
  EXPECT_EQ(hit["side"], -1);
  EXPECT_NEAR(hit["point"][2].get<double>(), 4, 1e-5);
  EXPECT_NEAR(hit["normal"][2].get<double>(), 1, 1e-12);
  EXPECT_EQ(hit["face"], 1);
  EXPECT_EQ(nearest[1]["hits"].size(), 0);
  EXPECT_EQ(nearest[1]["outcome"], "complete");
  EXPECT_GE(nearest[2]["hits"][0]["t"][1], 4.5);
  EXPECT_EQ(answer(rays, {"--all"})[0]["hits"].size(), 2);
  EXPECT_EQ(answer(rays, {"--any"})[0]["hits"].size(), 1);
}

TEST_F(ray_command, ends_with_5_where_something_is_left_open) {
  const json touching = answer("-1 1 4 1 0 0\n", {"--all"}, 5);
  ASSERT_FALSE(touching[0]["hits"].empty());
  EXPECT_EQ(touching[0]["hits"][0]["certified"], false);
}

TEST_F(ray_command, reaches_the_precision_or_ends_with_5) {
  const std::string saddle = write("saddle.obj", "v 0 0 0\nv 1 0 0\nv 1 1 1\nv 0 1 0\nf 1 2 3 4\n");
  const auto ask = [&](const char* precision, const char* query) {
    return run_snug({"ray", saddle, "--scheme", "bilinear", "--rays", write("down.txt", "0.5 0.5 3 0 0 -1\n"),
                     "--json", "--absolute", precision, query});
  };
  const Outcome fine = ask("1e-6", "--all");
  EXPECT_EQ(fine.status, 0) << fine.err;
  const json found = json::parse(fine.out, nullptr, false)["results"][0], hit = found["hits"][0];
  EXPECT_EQ(found["outcome"], "complete");
  EXPECT_LE(hit["t"][0], 2.75);
  EXPECT_GE(hit["t"][1], 2.75);
  EXPECT_LE(hit["t"][1].get<double>() - hit["t"][0].get<double>(), 1.0000001e-6);
  // Below rounding: certain, but not reached.
  const Outcome finer = ask("1e-18", "--all");
  EXPECT_EQ(finer.status, 5) << finer.err;
  const json wide = json::parse(finer.out, nullptr, false)["results"][0];
  EXPECT_EQ(wide["hits"][0]["certified"], true);
  EXPECT_EQ(wide["outcome"], "at-rounding");
  EXPECT_EQ(ask("1e-18", "--any").status, 0);
}

TEST_F(ray_command, refuses_what_is_no_ray) {
  const std::string mesh = write("box.obj", box);
  for (const char* line : {"1 1 9 0 0", "1 1 9 0 0 0", "1 1 9 0 0 nan", "1 1 9 0 0 1 2", "1 1 9 0 0 1 3 2",
                           "1 1 9 0 0 1 0 1 7", "a b c d e f"}) {
    const Outcome outcome =
        run_snug({"ray", mesh, "--rays", write("bad.txt", std::string("0 0 9 0 0 1\n") + line + "\n")});
    EXPECT_EQ(outcome.status, 3) << line;
    EXPECT_NE(outcome.err.find("bad.txt:2"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_snug({"ray", mesh, "--rays", write("r.txt", "0 0 9 0 0 1\n"), "--any", "--all"}).status, 2);
  EXPECT_EQ(run_snug({"ray", mesh}).status, 2);
}

TEST_F(ray_command, pictures_show_what_is_asked_for) {
  const std::string part = write("box.obj", box), other = write("other.obj", std::string(box));
  const auto picture = [&](std::vector<std::string> how) {
    const std::string file = folder_.file("picture.png");
    how.insert(how.begin(),
               {"render", part, other, "--place", "1 0 0 0 0 1 0 0 0 0 1 0", "--place",
                "1 0 0 3 0 1 0 0 0 0 1 0", "--size", "48", "--samples", "1", "--quiet", "-o", file});
    const Outcome outcome = run_snug(how);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return bytes(file);
  };
  std::vector<std::string> pictures{picture({})};
  for (const std::vector<std::string>& how : {std::vector<std::string>{"--no-shadows"},
                                              {"--opacity", "0.5"},
                                              {"--opacity", "1", "--opacity", "0.2"},
                                              {"--cut", "1 1 1  2 1 1"},
                                              {"--zoom", "3"},
                                              {"--dark"},
                                              {"--label", "separated, gap 0.2"},
                                              {"--colour", "kind"},
                                              {"--colour", "level"},
                                              {"--colour", "thickness"},
                                              {"--colour", "curvature"},
                                              {"--colour", "distance"}}) {
    pictures.push_back(picture(how));
    for (std::size_t i = 0; i + 1 < pictures.size(); ++i)
      EXPECT_NE(pictures[i], pictures.back()) << how[0] << how.back();
  }
}

TEST_F(ray_command, pictures_of_kinds_do_not_depend_on_threads) {
  std::vector<std::string> pictures;
  for (const char* const threads : {"1", "2", "2", "4"}) {
    const std::string file = folder_.file("picture.png");
    ASSERT_EQ(run_snug({"render", model("bust.obj"), "--colour", "kind", "--size", "64", "--samples", "1",
                        "--threads", threads, "--quiet", "-o", file})
                  .status,
              0);
    pictures.push_back(bytes(file));
    EXPECT_EQ(pictures.front(), pictures.back()) << threads;
  }
}

TEST_F(ray_command, pictures_refuse_what_cannot_be_drawn) {
  const std::string part = write("box.obj", box), file = folder_.file("picture.png");
  for (const std::vector<std::string>& how : {std::vector<std::string>{"--opacity", "2"},
                                              {"--opacity", "x"},
                                              {"--opacity", "1", "--opacity", "1"},
                                              {"--cut", "1 1 1 1 1 1"},
                                              {"--cut", "1 2"},
                                              {"--zoom", "0"},
                                              {"--colour", "mood"},
                                              {"--colour", "distance"}}) {
    std::vector<std::string> arguments{"render", part, "-o", file};
    arguments.insert(arguments.end(), how.begin(), how.end());
    EXPECT_EQ(run_snug(arguments).status, 2) << how[0] << how.back();
    EXPECT_FALSE(std::ifstream(file).good());
  }
}

}  // namespace
}  // namespace snug::testing::ray_test
