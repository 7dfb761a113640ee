#include <gtest/gtest.h>

#include <testing/counts.h>
#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "run_snug.h"

/// Triangles in files that mean them, in files that do not say, and in files that mean a control mesh.
namespace snug::testing::facets_test {
namespace {

using Words = std::vector<std::string>;

constexpr std::array<std::array<int, 3>, 12> box_faces{{{0, 2, 3},
                                                        {0, 3, 1},
                                                        {4, 5, 7},
                                                        {4, 7, 6},
                                                        {0, 1, 5},
                                                        {0, 5, 4},
                                                        {2, 6, 7},
                                                        {2, 7, 3},
                                                        {0, 4, 6},
                                                        {0, 6, 2},
                                                        {1, 3, 7},
                                                        {1, 7, 5}}};
std::string box_corner(int k) {
  return std::string(k & 1 ? "4 " : "0 ") + (k & 2 ? "2 " : "0 ") + (k & 4 ? "1" : "0");
}

// A box of 4 by 2 by 1; `tag` is a line of its own.
std::string obj_box(const std::string& tag = "") {
  std::string text = tag;
  for (int k = 0; k < 8; ++k) text += "v " + box_corner(k) + '\n';
  for (const auto& face : box_faces) {
    text += 'f';
    for (const int k : face) text += ' ' + std::to_string(k + 1);
    text += '\n';
  }
  return text;
}

std::string listed_box() {
  std::string text;
  for (int k = 0; k < 8; ++k) text += box_corner(k) + '\n';
  for (const auto& face : box_faces) {
    text += '3';
    for (const int k : face) text += ' ' + std::to_string(k);
    text += '\n';
  }
  return text;
}

std::string off_box() { return "OFF\n8 12 0\n" + listed_box(); }

std::string ply_box() {
  return "ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
         "element face 12\nproperty list uchar int vertex_indices\nend_header\n" +
         listed_box();
}

std::string stl_box() {
  std::string text = "solid box\n";
  for (const auto& face : box_faces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int k : face) text += "vertex " + box_corner(k) + '\n';
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string quad_box() {
  return "v 0 0 0\nv 4 0 0\nv 4 2 0\nv 0 2 0\nv 0 0 1\nv 4 0 1\nv 4 2 1\nv 0 2 1\n"
         "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
}

class Facets : public ::testing::Test {
 protected:
  void SetUp() override {
    write("untagged.obj", obj_box());
    write("untagged.off", off_box());
    write("untagged.ply", ply_box());
    write("facets.stl", stl_box());
    write("named.obj", obj_box("t scheme 0/0/1 loop\n"));
    write("creased.obj", obj_box("t crease 2/1/0 0 1 3.0\n"));
    write("quads.obj", quad_box());
    write("points.txt", "9 9 9\n");
    write("rays.txt", "9 1 0.5 -1 0 0\n");
    write("page.html", "<script type=\"application/json\" id=\"snug-data\"></script>");
    ASSERT_EQ(run_snug({"subdivide", path("facets.stl"), "--level", "0", "-o", path("facets.glb")}).status,
              0);
  }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }

  // Every command that makes a surface of one or two meshes, once with this one.
  [[nodiscard]] std::vector<Words> commands(const std::string& mesh) const {
    write("scene.json", R"({"parts": [{"mesh": ")" + mesh + R"("}, {"mesh": ")" + mesh +
                            R"(", "place": {"move": [9, 0, 0]}}]})");
    const std::string file = path(mesh);
    return {
        {"info", file},
        {"bound", file},
        {"eval", file},
        {"tessellate", file, "--error", "20%", "-o", path("out.obj")},
        {"hull", file, "--error", "20%", "--outer", path("outer.obj")},
        {"envelope", file, "--error", "20%", "-o", path("around.obj")},
        {"measure", file, "--relative", "10%"},
        {"self-contact", file},
        {"closest", file, "--points", path("points.txt")},
        {"ray", file, "--rays", path("rays.txt")},
        {"render", file, "--size", "40", "-o", path("out.png")},
        {"view", file, "--template", path("page.html"), "-o", path("view.html")},
        {"collide", file, file, "--move-b", "9 0 0"},
        {"distance", file, file, "--move-b", "9 0 0"},
        {"time-of-contact", file, file, "--to-b", "1 0 0 9 0 1 0 0 0 0 1 0", "--place-b",
         "1 0 0 8 0 1 0 0 0 0 1 0"},
        {"deviation", file, path("facets.stl"), "--absolute", "10%"},
        {"collide", "--scene", path("scene.json")},
        {"view", "--scene", path("scene.json"), "--template", path("page.html"), "-o", path("view.html")}};
  }

 private:
  TemporaryFolder folder_;
};

std::size_t smoothing_notes(const std::string& err) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = err.find("triangles taken as", at)) != std::string::npos; ++at) ++count;
  return count;
}

TEST_F(Facets, that_no_file_names_are_smoothed_with_one_note_by_every_command) {
  std::uint64_t number = 0;
  for (const char* name : {"untagged.obj", "untagged.off", "untagged.ply"}) {
    for (Words& words : commands(name)) {
      if (!testing::has_turn(number++)) continue;
      const Outcome plain = run_snug(words);
      EXPECT_EQ(plain.status, 0) << words[0] << plain.err;
      EXPECT_EQ(smoothing_notes(plain.err), 1u) << words[0] << ": " << plain.err;
      EXPECT_NE(plain.err.find("; --scheme flat takes the facets, --scheme loop says that this is meant"),
                std::string::npos)
          << plain.err;
      EXPECT_NE(plain.err.find(name), std::string::npos) << plain.err;
      words.emplace_back("--quiet");
      EXPECT_EQ(run_snug(words).err, "") << words[0];
    }
  }
}

