#include <snug/hull.h>

#include <gtest/gtest.h>
#include <oracle/tagged_shapes.h>
#include <testing/hulls.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

#include <cmath>
#include <iostream>
#include <numbers>

namespace snug::hull_test {
namespace {

namespace meshes = oracle::meshes;
using oracle::Rules;
using oracle::TaggedMesh;
using testing::both;
using testing::HullCounts;
using testing::moved;

constexpr SchemeOptions bilinear{Scheme::bilinear};
constexpr Rules loop{.scheme = oracle::PrimalScheme::loop};

SchemeOptions options_of(const oracle::WindingScheme& scheme) {
  if (const auto* const rules = std::get_if<Rules>(&scheme)) return testing::options_of(*rules);
  SchemeOptions options;
  options.scheme = std::get<oracle::DualScheme>(scheme) == oracle::DualScheme::doo_sabin ? Scheme::doo_sabin
                                                                                         : Scheme::midedge;
  return options;
}

struct Model {
  explicit Model(const TaggedMesh& mesh, const oracle::WindingScheme& scheme = Rules{})
      : Model(testing::control_mesh(mesh), options_of(scheme)) {}
  Model(ControlMesh mesh, const SchemeOptions& options)
      : surface(testing::public_surface(std::move(mesh), options)) {}
  [[nodiscard]] Hulls hulls(const HullOptions& options, const Run& run = {}) const {
    return hull(surface, options, run);
  }
  [[nodiscard]] Hulls hulls(double tolerance) const { return hulls(HullOptions{.error = tolerance}); }

  Surface surface;
};

TaggedMesh torus(std::uint32_t n, std::uint32_t m) {
  TaggedMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    for (std::uint32_t j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m, r = 3 + std::cos(b);
      mesh.points.push_back({r * std::cos(a), r * std::sin(a), std::sin(b)});
      const std::uint32_t k = (i + 1) % n, l = (j + 1) % m;
      mesh.polygons.push_back({i * m + j, k * m + j, k * m + l, i * m + l});
    }
  }
  return mesh;
}

// Pyramids on the faces of a cube.
TaggedMesh star() {
  const TaggedMesh cube = meshes::cube();
  TaggedMesh mesh;
  mesh.points = cube.points;
  for (const auto& polygon : cube.polygons) {
    oracle::Point middle{};
    for (const std::uint32_t v : polygon) {
      for (std::size_t a = 0; a < 3; ++a) middle[a] += cube.points[v][a] / 4;
    }
    for (double& x : middle) x = 0.5 + 3 * (x - 0.5);
    const auto apex = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(middle);
    for (std::size_t k = 0; k < 4; ++k) mesh.polygons.push_back({polygon[k], polygon[(k + 1) % 4], apex});
  }
  return mesh;
}

TaggedMesh turned_inside_out(TaggedMesh mesh) {
  for (auto& polygon : mesh.polygons) std::reverse(polygon.begin(), polygon.end());
  return mesh;
}

TaggedMesh creased(TaggedMesh mesh, double sharpness) {
  const auto& polygon = mesh.polygons[0];
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    mesh.creases.push_back({polygon[k], polygon[(k + 1) % polygon.size()], sharpness});
  }
  return mesh;
}

struct Case {
  std::string name;
  TaggedMesh mesh;
  oracle::WindingScheme scheme;
};

