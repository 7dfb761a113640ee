#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::cad_test {
namespace {

// A cube of six open sheets, each with vertices of its own, which are `gap` outside of where they meet.
std::string six_sheets(const std::string& gap) {
  std::string text;
  const std::string low = "-" + gap, high = "1" + gap.substr(1);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      for (int k = 0; k < 4; ++k) {
        const int turn = upper ? k : 3 - k;
        std::string p[3];
        p[axis] = upper ? high : low;
        p[(axis + 1) % 3] = turn == 1 || turn == 2 ? "1" : "0";
        p[(axis + 2) % 3] = turn >= 2 ? "1" : "0";
        text += "v " + p[0] + ' ' + p[1] + ' ' + p[2] + '\n';
      }
    }
  }
  for (int f = 0; f < 6; ++f) {
    text += 'f';
    for (int k = 1; k <= 4; ++k) text += ' ' + std::to_string(4 * f + k);
    text += '\n';
  }
  return text;
}

TEST(vertices_that_stand_twice, are_noted_with_their_number_and_joined_by_weld_0) {
  const std::string sheets = six_sheets("0.0");
  const Outcome apart = run_snug({"info", "-", "--json"}, sheets);
  EXPECT_NE(apart.err.find("24 vertices coincide with others, in 8 places"), std::string::npos);
  EXPECT_NE(apart.err.find("and 24 boundary edges coincide"), std::string::npos) << apart.err;
  EXPECT_NE(apart.err.find("--weld 0"), std::string::npos) << apart.err;
  EXPECT_EQ(run_snug({"info", "-", "--json", "--quiet"}, sheets).err, "");
  EXPECT_FALSE(nlohmann::json::parse(apart.out)["closed"].get<bool>());
  const Outcome joined = run_snug({"info", "-", "--json", "--weld", "0"}, sheets);
  EXPECT_NE(joined.err.find("16 vertices were welded"), std::string::npos) << joined.err;
  EXPECT_EQ(joined.err.find("coincide"), std::string::npos) << joined.err;
  EXPECT_TRUE(nlohmann::json::parse(joined.out)["closed"].get<bool>());
}

TEST(vertices_that_stand_twice, are_noted_where_they_nearly_do_with_the_length_that_joins_them) {
  const std::string sheets = six_sheets("0.0000001");
  const Outcome apart = run_snug({"info", "-", "--json"}, sheets);
  const std::string option = "--weld ";
  const std::size_t at = apart.err.find(option);
  ASSERT_NE(at, std::string::npos) << apart.err;
  const std::string length =
      apart.err.substr(at + option.size(), apart.err.find(' ', at + option.size()) - at - option.size());
  EXPECT_NEAR(std::stod(length), std::sqrt(2e-14), 1e-12);
  const Outcome joined = run_snug({"info", "-", "--json", "--weld", length}, sheets);
  EXPECT_TRUE(nlohmann::json::parse(joined.out)["closed"].get<bool>()) << joined.err;
}

