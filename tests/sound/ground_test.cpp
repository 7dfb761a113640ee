// The promises of collide, distance and closest for every scheme, tag and rule, each with each other one:
// boundary rules, holes, edges and vertices that are not manifold, creases, Chaikin, darts, corners, smooth
// triangles, valences above 200 (with tables 100), rows and tables; against a twin that refines by itself.
//
//   SNUG_PLACEMENTS=20000 build/release/bin/tests/sound_test --gtest_filter=ground.answers_are_true
//
// runs so many placements; progress goes to standard error. SNUG_FIRST=N begins with placement N: with
// SNUG_PLACEMENTS=1 one that failed alone, and SNUG_DUMP=FOLDER writes its meshes there.

#include <snug/distance.h>
#include <snug/evaluate.h>
#include <support/error.h>

#include <gtest/gtest.h>
#include <oracle/polygon_twin.h>
#include <oracle/tagged_shapes.h>
#include <testing/counts.h>
#include <testing/ground_trials.h>
#include <testing/surfaces.h>
#include <testing/tagged.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>

#include "testing/verdict_only.h"

namespace snug::ground_test {
namespace {

using oracle::ContactBounds;
using oracle::ContactGoal;
using oracle::Point;
using testing::GroundSide;
using testing::GroundTrial;

constexpr int max_failures = 20;
constexpr std::uint64_t of_each_row = 1;

double between(const Point& p, const Point& q) { return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]); }
Point point_of(const Point3& p) { return {p.x, p.y, p.z}; }

Run with(Workspace& workspace, Run run) {
  run.workspace = &workspace;
  return run;
}

class Checks {
 public:
  /// False once too much has failed.
  bool run(GroundTrial& trial) {
    trial_ = &trial;
    size_ = trial.size();
    rounding_ = size_;
    for (const oracle::Placement& place : trial.places)
      for (const std::size_t i : {3u, 7u, 11u}) rounding_ = std::max(rounding_, std::abs(place[i]));
    rounding_ *= 0x1p-50;
    ++counts_["trials " + trial.family];
    counts_["twin's bounds far apart"] += trial.truth.spent;
    timed("collide", [&] { check_collide(); });
    timed("distance", [&] { check_distance(); });
    const std::size_t s = trial.random() % 2;
    // Its nearest pieces may be all around a vertex of a hundred faces, and the tables of so many kinds take long.
    if (!has_many_kinds(s) || trial.number % 16 == 0) timed("closest", [&] { check_closest(s); });
    if (side(0).is_solid() && side(1).is_solid()) timed("solids", [&] { check_solids(); });
    return failures_ < max_failures;
  }

  void report() const {
    for (const auto& [name, count] : counts_) std::printf("  %-40s %8zu\n", name.c_str(), count);
    for (const auto& [name, seconds] : seconds_)
      std::printf("  %-40s %8.2f s, slowest %.2f s (trial %llu)\n", name.c_str(), seconds,
                  slowest_.at(name).first, static_cast<unsigned long long>(slowest_.at(name).second));
    std::fflush(stdout);
  }
  [[nodiscard]] std::size_t count(const std::string& name) const {
    const auto at = counts_.find(name);
    return at == counts_.end() ? 0 : at->second;
  }

 private:
  void timed(const std::string& name, const std::function<void()>& what) {
    const auto start = std::chrono::steady_clock::now();
    what();
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    seconds_[name] += took;
    if (took >= slowest_[name].first) slowest_[name] = {took, trial_->number};
    if (took > 2 && std::getenv("SNUG_SHOW"))
      std::fprintf(stderr, "%s took %.1f s: %s\n", name.c_str(), took, testing::describe(*trial_).c_str());
  }
  [[nodiscard]] const GroundSide& side(std::size_t s) const { return (*trial_->sides)[s]; }

  /// Less where each piece may be of a kind of its own.
  [[nodiscard]] Run budget(std::uint64_t usual) const {
    std::uint64_t most = usual;
    for (std::size_t s = 0; s < 2; ++s)
      if (side(s).has_many())
        most = std::min<std::uint64_t>(
            most, (side(s).bounds() == BoundMethod::table ? 15 : 300) / (testing::long_check() ? 1 : 3));
    return {.max_splits = most};
  }

  [[nodiscard]] bool has_many_kinds(std::size_t s) const {
    return side(s).has_many() && side(s).bounds() == BoundMethod::table && side(s).made.rules.chaikin;
  }

