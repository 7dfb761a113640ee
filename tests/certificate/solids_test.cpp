// Proofs of inside and outside, of solids, and of scenes.
#include "certified.h"

#include <snug/scene.h>
#include <support/error.h>

#include <algorithm>
#include <sstream>

namespace snug::solids_certificate_test {
namespace {

using namespace snug::testing;
namespace meshes = oracle::meshes;

constexpr std::array schemes{Scheme::loop,    Scheme::catmark,  Scheme::doo_sabin,
                             Scheme::midedge, Scheme::bilinear, Scheme::flat};

// More often if SNUG_CERTIFICATES asks for that.
std::vector<Scheme> of_all_rounds() {
  if (fewer(2) < 2) return {Scheme::catmark};
  std::vector<Scheme> all;
  for (std::uint64_t round = number_of("SNUG_CERTIFICATES", 1); round > 0; --round)
    all.insert(all.end(), schemes.begin(), schemes.end());
  return all;
}

// A closed mesh of several sorts, that a scheme can have.
Surface closed_surface(Scheme scheme, std::size_t sort, std::mt19937_64& random) {
  oracle::TaggedMesh mesh = sort == 0   ? meshes::cube()
                            : sort == 1 ? meshes::prism(5)
                            : sort == 2 ? meshes::pyramid(7)
                                        : meshes::prism(12);
  mesh = meshes::shaken(mesh, 0.15, random);
  if (scheme == Scheme::loop || scheme == Scheme::flat) mesh = meshes::triangulated(mesh);
  ControlMesh control = control_mesh(mesh);
  if (sort % 2 == 1 && scheme != Scheme::doo_sabin && scheme != Scheme::midedge) {
    const std::span<const VertexId> face = control.face(FaceId(0u));
    for (std::size_t k = 0; k < face.size(); ++k)
      control.tags.creases.push_back(
          {face[k], face[(k + 1) % face.size()], std::array{0.7, 2.5, 10.0}[k % 3]});
  }
  return Surface(control, {.scheme = scheme});
}

// Over six schemes all sorts are drawn.
std::array<std::size_t, 2> two_sorts(std::mt19937_64& random) {
  const std::size_t first = random() % 4;
  return {first, (first + 2) % 4};
}

void add(ControlMesh& to, const ControlMesh& part, double scale, const Vector3& by) {
  const auto first = static_cast<std::uint32_t>(to.points.size());
  for (const Point3& p : part.points) to.points.push_back(Point3{scale * p.x, scale * p.y, scale * p.z} + by);
  for (std::size_t f = 0; f < part.face_count(); ++f) {
    std::vector<VertexId> face;
    for (const VertexId v : part.face(FaceId(f))) face.push_back(VertexId(first + v.value()));
    to.add_face(face);
  }
}

TEST(certificate_solids, hold_where_points_are_of_every_scheme) {
  std::mt19937_64 random(81);
  std::size_t asked = 0, insides = 0;
  int files = 0;
  for (const Scheme scheme : of_all_rounds()) {
    for (const std::size_t sort : two_sorts(random)) {
      const Surface surface = closed_surface(scheme, sort, random);
      std::vector<Point3> points;
      for (std::uint64_t i = 0; i < fewer(12); ++i)
        points.push_back({1.6 * unit(random) - 0.3, 1.6 * unit(random) - 0.3, 1.6 * unit(random) - 0.3});
      Certificate certificate;
      const auto inside = contains(surface, points, {.threads = 1, .certificate = &certificate});
      EXPECT_EQ(certificate.missing, "") << name_of(scheme) << sort;
      const Checked checked = check(certificate.text);
      ASSERT_EQ(checked.refused, "") << name_of(scheme) << sort;
      ASSERT_EQ(checked.proved.size(), points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        ++asked;
        insides += inside[i] == true ? 1 : 0;
        const bool winds = checked.proved[i].find("winding number 0") == std::string::npos;
        EXPECT_EQ(winds, inside[i] == true) << checked.proved[i];
      }
      const auto far = signed_distance(surface, points, {}, {.threads = 1, .certificate = &certificate});
      EXPECT_EQ(check(certificate.text).refused, "");
      EXPECT_EQ(certificate.missing, "");
      files += 2;
    }
  }
  RecordProperty("files", files);
  EXPECT_GE(10 * insides, asked);
}

// Shells in shells, either way round: numbers other than 0 and 1.
TEST(certificate_solids, hold_how_often_shells_wind) {
  const ControlMesh cube = control_mesh(meshes::cube());
  ControlMesh shells = cube;
  add(shells, cube, 0.5, {0.25, 0.25, 0.25});
  ControlMesh reversed = cube;
  add(reversed, cube, -0.5, {0.75, 0.75, 0.75});  // an odd number of mirrors turns the faces
  const Point3 middle{0.52, 0.47, 0.5};
  const auto sentence = [&](const ControlMesh& mesh, const Point3& p) {
    Certificate certificate;
    static_cast<void>(
        contains(Surface(mesh, {.scheme = Scheme::bilinear}), p, {.certificate = &certificate}));
    EXPECT_EQ(certificate.missing, "");
    const Checked checked = check(certificate.text);
    return checked.refused.empty() ? checked.proved[0] : checked.refused;
  };
  EXPECT_NE(sentence(shells, middle).find("winding number 2"), std::string::npos) << sentence(shells, middle);
  EXPECT_NE(sentence(reversed, middle).find("winding number 0"), std::string::npos);
  EXPECT_NE(sentence(reversed, {0.5, 0.45, 0.2}).find("winding number 1"), std::string::npos);
  ControlMesh inverted;
  add(inverted, cube, -1, {1, 1, 1});
  EXPECT_NE(sentence(inverted, middle).find("winding number -1"), std::string::npos)
      << sentence(inverted, middle);
}

TEST(certificate_solids, hold_that_pairs_are_apart_or_not) {
  std::mt19937_64 random(82);
  std::size_t apart = 0, inside = 0;
  int files = 0;
  for (const Scheme scheme : of_all_rounds()) {
    for (const std::size_t sort : two_sorts(random)) {
      const Surface a = closed_surface(scheme, sort, random);
      ControlMesh two;
      const Surface b = closed_surface(schemes[random() % schemes.size()], random() % 4, random);
      add(two, b.mesh(), 0.2, {0.4, 0.4, 0.4});
      const Surface small(two, {.scheme = b.scheme()});
      add(two, b.mesh(), 0.2, {3, 0, 0});
      const Surface both(two, {.scheme = b.scheme()});  // one of two components inside
      const std::array list{small, both, b};
      for (const Surface& other : list) {
        const PlacedSurface placed =
            &other == &list[2] ? other.at(Motion::translation({1.7, 0.2, 0.1})) : PlacedSurface(other);
        Certificate certificate;
        const Collision answer = collide(a, placed, {.tolerance = 1e-3, .solid = true},
                                         {.threads = 1, .certificate = &certificate});
        const Checked checked = check(certificate.text);
        ASSERT_EQ(checked.refused, "") << name_of(scheme) << sort;
        if (answer.verdict == Verdict::separated) {
          ++apart;
          EXPECT_EQ(certificate.missing, "");
          EXPECT_NE(checked.proved[0].find("bound solids that are as far apart"), std::string::npos);
        }
        if (answer.contained) {
          ++inside;
          EXPECT_EQ(certificate.missing, "");
          EXPECT_NE(checked.proved[0].find("bound solids that have a point in common"), std::string::npos);
        }
        const Distance far = distance(placed, a, {.solid = true},
                                      {.threads = 1, .max_splits = 2000, .certificate = &certificate});
        ASSERT_EQ(check(certificate.text).refused, "");
        if (far.distance.lower > 0 || far.contained) {
          EXPECT_EQ(certificate.missing, "");
        }
        files += 2;
      }
    }
  }
  RecordProperty("files", files);
  EXPECT_GE(apart, fewer(5));
  EXPECT_GE(inside, fewer(5));
}

// Each part of a proof is needed, and a claim that is false is refused.
TEST(certificate_solids, with_faults_are_refused) {
  const ControlMesh cube = control_mesh(meshes::cube());
  const Surface surface(cube, {.scheme = Scheme::catmark});
  Certificate certificate;
  static_cast<void>(contains(surface, {0.45, 0.52, 0.48}, {.certificate = &certificate}));
  const std::vector<std::string> whole = lines_of(certificate.text);
  ASSERT_EQ(check(text_of(whole)).refused, "");
  const auto at = [&](const std::string& begin) {
    std::size_t i = 0;
    while (!whole[i].starts_with(begin) && whole[i].find(' ' + begin) == std::string::npos) ++i;
    return i;
  };
  const auto expect_refused = [&](const char* fault, const std::vector<std::string>& lines) {
    EXPECT_NE(check(text_of(lines)).refused, "") << fault;
  };
  const std::size_t claim = at("winding") + 1, crossing = at("x ");
  for (const char* number : {"0", "2", "-1"}) {
    std::vector<std::string> lines = whole;
    lines[claim] = number + lines[claim].substr(1);
    expect_refused("another number", lines);
  }
  std::vector<std::string> lines = whole;
  lines[crossing] = lines[crossing].substr(0, lines[crossing].find('x')) + "0 0 1";
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(crossing) + 1,
              lines.begin() + static_cast<std::ptrdiff_t>(crossing) + 6);
  expect_refused("a crossing said to be none", lines);
  for (std::size_t k = 1; k <= 4; ++k) {
    lines = whole;
    std::string& border = lines[crossing + k];
    ASSERT_TRUE(border.starts_with("border"));
    border = "border 4 0 0 0";
    expect_refused("a border without a direction", lines);
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(crossing + k));
    expect_refused("a border left out", lines);
  }
  lines = whole;
  std::string& start = lines[crossing];
  for (int i = 0; i < 3; ++i) start = start.substr(0, start.rfind(' '));
  start += " 0 0 0";
  expect_refused("a piece that may hold the point", lines);
  // What holds the piece off the point does not hold its borders off the half-line, which leads to it.
  std::istringstream words(whole[crossing].substr(whole[crossing].find('x')));
  std::string word;
  std::array<long, 3> w{};
  words >> word >> word >> w[0] >> w[1] >> w[2];
  for (const long sign : {1, -1}) {
    lines = whole;
    for (std::size_t k = 1; k <= 4; ++k) {
      lines[crossing + k] = "border 4 " + std::to_string(sign * w[0]) + ' ' + std::to_string(sign * w[1]) +
                            ' ' + std::to_string(sign * w[2]);
    }
    EXPECT_NE(check(text_of(lines)).refused.find("not held off the line"), std::string::npos);
  }
  // Without a direction the half-line would be its first point, and a proof that this is off the surface one of any number.
  static_cast<void>(closest_point(surface, {0.45, 0.52, 0.48}, {}, {.certificate = &certificate}));
  lines = lines_of(certificate.text);
  const auto apart =
      std::ranges::find_if(lines, [](const std::string& line) { return line.starts_with("apart"); });
  const auto near =
      std::ranges::find_if(lines, [](const std::string& line) { return line.starts_with("near"); });
  lines.erase(near, lines.end());
  lines.emplace_back("end");
  *apart = "apart 0";
  ASSERT_EQ(check(text_of(lines)).refused, "");
  *apart = "winding 1 here 0 0 0 0";
  EXPECT_NE(check(text_of(lines)).refused.find("without a direction"), std::string::npos);
  // A face left out: what is not closed has no inside.
  lines = whole;
  lines[at("holes 0")] = "holes 1\n5";
  std::string& order = lines[at("order")];
  order.erase(order.find(" 5"), 2);
  expect_refused("a hole", lines);
}

