#pragma once

#include <snug/time_of_contact.h>

#include <gtest/gtest.h>
#include <oracle/dual_twin.h>
#include <oracle/polygon_twin.h>
#include <testing/counts.h>
#include <testing/placements.h>
#include <testing/scheme_surfaces.h>
#include <testing/surfaces.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <string>
#include <vector>

/// Surfaces that deform, of every scheme and tag, with limit points of the twins, which go along lines too.
namespace snug::testing {

[[nodiscard]] inline std::size_t trials(std::size_t usual) { return number_of("SNUG_DEFORMATIONS", usual); }

/// A shape that the twins can sample: its limit points are linear in its control points.
struct Shape {
  std::string name;
  ControlMesh mesh;
  SchemeOptions options;
  oracle::TaggedMesh twin;
  std::function<std::vector<Point3>(const oracle::TaggedMesh&)> sample;
};

[[nodiscard]] inline Point3 point(const oracle::Point& p) { return {p[0], p[1], p[2]}; }

[[nodiscard]] inline std::vector<Shape> shapes(std::uint64_t seed) {
  std::vector<Shape> list;
  for (const auto scheme : {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    for (const TaggedCase& c : tagged_cases(scheme, seed)) {
      if (c.mesh.points.size() > 30 || oracle::sample_faces(c.mesh, c.rules, 0).empty()) continue;
      const auto sample = [rules = c.rules](const oracle::TaggedMesh& mesh) {
        std::vector<Point3> points;
        for (const auto& s : oracle::sample_faces(mesh, rules, 2)) points.push_back(point(s.position));
        return points;
      };
      list.push_back({c.name + ", " + text_of(c.rules), control_mesh(c.mesh, c.rules), options_of(c.rules),
                      c.mesh, sample});
    }
  }
  namespace meshes = oracle::meshes;
  std::mt19937_64 random(seed);
  for (const Scheme scheme : {Scheme::doo_sabin, Scheme::midedge}) {
    for (const auto& [name, plain] :
         std::vector<std::pair<std::string, oracle::TaggedMesh>>{{"cube", meshes::cube()},
                                                                 {"grid", meshes::quad_grid(4, 4)},
                                                                 {"prism 5", meshes::prism(5)},
                                                                 {"pyramid 7", meshes::pyramid(7)}}) {
      const oracle::TaggedMesh mesh = meshes::shaken(plain, 0.2, random);
      const Surface surface(control_mesh(mesh), {.scheme = scheme});
      std::vector<bool> there;
      for (std::uint32_t v = 0; v < mesh.points.size(); ++v) there.push_back(surface.has({v, 0, 0.25, 0.25}));
      const auto sample = [scheme, there](const oracle::TaggedMesh& moved) {
        std::vector<Point3> points;
        for (const auto& s : oracle::sample_dual(
                 moved,
                 scheme == Scheme::doo_sabin ? oracle::DualScheme::doo_sabin : oracle::DualScheme::midedge,
                 2)) {
          if (std::any_of(s.owners.begin(), s.owners.end(), [&](auto v) { return there[v]; })) {
            points.push_back(point(s.position));
          }
        }
        return points;
      };
      list.push_back({name + ", " + name_of(scheme), control_mesh(mesh), {scheme}, mesh, sample});
    }
  }
  return list;
}

/// The ways to deform.
inline constexpr int way_count = 10;
[[nodiscard]] inline std::vector<Point3> deformed(const std::vector<Point3>& points, int way,
                                                  std::mt19937_64& random) {
  Point3 centre{};
  for (const Point3& p : points)
    centre = centre + (1.0 / static_cast<double>(points.size())) * (p - Point3{});
  const Vector3 by = random_vector(random, 1);
  const std::size_t one = random() % points.size();
  const Motion turn = Motion::rotation(random_vector(random, 1), 1 + 2 * unit(random));
  std::vector<Point3> result;
  for (const Point3& p : points) {
    const Vector3 from = p - centre;
    switch (way) {
      case 0:  // stays
        result.push_back(p);
        break;
      case 1:  // all alike
        result.push_back(p + by);
        break;
      case 2:  // each by itself
        result.push_back(p + random_vector(random, 0.7));
        break;
      case 3:  // along the chords of a rotation
        result.push_back(centre + turn.rotate(from));
        break;
      case 4:  // grows
        result.push_back(centre + 2.5 * from);
        break;
      case 5:  // through a point to the mirrored one
        result.push_back(centre - from);
        break;
      case 6:  // into a plane
        result.push_back({p.x, p.y, centre.z});
        break;
      case 7:  // a part of it alone
        result.push_back(from.x > 0 ? p + by : p);
        break;
      case 8:  // one point alone
        result.push_back(&p == &points[one] ? p + 4 * by : p);
        break;
      default:  // bends
        result.push_back({p.x, p.y, p.z + from.x * from.x});
        break;
    }
  }
  return result;
}

[[nodiscard]] inline oracle::TaggedMesh with_points(oracle::TaggedMesh mesh,
                                                    const std::vector<Point3>& points) {
  for (std::size_t v = 0; v < points.size(); ++v) mesh.points[v] = {points[v].x, points[v].y, points[v].z};
  return mesh;
}

[[nodiscard]] inline std::vector<Point3> translated(std::vector<Point3> points, const Vector3& by) {
  for (Point3& p : points) p = p + by;
  return points;
}

/// A surface that deforms, with limit points of the twin at both ends.
struct Body {
  Body(const Shape& shape, std::vector<Point3> begin, std::vector<Point3> in_end)
      : name(shape.name),
        end(std::move(in_end)),
        first(shape.sample(with_points(shape.twin, begin))),
        last(shape.sample(with_points(shape.twin, end))),
        surface(public_surface(moved(shape.mesh, std::move(begin)), shape.options)) {}
  static ControlMesh moved(ControlMesh mesh, std::vector<Point3> points) {
    mesh.points = std::move(points);
    return mesh;
  }
  [[nodiscard]] Point3 at(std::size_t i, double s) const { return first[i] + s * (last[i] - first[i]); }
  [[nodiscard]] std::size_t farthest(const Motion& pose, const Vector3& along, double s) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < first.size(); ++i) {
      if (dot(along, pose.rotate(at(i, s) - at(best, s))) > 0) best = i;
    }
    return best;
  }

