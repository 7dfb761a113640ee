#include <snug/snug.h>

#include <atomic>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>

#include <gtest/gtest.h>
#include <testing/places.h>

#include <testing/files.h>

namespace snug::queries_test {
namespace {

std::string model(const char* name) { return testing::models_dir() + "/" + name; }

std::vector<PosePair> some_poses(double size) {
  std::vector<PosePair> poses;
  for (int i = 0; i < 40; ++i) {
    const Motion turned = Motion::rotation({1, 0.5 * i, 2}, 0.3 * i);
    poses.push_back({turned, turned.with_offset({0.05 * i * size, 0.02 * i * size, 0})});
  }
  return poses;
}

TEST(handles, answer_with_the_same_bits_alone_and_among_others) {
  const Surface a = load(model("pawn.obj")), b = load(model("star.obj"));
  const Surface again_a = load(model("pawn.obj")), again_b = load(model("star.obj"));
  Workspace own;
  const std::vector<PosePair> poses = some_poses(a.size());
  const std::vector<Collision> collisions = collide(a, b, poses);
  const std::vector<Distance> distances = distance(a, b, poses, {.absolute = {}, .relative = 1e-3});
  bool apart = false, meet = false;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Collision expected =
        collide(again_a.at(poses[i].a), again_b.at(poses[i].b), {}, {.workspace = &own});
    const Collision one = collide(a.at(poses[i].a), b.at(poses[i].b));
    for (const Collision& found : {one, collisions[i]}) {
      EXPECT_EQ(found.verdict, expected.verdict) << i;
      EXPECT_EQ(found.distance, expected.distance) << i;
      EXPECT_EQ(found.witness, expected.witness) << i;
    }
    const Distance gap = distance(a.at(poses[i].a), b.at(poses[i].b), {.absolute = {}, .relative = 1e-3});
    EXPECT_EQ(gap.distance, distance(again_a.at(poses[i].a), again_b.at(poses[i].b),
                                     {.absolute = {}, .relative = 1e-3}, {.workspace = &own})
                                .distance);
    EXPECT_EQ(gap.distance, distances[i].distance) << i;
    apart = apart || expected.verdict == Verdict::separated;
    meet = meet || expected.verdict == Verdict::within || expected.verdict == Verdict::intersecting;
  }
  EXPECT_TRUE(apart && meet);
  const Point3 q{1, 2, 3};
  EXPECT_EQ(closest_point(a, q).distance, closest_point(again_a, q, {}, {.workspace = &own}).distance);
  EXPECT_EQ(closest_point(a, std::vector{q})[0].point, closest_point(a, q).point);
}

TEST(handles, reach_their_default_precision) {
  const Surface a = load(model("pawn.obj")), b = load(model("star.obj"));
  const double size = std::max(a.size(), b.size());
  const Motion beside = Motion::translation({2 * size, 0, 0});
  const Distance gap = distance(a, b.at(beside));
  EXPECT_EQ(gap.outcome, Outcome::complete);
  EXPECT_LE(gap.distance.upper - gap.distance.lower, 1e-4 * size);
  const Collision hit = collide(a, b.at(beside));
  EXPECT_EQ(hit.verdict, Verdict::separated);
  EXPECT_GE(hit.distance.lower, gap.distance.upper / 2);
  const Collision measured = collide(a, b.at(beside), {.measure = true});
  EXPECT_GE(measured.distance.lower, measured.distance.upper / 2);
  const PlacedSurface inside = b.at(Motion::translation({0.01 * size, 0, 0}));
  EXPECT_EQ(collide(a, inside).verdict, Verdict::within);
  EXPECT_EQ(collide(a, inside, {.prove_contact = true}).verdict, Verdict::intersecting);
  EXPECT_EQ(collide(a, a, {.prove_contact = true}).verdict, Verdict::within);  // nothing crosses itself
}

TEST(handles, take_scheme_and_boundary_from_the_file_unless_told) {
  EXPECT_EQ(load(model("star.obj")).scheme(), Scheme::loop);
  EXPECT_EQ(load(model("bracket.obj")).scheme(), Scheme::catmark);
  EXPECT_EQ(load(model("star.obj"), {.scheme = Scheme::flat}).scheme(), Scheme::flat);
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("edge_only.obj");
  std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt interpolateboundary 1/0/0 1\n";
  EXPECT_EQ(load(path).boundary(), read_mesh(path).tags.boundary.value_or(BoundaryRule::edge_and_corner));
  EXPECT_EQ(load(path, {.scheme = {}, .boundary = BoundaryRule::edge_and_corner}).boundary(),
            BoundaryRule::edge_and_corner);
}

TEST(handles, refuse_in_a_line_that_names_the_file) {
  const testing::TemporaryFolder folder;
  const std::string path = folder.file("empty.obj");
  std::ofstream(path) << "v 0 0 0\n";
  try {
    static_cast<void>(load(path));
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
  const Surface a = load(model("star.obj"));
  EXPECT_THROW(static_cast<void>(collide(a, a, {.tolerance = -1})), InputError);
  EXPECT_THROW(static_cast<void>(distance(a, a, {.absolute = -1})), InputError);
  EXPECT_THROW(static_cast<void>(closest_point(a, {std::numeric_limits<double>::quiet_NaN(), 0, 0})),
               InputError);
  EXPECT_THROW(static_cast<void>(normal_at(a, {1'000'000, 0, 0, 0})), InputError);
  EXPECT_THROW(static_cast<void>(evaluate(a, {1'000'000, 0, 0, 0})), InputError);
}

TEST(handles, know_inside_from_outside) {
  const Surface ball = load(model("star.obj"));
  const Point3 middle = {0, 0, 0};
  const std::optional<bool> inside = contains(ball, middle);
  const SignedDistance signed_one = signed_distance(ball, middle);
  ASSERT_TRUE(inside.has_value());
  EXPECT_EQ(*inside, signed_one.distance.upper < 0);
  EXPECT_EQ(signed_distance(ball, std::vector{middle})[0].distance, signed_one.distance);
  EXPECT_EQ(contains(ball, {1e3, 0, 0}), false);
  const std::vector<Point3> several{middle, {1e3, 0, 0}, {0, 1e-3, 0}};
  for (const int threads : {1, 2}) {
    const std::vector<std::optional<bool>> answers = contains(ball, several, {.threads = threads});
    ASSERT_EQ(answers.size(), several.size());
    for (std::size_t i = 0; i < several.size(); ++i) EXPECT_EQ(answers[i], contains(ball, several[i]));
  }
  const Penetration deep = penetration(ball, ball.at(Motion::translation({0.01 * ball.size(), 0, 0})));
  EXPECT_GT(deep.depth.upper, 0);
  EXPECT_EQ(collide(ball,
                    ball.at(Motion::translation(
                        {0.01 * ball.size() + deep.translation.x, deep.translation.y, deep.translation.z})),
                    {.tolerance = 0.0})
                .verdict,
            Verdict::separated);
}

TEST(handles, evaluate_refine_and_measure) {
  const Surface a = load(model("star.obj"));
  const Place at{3, 0, 0.25, 0.5};
  const SurfacePoint point = evaluate(a, at);
  EXPECT_EQ(evaluate(a, std::vector{at, at})[1].point, point.point);
  std::array<float, 6> positions{}, normals{};
  const double error = evaluate(a, std::vector{at, at}, {positions, normals});
  for (std::size_t x = 0; x < 3; ++x) {
    EXPECT_NEAR(positions[3 + x], point.point[x], error);
    EXPECT_NEAR(normals[3 + x], point.normal.value()[x], 0x1p-24);
  }
  EXPECT_LE(closest_point(a, point.point, {.absolute = 1e-9}).distance.lower, point.error * 2);
  const std::optional<SurfaceNormal> normal =
      normal_at(a.at(Motion::rotation({0, 0, 1}, std::numbers::pi / 2)), at);
  ASSERT_TRUE(normal && point.normal);
  EXPECT_NEAR(normal->direction.x, -point.normal->y, 1e-12);
  EXPECT_EQ(subdivided(a.mesh(), 2).face_count(), 16 * a.mesh().face_count());
  EXPECT_EQ(subdivided(a.mesh(), 1, false, {.scheme = Scheme::midedge}).face_count(),
            3 * a.mesh().face_count() + 2);  // one for each face, edge and vertex, by Euler's formula
  EXPECT_GT(limit_to_faces(a).value(), 0);
  EXPECT_EQ(limit_to_faces(load(model("star.obj"), {.scheme = Scheme::flat})).value_or(1) < 1e-10, true);
}

TEST(handles, say_where_they_have_a_surface) {
  const auto count_places = [](const Surface& surface) {
    std::size_t places = 0;
    for (std::uint32_t owner = 0; owner < surface.owner_count(); ++owner) {
      for (std::uint32_t corner = 0; corner < surface.corner_count(owner); ++corner) {
        places += surface.has({owner, corner, 0.25, 0.25}) ? 1u : 0u;
      }
      EXPECT_FALSE(surface.has({owner, static_cast<std::uint32_t>(surface.corner_count(owner)), 0.25, 0.25}));
      EXPECT_FALSE(surface.has({owner, 0, 0.25, std::numeric_limits<double>::quiet_NaN()}));
    }
    EXPECT_FALSE(surface.has({static_cast<std::uint32_t>(surface.owner_count()), 0, 0.25, 0.25}));
    EXPECT_THROW(static_cast<void>(surface.corner_count(static_cast<std::uint32_t>(surface.owner_count()))),
                 InputError);
    return places;
  };
  // A pentagon, beside it a quad.
  ControlMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.5, 2, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0}};
  mesh.add_face(std::array{VertexId(0), VertexId(1), VertexId(2), VertexId(3), VertexId(4)});
  mesh.add_face(std::array{VertexId(1), VertexId(5), VertexId(6), VertexId(2)});
  EXPECT_EQ(count_places(Surface(mesh)), 6u);
  mesh.tags.holes = {FaceId(0)};
  EXPECT_EQ(count_places(Surface(mesh)), 1u);
  const Surface pawn = load(model("pawn.obj"), {.scheme = Scheme::loop});
  EXPECT_EQ(count_places(pawn), pawn.mesh().face_count());
  EXPECT_EQ(load(model("pawn.obj"), {.scheme = Scheme::doo_sabin}).owner_count(), pawn.mesh().vertex_count());
}