TEST_F(Facets, that_somebody_names_get_no_note) {
  std::uint64_t number = 0;
  for (const char* name : {"facets.stl", "facets.glb", "named.obj", "creased.obj", "quads.obj"}) {
    for (const Words& words : commands(name)) {
      if (!testing::has_turn(number++)) continue;
      const Outcome plain = run_snug(words);
      EXPECT_EQ(plain.status, 0) << words[0] << plain.err;
      EXPECT_EQ(smoothing_notes(plain.err), 0u) << words[0] << ": " << plain.err;
    }
  }
  for (const char* scheme : {"flat", "loop", "catmark"}) {
    for (Words& words : commands("untagged.obj")) {
      if (words[1] == "--scene" || !testing::has_turn(number++)) continue;  // its file names schemes
      words.insert(words.end(), {"--scheme", scheme});
      const Outcome named = run_snug(words);
      EXPECT_EQ(smoothing_notes(named.err), 0u) << words[0] << ": " << named.err;
    }
  }
  for (Words& words : commands("untagged.off")) {
    if (words[1] == "--scene" || !testing::has_turn(number++)) continue;
    words.insert(words.end(), {"--sharp", "auto"});
    EXPECT_EQ(smoothing_notes(run_snug(words).err), 0u) << words[0];
  }
}

TEST_F(Facets, of_stl_and_gltf_are_what_answers_are_about) {
  for (const char* name : {"facets.stl", "facets.glb"}) {
    const Outcome apart = run_snug({"distance", path(name), path(name), "--move-b", "5 0 0", "--json"});
    const nlohmann::json answer = nlohmann::json::parse(apart.out);
    EXPECT_EQ(answer["scheme"][0], "flat");
    EXPECT_NEAR(answer["distance"][0].get<double>(), 1, 1e-3) << name;
    EXPECT_NEAR(answer["distance"][1].get<double>(), 1, 1e-3) << name;
    EXPECT_EQ(apart.err, "") << name;
  }
}

TEST_F(Facets, that_are_sharpened_are_a_control_mesh_with_creases) {
  const Outcome sharp = run_snug({"info", path("facets.stl"), "--sharp", "auto", "--json"});
  const nlohmann::json answer = nlohmann::json::parse(sharp.out);
  EXPECT_EQ(answer["scheme"], "loop");
  EXPECT_EQ(answer["creases"], 18);
  EXPECT_EQ(answer["limit_to_faces"], 0);
  EXPECT_EQ(run_snug({"info", path("facets.stl"), "--sharp", "auto", "--scheme", "flat"}).status, 2);
}

TEST_F(Facets, and_quads_meet_each_by_its_own_scheme) {
  const auto verdict = [&](const std::string& shift) {
    const Outcome found = run_snug({"collide", path("facets.stl"), path("quads.obj"), "--move-b", shift,
                                    "--tolerance", "1e-4", "--json"});
    EXPECT_EQ(found.err, "");
    const nlohmann::json answer = nlohmann::json::parse(found.out);
    EXPECT_EQ(answer["scheme"], nlohmann::json::parse(R"(["flat", "catmark"])"));
    return answer["verdict"].get<std::string>();
  };
  EXPECT_EQ(verdict("4.5 0 0"), "separated");
  EXPECT_NE(verdict("1 0 0"), "separated");
}

TEST_F(Facets, begin_what_info_says) {
  const auto first = [&](const Words& words) {
    const std::string out = run_snug(words).out;
    return out.substr(0, out.find('\n'));
  };
  const std::string smoothed = first({"info", path("untagged.obj")});
  EXPECT_NE(
      smoothed.find("untagged.obj: taken as the control mesh of a limit surface, scheme loop (chosen by "
                    "its faces), within "),
      std::string::npos)
      << smoothed;
  EXPECT_NE(smoothed.find(" % of the size) of its faces"), std::string::npos) << smoothed;
  EXPECT_NE(first({"info", path("facets.stl")})
                .find("facets.stl: taken as triangles, scheme flat (chosen by the file)"),
            std::string::npos);
  EXPECT_NE(first({"info", path("named.obj")}).find("scheme loop (chosen by the file), within "),
            std::string::npos);
  EXPECT_NE(
      first({"info", path("untagged.off"), "--scheme", "flat"}).find("scheme flat (chosen by --scheme)"),
      std::string::npos);
  EXPECT_NE(first({"info", path("facets.stl"), "--sharp", "auto"})
                .find("scheme loop (chosen by --sharp), within 0 (0 % of the size) of its faces"),
            std::string::npos);
}

TEST_F(Facets, that_are_subdivided_stay_facets_in_formats_that_say_so) {
  for (const char* ending : {".obj", ".stl", ".glb", ".usda"}) {
    const std::string out = path(std::string("finer") + ending);
    const Outcome done = run_snug({"subdivide", path("facets.stl"), "--level", "1", "-o", out});
    EXPECT_EQ(done.err, "") << ending;
    EXPECT_EQ(nlohmann::json::parse(run_snug({"info", out, "--json"}).out)["scheme"], "flat") << ending;
  }
  const Outcome lost = run_snug({"subdivide", path("facets.stl"), "--level", "1", "-o", path("finer.off")});
  EXPECT_NE(lost.err.find("meant as they are"), std::string::npos) << lost.err;
}

}  // namespace
}  // namespace snug::testing::facets_test
