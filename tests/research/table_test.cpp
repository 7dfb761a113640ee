// table, as other people's programs use it: everything is read from its JSON, limit points come from the twins.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <command/run_snug.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>

namespace snug::testing::table_test {
namespace {

using nlohmann::json;
using oracle::Point;
using oracle::TaggedMesh;

json table_of(const std::string& scheme, std::size_t valence) {
  const Outcome outcome =
      run_research({"table", "--scheme", scheme, "--valence", std::to_string(valence), "--json"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return json::parse(outcome.out, nullptr, false);
}

// Two rings around a vertex or a face, numbered as docs/command/table.md has it: written down again, from the page.
class Rings {
 public:
  Rings(const std::string& scheme, int n)
      : loop_(scheme == "loop"), dual_(scheme != "loop" && scheme != "catmark") {
    middle_ = dual_ ? 0 : 1;
    one_ = scheme == "catmark" ? 2 * n : n;
    two_ = loop_ ? 2 * n : dual_ ? 3 * n : 4 * n;
    mesh_.points.resize(static_cast<std::size_t>(middle_ + one_ + two_));
    if (dual_) {
      std::vector<std::uint32_t> face;
      for (int k = 0; k < n; ++k) face.push_back(at(1, k));
      mesh_.polygons.push_back(face);
    }
    for (int k = 0; k < n; ++k) {
      if (loop_) {
        mesh_.polygons.push_back({at(0, 0), at(1, k), at(1, k + 1)});
        mesh_.polygons.push_back({at(1, k), at(2, 2 * k), at(2, 2 * k + 1)});
        mesh_.polygons.push_back({at(1, k), at(2, 2 * k + 1), at(1, k + 1)});
        mesh_.polygons.push_back({at(1, k + 1), at(2, 2 * k + 1), at(2, 2 * k + 2)});
      } else if (dual_) {
        mesh_.polygons.push_back({at(1, k), at(2, 3 * k), at(2, 3 * k + 1), at(2, 3 * k + 2)});
        mesh_.polygons.push_back({at(1, k), at(2, 3 * k + 2), at(2, 3 * k + 3), at(1, k + 1)});
      } else {
        mesh_.polygons.push_back({at(0, 0), at(1, 2 * k), at(1, 2 * k + 1), at(1, 2 * k + 2)});
        mesh_.polygons.push_back({at(1, 2 * k), at(2, 4 * k), at(2, 4 * k + 1), at(1, 2 * k + 1)});
        mesh_.polygons.push_back({at(1, 2 * k + 1), at(2, 4 * k + 1), at(2, 4 * k + 2), at(2, 4 * k + 3)});
        mesh_.polygons.push_back({at(1, 2 * k + 1), at(2, 4 * k + 3), at(2, 4 * k + 4), at(1, 2 * k + 2)});
      }
    }
  }
  [[nodiscard]] std::uint32_t at(int ring, int index) const {
    if (ring == 0) return 0;
    const int size = ring == 1 ? one_ : two_, begin = ring == 1 ? middle_ : middle_ + one_;
    return static_cast<std::uint32_t>(begin + (index + size) % size);
  }
  // The vertex at a place of the numbering, or at its mirror image.
  [[nodiscard]] std::uint32_t at(const json& place, bool mirrored) const {
    const int ring = place["ring"], index = place["index"];
    if (!mirrored) return at(ring, index);
    const int first = ring == 1 ? (loop_ ? 1 : dual_ ? 0 : 2) : (loop_ || dual_ ? 2 : 4);
    return at(ring, first - index);
  }
  [[nodiscard]] const std::vector<std::vector<std::uint32_t>>& faces() const { return mesh_.polygons; }

  // Limit points of a net, on both halves of the quad of `patch`; the same ones for all nets.
  [[nodiscard]] std::vector<Point> limits(const std::string& scheme, const std::vector<Point>& net,
                                          int levels, std::vector<Point>* places = nullptr) const {
    TaggedMesh mesh = mesh_;
    mesh.points = net;
    std::vector<Point> found;
    if (dual_) {
      const auto kind = scheme == "midedge" ? oracle::DualScheme::midedge : oracle::DualScheme::doo_sabin;
      for (const oracle::DualSample& sample : oracle::sample_dual(mesh, kind, levels)) {
        if (std::find(sample.owners.begin(), sample.owners.end(), at(1, 0)) == sample.owners.end()) continue;
        found.push_back(sample.position);
        if (places) places->push_back({});
      }
      return found;
    }
    const oracle::Rules rules{loop_ ? oracle::PrimalScheme::loop : oracle::PrimalScheme::catmull_clark};
    for (const oracle::FaceSample& sample : oracle::sample_faces(mesh, rules, levels)) {
      if (sample.face != 0) continue;
      found.push_back(sample.position);
      if (places) places->push_back({sample.u, sample.v, 0});
    }
    return found;
  }
  // Heights that are opposite at mirrored places: their limit is 0 on the diagonal, positive in the half of the
  // table.
  [[nodiscard]] std::vector<Point> sides() const {
    std::vector<Point> net(mesh_.points.size(), Point{});
    for (int i = 0; i < one_; ++i) net[at(1, i)][0] = -std::sin(2 * std::numbers::pi * i / one_);
    for (int j = 0; j < two_; ++j) net[at(2, j)][0] = -2 * std::sin(2 * std::numbers::pi * (j - 1) / two_);
    return net;
  }
  [[nodiscard]] bool loop() const { return loop_; }
  [[nodiscard]] bool dual() const { return dual_; }

 private:
  bool loop_, dual_;
  int middle_, one_, two_;
  TaggedMesh mesh_;
};

// Which limit points are on this half of the quad.
std::vector<bool> on_half(const std::string& scheme, const Rings& rings, int levels, bool mirrored) {
  std::vector<Point> places;
  const std::vector<Point> sides = rings.limits(scheme, rings.sides(), levels, &places);
  std::vector<bool> found;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const double side = rings.dual() ? sides[k][0] : rings.loop() ? 0 : places[k][0] - places[k][1];
    found.push_back((mirrored ? -side : side) >= -1e-12);
  }
  return found;
}

// Bounds of a coordinate of a patch by a program that knows the table alone: values of two planes at the corners of
// the triangle.
struct Planes {
  std::array<double, 3> lower, upper;

  // How far a value is inside of both: negative if it is not.
  [[nodiscard]] std::array<double, 2> room(const std::array<double, 3>& weights, double value) const {
    double below = 0, above = 0;
    for (std::size_t k = 0; k < 3; ++k) below += weights[k] * lower[k], above += weights[k] * upper[k];
    return {value - below, above - value};
  }
};

Planes planes_around(const json& table, const std::vector<double>& control) {
  const std::size_t first = table["first_bounded"];
  std::array<double, 3> corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < control.size(); ++i) {
      const double weight = first == 3 ? (i == k ? 1 : 0) : table["corner_limits"][k][i].get<double>();
      corners[k] += weight * control[i];
    }
  }
  const auto linear = [&](const json& u) {
    const double x = u[0], y = u[1];
    return (1 - x - y) * corners[0] + x * corners[1] + y * corners[2];
  };
  Planes found{};
  for (std::size_t k = 0; k < 3; ++k) {
    found.lower[k] = found.upper[k] = linear(table["triangle"][k]);
    for (std::size_t i = first; i < control.size(); ++i) {
      const double d = control[i] - linear(table["points"][i]);
      const double below = table["below"][i - first][k], above = table["above"][i - first][k];
      found.lower[k] += d > 0 ? d * below : d * above;
      found.upper[k] += d > 0 ? d * above : d * below;
    }
  }
  return found;
}

// Weights of the triangle's corners at a domain point.
std::array<double, 3> weights_at(const json& triangle, const Point& u) {
  const double x0 = triangle[0][0], y0 = triangle[0][1], x1 = triangle[1][0], y2 = triangle[2][1];
  const double one = (u[0] - x0) / (x1 - x0), two = (u[1] - y0) / (y2 - y0);
  return {1 - one - two, one, two};
}

// Limit points of nets on a half of the patch's quad; of Loop on the patch, and on it once more mirrored.
class Half {
 public:
  Half(const std::string& scheme, const json& table, const Rings& rings, int levels, bool mirrored)
      : scheme_(scheme), table_(table), rings_(rings), levels_(levels), mirrored_(mirrored) {
    mine_ = on_half(scheme, rings, levels, mirrored);
  }
  // With these control points; all others are at a place that would be noticed.
  [[nodiscard]] std::vector<Point> limits(const std::vector<Point>& control) const {
    std::vector<Point> net(rings_.sides().size(), Point{17, 17, 17});
    for (std::size_t i = 0; i < control.size(); ++i)
      net[rings_.at(table_["numbering"][i], mirrored_)] = control[i];
    const std::vector<Point> all = rings_.limits(scheme_, net, levels_);
    std::vector<Point> found;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (mine_[k]) found.push_back(all[k]);
    }
    return found;
  }

