#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "run_snug.h"

namespace snug::testing {
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
  EXPECT_EQ(decoded(json["parts"][0]["base64"]), content(star));
  EXPECT_EQ(decoded(json["parts"][1]["base64"]), content(pin));
  EXPECT_EQ(json["parts"][0]["place"], (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0.1}));
  EXPECT_FALSE(json["parts"][1].contains("place"));
  EXPECT_EQ(json["sharp"], 30);
  EXPECT_EQ(json["answer"], content(answer));
}

TEST_F(View, takes_files_of_any_length_and_any_bytes) {
  for (const std::string more : {"", "#", "# \xff\xfe", "# </script>"}) {
    const std::string mesh = folder.file("mesh.obj");
    put(mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n" + more);
    EXPECT_EQ(decoded(data({mesh})["parts"][0]["base64"]), content(mesh));
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
  EXPECT_EQ(refused({star, "--template", page}).status, 2);
  EXPECT_EQ(refused({star, "--template", page, "-o", folder.file("made.json")}).status, 2);
  EXPECT_EQ(refused({"-", "--template", page, "-o", made}).status, 2);
  EXPECT_EQ(refused({star, "--place", "1", "--place", "2", "--template", page, "-o", made}).status, 2);
}

}  // namespace
}  // namespace snug::testing