TEST(certificate_solids, with_a_component_left_out_are_refused) {
  const ControlMesh cube = control_mesh(meshes::cube());
  ControlMesh two = cube;
  add(two, cube, 1, {3, 0, 0});
  const Surface a(two, {.scheme = Scheme::catmark}), b(cube, {.scheme = Scheme::catmark});
  Certificate certificate;
  ASSERT_EQ(collide(a, b.at(Motion::translation({1.5, 0, 0})), {.solid = true}, {.certificate = &certificate})
                .verdict,
            Verdict::separated);
  ASSERT_EQ(certificate.missing, "");
  const std::vector<std::string> whole = lines_of(certificate.text);
  ASSERT_EQ(check(text_of(whole)).refused, "");
  std::vector<std::size_t> claims;
  std::size_t end = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (whole[i].starts_with("winding")) claims.push_back(i);
    if (whole[i].starts_with("solids")) end = i;
  }
  ASSERT_EQ(claims.size(), 3U);
  claims.push_back(end);
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<std::string> lines = whole;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(claims[k]),
                lines.begin() + static_cast<std::ptrdiff_t>(claims[k + 1]));
    EXPECT_NE(check(text_of(lines)).refused.find("of all components"), std::string::npos);
  }
  // Nor are they where nothing is known of their surfaces.
  std::vector<std::string> unknown = whole;
  std::size_t apart = 0;
  while (!whole[apart].starts_with("apart")) ++apart;
  unknown.erase(unknown.begin() + static_cast<std::ptrdiff_t>(apart),
                unknown.begin() + static_cast<std::ptrdiff_t>(claims[0]));
  EXPECT_NE(check(text_of(unknown)).refused.find("of all components"), std::string::npos);
  // Solids are not apart because their surfaces are.
  std::vector<std::string> lines = whole;
  lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(claims[0]),
              lines.begin() + static_cast<std::ptrdiff_t>(end));
  EXPECT_NE(check(text_of(lines)).refused, "");
}

