// Where a surface meets itself.

#include <snug/contacts.h>
#include <snug/evaluate.h>

#include <algorithm>

#include "answers.h"
#include "call.h"
#include "state.h"
#include "surface.h"
#include "witness.h"

namespace snug {

using python::Either;

auto members_of(Either<SelfContact> auto& t) {
  return std::tie(t.verdict, t.pairs, t.stars, t.pair_tests, t.radius, t.levels, t.outcome);
}

}  // namespace snug

namespace snug::python {
namespace {

SelfContact met_itself(const PySurface& self, const py::object& within, const py::object& radius,
                       const py::object& levels, const py::object& max_splits, const py::object& threads,
                       const py::object& progress) {
  const Surface surface = self.surface();
  SelfContactOptions options;
  options.within = length_of(within, surface.size(), "within");
  options.radius = length_of(radius, surface.size(), "radius");
  options.levels =
      static_cast<unsigned>(std::min<std::uint64_t>(count_of(levels, options.levels, "levels"), 1000));
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return self_contact(surface, options, run); });
}

bool meets(const SelfContact& self) {
  if (self.verdict == SelfVerdict::undecided) {
    refuse_undecided("undecided: " + std::to_string(self.pairs.size()) +
                     " places could not be proved apart, see .pairs" +
                     (self.outcome == Outcome::budget_spent ? "; give a larger max_splits" : ""));
  }
  return self.verdict != SelfVerdict::clear;
}

void add_pairs(py::module_& module) {
  AnswerClass<SelfContactPair> pairs(
      module, "SelfContactPairs",
      "Two places each of a surface that meet, are near each other, or could not be proved apart.");
  pairs
      .list(
          "verdict", [](const SelfContactPair& t) { return py::str(name_of(t.verdict)); },
          "'intersecting', 'near' or 'undecided'; of n pairs a list.")
      .view(
          "lower", [](const SelfContactPair& t) -> const double& { return t.distance.lower; },
          "Lower end of an interval that contains the distance of the two pieces, (n,).")
      .view(
          "upper", [](const SelfContactPair& t) -> const double& { return t.distance.upper; },
          "Upper end of it, (n,); both are 0 where the surface meets itself.")
      .array<bool>(
          "touching", {}, [](const SelfContactPair& t, bool* out) { *out = t.touching; },
          "Of facets: have they no point in common that is inside of both? (n,) bool.");
  add_witness(pairs, "Points on the two pieces, or on both sides of one that turns over, (n, 2, 3).");
  pairs.repr([](const SelfContactPair& t) { return std::string(name_of(t.verdict)); });
}

void add_self_contact(py::module_& module) {
  py::class_<SelfContact> cls(module, "SelfContact",
                              "Does a surface meet itself? bool() is True for 'intersecting' and 'near', "
                              "False for 'clear', and raises\n"
                              "UndecidedError for 'undecided'.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  cls.def_property_readonly(
         "verdict", [](const SelfContact& self) { return name_of(self.verdict); },
         "'clear': proved, no two parameters have one limit point. 'intersecting': proved. 'near': proved, "
         "two "
         "points at most\n"
         "`within` apart are farther apart than the radius along the surface. 'undecided'.")
      .def_property_readonly(
          "outcome", [](const SelfContact& self) { return name_of(self.outcome); },
          "'complete' unless undecided; else 'budget-spent' or 'at-rounding'.")
      .def_property_readonly(
          "pairs", [](const SelfContact& self) { return Answers<SelfContactPair>(self.pairs); },
          "The places that the verdict rests on, at most 100: SelfContactPairs; none if clear.")
      .def_property_readonly(
          "radius", [](const SelfContact& self) { return self.radius; },
          "The radius that was used; 0 without `within`.")
      .def_property_readonly(
          "stats",
          [](const SelfContact& self) {
            py::dict stats;
            stats["stars"] = self.stars;
            stats["pair_tests"] = self.pair_tests;
            stats["levels"] = self.levels;
            return stats;
          },
          "The work that was done, as a dict.")
      .def("__bool__", meets)
      .def("__repr__", [](const SelfContact& self) {
        return std::string("<snug.SelfContact ") + name_of(self.verdict) +
               (self.pairs.empty() ? "" : ", " + std::to_string(self.pairs.size()) + " places") + ">";
      });
}

}  // namespace

void add_contacts(py::class_<PySurface>& surface, py::module_& module) {
  add_pairs(module);
  add_self_contact(module);
  using py::arg;
  const py::object none = py::none();
  surface
      .def("self_contact", &met_itself, py::kw_only(), arg("within") = none, arg("radius") = none,
           arg("levels") = none, arg("max_splits") = none, arg("threads") = 0, arg("progress") = none,
           "Does the surface meet itself, or come near itself?\n\n"
           "within: also decide whether points at most this far apart are farther apart than `radius` along "
           "the surface, which\n"
           "is at least twice that, by default four times; mesh units or percent of the size. levels: most "
           "splits of the\n"
           "coarsest pieces that have a name (10). max_splits: most stars and pairs of pieces.\n\n"
           "Guarantee: 'clear', 'intersecting' and 'near' hold in exact arithmetic for the control points "
           "given.\n"
           "Raises ValueError, MeshError, OverflowError.")
      .def(
          "limit_to_faces",
          [](const PySurface& self, const py::object& threads, const py::object& progress) -> py::object {
            const Surface surface_of_self = self.surface();
            Call call(progress, run_of(threads));
            const std::optional<double> apart =
                call.run([&](const Run& run) { return limit_to_faces(surface_of_self, run); });
            return apart ? py::object(py::float_(*apart)) : py::object(py::none());
          },
          py::kw_only(), arg("threads") = 0, arg("progress") = none,
          "How far a limit point may be from the convex hull of its face's corners, mesh units: proved. 0 if "
          "all edges are\n"
          "sharp, None with a dual scheme. Raises OverflowError.");
}

}  // namespace snug::python
