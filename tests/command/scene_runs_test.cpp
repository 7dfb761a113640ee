// Scenes on several ranks, and runs that are killed.

#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <iterator>
#include <thread>

#include "scene_testing.h"

namespace snug::testing::scene_runs_test {
namespace {

class scene_runs : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string file_ = write_scene(folder_.file("s.json"), random_scene(200, 7, 11));
};

TEST_F(scene_runs, go_on_after_being_killed_at_any_moment) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  std::mt19937_64 random(12);
  int killed_in_all = 0;  // a run may end before it is killed
  for (int trial = 0; trial < 10; ++trial) {
    const std::string journal = folder_.file("journal" + std::to_string(trial));
    const std::vector<std::string> words{"collide",  "--scene", file_,       "--json",
                                         "--resume", journal,   "--threads", "2"};
    int killed = 0;
    while (true) {
      const auto kill_soon = [&](int process) {
        // Longer from time to time, so that it comes to an end.
        std::this_thread::sleep_for(std::chrono::milliseconds(random() % 60 + 10 * killed));
        kill(process, SIGKILL);
      };
      const Outcome outcome = run_snug_in({{}, kill_soon}, words);
      if (outcome.status == 0) {
        ASSERT_EQ(comparable(outcome.out), expected) << trial << ' ' << killed;
        break;
      }
      ASSERT_EQ(outcome.status, 1000 + SIGKILL) << outcome.err;
      ++killed;
    }
    killed_in_all += killed;
  }
  EXPECT_GT(killed_in_all, 0);
}

// Output and status of a line for the shell.
Outcome shell(const std::string& line) {
  Outcome outcome;
  FILE* const pipe =
      popen(("OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 " + line).c_str(), "r");
  std::array<char, 65536> text;
  for (std::size_t got = 0; (got = fread(text.data(), 1, text.size(), pipe)) > 0;)
    outcome.out.append(text.data(), got);
  outcome.status = WEXITSTATUS(pclose(pipe));
  return outcome;
}

class ranks : public scene_runs {
 protected:
  void SetUp() override {
    if (std::system("mpirun --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "mpirun is not installed";
    if (access(SNUG_MPI, R_OK) != 0) GTEST_SKIP() << "built without MPI";
  }
  [[nodiscard]] static std::string mpirun(int count, const std::string& words) {
    return "mpirun --oversubscribe -n " + std::to_string(count) + " " + SNUG_COMMAND + " " + words;
  }
  // Two ranks, one of which does as `line` says before it becomes the command; a subshell of it outlives that.
  [[nodiscard]] static std::string with_rank(int rank, const std::string& line, const std::string& words) {
    return "mpirun --oversubscribe -n 2 sh -c 'if [ $OMPI_COMM_WORLD_RANK = " + std::to_string(rank) +
           " ]; then " + line + "; fi; exec " + SNUG_COMMAND + " " + words + "'";
  }
  // Once so many lines are in a file.
  [[nodiscard]] static std::string send_when(const std::string& journal, std::size_t lines,
                                             const char* signal) {
    return "(until [ $(cat " + journal + " 2> /dev/null | wc -l) -ge " + std::to_string(lines) +
           " ]; do sleep 0.005; done; kill -" + signal + " $$) > /dev/null 2>&1 &";
  }
  static std::size_t lines_of(const std::string& path) {
    std::ifstream stream(path);
    return static_cast<std::size_t>(
        std::count(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>(), '\n'));
  }
};

TEST_F(ranks, write_the_document_of_one_process) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  for (const int count : {2, 3}) {
    const Outcome outcome = shell(mpirun(count, "collide --scene " + file_ + " --json"));
    ASSERT_EQ(outcome.status, 0);
    EXPECT_EQ(comparable(outcome.out), expected) << count;
  }
  const Outcome distances = shell(mpirun(2, "distance --limit 0.5 --scene " + file_ + " --json --threads 2"));
  EXPECT_EQ(comparable(distances.out),
            comparable(run_snug({"distance", "--limit", "0.5", "--scene", file_, "--json"}).out));
}

TEST_F(ranks, keep_a_journal_together) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  const std::string journal = folder_.file("journal");
  const std::string line = mpirun(2, "collide --scene " + file_ + " --json --resume " + journal);
  shell("timeout -s KILL 0.7 " + line + " 2> /dev/null");
  const Outcome outcome = shell(line);
  EXPECT_EQ(comparable(outcome.out), expected);
}

// Any of two ranks is killed while both work: mpirun says so and ends the job, and nothing that was finished is lost.
TEST_F(ranks, go_on_after_one_of_them_was_killed) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  for (const int rank : {0, 1}) {
    const std::string journal = folder_.file("journal" + std::to_string(rank)),
                      words = "collide --scene " + file_ + " --json --threads 1 --resume " + journal;
    std::size_t before = 1;
    for (const std::size_t lines : {2u, 60u}) {
      const Outcome outcome =
          shell(with_rank(rank, send_when(journal, lines, "KILL") + " true", words) + " 2>&1");
      ASSERT_EQ(outcome.status, 128 + SIGKILL) << outcome.out;
      EXPECT_NE(outcome.out.find("rank " + std::to_string(rank)), std::string::npos) << outcome.out;
      EXPECT_NE(outcome.out.find("signal 9"), std::string::npos) << outcome.out;
      EXPECT_GE(lines_of(journal), std::max(lines, before));
      before = lines_of(journal);
    }
    const Outcome outcome = shell(mpirun(2, words));
    ASSERT_EQ(outcome.status, 0);
    EXPECT_EQ(comparable(outcome.out), expected);
    EXPECT_EQ(comparable(run_snug({"collide", "--scene", file_, "--json", "--resume", journal}).out),
              expected);
  }
}