 private:
  const std::string& scheme_;
  const json& table_;
  const Rings& rings_;
  int levels_;
  bool mirrored_;
  std::vector<bool> mine_;
};

class PatchSamples {
 public:
  PatchSamples(const json& table, const Half& half)
      : table_(table), half_(half), count_(table["points"].size()) {
    std::vector<Point> layout;
    for (const json& u : table["points"]) layout.push_back({u[0].get<double>(), u[1].get<double>(), 0});
    for (const Point& u : half.limits(layout)) weights_.push_back(weights_at(table["triangle"], u));
  }
  void expect_domain_inside() const {
    ASSERT_GE(weights_.size(), 15u);
    for (const auto& weights : weights_) {
      for (const double w : weights) ASSERT_GE(w, -1e-12);
    }
  }
  void expect_holds_random_nets() const {
    std::mt19937_64 random(count_);
    std::uniform_real_distribution<double> height(-1, 1);
    for (int trial = 0; trial < 3; ++trial) {
      std::vector<Point> net(count_);
      for (Point& p : net) p = {height(random), height(random), height(random)};
      const std::vector<Point> limits = half_.limits(net);
      for (std::size_t x = 0; x < 3; ++x) {
        std::vector<double> control;
        for (const Point& p : net) control.push_back(p[x]);
        static_cast<void>(min_room(planes_around(table_, control), limits, x));
      }
    }
  }
  // Each function lies between its planes, and touches them nearly.
  void expect_holds_functions() const {
    const std::size_t first = table_["first_bounded"];
    for (std::size_t i = first; i < count_; i += 3) {
      std::vector<Point> net(count_, Point{});
      for (std::size_t x = 0; x < 3 && i + x < count_; ++x) net[i + x][x] = 1;
      const std::vector<Point> limits = half_.limits(net);
      for (std::size_t x = 0; x < 3 && i + x < count_; ++x) {
        const Planes planes{table_["below"][i + x - first], table_["above"][i + x - first]};
        for (const double room : min_room(planes, limits, x)) EXPECT_LT(room, 0.03) << "function " << i + x;
      }
    }
  }