std::vector<Case> cases() {
  const TaggedMesh cube = meshes::cube(), grid = meshes::quad_grid(3, 3);
  TaggedMesh bumpy = grid;
  bumpy.points[5][2] = 1;
  bumpy.points[10][2] = -0.7;
  return {{"cube", cube, Rules{}},
          {"cube, loop", meshes::triangulated(cube), loop},
          {"cube, doo-sabin", cube, oracle::DualScheme::doo_sabin},
          {"cube, midedge", cube, oracle::DualScheme::midedge},
          {"star", star(), loop},
          {"torus", torus(8, 5), Rules{}},
          {"prism", meshes::prism(5), Rules{}},
          {"pyramid", meshes::pyramid(7), Rules{}},
          {"crease", creased(cube, 10), Rules{}},
          {"crease, semi-sharp", creased(cube, 1.5), Rules{}},
          {"cavity", both(moved(cube, 3, {}), turned_inside_out(moved(cube, 1, {1, 1, 1}))), Rules{}},
          {"two cubes", both(cube, moved(cube, 1, {2, 0.3, 0})), Rules{}},
          {"grid", grid, Rules{}},
          {"bumpy grid", bumpy, Rules{}},
          {"bumpy grid, edge only", bumpy, Rules{.boundary = oracle::Boundary::edge_only}},
          {"bumpy grid, none", meshes::quad_grid(5, 5), Rules{.boundary = oracle::Boundary::none}},
          {"bumpy grid, loop", meshes::triangulated(bumpy), loop}};
}

