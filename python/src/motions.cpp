// Surfaces that move: trajectories, when two of them touch, and how far apart they stay.

#include <snug/clearance.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "answers.h"
#include "call.h"
#include "fields.h"
#include "poses.h"
#include "state.h"
#include "surface.h"

namespace snug {

auto members_of(python::Either<Clearance> auto& t) {
  return std::tie(t.distance, t.time, t.witness, t.contained, t.spans, t.outcome, t.steps, t.stats);
}

}  // namespace snug

namespace snug::python {
namespace {

Point3 point_of(const py::object& given, const char* what) {
  const Points points(given, what);
  if (!points.single()) throw py::value_error(std::string(what) + ": give x, y, z");
  return points.all()[0];
}
Vector3 vector_of(const py::object& given, const char* what) {
  const auto [x, y, z] = point_of(given, what);
  return {x, y, z};
}

// An object that __new__ alone made has zeros for a pose.
const Trajectory& made(const Trajectory& trajectory) {
  if (trajectory.start().numbers() == std::array<double, 12>{}) {
    throw py::type_error("this Trajectory was not made: through() and steady() make trajectories");
  }
  return trajectory;
}

// A Trajectory as it is; one pose stays, several are passed through.
Trajectory motion_of(const py::object& given, const char* name, const py::object& rigid) {
  if (py::isinstance<Trajectory>(given)) return made(given.cast<const Trajectory&>());
  const Poses poses(given, name, rigid);
  if (!poses.count()) return poses.at(0);
  if (*poses.count() == 0) throw py::value_error(std::string(name) + ": give a pose, or several");
  std::vector<Motion> motions;
  for (std::size_t i = 0; i < *poses.count(); ++i) motions.push_back(poses.at(i));
  try {
    return Trajectory::through(motions);
  } catch (const InputError& error) {
    throw InputError(error.problem(), std::string(name) + ": " + error.what());
  }
}

Trajectory steady(const py::object& pose, const py::object& velocity, const py::object& axis, double radians,
                  const py::object& about, const py::object& rigid) {
  const Motion from = pose_of(pose, "pose", rigid);
  SteadyMotion motion;
  motion.velocity = vector_of(velocity, "velocity");
  motion.axis = vector_of(axis, "axis");
  motion.radians = radians;
  const auto [x, y, z] = from.offset();
  motion.about = about.is_none() ? Point3{x, y, z} : point_of(about, "about");
  return Trajectory::steady(from, motion);
}

Answers<TimeOfContact> first_contact(const PySurface& py_a, const py::object& motion_a, const PySurface& py_b,
                                     const py::object& motion_b, const py::object& tolerance,
                                     const py::object& margin, bool solid, bool prove_contact,
                                     const py::object& max_splits, const py::object& threads,
                                     const py::object& progress, const py::object& rigid) {
  const Surface a = py_a.surface(), b = py_b.surface();  // which an update() meanwhile does not reach
  const Trajectory of_a = motion_of(motion_a, "motion_a", rigid),
                   of_b = motion_of(motion_b, "motion_b", rigid);
  TimeOfContactOptions options;
  options.tolerance = length_of(tolerance, std::max(a.size(), b.size()), "tolerance");
  options.margin = length_of(margin, std::max(a.size(), b.size()), "margin").value_or(0);
  options.solid = solid;
  options.prove_contact = prove_contact;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) {
    return Answers<TimeOfContact>(time_of_contact(a, of_a, b, of_b, options, run));
  });
}

Answers<Clearance> clearance_of(const PySurface& py_a, const py::object& motion_a, const PySurface& py_b,
                                const py::object& motion_b, const py::object& absolute,
                                const py::object& relative, bool solid, const py::object& max_splits,
                                const py::object& threads, const py::object& progress,
                                const py::object& rigid) {
  const Surface a = py_a.surface(), b = py_b.surface();
  const Trajectory of_a = motion_of(motion_a, "motion_a", rigid),
                   of_b = motion_of(motion_b, "motion_b", rigid);
  ClearanceOptions options;
  options.absolute = length_of(absolute, std::max(a.size(), b.size()), "absolute");
  options.relative = number_of(relative, "relative");
  options.solid = solid;
  Call call(progress, run_of(threads, max_splits));
  return call.run(
      [&](const Run& run) { return Answers<Clearance>(clearance(a, of_a, b, of_b, options, run)); });
}

bool meets(const Answers<TimeOfContact>& self) {
  const TimeOfContact& answer = self.one();
  if (answer.verdict == Verdict::undecided) {
    refuse_undecided("undecided: no contact before time " + text_at_least(answer.time.lower) +
                     "; give a larger tolerance or max_splits");
  }
  return answer.verdict != Verdict::separated;
}