  void expect(bool holds, const char* claim, double found = 0, double bound = 0) {
    if (holds) return;
    ++failures_;
    char numbers[120];
    std::snprintf(numbers, sizeof numbers, " (%.17g, %.17g): ", found, bound);
    ADD_FAILURE() << claim << numbers << answer_ << "; " << testing::describe(*trial_);
  }

  /// Of the twin: much now and then.
  [[nodiscard]] std::size_t effort() const {
    const std::size_t usual = trial_->number % 10 == 3 ? 3000 : 400;
    return testing::long_check() ? usual : usual / 3;
  }
  [[nodiscard]] ContactBounds contact(const ContactGoal& goal) {
    return contact_bounds(*side(0).twin, trial_->places[0], *side(1).twin, trial_->places[1], goal);
  }
  void expect_no_nearer(double lower, const char* claim) {
    if (!(lower > 0)) return;
    expect(lower <= trial_->truth.upper + rounding_, claim, lower, trial_->truth.upper);
    if (lower <= trial_->truth.lower) return;
    ContactGoal goal;
    goal.effort = effort();
    goal.threshold = lower;
    goal.precision = {1e-14 * size_, 1e-6};
    const ContactBounds found = contact(goal);
    expect(found.upper >= lower - rounding_, claim, lower, found.upper);
    counts_["twin left open"] += found.spent;
  }
  void expect_no_farther(double upper, const char* claim) {
    expect(upper >= trial_->truth.lower, claim, upper, trial_->truth.lower);
    if (upper >= trial_->truth.upper) return;
    ContactGoal goal;
    goal.effort = effort();
    goal.threshold = upper;
    goal.precision = {1e-14 * size_, 1e-6};
    const ContactBounds found = contact(goal);
    expect(found.lower <= upper + rounding_, claim, upper, found.lower);
    counts_["twin left open"] += found.spent;
  }
  // The twin has two points that are no farther apart.
  void expect_not_beyond(CollideOptions options) {
    options.margin = trial_->truth.upper * 1.001 + rounding_;
    const Collision answer = collide(trial_->placed(0), trial_->placed(1), options);
    expect(answer.verdict != Verdict::separated, "false separated: asked beyond the distance",
           answer.distance.lower, options.margin);
  }
  void expect_contact(const char* claim) {
    ContactGoal goal;
    goal.effort = effort();
    goal.threshold = 0;
    goal.precision = {1e-6 * size_, 0};
    const ContactBounds found = contact(goal);
    expect(found.lower <= 0, claim, found.lower);
    counts_["twin left open"] += found.spent;
  }
  void expect_on_surfaces(const WitnessPoints& witness) {
    for (std::size_t s = 0; s < 2; ++s) {
      const double error = witness[s].error, near = std::max(2 * error, 1e-9 * size_) + 8 * rounding_;
      // The twin goes down 46 levels, which where many edges meet are still wide, most in a dual scheme: with Midedge
      // as wide as the polygon.
      double reached = near;
      if (side(s).has_many()) {
        const Scheme scheme = side(s).made.scheme;
        reached = (scheme == Scheme::midedge ? 1 : !traits_of(scheme).dual ? 1e-7 : 1e-3) * size_;
      }
      ContactGoal goal;
      goal.threshold = near;
      const ContactBounds off =
          side(s).twin->distance_to(trial_->places[s], point_of(witness[s].point), goal);
      counts_["twin left a witness open"] += off.upper > near;
      expect(off.lower <= near && off.upper <= reached,
             s == 0 ? "the witness on A is on the surface" : "the witness on B is on the surface", near,
             error);
    }
  }