// Pairs in one place, which take long: a rank is given forty of them at once, and is killed before it has answered all.
TEST_F(ranks, keep_what_a_rank_found_of_its_share) {
  Json scene{{"parts", Json::array()}, {"tolerance", 0}, {"pairs", Json::array()}};
  for (int i = 0; i < 1280; ++i)
    scene["parts"].push_back({{"mesh", model("pawn.obj")}, {"place", {{"move", {i / 2, 0, 0}}}}});
  for (int i = 0; i < 640; ++i) scene["pairs"].push_back({2 * i, 2 * i + 1});
  const std::string journal = folder_.file("journal"),
                    words = "collide --scene " + write_scene(folder_.file("slow.json"), scene) +
                            " --max-splits 60000 --threads 1 --resume " + journal;
  const Outcome outcome = shell(with_rank(1, send_when(journal, 7, "KILL") + " true", words) + " 2>&1");
  ASSERT_EQ(outcome.status, 128 + SIGKILL) << outcome.out;
  std::ifstream stream(journal);
  std::string line;
  std::getline(stream, line);
  int first = 0, count = 0;
  for (; std::getline(stream, line); ++count) first += std::stoi(line) < 80 ? 1 : 0;
  EXPECT_GT(first, 0);
  EXPECT_LT(first, count);  // of the second share
}

TEST_F(ranks, go_on_after_one_of_them_was_interrupted) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  for (const int rank : {0, 1}) {
    const std::string journal = folder_.file("journal" + std::to_string(rank)),
                      words = "collide --scene " + file_ + " --json --threads 1 --resume " + journal;
    const Outcome outcome = shell(with_rank(rank, send_when(journal, 30, "INT") + " true", words) + " 2>&1");
    EXPECT_EQ(outcome.status, 130) << outcome.out;
    EXPECT_NE(outcome.out.find("snug: "), std::string::npos) << outcome.out;
    EXPECT_GE(lines_of(journal), 30u);
    EXPECT_EQ(comparable(shell(mpirun(2, words)).out), expected);
  }
}

// A stopped process neither answers nor ends: the others say so, and what was finished is kept.
TEST_F(ranks, end_with_a_word_if_one_of_them_is_stopped) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  for (const int rank : {0, 1}) {
    const std::string journal = folder_.file("journal" + std::to_string(rank)),
                      words = "collide --scene " + file_ + " --json --threads 1 --resume " + journal;
    const Outcome outcome = shell(
        "timeout -s KILL 100 " +
        with_rank(rank, send_when(journal, 30, "STOP") + " true", words + " --rank-timeout 1") + " 2>&1");
    EXPECT_EQ(outcome.status, 3) << outcome.out;
    EXPECT_NE(outcome.out.find("snug: rank " + std::to_string(rank) + " has been silent for 1 s"),
              std::string::npos)
        << outcome.out;
    EXPECT_GE(lines_of(journal), 30u);
    EXPECT_EQ(comparable(shell(mpirun(2, words)).out), expected);
  }
}

TEST_F(ranks, go_on_after_a_full_disk) {
  const Json expected = comparable(run_snug({"collide", "--scene", file_, "--json"}).out);
  const std::string journal = folder_.file("journal"),
                    words = "collide --scene " + file_ + " --json --resume " + journal;
  const Outcome outcome = shell(with_rank(0, "ulimit -f 40", words) + " 2>&1");
  EXPECT_EQ(outcome.status, 3) << outcome.out;
  EXPECT_NE(outcome.out.find("make room, and run again"), std::string::npos) << outcome.out;
  EXPECT_GT(lines_of(journal), 5u);
  EXPECT_EQ(comparable(shell(mpirun(2, words)).out), expected);
}

TEST_F(ranks, end_with_one_word_for_all_of_them) {
  const Outcome gone = shell(mpirun(2, "collide --scene /gone.json 2>&1"));
  EXPECT_EQ(gone.status, 3);
  EXPECT_NE(gone.out.find("snug: /gone.json: cannot be read"), std::string::npos) << gone.out;
  const std::string wrong = write_text(folder_.file("wrong.json"), "{");
  const Outcome bad = shell(mpirun(2, "collide --scene " + wrong + " 2>&1"));
  EXPECT_EQ(bad.status, 3);
  EXPECT_NE(bad.out.find("not a scene in JSON"), std::string::npos) << bad.out;
  const std::string mesh = write_text(folder_.file("bad.obj"), "v 0 0 0\n");
  const Outcome none = shell(mpirun(
      2, "collide --scene " +
             write_text(folder_.file("s2.json"), R"({"parts": [{"mesh": ")" + mesh + R"("}]})") + " 2>&1"));
  EXPECT_EQ(none.status, 3);
  for (const Outcome* outcome : {&gone, &bad, &none}) {
    const auto first = outcome->out.find("snug: ");
    ASSERT_NE(first, std::string::npos) << outcome->out;
    EXPECT_EQ(outcome->out.find("snug: ", first + 1), std::string::npos) << outcome->out;
  }
}

}  // namespace
}  // namespace snug::testing::scene_runs_test
