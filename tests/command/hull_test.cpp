#include <snug/mesh.h>
#include <snug/mesh/topology.h>
#include <support/read_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::hull_test {
namespace {

using nlohmann::json;

json answer(std::vector<std::string> arguments, int status = 0) {
  arguments.emplace_back("--json");
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return json::parse(outcome.out);
}

void expect_refused(const std::vector<std::string>& arguments, int status, const std::string& text) {
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

ControlMesh read_closed(const std::string& file) {
  ReadOptions reading;
  if (file.ends_with("stl")) reading.weld = [](double) { return 0.0; };
  ControlMesh mesh = read_mesh(file, reading);
  const Topology topology(mesh);
  EXPECT_TRUE(topology.is_manifold()) << file;
  EXPECT_EQ(2 * topology.edge_count(), 3 * mesh.face_count()) << file;
  return mesh;
}

std::string write(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.file(name)) << text;
  return folder.file(name);
}

constexpr const char* cube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
constexpr const char* moebius =
    "v 0 0 0\nv 2 0 1\nv 1 2 0\nv 0 0 1\nv 2 0 0\nv 1 2 1\n"
    "f 1 2 5 4\nf 2 3 6 5\nf 3 4 1 6\n";

// The files as they are read again are apart from the surface, and on the right sides.
TEST(hull, writes_verified_triangles_in_every_format) {
  const TemporaryFolder folder;
  const std::string pawn = model("pawn.obj");
  for (const char* const format : {"obj", "off", "ply", "stl"}) {
    const std::string inner = folder.file(std::string("in.") + format),
                      outer = folder.file(std::string("out.") + format);
    const json found = answer({"hull", pawn, "--error", "2%", "--inner", inner, "--outer", outer});
    EXPECT_EQ(found["command"], "hull");
    EXPECT_EQ(found["scheme"], "loop");
    EXPECT_EQ(found["outcome"], "complete");
    EXPECT_TRUE(found["closed"]);
    EXPECT_EQ(found["problems"], json::array());
    for (const auto& [side, file] : {std::pair{"inner", inner}, {"outer", outer}}) {
      EXPECT_LE(found[side]["gap"], found["error"]);
      const ControlMesh mesh = read_closed(file);
      EXPECT_EQ(mesh.face_count(), found[side]["triangles"]) << format;
      EXPECT_EQ(mesh.vertex_count(), found[side]["vertices"]) << format;
      const json apart = answer({"collide", file, pawn, "--scheme-a", "flat", "--tolerance", "0", "--solid"});
      EXPECT_EQ(apart["contained"], std::string(side) == "inner" ? "a" : "b") << format;
      EXPECT_EQ(answer({"collide", file, pawn, "--scheme-a", "flat", "--tolerance", "0"})["verdict"],
                "separated");
    }
  }
}

TEST(hull, tells_people_what_was_written) {
  const TemporaryFolder folder;
  const Outcome outcome =
      run_snug({"hull", model("pawn.obj"), "--error", "2%", "--outer", folder.file("out.ply")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("out.ply: outer hull of "), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.out.find("inner"), std::string::npos);
}

TEST(hull, of_one_side_says_null_of_the_other) {
  const TemporaryFolder folder;
  const json found = answer({"hull", model("pawn.obj"), "--error", "2%", "--inner", folder.file("in.ply")});
  EXPECT_EQ(found["outer"], nullptr);
  EXPECT_FALSE(found["inner"].is_null());
}

TEST(hull, of_open_surfaces_says_so) {
  const TemporaryFolder folder;
  const std::string sheet = write(folder, "sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.2\nv 0 1 0\nf 1 2 3 4\n");
  const Outcome outcome = run_snug({"hull", sheet, "--error", "5%", "--outer", folder.file("out.ply")});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("the surface is open"), std::string::npos) << outcome.out;
  EXPECT_FALSE(answer({"hull", sheet, "--error", "5%", "--outer", folder.file("out.ply")})["closed"]);
}

// Two cubes on each other, and their names.
TEST(hull, writes_nothing_that_is_not_verified) {
  const TemporaryFolder folder, results;
  const std::string touching = write(folder, "touching.obj",
                                     std::string(cube) +
                                         "v 1 0 0\nv 2 0 0\nv 1 1 0\nv 2 1 0\nv 1 0 1\nv 2 0 1\nv 1 1 1\n"
                                         "v 2 1 1\nf 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\n"
                                         "f 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n");
  const std::vector<std::string> arguments{"hull",     touching,
                                           "--scheme", "bilinear",
                                           "--error",  "1%",
                                           "--inner",  results.file("in.obj"),
                                           "--outer",  results.file("out.obj"),
                                           "--quiet"};
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, 5);
  EXPECT_NE(outcome.out.find("not proved, so nothing was written"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("outer hull at face 5, near ("), std::string::npos) << outcome.out;
  EXPECT_LE(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 12);
  const json found = answer(arguments, 5);
  EXPECT_NE(found["outcome"], "complete");
  EXPECT_GE(found["problems"].size(), 1u);
  EXPECT_LE(found["problems"].size(), 10u);
  for (const json& problem : found["problems"]) {
    EXPECT_TRUE(problem["face"].is_number()) << problem;
    EXPECT_EQ(problem["place"].size(), 3u);
    EXPECT_FALSE(problem["fault"].get<std::string>().empty());
  }
  EXPECT_TRUE(results.empty());
}

TEST(hull, says_what_is_wrong) {
  const TemporaryFolder folder, sources;
  const std::string pawn = model("pawn.obj"), file = folder.file("a.ply");
  expect_refused({"hull", pawn, "--error", "1%"}, 2, "--inner FILE");
  expect_refused({"hull", pawn, "--inner", file}, 2, "--error");
  expect_refused({"hull", pawn, "--error", "0", "--inner", file}, 2, "--error");
  expect_refused({"hull", pawn, "--error", "1%", "--inner", file, "--outer", file}, 2, "the same file");
  expect_refused({"hull", pawn, "--error", "1%", "--inner", "-"}, 2, "standard output");
  expect_refused({"hull", pawn, "--error", "1%", "--inner", folder.file("a.txt")}, 3, "written to");
  expect_refused({"hull", pawn, "--error", "1%", "--inner", file, "-o", folder.file("a.obj")}, 2, "json");
  expect_refused({"hull", pawn, "--error", "200%", "--inner", file}, 4, "at most ");
  expect_refused({"hull", pawn, "--error", "1e-20", "--inner", file}, 4, "doubles allow");
  expect_refused({"hull", pawn, "--error", "1e-7", "--inner", folder.file("a.stl")}, 4, "floats allow");
  expect_refused({"hull", write(sources, "m.obj", moebius), "--error", "1%", "--inner", file}, 4,
                 "the same way");
  EXPECT_TRUE(folder.empty());
}

TEST(hull, leaves_nothing_after_a_signal) {
  const TemporaryFolder folder;
  const Outcome outcome = interrupt_snug({"hull", model("bust.obj"), "--error", "0.001%", "--inner",
                                          folder.file("a.ply"), "--outer", folder.file("b.ply")},
                                         300);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_TRUE(folder.empty());
}

TEST(hull, does_not_depend_on_threads) {
  const TemporaryFolder folder;
  const std::string one = folder.file("one.ply"), three = folder.file("three.ply");
  answer({"hull", model("ring.obj"), "--error", "1%", "--outer", one, "--threads", "1"});
  answer({"hull", model("ring.obj"), "--error", "1%", "--outer", three, "--threads", "3"});
  EXPECT_EQ(read_file(one, {}), read_file(three, {}));
}

TEST(envelope, is_closed_and_around_the_surface) {
  const TemporaryFolder folder, sources;
  // A solid, a sheet, and a solid in floats.
  const std::string sheet = write(sources, "sheet.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n");
  for (const auto& [mesh, file] : {std::pair{model("pawn.obj"), folder.file("a.ply")},
                                   {sheet, folder.file("b.ply")},
                                   {model("bracket.obj"), folder.file("c.stl")}}) {
    const json found = answer({"envelope", mesh, "--error", "2%", "--clearance", "0.5%", "-o", file});
    EXPECT_EQ(found["outcome"], "complete");
    EXPECT_EQ(found["envelope"]["gap"], found["error"]);
    EXPECT_LE(found["volume"][0], found["volume"][1]);
    EXPECT_EQ(read_closed(file).face_count(), found["envelope"]["triangles"]);
    const json apart =
        answer({"distance", file, mesh, "--scheme-a", "flat", "--relative", "1e-3", "--absolute", "1e-6"});
    EXPECT_GE(apart["distance"][1], found["clearance"]);
    EXPECT_GE(static_cast<double>(apart["distance"][0]) * 1.01, found["clearance"]) << mesh;
    const json far = answer({"deviation", mesh, file, "--absolute", "0.1%"});
    EXPECT_LE(far["from_candidate"][0], found["error"]);
    EXPECT_LE(static_cast<double>(far["from_candidate"][1]) * 0.9, found["error"]) << mesh;
    EXPECT_EQ(answer({"self-contact", file, "--scheme", "flat"})["verdict"], "clear") << mesh;
  }
}

// Finer than its cubes go the outer hull is made, of solids alone.
TEST(envelope, is_a_hull_where_the_error_is_small) {
  const TemporaryFolder folder;
  const std::string pawn = model("pawn.obj"), file = folder.file("around.ply");
  EXPECT_EQ(run_snug({"envelope", pawn, "--error", "1%", "--max-splits", "1000", "-o", file}).status, 5);
  EXPECT_TRUE(folder.empty());
  const json fine = answer({"envelope", pawn, "--error", "0.3%", "--max-splits", "50000", "-o", file});
  EXPECT_EQ(fine["outcome"], "complete");
  EXPECT_EQ(fine["clearance"], 0);
  EXPECT_LE(fine["envelope"]["gap"], fine["error"]);
  EXPECT_EQ(answer({"collide", file, pawn, "--scheme-a", "flat", "--tolerance", "0", "--solid"})["contained"],
            "b");
}

TEST(envelope, tells_whether_a_part_is_inside) {
  const TemporaryFolder folder;
  const std::string whole = write(folder, "cube.obj", cube);
  // The same cube smaller inside, through a face, and beside.
  const auto part = [&](double size, double x) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      text += "v " + std::to_string(x + (i & 1 ? size : 0)) + " " + std::to_string(0.4 + (i & 2 ? size : 0)) +
              " " + std::to_string(0.4 + (i & 4 ? size : 0)) + "\n";
    }
    return write(folder, "part.obj", text + std::string(cube).substr(std::string(cube).find('f')));
  };
  for (const auto& [x, inside] : {std::pair{0.4, true}, {0.8, false}, {1.5, false}}) {
    const json found =
        answer({"envelope", whole, "--error", "2%", "--scheme", "catmark", "--part", part(0.2, x)});
    EXPECT_EQ(found["part"]["inside"], inside) << x;
    EXPECT_EQ(found["part"]["clearance"][1] == 0, x == 0.8) << found;
  }
  // The surface that it is around: its clearance is within the gap.
  const json own = answer({"envelope", whole, "--error", "2%", "--part", whole});
  EXPECT_EQ(own["part"]["inside"], true);
  EXPECT_GT(own["part"]["clearance"][0], 0);
  EXPECT_LE(own["part"]["clearance"][1], own["envelope"]["gap"]);
  const Outcome outcome = run_snug({"envelope", whole, "--error", "2%", "--part", part(0.2, 1.5)});
  EXPECT_NE(outcome.out.find("is outside the envelope"), std::string::npos) << outcome.out;
}

