#include "certified.h"

#include <snug/certificate/text.h>

#include <map>
#include <sstream>

namespace snug::faults_test {
namespace {

using namespace snug::testing;

// The n-th line that begins so; the number of lines if there is none.
std::size_t find(const Lines& lines, const std::string& begin, int n = 0) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].starts_with(begin) && n-- == 0) return i;
  }
  return lines.size();
}

std::string exactly(double x) {
  std::string text;
  append_exactly(text, x);
  return text;
}

// Lines of a tree: each ends in three integers.
std::vector<std::size_t> leaves_of(const Lines& lines) {
  std::vector<std::size_t> leaves;
  for (std::size_t i = find(lines, "apart ") + 1; i < lines.size() && !lines[i].starts_with("near"); ++i)
    leaves.push_back(i);
  return leaves;
}

// A leaf: what divides before it, and its direction.
struct Leaf {
  std::string steps;
  std::array<long, 3> w;
  explicit Leaf(const std::string& line) {
    std::istringstream words(line);
    if (std::isalpha(static_cast<unsigned char>(line[0])) != 0) words >> steps;
    for (long& x : w) words >> x;
  }
  [[nodiscard]] std::string direction(long factor = 1) const {
    return std::to_string(factor * w[0]) + ' ' + std::to_string(factor * w[1]) + ' ' +
           std::to_string(factor * w[2]);
  }
  [[nodiscard]] std::string text(const std::string& more, long factor = 1) const {
    return steps + more + ' ' + direction(factor);
  }
};

struct Tally {
  std::map<std::string, int> planted;
  int total = 0;
};

void expect_refused(const std::string& fault, const Lines& lines, const std::string& name, Tally& tally) {
  ++tally.planted[fault];
  ++tally.total;
  EXPECT_NE(check(text_of(lines)).refused, "") << fault << ": " << name;
}

// Two surfaces at a known distance, and the certificate of that.
struct Case {
  std::string name;
  Surface a, b;
  Motion pose;
  Distance answer;
  Lines lines;
};

std::vector<Case> cases(std::uint64_t seed, std::size_t most) {
  std::vector<Case> all;
  std::mt19937_64 random(seed);
  std::optional<Surface> last;
  std::size_t number = 0;
  for_each_certified_surface(seed, [&](const std::string& name, const Surface& surface) {
    if (!last) last = surface;
    const Motion pose = placed_beside(*last, surface, 1.3, random);
    if (++number % 2 == 0 && all.size() < most) {
      Certificate certificate;
      const Distance answer =
          distance(*last, surface.at(pose), {.relative = 0.01}, {.threads = 1, .certificate = &certificate});
      if (answer.distance.lower > 0 && certificate.missing.empty()) {
        all.push_back({name, *last, surface, pose, answer, lines_of(certificate.text)});
      }
    }
    last = surface;
  });
  return all;
}

// What makes the proof incomplete, or one of its steps false.
void plant_in_proof(const Case& c, Tally& tally) {
  const std::vector<std::size_t> leaves = leaves_of(c.lines);
  const std::size_t first = leaves[0], last = leaves.back(), middle = leaves[leaves.size() / 2];
  const std::size_t near = find(c.lines, "near ");
  Lines lines = c.lines;
  lines[middle] = Leaf(lines[middle]).text("", -1);
  expect_refused("a direction turned round", lines, c.name, tally);
  lines = c.lines;
  lines[middle] = Leaf(lines[middle]).text("", 0);
  expect_refused("no direction", lines, c.name, tally);
  lines = c.lines;
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(last));
  expect_refused("a leaf dropped", lines, c.name, tally);
  lines = c.lines;
  lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(first), "1 0 0");
  expect_refused("a leaf too many", lines, c.name, tally);
  lines = c.lines;
  lines[middle] = "A " + lines[middle];
  expect_refused("a child dropped", lines, c.name, tally);
  lines = c.lines;
  std::string& order = lines[find(lines, "order")];
  order = order.substr(0, order.rfind(' '));
  expect_refused("an owner left out of the order", lines, c.name, tally);
  lines = c.lines;
  std::string& twice = lines[find(lines, "order", 1)];
  const std::size_t second = twice.find(' ', 6);
  if (second != std::string::npos) {
    twice = twice.substr(0, second) + twice.substr(5, second - 5) +
            twice.substr(twice.find(' ', second + 1) == std::string::npos ? twice.size()
                                                                          : twice.find(' ', second + 1));
    expect_refused("an owner twice in the order", lines, c.name, tally);
  }
  lines = c.lines;
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(near) + 1);
  expect_refused("a place dropped", lines, c.name, tally);
  lines = c.lines;
  lines.pop_back();
  expect_refused("no end", lines, c.name, tally);
}

