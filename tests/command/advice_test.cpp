// Advice that the command gives, and that helps: each test follows it.

#include <gtest/gtest.h>

#include <array>
#include <fstream>

#include "run_snug.h"

namespace snug::testing::advice_test {
namespace {

using Words = std::vector<std::string>;

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// `words` is not reached and says so in `advice`; with one of `remedies` it is.
void expect_helps(const Words& words, const std::string& advice, const std::vector<Words>& remedies) {
  const Outcome before = run_snug(words);
  EXPECT_EQ(before.status, 5) << before.err;
  EXPECT_NE(before.out.find(advice), std::string::npos) << before.out;
  for (const Words& remedy : remedies) {
    const Outcome after = run_snug(with(words, remedy));
    EXPECT_EQ(after.status, 0) << remedy.front() << '\n' << after.out << after.err;
    EXPECT_EQ(after.out.find("give a"), std::string::npos) << after.out;
  }
}

class advice : public ::testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.file(name)) << text;
    return folder_.file(name);
  }
  TemporaryFolder folder_;
  // Two unit squares of two triangles each, side by side in one plane.
  std::string left_ = write("left.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n");
  std::string right_ = write("right.obj", "v 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3\nf 1 3 4\n");
};

TEST_F(advice, of_collide_is_a_tolerance_where_parts_touch) {
  const Words words{"collide", left_, right_, "--scheme", "flat"};
  const Outcome touching = run_snug(with(words, {"--tolerance", "0"}));
  EXPECT_EQ(touching.out.find("max-splits"), std::string::npos) << touching.out;
  expect_helps(with(words, {"--tolerance", "0"}), "give a --tolerance above 0", {});
  expect_helps(with(words, {"--tolerance", "1e-300"}), "give a larger --tolerance", {});
  EXPECT_EQ(run_snug(with(words, {"--tolerance", "1e-9"})).status, 0);
}

