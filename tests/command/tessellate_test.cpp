#include <snug/mesh.h>
#include <snug/mesh/topology.h>
#include <support/read_file.h>

#include <gtest/gtest.h>

#include <testing/counts.h>
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "run_snug.h"

namespace snug::testing::tessellate_test {
namespace {

nlohmann::json answer(std::vector<std::string> arguments, int status = 0) {
  arguments.insert(arguments.begin(), "tessellate");
  arguments.emplace_back("--json");
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  return nlohmann::json::parse(outcome.out);
}

void expect_refused(std::vector<std::string> arguments, int status, const std::string& text) {
  arguments.insert(arguments.begin(), "tessellate");
  const Outcome outcome = run_snug(arguments);
  EXPECT_EQ(outcome.status, status) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
}

TEST(tessellate, writes_closed_triangles_in_every_format) {
  const TemporaryFolder folder;
  for (const char* const format : {"obj", "off", "ply", "stl"}) {
    const std::string file = folder.file(std::string("pawn.") + format);
    const auto json = answer({model("pawn.obj"), "--error", "0.03", "-o", file});
    EXPECT_EQ(json["outcome"], "complete");
    EXPECT_GT(json["error_bound"], 0);
    EXPECT_LE(json["error_bound"], 0.03);
    ReadOptions reading;
    if (std::string(format) == "stl") reading.weld = [](double) { return 0.0; };
    const ControlMesh mesh = read_mesh(file, reading);
    EXPECT_EQ(mesh.face_count(), json["triangles"]) << format;
    EXPECT_EQ(mesh.vertex_count(), json["vertices"]) << format;
    const Topology topology(mesh);
    EXPECT_TRUE(topology.is_manifold()) << format;
    EXPECT_EQ(2 * topology.edge_count(), 3 * mesh.face_count()) << format;
    for (std::size_t e = 0; e < topology.edge_count(); ++e)
      EXPECT_FALSE(topology.ends_fans(EdgeId(e))) << format;
  }
}

TEST(tessellate, writes_gltf_with_normals) {
  const TemporaryFolder folder;
  const std::string file = folder.file("pawn.glb");
  const auto json = answer({model("pawn.obj"), "--error", "1%", "-o", file});
  const std::string bytes = read_file(file, {});
  EXPECT_NE(bytes.find("\"NORMAL\":2"), std::string::npos);
  EXPECT_GT(bytes.size(),
            24 * json["vertices"].get<std::size_t>() + 12 * json["triangles"].get<std::size_t>());
}

// Floats are off by more than doubles, and the error says so.
TEST(tessellate, states_the_error_of_floats) {
  const TemporaryFolder folder;
  const auto doubles = answer({model("pawn.obj"), "--error", "1%", "-o", folder.file("a.ply")}),
             floats = answer({model("pawn.obj"), "--error", "1%", "-o", folder.file("a.stl")});
  EXPECT_GT(floats["position_error"], 1e-9);
  EXPECT_LT(doubles["position_error"], 1e-13);
}

// Fewer triangles than faces, closed, and another command proves that they are near.
TEST(tessellate, holds_what_is_seen_and_thicknesses) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.off"), pawn = model("pawn.obj");
  EXPECT_GT(answer({pawn, "--eye", "0 0 9", "-o", file})["triangles"],
            answer({pawn, "--eye", "0 0 90", "-o", file})["triangles"]);
  EXPECT_GT(answer({pawn, "--eye", "0,0,9", "--eye-angle", "0.01", "-o", file})["triangles"],
            answer({pawn, "--eye", "0 0 9", "-o", file})["triangles"]);
  EXPECT_GT(answer({pawn, "--max-thickness", "1%", "-o", file})["triangles"],
            answer({pawn, "--max-thickness", "5%", "-o", file})["triangles"]);
  expect_refused({pawn, "--eye", "0 0", "-o", file}, 2, "--eye: '0 0' is not a point");
}

TEST(tessellate, coarsens_below_the_number_of_faces) {
  const TemporaryFolder folder;
  const std::string bust = model("bust.obj");
  const std::string file = folder.file("bust.stl");
  // At 10 % the waist closes. Sanitizers make 3 % too long.
  const bool whole = testing::fewer(4) == 4;
  for (const char* const error : whole ? std::vector{"3%", "10%"} : std::vector{"10%"}) {
    const auto json = answer({bust, "--error", error, "--coarsen", "-o", file});
    EXPECT_LT(json["triangles"], 400) << "bust has 1398 faces";
    const auto judged =
        nlohmann::json::parse(run_snug({"deviation", bust, file, "--threshold", error, "--json"}).out);
    EXPECT_EQ(judged["verdict"], "within");
    ReadOptions reading;
    reading.weld = [](double) { return 0.0; };
    const ControlMesh mesh = read_mesh(file, reading);
    EXPECT_EQ(mesh.face_count(), json["triangles"]);
    const Topology topology(mesh);
    for (std::size_t e = 0; e < topology.edge_count(); ++e) EXPECT_FALSE(topology.ends_fans(EdgeId(e)));
  }
  expect_refused({bust, "--coarsen", "--max-edge", "1%", "-o", folder.file("a.ply")}, 2,
                 "--coarsen goes with --error");
  expect_refused({bust, "--coarsen", "--error", "1%", "--max-angle", "9", "-o", folder.file("a.ply")}, 2,
                 "--coarsen goes with --error");
}

TEST(tessellate, holds_numbers_of_triangles_edges_and_angles) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.off"), pawn = model("pawn.obj");
  EXPECT_LE(answer({pawn, "--max-triangles", "2000", "-o", file})["triangles"], 2000);
  EXPECT_GT(answer({pawn, "--max-edge", "2%", "-o", file})["triangles"], 5000);
  EXPECT_GT(answer({pawn, "--error", "1%", "--max-angle", "10", "-o", file})["triangles"],
            answer({pawn, "--error", "1%", "-o", file})["triangles"]);
  const auto ended = answer({pawn, "--error", "0.001%", "--max-splits", "3000", "-o", file}, 5);
  EXPECT_EQ(ended["outcome"], "budget-spent");
  EXPECT_LE(ended["triangles"], 3000);
}