 private:
  // The least room that the limit points have in a coordinate, which is not to be negative.
  std::array<double, 2> min_room(const Planes& planes, const std::vector<Point>& limits,
                                 std::size_t x) const {
    std::array<double, 2> least{1, 1};
    EXPECT_EQ(limits.size(), weights_.size());
    for (std::size_t k = 0; k < limits.size(); ++k) {
      const auto room = planes.room(weights_[k], limits[k][x]);
      for (std::size_t side = 0; side < 2; ++side) least[side] = std::min(least[side], room[side]);
    }
    EXPECT_GE(std::min(least[0], least[1]), -1e-12);
    return least;
  }

  const json& table_;
  const Half& half_;
  std::size_t count_;
  std::vector<std::array<double, 3>> weights_;
};

class table_command : public ::testing::TestWithParam<const char*> {};

// The largest valence asked for that the scheme has a table of.
int at_most(const std::string& scheme, int valence) {
  return scheme == "midedge" ? std::min(valence, 20) : valence;
}

TEST_P(table_command, bounds_patches_from_its_json_alone) {
  const std::string scheme = GetParam();
  for (const int wanted : {3, 4, 5, 6, 7, 12, 30}) {
    const int valence = at_most(scheme, wanted);
    const json table = table_of(scheme, static_cast<std::size_t>(valence));
    const Rings rings(scheme, valence);
    for (const bool mirrored : {false, true}) {
      SCOPED_TRACE(::testing::Message() << "valence " << valence << ", mirrored " << mirrored);
      const Half half(scheme, table, rings, valence <= 7 && valence % 2 == 1 ? 4 : 3, mirrored);
      const PatchSamples samples(table, half);
      samples.expect_domain_inside();
      samples.expect_holds_random_nets();
      if (valence <= 7) samples.expect_holds_functions();
    }
  }
}

