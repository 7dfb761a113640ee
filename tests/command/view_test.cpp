#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing::view_test {
namespace {

constexpr const char* head = "<html><script type=\"application/json\" id=\"snug-data\">";
constexpr const char* tail = "</script><script>more()</script></html>\n";

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}
void put(const std::string& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

// The bytes that a text in base64 stands for.
std::string decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned held = 0, bits = 0;
  for (const char c : text) {
    if (c == '=') break;
    held = held << 6 | static_cast<unsigned>(digits.find(c));
    if ((bits += 6) < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(held >> bits & 255);
  }
  return bytes;
}

struct View : ::testing::Test {
  void SetUp() override { put(page, head + std::string("null") + tail); }
  // The document in the page that these arguments make.
  nlohmann::json data(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    arguments.insert(arguments.end(), {"--template", page, "-o", made});
    const Outcome outcome = run_snug(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::string text = content(made);
    EXPECT_TRUE(text.starts_with(head) && text.ends_with(tail)) << text;
    const std::string inside = text.substr(std::string(head).size(),
                                           text.size() - std::string(head).size() - std::string(tail).size());
    EXPECT_EQ(inside.find('<'), std::string::npos);
    return nlohmann::json::parse(inside);
  }
  Outcome refused(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "view");
    const Outcome outcome = run_snug(arguments);
    EXPECT_FALSE(std::filesystem::exists(made));
    return outcome;
  }

  TemporaryFolder folder;
  std::string page = folder.file("page.html"), made = folder.file("made.html");
};

TEST_F(View, holds_the_files_their_poses_and_the_answer) {
  const std::string pin = model("pin.obj"), star = model("star.obj"), answer = folder.file("answer.json");
  put(answer, "{\"command\": \"collide\", \"distance\": [1, 2], \"mesh\": \"</script><!--\"}\n");
  const auto json =
      data({star, pin, "--answer", answer, "--place", "1 0 0 0 0 1 0 0 0 0 1 0.1", "--sharp", "auto"});
  ASSERT_EQ(json["parts"].size(), 2u);
  EXPECT_EQ(json["parts"][1]["name"], pin);
  ASSERT_EQ(json["files"].size(), 2u);
  EXPECT_EQ(decoded(json["files"][json["parts"][0]["file"].get<std::size_t>()]["base64"]), content(star));
  EXPECT_EQ(decoded(json["files"][json["parts"][1]["file"].get<std::size_t>()]["base64"]), content(pin));
  EXPECT_EQ(json["parts"][0]["place"], (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1}));
  EXPECT_FALSE(json["parts"][1].contains("place"));
  EXPECT_EQ(json["sharp"], 30);
  EXPECT_EQ(json["answer"], content(answer));
}

TEST_F(View, holds_a_file_once_that_is_several_parts) {
  const std::string pin = model("pin.obj");
  const auto json = data({pin, model("star.obj"), pin});
  EXPECT_EQ(json["files"].size(), 2u);
  EXPECT_EQ(json["parts"][0]["file"], 0);
  EXPECT_EQ(json["parts"][1]["file"], 1);
  EXPECT_EQ(json["parts"][2]["file"], 0);
}

// Meshes are those that the command about the scene has: welded, sharpened, with scheme and boundary rule as tags.
TEST_F(View, holds_the_parts_of_a_scene_as_they_are_read) {
  const std::string scene = folder.file("scene.json"), sheet = folder.file("sheet.obj");
  put(sheet,
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 1 1 1\nv 1 0 1\nf 1 2 3 4\nf 5 6 7 8\n");
  put(scene, R"({"parts": [
    {"name": "one </script>", "mesh": "sheet.obj", "weld": 0, "sharp": 30, "boundary": "edge-only"},
    {"mesh": ")" +
                 model("pin.obj") + R"(", "place": {"move": [1, 2, 3]}},
    {"mesh": "sheet.obj", "scheme": "bilinear"},
    {"mesh": ")" +
                 model("pin.obj") + R"("}]})");
  const auto json = data({"--scene", scene});
  ASSERT_EQ(json["files"].size(), 3u);
  ASSERT_EQ(json["parts"].size(), 4u);
  EXPECT_EQ(json["parts"][0]["name"], "one </script>");
  EXPECT_EQ(json["parts"][0]["options"],
            (nlohmann::json{{"--boundary", "edge-only"}, {"--sharp", "30"}, {"--weld", "0"}}));
  EXPECT_EQ(json["parts"][1]["file"], json["parts"][3]["file"]);
  EXPECT_EQ(json["parts"][1]["place"], (std::vector<double>{1, 0, 0, 1, 0, 1, 0, 2, 0, 0, 1, 3}));
  EXPECT_EQ(json["parts"][2]["options"], (nlohmann::json{{"--scheme", "bilinear"}}));
  EXPECT_EQ(json["parts"][3]["options"], nlohmann::json::object());
  EXPECT_EQ(json["files"][0]["name"], sheet);

  // The same answers without options.
  const auto ask = [&](const std::string& mesh, std::vector<std::string> more) {
    more.insert(more.begin(), {"closest", mesh, "--points", folder.file("points.txt"), "--json"});
    auto answer = nlohmann::json::parse(run_snug(more).out);
    for (const char* name : {"seconds", "mesh", "stats"}) answer.erase(name);
    return answer;
  };
  put(folder.file("points.txt"), "0.3 0.2 1\n2 2 0.4\n");
  const std::string kept = folder.file("kept.obj");
  put(kept, decoded(json["files"][0]["base64"]));
  EXPECT_EQ(ask(kept, {}), ask(sheet, {"--weld", "0", "--sharp", "30", "--boundary", "edge-only"}));
  put(kept, decoded(json["files"][2]["base64"]));
  EXPECT_EQ(ask(kept, {}), ask(sheet, {"--scheme", "bilinear"}));
}

