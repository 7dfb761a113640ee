// Nothing that comes from outside ends the command without one line and a status: descriptors, limits,
// signals, files.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <testing/counts.h>
#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "run_snug.h"

namespace snug::testing::border_test {
namespace {

using Seconds = std::chrono::duration<double>;

void expect_one_line(const Outcome& outcome, const std::string& about) {
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << about << ": " << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("snug: ")) << about << ": " << outcome.err;
  for (const char c : outcome.err) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7f)) << about;
}

Surroundings closing(std::vector<int> descriptors) {
  return {[descriptors] {
            for (const int descriptor : descriptors) close(descriptor);
          },
          {}};
}

Surroundings redirecting(int descriptor, const char* path, int flags) {
  return {[=] {
            if (dup2(open(path, flags), descriptor) < 0) _exit(126);
          },
          {}};
}

Surroundings preloading(const char* library) {
  return {[library] { setenv("LD_PRELOAD", library, 1); }, {}};
}

std::string slurp(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(border, standard_error_may_be_closed_or_full) {
  for (const Surroundings& silent : {closing({2}), redirecting(2, "/dev/full", O_WRONLY)}) {
    EXPECT_EQ(run_snug_in(silent, {"info", "nofile"}).status, 3);
    EXPECT_EQ(run_snug_in(silent, {"info"}).status, 2);
    EXPECT_EQ(run_snug_in(silent, {"info", model("star.obj")}).status, 0);
    EXPECT_EQ(run_snug_in(silent, {"subdivide", model("star.obj"), "--level", "40", "-o", "x.obj"}).status,
              2);
  }
}

TEST(border, no_message_goes_into_a_file_that_took_a_closed_descriptor) {
  const TemporaryFolder folder;
  const auto subdivide = [&](const std::string& name, const Surroundings& surroundings) {
    const Outcome outcome =
        run_snug_in(surroundings, {"subdivide", model("pawn.obj"), "--json", "-o", folder.file(name)});
    return std::pair(outcome.status, slurp(folder.file(name)));
  };
  const auto [status, bytes] = subdivide("usual.stl", {});  // with a note about rounding
  ASSERT_EQ(status, 0);
  EXPECT_EQ(subdivide("silent.stl", closing({2})), std::pair(0, bytes));
  EXPECT_EQ(subdivide("deaf.stl", closing({0, 2})), std::pair(0, bytes));
  // No answer is to be had, and then no file either.
  EXPECT_EQ(subdivide("mute.stl", closing({0, 1, 2})), std::pair(3, std::string()));
}

TEST(border, standard_output_that_is_closed_or_full_is_status_3) {
  const TemporaryFolder folder;
  const std::string mesh = model("star.obj");
  const std::vector<std::vector<std::string>> commands{
      {"info", mesh},
      {"info", mesh, "--json"},
      {"eval", mesh, "--samples", "40"},
      {"eval", mesh, "--samples", "40", "--json"},
      {"bound", mesh, "--polyhedra", folder.file("a.ply")},
      {"bound", mesh, "--json", "--polyhedra", folder.file("b.ply")},
      {"subdivide", mesh, "-o", "-"},
      {"subdivide", mesh, "-o", folder.file("c.obj")},
      {"subdivide", mesh, "--json", "-o", folder.file("d.obj")},
      {"render", mesh, "--size", "20", "-o", folder.file("e.png")},
      {"collide", mesh, mesh, "--tolerance", "10%"},
      {"distance", mesh, mesh, "--absolute", "50%", "--json"},
      {"--help"},
      {"--version"},
      {"collide", "--help"}};
  for (const Surroundings& mute : {closing({1}), redirecting(1, "/dev/full", O_WRONLY)}) {
    for (const std::vector<std::string>& command : commands) {
      const Outcome outcome = run_snug_in(mute, command);
      EXPECT_EQ(outcome.status, 3) << command[0];
      expect_one_line(outcome, command[0]);
      EXPECT_NE(outcome.err.find("standard output"), std::string::npos) << outcome.err;
    }
  }
  EXPECT_TRUE(folder.empty());
}

TEST(border, a_closed_pipe_is_status_3) {
  const Surroundings cut{[] {
                           int ends[2];
                           if (pipe(ends) != 0 || dup2(ends[1], STDOUT_FILENO) < 0) _exit(126);
                           close(ends[0]);
                           close(ends[1]);
                         },
                         {}};
  const Outcome outcome = run_snug_in(cut, {"eval", model("bust.obj")});
  EXPECT_EQ(outcome.status, 3);
  expect_one_line(outcome, "pipe");
}

TEST(border, standard_input_that_is_closed_is_status_3) {
  const Outcome outcome = run_snug_in(closing({0}), {"info", "-"});
  EXPECT_EQ(outcome.status, 3);
  expect_one_line(outcome, "standard input");
}

TEST(border, a_file_that_never_ends_is_refused) {
  for (const char* path : {"/dev/zero", "/dev/full", "/dev/urandom"}) {
    const Outcome outcome = run_snug({"info", path});
    EXPECT_EQ(outcome.status, 3);
    expect_one_line(outcome, path);
    EXPECT_NE(outcome.err.find("does not end after 2^20 bytes"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(run_snug_in(redirecting(0, "/dev/zero", O_RDONLY), {"info", "-"}).status, 3);
  EXPECT_EQ(run_snug({"closest", model("star.obj"), "--points", "/dev/zero"}).status, 3);
  EXPECT_EQ(run_snug({"eval", model("star.obj"), "--at", "/dev/zero"}).status, 3);
}

TEST(border, the_output_is_tried_before_any_work) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.file("a.json"));
  std::filesystem::create_directory(folder.file("a.obj"));
  // Were the meshes read first, they would be what is named.
  const auto expect_named = [](std::vector<std::string> command, const std::string& target, int status) {
    const Outcome outcome = run_snug(command);
    EXPECT_EQ(outcome.status, status) << command[0] << outcome.err;
    expect_one_line(outcome, command[0]);
    EXPECT_NE(outcome.err.find(target), std::string::npos) << command[0] << ": " << outcome.err;
  };
  const std::vector<std::vector<std::string>> questions{
      {"info", "none.obj"},
      {"bound", "none.obj"},
      {"eval", "none.obj"},
      {"collide", "none.obj", "none.obj", "--tolerance", "0"},
      {"distance", "none.obj", "none.obj"},
      {"closest", "none.obj", "--points", "none.txt"}};
  for (std::vector<std::string> command : questions) {
    command.insert(command.end(), {"-o", "/nowhere/at/all.json"});
    expect_named(command, "/nowhere/at/all.json", 3);
    command.back() = folder.file("a.json");
    expect_named(command, "a.json", 3);
    command.back() = "out.txt";
    expect_named(command, "out.txt", 2);
  }
  expect_named({"subdivide", "none.obj", "-o", "/nowhere/at/all.obj"}, "all.obj", 3);
  expect_named({"subdivide", "none.obj", "-o", folder.file("a.obj")}, "a.obj", 3);
  expect_named({"subdivide", "none.obj", "-o", "out.txt"}, "out.txt", 3);
  expect_named({"render", "none.obj", "-o", "/nowhere/at/all.png"}, "all.png", 3);
  expect_named({"render", "none.obj", "-o", "out.txt"}, "out.txt", 2);
  expect_named({"bound", "none.obj", "--polyhedra", "/nowhere/at/all.ply"}, "all.ply", 3);
  EXPECT_FALSE(std::filesystem::exists("out.txt"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("")), {}), 2);
}

TEST(border, errors_are_one_line_whatever_an_argument_holds) {
  const std::string strange = "a\nb\r\tc\x1b[31m\x07\x7f\xff\xc0\xaf\xed\xa0\x80\xe2\x80\xa8\xc2\x85.obj";
  const std::vector<std::vector<std::string>> commands{
      {"info", strange},
      {"info", model("star.obj"), "--" + strange},
      {"info", model("star.obj"), "--scheme", strange},
      {"info", model("star.obj"), "-o", strange},
      {"info", model("star.obj"), "--threads", strange},
      {"bound", model("star.obj"), "--error", strange},
      {"subdivide", model("star.obj"), "-o", "/no/" + strange},
      {"render", model("star.obj"), "-o", strange},
      {"render", strange, "-o", "x.png"},
      {"eval", strange}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome outcome = run_snug(command);
    EXPECT_TRUE(outcome.status == 2 || outcome.status == 3) << outcome.status;
    expect_one_line(outcome, command[0]);
    EXPECT_NE(outcome.err.find(R"(a\nb\r\tc\x1b[31m\x07\x7f\xff\xc0\xaf\xed\xa0\x80\u2028\u0085.obj)"),
              std::string::npos)
        << outcome.err;
  }
}

TEST(border, messages_keep_letters_of_all_languages) {
  const Outcome outcome = run_snug({"info", "Löwe-獅子.obj"});
  EXPECT_NE(outcome.err.find("Löwe-獅子.obj"), std::string::npos) << outcome.err;
}

TEST(border, json_names_a_file_whose_name_is_no_utf_8) {
  const TemporaryFolder folder;
  const std::string path = folder.file("a\xff\n.obj");
  std::filesystem::copy_file(model("star.obj"), path);
  const Outcome outcome = run_snug({"info", path, "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(nlohmann::json::parse(outcome.out)["mesh"].get<std::string>().ends_with("a\xef\xbf\xbd\n.obj"));
}

// The same answer, but for the time it took.
nlohmann::json answer(const Outcome& outcome) {
  nlohmann::json document = nlohmann::json::parse(outcome.out);
  document.erase("seconds");
  return document;
}

void expect_one_thread_and_a_note(const Surroundings& poor) {
  const std::vector<std::vector<std::string>> commands{
      {"bound", model("pawn.obj"), "--json", "--threads", "4"},
      {"collide", model("pawn.obj"), model("star.obj"), "--tolerance", "1%", "--json", "--threads", "4"}};
  for (std::vector<std::string> command : commands) {
    const Outcome usual = run_snug(command), outcome = run_snug_in(poor, command);
    ASSERT_EQ(outcome.status, usual.status) << outcome.err;
    EXPECT_EQ(answer(outcome), answer(usual));
    EXPECT_EQ(usual.err, "");
    expect_one_line(outcome, command[0]);
    EXPECT_NE(outcome.err.find("note: the system refused to start threads"), std::string::npos)
        << outcome.err;
    command.emplace_back("--quiet");
    EXPECT_EQ(run_snug_in(poor, command).err, "");
  }
}

TEST(border, where_no_thread_can_be_started_one_does_the_work) {
  SNUG_SKIP_UNDER_SANITIZERS();
  expect_one_thread_and_a_note(preloading(SNUG_NO_THREADS));
}

TEST(border, where_memory_is_too_small_for_the_stack_of_a_thread_one_does_the_work) {
  SNUG_SKIP_UNDER_SANITIZERS();
  static constexpr rlim_t stack = rlim_t{1} << 30, all = rlim_t{700} << 20;
  expect_one_thread_and_a_note({[] {
                                  rlimit limit{};
                                  getrlimit(RLIMIT_STACK, &limit);
                                  limit.rlim_cur = std::min(stack, limit.rlim_max);
                                  setrlimit(RLIMIT_STACK, &limit);  // of new threads, too
                                  const rlimit memory{all, all};
                                  setrlimit(RLIMIT_AS, &memory);
                                },
                                {}});
}

TEST(border, memory_that_is_not_enough_is_status_4_on_every_thread) {
  SNUG_SKIP_UNDER_SANITIZERS();
  const TemporaryFolder folder;
  int answered = 0, refused = 0;
  for (rlim_t mib = 24; mib <= 300; mib += mib / (testing::long_check() ? 8 : 3)) {
    const Surroundings small{[mib] {
                               const rlimit memory{mib << 20, mib << 20};
                               setrlimit(RLIMIT_AS, &memory);
                             },
                             {}};
    const std::vector<std::vector<std::string>> commands{
        {"bound", model("pawn.obj"), "--level", "3", "--threads", "4", "--quiet", "-o",
         folder.file("a.json")},
        {"render", model("star.obj"), "--size", "100", "--threads", "4", "--quiet", "-o",
         folder.file("b.png")},
        {"subdivide", model("star.obj"), "--level", "6", "--quiet", "-o", folder.file("c.obj")}};
    for (const std::vector<std::string>& command : commands) {
      const Outcome outcome = run_snug_in(small, command);
      if (outcome.status == 127) continue;  // too small for the loader
      ASSERT_TRUE(outcome.status == 0 || outcome.status == 4) << command[0] << mib << ": " << outcome.status;
      ++(outcome.status == 0 ? answered : refused);
      if (outcome.status == 0) {
        std::filesystem::remove(command.back());
        continue;
      }
      expect_one_line(outcome, command[0]);
      EXPECT_NE(outcome.err.find("out of memory"), std::string::npos) << outcome.err;
      EXPECT_TRUE(folder.empty()) << command[0];
    }
  }
  EXPECT_GT(answered, 2);
  EXPECT_GT(refused, 2);
}

TEST(border, a_signal_at_mains_first_statement_is_status_130) {
  SNUG_SKIP_UNDER_SANITIZERS();
  const TemporaryFolder folder;
  const std::vector<std::vector<std::string>> commands{
      {"info", model("star.obj")},
      {"subdivide", model("star.obj"), "-o", folder.file("a.obj")},
      {"info", "none"}};
  for (const std::vector<std::string>& command : commands) {
    const Outcome outcome = run_snug_in(preloading(SNUG_EARLY_SIGNAL), command);
    EXPECT_EQ(outcome.status, 130);
    EXPECT_EQ(outcome.err, "snug: interrupted\n");
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_TRUE(folder.empty());
}

// Has the process told the system that it handles SIGINT?
bool handles_signals(int child) {
  std::ifstream status("/proc/" + std::to_string(child) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("SigCgt:"))
      return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1) & 1u) != 0;
  }
  return false;
}

// Waits until the command has been at work for a while, signals it, and waits for its end.
double seconds_to_end(const std::vector<std::string>& command, int milliseconds, int signals,
                      int signal = SIGINT) {
  auto sent = std::chrono::steady_clock::now();
  const Outcome outcome = run_snug_in({{},
                                       [&](int child) {
                                         while (!handles_signals(child)) std::this_thread::yield();
                                         std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
                                         sent = std::chrono::steady_clock::now();
                                         for (int i = 0; i < signals; ++i) {
                                           kill(child, signal);
                                           std::this_thread::sleep_for(std::chrono::milliseconds(20));
                                         }
                                       }},
                                      command);
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(outcome.err, "snug: interrupted\n");
  return Seconds(std::chrono::steady_clock::now() - sent).count();
}

TEST(border, subdivide_stops_soon_after_a_signal) {
  const TemporaryFolder folder;
  for (const char* name : {"out.obj", "out.ply", "out.stl"}) {
    // Half a second is what is promised; a loaded machine may need more to end a process.
    for (const int wait : {0, 30, 300, 1500}) {
      const std::vector<std::string> command{"subdivide", model("head.obj"), "--level", "8", "--quiet",
                                             "-o",        folder.file(name)};
      EXPECT_LT(seconds_to_end(command, wait, 1), 2) << name << wait;
    }
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::vector<std::string> command{"subdivide", model("head.obj"),     "--level", "8", "--quiet",
                                           "-o",        folder.file("out.obj")};
    EXPECT_LT(seconds_to_end(command, 200, 1, signal), 2);
    EXPECT_LT(seconds_to_end(command, 200, 2, signal), 2);
  }
  EXPECT_TRUE(folder.empty());
}

TEST(border, a_signal_while_the_file_is_written_leaves_nothing) {
  for (const int signals : {1, 2}) {
    const TemporaryFolder folder;
    const Surroundings watched{{}, [&](int child) {
                                 while (folder.empty()) std::this_thread::yield();
                                 for (int i = 0; i < signals; ++i) kill(child, SIGTERM);
                               }};
    // The first file that appears is the trial before the work; the name is taken from then on by others of
    // its kind.
    const Outcome outcome = run_snug_in(
        watched, {"bound", model("bust.obj"), "--level", "6", "--quiet", "-o", folder.file("a.json")});
    EXPECT_EQ(outcome.status, 130);
    EXPECT_TRUE(folder.empty());
  }
}

}  // namespace
}  // namespace snug::testing::border_test
