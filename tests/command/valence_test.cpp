#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "run_snug.h"

// The largest valences and faces that are taken, and the next ones.

namespace snug::testing::valence_test {
namespace {

std::string point_at(double turns, double radius, double height) {
  const double angle = 2 * std::numbers::pi * turns;
  return "v " + std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) +
         " " + std::to_string(height) + "\n";
}

// A polygon of n corners, closed by triangles to a vertex above.
std::string cone(int n) {
  std::string mesh = "v 0 0 1\n", base = "f";
  for (int i = 0; i < n; ++i) mesh += point_at(1.0 * i / n, 1, 0);
  for (int i = 0; i < n; ++i) {
    mesh += "f 1 " + std::to_string(i + 2) + " " + std::to_string((i + 1) % n + 2) + "\n";
    base += " " + std::to_string(n + 1 - i);
  }
  return mesh + base + "\n";
}

// Triangles from a vertex above to a ring, and from there to a vertex below.
std::string double_cone(int n) {
  std::string mesh = "v 0 0 1\nv 0 0 -1\n";
  for (int i = 0; i < n; ++i) mesh += point_at(1.0 * i / n, 1, 0);
  for (int i = 0; i < n; ++i) {
    const std::string from = std::to_string(i + 3), to = std::to_string((i + 1) % n + 3);
    mesh += "f 1 " + from + " " + to + "\nf 2 " + to + " " + from + "\n";
  }
  return mesh;
}

std::string prism(int n) {
  std::string mesh, top = "f", bottom = "f", sides;
  for (const double height : {0.0, 1.0}) {
    for (int i = 0; i < n; ++i) mesh += point_at(1.0 * i / n, 1, height);
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    top += " " + std::to_string(n + i + 1);
    bottom += " " + std::to_string(n - i);
    for (const int corner : {i, next, n + next, n + i})
      sides += (corner == i ? "f " : " ") + std::to_string(corner + 1);
    sides += "\n";
  }
  return mesh + top + "\n" + bottom + "\n" + sides;
}

void write(const std::string& file, const std::string& text) { std::ofstream(file) << text; }

struct Shape {
  const char* scheme;
  std::string (*make)(int);
  int largest;
};

class largest_valence : public ::testing::TestWithParam<Shape> {};

TEST_P(largest_valence, is_answered_and_the_next_is_refused) {
  SNUG_SKIP_UNDER_SANITIZERS();
  const auto& [scheme, make, largest] = GetParam();
  const TemporaryFolder folder;
  const std::string points = folder.file("points.txt"), rays = folder.file("rays.txt");
  write(points, "0.2 0.3 2\n");
  write(rays, "0.2 0.3 2 0 0 -1\n3 0.1 0.1 -1 0 0\n");
  const std::string mesh = make(largest);
  const std::vector<std::vector<std::string>> questions{
      {"ray", "--rays", rays}, {"tessellate", "--error", "5%", "-o", folder.file("out.ply")}};
  for (std::vector<std::string> question : questions) {
    const std::string name = question[0];
    question.insert(question.begin() + 1, "-");
    question.insert(question.end(), {"--scheme", scheme});
    const Outcome outcome = run_snug(question, mesh);
    // The patches of Midedge's polygons hardly shrink at their centre.
    const bool may_be_refused = name == "tessellate" && std::string(scheme) == "midedge";
    EXPECT_TRUE(outcome.status == 0 || outcome.status == (may_be_refused ? 4 : 5))
        << name << ": " << outcome.err;
  }
  const Outcome beyond =
      run_snug({"closest", "-", "--points", points, "--scheme", scheme}, make(largest + 1));
  EXPECT_EQ(beyond.status, 4);
  EXPECT_NE(beyond.err.find(std::to_string(largest + 1)), std::string::npos) << beyond.err;
  EXPECT_NE(beyond.err.find("at most " + std::to_string(largest)), std::string::npos) << beyond.err;
}

INSTANTIATE_TEST_SUITE_P(schemes, largest_valence,
                         ::testing::Values(Shape{"loop", double_cone, 512}, Shape{"catmark", cone, 512},
                                           Shape{"doo-sabin", prism, 360}, Shape{"midedge", prism, 360}),
                         [](const auto& shape) {
                           std::string name = shape.param.scheme;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace snug::testing::valence_test