TEST_F(View, takes_files_of_any_length_and_any_bytes) {
  for (const std::string more : {"", "#", "# \xff\xfe", "# </script>"}) {
    const std::string mesh = folder.file("mesh.obj");
    put(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + more);
    EXPECT_EQ(decoded(data({mesh})["files"][0]["base64"]), content(mesh));
  }
}

// The page that the command itself holds, when it stands in a folder with none beside it.
TEST_F(View, shows_still_parts_where_there_is_no_page_with_answers) {
  const std::string pin = model("pin.obj"), star = model("star.obj"), bin = folder.file("bin"),
                    copy = bin + "/snug";
  std::filesystem::create_directory(bin);
  std::filesystem::copy_file(SNUG_COMMAND, copy);
  const Surroundings elsewhere{[&] {
                                 ::execl(copy.c_str(), copy.c_str(), "view", pin.c_str(), star.c_str(),
                                         pin.c_str(), "-o", made.c_str(), nullptr);
                               },
                               {}};
  const Outcome outcome = run_snug_in(elsewhere, {"view"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("parts stay where they are"), std::string::npos) << outcome.err;
  const std::string text = content(made), begins = std::string(head).substr(6);
  const auto at = text.find(begins) + begins.size();
  const auto json = nlohmann::json::parse(text.substr(at, text.find("</script>", at) - at));
  ASSERT_EQ(json["files"].size(), 2u);
  for (const auto& file : json["files"]) {
    const std::string positions = decoded(file["still"]["positions"]),
                      triangles = decoded(file["still"]["triangles"]);
    std::vector<std::uint32_t> corners(triangles.size() / 4);
    std::memcpy(corners.data(), triangles.data(), triangles.size());
    ASSERT_GT(corners.size(), 300u);
    EXPECT_EQ(*std::max_element(corners.begin(), corners.end()) + 1, positions.size() / 12);
  }
}

TEST_F(View, refuses_what_it_cannot_show_and_writes_nothing) {
  const std::string star = model("star.obj"), bad = folder.file("bad.obj");
  put(bad, "v 0 0 nan\n");
  Outcome outcome = refused({bad, "--template", page, "-o", made});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("bad.obj:1: vertex 0: 'nan' is not a finite number"), std::string::npos)
      << outcome.err;
  outcome = refused({star, "--template", star, "-o", made});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("is not snug's page; build it with make page"), std::string::npos)
      << outcome.err;
  outcome = refused({star, "--template", folder.file("gone.html"), "-o", made});
  EXPECT_EQ(outcome.status, 3);
  outcome = refused({star, "--template", page, "--answer", star, "-o", made});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("is not an answer of collide or distance"), std::string::npos) << outcome.err;
  const std::string scene = folder.file("scene.json");
  put(scene, R"({"parts": [{"mesh": "bad.obj"}]})");
  outcome = refused({"--scene", scene, "--template", page, "-o", made});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("bad.obj:1"), std::string::npos) << outcome.err;
  EXPECT_EQ(refused({star, "--scene", scene, "--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({"--scene", scene, "--place", "1", "--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({star, "--nearest-rigid", "--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({"--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({star, "--template", page}).status, 2);
  EXPECT_EQ(refused({star, "--template", page, "-o", folder.file("made.json")}).status, 2);
  EXPECT_EQ(refused({"-", "--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({star, "--place", "1", "--place", "2", "--template", page, "-o", made}).status, 2);
}

}  // namespace
}  // namespace snug::testing::view_test