TEST(hulls, sandwich_surfaces_of_each_kind) {
  HullCounts counts;
  for (const Case& c : cases()) {
    const Model model(c.mesh, c.scheme);
    const double tolerance = 0.02 * model.surface.size();
    const Hulls found = model.hulls(tolerance);
    EXPECT_EQ(found.outcome, Outcome::complete)
        << c.name << ": " << (found.problems.empty() ? "" : name_of(found.problems[0].fault));
    ASSERT_TRUE(found.inner && found.outer) << c.name;
    testing::expect_sandwich(c.mesh, c.scheme, found, tolerance, 4, c.name, counts);
    EXPECT_EQ(found.inner->owners.size(), found.inner->triangles.size());
  }
  std::cout << counts.hulls << " hulls, " << counts.triangles << " triangles, " << counts.points
            << " points, " << counts.chords << " chords, " << counts.sides << " sides\n";
  EXPECT_GT(counts.chords, 2'000u);
  EXPECT_GT(counts.sides, 50u);
}

TEST(hulls, of_one_side_are_those_of_both) {
  const Model model(meshes::cube());
  const Hulls all = model.hulls(0.02);
  const Hulls inner = model.hulls(HullOptions{.error = 0.02, .outer = false}),
              outer = model.hulls(HullOptions{.error = 0.02, .inner = false});
  EXPECT_FALSE(inner.outer || outer.inner);
  EXPECT_TRUE(inner.outcome == Outcome::complete && outer.outcome == Outcome::complete);
  EXPECT_EQ(inner.inner->positions, all.inner->positions);
  EXPECT_EQ(outer.outer->positions, all.outer->positions);
}

TEST(hulls, of_a_flat_sheet_lie_behind_and_in_front_of_it) {
  const Model model(meshes::quad_grid(3, 3));
  const Hulls found = model.hulls(0.1);
  ASSERT_EQ(found.outcome, Outcome::complete);
  EXPECT_FALSE(found.closed);
  for (const Point3& p : found.inner->positions) EXPECT_LT(p.z, 0);
  for (const Point3& p : found.outer->positions) EXPECT_GT(p.z, 0);
}

TEST(hulls, face_outward_whichever_way_faces_do) {
  HullCounts counts;
  for (const TaggedMesh& mesh : {meshes::cube(), meshes::triangulated(torus(8, 5))}) {
    const TaggedMesh inward = turned_inside_out(mesh);
    const Model model(inward);
    const double tolerance = 0.02 * model.surface.size();
    const Hulls found = model.hulls(tolerance);
    ASSERT_EQ(found.outcome, Outcome::complete);
    testing::expect_sandwich(mesh, Rules{}, found, tolerance, 4, "inward", counts);
  }
}

TEST(hulls, do_not_depend_on_threads) {
  const Model model(star(), loop);
  const Hulls one = model.hulls(HullOptions{.error = 0.03}, {.threads = 1}),
              three = model.hulls(HullOptions{.error = 0.03}, {.threads = 3});
  ASSERT_TRUE(one.outcome == Outcome::complete && three.outcome == Outcome::complete);
  EXPECT_EQ(one.inner->positions, three.inner->positions);
  EXPECT_EQ(one.inner->triangles, three.inner->triangles);
  EXPECT_EQ(one.outer->positions, three.outer->positions);
  EXPECT_EQ(one.outer->gap, three.outer->gap);
}

TEST(hulls, of_floats_are_floats_and_proved) {
  HullCounts counts;
  for (const double far : {0.0, 1000.0}) {
    for (const TaggedMesh& plain : {meshes::cube(), star()}) {
      const TaggedMesh mesh = moved(plain, 1, {far, -far, 0.1});
      const Model model(mesh);
      const double tolerance = 0.02 * model.surface.size();
      const Hulls found = model.hulls(HullOptions{.error = tolerance, .single_precision = true});
      EXPECT_EQ(found.outcome, Outcome::complete) << far;
      testing::expect_sandwich(mesh, Rules{}, found, tolerance, 4, "floats", counts);
      for (const Hull* const hull : {&*found.inner, &*found.outer}) {
        for (const Point3& p : hull->positions) {
          for (std::size_t a = 0; a < 3; ++a) EXPECT_EQ(static_cast<double>(static_cast<float>(p[a])), p[a]);
        }
      }
    }
  }
}

// The least tolerance of floats, where rounding moves vertices as far as they are in front of the surface.
TEST(hulls, of_floats_withstand_their_rounding) {
  TaggedMesh mesh = moved(meshes::cube(), 1, {1.1, -1.2, 1.3});
  for (oracle::Point& p : mesh.points) p = {p[0] - 0.3 * p[1], p[1] + 0.2 * p[2], p[2] + 0.1 * p[0]};
  const Model model(testing::control_mesh(mesh), bilinear);
  HullOptions options{.error = 1e-9, .single_precision = true};
  std::string message;
  try {
    static_cast<void>(model.hulls(options));
  } catch (const InputError& error) {
    message = error.what();
  }
  ASSERT_NE(message.find("floats allow no error below "), std::string::npos) << message;
  options.error = std::stod(message.substr(message.find("below ") + 6));
  const Hulls found = model.hulls(options);
  EXPECT_EQ(found.outcome, Outcome::complete)
      << (found.problems.empty() ? "" : name_of(found.problems[0].fault));
}

TEST(hulls, do_not_depend_on_the_unit) {
  const Hulls plain = Model(meshes::cube()).hulls(0x1p-6);
  ASSERT_EQ(plain.outcome, Outcome::complete);
  for (const int exponent : {-990, -300, 300, 990}) {
    const Model model(moved(meshes::cube(), std::ldexp(1, exponent), {}));
    const Hulls found = model.hulls(std::ldexp(1, exponent - 6));
    EXPECT_EQ(found.outcome, Outcome::complete) << exponent;
    EXPECT_EQ(found.outer->triangles, plain.outer->triangles);
    EXPECT_NEAR(std::ldexp(found.outer->gap, -exponent), plain.outer->gap, 1e-12);
  }
}

std::string refusal(const Model& model, const HullOptions& options, InputProblem problem) {
  try {
    static_cast<void>(model.hulls(options));
  } catch (const InputError& error) {
    EXPECT_EQ(error.problem(), problem) << error.what();
    return error.what();
  }
  return "not refused";
}

TEST(hulls, refuse_what_has_no_two_sides) {
  for (const auto& [mesh, part] : {std::pair{meshes::moebius(5), "the same way"},
                                   {meshes::book(3), "the same way"},
                                   {meshes::same_ways(), "the same way"}}) {
    const std::string message = refusal(Model(mesh), {.error = 0.1}, InputProblem::refused);
    EXPECT_NE(message.find(part), std::string::npos) << message;
    EXPECT_NE(message.find("faces "), std::string::npos) << message;
  }
}

TEST(hulls, refuse_what_is_no_tolerance) {
  const Model model(meshes::cube());
  for (const double tolerance : {0.0, -1.0, double{NAN}, double{INFINITY}}) {
    EXPECT_NE(refusal(model, {.error = tolerance}, InputProblem::value).find("finite and greater than 0"),
              std::string::npos);
  }
  EXPECT_NE(refusal(model, {.error = 1}, InputProblem::value).find("at most 0.5"), std::string::npos);
  EXPECT_NE(refusal(model, {.error = 1e-15}, InputProblem::value).find("doubles allow no error below"),
            std::string::npos);
  EXPECT_NE(
      refusal(model, {.error = 0.1, .inner = false, .outer = false}, InputProblem::value).find("ask for"),
      std::string::npos);
}

TEST(hulls, refuse_floats_that_do_not_fit) {
  const Model model(moved(meshes::cube(), 1e39, {}));
  EXPECT_NE(refusal(model, {.error = 1e37, .single_precision = true}, InputProblem::unrepresentable)
                .find("does not fit a float"),
            std::string::npos);
}

// Some problem is near a place.
void expect_problem_near(const Hulls& found, const Point3& place, double reach, const std::string& name) {
  EXPECT_NE(found.outcome, Outcome::complete) << name;
  EXPECT_TRUE(std::any_of(found.problems.begin(), found.problems.end(), [&](const HullProblem& p) {
    return distance(p.place, place) <= reach;
  })) << name;
  for (const HullProblem& p : found.problems) EXPECT_TRUE(p.owner) << name;
}

TEST(hulls, are_not_verified_of_surfaces_that_touch_themselves) {
  const TaggedMesh cube = meshes::cube();
  // Faces on each other, a face on an edge, a corner in a face, and through each other.
  for (const auto& [mesh, place, name] :
       {std::tuple{both(cube, moved(cube, 1, {1, 0, 0})), Point3{1, 0.5, 0.5}, "faces"},
        {both(cube, moved(cube, 1, {1, 1, 0})), Point3{1, 1, 0.5}, "edges"},
        {both(cube, moved(cube, 1, {0.5, 0.5, 0.5})), Point3{0.75, 0.75, 0.75}, "crossing"},
        {meshes::two_cubes_at_a_vertex(), Point3{0, 0, 0}, "a vertex"}}) {
    const Model model(testing::control_mesh(mesh), bilinear);
    const Hulls found = model.hulls(0.01 * model.surface.size());
    const double reach = std::string(name) == "a vertex" ? 2 : 1;
    expect_problem_near(found, place, reach, name);
  }
}

TEST(hulls, are_not_verified_of_sheets_on_each_other) {
  const Model twice(testing::control_mesh(both(meshes::cube(), meshes::cube())), bilinear);
  EXPECT_NE(twice.hulls(0.01).outcome, Outcome::complete);
}

TEST(hulls, pass_between_sheets_that_are_near_to_each_other) {
  HullCounts counts;
  const TaggedMesh grid = meshes::quad_grid(3, 3);
  for (const double gap : {0.2, 0.04, 0.01, 1e-7}) {
    const TaggedMesh mesh = both(grid, moved(grid, 1, {0, 0, gap}));
    const Model model(mesh);
    const double tolerance = 0.1;
    const Hulls found = model.hulls(tolerance);
    EXPECT_EQ(found.outcome, Outcome::complete) << gap;
    testing::expect_sandwich(mesh, Rules{}, found, tolerance, 3, "sheets", counts);
  }
  expect_problem_near(Model(both(grid, grid)).hulls(0.1), {1.5, 1.5, 0}, 1, "on each other");
}

TEST(hulls, of_a_thin_plate_are_inside_and_outside_of_it) {
  HullCounts counts;
  TaggedMesh plate = meshes::cube();
  for (oracle::Point& p : plate.points) p[2] *= 0.02;
  const Model model(plate);
  const double tolerance = 0.02;
  const Hulls found = model.hulls(tolerance);
  EXPECT_EQ(found.outcome, Outcome::complete);
  testing::expect_sandwich(plate, Rules{}, found, tolerance, 5, "plate", counts);
}

// A gear whose caps are fans around one vertex: only beside that triangles are narrow and must be small.
TEST(hulls, are_refined_where_they_fail_alone) {
  constexpr std::uint32_t n = 44;
  TaggedMesh gear;
  for (const double z : {0.0, 0.3}) {
    for (std::uint32_t k = 0; k < n; ++k) {
      const double angle = 2 * std::numbers::pi * k / n, r = k % 4 < 2 ? 1.25 : 1;
      gear.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  }
  for (std::uint32_t k = 1; k + 1 < n; ++k) {
    gear.polygons.push_back({0, k + 1, k});
    gear.polygons.push_back({n, n + k, n + k + 1});
  }
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::uint32_t next = (k + 1) % n;
    gear.polygons.push_back({k, next, n + next});
    gear.polygons.push_back({k, n + next, n + k});
  }
  const Model model(gear, loop);
  const double tolerance = 0.01 * model.surface.size();
  const Hulls found = model.hulls(HullOptions{.error = tolerance, .outer = false});
  ASSERT_EQ(found.outcome, Outcome::complete);
  EXPECT_LT(found.inner->triangles.size(), 25'000u);
}

// Halves of a torus that are not joined touch along their borders, which no tolerance mends.
TEST(hulls, that_touch_are_given_up_soon) {
  TaggedMesh halves = torus(8, 5);
  const auto count = static_cast<std::uint32_t>(halves.points.size());
  for (std::uint32_t v = 0; v < count; ++v) halves.points.push_back(oracle::Point(halves.points[v]));
  for (std::size_t f = halves.polygons.size() / 2; f < halves.polygons.size(); ++f) {
    for (std::uint32_t& v : halves.polygons[f]) v += count;
  }
  const Model model(halves);
  const Hulls found = model.hulls(0.01 * model.surface.size());
  ASSERT_NE(found.outcome, Outcome::complete);
  EXPECT_FALSE(found.outer) << "nobody can use the other one";
  EXPECT_LT(found.inner->triangles.size(), 5'000u);
}

TEST(hulls, are_not_verified_where_vertices_coincide) {
  TaggedMesh mesh = meshes::cube();
  mesh.points[7] = mesh.points[6];
  const Model model(mesh);
  const Hulls found = model.hulls(0.02);
  if (found.outcome == Outcome::complete) {
    HullCounts counts;
    testing::expect_sandwich(mesh, Rules{}, found, 0.02, 4, "coincident", counts);
  } else {
    EXPECT_FALSE(found.problems.empty());
  }
  mesh.points = std::vector<oracle::Point>(8, {1, 2, 3});
  EXPECT_THROW(static_cast<void>(Model(mesh).hulls(0.02)), InputError);
}

TEST(hulls, end_with_their_budget) {
  const Model model(star(), loop);
  const Hulls found = model.hulls(HullOptions{.error = 1e-4}, {.max_splits = 200});
  EXPECT_EQ(found.outcome, Outcome::budget_spent);
  ASSERT_FALSE(found.problems.empty());
  EXPECT_LE(found.inner->triangles.size(), 200u);
}

TEST(hulls, stop_when_asked) {
  const Model model(star(), loop);
  const std::atomic<bool> stop = true;
  const WorkMonitor monitor{{}, &stop};
  EXPECT_THROW(static_cast<void>(hull(model.surface, {.error = 0.01}, {.monitor = &monitor})), Interrupted);
}

}  // namespace
}  // namespace snug::hull_test
