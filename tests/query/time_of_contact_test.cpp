// First times of contact against exact ones: translated polyhedra in rational arithmetic, boxes along every kind of
// motion into every kind of contact by their separating axes at many times, and known ones.

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <oracle/contact_time_twin.h>
#include <support/error.h>
#include <testing/cad_parts.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace snug::time_of_contact_test {
namespace {

using testing::random_placement;
using testing::random_vector;
using testing::unit;

Surface part(ControlMesh mesh) { return Surface(std::move(mesh), {.scheme = Scheme::flat}); }

Trajectory translated(const Vector3& by, const Motion& from = {}) {
  return Trajectory::steady(from, {by, {0, 0, 1}, 0, {}});
}

Surface box(double x, double y, double z) { return part(testing::box({-x, -y, -z}, {x, y, z}, true)); }

oracle::TriangleSoup soup(const ControlMesh& mesh) {
  oracle::TriangleSoup triangles;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    std::array<oracle::Point, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Point3& p = mesh.points[mesh.face(FaceId(f))[k].index()];
      corners[k] = {p.x, p.y, p.z};
    }
    triangles.push_back(corners);
  }
  return triangles;
}

// Whole-numbered corners, many of them in one plane or on one line with others.
ControlMesh lattice_part(std::mt19937_64& random) {
  const auto whole = [&](int most) {
    return static_cast<double>(random() % static_cast<unsigned>(most)) + 1;
  };
  switch (random() % 4) {
    case 0:
      return testing::l_prism(true);
    case 1: {
      ControlMesh mesh;
      mesh.points = {{0, 0, 0}, {whole(3), 0, 0}, {0, whole(3), 0}, {0, 0, whole(3)}};
      for (const testing::Ids& f : {testing::Ids{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}})
        testing::add_face(mesh, f);
      return mesh;
    }
    default:
      return testing::box({0, 0, 0}, {whole(3), whole(3), whole(3)}, true);
  }
}

TEST(time_of_contact, of_translated_polyhedra_holds_the_exact_one) {
  std::mt19937_64 random(1);
  int met = 0, missed = 0, proved = 0, touched = 0, reached = 0;
  for (std::uint64_t trial = 0; trial < testing::fewer(300); ++trial) {
    const Surface a = part(lattice_part(random)), b = part(lattice_part(random));
    const auto whole = [&](int most) {
      return static_cast<double>(static_cast<int>(random() % static_cast<unsigned>(2 * most + 1)) - most);
    };
    const Vector3 from{whole(7), whole(7), whole(7)};
    const Vector3 by =
        random() % 2 ? Vector3{-2 * from.x, -2 * from.y, -2 * from.z} : Vector3{whole(9), whole(9), whole(9)};
    oracle::TriangleSoup moving = soup(b.mesh());
    for (auto& t : moving) {
      for (auto& p : t) {
        for (std::size_t x = 0; x < 3; ++x) p[x] += from[x];
      }
    }
    const std::optional<mpq_class> first = oracle::first_contact(soup(a.mesh()), moving, {by.x, by.y, by.z});
    const double tolerance = random() % 4 == 0 ? 0 : 1e-3;
    const TimeOfContact found =
        time_of_contact(a, Motion(), b, translated(by, Motion::translation(from)), {.tolerance = tolerance});
    const std::string what = "trial " + std::to_string(trial);
    if (!first) {
      ++missed;
      EXPECT_NE(found.verdict, Verdict::intersecting) << what;
      continue;
    }
    ++met;
    EXPECT_NE(found.verdict, Verdict::separated) << what << " at " << first->get_d();
    EXPECT_LE(mpq_class(found.time.lower), *first) << what;
    if (found.verdict == Verdict::intersecting) {
      EXPECT_GE(mpq_class(found.time.upper), *first) << what;
    }
    touched += *first == 0;
    proved += found.verdict == Verdict::intersecting;
    reached += (found.outcome == Outcome::complete);
  }
  std::cout << "  " << met << " meet, " << touched << " at once, " << proved << " proved, " << reached
            << " told to the tolerance; " << missed << " miss\n";
  EXPECT_GT(met, testing::fewer(100));
  EXPECT_GT(missed, testing::fewer(50));
}