// A surface has an inside if as many faces run one way along each edge as the other, and none is missing.
TEST(certificate_solids, are_of_closed_surfaces_alone) {
  ControlMesh two = control_mesh(meshes::cube());  // boxes that share an edge
  two.points.insert(two.points.end(), {{2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {2, 1, 1}, {2, 2, 1}, {1, 2, 1}});
  for (const auto& face : {std::array{3u, 10u, 9u, 8u},
                           {7u, 11u, 12u, 13u},
                           {3u, 8u, 11u, 7u},
                           {8u, 9u, 12u, 11u},
                           {9u, 10u, 13u, 12u},
                           {10u, 3u, 7u, 13u}}) {
    two.add_face(std::array{VertexId(face[0]), VertexId(face[1]), VertexId(face[2]), VertexId(face[3])});
  }
  ControlMesh hole = control_mesh(meshes::cube());
  hole.tags.holes.push_back(FaceId(2u));
  struct Sort {
    const char* name;
    ControlMesh mesh;
    bool closed;
  };
  const auto plain = [](const oracle::TaggedMesh& mesh) { return control_mesh(mesh); };
  const std::vector<Sort> sorts{{"cube", plain(meshes::cube()), true},
                                {"prism", plain(meshes::prism(7)), true},
                                {"at a vertex", plain(meshes::two_cubes_at_a_vertex()), true},
                                {"at an edge", two, true},
                                {"two quads", plain(meshes::back_to_back()), true},
                                {"hole", hole, false},
                                {"strip", plain(meshes::mixed_strip()), false},
                                {"moebius", plain(meshes::moebius(5)), false},
                                {"same ways", plain(meshes::same_ways()), false},
                                {"book", plain(meshes::book(3)), false}};
  for (const Sort& sort : sorts) {
    for (const Scheme scheme : {Scheme::catmark, Scheme::bilinear, Scheme::doo_sabin}) {
      for (const BoundaryRule rule : {BoundaryRule::edge_only, BoundaryRule::none}) {
        const std::string what = std::string(sort.name) + ' ' + name_of(scheme);
        Certificate certificate;
        try {
          const Surface surface(sort.mesh, {.scheme = scheme, .boundary = rule});
          static_cast<void>(closest_point(surface, Point3{30, 200, 100}, {}, {.certificate = &certificate}));
        } catch (const InputError&) {
          continue;  // the scheme has no such surface
        }
        Lines lines = lines_of(certificate.text);
        std::size_t claim = 0;
        while (!lines[claim].starts_with("apart")) ++claim;
        std::size_t next = claim;
        while (!lines[next].starts_with("near")) ++next;
        lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(next), lines.end());
        lines.emplace_back("end");
        lines[claim] = "winding 1 here 0 30 200 100";  // away from the surface
        // Doo-Sabin's surface has no holes.
        const bool closed = sort.closed || (scheme == Scheme::doo_sabin && !sort.mesh.tags.holes.empty());
        const std::string refused = check(text_of(lines)).refused;
        EXPECT_EQ(refused.find("no closed surface") == std::string::npos, closed) << what << ": " << refused;
        if (closed) {
          EXPECT_EQ(refused, "") << what;
        }
      }
    }
  }
}

