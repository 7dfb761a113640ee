#include "certified.h"

#include <cmath>

namespace snug::answers_test {
namespace {

using namespace snug::testing;

// How many of the questions whose answer names contact were proved.
struct Tally {
  std::size_t files = 0, meetings = 0, proved_meetings = 0, lacking = 0;
};

void expect_proved(const Certificate& certificate, const std::string& name, Tally& tally, bool meeting) {
  const Checked checked = check(certificate.text);
  ASSERT_EQ(checked.refused, "") << name;
  ++tally.files;
  if (meeting) {
    ++tally.meetings;
    if (certificate.missing.empty()) ++tally.proved_meetings;
  } else if (!certificate.missing.empty()) {  // so it is of flat faces a few roundings apart
    ++tally.lacking;
  }
}

// Pairs of neighbours in the list of all surfaces: every scheme and tag is a side, and meets itself and the next one.
TEST(certificate, holds_what_answers_about_pairs_say) {
  std::mt19937_64 random(61);
  std::optional<Surface> last;
  Tally tally;
  for_each_certified_surface(61, [&](const std::string& name, const Surface& surface) {
    if (!last) last = surface;
    const double apart = std::array{0.4, 0.8, 1.1, 1.6}[random() % 4];
    const PlacedSurface a(*last), b(surface, placed_beside(*last, surface, apart, random));
    Certificate certificate;
    const Collision touch =
        collide(a, b, {.tolerance = 1e-3 * surface.size()}, {.threads = 1, .certificate = &certificate});
    ASSERT_NO_FATAL_FAILURE(expect_proved(certificate, name, tally, touch.verdict == Verdict::intersecting));
    const Distance far = distance(a, b, {}, {.threads = 1, .certificate = &certificate});
    ASSERT_NO_FATAL_FAILURE(expect_proved(certificate, name, tally, far.distance.upper == 0));
    last = surface;
  });
  RecordProperty("files", static_cast<int>(tally.files));
  RecordProperty("meetings", static_cast<int>(tally.meetings));
  RecordProperty("proved meetings", static_cast<int>(tally.proved_meetings));
  EXPECT_GE(tally.files, fewer(60));
  EXPECT_LE(50 * tally.lacking, tally.files + 49);
  if (tally.meetings >= 10) {
    EXPECT_GE(4 * tally.proved_meetings, 3 * tally.meetings);
  }
}

TEST(certificate, holds_distances_of_points_and_hits_of_rays) {
  std::mt19937_64 random(62);
  Tally tally;
  for_each_certified_surface(62, [&](const std::string& name, const Surface& surface) {
    const double size = surface.size();
    Box3 box;
    for (const Point3& p : surface.mesh().points) box.add(p);
    const auto anywhere = [&] {
      Point3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] =
            box.lower[axis] - 0.3 * size + unit(random) * (box.upper[axis] - box.lower[axis] + 0.6 * size);
      }
      return p;
    };
    const std::array points{anywhere(), anywhere()};
    Certificate certificate;
    static_cast<void>(closest_point(surface, points, {}, {.threads = 1, .certificate = &certificate}));
    ASSERT_NO_FATAL_FAILURE(expect_proved(certificate, name, tally, false));
    const Point3 from = anywhere(), to = anywhere();
    const std::array rays{Ray{from, to - from}, Ray{from, to - from, -1, 2}};
    const auto hits =
        ray(surface, rays, {.query = RayQuery::all}, {.threads = 1, .certificate = &certificate});
    const bool meeting = !hits[0].hits.empty() || !hits[1].hits.empty();
    ASSERT_NO_FATAL_FAILURE(expect_proved(certificate, name, tally, meeting));
  });
  RecordProperty("files", static_cast<int>(tally.files));
  RecordProperty("meetings", static_cast<int>(tally.meetings));
  RecordProperty("proved meetings", static_cast<int>(tally.proved_meetings));
  EXPECT_LE(50 * tally.lacking, tally.files + 49);
  if (tally.meetings >= 10) {
    EXPECT_GE(2 * tally.proved_meetings, tally.meetings);
  }
}