void add_box(ControlMesh& mesh, const Point3& low, const Point3& high) {
  const ControlMesh box = testing::box(low, high, true);
  const auto first = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), box.points.begin(), box.points.end());
  for (std::size_t f = 0; f < box.face_count(); ++f) {
    const auto face = box.face(FaceId(f));
    testing::add_face(mesh, {first + face[0].value(), first + face[1].value(), first + face[2].value()});
  }
}

// A small part flies along a plate, as far from it all the time, and into thin fins.
TEST(time_of_contact, thin_fins_are_not_jumped_over) {
  std::mt19937_64 random(8);
  int met = 0;
  for (std::uint64_t trial = 0; trial < testing::fewer(100); ++trial) {
    ControlMesh comb;
    add_box(comb, {-1, -2, -2}, {10, 2, -1});
    for (int fins = 1 + static_cast<int>(random() % 3); fins > 0; --fins) {
      const double x = 1 + 8 * unit(random);
      add_box(comb, {x, -1, -0.5}, {x + std::exp2(-12 * unit(random)), 1, 2 * unit(random) - 0.4});
    }
    const Surface a = part(comb), b = box(0.05, 0.05, 0.05);
    const Vector3 from{-0.5, 0, -0.6 + 1.5 * unit(random)}, by{10, 0.5 * unit(random), 0};
    oracle::TriangleSoup moving = soup(b.mesh());
    for (auto& t : moving) {
      for (auto& p : t) {
        for (std::size_t k = 0; k < 3; ++k) p[k] += from[k];  // rounds by less than what is allowed for below
      }
    }
    const std::optional<mpq_class> first = oracle::first_contact(soup(a.mesh()), moving, {by.x, by.y, by.z});
    const TimeOfContact found =
        time_of_contact(a, Motion(), b, translated(by, Motion::translation(from)), {.tolerance = 1e-5});
    if (!first) continue;
    ++met;
    ASSERT_NE(found.verdict, Verdict::separated) << trial << " at " << first->get_d();
    ASSERT_LE(found.time.lower, first->get_d() + 1e-14) << trial;
    EXPECT_LE(found.time.upper, first->get_d() + 1e-4) << trial;
  }
  EXPECT_GT(met, testing::fewer(40));
}

// The first time at which boxes penetrate by more than `depth`, by samples and halving; nothing if none is seen.
std::optional<double> first_overlap(const std::function<long double(double)>& apart, double end,
                                    double depth) {
  constexpr int samples = 400;
  double before = 0;
  for (int i = 0; i <= samples; ++i) {
    const double t = end * i / samples;
    if (apart(t) > -depth) {
      before = t;
      continue;
    }
    double after = t;
    for (int k = 0; k < 50 && i > 0; ++k) {
      const double middle = before + (after - before) / 2;
      (apart(middle) > -depth ? before : after) = middle;
    }
    return after;
  }
  return std::nullopt;
}

struct Checked {
  int intersecting = 0, within = 0, separated = 0, undecided = 0, wide = 0;
  std::vector<int> looks;
};

// Boxes with these halves along two motions: is what was found true at every sample?
void check_boxes(const std::array<oracle::Point, 2>& half, const Trajectory& motion_a,
                 const Trajectory& motion_b, const std::string& what, Checked& checked) {
  const Surface a = box(half[0][0], half[0][1], half[0][2]), b = box(half[1][0], half[1][1], half[1][2]);
  const double tolerance = 1e-3;
  const TimeOfContact found =
      time_of_contact(a, motion_a, b, motion_b, {.tolerance = tolerance, .solid = true});
  const auto apart = [&](double t) {
    return oracle::separation(half[0], motion_a.at(t).numbers(), half[1], motion_b.at(t).numbers());
  };
  const double end = std::max(motion_a.duration(), motion_b.duration());
  const std::optional<double> certain = first_overlap(apart, end, 1e-12);
  checked.looks.push_back(found.steps);
  if (certain) {
    ASSERT_NE(found.verdict, Verdict::separated) << what << ": overlap at " << *certain;
    ASSERT_LE(found.time.lower, *certain) << what;
  }
  switch (found.verdict) {
    case Verdict::separated:
      ++checked.separated;
      EXPECT_EQ(found.time.lower, end);
      break;
    case Verdict::within:
      ++checked.within;
      // Of the axes none tells more than the distance.
      EXPECT_LE(apart(found.time.upper), tolerance * (1 + 1e-9)) << what;
      break;
    case Verdict::intersecting: {
      ++checked.intersecting;
      const std::optional<double> touch = first_overlap(apart, end, -1e-12);
      ASSERT_TRUE(touch) << what;
      EXPECT_GE(found.time.upper, *touch - 1e-12) << what;
      break;
    }
    case Verdict::undecided:
      ++checked.undecided;
      break;
  }
  checked.wide += found.outcome != Outcome::complete;
  if (certain) {
    const std::optional<double> deep = first_overlap(apart, end, 20 * tolerance);
    if (deep) {
      EXPECT_NE(found.verdict, Verdict::undecided) << what;
      EXPECT_EQ(found.outcome, Outcome::complete) << what;
    }
  }
}