TEST_P(table_command, numbers_faces_and_rings_alike) {
  const std::string scheme = GetParam();
  for (const int wanted : {3, 5, 6, 200}) {
    const int valence = at_most(scheme, wanted);
    const json table = table_of(scheme, static_cast<std::size_t>(valence));
    const Rings rings(scheme, valence);
    const auto turned = [](std::vector<std::uint32_t> face) {
      std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
      return face;
    };
    std::vector<std::vector<std::uint32_t>> known;
    for (const auto& face : rings.faces()) known.push_back(turned(face));
    for (const json& face : table["faces"]) {
      std::vector<std::uint32_t> mine;
      for (const json& i : face) mine.push_back(rings.at(table["numbering"][i.get<std::size_t>()], false));
      EXPECT_NE(std::find(known.begin(), known.end(), turned(mine)), known.end()) << face;
    }
  }
}

TEST_P(table_command, has_the_counts_of_its_scheme) {
  const std::string scheme = GetParam();
  const bool loop = scheme == "loop", catmark = scheme == "catmark";
  for (const int wanted : {3, 7, 200}) {
    const auto n = static_cast<std::size_t>(at_most(scheme, wanted));
    const json table = table_of(scheme, n);
    const std::size_t count = loop ? n + 6 : catmark ? 2 * n + 8 : n + 5, first = loop ? 3 : 0;
    EXPECT_EQ(table["command"], "table");
    EXPECT_EQ(table["scheme"], scheme);
    EXPECT_EQ(table["valence"], n);
    EXPECT_EQ(table["first_bounded"], first);
    EXPECT_EQ(table["points"].size(), count);
    EXPECT_EQ(table["numbering"].size(), count);
    EXPECT_EQ(table["below"].size(), count - first);
    EXPECT_EQ(table["above"].size(), count - first);
    ASSERT_EQ(table["corner_limits"].size(), 3);
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> limit{};  // of the layout, and the sum of weights
      for (std::size_t i = 0; i < count; ++i) {
        const double weight = table["corner_limits"][k][i];
        limit[0] += weight * table["points"][i][0].get<double>();
        limit[1] += weight * table["points"][i][1].get<double>();
        limit[2] += weight;
      }
      EXPECT_NEAR(limit[0], k == 1, loop ? 0.3 : 1e-9);
      EXPECT_NEAR(limit[1], k == 2, loop ? 0.3 : 1e-9);
      EXPECT_NEAR(limit[2], 1, 1e-12);
    }
  }
}