TEST(handles, say_whether_they_are_closed) {
  EXPECT_EQ(load(model("pawn.obj")).open_reason(), std::nullopt);
  ControlMesh open = load(model("pawn.obj")).mesh();
  open.tags.holes.emplace_back(0);
  EXPECT_NE(Surface(open).open_reason().value_or("").find("face 0"), std::string::npos);
}

TEST(handles, are_prepared_once) {
  const Surface a = load(model("pawn.obj"));
  const std::size_t before = a.bytes();
  a.prepare();
  EXPECT_GT(a.bytes(), before);
  std::atomic<bool> stop{true};
  const Surface b = load(model("pawn.obj"));
  const WorkMonitor monitor{.on_progress = {}, .stop = &stop};
  EXPECT_THROW(b.prepare({.monitor = &monitor}), Interrupted);
  EXPECT_EQ(collide(a, b).verdict, Verdict::within);  // prepared after all
  ControlMesh triangle;
  triangle.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  triangle.add_face(std::array{VertexId(0), VertexId(1), VertexId(2)});
  EXPECT_THROW(Surface(triangle, {.boundary = BoundaryRule::none}).prepare(), InputError);
}

TEST(schemes, are_found_by_each_of_their_names) {
  for (const Scheme scheme : all_schemes) {
    const SchemeTraits& traits = traits_of(scheme);
    EXPECT_EQ(scheme_named(traits.name), scheme);
    EXPECT_EQ(std::string(traits.name), name_of(scheme));
    for (const char* other : traits.other_names) EXPECT_EQ(scheme_named(other), scheme) << other;
    EXPECT_EQ(traits.dual, scheme == Scheme::doo_sabin || scheme == Scheme::midedge);
    EXPECT_EQ(traits.triangular, scheme == Scheme::loop || scheme == Scheme::flat);
  }
  EXPECT_EQ(scheme_named("auto"), std::nullopt);
}

}  // namespace
}  // namespace snug::queries_test