// B as it touches the unit box A at x = 1, halves 0.5, 0.6, 0.7.
struct Contact {
  std::string name;
  Motion pose;
};
constexpr oracle::Point half_a{1, 1, 1}, half_b{0.5, 0.6, 0.7};

// The rotated box B moved along x until it touches the plane x = 1, or A's edge or corner beside it.
Contact touching(const std::string& name, const Motion& turn, double y, double z) {
  Contact contact{name, turn};
  double near = 0, far = 4;
  for (int k = 0; k < 60; ++k) {
    const double x = near + (far - near) / 2;
    const Motion pose = turn.with_offset({x, y, z});
    const bool apart = oracle::separation(half_a, Motion().numbers(), half_b, pose.numbers()) > 0;
    (apart ? far : near) = x;
  }
  contact.pose = turn.with_offset({far, y, z});
  return contact;
}

std::vector<Contact> contacts() {
  const Motion tilted = Motion::rotation({0.3, 1, 0.2}, 0.6) * Motion::rotation({0.1, 0.2, 1}, 0.7);
  const Motion edge = Motion::rotation_degrees({0, 0, 1}, 45);
  const Motion across = Motion::rotation({1, 0, 0}, 0.5) * edge;
  return {
      touching("vertex, face", tilted, 0.1, 0.2),
      touching("face, vertex", Motion::rotation({0, 0, 1}, 0.2) * Motion::rotation({0, 1, 0}, 0.1), 1.4, 1.5),
      touching("edge, edge", Motion::rotation({1, 0, 0}, 0.5) * Motion::rotation_degrees({0, 1, 0}, 45), 1.2,
               0.1),
      touching("edge, face", edge, 0.1, 0.2),
      touching("crossed edge, face", across, 0.3, 0),
      touching("face, face", {}, 0.1, 0.2),
      touching("face, face beside", {}, 1.6, 0),
      touching("face, whole face", {}, 0, 0),
      touching("vertex, vertex", tilted, 1.6, 1.6),
      touching("grazing edge", edge, 1.845, 0.2)};
}

// Motions of B that are at the pose at time 0.6 of each piece, more or less.
struct Kind {
  std::string name;
  std::function<Trajectory(const Motion&)> through;
};

Trajectory steady_to(const Motion& pose, const Vector3& velocity, const Vector3& axis, double radians,
                     const Point3& about_then) {
  const double s = 0.6;
  const Motion back = Motion::rotation(axis, -s * radians);
  const Point3 about = about_then - s * velocity;
  const Vector3 t = back.rotate(Point3{} + pose.offset() - about_then) + (about - Point3{});
  const Motion from = (back * pose.with_offset({})).with_offset(t);
  return Trajectory::steady(from, {velocity, axis, radians, about});
}

