// fit, as people script it.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <command/run_snug.h>
#include <snug/mesh.h>
#include <support/point.h>

namespace snug::testing::fit_test {
namespace {

using nlohmann::json;

constexpr const char* cube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

class fit_command : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  // The mesh with control points moved a little.
  std::string moved(const std::string& path, double by) {
    ControlMesh mesh = read_mesh(path);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> distance(-by, by);
    for (Point3& p : mesh.points) p = p + Vector3{distance(random), distance(random), distance(random)};
    write_mesh(mesh, folder_.file("moved.obj"));
    return folder_.file("moved.obj");
  }
  // Limit points of a mesh: "x y z", and where they are.
  std::string points_of(const std::string& path, const std::string& scheme, unsigned samples,
                        bool with_place) {
    const Outcome outcome =
        run_snug({"eval", path, "--scheme", scheme, "--samples", std::to_string(samples), "--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::ostringstream text;
    text.precision(17);
    const json answer = json::parse(outcome.out);
    for (const json& at : answer["points"]) {
      for (const json& x : at["point"]) text << x.get<double>() << ' ';
      if (with_place) {
        text << (at.contains("face") ? at["face"] : at["vertex"]).get<unsigned>() << ' '
             << at["u"].get<double>() << ' ' << at["v"].get<double>();
        if (at.contains("corner")) text << ' ' << at["corner"].get<unsigned>();
      }
      text << '\n';
    }
    return write("points.txt", text.str());
  }
  [[nodiscard]] std::string output() const { return folder_.file("out.obj"); }
  json answer(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "fit");
    arguments.insert(arguments.end(), {"-o", output(), "--json"});
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out, nullptr, false);
  }
  void expect_refused(std::vector<std::string> arguments, int status, const std::vector<std::string>& parts) {
    arguments.insert(arguments.begin(), "fit");
    arguments.insert(arguments.end(), {"-o", output()});
    const Outcome outcome = run_research(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    for (const std::string& part : parts) EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
    EXPECT_FALSE(std::ifstream(output()).good());
  }
  static double farthest(const ControlMesh& a, const ControlMesh& b) {
    EXPECT_EQ(a.vertex_count(), b.vertex_count());
    double most = 0;
    for (std::size_t v = 0; v < a.vertex_count(); ++v) {
      for (std::size_t x = 0; x < 3; ++x) most = std::max(most, std::fabs(a.points[v][x] - b.points[v][x]));
    }
    return most;
  }

  TemporaryFolder folder_;
};

// Quads beside triangles, a five-cornered face and a crease; closed and open; every scheme.
TEST_F(fit_command, finds_the_control_points_of_given_places) {
  const std::string house = write("house.obj",
                                  "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                  "v .5 0 1.7\nv .5 1 1.6\n"
                                  "f 4 3 2 1\nf 1 2 6 9 5\nf 3 4 8 10 7\nf 2 3 7 6\nf 4 1 5 8\nf 6 7 10 9\n"
                                  "f 5 9 8\nf 9 10 8\nt crease 2/1/0 8 9 3\n");
  struct Case {
    std::string mesh, scheme;
  };
  for (const auto& [mesh, scheme] : {Case{house, "catmark"},
                                     {house, "doo-sabin"},
                                     {house, "midedge"},
                                     {model("pawn.obj"), "loop"},
                                     {model("bracket.obj"), "catmark"},
                                     {write("cube.obj", cube), "bilinear"}}) {
    SCOPED_TRACE(mesh + " " + scheme);
    const std::string points = points_of(mesh, scheme, 3, true);
    const json found = answer({moved(mesh, 0.1), "--scheme", scheme, "--points", points});
    EXPECT_EQ(found["command"], "fit");
    EXPECT_EQ(found["scheme"], scheme);
    EXPECT_EQ(found["rounds"], 1);
    EXPECT_EQ(found["rank"], found["dimension"]);
    EXPECT_EQ(found["kernel"], json::array());
    EXPECT_LT(found["residual"]["max"], 1e-12);
    EXPECT_LE(found["residual"]["rms"], found["residual"]["max"]);
    const ControlMesh expected = read_mesh(mesh), got = read_mesh(output());
    EXPECT_EQ(found["dimension"], expected.vertex_count());
    EXPECT_LT(farthest(expected, got), 1e-9);
    EXPECT_EQ(expected.face_vertices, got.face_vertices);
    EXPECT_EQ(expected.tags.creases.size(), got.tags.creases.size());
  }
}

TEST_F(fit_command, does_not_mind_the_size) {
  for (const double scale : {1e-200, 1e-5, 1e200}) {
    ControlMesh mesh = read_mesh(model("bracket.obj"));
    for (Point3& p : mesh.points) p = {scale * p.x, scale * p.y, scale * p.z};
    const std::string path = folder_.file("scaled.obj");
    write_mesh(mesh, path);
    const json found = answer({moved(path, 0.1 * scale), "--points", points_of(path, "catmark", 3, true)});
    EXPECT_EQ(found["rounds"], 1);
    EXPECT_LT(found["residual"]["rms"], 1e-12 * scale);
    EXPECT_LT(farthest(mesh, read_mesh(output())), 1e-9 * scale);
  }
}

TEST_F(fit_command, comes_nearer_from_round_to_round) {
  const std::string pawn = model("pawn.obj"), points = points_of(pawn, "loop", 3, false),
                    begin = moved(pawn, 0.003);
  double last = 1;
  for (const char* rounds : {"1", "3", "6"}) {
    const json found = answer({begin, "--points", points, "--rounds", rounds});
    EXPECT_LT(found["residual"]["rms"], last);
    EXPECT_LE(found["rounds"], std::stoi(rounds));
    last = found["residual"]["rms"];
  }
  EXPECT_LT(last, 3e-4);
  const std::string fitted = output();
  EXPECT_LT(farthest(read_mesh(pawn), read_mesh(fitted)), 0.05);
}

TEST_F(fit_command, says_where_a_budget_ended_closest_points) {
  const std::string pawn = model("pawn.obj"), points = points_of(pawn, "loop", 3, false);
  const Outcome outcome = run_research(
      {"fit", moved(pawn, 0.003), "--points", points, "--max-splits", "1", "-o", output(), "--json"});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["reached"], false);
  EXPECT_EQ(answer({moved(pawn, 0.003), "--points", points})["reached"], true);
}

TEST_F(fit_command, ends_where_the_residual_no_longer_falls) {
  const std::string box = write("cube.obj", cube);
  const json found = answer(
      {box, "--scheme", "doo-sabin", "--points", points_of(box, "doo-sabin", 2, false), "--rounds", "60"});
  EXPECT_LT(found["rounds"], 60);
  EXPECT_LT(found["residual"]["max"], 1e-5);
}

// The numbers are those of the mesh that was written.
TEST_F(fit_command, tells_the_residual_of_what_it_wrote) {
  const std::string pawn = model("pawn.obj");
  const json found =
      answer({moved(pawn, 0.01), "--points", points_of(pawn, "loop", 2, false), "--rounds", "2"});
  const Outcome closest = run_snug(
      {"closest", output(), "--points", folder_.file("points.txt"), "--precision", "0.00001%", "--json"});
  double sum = 0, most = 0;
  const json results = json::parse(closest.out)["results"];
  for (const json& result : results) {
    const double d = result["distance"][1];
    most = std::max(most, d);
    sum += d * d;
  }
  EXPECT_EQ(found["points"], results.size());
  EXPECT_NEAR(found["residual"]["max"], most, 1e-6);
  EXPECT_NEAR(found["residual"]["rms"], std::sqrt(sum / static_cast<double>(results.size())), 1e-6);
}

TEST_F(fit_command, names_the_kernel_of_a_cube) {
  const std::string box = write("cube.obj", cube);
  for (const std::string scheme : {"catmark", "midedge"}) {
    const std::string points = points_of(box, scheme, 4, true);
    const std::string begin = moved(box, 0.1);
    expect_refused(
        {begin, "--scheme", scheme, "--points", points}, 4,
        {"moved.obj: ", scheme, "control points 0, 1, 2, 3, 4, 5, 6, 7", "--smooth", "--least-change"});
    const json found = answer({begin, "--scheme", scheme, "--points", points, "--least-change"});
    EXPECT_EQ(found["rank"], 7);
    EXPECT_EQ(found["dimension"], 8);
    EXPECT_LT(found["residual"]["max"], 1e-12);
    ASSERT_EQ(found["kernel"].size(), 1);
    EXPECT_EQ(found["kernel"][0]["vertices"], (json{0, 1, 2, 3, 4, 5, 6, 7}));
    const json signs = found["kernel"][0]["signs"];
    EXPECT_EQ(signs, (json{1, -1, -1, 1, -1, 1, 1, -1}));
    // The change has no part in the kernel, and is all of the difference otherwise.
    const ControlMesh before = read_mesh(begin), after = read_mesh(output()), truth = read_mesh(box);
    for (std::size_t x = 0; x < 3; ++x) {
      double along = 0, missed = 0;
      for (std::size_t v = 0; v < 8; ++v) {
        along += signs[v].get<int>() * (after.points[v][x] - before.points[v][x]);
        missed += signs[v].get<int>() * (truth.points[v][x] - after.points[v][x]) / 8;
      }
      EXPECT_NEAR(along, 0, 1e-12);
      for (std::size_t v = 0; v < 8; ++v) {
        EXPECT_NEAR(after.points[v][x] + signs[v].get<int>() * missed, truth.points[v][x], 1e-9);
      }
    }
    std::remove(output().c_str());
  }
  // Smoothing makes it regular.
  const json found =
      answer({moved(box, 0.1), "--points", points_of(box, "catmark", 4, true), "--smooth", "0.01"});
  EXPECT_EQ(found["rank"], 8);
  EXPECT_LT(found["residual"]["rms"], 0.05);
}

TEST_F(fit_command, refuses_too_few_points) {
  const std::string pawn = model("pawn.obj");
  const std::string one = write("one.txt", "0 0 0 5 0.2 0.3\n");
  expect_refused({pawn, "--points", one}, 4, {"122 of 133 have no point on the surface near them: "});
  // Every control point has a sample, and still there are too few.
  std::string corners;
  const std::size_t faces = read_mesh(model("bracket.obj")).face_count();
  for (std::size_t f = 0; f < faces; ++f) corners += "0 0 0 " + std::to_string(f) + " 0.5 0.5\n";
  expect_refused({model("bracket.obj"), "--points", write("few.txt", corners)}, 4, {"numerical rank "});
  EXPECT_EQ(answer({pawn, "--points", one, "--least-change"})["rank"], 1);
  EXPECT_EQ(answer({pawn, "--points", one, "--smooth", "1"})["rank"], 133);
}

TEST_F(fit_command, refuses_isolated_vertices_by_number) {
  const std::string points = points_of(model("pawn.obj"), "loop", 3, true);
  ControlMesh mesh = read_mesh(model("pawn.obj"));
  mesh.points.push_back({5, 5, 5});
  write_mesh(mesh, folder_.file("more.obj"));
  expect_refused({folder_.file("more.obj"), "--points", points}, 4, {"1 of 134 have no point", ": 133;"});
  EXPECT_EQ(answer({folder_.file("more.obj"), "--points", points, "--least-change"})["rank"], 133);
  EXPECT_EQ(read_mesh(output()).points.back(), (Point3{5, 5, 5}));
}

TEST_F(fit_command, names_the_line_that_is_no_sample) {
  const std::string pawn = model("pawn.obj");
  const auto expect = [&](const std::string& text, int status, const std::string& part) {
    expect_refused({pawn, "--points", write("bad.txt", text)}, status, {"bad.txt", part});
  };
  expect("0 0 0\n# a comment\n\n0 nan 0\n", 3, ":4: a line is 'x y z'");
  expect("0 0 inf\n", 3, ":1: ");
  expect("0 0\n", 3, ":1: ");
  expect("0 0 0\n0 0 0 1 0.5 0.5\n", 3, ":2: give all points a place");
  expect("0 0 0 1 0.5 0.5\n0 0 0\n", 3, ":2: give all points a place");
  expect("0 0 0 1 0.5\n", 3, ":1: a line is 'x y z face u v'");
  expect("0 0 0 1 nan 0\n", 3, ":1: u and v must be");
  expect("0 0 0 1 0.7 0.7\n", 3, "u + v <= 1");
  expect("0 0 0 9999 0 0\n", 3, ":1: face 9999 of ");
  expect("", 3, "there are no points");
}

TEST_F(fit_command, refuses_words_and_files_that_do_not_fit) {
  const std::string points = write("points.txt", "0 0 0\n"), pawn = model("pawn.obj");
  EXPECT_EQ(run_research({"fit", pawn, "--points", points}).status, 2);
  EXPECT_EQ(run_research({"fit", pawn, "-o", output()}).status, 2);
  EXPECT_EQ(run_research({"fit", pawn, "--points", points, "-o", "-", "--json"}).status, 2);
  EXPECT_EQ(run_research({"fit", pawn, "--points", points, "-o", output(), "--smooth", "-1"}).status, 2);
  EXPECT_EQ(run_research({"fit", pawn, "--points", points, "-o", output(), "--rounds", "0"}).status, 2);
  EXPECT_EQ(run_research({"fit", pawn, "--points", points, "-o", folder_.file("out.json")}).status, 3);
  EXPECT_EQ(run_research({"fit", pawn, "--points", "nowhere.txt", "-o", output()}).status, 3);
  EXPECT_EQ(run_research({"fit", pawn, "--points", points, "-o", output(), "--max-splits", "0"}).status, 2);
  EXPECT_NE(run_research({"fit", "-", "--points", "-", "-o", output()}).err.find("one standard input"),
            std::string::npos);
  const std::string curve = write("curve.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
  EXPECT_EQ(run_research({"fit", curve, "--points", points, "-o", output()}).status, 4);
}

}  // namespace
}  // namespace snug::testing::fit_test