  std::string name;
  std::vector<Point3> end, first, last;
  Surface surface;
};

/// How both are placed meanwhile.
inline constexpr int placing_count = 4;
[[nodiscard]] inline Trajectory any_motion(int placing, std::mt19937_64& random) {
  switch (placing) {
    case 0:
      return Motion();
    case 1:
      return random_placement(random, random_vector(random, 1));
    case 2:
      return Trajectory::steady(random_placement(random, random_vector(random, 1)),
                                {random_vector(random, 1), {0, 0, 1}, 0, {}});
    default:
      return Trajectory::steady(random_placement(random, random_vector(random, 1)),
                                {random_vector(random, 0.5), random_vector(random, 1), 3 * unit(random),
                                 Point3{} + random_vector(random, 1)});
  }
}

[[nodiscard]] inline Trajectory shifted(const Trajectory& motion, const Vector3& by) {
  const Motion from = motion.start().with_offset(motion.start().offset() + by);
  if (motion.pieces().empty()) return from;
  const Trajectory::Piece& piece = motion.pieces()[0];
  return Trajectory::steady(from, {piece.velocity, piece.axis, piece.radians, piece.about + by});
}

/// Counts of answers.
struct Tally {
  std::array<int, 4> verdicts{};
  int wide = 0, sharp = 0;
  std::vector<int> looks;  // with a usual tolerance
  void add(const TimeOfContact& found, bool usual = true) {
    ++verdicts[static_cast<std::size_t>(found.verdict)];
    wide += found.outcome != Outcome::complete;
    if (usual) looks.push_back(found.steps);
  }
  [[nodiscard]] int median() {
    std::sort(looks.begin(), looks.end());
    return looks[looks.size() / 2];
  }
  void print() {
    const int middle = median();
    std::cout << "  " << verdicts[0] << " separated, " << verdicts[1] << " within, " << verdicts[2]
              << " intersecting, " << verdicts[3] << " undecided; " << wide
              << " not decided to the tolerance, " << sharp << " sharp; looks " << middle
              << " in the median, " << looks[9 * looks.size() / 10] << " at nine tenths, " << looks.back()
              << " at most\n";
  }
};