Scene grid_of(const std::vector<Surface>& surfaces, std::size_t side, double spacing, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Scene scene;
  for (std::size_t i = 0; i < side * side * side; ++i) {
    const auto at = [&](std::size_t k) {
      return spacing * static_cast<double>(k % side) + 0.1 * unit(random);
    };
    const Vector3 to{at(i), at(i / side), at(i / side / side)};
    const Motion turn = Motion::rotation({unit(random), unit(random), 0.5}, 3 * unit(random));
    scene.parts.push_back(surfaces[random() % surfaces.size()].at(turn.with_offset(to)));
  }
  return scene;
}

TEST(certificate_scenes, hold_what_is_said_of_every_pair) {
  std::mt19937_64 random(83);
  std::vector<Surface> surfaces;
  for (const Scheme scheme : schemes) surfaces.push_back(closed_surface(scheme, surfaces.size() % 4, random));
  const bool few = fewer(2) < 2;
  for (const double spacing : {1.2, 1.8}) {
    for (const bool solid : {false, true}) {
      if (few && (!solid || spacing < 1.5)) continue;
      Scene scene = grid_of(surfaces, spacing > 1.5 && !few ? 3 : 2, spacing, 84);
      scene.margins.push_back({{1, 2}, 0.05});
      Certificate certificate;
      std::size_t meetings = 0, others = 0;
      const SceneCounts counts =
          collide(scene, {.tolerance = 1e-3, .margin = 0.01, .solid = solid},
                  [&](const PairCollision& pair) {
                    ++(pair.answer.verdict == Verdict::intersecting ? meetings : others);
                  },
                  {.threads = 1, .max_splits = 1000, .certificate = &certificate});
      const Checked checked = check(certificate.text, 4'000'000);
      ASSERT_EQ(checked.refused, "") << spacing;
      EXPECT_EQ(counts.intersecting, meetings);
      // A sentence for the hulls, and one for each pair that they do not separate, or that has a margin of its own.
      EXPECT_GE(checked.proved.size(), 1 + meetings);
      EXPECT_NE(checked.proved[0].find("scene 0 of "), std::string::npos);
      if (meetings == 0) {
        EXPECT_EQ(certificate.missing, "");
      }
      static_cast<void>(distance(scene, 0.3, {.solid = solid}, [](const PairDistance&) {},
                                 {.threads = 1, .max_splits = 1000, .certificate = &certificate}));
      ASSERT_EQ(check(certificate.text, 4'000'000).refused, "") << spacing;
    }
  }
}