std::vector<Kind> kinds() {
  const auto screw_of = [](const Trajectory& steady) {
    return Trajectory::screw(steady.at(0), steady.at(1));
  };
  return {{"translation",
           [](const Motion& c) {
             return steady_to(c, {-2, 0.3, 0.2}, {0, 0, 1}, 0, {});
           }},
          {"straight on",
           [](const Motion& c) {
             return steady_to(c, {-2, 0, 0}, {0, 0, 1}, 0, {});
           }},
          {"slow at the end",
           [](const Motion& c) {
             return steady_to(c, {-0.02, 1, 0}, {0, 0, 1}, 0, {});
           }},
          {"along",
           [](const Motion& c) {
             return steady_to(c, {0, 1.5, 0.4}, {0, 0, 1}, 0, {});
           }},
          {"away",
           [](const Motion& c) {
             return steady_to(c, {1, 0.5, 0}, {0, 0, 1}, 0, {});
           }},
          {"turn about a point beside",
           [](const Motion& c) {
             return steady_to(c, {}, {0.1, 0.2, 1}, 1.2, {1, -3, 0});
           }},
          {"turn the other way",
           [](const Motion& c) {
             return steady_to(c, {}, {0.1, 0.2, 1}, -1.2, {1, -3, 0});
           }},
          {"turn about its middle, moving",
           [](const Motion& c) {
             return steady_to(c, {-1, 0, 0}, {1, 1, 1}, 2.5, Point3{} + c.offset());
           }},
          {"many turns",
           [](const Motion& c) {
             return steady_to(c, {-1, 0.1, 0}, {0, 1, 1}, 20, Point3{} + c.offset());
           }},
          {"tiny turn",
           [](const Motion& c) {
             return steady_to(c, {-1, 0, 0}, {0, 1, 1}, 1e-9, {1, 1, 1});
           }},
          {"screw",
           [=](const Motion& c) {
             return screw_of(steady_to(c, {-1, 0.3, 0}, {1, 0.2, 0}, 1.5, Point3{} + c.offset()));
           }},
          {"screw of 179.999 degrees",
           [=](const Motion& c) {
             return screw_of(steady_to(c, {-1, 0, 0}, {1, 0, 0.1}, 179.999 * std::numbers::pi / 180,
                                       Point3{} + c.offset()));
           }},
          {"path that ends a piece there",
           [](const Motion& c) {
             return Trajectory::through(std::vector<Motion>{
                 Motion::rotation({0, 0, 1}, 0.5) * c.with_offset(c.offset() + Vector3{1.5, 0, 0}), c,
                 c.with_offset(c.offset() + Vector3{-0.5, 0.1, 0})});
           }},
          {"path that ends there",
           [](const Motion& c) {
             return Trajectory::through(std::vector<Motion>{c.with_offset(c.offset() + Vector3{2, 1, 0}),
                                                            c.with_offset(c.offset() + Vector3{1, 0, 0}), c});
           }},
          {"begins there",
           [](const Motion& c) {
             return translated({-0.5, 0, 0}, c);
           }},
          {"begins inside",
           [](const Motion& c) {
             return translated({-0.5, 0, 0}, c.with_offset(c.offset() - Vector3{0.3, 0, 0}));
           }},
          {"no motion", [](const Motion& c) { return translated({}, c); }}};
}

TEST(time_of_contact, is_true_for_every_motion_into_every_contact) {
  Checked checked;
  for (const Contact& contact : contacts()) {
    for (const Kind& kind : kinds()) {
      const std::string what = kind.name + " to " + contact.name;
      check_boxes({half_a, half_b}, Motion(), kind.through(contact.pose), what, checked);
      if (::testing::Test::HasFatalFailure()) return;
    }
  }
  std::sort(checked.looks.begin(), checked.looks.end());
  std::cout << "  " << checked.intersecting << " intersecting, " << checked.within << " within, "
            << checked.separated << " separated, " << checked.undecided << " undecided; " << checked.wide
            << " not told to the tolerance; looks " << checked.looks[checked.looks.size() / 2]
            << " in the median, " << checked.looks.back() << " at most\n";
}

TEST(time_of_contact, is_true_where_both_move) {
  Checked checked;
  std::mt19937_64 random(3);
  const std::vector<Contact> all = contacts();
  for (const Kind& kind : kinds()) {
    const Contact& contact = all[random() % all.size()];
    const Trajectory of_b = kind.through(contact.pose);
    if (of_b.duration() != 1) continue;
    const Trajectory of_a = Trajectory::steady(
        {}, {random_vector(random, 0.5), random_vector(random, 1), unit(random), {0.1, 0.2, 0}});
    check_boxes({half_a, half_b}, of_a, of_b, kind.name + " to " + contact.name + ", both", checked);
  }
  // Both translate: towards each other, side by side, one after the other.
  for (int trial = 0; trial < 60; ++trial) {
    const Vector3 start = random_vector(random, 3), of_both = random_vector(random, 2);
    const Trajectory of_a = translated(of_both + random_vector(random, 1)),
                     of_b =
                         translated(of_both - (trial % 2 ? 1.0 : 0.2) * start,
                                    random_placement(random, start + Vector3{trial % 3 ? 0.0 : 2.5, 0, 0}));
    check_boxes({half_a, half_b}, of_a, of_b, "translations, trial " + std::to_string(trial), checked);
    if (::testing::Test::HasFatalFailure()) return;
  }
  for (int trial = 0; trial < 60; ++trial) {
    const auto any = [&] {
      return Trajectory::screw(random_placement(random, random_vector(random, 2)),
                               random_placement(random, random_vector(random, 2)));
    };
    check_boxes({half_a, half_b}, any(), any(), "screws, trial " + std::to_string(trial), checked);
  }
  std::cout << "  " << checked.intersecting << " intersecting, " << checked.within << " within, "
            << checked.separated << " separated, " << checked.undecided << " undecided\n";
}

