// Two surfaces: collide, distance, penetration.

#include <cmath>

#include <snug/collide.h>
#include <snug/distance.h>
#include <snug/scene.h>

#include "answers.h"
#include "call.h"
#include "certificate.h"
#include "fields.h"
#include "poses.h"
#include "surface.h"

namespace snug::python {
namespace {

double larger_size(const PySurface& a, const PySurface& b) {
  return std::max(a.surface().size(), b.surface().size());
}

// One answer, or one for each pose.
template <class T, class One, class Many>
Answers<T> for_poses(const PySurface& py_a, const PySurface& py_b, const Poses& pose_a, const Poses& pose_b,
                     const py::object& progress, const Run& run, const One& one, const Many& many) {
  const Surface a = py_a.surface(), b = py_b.surface();  // which an update() meanwhile does not reach
  const std::optional<std::size_t> count = common_count(pose_a, pose_b);
  Call call(progress, run);
  return call.run([&](const Run& each) {
    if (!count) return Answers<T>(one(a.at(pose_a.at(0)), b.at(pose_b.at(0)), each));
    return Answers<T>(many(a, b, pairs_of(pose_a, pose_b, *count), each));
  });
}

Answers<Collision> collide_surfaces(const PySurface& a, const PySurface& b, const py::object& pose_a,
                                    const py::object& pose_b, const py::object& tolerance,
                                    const py::object& margin, bool solid, const py::object& witness,
                                    bool measure, bool prove_contact, const py::object& max_splits,
                                    const py::object& threads, const py::object& progress,
                                    const py::object& rigid, const py::object& certificate) {
  CertificateFile file(certificate);
  CollideOptions options;
  if (!tolerance.is_none()) options.tolerance = length_of(tolerance, larger_size(a, b), "tolerance");
  if (!margin.is_none()) options.margin = *length_of(margin, larger_size(a, b), "margin");
  options.solid = solid;
  options.measure = measure;
  options.prove_contact = prove_contact;
  options.witness = witness_kind(witness);
  return file.written(for_poses<Collision>(
      a, b, {pose_a, "pose_a", rigid}, {pose_b, "pose_b", rigid}, progress,
      file.with(run_of(threads, max_splits)),
      [&](const PlacedSurface& x, const PlacedSurface& y, const Run& run) {
        return collide(x, y, options, run);
      },
      [&](const Surface& x, const Surface& y, const std::vector<PosePair>& poses, const Run& run) {
        return collide(x, y, poses, options, run);
      }));
}

Answers<Distance> distance_of_surfaces(const PySurface& a, const PySurface& b, const py::object& pose_a,
                                       const py::object& pose_b, const py::object& relative,
                                       const py::object& absolute, bool solid, const py::object& max_splits,
                                       const py::object& threads, const py::object& progress,
                                       const py::object& rigid, const py::object& certificate) {
  CertificateFile file(certificate);
  DistanceOptions options;
  options.relative = number_of(relative, "relative");
  options.absolute = length_of(absolute, larger_size(a, b), "absolute");
  options.solid = solid;
  return file.written(for_poses<Distance>(
      a, b, {pose_a, "pose_a", rigid}, {pose_b, "pose_b", rigid}, progress,
      file.with(run_of(threads, max_splits)),
      [&](const PlacedSurface& x, const PlacedSurface& y, const Run& run) {
        return distance(x, y, options, run);
      },
      [&](const Surface& x, const Surface& y, const std::vector<PosePair>& poses, const Run& run) {
        return distance(x, y, poses, options, run);
      }));
}

Answers<Penetration> penetration_of_surfaces(const PySurface& a, const PySurface& b, const py::object& pose_a,
                                             const py::object& pose_b, const py::object& relative,
                                             const py::object& max_splits, const py::object& progress,
                                             const py::object& rigid) {
  PenetrationOptions options;
  options.relative = number_of(relative, "relative").value_or(options.relative);
  return for_poses<Penetration>(
      a, b, {pose_a, "pose_a", rigid}, {pose_b, "pose_b", rigid}, progress, run_of(py::int_(1), max_splits),
      [&](const PlacedSurface& x, const PlacedSurface& y, const Run& run) {
        return penetration(x, y, options, run);
      },
      [&](const Surface& x, const Surface& y, const std::vector<PosePair>& poses, const Run& run) {
        const WorkMonitor quiet{.on_progress = {}, .stop = run.monitor->stop};
        std::vector<Penetration> answers;
        answers.reserve(poses.size());
        for (const PosePair& pose : poses) {
          run.monitor->report(static_cast<double>(answers.size()) / static_cast<double>(poses.size()));
          answers.push_back(penetration(x.at(pose.a), y.at(pose.b), options,
                                        {.monitor = &quiet, .max_splits = run.max_splits}));
        }
        return answers;
      });
}

// The pairs of parts that boxes do not separate by more than `reach`, and lower bounds of their distances: every two, or
// each of the `first` ones with each of the others.
py::tuple near_pairs(const py::sequence& surfaces, const py::object& given, const py::object& first,
                     double reach) {
  const Poses poses(given, "poses", py::none());
  Scene scene;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    scene.parts.push_back(surfaces[i].cast<const PySurface&>().surface().at(poses.at(i)));
  }
  if (!first.is_none()) {
    scene.pairs.emplace();
    const auto begin = first.cast<std::uint32_t>();
    for (std::uint32_t a = 0; a < begin; ++a) {
      for (std::uint32_t b = begin; b < scene.parts.size(); ++b) scene.pairs->push_back({a, b});
    }
  }
  Call call;
  const std::vector<ScenePair> found = call.run([&](const Run& run) {
    SceneBroadPhase broad(scene, std::min(reach, std::numeric_limits<double>::max()), std::isinf(reach), run);
    return broad.next(broad.pair_count());
  });
  const auto count = static_cast<py::ssize_t>(found.size());
  py::array_t<std::uint32_t> a(count), b(count);
  py::array_t<double> gaps(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const ScenePair& pair = found[static_cast<std::size_t>(i)];
    a.mutable_at(i) = pair.parts.a;
    b.mutable_at(i) = pair.parts.b;
    gaps.mutable_at(i) = pair.gap;
  }
  return py::make_tuple(a, b, gaps);
}

// ", budget-spent" and the like.
std::string note_of(Outcome outcome) {
  return outcome == Outcome::complete ? "" : std::string(", ") + name_of(outcome);
}

bool colliding(const Collision& answer) {
  return answer.verdict == Verdict::within || answer.verdict == Verdict::intersecting;
}

bool truth(const Answers<Collision>& self) {
  if (!self.single()) {
    throw py::value_error(
        "The truth value of an array with more than one element is ambiguous. Use hit.any() or hit.all()");
  }
  const Collision& answer = self.one();
  if (answer.verdict == Verdict::undecided) {
    refuse_undecided("undecided: the distance is " + text_of(answer.distance) +
                     "; give a larger tolerance or max_splits");
  }
  return colliding(answer);
}

// Is there one that is `wanted`? Not known where none is and some are undecided.
bool some(const Answers<Collision>& self, bool wanted) {
  std::size_t undecided = 0;
  for (const Collision& answer : self.all()) {
    if (answer.verdict == Verdict::undecided) {
      ++undecided;
    } else if (colliding(answer) == wanted) {
      return true;
    }
  }
  if (undecided > 0) {
    refuse_undecided(std::to_string(undecided) + " of " + std::to_string(self.all().size()) +
                     " answers are undecided; give a larger tolerance or max_splits, or see hit.undecided");
  }
  return false;
}

std::string counts(std::span<const Collision> all) {
  std::array<std::size_t, 4> count{};
  for (const Collision& each : all) ++count[static_cast<std::size_t>(each.verdict) % 4];
  std::string text;
  for (std::size_t v = 0; v < 4; ++v) {
    if (count[v] > 0)
      text +=
          (text.empty() ? ": " : ", ") + std::to_string(count[v]) + " " + name_of(static_cast<Verdict>(v));
  }
  return text;
}

void add_collision(py::module_& module) {
  AnswerClass<Collision> answers(
      module, "Collision",
      "Do two surfaces touch? One answer, or n of them for n poses. bool() is True for 'within' and\n"
      "'intersecting', False for 'separated', and raises UndecidedError for 'undecided'.");
  answers.fields();
  const auto mask = [&](const char* name, const auto& holds, const char* doc) {
    answers.array<bool>(
        name, {}, [holds](const Collision& t, bool* out) { *out = holds(t); }, doc);
  };
  mask("colliding", colliding, "Is the verdict 'within' or 'intersecting'? (n,) bool.");
  mask(
      "separated", [](const Collision& t) { return t.verdict == Verdict::separated; },
      "Are they proved to be farther apart than the margin? (n,) bool.");
  mask(
      "undecided", [](const Collision& t) { return t.verdict == Verdict::undecided; },
      "Was nothing shown within max_splits or the precision of doubles? (n,) bool.");
  answers.python()
      .def("__bool__", truth)
      .def(
          "any", [](const Answers<Collision>& self) { return some(self, true); },
          "Does any collide? Raises UndecidedError where that depends on undecided ones.")
      .def(
          "all", [](const Answers<Collision>& self) { return !some(self, false); },
          "Do all collide? Raises UndecidedError where that depends on undecided ones.");
  answers.repr(
      [](const Collision& t) {
        const bool touch = t.verdict == Verdict::intersecting && t.distance.upper == 0;
        return std::string(name_of(t.verdict)) + (touch ? "" : ", distance " + text_of(t.distance));
      },
      counts);
}

void add_distance(py::module_& module) {
  AnswerClass<Distance> answers(module, "Distance",
                                "How far apart two surfaces are: one answer, or n of them for n poses.");
  answers.fields().repr([](const Distance& t) { return text_of(t.distance) + note_of(t.outcome); });
}

void add_penetration(py::module_& module) {
  AnswerClass<Penetration> answers(
      module, "Penetration",
      "How deeply two solids penetrate: the least length of a translation of B that separates them.");
  answers.fields().repr(
      [](const Penetration& t) { return "depth " + text_of(t.depth) + note_of(t.outcome); });
}

constexpr const char* pose_doc =
    "pose_a, pose_b: rigid transforms x -> R x + t as (4, 4), (3, 4), a tuple (R, t) or (quaternion w x y z, "
    "t); or n of\n"
    "them with n in front of each shape, or a list of them, and then the answer has n. One pose on one side "
    "stands beside n\n"
    "on the other.\n"
    "rigid=\"nearest\": what is not rigid within 1e-9 is replaced by the nearest rotation.\n"
    "progress: called with the fraction done, or True for a bar by tqdm; what it raises ends the work.\n\n";

// Most calls of collide() name a few plain arguments: these are taken as they come, without what pybind11 does to sort out fifteen.
// All others, and what goes wrong, are for the function that it made.
class QuickCollide {
 public:
  static PyObject* call(PyObject* slow, PyObject* const* args, Py_ssize_t count, PyObject* names) {
    try {
      if (PyObject* const answer = quick(args, count, names)) return answer;
    } catch (py::error_already_set& error) {
      error.restore();
      return nullptr;
    } catch (...) {  // the other one will say it
    }
    return PyObject_Vectorcall(slow, args, static_cast<std::size_t>(count), names);
  }
  // Stands in the place of the function of this name.
  static void put_before(py::module_& module) {
    surface_ = py::type::of<PySurface>().ptr();
    static PyMethodDef definition{"collide", nullptr, METH_FASTCALL | METH_KEYWORDS, nullptr};
    const py::object slow = module.attr("collide");
    using Any = void (*)();
    definition.ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<Any>(call));     // NOLINT
    definition.ml_doc = reinterpret_cast<PyCFunctionObject*>(slow.ptr())->m_ml->ml_doc;  // NOLINT
    module.attr("collide") = py::reinterpret_steal<py::object>(
        PyCFunction_NewEx(&definition, slow.ptr(), module.attr("__name__").ptr()));
  }