// Coordinates that a pose cancels leave their rounding.
TEST(certificate_solids, hold_far_from_the_origin_too) {
  std::mt19937_64 random(89);
  for (const double far : {0x1p10, 0x1p20, 0x1p27}) {
    for (std::uint64_t trial = 0; trial < fewer(4); ++trial) {
      const Surface near = closed_surface(schemes[random() % 6], random() % 4, random);
      const Vector3 away{far * unit(random), far * unit(random), far};
      ControlMesh moved;
      add(moved, closed_surface(near.scheme(), random() % 4, random).mesh(), 1, away);
      const Surface other(moved, {.scheme = near.scheme()});
      const Motion turn = Motion::rotation({unit(random), unit(random), 1}, unit(random));
      const double apart = std::array{0.2, 1.01, 1.5}[trial % 3];
      const Motion pose = turn.with_offset(Vector3{apart, 0, 0} - turn.rotate(away));
      Certificate certificate;
      static_cast<void>(collide(near, other.at(pose), {.tolerance = 1e-3, .solid = trial % 2 == 0},
                                {.threads = 1, .max_splits = 2000, .certificate = &certificate}));
      if (!certificate.text.empty()) {
        EXPECT_EQ(check(certificate.text).refused, "") << far << ' ' << trial;
      }
      static_cast<void>(distance(near, other.at(pose), {},
                                 {.threads = 1, .max_splits = 2000, .certificate = &certificate}));
      if (!certificate.text.empty()) {
        EXPECT_EQ(check(certificate.text).refused, "") << far << ' ' << trial;
      }
    }
  }
}

