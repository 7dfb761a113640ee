// bench_contact_time: first times of contact on screws through another model, beside distances and FCL's continuous
// collision on the same triangles. Files: the triangle models of examples/models.

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <snug/distance.h>
#include <snug/time_of_contact.h>

#include "peers.h"

namespace {

using namespace snug;
using namespace snug::bench;

constexpr double tolerance = 0.001, mesh_tolerance = 0.01;

struct Move {
  Motion a, from, to;
};

// B comes from one side of a room of side 5, turned at random, and leaves at the other one.
std::vector<Move> moves(std::size_t count, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Move> result;
  while (result.size() < count) {
    const PosePair one = place_in_room(1.5, random), other = place_in_room(1.5, random);
    const Vector3 to{normal(random), normal(random), normal(random)};
    const Vector3 way = (2 / length(to)) * to;
    const Move move{one.a, one.b.with_offset(one.b.offset() - way),
                    other.b.with_offset(other.b.offset() + way)};
    result.push_back(move);
  }
  return result;
}

struct Subjects {
  Surface a, b;

  TimeOfContact first(const Move& move) const {
    return time_of_contact(a, move.a, b, Trajectory::screw(move.from, move.to), {.tolerance = tolerance});
  }
  // B's control points go along lines to where it ends, turned and a fifth larger.
  std::vector<Point3> end_of(const Move& move) const {
    const Motion way = move.from.inverse() * move.to;
    std::vector<Point3> end;
    for (const Point3& p : b.mesh().points) end.push_back(way.apply(Point3{} + 1.2 * (p - Point3{})));
    return end;
  }
  TimeOfContact first_of_bent(const Move& move) const {
    const std::vector<Point3> end = end_of(move);
    return time_of_contact({a, {}, move.a}, {b, end, move.from}, {.tolerance = tolerance});
  }
  double distance_at(const Motion& pose_a, const Motion& pose_b) const {
    return distance(a.at(pose_a), b.at(pose_b), {.absolute = tolerance}).distance.upper;
  }
};

TriangleMesh triangles(const ControlMesh& mesh) {
  TriangleMesh result{mesh.points, {}};
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
  }
  return result;
}

// Returns the looks in the median.
int print_answers(const char* name, std::vector<TimeOfContact>& answers) {
  std::array<std::size_t, 4> verdicts{};
  std::vector<int> looks;
  std::vector<double> widths;
  std::size_t reached = 0;
  for (const TimeOfContact& answer : answers) {
    ++verdicts[static_cast<std::size_t>(answer.verdict)];
    looks.push_back(answer.steps);
    reached += (answer.outcome == Outcome::complete);
    if (answer.time.upper < INFINITY) widths.push_back(answer.time.upper - answer.time.lower);
  }
  std::sort(looks.begin(), looks.end());
  std::sort(widths.begin(), widths.end());
  std::printf(
      "# %s: %zu intersecting, %zu within, %zu separated, %zu undecided, %zu reached; looks %d in the "
      "median, %d at nine tenths, %d at most; widths %.2g in the median\n",
      name, verdicts[2], verdicts[1], verdicts[0], verdicts[3], reached, looks[looks.size() / 2],
      looks[looks.size() * 9 / 10], looks.back(), widths.empty() ? 0 : widths[widths.size() / 2]);
  return looks[looks.size() / 2];
}