TEST(tessellate, does_not_depend_on_threads) {
  const TemporaryFolder folder;
  const std::string one = folder.file("one.ply"), three = folder.file("three.ply");
  answer({model("ring.obj"), "--error", "0.1%", "-o", one, "--threads", "1"});
  answer({model("ring.obj"), "--error", "0.1%", "-o", three, "--threads", "3"});
  EXPECT_EQ(read_file(one, {}), read_file(three, {}));
}

TEST(tessellate, says_what_is_wrong) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.off"), pawn = model("pawn.obj");
  expect_refused({pawn, "--error", "1%"}, 2, "-o FILE is missing");
  expect_refused({pawn, "-o", file}, 2, "--error");
  expect_refused({pawn, "--error", "-1", "-o", file}, 2, "--error");
  expect_refused({pawn, "--error", "1%", "-o", folder.file("a.txt")}, 3, "written to");
  expect_refused({pawn, "--error", "1e-20", "-o", file}, 4, "take ");
  expect_refused({pawn, "--error", "1e-8", "-o", folder.file("a.stl")}, 4, "single precision");
  expect_refused({pawn, "--max-triangles", "3", "-o", file}, 4, "take ");
  EXPECT_TRUE(folder.empty());
}

TEST(tessellate, leaves_nothing_after_a_signal) {
  const TemporaryFolder folder;
  const Outcome outcome = interrupt_snug(
      {"tessellate", model("bust.obj"), "--error", "0.00002%", "-o", folder.file("a.ply")}, 300);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_TRUE(folder.empty());
}

}  // namespace
}  // namespace snug::testing::tessellate_test