// What makes the claim false.
void plant_in_claim(const Case& c, Tally& tally) {
  const Interval truth = c.answer.distance;
  Lines lines = c.lines;
  lines[find(lines, "apart ")] = "apart " + exactly(truth.upper * 1.001);
  expect_refused("a margin beyond the distance", lines, c.name, tally);
  lines = c.lines;
  lines[find(lines, "near ")] = "near " + exactly(truth.lower * 0.999);
  expect_refused("an upper end below the distance", lines, c.name, tally);
  // Moved by the difference of two limit points, the surfaces touch.
  const Vector3 between = c.answer.witness[1].point - c.answer.witness[0].point;
  const auto placed = [&](const Vector3& by) {
    std::string text = c.lines[find(c.lines, "placed", 1)];
    text = text.substr(0, text.find(' ', 7));
    const Motion moved = c.pose.with_offset(c.pose.offset() + by);
    for (const double x : moved.numbers()) append_words(text, x);
    return text;
  };
  lines = c.lines;
  lines[find(lines, "placed", 1)] = placed(-between);
  expect_refused("a pose in which they touch", lines, c.name, tally);
  lines[find(lines, "placed", 1)] = placed((3 * c.a.size() / length(between)) * between);
  expect_refused("a pose in which they are far apart", lines, c.name, tally);
}

// Another mesh, for which the library knows that a claim is false.
void plant_in_mesh(const Case& c, const std::string& fault, const ControlMesh& mesh,
                   const SurfaceOptions& options, const std::function<void(Lines&)>& change, Tally& tally) {
  try {
    const Surface changed(mesh, options);
    const Distance now = distance(c.a, changed.at(c.pose), {.relative = 0.001});
    if (now.distance.lower <= c.answer.distance.upper * (1 + 1e-6) &&
        now.distance.upper >= c.answer.distance.lower * (1 - 1e-6))
      return;
  } catch (const InputError&) {
    return;
  }
  Lines lines = c.lines;
  change(lines);
  expect_refused(fault, lines, c.name, tally);
}

void plant_in_meshes(const Case& c, Tally& tally) {
  const std::size_t head = find(c.lines, "surface ", 1);
  const bool one = head == c.lines.size();
  const std::size_t at = one ? find(c.lines, "surface ") : head;
  const SurfaceOptions options{.scheme = c.b.scheme(), .boundary = c.b.boundary()};
  const auto line = [&](const std::string& begin) {
    std::size_t i = at;
    while (!c.lines[i].starts_with(begin)) ++i;
    return i;
  };
  if (one) return;
  ControlMesh mesh = c.b.mesh();
  for (std::size_t v = 0; v < std::min<std::size_t>(mesh.points.size(), 4); ++v) {
    mesh = c.b.mesh();
    mesh.points[v] = mesh.points[v] + Vector3{0.5 * c.b.size(), 0, 0.3 * c.b.size()};
    plant_in_mesh(
        c, "a point moved", mesh, options,
        [&](Lines& lines) {
          std::string text;
          append_point(text, mesh.points[v]);
          lines[line("points") + 1 + v] = text;
        },
        tally);
  }
  mesh = c.b.mesh();
  if (!mesh.tags.creases.empty()) {
    mesh.tags.creases.clear();
    plant_in_mesh(
        c, "creases left out", mesh, options,
        [&](Lines& lines) {
          const std::size_t creases = line("creases"), corners = line("corners");
          lines[creases] = "creases 0";
          lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(creases) + 1,
                      lines.begin() + static_cast<std::ptrdiff_t>(corners));
        },
        tally);
  }
  for (const Scheme scheme : {Scheme::catmark, Scheme::bilinear, Scheme::loop, Scheme::flat}) {
    if (scheme == c.b.scheme() || c.b.traits().dual) continue;
    plant_in_mesh(
        c, "another scheme", c.b.mesh(), {.scheme = scheme, .boundary = c.b.boundary()},
        [&](Lines& lines) {
          lines[at] =
              std::string("surface ") + name_of(scheme) + c.lines[at].substr(c.lines[at].find(' ', 8));
        },
        tally);
  }
}

TEST(certificate_faults, that_make_a_claim_false_or_its_proof_incomplete_are_refused) {
  Tally tally;
  for (const Case& c : cases(71, fewer(40))) {
    ASSERT_EQ(check(text_of(c.lines)).refused, "") << c.name;
    plant_in_proof(c, tally);
    plant_in_claim(c, tally);
    plant_in_meshes(c, tally);
    if (HasFailure()) return;
  }
  for (const auto& [fault, count] : tally.planted) RecordProperty(fault, count);
  EXPECT_GE(tally.total, static_cast<int>(fewer(400)));
  if (fewer(40) < 40) return;  // too few for every fault of a mesh
  for (const char* fault : {"a point moved", "creases left out", "another scheme"})
    EXPECT_GE(tally.planted[fault], 1) << fault;
}