// FCL's times against snug's intervals on the same triangles.
struct Errors {
  std::size_t count = 0, missed = 0, late = 0, early = 0, invented = 0;
  double latest = 0, earliest = 0;
  void add(const TimeOfContact& truth, const std::optional<double>& found) {
    ++count;
    if (truth.verdict == Verdict::intersecting) {
      if (!found) {
        ++missed;
      } else if (*found > truth.time.upper) {
        ++late;
        latest = std::max(latest, *found - truth.time.upper);
      } else if (*found < truth.time.lower) {
        ++early;
        earliest = std::max(earliest, truth.time.lower - *found);
      }
    } else if (truth.verdict == Verdict::separated) {
      invented += found.has_value();
    }
  }
  void print(const char* name) const {
    std::printf(
        "# %s of %zu: %zu contacts missed, %zu late by up to %.4f, %zu early by up to %.4f, %zu of none\n",
        name, count, missed, late, latest, early, earliest, invented);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const Options options = start(argc, argv, 7, " SEVEN-MODELS");
  const std::vector<Model> models = read_models(options.files);
  for (const auto& [name_a, name_b] : model_pairs) {
    const Model &model_a = named(models, name_a), &model_b = named(models, name_b);
    const Subjects smooth{Surface(model_a.mesh, {.scheme = Scheme::loop}),
                          Surface(model_b.mesh, {.scheme = Scheme::loop})},
        flat{Surface(model_a.mesh, {.scheme = Scheme::flat}),
             Surface(model_b.mesh, {.scheme = Scheme::flat})};
    const FclPair peers(triangles(model_a.mesh), triangles(model_b.mesh), FclBoxes::obbrss);
    const std::vector<Move> all = moves(options.size<std::size_t>(200, 20), 17);
    const auto count = static_cast<double>(all.size());
    const std::string names = std::string(name_a) + ", " + name_b;
    Group group("time of contact to 0.1 %, " + names, "motion", options);
    group.limit_rounds(3);
    const auto times_of = [&](const Subjects& subjects) {
      return [&] {
        double sum = 0;
        for (const Move& move : all) sum += subjects.first(move).time.lower;
        return sum;
      };
    };
    group.add("snug, limit surfaces", count, times_of(smooth));
    group.add("snug, flat meshes", count, times_of(flat));
    group.add("snug, limit surfaces, control points that move", count, [&] {
      double sum = 0;
      for (const Move& move : all) sum += smooth.first_of_bent(move).time.lower;
      return sum;
    });
    group.add("snug, one distance of limit surfaces to 0.1 %", 2 * count, [&] {
      double sum = 0;
      for (const Move& move : all) {
        // On the way: at a quarter and three quarters of it.
        for (const double s : {0.25, 0.75}) {
          sum += smooth.distance_at(move.a, Trajectory::screw(move.from, move.to).at(s));
        }
      }
      return sum;
    });
    for (const auto& [how, looks, name] :
         {std::tuple{FclContact::naive, std::size_t{10}, "FCL naive, 10 times, flat meshes"},
          {FclContact::naive, std::size_t{1000}, "FCL naive, 1000 times, flat meshes"},
          {FclContact::advancement, std::size_t{1000}, "FCL conservative advancement, flat meshes"}}) {
      group.add(name, count, [&, how = how, looks = looks] {
        double sum = 0;
        for (const Move& move : all) {
          sum += fcl_first_contact(peers.a, move.a, peers.b, move.from, move.to, how, looks).value_or(2);
        }
        return sum;
      });
    }
    const std::vector<Times> times = group.run();
    at_most("time of contact over one distance, " + names, ratio(times[0], times[3]), 20);
    std::vector<TimeOfContact> of_smooth, of_flat, of_bent;
    Errors ten, thousand, advancement;
    for (const Move& move : all) {
      of_smooth.push_back(smooth.first(move));
      of_flat.push_back(flat.first(move));
      of_bent.push_back(smooth.first_of_bent(move));
      const auto peer = [&](FclContact how, std::size_t looks) {
        return fcl_first_contact(peers.a, move.a, peers.b, move.from, move.to, how, looks);
      };
      ten.add(of_flat.back(), peer(FclContact::naive, 10));
      thousand.add(of_flat.back(), peer(FclContact::naive, 1000));
      advancement.add(of_flat.back(), peer(FclContact::advancement, 1000));
    }
    print_answers("snug, limit surfaces", of_smooth);
    print_answers("snug, flat meshes", of_flat);
    at_most("distances until contact where control points move, " + names,
            print_answers("snug, limit surfaces, control points that move", of_bent), 20);
    ten.print("FCL naive, 10 times,");
    thousand.print("FCL naive, 1000 times,");
    advancement.print("FCL conservative advancement,");
  }
  return 0;
}