void add_trajectory(py::module_& module) {
  py::class_<Trajectory> cls(
      module, "Trajectory",
      "How a surface moves from time 0 to `duration`: through() and steady() make one. It never "
      "changes.");
  cls.attr("__module__") = "snug";
  using py::arg;
  const py::object none = py::none();
  cls.def(py::init([](const py::args&, const py::kwargs&) -> Trajectory {
    throw py::type_error(
        "Trajectory() makes none: give Trajectory.through(poses, *, rigid=None) or "
        "Trajectory.steady(pose=None, *, "
        "velocity=(0, 0, 0), axis=(0, 0, 1), radians=0, about=None, rigid=None)");
  }));
  cls.def_static(
         "through",
         [](const py::object& poses, const py::object& rigid) { return motion_of(poses, "poses", rigid); },
         arg("poses"), py::kw_only(), arg("rigid") = none,
         "Through n poses as collide() takes them, one unit of time from each to the next, along "
         "screws with the shorter\n"
         "rotation. Raises PoseError for poses half a turn apart, ValueError.")
      .def_static(
          "steady", &steady, arg("pose") = none, py::kw_only(),
          arg("velocity") = py::make_tuple(0.0, 0.0, 0.0), arg("axis") = py::make_tuple(0.0, 0.0, 1.0),
          arg("radians") = 0.0, arg("about") = none, arg("rigid") = none,
          "From a pose for one unit of time with a constant velocity, (3,), and a rotation by so many "
          "radians about an axis,\n"
          "(3,), through the point `about`, (3,), which moves with the velocity; by default where the "
          "pose puts the origin.\n"
          "Raises PoseError, ValueError.")
      .def_property_readonly(
          "duration", [](const Trajectory& self) { return self.duration(); }, "The time at which it ends.")
      .def(
          "at", [](const Trajectory& self, double time) { return matrix_of(made(self).at(time)); },
          arg("time"), "The pose at a time, (4, 4), up to some roundings. Raises ValueError.")
      .def("__repr__", [](const Trajectory& self) {
        return "<snug.Trajectory of duration " + text_of(self.duration()) + ">";
      });
  const auto itself = [](const py::object& self, const py::args&) { return self; };
  cls.def("__copy__", itself);
  cls.def("__deepcopy__", itself);
}

void add_time_of_contact(py::module_& module) {
  AnswerClass<TimeOfContact> answers(
      module, "TimeOfContact",
      "The first contact of two moving surfaces. bool() is True for 'within' and 'intersecting', False for\n"
      "'separated', and raises UndecidedError for 'undecided'.");
  answers.fields();
  answers.python().def("__bool__", meets);
  answers.repr([](const TimeOfContact& t) {
    return std::string(name_of(t.verdict)) +
           (t.verdict == Verdict::separated ? "" : ", time " + text_of(t.time));
  });
}

void add_clearance(py::module_& module) {
  AnswerClass<ClearanceSpan> spans(
      module, "ClearanceSpans",
      "A motion in parts: the least distance in each. `lower` and `upper` are those of `distance`.");
  spans.fields().repr(
      [](const ClearanceSpan& t) { return "time " + text_of(t.time) + ", distance " + text_of(t.distance); });
  AnswerClass<Clearance> answers(module, "Clearance", "How far apart two surfaces are while they move.");
  answers.fields().repr(
      [](const Clearance& t) { return text_of(t.distance) + ", at time " + text_of(t.time); });
}

}  // namespace

void add_motions(py::module_& module) {
  add_trajectory(module);
  add_time_of_contact(module);
  add_clearance(module);
  using py::arg;
  const py::object none = py::none();
  module.def(
      "time_of_contact", first_contact, arg("a"), arg("motion_a"), arg("b"), arg("motion_b"), py::kw_only(),
      arg("tolerance") = "0.1%", arg("margin") = 0, arg("solid") = false, arg("prove_contact") = true,
      arg("max_splits") = none, arg("threads") = 0, arg("progress") = none, arg("rigid") = none,
      "When do two moving limit surfaces first touch?\n\n"
      "motion_a, motion_b: a Trajectory, a pose as collide() takes it, or None, which stay, or n poses to "
      "pass "
      "through. Both\n"
      "last equally long, or one stays.\n"
      "tolerance: mesh units, or percent of the larger surface's size; surfaces this close may be 'within', "
      "and the interval\n"
      "is narrowed until they move by at most this much in it. margin: contact is being at most so far "
      "apart. solid: compare\n"
      "the solids that closed surfaces bound.\n"
      "prove_contact: before 'within' try to prove 'intersecting'. max_splits: most work in each unit of "
      "time.\n\n"
      "Guarantee: no common point before `lower`, for the exact motions; with 'separated' at no time; nor, "
      "with a\n"
      "margin, points that near.\n"
      "Raises ValueError, PoseError, MeshError (solid: a surface is not closed), OverflowError.");
  module.def(
      "clearance", clearance_of, arg("a"), arg("motion_a"), arg("b"), arg("motion_b"), py::kw_only(),
      arg("absolute") = none, arg("relative") = none, arg("solid") = false, arg("max_splits") = none,
      arg("threads") = 0, arg("progress") = none, arg("rigid") = none,
      "How far apart do two moving limit surfaces stay? An envelope of their distance over time, proved "
      "between\n"
      "samples, too.\n\n"
      "motion_a, motion_b: as for time_of_contact(). absolute (mesh units, or percent of the larger "
      "surface's "
      "size),\n"
      "relative: how narrow the interval of each span must become; by default 0.1 % of the size or 10 % of "
      "the\n"
      "distance. solid, max_splits: as for time_of_contact().\n\n"
      "Guarantee: at each time of `spans[i]` they are at least `spans.lower[i]` apart, for the exact "
      "motions.\n"
      "Raises ValueError, PoseError, MeshError (solid: a surface is not closed), OverflowError.");
}

}  // namespace snug::python
