// Poses, and questions about two surfaces, or about one and itself.

#include <algorithm>
#include <array>
#include <cmath>

#include "fields.h"
#include "part.h"
#include "poses.h"

namespace snug::web {
namespace {

std::array<double, 12> twelve(const val& numbers) {
  if (!numbers.isArray() && numbers["BYTES_PER_ELEMENT"].isUndefined()) {
    throw InputError(InputProblem::pose, "a pose is a list of twelve numbers, row by row: R | t");
  }
  const std::vector<double> read = emscripten::convertJSArrayToNumberVector<double>(numbers);
  if (read.size() != 12) {
    throw InputError(
        InputProblem::pose,
        "a pose is a list of twelve numbers, row by row: R | t; this one has " + std::to_string(read.size()));
  }
  std::array<double, 12> matrix;
  std::copy(read.begin(), read.end(), matrix.begin());
  return matrix;
}
}  // namespace

Motion motion_of(const val& numbers) {
  return numbers.isUndefined() || numbers.isNull() ? Motion() : Motion::from_3x4(twelve(numbers));
}

CollideOptions collide_options(const val& options) {
  CollideOptions how;
  how.tolerance = option<double>(options, "tolerance");
  how.margin = option<double>(options, "margin").value_or(0);
  how.solid = option<bool>(options, "solid").value_or(false);
  how.measure = option<bool>(options, "measure").value_or(false);
  how.prove_contact = option<bool>(options, "proveContact").value_or(false);
  return how;
}
DistanceOptions distance_options(const val& options) {
  return {.absolute = option<double>(options, "absolute"),
          .relative = option<double>(options, "relative"),
          .solid = option<bool>(options, "solid").value_or(false)};
}

namespace {

// {axis, degrees, move}: rotated about an axis through the origin, then moved; `after` another pose.
val make_pose(const val& parts) {
  return guarded([&] {
    std::optional<Motion> motion;
    // Nothing is multiplied by the identity, which would turn -0 into 0.
    const auto then = [&](const Motion& next) { motion = motion ? next * *motion : next; };
    if (given(parts, "after")) then(motion_of(parts["after"]));
    if (given(parts, "degrees")) {
      const Vector3 axis = given(parts, "axis") ? vector_of(parts["axis"], "axis") : Vector3{0, 0, 1};
      then(Motion::rotation_degrees(axis, parts["degrees"].as<double>()));
    }
    if (given(parts, "move")) {
      const Vector3 by = vector_of(parts["move"], "move");
      const Vector3 from = motion ? motion->offset() : Vector3{};
      motion = motion.value_or(Motion()).with_offset({from.x + by.x, from.y + by.y, from.z + by.z});
    }
    return array_of(motion.value_or(Motion()));
  });
}

// Where a proof is wanted: receives it, and sets it in a result.
class Proof {
 public:
  explicit Proof(const val& options) : wanted_(option<bool>(options, "certificate").value_or(false)) {}
  Run with(Run run) { return run.certificate = wanted_ ? &certificate_ : nullptr, run; }
  void add_to(val& result) const {
    if (!wanted_) return;
    val object = val::object();
    object.set("text", certificate_.text);
    object.set("missing", certificate_.missing);
    result.set("certificate", object);
  }

 private:
  bool wanted_;
  Certificate certificate_;
};

val collide_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const PlacedSurface a(part_a.surface(), motion_of(options["poseA"]));
    const PlacedSurface b(part_b.surface(), motion_of(options["poseB"]));
    Proof proof(options);
    const Collision answer = collide(a, b, collide_options(options), proof.with(run_of(options)));
    val result = object_of(answer, std::array{a, b});
    proof.add_to(result);
    return result;
  });
}

val distance_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const PlacedSurface a(part_a.surface(), motion_of(options["poseA"]));
    const PlacedSurface b(part_b.surface(), motion_of(options["poseB"]));
    Proof proof(options);
    const Distance answer = distance(a, b, distance_options(options), proof.with(run_of(options)));
    val result = object_of(answer, std::array{a, b});
    proof.add_to(result);
    return result;
  });
}

// Twelve numbers each, of B; A stays where poseA puts it.
std::vector<PosePair> pairs_of(const val& poses, const val& options) {
  const std::vector<double> numbers = emscripten::convertJSArrayToNumberVector<double>(poses);
  if (numbers.size() % 12 != 0) {
    throw InputError(InputProblem::pose, "posesB: give twelve numbers each, row by row: R | t");
  }
  const Motion a = motion_of(options["poseA"]);
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < numbers.size(); i += 12) {
    std::array<double, 12> matrix;
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i), 12, matrix.begin());
    pairs.push_back({a, Motion::from_3x4(matrix)});
  }
  return pairs;
}
// Columns: what an object each would take longer to make than to find.
template <class Answer>
val columns_of(const std::vector<Answer>& answers) {
  std::vector<double> lower, upper;
  for (const Answer& answer : answers) {
    lower.push_back(answer.distance.lower);
    upper.push_back(answer.distance.upper);
  }
  val result = val::object();
  if constexpr (std::is_same_v<Answer, Collision>) {
    std::vector<std::uint8_t> verdicts;
    for (const Answer& answer : answers) verdicts.push_back(static_cast<std::uint8_t>(answer.verdict));
    result.set("verdicts", copied(verdicts));
  }
  result.set("lower", copied(lower));
  result.set("upper", copied(upper));
  return result;
}