TEST(envelope, closes_holes_up_to_a_gap_and_says_how_far_off_it_is_there) {
  const TemporaryFolder folder;
  // A square tube, open at both ends.
  const std::string open = write(folder, "tube.obj",
                                 "v 0 0 0\nv .2 0 0\nv .2 .2 0\nv 0 .2 0\nv 0 0 1\nv .2 0 1\nv .2 .2 1\n"
                                 "v 0 .2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  const std::string file = folder.file("a.ply");
  const std::vector<std::string> words{"envelope", open, "--scheme", "bilinear", "--error", "2%", "-o", file};
  const auto with_gap = [&](const std::string& gap) {
    std::vector<std::string> all = words;
    all.insert(all.end(), {"--gap", gap});
    return all;
  };
  const json thin = answer(words), filled = answer(with_gap("24%"));
  EXPECT_FALSE(thin.contains("bridges"));
  EXPECT_LT(thin["volume"][1], 0.03);
  EXPECT_GT(filled["volume"][0], 0.04);
  EXPECT_EQ(filled["bridges"]["diameter"], 0.24);
  EXPECT_GT(filled["bridges"]["triangles"], 0);
  EXPECT_GT(filled["bridges"]["distance"], filled["error"]);
  EXPECT_EQ(filled["bridges"]["distance"], filled["envelope"]["gap"]);
  EXPECT_NE(run_snug(with_gap("24%")).out.find("ball of diameter 0.24"), std::string::npos);
  expect_refused(with_gap("3%"), 4, "twice the error");
  expect_refused(with_gap("a"), 2, "--gap");
}

TEST(envelope, of_a_scene_is_around_all_of_its_parts) {
  const TemporaryFolder folder;
  json scene{{"parts", json::array()}};
  scene["parts"].push_back({{"mesh", model("bracket.obj")}});
  scene["parts"].push_back({{"mesh", model("pin.obj")}, {"place", {{"move", {3, 0, 0}}}}});
  const std::string name = folder.file("scene.json"), file = folder.file("a.ply");
  std::ofstream(name) << scene.dump();
  const json found = answer({"envelope", "--scene", name, "--error", "2%", "-o", file});
  EXPECT_EQ(found["outcome"], "complete");
  EXPECT_EQ(found["scene"], name);
  EXPECT_EQ(found["mesh"].size(), 2);
  // Percent of the box around both, which is longer than either.
  EXPECT_GT(found["error"], 0.06);
  for (const auto& [mesh, move] : {std::pair{model("bracket.obj"), "0 0 0"}, {model("pin.obj"), "3 0 0"}}) {
    const json in = answer({"collide", file, mesh, "--move-b", move, "--scheme-a", "flat", "--solid",
                            "--tolerance", "0", "--margin", "0"});
    EXPECT_EQ(in["verdict"], "intersecting") << mesh;
    EXPECT_EQ(in["contained"], "b") << mesh;
  }
  expect_refused({"envelope", model("pin.obj"), "--scene", name, "--error", "1%", "-o", file}, 2, "exclude");
}

TEST(envelope, says_what_is_wrong) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.stl");
  expect_refused({"envelope", model("pawn.obj"), "--error", "1%", "--clearance", "1%", "-o", file}, 4,
                 "less than the error");
  expect_refused({"envelope", model("pawn.obj"), "--error", "60%", "-o", file}, 4, "half");
  expect_refused({"envelope", model("pawn.obj"), "--error", "1%"}, 2, "--part");
  expect_refused({"envelope", model("pawn.obj"), "-o", file}, 2, "--error");
  expect_refused({"envelope", model("pawn.obj"), "--error", "1%", "-o", "-"}, 2, "standard output");
  expect_refused({"envelope", model("pawn.obj"), "--error", "1%", "-o", folder.file("a.json")}, 3,
                 "written to");
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace snug::testing::hull_test
