// Scenes: --scene, --all-pairs, --limit, --resume.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <testing/counts.h>
#include <algorithm>
#include <csignal>
#include <filesystem>

#include "scene_testing.h"

namespace snug::testing::scene_test {
namespace {

using Words = std::vector<std::string>;

constexpr const char* octahedron =
    "t scheme 0/0/1 loop\nv 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
    "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";

class scenes : public ::testing::Test {
 protected:
  scenes() {
    write_text(folder_.file("ball.obj"), octahedron);
    write_text(folder_.file("open.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }

  std::string scene(const std::string& text) { return write_text(folder_.file("scene.json"), text); }
  // Three balls in a row, the first two of which meet.
  std::string three(const std::string& more = "") {
    return scene(R"({"parts": [{"name": "a", "mesh": "ball.obj"},
                               {"name": "b", "mesh": "ball.obj", "place": {"move": "0.5 0 0"}},
                               {"mesh": "ball.obj", "place": [1,0,0,9, 0,1,0,0, 0,0,1,0]}])" +
                 more + "}");
  }
  Json answer(const Words& words, int status = 0) {
    Words all = words;
    all.emplace_back("--json");
    const Outcome outcome = run_snug(all);
    EXPECT_EQ(outcome.status, status) << outcome.err;
    return comparable(outcome.out);
  }
  // The one line that refuses a scene.
  std::string refusal(const std::string& text, int status = 3, const Words& more = {}) {
    Words words{"collide", "--scene", scene(text)};
    words.insert(words.end(), more.begin(), more.end());
    const Outcome outcome = run_snug(words);
    EXPECT_EQ(outcome.status, status) << text << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }
  void expect_refusal(const std::string& text, const std::string& part, int status = 3) {
    const std::string line = refusal(text, status);
    EXPECT_NE(line.find(part), std::string::npos) << line;
    EXPECT_NE(line.find("scene.json: "), std::string::npos) << line;
  }

  TemporaryFolder folder_;
};

TEST_F(scenes, lists_what_boxes_do_not_separate_and_counts_the_rest) {
  const Json found = answer({"collide", "--scene", three()});
  ASSERT_EQ(found["results"].size(), 1u);
  EXPECT_EQ(found["results"][0]["a"], "a");
  EXPECT_EQ(found["results"][0]["b"], "b");
  EXPECT_EQ(found["results"][0]["verdict"], "intersecting");
  EXPECT_EQ(found["mesh"], Json({"ball.obj"}));
  EXPECT_EQ(found["parts"], 3);
  EXPECT_EQ(found["pairs"], 3);
  EXPECT_EQ(found["separated_by_boxes"], 2);
  EXPECT_EQ(found["intersecting"], 1);
  const Json all = answer({"collide", "--scene", three(), "--all-pairs"});
  ASSERT_EQ(all["results"].size(), 3u);
  EXPECT_EQ(all["separated_by_boxes"], 2);
  EXPECT_EQ(all["results"][1]["b"], "2");
  EXPECT_EQ(all["results"][1]["verdict"], "separated");
  EXPECT_GT(all["results"][1]["distance"][0], 6.9);
  EXPECT_TRUE(all["results"][1]["distance"][1].is_null());
}

TEST_F(scenes, take_pairs_by_place_or_name_and_margins) {
  const Json listed =
      answer({"collide", "--scene", three(R"(, "pairs": [["2", "b"], [1, 0]], "tolerance": 0.01)")});
  EXPECT_EQ(listed["pairs"], 2);
  EXPECT_EQ(listed["tolerance"], 0.01);
  ASSERT_EQ(listed["results"].size(), 1u);
  EXPECT_EQ(listed["results"][0]["a"], "b");
  const Json margins = answer({"collide", "--scene", three(R"(, "margins": [["b", 2, 8]], "pairs": "all")")});
  ASSERT_EQ(margins["results"].size(), 2u);
  EXPECT_EQ(margins["results"][1]["verdict"], "within");
  const Json margin = answer({"collide", "--scene", three(R"(, "margin": 100)")});
  EXPECT_EQ(margin["within"].get<int>() + margin["intersecting"].get<int>(), 3);
  EXPECT_EQ(margin["separated_by_boxes"], 0);
}

TEST_F(scenes, distances_up_to_a_limit) {
  const Json found = answer({"distance", "--scene", three(), "--limit", "8"});
  ASSERT_EQ(found["results"].size(), 2u);
  EXPECT_EQ(found["results"][1]["a"], "b");
  const double lower = found["results"][1]["distance"][0], upper = found["results"][1]["distance"][1];
  EXPECT_LT(upper - lower, 0.001);
  EXPECT_EQ(found["separated_by_boxes"].get<int>() + found["separated"].get<int>(), 1);
  EXPECT_EQ(run_snug({"distance", "--scene", three()}).status, 2);
}

// The twin: each pair asked about by itself, the poses as numbers.
TEST_F(scenes, are_answered_as_pairs_are) {
  const Json scene = random_scene(14, 4, 5);
  const Json found =
      answer({"collide", "--scene", write_scene(folder_.file("s.json"), scene), "--all-pairs"});
  std::size_t next = 0, near = 0;
  for (std::size_t a = 0; a < 14; ++a) {
    for (std::size_t b = a + 1; b < 14; ++b) {
      const Json& other = found["results"][next++];
      if (!testing::has_turn(next)) continue;
      const auto words = [&](std::size_t part, const char* key) {
        std::string text;
        for (const Json& x : scene["parts"][part]["place"][key]) text += x.dump() + " ";
        return text;
      };
      Json one = answer({"collide", scene["parts"][a]["mesh"], scene["parts"][b]["mesh"], "--margin", "0.02",
                         "--move-a", words(a, "move"), "--rotate-a", words(a, "rotate"), "--move-b",
                         words(b, "move"), "--rotate-b", words(b, "rotate")});
      ASSERT_EQ(other["a"], scene["parts"][a]["name"]);
      ASSERT_EQ(other["b"], scene["parts"][b]["name"]);
      ASSERT_EQ(other["verdict"], one["verdict"]);
      if (other["distance"][1].is_null() && other["verdict"] == "separated") {
        EXPECT_GT(other["distance"][0], 0.02);
        EXPECT_TRUE(one["distance"][1].is_null() || one["distance"][1] >= other["distance"][0]);
        continue;
      }
      ++near;
      for (const char* key : {"distance", "witness", "witness_at"}) EXPECT_EQ(other[key], one[key]) << key;
    }
  }
  EXPECT_GT(near, testing::fewer(4) == 4 ? 10u : 0u);
  EXPECT_LT(near, next);
}

TEST_F(scenes, do_not_depend_on_threads) {
  const std::string file = write_scene(folder_.file("s.json"), random_scene(60, 6, 6));
  const Json one = answer({"collide", "--scene", file, "--threads", "1"});
  EXPECT_EQ(answer({"collide", "--scene", file, "--threads", "3"}), one);
  EXPECT_GT(one["intersecting"], 3);
}

TEST_F(scenes, parts_may_have_rules_of_their_own) {
  const Json found = answer({"collide", "--scene", scene(R"({"parts": [
      {"mesh": "ball.obj", "scheme": "flat"}, {"mesh": "ball.obj", "scheme": "Loop", "place": {"move": [1.9, 0, 0]}},
      {"mesh": "ball.obj", "scheme": "flat", "place": {"move": [2, 0, 0]}}, {"mesh": "ball.obj", "sharp": 30, "place": {"rotate": "z 90"}}]})")});
  EXPECT_EQ(found["scheme"], Json({"flat", "loop", "loop"}));
  EXPECT_EQ(found["mesh"].size(), 3u);
  // Two flat ones that touch at a vertex; the smooth one between them is smaller, and meets the last alone.
  EXPECT_EQ(found["parts"], 4);
}

TEST_F(scenes, exit_with_the_gravest_verdict) {
  const auto status = [&](const std::string& more) {
    return run_snug({"collide", "--scene", three(more), "--exit-code"}).status;
  };
  EXPECT_EQ(status(""), 11);
  EXPECT_EQ(status(R"(, "pairs": [[0, 2]])"), 0);
  EXPECT_EQ(status(R"(, "pairs": [[0, 2]], "margin": 20)"), 10);
  EXPECT_EQ(status(R"(, "pairs": [])"), 0);
}

TEST_F(scenes, tell_people) {
  const Outcome outcome = run_snug({"collide", "--scene", three()});
  EXPECT_NE(outcome.out.find("\na b intersecting 0 "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("3 pairs: 2 separated by boxes, 1 intersecting\n"), std::string::npos)
      << outcome.out;
}

TEST_F(scenes, that_are_wrong_are_refused_in_one_line) {
  const auto one = [](const std::string& more) { return R"({"parts": [{"mesh": "ball.obj")" + more + "}]}"; };
  const auto two = [](const std::string& more) {
    return R"({"parts": [{"mesh": "ball.obj"}, {"name": "x", "mesh": "ball.obj"}])" + more + "}";
  };
  expect_refusal("", "line 1, column 1");
  expect_refusal("{\n\"parts\": [\n  {\"mesh\" \"ball.obj\"}]}", "line 3, column");
  expect_refusal("[1]", "the document is a list");
  expect_refusal("{}", "\"parts\" is missing");
  expect_refusal(R"({"parts": []})", "parts is empty");
  expect_refusal(R"({"parts": {}})", "parts is an object");
  expect_refusal(R"({"parts": [7]})", "parts[0] is a number");
  expect_refusal(R"({"parts": [{}]})", "parts[0]: \"mesh\" is missing");
  expect_refusal(R"({"parts": [{"mesh": 5}]})", "parts[0].mesh is a number");
  expect_refusal(R"({"parts": [{"mesh": "ball.obj"}], "part": 1})", "did you mean 'parts'");
  expect_refusal(one(R"(, "plaec": 1)"), "parts[0]: unknown name \"plaec\"; did you mean 'place'");
  expect_refusal(one(R"(, "scheme": "lop")"), "did you mean 'loop'");
  expect_refusal(one(R"(, "boundary": "x")"), "--boundary");
  expect_refusal(one(R"(, "sharp": "x")"), "--sharp");
  expect_refusal(one(R"(, "weld": -1)"), "--weld");
  expect_refusal(R"({"parts": [{"mesh": "ball.obj\u0000.obj"}]})", "parts[0].mesh: give the name of a file");
  expect_refusal({"\xff\xfe{\0}\0", 6}, "this is UTF-16 text: save it as UTF-8");
  expect_refusal({"{\0}\0", 4}, "this is UTF-16 text: save it as UTF-8");
  expect_refusal(one(R"(, "name": "")"), "parts[0].name is empty");
  expect_refusal(one(R"(, "mesh": "ball.obj")"), "\"mesh\" appears twice");
  expect_refusal(one(R"(, "place": [1, 2, 3])"), "parts[0].place has 3 numbers, not 12");
  expect_refusal(one(R"(, "place": [1,0,0,0, 0,1,0,0, 0,0,1,"x"])"), "parts[0].place[11] is a text");
  expect_refusal(one(R"(, "place": [1,0,0,0, 0,1,0,0, 0,0,1,NaN])"), "line 1");
  expect_refusal(one(R"(, "place": [1,0,0,0, 0,1,0,0, 0,0,1,1e999])"), "1e999");
  expect_refusal(one(R"(, "place": [2,0,0,0, 0,1,0,0, 0,0,1,0])"), "parts[0]", 4);
  expect_refusal(one(R"(, "place": {"move": [1, 2]})"), "parts[0].place.move has 2 numbers");
  expect_refusal(one(R"(, "place": {"rotate": "q 3"})"), "parts[0]");
  expect_refusal(one(R"(, "place": {"turn": 1})"), "parts[0].place: unknown name");
  expect_refusal(two(R"(, "pairs": 3)"), "pairs is a number");
  expect_refusal(two(R"(, "pairs": [[0]])"), "pairs[0] is a list; give two parts");
  expect_refusal(two(R"(, "pairs": [[0, 1], [0, 2]])"), "pairs[1][1]: there is no part 2; places are 0 to 1");
  expect_refusal(two(R"(, "pairs": [[0, -1]])"), "there is no part -1");
  expect_refusal(two(R"(, "pairs": [[0, 99999999999999999999999]])"), "pairs[0][1]");
  expect_refusal(two(R"(, "pairs": [[0, 1.5]])"), "pairs[0][1] is a number");
  expect_refusal(two(R"(, "pairs": [["0", "y"]])"), "no part is called \"y\"");
  expect_refusal(two(R"(, "pairs": [["0", "Käfig 螺丝"]])"), "no part is called \"Käfig 螺丝\"");
  std::string screws;  // shortened, but not inside a character
  for (int i = 0; i < 30; ++i) screws += "螺";
  expect_refusal(two(R"(, "pairs": [["0", ")" + screws + "\"]]"), "螺螺...");
  expect_refusal(two(R"(, "pairs": [[1, "x"]])"), "\"x\" with itself");
  expect_refusal(two(R"(, "margins": [[0, 1, 1], ["x", 0, 2]])"),
                 "margins[1]: this pair has a margin already");
  expect_refusal(two(R"(, "margins": [[0, 1, -1]])"), "margins[0][2]: -1 is not a length");
  expect_refusal(two(R"(, "margin": "1")"), "margin is a text");
  expect_refusal(two(R"(, "tolerance": "x%")"), "tolerance");
  expect_refusal(R"({"parts": [{"name": "1", "mesh": "ball.obj"}, {"mesh": "ball.obj"}]})",
                 "that of parts[0]");
  expect_refusal(std::string(100'000, '['), "nested");
  expect_refusal(R"({"parts": )" + std::string(100'000, '[') + std::string(100'000, ']') + "}", "nested");
  EXPECT_NE(refusal(R"({"parts": [{"mesh": "gone.obj"}]})").find("gone.obj: "), std::string::npos);
  EXPECT_NE(refusal(two(R"(, "pairs": "all")"), 2, {"--tolerance", "1"}).find("exclude"), std::string::npos);
  const std::string line =
      refusal(R"({"parts": [{"mesh": "ball.obj"}, {"mesh": "open.obj"}]})", 4, {"--solid"});
  EXPECT_NE(line.find("open.obj: "), std::string::npos) << line;
}

TEST_F(scenes, of_a_thousand_equal_parts_end_soon_with_a_count) {
  Json same{{"parts", Json::array()}};
  for (int i = 0; i < 1000; ++i) same["parts"].push_back({{"mesh", "ball.obj"}});
  const Outcome outcome = run_snug({"collide", "--scene", scene(same.dump())});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("499500 pairs: 0 separated by boxes, 499500 "), std::string::npos);
}

// The processor's time, which others on the machine do not lengthen much.
TEST_F(scenes, are_read_in_a_time_that_grows_with_their_parts) {
  const auto seconds = [&](int parts) {
    std::string text = R"({"pairs": [], "parts": [)";
    for (int i = 0; i < parts; ++i) {
      text += i == 0 ? "" : ",\n";
      text += R"({"mesh": "ball.obj", "place": {"move": [)" + std::to_string(i) + ", 0, 0]}}";
    }
    const std::string file = scene(text + "]}");
    const auto spent = [] {
      rusage usage{};
      getrusage(RUSAGE_CHILDREN, &usage);
      return static_cast<double>(usage.ru_utime.tv_sec) + 1e-6 * static_cast<double>(usage.ru_utime.tv_usec);
    };
    const double before = spent();
    EXPECT_EQ(run_snug({"collide", "--scene", file}).status, 0);
    return spent() - before;
  };
  EXPECT_LT(seconds(80'000), 7 * seconds(20'000));
}

TEST_F(scenes, whose_meshes_are_none_are_refused) {
  const auto mesh = [&](const std::string& name) {
    return refusal(R"({"parts": [{"mesh": "ball.obj"}, {"mesh": ")" + name + R"("}]})");
  };
  std::filesystem::create_directory(folder_.file("folder.obj"));
  write_text(folder_.file("empty.obj"), "");
  EXPECT_NE(mesh("folder.obj").find("folder.obj: "), std::string::npos);
  EXPECT_NE(mesh("empty.obj").find("empty.obj: "), std::string::npos);
  EXPECT_NE(mesh("scene.json").find("scene.json: "), std::string::npos);  // it names itself
  EXPECT_EQ(run_snug({"collide", "--scene", folder_.file("folder.obj")}).status, 3);
}

TEST_F(scenes, need_no_meshes_and_take_none) {
  EXPECT_EQ(run_snug({"collide"}).status, 2);
  EXPECT_EQ(run_snug({"collide", folder_.file("ball.obj"), "--scene", three()}).status, 2);
  EXPECT_EQ(run_snug({"collide", "--scene", three(), "--move-b", "1 0 0"}).status, 2);
  EXPECT_EQ(run_snug({"collide", "--scene", folder_.file("gone.json")}).status, 3);
  EXPECT_EQ(run_snug({"collide", "--scene", three(), "--resume"}).status, 2);
}

class journals : public scenes {
 protected:
  journals() : file_(write_scene(folder_.file("s.json"), random_scene(40, 5, 7))) {}
  [[nodiscard]] std::string text() const {
    std::ifstream stream(journal_, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  Words words(const Words& more = {}) {
    Words all{"collide", "--scene", file_, "--resume", journal_};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string file_, journal_ = folder_.file("journal.json");
};

TEST_F(journals, go_on_from_any_torn_end) {
  const Json expected = answer({"collide", "--scene", file_});
  EXPECT_EQ(answer(words()), expected);
  const std::string whole = text();
  std::mt19937_64 random(8);
  for (int trial = 0; trial < static_cast<int>(testing::fewer(12)); ++trial) {
    std::string torn = whole.substr(0, random() % whole.size());
    if (trial % 3 == 1) torn += "\t12\n";
    if (trial % 3 == 2) {
      // A bit that a disk lost, after the first line.
      torn = whole;
      torn[100 + random() % (whole.size() - 100)] ^= 1;
    }
    write_text(journal_, torn);
    EXPECT_EQ(answer(words()), expected) << torn.size();
    std::string again = text();
    EXPECT_EQ(std::count(again.begin(), again.end(), '\n'), std::count(whole.begin(), whole.end(), '\n'));
  }
}

TEST_F(journals, serve_rows_and_documents_alike) {
  const Outcome plain = run_snug({"collide", "--scene", file_});
  EXPECT_EQ(run_snug(words()).out, plain.out);
  EXPECT_EQ(answer(words()), answer({"collide", "--scene", file_}));
  EXPECT_EQ(run_snug(words()).out, plain.out);
}

TEST_F(journals, of_other_questions_are_refused) {
  ASSERT_EQ(run_snug(words()).status, 0);
  const auto refused = [&](const Words& all) {
    const Outcome outcome = run_snug(all);
    EXPECT_EQ(outcome.status, 3);
    EXPECT_NE(outcome.err.find("another scene"), std::string::npos) << outcome.err;
  };
  const std::string before = text();
  refused(words({"--max-splits", "7"}));
  refused(words({"--boundary", "edge-only"}));
  refused({"distance", "--scene", file_, "--limit", "1", "--resume", journal_});
  write_scene(file_, random_scene(40, 5, 9));
  refused(words());
  EXPECT_EQ(text(), before);
  write_text(journal_, "something else");
  EXPECT_NE(run_snug(words()).err.find("is not a journal"), std::string::npos);
  EXPECT_EQ(text(), "something else");
  EXPECT_EQ(run_snug({"collide", "--scene", file_, "--resume", "/dev/full"}).status, 3);
}

TEST_F(journals, notice_a_mesh_that_changed) {
  std::filesystem::copy_file(model("pin.obj"), folder_.file("pin.obj"));
  file_ = scene(R"({"parts": [{"mesh": "pin.obj"}, {"mesh": "ball.obj"}]})");
  ASSERT_EQ(run_snug(words()).status, 0);
  write_text(folder_.file("ball.obj"), std::string(octahedron) + "# changed\n");
  EXPECT_EQ(run_snug(words()).status, 3);
}

TEST_F(journals, keep_what_was_finished_before_an_interrupt) {
  write_scene(file_, random_scene(150, 6, 10));
  const Json expected = answer({"collide", "--scene", file_});
  int interrupted = 0;
  for (int milliseconds = 10;; milliseconds += 20 + milliseconds / 4) {
    const Outcome outcome = interrupt_snug(words({"--json"}), milliseconds);
    if (outcome.status == 0) {
      EXPECT_EQ(comparable(outcome.out), expected);
      break;
    }
    if (outcome.status == 1000 + SIGINT) continue;  // before the program began
    ASSERT_EQ(outcome.status, 130) << outcome.err;
    EXPECT_EQ(outcome.err.substr(0, 6), "snug: ");
    ++interrupted;
  }
  EXPECT_GT(interrupted, 0);
}

TEST_F(journals, that_cannot_be_written_are_refused) {
  const auto refused = [&](const std::string& journal, const std::string& part) {
    // Without what lets root write everywhere.
    const auto as_others = [] { prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE, 0, 0, 0); };
    const Outcome outcome = run_snug_in({as_others, {}}, {"collide", "--scene", file_, "--resume", journal});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(journal + ": cannot be opened"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  };
  refused(folder_.file("no/journal"), "No such file");
  std::filesystem::create_directory(folder_.file("folder"));
  refused(folder_.file("folder"), "Is a directory");
  ASSERT_EQ(run_snug(words()).status, 0);
  const std::string before = text();
  std::filesystem::permissions(journal_, std::filesystem::perms::owner_read);
  refused(journal_, "Permission denied");
  EXPECT_EQ(text(), before);
}

TEST_F(journals, keep_what_was_finished_where_the_document_cannot_be_written) {
  const Json expected = answer({"collide", "--scene", file_});
  const auto full = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  const Outcome outcome = run_snug_in({full, {}}, words({"--json"}));
  EXPECT_EQ(outcome.status, 3) << outcome.err;
  const std::string before = text();
  EXPECT_GT(std::count(before.begin(), before.end(), '\n'), 1);
  EXPECT_EQ(answer(words()), expected);
  EXPECT_EQ(text().substr(0, before.size()), before);
}

TEST_F(journals, are_not_replaced_by_the_document) {
  const Outcome outcome = run_snug(words({"-o", journal_}));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--resume and -o name the same file"), std::string::npos) << outcome.err;
  const Json expected = answer({"collide", "--scene", file_});
  EXPECT_EQ(answer(words()), expected);
}

// A reader of the document has an answer while the others are looked for.
TEST_F(journals, stand_beside_a_document_that_is_streamed) {
  for (const bool json : {true, false}) {
    journal_ = folder_.file(json ? "journal.a" : "journal.b");
    const std::string out = folder_.file("out");
    const auto into_file = [&] {
      dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    };
    std::string seen;
    const auto look = [&](int process) {
      while (std::count_if(seen.begin(), seen.end(), [](char c) { return c == '\n'; }) < 8) {
        usleep(500);
        seen = text();
      }
      kill(process, SIGSTOP);
      std::ifstream stream(out, std::ios::binary);
      seen.assign(std::istreambuf_iterator<char>(stream), {});
      kill(process, SIGCONT);
    };
    Words all = words({"--threads", "1"});
    if (json) all.emplace_back("--json");
    EXPECT_EQ(run_snug_in({into_file, look}, all).status, 0);
    EXPECT_NE(seen.find(json ? "\"verdict\": " : "part 0 part"), std::string::npos) << seen;
  }
}

TEST_F(journals, keep_what_was_finished_on_a_full_disk) {
  const Json expected = answer({"collide", "--scene", file_});
  const auto limit = [] {
    const rlimit bytes{20'000, 20'000};
    setrlimit(RLIMIT_FSIZE, &bytes);
  };
  const Outcome outcome = run_snug_in({limit, {}}, words({"--threads", "2"}));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_NE(outcome.err.find("make room, and run again"), std::string::npos) << outcome.err;
  EXPECT_GT(text().size(), 10'000u);
  EXPECT_LE(text().size(), 20'000u);
  EXPECT_EQ(text().back(), '\n');  // half a line would cost those that other threads write after it
  EXPECT_EQ(answer(words()), expected);
}

}  // namespace
}  // namespace snug::testing::scene_test