/// Two limit points are in one place at a known time, where one surface comes from outside of the other one or from
/// anywhere.
/// The answers are never late.
inline Tally points_that_meet(std::uint64_t seed, std::size_t count, std::uint64_t budget) {
  std::mt19937_64 random(seed);
  const std::vector<Shape> all = shapes(seed);
  Tally tally;
  for (std::size_t trial = 0; trial < count; ++trial) {
    const Shape &shape_a = all[random() % all.size()], &shape_b = all[random() % all.size()];
    const int way_a = static_cast<int>(trial % way_count),
              way_b = static_cast<int>(trial / way_count % way_count);
    const int placing_a = static_cast<int>(random() % placing_count),
              placing_b = static_cast<int>(random() % placing_count);
    const double s = trial % 7 == 0 ? 1 : trial % 11 == 0 ? 0 : 0.05 + 0.9 * unit(random);
    const bool outside = random() % 4 != 0;
    const Body a(shape_a, shape_a.mesh.points, deformed(shape_a.mesh.points, way_a, random));
    const Trajectory motion_a = any_motion(placing_a, random);
    // B comes along `way`.
    const Vector3 way = random_vector(random, outside ? 4 : 0.5);
    const std::vector<Point3> begin_b = shape_b.mesh.points;
    const Body still(shape_b, begin_b, translated(deformed(begin_b, way_b, random), way));
    const Trajectory any_b = any_motion(placing_b, random);
    const Motion pose_a = motion_a.at(s), pose_b = any_b.at(any_b.duration() > 0 ? s : 0);
    std::size_t i = random() % a.first.size(), j = random() % still.first.size();
    if (outside) {
      const Vector3 ahead = pose_b.rotate(way);
      i = a.farthest(pose_a, -ahead, s);
      j = still.farthest(pose_b, ahead, s);
    }
    const Trajectory motion_b = shifted(any_b, pose_a.apply(a.at(i, s)) - pose_b.apply(still.at(j, s)));
    const double tolerance = std::array{1e-3, 1e-5, 1e-2, 0.0}[trial % 4];
    const TimeOfContact found = time_of_contact(
        {a.surface, way_a == 0 ? std::span<const Point3>{} : a.end, motion_a},
        {still.surface, still.end, motion_b}, {.tolerance = tolerance}, {.max_splits = budget});
    const std::string what = "trial " + std::to_string(trial) + ": " + a.name + " by way " +
                             std::to_string(way_a) + ", " + still.name + " by way " + std::to_string(way_b) +
                             ", placed by " + std::to_string(placing_a) + " and " + std::to_string(placing_b);
    tally.add(found, tolerance >= 1e-3);
    EXPECT_NE(found.verdict, Verdict::separated) << what << ", meet at " << s;
    EXPECT_LE(found.time.lower, s + 1e-10) << what;
    if (::testing::Test::HasFailure()) break;
    tally.sharp += found.time.lower > s - 0.02;
    if (found.verdict == Verdict::within || found.verdict == Verdict::intersecting) {
      EXPECT_GE(found.time.upper, found.time.lower) << what;
    }
  }
  return tally;
}

}  // namespace snug::testing