val collide_many(const Part& a, const Part& b, const val& poses, const val& options) {
  return guarded([&] {
    return columns_of(collide(a.surface(), b.surface(), pairs_of(poses, options), collide_options(options),
                              run_of(options)));
  });
}
val distance_many(const Part& a, const Part& b, const val& poses, const val& options) {
  return guarded([&] {
    return columns_of(distance(a.surface(), b.surface(), pairs_of(poses, options), distance_options(options),
                               run_of(options)));
  });
}

// All contacts, and the curves in which the surfaces intersect.
val contacts_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const PlacedSurface a(part_a.surface(), motion_of(options["poseA"]));
    const PlacedSurface b(part_b.surface(), motion_of(options["poseB"]));
    ContactsOptions how;
    how.within = option<double>(options, "within");
    how.error = option<double>(options, "error");
    how.curves = option<bool>(options, "curves").value_or(true);
    return object_of(contacts(a, b, how, run_of(options)), std::array{a, b});
  });
}

val penetration_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    PenetrationOptions how;
    how.relative = option<double>(options, "relative").value_or(how.relative);
    return object_of(penetration({part_a.surface(), motion_of(options["poseA"])},
                                 {part_b.surface(), motion_of(options["poseB"])}, how, run_of(options)));
  });
}

// Through a list of poses, one unit of time from each to the next; one pose stays, and nothing is the identity.
Trajectory trajectory_of(const val& poses, const char* what) {
  if (poses.isUndefined() || poses.isNull()) return Motion();
  const std::size_t count = poses.isArray() ? poses["length"].as<std::size_t>() : 0;
  if (count == 0) throw InputError(InputProblem::value, std::string(what) + ": give a list of poses");
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < count; ++i) motions.push_back(motion_of(poses[i]));
  return Trajectory::through(motions);
}

// Where motions put two parts at a time.
std::array<PlacedSurface, 2> placed_at(double time, const Part& part_a, const Trajectory& motion_a,
                                       const Part& part_b, const Trajectory& motion_b) {
  const auto pose = [&](const Trajectory& motion) { return motion.at(std::min(time, motion.duration())); };
  return {PlacedSurface(part_a.surface(), pose(motion_a)), PlacedSurface(part_b.surface(), pose(motion_b))};
}

val time_of_contact_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const Trajectory motion_a = trajectory_of(options["motionA"], "motionA"),
                     motion_b = trajectory_of(options["motionB"], "motionB");
    TimeOfContactOptions how;
    how.tolerance = option<double>(options, "tolerance");
    how.solid = option<bool>(options, "solid").value_or(false);
    how.prove_contact = option<bool>(options, "proveContact").value_or(true);
    how.margin = option<double>(options, "margin").value_or(0);
    const TimeOfContact answer =
        time_of_contact(part_a.surface(), motion_a, part_b.surface(), motion_b, how, run_of(options));
    return object_of(answer, placed_at(std::isfinite(answer.time.upper) ? answer.time.upper : 0, part_a,
                                       motion_a, part_b, motion_b));
  });
}

val clearance_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const Trajectory motion_a = trajectory_of(options["motionA"], "motionA"),
                     motion_b = trajectory_of(options["motionB"], "motionB");
    ClearanceOptions how;
    how.absolute = option<double>(options, "absolute");
    how.relative = option<double>(options, "relative");
    how.solid = option<bool>(options, "solid").value_or(false);
    const Clearance answer =
        clearance(part_a.surface(), motion_a, part_b.surface(), motion_b, how, run_of(options));
    return object_of(answer, placed_at(answer.time, part_a, motion_a, part_b, motion_b));
  });
}

val self_contact_of(const Part& part, const val& options) {
  return guarded([&] {
    SelfContactOptions how;
    how.within = option<double>(options, "within");
    how.radius = option<double>(options, "radius");
    if (const auto levels = option<double>(options, "levels")) how.levels = index_of(*levels, "levels");
    const SelfContact answer = self_contact(part.surface(), how, run_of(options));
    const PlacedSurface surface(part.surface());
    return object_of(answer, std::array{surface, surface});
  });
}

}  // namespace
}  // namespace snug::web

EMSCRIPTEN_BINDINGS(pairs) {
  using namespace snug::web;  // NOLINT
  emscripten::function("pose", &make_pose);
  emscripten::function("collide", &collide_parts);
  emscripten::function("distance", &distance_of_parts);
  emscripten::function("collideMany", &collide_many);
  emscripten::function("distanceMany", &distance_many);
  emscripten::function("contacts", &contacts_of_parts);
  emscripten::function("penetration", &penetration_of_parts);
  emscripten::function("timeOfContact", &time_of_contact_of_parts);
  emscripten::function("clearance", &clearance_of_parts);
  emscripten::function("selfContact", &self_contact_of);
}