// A box of 12 facets, as CAD exports it.
std::string stl_box(double x, double y, double z) {
  const auto corner = [&](int k) {
    return "vertex " + std::to_string(k & 1 ? x : 0) + ' ' + std::to_string(k & 2 ? y : 0) + ' ' +
           std::to_string(k & 4 ? z : 0) + '\n';
  };
  std::string text = "solid box\n";
  for (const auto& [a, b, c] :
       {std::array{0, 2, 3}, std::array{0, 3, 1}, std::array{4, 5, 7}, std::array{4, 7, 6},
        std::array{0, 1, 5}, std::array{0, 5, 4}, std::array{2, 6, 7}, std::array{2, 7, 3},
        std::array{0, 4, 6}, std::array{0, 6, 2}, std::array{1, 3, 7}, std::array{1, 7, 5}}) {
    text += "facet normal 0 0 0\nouter loop\n" + corner(a) + corner(b) + corner(c) + "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

TEST(sharp, makes_boxes_of_facets_what_they_are) {
  const TemporaryFolder folder;
  const std::string box = folder.file("box.STL");
  std::ofstream(box) << stl_box(40, 20, 10);
  const auto verdict = [&](const std::vector<std::string>& options, const std::string& shift) {
    std::vector<std::string> arguments{"collide",     box,         box,
                                       "--tolerance", "0.1%",      "--json",
                                       "--quiet",     "--place-b", "1 0 0 " + shift + " 0 1 0 3 0 0 1 2"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return nlohmann::json::parse(run_snug(arguments).out)["verdict"].get<std::string>();
  };
  EXPECT_EQ(verdict({}, "35"), "intersecting");
  EXPECT_EQ(verdict({"--scheme", "loop"}, "35"), "separated");
  EXPECT_EQ(verdict({"--sharp", "auto"}, "35"), "intersecting");
  EXPECT_EQ(verdict({"--sharp", "45.5"}, "41"), "separated");
  for (const char* scheme : {"flat", "bilinear"}) {
    EXPECT_EQ(verdict({"--scheme", scheme}, "35"), "intersecting");
    EXPECT_EQ(verdict({"--scheme", scheme}, "41"), "separated");
  }
  for (const std::vector<std::string>& options :
       std::vector<std::vector<std::string>>{{"--sharp", "auto"}, {"--scheme", "flat"}}) {
    const Outcome apart = run_snug({"distance", box, box, options[0], options[1], "--absolute", "1e-9",
                                    "--json", "--quiet", "--place-b", "1 0 0 41 0 1 0 0 0 0 1 0"});
    const nlohmann::json distance = nlohmann::json::parse(apart.out)["distance"];
    EXPECT_NEAR(distance[0].get<double>(), 1, 1e-9);
    EXPECT_NEAR(distance[1].get<double>(), 1, 1e-9);
  }
}

TEST(sharp, notes_what_was_made_of_an_stl_file) {
  const TemporaryFolder folder;
  const std::string box = folder.file("box.stl");
  std::ofstream(box) << stl_box(40, 20, 10);
  for (const std::string command : {"info", "bound", "eval", "subdivide"}) {
    std::vector<std::string> arguments{command, box, "--sharp", "auto"};
    if (command == "subdivide") arguments.insert(arguments.end(), {"-o", folder.file("out.obj")});
    const Outcome sharp = run_snug(arguments);
    EXPECT_EQ(sharp.status, 0) << sharp.err;
    EXPECT_NE(sharp.err.find("18 creases"), std::string::npos) << command << sharp.err;
    arguments.emplace_back("--quiet");
    EXPECT_EQ(run_snug(arguments).err, "") << command;
  }
}

TEST(sharp, shows_in_info_how_far_the_limit_surface_is_from_the_faces) {
  const TemporaryFolder folder;
  const std::string box = folder.file("box.stl");
  std::ofstream(box) << stl_box(40, 20, 10);
  const auto apart = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"info", box, "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return nlohmann::json::parse(run_snug(arguments).out)["limit_to_faces"];
  };
  EXPECT_EQ(apart({}).get<double>(), 0);
  EXPECT_NEAR(apart({"--scheme", "loop"}).get<double>(), 13.91, 0.02);
  EXPECT_EQ(apart({"--sharp", "auto"}).get<double>(), 0);
  EXPECT_EQ(apart({"--scheme", "flat"}).get<double>(), 0);
  EXPECT_TRUE(apart({"--scheme", "doo-sabin"}).is_null());
}

TEST(sharp, is_refused_where_there_are_no_creases_and_where_it_is_no_angle) {
  const std::string cube = six_sheets("0.0");
  for (const char* angle : {"-1", "180", "sharp", "", "30deg", "nan"}) {
    const Outcome bad = run_snug({"info", "-", "--sharp", angle}, cube);
    if (std::string(angle).empty()) continue;
    EXPECT_EQ(bad.status, 2) << angle;
    EXPECT_NE(bad.err.find("--sharp"), std::string::npos) << bad.err;
  }
  const Outcome dual =
      run_snug({"bound", "-", "--weld", "0", "--sharp", "auto", "--scheme", "midedge"}, cube);
  EXPECT_EQ(dual.status, 2);
  EXPECT_NE(dual.err.find("has no creases"), std::string::npos) << dual.err;
  EXPECT_EQ(run_snug({"bound", "-", "--sharp", "auto"}, "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n").status, 2);
}

TEST(sharp, says_which_faces_it_split) {
  const std::string prism =
      "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 2 2 0\nv 2 4 0\nv 0 4 0\nv 0 0 1\nv 4 0 1\nv 4 2 1\nv 2 2 1\nv 2 4 1\nv "
      "0 4 1\n"
      "f 6 5 4 3 2 1\nf 7 8 9 10 11 12\nf 1 2 8 7\nf 2 3 9 8\nf 3 4 10 9\nf 4 5 11 10\nf 5 6 12 11\nf 6 1 7 "
      "12\n";
  const Outcome info = run_snug({"info", "-", "--sharp", "auto", "--json"}, prism);
  EXPECT_NE(info.err.find("2 of their faces"), std::string::npos) << info.err;
  const nlohmann::json answer = nlohmann::json::parse(info.out);
  EXPECT_EQ(answer["faces"], 14);
  EXPECT_EQ(answer["limit_to_faces"], 0);
}

// For who has them: SNUG_EXTRA_MODELS names a folder with cad/box.stl, cad/plate.stl and cad/pin.stl.
TEST(sharp, gives_known_parts_their_known_clearance) {
  const char* folder = std::getenv("SNUG_EXTRA_MODELS");
  if (!folder) GTEST_SKIP() << "SNUG_EXTRA_MODELS names no folder";
  const std::string cad = std::string(folder) + "/cad/";
  const auto ask = [&](const std::string& command, const std::string& a, const std::string& b,
                       const std::string& shift) {
    std::vector<std::string> arguments{command,   cad + a,     cad + b,
                                       "--sharp", "auto",      "--json",
                                       "--quiet", "--place-b", "1 0 0 " + shift + " 0 1 0 0 0 0 1 0"};
    arguments.insert(arguments.end(), {command == "collide" ? "--tolerance" : "--absolute", "1e-9"});
    return nlohmann::json::parse(run_snug(arguments).out);
  };
  const nlohmann::json boxes = ask("distance", "box.stl", "box.stl", "41")["distance"];
  EXPECT_NEAR(boxes[0].get<double>(), 1, 1e-9);
  EXPECT_NEAR(boxes[1].get<double>(), 1, 1e-9);
  EXPECT_NE(ask("collide", "box.stl", "box.stl", "35")["verdict"], "separated");
  const nlohmann::json centred = ask("distance", "plate.stl", "pin.stl", "0")["distance"];
  EXPECT_GE(centred[0].get<double>(), 0.1998);
  EXPECT_LE(centred[1].get<double>(), 0.1999);
  EXPECT_EQ(ask("collide", "plate.stl", "pin.stl", "0.3")["verdict"], "intersecting");
}

}  // namespace
}  // namespace snug::testing::cad_test