TEST(certificate_faults, are_not_what_changes_nothing) {
  for (const Case& c : cases(72, fewer(20))) {
    const std::vector<std::size_t> leaves = leaves_of(c.lines);
    for (const std::size_t leaf : {leaves[0], leaves.back()}) {
      Lines lines = c.lines;
      const Leaf known(c.lines[leaf]);
      for (const std::string& changed :
           {known.text("", 2), known.text("a"), known.text("aA") + ' ' + known.direction()}) {
        lines[leaf] = changed;
        EXPECT_EQ(check(text_of(lines)).refused, "") << c.name << ": " << changed;
      }
    }
  }
}

// A crossing of two surfaces: each of its parts is needed.
TEST(certificate_faults, of_common_points_are_refused) {
  const Surface cube(control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  const Motion pose = Motion::rotation({1, 2, 3}, 0.7).with_offset({0.5, 0.3, 0.2});
  Certificate certificate;
  ASSERT_EQ(
      collide(cube, cube.at(pose), {.tolerance = 0}, {.threads = 1, .certificate = &certificate}).verdict,
      Verdict::intersecting);
  ASSERT_EQ(certificate.missing, "");
  const Lines whole = lines_of(certificate.text);
  ASSERT_EQ(check(text_of(whole)).refused, "");
  Tally tally;
  for (int k = 0; k < 4; ++k) {
    Lines lines = whole;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(find(lines, "border", k)));
    expect_refused("a border left out", lines, "cubes", tally);
    lines = whole;
    lines[find(lines, "border", k)] = "border 4 0 0 0";
    expect_refused("a border without a direction", lines, "cubes", tally);
  }
  Lines lines = whole;
  lines[find(lines, "end ", 1)] = lines[find(lines, "end ", 0)];
  expect_refused("both ends on one side", lines, "cubes", tally);
  for (int k = 0; k < 2; ++k) {
    lines = whole;
    std::string& end = lines[find(lines, "end ", k)];
    for (int i = 0; i < 3; ++i) end = end.substr(0, end.rfind(' '));
    end += " 0 0 0";
    expect_refused("an end without a direction", lines, "cubes", tally);
  }
  for (const double far : {2.0, 5.0, -4.0}) {
    lines = whole;
    std::string& placed = lines[find(lines, "placed", 1)];
    placed = "placed 0";
    const Motion moved = pose.with_offset({far, far, far});
    for (const double x : moved.numbers()) append_words(placed, x);
    expect_refused("a pose in which they are apart", lines, "cubes", tally);
  }
}

// Whatever the bytes are: accepted or refused, and nothing else.
TEST(certificate_faults, of_any_sort_end_in_an_answer) {
  std::mt19937_64 random(73);
  std::size_t refused = 0, total = 0;
  const std::vector<Case> all = cases(74, fewer(12));
  for (const Case& c : all) {
    const std::string whole = text_of(c.lines);
    for (std::uint64_t trial = 0; trial < fewer(60); ++trial) {
      std::string text = whole;
      const std::size_t changes = 1 + random() % 4;
      for (std::size_t i = 0; i < changes; ++i) {
        const std::size_t place = random() % text.size();
        switch (random() % 4) {
          case 0:
            text[place] = static_cast<char>(random() % 256);
            break;
          case 1:
            text.erase(place, 1 + random() % 20);
            break;
          case 2:
            text.insert(place, std::to_string(random() >> (random() % 64)));
            break;
          default:
            text.insert(place,
                        std::array{" a", " A", " b", "-", " inf ", " nan ", "e999", " order "}[random() % 8]);
            break;
        }
        if (text.empty()) text = " ";
      }
      refused += check(text).refused.empty() ? 0 : 1;
      ++total;
    }
    static_cast<void>(check(whole.substr(0, random() % whole.size())));
  }
  EXPECT_GE(4 * refused, 3 * total);
}

// A tree of any depth is refused, and is no load on the stack.
TEST(certificate_faults, of_depth_and_size_are_refused) {
  const std::string head =
      "snug-certificate 1 surface flat edge-and-corner uniform catmark points 3 0 0 0 1 0 0 0 1 0 faces 1 3 "
      "0 1 2 "
      "creases 0 corners 0 holes 0 order 0 question placed 0 1 0 0 0 0 1 0 0 0 0 1 0 point 0 0 5 apart 0 ";
  std::string deep = head;
  for (int i = 0; i < 20'000; ++i) deep += "aAA";
  EXPECT_NE(check(deep).refused.find("divided more often"), std::string::npos);
  EXPECT_NE(check(head + std::string(40, 'a') + " 0 0 1", 20'000).refused.find("more points"),
            std::string::npos);
}

}  // namespace
}  // namespace snug::faults_test