TEST(time_of_contact, of_a_rotated_box_is_the_known_one) {
  // The corner (1, 1) of a box, turned about z, comes to x = 1.2 when sqrt(2) cos(pi / 4 - angle) does.
  const Surface a = box(1, 1, 1), wall = part(testing::box({1.2, -9, -9}, {2, 9, 9}, true));
  const double radians = 1.5;
  const double exact = (std::numbers::pi / 4 - std::acos(1.2 / std::numbers::sqrt2)) / radians;
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const TimeOfContact found = time_of_contact(
        wall, Motion(), a, Trajectory::steady({}, {{}, {0, 0, 2}, radians, {}}), {.tolerance = tolerance});
    EXPECT_EQ(found.verdict, Verdict::intersecting);
    EXPECT_LE(found.time.lower, exact + 1e-15);
    EXPECT_GE(found.time.upper, exact - 1e-15);
    EXPECT_LE(found.time.upper - found.time.lower, tolerance);
    EXPECT_EQ(found.outcome, Outcome::complete);
    ASSERT_TRUE(found.witness);
    EXPECT_NEAR((*found.witness)[0].point.x, 1.2, 2 * tolerance);
  }
}

TEST(time_of_contact, that_touches_at_the_end_alone_is_not_called_separated) {
  const Surface a = box(1, 1, 1), b = box(0.5, 0.5, 0.5);
  const TimeOfContact touching = time_of_contact(
      a, Motion(), b, translated({-1, 0, 0}, Motion::translation({2.5, 0, 0})), {.tolerance = 1e-6});
  EXPECT_NE(touching.verdict, Verdict::separated);
  EXPECT_LE(touching.time.lower, 1);
  EXPECT_LE(touching.time.upper, 1);
  const TimeOfContact short_of_it = time_of_contact(
      a, Motion(), b, translated({-1, 0, 0}, Motion::translation({2.5 + 1e-9, 0, 0})), {.tolerance = 1e-10});
  EXPECT_EQ(short_of_it.verdict, Verdict::separated);
}

TEST(time_of_contact, of_thousands_of_poses_is_found_at_the_end_of_the_path) {
  const Surface a = box(1, 1, 1), b = box(0.5, 0.5, 0.5);
  const auto path = [](double from, double to) {
    std::vector<Motion> poses;
    for (int i = 0; i <= 2500; ++i)
      poses.push_back(Motion::translation({from + (to - from) * i / 2500, 0, 0}));
    return Trajectory::through(poses);
  };
  const TimeOfContact meet = time_of_contact(a, Motion(), b, path(3.5, 1.4), {.tolerance = 1e-4});
  EXPECT_NE(meet.verdict, Verdict::undecided);
  EXPECT_NEAR(meet.time.lower, 2500 / 2.1 * 2, 1);
  EXPECT_EQ(time_of_contact(a, Motion(), b, path(1.6, 3)).verdict, Verdict::separated);
}

// On a path of short pieces the time at which they are near enough may lie in another piece than the end of the search.
TEST(time_of_contact, comes_with_points_of_the_time_that_it_names) {
  std::mt19937_64 random(6);
  const Surface a = box(1, 1, 1), b = box(1, 1, 1);
  int within = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const std::size_t count = 10 + random() % 200;
    const double way = 0.1 + 0.4 * unit(random);
    std::vector<Motion> poses;
    for (std::size_t i = 0; i <= count; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(count);
      poses.push_back(Motion::rotation({1, 1, 0}, 0.3 * s).with_offset({2.4 - way * s, 0.1 * s, 0.05}));
    }
    const Trajectory motion = Trajectory::through(poses);
    const double tolerance = std::pow(10, -4 + 2.5 * unit(random));
    const TimeOfContact found =
        time_of_contact(a, Motion(), b, motion, {.tolerance = tolerance, .prove_contact = trial % 2 == 0});
    if (found.verdict != Verdict::within) continue;
    ++within;
    ASSERT_TRUE(found.witness);
    const Motion back = motion.at(found.time.upper).inverse();
    const std::string what = "trial " + std::to_string(trial);
    EXPECT_NEAR(max_abs((*found.witness)[0].point - Point3{}), 1, 1e-12) << what;
    EXPECT_NEAR(max_abs(back.apply((*found.witness)[1].point) - Point3{}), 1, 1e-12) << what;
    EXPECT_LE(distance((*found.witness)[0].point, (*found.witness)[1].point), tolerance * (1 + 1e-12))
        << what;
  }
  EXPECT_GT(within, 20);
}