  void check_collide() {
    CollideOptions options = testing::verdict_only();
    options.tolerance = trial_->tolerance;
    options.margin = trial_->margin;
    const Run run = budget(trial_->tolerance > 0 ? 20'000 : 3000);
    options.prove_contact = trial_->number % 3 == 0;
    const Collision answer = collide(trial_->placed(0), trial_->placed(1), options, run);
    answer_ = std::string("collide: ") + name_of(answer.verdict) + " [" +
              std::to_string(answer.distance.lower) + ", " + std::to_string(answer.distance.upper) + "]";
    ++counts_[std::string("collide: ") + name_of(answer.verdict)];
    const double reach = options.margin + *options.tolerance;
    expect(answer.distance.lower >= 0 && std::isfinite(answer.distance.lower), "lower is a length",
           answer.distance.lower);
    if (std::isfinite(answer.distance.upper)) {
      expect(answer.distance.lower <= answer.distance.upper, "lower is at most upper", answer.distance.lower,
             answer.distance.upper);
      expect_no_farther(answer.distance.upper, "upper is at least the distance");
    }
    expect_no_nearer(answer.distance.lower, "lower is at most the distance");
    expect_not_beyond(options);
    switch (answer.verdict) {
      case Verdict::separated:
        expect(trial_->truth.upper > options.margin, "false separated", trial_->truth.upper, options.margin);
        expect_apart(options.margin);
        break;
      case Verdict::within:
        expect(answer.distance.upper <= reach * (1 + 1e-15), "within: upper is what was asked",
               answer.distance.upper, reach);
        expect(trial_->truth.lower <= reach, "false within", trial_->truth.lower, reach);
        break;
      case Verdict::intersecting:
        expect(answer.distance.lower == 0, "intersecting: nothing is between them", answer.distance.lower);
        expect_contact("false intersecting");
        break;
      case Verdict::undecided:
        counts_["undecided with a tolerance"] += *options.tolerance > 0;
        expect(*options.tolerance == 0 || side(0).has_many() || side(1).has_many(), "decided");
        break;
    }
    if (answer.witness) {
      if (answer.verdict != Verdict::intersecting)
        expect(between(point_of((*answer.witness)[0].point), point_of((*answer.witness)[1].point)) <=
                   answer.distance.upper * (1 + 1e-12) + rounding_,
               "the witnesses are at most upper apart", answer.distance.upper);
      expect_on_surfaces(*answer.witness);
    }
    if (trial_->number % 3 == 1) {
      Workspace empty;
      for (const Run& again_run : {with(empty, run), run}) {
        const Collision again = collide(trial_->placed(0), trial_->placed(1), options, again_run);
        expect(again.verdict == answer.verdict && again.distance.lower == answer.distance.lower &&
                   again.distance.upper == answer.distance.upper && again.witness == answer.witness &&
                   again.stats.splits == answer.stats.splits,
               "the same answer again", again.distance.lower, answer.distance.lower);
      }
    }
  }

  /// Farther than the margin: the twin finds no two points as near.
  void expect_apart(double margin) {
    ContactGoal goal;
    goal.effort = effort();
    goal.threshold = margin;
    goal.precision = {1e-14 * size_, 1e-9};
    if (trial_->truth.lower > margin) return;
    const ContactBounds found = contact(goal);
    expect(found.upper > margin - (margin > 0 ? rounding_ : 0), "false separated: the twin's points",
           found.upper, margin);
    counts_["twin left open"] += found.spent;
  }

  void check_distance() {
    DistanceOptions options{.absolute = 0, .relative = 0};
    const std::uint64_t choice = trial_->random() % 4;
    if (choice != 1) options.relative = choice == 0 ? 1e-6 : 1e-2;
    if (choice != 0) options.absolute = size_ * (choice == 1 ? 1e-6 : 1e-3);
    const Run run = budget(3000);
    const Distance answer = distance(trial_->placed(0), trial_->placed(1), options, run);
    char text[100];
    std::snprintf(text, sizeof text, "distance: [%.17g, %.17g]", answer.distance.lower,
                  answer.distance.upper);
    answer_ = text;
    counts_["distance: reached"] += (answer.outcome == Outcome::complete);
    expect(answer.distance.lower >= 0 && answer.distance.lower <= answer.distance.upper &&
               std::isfinite(answer.distance.upper),
           "an interval", answer.distance.lower, answer.distance.upper);
    expect_no_farther(answer.distance.upper, "upper is at least the distance");
    expect_no_nearer(answer.distance.lower, "lower is at most the distance");
    if (answer.distance.upper == 0) {
      expect_contact("false contact");
    } else {
      expect(between(point_of(answer.witness[0].point), point_of(answer.witness[1].point)) <=
                 answer.distance.upper * (1 + 1e-12) + rounding_,
             "the witnesses are at most upper apart", answer.distance.upper);
    }
    expect_on_surfaces(answer.witness);
    if (trial_->number % 3 == 2) {
      Workspace empty;
      const Distance again = distance(trial_->placed(0), trial_->placed(1), options, with(empty, run));
      expect(again.distance.lower == answer.distance.lower && again.distance.upper == answer.distance.upper &&
                 again.witness == answer.witness,
             "the same answer again", again.distance.lower, again.distance.upper);
    }
  }

  [[nodiscard]] Point some_point(std::size_t s) {
    std::uniform_real_distribution<double> unit(-1, 1);
    Point p = side(s).twin->some_limit_point(trial_->random());
    switch (trial_->random() % 5) {
      case 0:
        break;
      case 1:
        p[trial_->random() % 3] +=
            size_ * std::ldexp(unit(trial_->random), -static_cast<int>(trial_->random() % 40));
        break;
      case 2: {
        const auto& points = side(s).made.mesh.points;
        p = points[trial_->random() % points.size()];
        break;
      }
      default:
        for (double& x : p) x = 1.5 * size_ * unit(trial_->random);
    }
    return p;
  }

  void check_closest(std::size_t s) {
    const Point to = some_point(s);
    Precision options{.absolute = 0, .relative = 0};
    const std::uint64_t choice = trial_->random() % 3;
    options.relative = choice == 0 ? 1e-9 : 1e-3;
    options.absolute = size_ * (choice == 1 ? 1e-4 : 1e-9);
    const Run run = budget(1000);
    const ClosestPoint answer = closest_point(*side(s).surface, {to[0], to[1], to[2]}, options, run);
    char text[240];
    std::snprintf(text, sizeof text,
                  "closest on %s to (%.17g %.17g %.17g): [%.17g, %.17g] owner %u corner %u at %.17g %.17g",
                  s == 0 ? "A" : "B", to[0], to[1], to[2], answer.distance.lower, answer.distance.upper,
                  answer.at->owner, answer.at->corner, answer.at->u, answer.at->v);
    answer_ = text;
    counts_["closest: reached"] += (answer.outcome == Outcome::complete);
    const double rounding = 0x1p-50 * std::max({size_, std::abs(to[0]), std::abs(to[1]), std::abs(to[2])});
    const Point point = point_of(answer.point);
    expect(answer.distance.lower >= 0 && answer.distance.lower <= answer.distance.upper &&
               std::isfinite(answer.distance.upper),
           "an interval");
    expect(between(point, to) <= answer.distance.upper * (1 + 1e-12) + rounding,
           "the point is at most upper away", between(point, to), answer.distance.upper);
    ContactGoal goal;
    goal.effort = effort();
    goal.precision = {1e-13 * size_, 1e-3};
    if (answer.distance.lower > 0) goal.threshold = answer.distance.lower;
    const ContactBounds found = side(s).twin->distance_to(oracle::kUnmoved, to, goal);
    expect(found.upper >= answer.distance.lower - rounding, "the twin finds a nearer point", found.upper,
           answer.distance.lower);
    expect(answer.distance.upper >= found.lower - rounding, "upper is at least the distance",
           answer.distance.upper, found.lower);
    counts_["twin left open"] += found.spent;
    // The twin goes down 46 levels, which at large faces of a dual scheme are still wide, most of all around
    // their middles.
    const bool primal = !traits_of(side(s).made.scheme).dual, many = side(s).has_many();
    if (!primal && many && answer.at->u == 1 && answer.at->v == 1) {
      ++counts_["closest: in the middle of a large face"];
      return;
    }
    const bool by_twin = primal && !many;
    const Point same =
        side(s).twin->limit_point(answer.at->owner, answer.at->corner, answer.at->u, answer.at->v);
    expect(between(same, point) <= 2 * answer.error + (by_twin ? 1e-9 : 1e-3) * size_,
           "owner, u and v are those of the point", between(same, point), answer.error);
    if (trial_->number % 3 == 0) {
      Workspace empty;
      const ClosestPoint again =
          closest_point(*side(s).surface, {to[0], to[1], to[2]}, options, with(empty, run));
      expect(again.distance.lower == answer.distance.lower && again.distance.upper == answer.distance.upper &&
                 again.point == answer.point,
             "the same answer again", again.distance.lower, again.distance.upper);
    }
  }

  /// A limit point of one placed surface as the other one's mesh sees it.
  [[nodiscard]] static Point from_world(const oracle::Placement& place, const Point& p) {
    Point q{};
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < 3; ++r) q[c] += place[4 * r + c] * (p[r] - place[4 * r + 3]);
    return q;
  }
  [[nodiscard]] static Point to_world(const oracle::Placement& place, const Point& p) {
    Point q{};
    for (std::size_t r = 0; r < 3; ++r)
      q[r] = place[4 * r] * p[0] + place[4 * r + 1] * p[1] + place[4 * r + 2] * p[2] + place[4 * r + 3];
    return q;
  }
  /// Does a surface wind around a limit point of the other one? Nothing where that is not told.
  [[nodiscard]] std::optional<bool> holds(std::size_t outer) const {
    for (std::size_t i = 0; i < 40; i += 7) {
      const Point p = to_world(trial_->places[1 - outer], side(1 - outer).twin->some_limit_point(i));
      const int levels = side(outer).made.mesh.polygons.size() > 150 ? 1 : 4;
      const std::optional<int> number =
          side(outer).twin->winding_number(from_world(trial_->places[outer], p), levels);
      if (number) return *number != 0;
    }
    return {};
  }