// Where the patch is, two planes are not farther apart than functions are high, or nearly.
TEST_P(table_command, has_planes_that_are_of_use) {
  const std::string scheme = GetParam();
  for (const int wanted : {3, 4, 5, 6, 8, 10, 13, 16, 20, 40, 80, 200}) {
    const json table = table_of(scheme, static_cast<std::size_t>(at_most(scheme, wanted)));
    const auto corner = [&](std::size_t k, std::size_t axis) {
      return table["triangle"][k][axis].get<double>();
    };
    for (std::size_t i = 0; i < table["below"].size(); ++i) {
      for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0 / 3, 1.0 / 3}}) {
        const double b = (x - corner(0, 0)) / (corner(1, 0) - corner(0, 0)),
                     c = (y - corner(0, 1)) / (corner(2, 1) - corner(0, 1));
        const auto at = [&](const char* plane) {
          const json& values = table[plane][i];
          return (1 - b - c) * values[0].get<double>() + b * values[1].get<double>() +
                 c * values[2].get<double>();
        };
        ASSERT_LE(at("above") - at("below"), 1.5) << wanted << " " << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(schemes, table_command, ::testing::Values("loop", "catmark", "doo-sabin", "midedge"),
                         [](const auto& scheme) {
                           std::string name = scheme.param;
                           std::erase(name, '-');
                           return name;
                         });

// [Wu05, sec. 4.3]: spokes of length 1 at equal angles, b and d on them, c between, a and e their mirror images.
TEST(table_of_loop, is_laid_out_as_in_the_dissertation) {
  for (int n = 3; n <= 12; ++n) {
    const json table = table_of("loop", static_cast<std::size_t>(n));
    const double angle = 2 * std::numbers::pi / n, c = std::cos(angle / 2);
    const double k = n < 6 ? 6 * (7 - 2 * c * c) / (15 + 2 * c * c) : 4 * (2 - c * c) / (1 + 2 * c * c);
    const auto along = [&](double a, double length) {
      return std::array{length * std::cos(a), length * std::sin(a)};
    };
    for (std::size_t i = 0; i < table["points"].size(); ++i) {
      const double x = table["points"][i][0], y = table["points"][i][1];
      const int ring = table["numbering"][i]["ring"], index = table["numbering"][i]["index"];
      std::array<double, 2> expected{0, 0};
      if (ring == 1) expected = along(angle * index, 1);
      const int j = index == 2 * n - 1 ? -1 : index;
      if (ring == 2) expected = along(angle * j / 2, j % 2 == 0 ? k : k * std::cos(angle / 2));
      EXPECT_NEAR(x + y * std::cos(angle), expected[0], 1e-12) << n << ", " << ring << ", " << index;
      EXPECT_NEAR(y * std::sin(angle), expected[1], 1e-12) << n << ", " << ring << ", " << index;
    }
  }
}

TEST(table_usage, is_refused_in_one_line) {
  for (const char* bad : {"2", "201", "0", "-3", "3.5", "x", ""}) {
    const Outcome outcome = run_research({"table", "--scheme", "loop", "--valence", bad});
    EXPECT_EQ(outcome.status, 2) << bad;
    EXPECT_NE(outcome.err.find("3 to 200"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  for (const char* bad : {"bilinear", "flat", "auto", "curve"}) {
    const Outcome outcome = run_research({"table", "--scheme", bad, "--valence", "5"});
    EXPECT_EQ(outcome.status, 2) << bad;
    EXPECT_NE(outcome.err.find("midedge"), std::string::npos) << outcome.err;
  }
  const Outcome wide = run_research({"table", "--scheme", "midedge", "--valence", "21"});
  EXPECT_EQ(wide.status, 2);
  EXPECT_NE(wide.err.find("beyond 20 corners"), std::string::npos) << wide.err;
  EXPECT_EQ(run_research({"table", "--scheme", "loop"}).status, 2);
  EXPECT_EQ(run_research({"table", "--valence", "5"}).status, 2);
  EXPECT_EQ(run_research({"table", "--scheme", "loop", "--valence", "5", "mesh.obj"}).status, 2);
}

TEST(table_text, has_a_line_a_control_point) {
  const Outcome outcome = run_research({"table", "--scheme", "loop", "--valence", "5"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2 + 11);
}

}  // namespace
}  // namespace snug::testing::table_test