TEST(time_of_contact, of_solids_counts_what_is_inside) {
  const Surface a = box(1, 1, 1), b = box(0.2, 0.2, 0.2);
  const Trajectory inside = translated({0.5, 0, 0}), out = translated({2, 0, 0});
  EXPECT_EQ(time_of_contact(a, Motion(), b, inside).verdict, Verdict::separated);
  const TimeOfContact solids = time_of_contact(a, Motion(), b, inside, {.solid = true});
  EXPECT_EQ(solids.verdict, Verdict::intersecting);
  EXPECT_EQ(solids.time.upper, 0);
  EXPECT_EQ(solids.contained, 1u);
  // Along the wall inside, a rounding away from it: a point inside proves nothing of these surfaces.
  const Trajectory along = translated({0, 0.5, 0}, Motion::translation({std::nextafter(0.8, 0.0), 0, 0}));
  EXPECT_NE(time_of_contact(a, Motion(), b, along).verdict, Verdict::intersecting);
  // From inside to the wall, face on face.
  const TimeOfContact wall = time_of_contact(a, Motion(), b, out, {.tolerance = 1e-4});
  EXPECT_LE(wall.time.lower, 0.4);
  EXPECT_GE(wall.time.upper, 0.4 - 1e-4);
  EXPECT_LE(wall.time.upper, 0.4 + 1e-3);
}

TEST(time_of_contact, says_what_it_cannot_do) {
  const Surface a = box(1, 1, 1), b = box(1, 1, 1);
  const Trajectory path = Trajectory::through(
      std::vector<Motion>{Motion(), Motion::translation({1, 0, 0}), Motion::translation({2, 0, 0})});
  EXPECT_THROW(static_cast<void>(time_of_contact(a, path, b, translated({1, 0, 0}))), InputError);
  EXPECT_THROW(static_cast<void>(time_of_contact(a, Motion(), b, path, {.tolerance = -1})), InputError);
  const Trajectory far = translated({-4, 0, 0}, Motion::translation({5, 0.1, 0.1}));
  const TimeOfContact stopped =
      time_of_contact(a, Motion(), b, far, {.tolerance = 1e-6}, {.max_splits = 3000});
  EXPECT_EQ(stopped.verdict, Verdict::undecided);
  EXPECT_LE(stopped.time.lower, 0.75);
  EXPECT_EQ(stopped.outcome, Outcome::budget_spent);
}

TEST(time_of_contact, of_every_scheme_is_not_later_than_collisions_at_samples) {
  std::mt19937_64 random(5);
  int met = 0;
  testing::for_each_surface(7, [&](const testing::NamedSurface& named) {
    std::size_t patches = 0;
    testing::for_each_patch(named.surface, [&](PatchId) { ++patches; });
    if (patches == 0 || patches > 400) return;
    const Surface surface = testing::public_surface(named.surface.mesh(), named.surface.options());
    const double size = named.surface.size();
    const Motion from = random_placement(random, random_vector(random, 2 * size)),
                 to = random_placement(random, random_vector(random, size));
    const Trajectory motion = Trajectory::screw(from, to);
    const TimeOfContact found = time_of_contact(surface, Motion(), surface, motion);
    for (int i = 0; i <= 60; ++i) {
      const double t = i / 60.0;
      const Collision at = collide(surface, surface.at(motion.at(t)), {.tolerance = 0, .prove_contact = true},
                                   {.max_splits = 20'000});
      if (at.verdict != Verdict::intersecting) continue;
      ++met;
      EXPECT_LE(found.time.lower, t) << named.name;
      EXPECT_NE(found.verdict, Verdict::separated) << named.name;
      break;
    }
  });
  EXPECT_GT(met, testing::fewer(10));
}

}  // namespace
}  // namespace snug::time_of_contact_test