 private:
  static const PySurface* surface_of(PyObject* object) {
    if (reinterpret_cast<PyObject*>(Py_TYPE(object)) != surface_) return nullptr;  // NOLINT
    auto* const instance = reinterpret_cast<py::detail::instance*>(object);        // NOLINT
    return instance->get_value_and_holder().value_ptr<PySurface>();
  }
  static PyObject* quick(PyObject* const* args, Py_ssize_t count, PyObject* names) {
    if (count != 2) return nullptr;
    const PySurface *const a = surface_of(args[0]), *const b = surface_of(args[1]);
    if (a == nullptr || b == nullptr) return nullptr;
    CollideOptions options;
    options.tolerance = 0.1 / 100 * larger_size(*a, *b);  // as length_of() has "0.1%"
    std::array<PyObject*, 2> poses{Py_None, Py_None};
    for (Py_ssize_t i = 0; names != nullptr && i < PyTuple_GET_SIZE(names); ++i) {
      PyObject *const name = PyTuple_GET_ITEM(names, i), *const value = args[2 + i];
      const auto is = [&](const char* word) { return PyUnicode_CompareWithASCIIString(name, word) == 0; };
      const bool truth = value == Py_True || value == Py_False;
      if (is("pose_b")) {
        poses[1] = value;
      } else if (is("pose_a")) {
        poses[0] = value;
      } else if (truth && is("measure")) {
        options.measure = value == Py_True;
      } else if (truth && is("prove_contact")) {
        options.prove_contact = value == Py_True;
      } else if (truth && is("solid")) {
        options.solid = value == Py_True;
      } else if (is("witness")) {
        options.witness = witness_kind(py::reinterpret_borrow<py::object>(value));
      } else {
        return nullptr;
      }
    }
    const py::none none;
    const Poses pose_a(py::reinterpret_borrow<py::object>(poses[0]), "pose_a", none),
        pose_b(py::reinterpret_borrow<py::object>(poses[1]), "pose_b", none);
    if (pose_a.count() || pose_b.count()) return nullptr;
    const PlacedSurface placed_a(a->surface(), pose_a.at(0)), placed_b(b->surface(), pose_b.at(0));
    Call call;
    return py::cast(call.run([&](const Run& run) {
             return Answers<Collision>(collide(placed_a, placed_b, options, run));
           }))
        .release()
        .ptr();
  }
  static inline PyObject* surface_ = nullptr;
};

}  // namespace