// What the checker prints is what was asked and answered.
TEST(certificate, says_the_numbers_of_the_answer) {
  const Surface cube(control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  Certificate certificate;
  const Distance far =
      distance(cube, cube.at(Motion::translation({5, 0.25, 0})), {}, {.certificate = &certificate});
  const Checked checked = check(certificate.text);
  ASSERT_EQ(checked.proved.size(), 1U);
  const std::string& sentence = checked.proved[0];
  const std::size_t below = sentence.find("are farther apart than "), above = sentence.find("are at most ");
  ASSERT_NE(below, std::string::npos) << sentence;
  ASSERT_NE(above, std::string::npos) << sentence;
  const double lower = std::stod(sentence.substr(below + 23)), upper = std::stod(sentence.substr(above + 12));
  EXPECT_LE(lower, far.distance.lower);
  EXPECT_GE(lower, far.distance.lower - 1e-10);
  EXPECT_GE(upper, far.distance.upper);
  EXPECT_LE(upper, far.distance.upper + 1e-10);
  EXPECT_NE(sentence.find("catmark, 8 points, 6 faces, sha256 "), std::string::npos) << sentence;
}

TEST(certificate, lacks_what_it_says_it_lacks) {
  const Surface cube(control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  Certificate certificate;
  // Coincident surfaces: no contact is proved without a tolerance.
  const Collision same =
      collide(cube, cube, {.tolerance = 0}, {.max_splits = 2000, .certificate = &certificate});
  ASSERT_EQ(same.verdict, Verdict::undecided);
  EXPECT_EQ(certificate.missing, "the verdict, which is undecided");
  EXPECT_EQ(certificate.text, "");
}

TEST(certificate, of_many_poses_has_a_question_each) {
  const Surface cube(control_mesh(oracle::meshes::cube()), {.scheme = Scheme::catmark});
  std::vector<PosePair> poses;
  for (int i = 1; i < 6; ++i) poses.push_back({{}, Motion::translation({2.0 * i, 0.1 * i, 0.3})});
  Certificate certificate;
  static_cast<void>(collide(cube, cube, poses, {}, {.certificate = &certificate}));
  const Checked checked = check(certificate.text);
  EXPECT_EQ(checked.refused, "");
  EXPECT_EQ(checked.proved.size(), poses.size());
}

// Decimals of a sentence are no bolder than the number that was proved.
TEST(certificate, says_numbers_rounded_to_the_safe_side) {
  const std::string head =
      "snug-certificate 1 surface flat edge-and-corner uniform catmark points 3 0 0 0 1 0 0 0 1 0 faces 1 3 "
      "0 1 2 "
      "creases 0 corners 0 holes 0 order 0 question point 0 0 -1 point 0 0 ";
  const auto sentence = [&](const std::string& claim) { return check(head + claim + " end").proved.at(0); };
  // Both are the doubles nearest to these decimals, which lie on the other side of them.
  EXPECT_NE(sentence("4.9 apart 4.9 0 0 1").find("farther apart than 4.9000000000000003"), std::string::npos);
  EXPECT_NE(sentence("3 near 4.35 here here").find("at most 4.3499999999999997"), std::string::npos);
}

// An edge below 1 of which both halves stay sharp, since its neighbours are sharper, is a full crease.
TEST(certificate, of_a_blunt_edge_among_sharp_ones_by_chaikin) {
  ControlMesh mesh = control_mesh(oracle::meshes::cube());
  mesh.tags.crease_method = CreaseMethod::chaikin;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const std::span<const VertexId> face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      mesh.tags.creases.push_back({face[k], face[(k + 1) % face.size()], 2});
    }
  }
  const std::array ends{mesh.face(FaceId(0u))[0], mesh.face(FaceId(0u))[1]};
  mesh.tags.creases.push_back({ends[0], ends[1], 0.8});
  const Surface surface(mesh, {.scheme = Scheme::catmark});
  const Point3 &a = mesh.points[ends[0].index()], &b = mesh.points[ends[1].index()];
  const Point3 middle = a + 0.5 * (b - a);
  Certificate certificate;
  static_cast<void>(closest_point(surface, Point3{3 * middle.x, 3 * middle.y, 3 * middle.z}, {},
                                  {.certificate = &certificate}));
  EXPECT_EQ(certificate.missing, "");
  EXPECT_EQ(check(certificate.text).refused, "");
}

// The last tag of an edge counts, on the boundary too.
TEST(certificate, of_boundary_edges_that_are_tagged_twice) {
  ControlMesh mesh = control_mesh(oracle::meshes::quad_grid(4, 4));
  for (const double sharpness : {10.0, 3.0}) {
    for (std::uint32_t v = 0; v < 4; ++v)
      mesh.tags.creases.push_back({VertexId(v), VertexId(v + 1), sharpness});
  }
  const Surface surface(mesh, {.scheme = Scheme::catmark, .boundary = BoundaryRule::none});
  Certificate certificate;
  static_cast<void>(closest_point(surface, Point3{0.3, 0.2, 5}, {}, {.certificate = &certificate}));
  EXPECT_EQ(check(certificate.text).refused, "");
}

TEST(certificate, of_faces_that_name_a_vertex_twice_is_not_written_where_none_is_the_rule) {
  ControlMesh mesh = control_mesh(oracle::meshes::cube());
  mesh.add_face(std::array{VertexId(0u), VertexId(1u), VertexId(0u), VertexId(2u)});
  Certificate certificate;
  const Surface open(mesh, {.scheme = Scheme::bilinear, .boundary = BoundaryRule::none});
  static_cast<void>(closest_point(open, Point3{5, 0, 0}, {}, {.certificate = &certificate}));
  EXPECT_EQ(certificate.text, "");
  EXPECT_NE(certificate.missing.find("names a vertex twice"), std::string::npos);
  const Surface closed(mesh, {.scheme = Scheme::bilinear});
  static_cast<void>(closest_point(closed, Point3{5, 0, 0}, {}, {.certificate = &certificate}));
  EXPECT_EQ(check(certificate.text).refused, "");
}

}  // namespace
}  // namespace snug::answers_test