  void check_solids() {
    if (!(trial_->truth.lower > 0)) return;  // what meets is told by the surfaces alone
    CollideOptions options = testing::verdict_only();
    options.tolerance = trial_->tolerance;
    const Run run = budget(20'000);
    options.solid = true;
    const Collision answer = collide(trial_->placed(0), trial_->placed(1), options, run);
    answer_ = std::string("solids: ") + name_of(answer.verdict);
    ++counts_[answer_];
    const std::optional<bool> in_a = holds(0), in_b = holds(1);
    if (!in_a || !in_b) {
      ++counts_["solids: the twin does not tell"];
      return;
    }
    const bool nested = *in_a || *in_b;
    ++counts_[nested ? "solids: nested" : "solids: not nested"];
    if (nested) {
      expect(answer.verdict != Verdict::separated, "false separated: one lies inside the other");
    } else {
      expect(answer.verdict != Verdict::intersecting, "false intersecting: apart, none inside the other");
    }
  }

  GroundTrial* trial_ = nullptr;
  double size_ = 0, rounding_ = 0;
  std::string answer_;
  std::map<std::string, std::size_t> counts_;
  std::map<std::string, double> seconds_;
  std::map<std::string, std::pair<double, std::uint64_t>> slowest_;
  int failures_ = 0;
};

// Where a patch's kind once left out what its surface depends on.
void expect_limit_points(const oracle::TaggedMesh& mesh, const oracle::Rules& rules) {
  const Surface surface = testing::public_surface(testing::control_mesh(mesh), testing::options_of(rules));
  const std::vector<oracle::FaceSample> samples = oracle::sample_faces(mesh, rules, 3);
  EXPECT_FALSE(samples.empty());
  for (const oracle::FaceSample& s : samples) {
    const SurfacePoint found = evaluate(surface, {s.face, s.part, s.u, s.v});
    for (std::size_t x = 0; x < 3; ++x)
      EXPECT_LE(std::fabs(found.point[x] - s.position[x]), found.error + s.error)
          << "face " << s.face << '.' << s.part << " at " << s.u << ", " << s.v;
  }
}

// With Chaikin an edge of sharpness 0.5 stays sharp beside sharper ones at both of its ends: faces that touch
// one end alone have to know of the other.
TEST(ground, chaikin_looks_beyond_the_faces_around) {
  std::mt19937_64 random(5);
  for (const oracle::PrimalScheme scheme :
       {oracle::PrimalScheme::catmull_clark, oracle::PrimalScheme::loop}) {
    oracle::Rules rules;
    rules.scheme = scheme;
    rules.chaikin = rules.clamp_dart_edges = true;
    for (const double middle : {0.5, 0.3, 1.7}) {
      oracle::TaggedMesh mesh = oracle::meshes::shaken(oracle::meshes::quad_grid(5, 4), 0.2, random);
      if (scheme == oracle::PrimalScheme::loop) mesh = oracle::meshes::triangulated(mesh);
      mesh.creases = {{13, 14, 3.2}, {14, 15, middle}, {15, 16, 3.2}};
      expect_limit_points(mesh, rules);
    }
  }
}

// A corner whose faces run from one sharp edge back to it, beside vertices of three faces.
TEST(ground, fans_from_an_edge_back_to_it_are_told) {
  oracle::Rules rules;
  rules.scheme = oracle::PrimalScheme::loop;
  oracle::TaggedMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1, 0.1}, {0.3, 0.2, 1}};
  mesh.polygons = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  mesh.creases = {{0, 1, 10}};
  mesh.corners = {{0, 10}};
  expect_limit_points(mesh, rules);
}