TEST(certificate_scenes, of_listed_pairs_hold_these) {
  std::mt19937_64 random(85);
  Scene scene = grid_of({closed_surface(Scheme::catmark, 0, random)}, 2, 2, 86);
  scene.pairs = {{{0, 1}, {5, 2}, {3, 7}}};
  Certificate certificate;
  static_cast<void>(collide(scene, {}, [](const PairCollision&) {}, {.certificate = &certificate}));
  const Checked checked = check(certificate.text);
  EXPECT_EQ(checked.refused, "");
  ASSERT_EQ(checked.proved.size(), 3U);
  EXPECT_NE(checked.proved[1].find("parts 5 and 2 have no point in common"), std::string::npos);
}

TEST(certificate_scenes, with_faults_are_refused) {
  std::mt19937_64 random(87);
  const Surface surface = closed_surface(Scheme::catmark, 0, random);
  Scene scene;  // of which the first two meet
  for (const double x : {0.0, 0.3, 3.0, 5.0, 8.0})
    scene.parts.push_back(surface.at(Motion::translation({x, 0.1 * x, 0.2})));
  Certificate certificate;
  static_cast<void>(collide(scene, {}, [](const PairCollision&) {}, {.certificate = &certificate}));
  const std::vector<std::string> whole = lines_of(certificate.text);
  ASSERT_EQ(check(text_of(whole)).refused, "");
  const auto at = [&](const std::string& begin) {
    const auto found =
        std::ranges::find_if(whole, [&](const std::string& line) { return line.starts_with(begin); });
    return static_cast<std::size_t>(found - whole.begin());
  };
  const std::size_t hulls = at("hulls"), claims = at("pair");
  ASSERT_LT(claims, whole.size());
  ASSERT_LT(hulls, claims);
  std::istringstream head(whole[hulls]);
  std::string word, margin;
  std::size_t count = 0;
  head >> word >> margin >> count;
  ASSERT_GT(count, 0U);
  const auto expect_refused = [&](const char* fault, const std::vector<std::string>& lines) {
    EXPECT_NE(check(text_of(lines)).refused, "") << fault;
  };
  std::vector<std::string> lines = whole;
  std::string pair;
  std::string rest;
  head >> pair;
  head >> word;
  std::getline(head, rest);
  lines[hulls] = "hulls " + margin + ' ' + std::to_string(count - 1) + rest;
  expect_refused("a pair that is not named", lines);
  lines = whole;
  lines[hulls] = "hulls 0x1p3" + whole[hulls].substr(whole[hulls].find(' ', 6));
  expect_refused("a margin beyond the gaps", lines);
  for (std::size_t i = hulls + 1; i < claims; ++i) {
    lines = whole;
    lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(i));
    expect_refused("a leaf left out", lines);
  }
  lines = whole;
  lines[hulls - 1] = "order 0 0 1 2 3";
  expect_refused("a part twice in the order", lines);
  // One part where another one is: all pairs are said to be apart but those that are named.
  lines = whole;
  const std::size_t first = at("placed 0");
  lines[first + 4] = whole[first];
  expect_refused("a part moved", lines);
}

}  // namespace
}  // namespace snug::solids_certificate_test