TEST_F(advice, of_collide_is_a_budget_where_that_ended) {
  const Words words{"collide",  model("bracket.obj"), model("pin.obj"),
                    "--move-b", "0.05 0.05 0.5",      "--tolerance",
                    "1e-6",     "--max-splits",       "1"};
  const Outcome ended = run_snug(words);
  ASSERT_EQ(ended.status, 5) << ended.out;
  EXPECT_NE(ended.out.find("give a larger --max-splits"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("tolerance"), std::string::npos) << ended.out;
  Words larger = words;
  larger.back() = "100000";
  EXPECT_EQ(run_snug(larger).status, 0);
}

TEST_F(advice, is_no_budget_where_a_query_may_keep_no_more_pieces) {
  const std::string pawn = model("pawn.obj");
  const Outcome same = run_snug({"collide", pawn, pawn, "--tolerance", "0", "--max-splits", "1000000000"});
  EXPECT_EQ(same.status, 5);
  EXPECT_EQ(same.out.find("max-splits"), std::string::npos) << same.out;
  const Outcome apart = run_snug({"distance", pawn, model("bust.obj"), "--move-b", "3 0 0", "--absolute",
                                  "1e-15", "--max-splits", "1000000000"});
  EXPECT_EQ(apart.status, 5);
  EXPECT_NE(apart.out.find("rounding or memory"), std::string::npos) << apart.out;
}

TEST_F(advice, of_distance) {
  const Words words{"distance", model("bracket.obj"), model("pin.obj"), "--move-b", "0 0 5", "--absolute",
                    "1e-5"};
  expect_helps(with(words, {"--max-splits", "10"}), "give a larger --max-splits", {});
  EXPECT_EQ(run_snug(with(words, {"--max-splits", "100000"})).status, 0);
}

TEST_F(advice, of_bound) {
  const Words words{"bound", model("pin.obj")};
  expect_helps(with(words, {"--error", "0.1%", "--max-splits", "10"}), "give a larger --max-splits", {});
  EXPECT_EQ(run_snug(with(words, {"--error", "0.1%", "--max-splits", "1000000"})).status, 0);
  const Words fine{"bound", write("triangle.obj", "v 0.1 0.2 0.3\nv 1.7 0.3 0.1\nv 0.4 1.9 0.7\nf 1 2 3\n"),
                   "--scheme", "loop"};
  expect_helps(with(fine, {"--error", "1e-30", "--max-splits", "100000000"}), "give a larger --error", {});
  EXPECT_EQ(run_snug(with(fine, {"--error", "1e-3"})).status, 0);
}

TEST_F(advice, of_measure) {
  const Words words{"measure", model("pin.obj")};
  const std::string text = "give a larger --max-splits or --relative";
  expect_helps(with(words, {"--relative", "1e-7", "--max-splits", "10"}), text, {});
  EXPECT_EQ(run_snug(with(words, {"--relative", "1e-7"})).status, 0);
  expect_helps(with(words, {"--relative", "1e-14"}), "rounding is in the way; give a larger --relative", {});
}

TEST_F(advice, of_deviation) {
  const Words words{"deviation", model("bust.obj"), model("bust.obj"), "--scheme", "loop"};
  expect_helps(with(words, {"--absolute", "0.01%", "--max-splits", "5"}),
               "give a larger --max-splits or --absolute", {});
  EXPECT_EQ(run_snug(with(words, {"--absolute", "0.01%", "--max-splits", "1000000"})).status, 0);
  EXPECT_EQ(run_snug(with(words, {"--absolute", "100%", "--max-splits", "5"})).status, 0);
}

TEST_F(advice, of_ray) {
  const std::string rays = write("through.rays", "0.1 0.2 9 0 0 -1\n");
  const Words words{"ray", model("bust.obj"), "--scheme", "loop", "--rays", rays, "--all"};
  const Outcome ended = run_snug(with(words, {"--max-splits", "1"}));
  EXPECT_EQ(ended.status, 5);
  EXPECT_NE(ended.out.find("give a larger --max-splits"), std::string::npos) << ended.out;
  EXPECT_EQ(run_snug(words).status, 0);
}

// Facets without area, and some twice: no smooth surface takes them, the plain one does.
TEST_F(advice, of_refused_triangles_is_the_scheme_flat) {
  const std::string degenerate = write("degenerate.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n");
  const std::string twice = write("twice.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
  for (const std::string& mesh : {degenerate, twice}) {
    const Outcome refused = run_snug({"measure", mesh, "--scheme", "loop"});
    EXPECT_EQ(refused.status, 4);
    EXPECT_NE(refused.err.find("or use the scheme flat, which takes the triangles as they are"),
              std::string::npos)
        << refused.err;
    const Outcome taken = run_snug({"measure", mesh, "--scheme", "flat"});
    EXPECT_EQ(taken.status, 0) << taken.err;
  }
  // Where it does not take them either, it is not named.
  const std::string infinite = write("quad.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 2\n");
  EXPECT_EQ(run_snug({"measure", infinite, "--scheme", "loop"}).err.find("takes the triangles"),
            std::string::npos);
}

TEST_F(advice, of_a_scheme_that_fits_one_of_two_meshes_is_one_for_each) {
  const std::string quad = write("quad.obj", "v 0 0 5\nv 1 0 5\nv 1 1 5\nv 0 1 5\nf 1 2 3 4\n");
  const Words words{"distance", left_, quad, "--scheme", "flat"};
  const Outcome refused = run_snug(words);
  EXPECT_EQ(refused.status, 4);
  EXPECT_NE(refused.err.find("--scheme-b names the scheme of this mesh alone"), std::string::npos)
      << refused.err;
  EXPECT_EQ(run_snug(with(words, {"--scheme-b", "bilinear"})).status, 0);
}

TEST_F(advice, of_a_hull_says_that_a_saddle_corner_has_none_and_the_envelope_is_made) {
  // Six unit cubes around one corner, two opposite ones of the eight left out.
  std::string text;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i)
        text += "v " + std::to_string(i) + ' ' + std::to_string(j) + ' ' + std::to_string(k) + '\n';
    }
  }
  const auto full = [](int i, int j, int k) {
    return i >= 0 && j >= 0 && k >= 0 && i < 2 && j < 2 && k < 2 && !(i == j && j == k);
  };
  const auto vertex = [](int i, int j, int k) { return std::to_string(1 + i + 3 * (j + 3 * k)) + ' '; };
  for (int axis = 0; axis < 3; ++axis) {
    for (int c = 0; c < 3; ++c) {
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          std::array<int, 3> cell{};
          cell[axis] = c, cell[(axis + 1) % 3] = a, cell[(axis + 2) % 3] = b;
          std::array<int, 3> before = cell;
          --before[axis];
          const bool inside = full(before[0], before[1], before[2]),
                     outside = full(cell[0], cell[1], cell[2]);
          if (inside == outside) continue;
          std::array<std::string, 4> corners;
          for (int n = 0; n < 4; ++n) {
            std::array<int, 3> at = cell;
            at[(axis + 1) % 3] += n == 1 || n == 2 ? 1 : 0;
            at[(axis + 2) % 3] += n >= 2 ? 1 : 0;
            corners[static_cast<std::size_t>(inside ? n : 3 - n)] = vertex(at[0], at[1], at[2]);
          }
          text += "f " + corners[0] + corners[1] + corners[2] + "\nf " + corners[0] + corners[2] +
                  corners[3] + '\n';
        }
      }
    }
  }
  const std::string saddle = write("saddle.obj", text), out = folder_.file("e.obj");
  const Outcome outcome = run_snug({"hull", saddle, "--scheme", "flat", "--error", "0.05", "--outer", out});
  EXPECT_EQ(outcome.status, 5) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("not at a spike, a fold or a saddle-shaped corner"),
            std::string::npos)
      << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("snug envelope"), std::string::npos) << outcome.out;
  EXPECT_EQ(run_snug({"envelope", saddle, "--scheme", "flat", "--error", "0.05", "-o", out}).status, 0);
}

}  // namespace
}  // namespace snug::testing::advice_test