TEST(ground, meshes_have_what_was_chosen) {
  std::mt19937_64 random(3);
  const auto& rows = testing::covering_rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    testing::Choices choices;
    std::copy_n(rows[i].begin() + (i % 2 == 0 ? 0 : testing::factor_count), testing::factor_count,
                choices.begin());
    EXPECT_TRUE(testing::is_possible(choices));
    EXPECT_EQ(testing::missing(testing::make_mesh(choices, random), choices), "") << i;
  }
}

TEST(ground, answers_are_true) {
  const std::uint64_t usual = testing::row_count() * of_each_row;
  const std::uint64_t first = testing::number_of("SNUG_FIRST", 0);
  const std::uint64_t count = testing::number_of("SNUG_PLACEMENTS", usual);
  testing::GroundTrials trials(of_each_row);
  Checks checks;
  std::map<testing::ValuePair, std::size_t> covered;
  double making = 0;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto before = std::chrono::steady_clock::now();
    GroundTrial trial = trials.make(first + i);
    making += std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
    for (const testing::ValuePair& pair : testing::pairs_of(trials.row())) ++covered[pair];
    if (!checks.run(trial)) break;
    if ((i + 1) % 500 == 0)
      std::fprintf(stderr, "%llu placements, %.0f s\n", static_cast<unsigned long long>(i + 1),
                   std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  checks.report();
  std::printf("  %-40s %8.2f s\n", "surfaces, placements and the twin's bounds", making);
  std::size_t least = SIZE_MAX, all = 0;
  for (const testing::ValuePair& pair : testing::all_pairs()) {
    all += covered.contains(pair);
    least = std::min(least, covered.contains(pair) ? covered[pair] : 0);
  }
  std::printf("  pairs of cases: %zu of %zu, each in at least %zu placements; %zu rows cover them\n", all,
              testing::all_pairs().size(), least, testing::covering_rows().size());
  if (first == 0 && count >= usual && !HasFailure()) {
    EXPECT_EQ(all, testing::all_pairs().size());
    EXPECT_GT(checks.count("collide: separated"), count / 10);
    EXPECT_GT(checks.count("collide: within") + checks.count("collide: intersecting"), count / 10);
    // A few hundred trials have some ten solids; one in the other is a matter of thousands.
    EXPECT_GT(checks.count("solids: nested") + checks.count("solids: not nested"), 0u);
    if (count >= 10 * usual) {
      EXPECT_GT(checks.count("solids: nested"), 0u);
    }
  }
}

// The same of surfaces whose control points have moved and whose trees were refitted: journeys with each
// scheme, tag and rule, nine pairs of ten at least. SNUG_MOVED=N: so many placements.
TEST(ground, answers_about_moved_surfaces_are_true) {
  const std::uint64_t usual = 5 * testing::covering_rows().size() / 4;
  const std::uint64_t first = testing::number_of("SNUG_FIRST", 0);
  const std::uint64_t count = testing::number_of("SNUG_MOVED", usual);
  testing::GroundTrials trials(1, true);
  Checks checks;
  std::set<std::array<std::size_t, 3>> covered, possible;  // journey, factor, value
  for (std::uint64_t i = 0; i < count; ++i) {
    GroundTrial trial = trials.make(first + i);
    for (const GroundSide& side : *trial.sides) {
      for (std::size_t f = 0; f < testing::factor_count; ++f) {
        covered.insert({static_cast<std::size_t>(*side.journey), f, side.choices[f]});
        for (std::size_t j = 0; j < testing::journey_count; ++j) possible.insert({j, f, side.choices[f]});
      }
    }
    if (!checks.run(trial)) break;
  }
  checks.report();
  std::printf("  journeys with cases: %zu of %zu\n", covered.size(), possible.size());
  if (first == 0 && count >= usual && !HasFailure()) {
    EXPECT_GE(covered.size(), possible.size() * 9 / 10);
    EXPECT_GT(checks.count("collide: separated"), count / 10);
    EXPECT_GT(checks.count("collide: within") + checks.count("collide: intersecting"), count / 10);
  }
}

}  // namespace
}  // namespace snug::ground_test