void quicken_collide(py::module_& module) { QuickCollide::put_before(module); }

void add_pair_queries(py::module_& module) {
  add_collision(module);
  add_distance(module);
  add_penetration(module);
  using py::arg;
  const py::object none = py::none();
  const std::string poses = pose_doc;
  module.def(
      "collide", collide_surfaces, arg("a"), arg("b"), py::kw_only(), arg("pose_a") = none,
      arg("pose_b") = none, arg("tolerance") = "0.1%", arg("margin") = 0, arg("solid") = false,
      arg("witness") = "exact", arg("measure") = false, arg("prove_contact") = false,
      arg("max_splits") = none, arg("threads") = 0, arg("progress") = none, arg("rigid") = none,
      arg("certificate") = none,
      ("Do two limit surfaces touch?\n\n" + poses +
       "tolerance, margin: mesh units, or percent of the larger surface's size as in \"0.1%\"; with "
       "tolerance 0 only proofs\n"
       "of contact or separation count. solid: compare the solids that closed surfaces bound.\n"
       "witness: 'none', 'approximate' or 'exact'. measure: narrow the interval of separated surfaces, some "
       "ten\n"
       "microseconds more. prove_contact: before 'within' try to prove 'intersecting', some thirty more.\n"
       "max_splits: most splits. threads: for many poses; 0 takes all cores.\n"
       "certificate: a file for a proof of the answers, which snug-check verifies.\n\n"
       "Guarantee: 'separated' means distance > margin, 'within' distance <= margin + tolerance, "
       "'intersecting' a common\n"
       "point, for the doubles given. The answer depends on the input alone.\n"
       "Raises ValueError, PoseError, MeshError (solid: a surface is not closed), OverflowError.")
          .c_str());
  module.def("distance", distance_of_surfaces, arg("a"), arg("b"), py::kw_only(), arg("pose_a") = none,
             arg("pose_b") = none, arg("relative") = none, arg("absolute") = none, arg("solid") = false,
             arg("max_splits") = none, arg("threads") = 0, arg("progress") = none, arg("rigid") = none,
             arg("certificate") = none,
             ("How far apart are two limit surfaces?\n\n" + poses +
              "The work ends once upper - lower <= max(absolute, relative * upper); absolute is in mesh "
              "units, or percent of the\n"
              "larger surface's size. By default absolute is 0.01 % of it.\n\n"
              "Guarantee: [lower, upper] contains the distance, whatever the outcome.\n"
              "Raises as collide().")
                 .c_str());
  module.def(
      "_near_pairs", near_pairs, arg("surfaces"), arg("poses"), arg("first"), arg("reach"),
      "For collision.py: pairs of parts that boxes do not separate, and lower bounds of their distances.");
  module.def("_pose", matrix_of_pose, arg("pose"), arg("name"),
             arg("rigid") = none);  // for the package alone
  module.def("penetration", penetration_of_surfaces, arg("a"), arg("b"), py::kw_only(), arg("pose_a") = none,
             arg("pose_b") = none, arg("relative") = none, arg("max_splits") = none, arg("progress") = none,
             arg("rigid") = none,
             ("How deeply do two solids penetrate?\n\n" + poses +
              "relative: ends once the interval's width is at most this fraction of its upper end (0.05).\n"
              "max_splits: most splits of each collision query of the search.\n\n"
              "Raises as collide(); MeshError for surfaces that are not closed.")
                 .c_str());
}

}  // namespace snug::python
