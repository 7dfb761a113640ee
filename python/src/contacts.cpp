// Where surfaces touch, and where one meets itself.

#include <snug/contacts.h>
#include <snug/evaluate.h>

#include <algorithm>

#include "answers.h"
#include "call.h"
#include "fields.h"
#include "poses.h"
#include "state.h"
#include "surface.h"

namespace snug {

using python::Either;

auto members_of(Either<ContactRegion> auto& t) {
  return std::tie(t.verdict, t.contacts, t.owners[0], t.owners[1], t.box, t.distance, t.witness);
}
auto members_of(Either<IntersectionCurve> auto& t) {
  return std::tie(t.points, t.boxes, t.closed, t.proved, t.at_border, t.error, t.region);
}
auto members_of(Either<ContactArea> auto& t) { return std::tie(t.points, t.error, t.faces, t.region); }
auto members_of(Either<Contacts> auto& t) {
  return std::tie(t.outcome, t.exhaustive, t.regions, t.curves, t.areas, t.open, t.stats, t.compared);
}
auto members_of(Either<SelfContact> auto& t) {
  return std::tie(t.verdict, t.pairs, t.stars, t.pair_tests, t.radius, t.levels, t.outcome);
}

}  // namespace snug

namespace snug::python {
namespace {

// All contacts of two surfaces.

Contacts contacts_of(const PySurface& py_a, const PySurface& py_b, const py::object& pose_a,
                     const py::object& pose_b, const py::object& within, const py::object& error, bool curves,
                     const py::object& max_splits, const py::object& threads, const py::object& progress,
                     const py::object& rigid) {
  const Surface a = py_a.surface(), b = py_b.surface();
  const PlacedSurface placed_a(a, pose_of(pose_a, "pose_a", rigid)),
      placed_b(b, pose_of(pose_b, "pose_b", rigid));
  const double size = std::max(a.size(), b.size());
  ContactsOptions options;
  options.within = length_of(within, size, "within");
  options.error = length_of(error, size, "error");
  options.curves = curves;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return contacts(placed_a, placed_b, options, run); });
}

std::string number_of(std::size_t count, const std::string& one, const std::string& many = "") {
  return std::to_string(count) + " " + (count == 1 ? one : many.empty() ? one + "s" : many);
}

bool touches(const Contacts& self) {
  for (const ContactRegion& region : self.regions) {
    if (region.verdict != Verdict::undecided) return true;
  }
  if (!self.regions.empty() || !self.exhaustive) {
    refuse_undecided("undecided: " + number_of(self.regions.size(), "region") +
                     " in which nothing is proved, see .regions" +
                     (self.exhaustive ? "" : "; give a larger max_splits"));
  }
  return false;
}

void add_all_contacts(py::module_& module) {
  AnswerClass<ContactRegion> regions(module, "ContactRegions", "Connected parts of a contact, n in all.");
  regions.fields().repr([](const ContactRegion& t) {
    return std::string(name_of(t.verdict)) + ", distance " + text_of(t.distance);
  });
  py::class_<IntersectionCurve> curve(
      module, "IntersectionCurve",
      "A curve in which two surfaces intersect: points, and boxes between them.");
  add_fields(curve);
  curve.def_property_readonly(
      "one_arc",
      [](const py::object& self) {
        return column(
            std::span<const CurveBox>(self.cast<const IntersectionCurve&>().boxes),
            [](const CurveBox& box) -> const bool& { return box.one_arc; }, self);
      },
      "Is it proved of each box that the surfaces cross in one arc there, from one point to the other? "
      "(n,) bool.");
  curve.def("__repr__", [](const IntersectionCurve& self) {
    return "<snug.IntersectionCurve of " + std::to_string(self.points.size()) + " points" +
           (self.closed ? ", closed" : "") + (self.proved ? ", proved>" : ">");
  });
  py::class_<ContactArea> area(module, "ContactArea",
                               "What a plane face of A and one of B that touch have in common.");
  add_fields(area);
  area.def("__repr__", [](const ContactArea& self) {
    return "<snug.ContactArea of " + std::to_string(self.points.size()) + " points>";
  });
  py::class_<Contacts> cls(module, "Contacts",
                           "All contacts of two surfaces. bool() is True if one is proved, False if there is "
                           "none, and raises\nUndecidedError else.");
  add_fields(cls);
  cls.def("__bool__", touches).def("__repr__", [](const Contacts& self) {
    return "<snug.Contacts: " + number_of(self.regions.size(), "region") + ", " +
           number_of(self.curves.size(), "curve") + ", " + number_of(self.areas.size(), "area") + ", " +
           number_of(self.open.size(), "open box", "open boxes") + ">";
  });
}

// One surface and itself.

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
    refuse_undecided("undecided: " + number_of(self.pairs.size(), "place") +
                     " could not be proved apart, see .pairs" +
                     (self.outcome == Outcome::budget_spent ? "; give a larger max_splits" : ""));
  }
  return self.verdict != SelfVerdict::clear;
}

void add_self_contact(py::module_& module) {
  AnswerClass<SelfContactPair> pairs(
      module, "SelfContactPairs",
      "Two places each of a surface that meet, are near each other, or could not be proved apart.");
  pairs.fields().repr([](const SelfContactPair& t) { return std::string(name_of(t.verdict)); });
  py::class_<SelfContact> cls(module, "SelfContact",
                              "Does a surface meet itself? bool() is True for 'intersecting' and 'near', "
                              "False for 'clear', and raises\n"
                              "UndecidedError for 'undecided'.");
  add_fields(cls);
  cls.def("__bool__", meets).def("__repr__", [](const SelfContact& self) {
    return std::string("<snug.SelfContact ") + name_of(self.verdict) +
           (self.pairs.empty() ? "" : ", " + number_of(self.pairs.size(), "place")) + ">";
  });
}

}  // namespace

void add_contacts(py::class_<PySurface>& surface, py::module_& module) {
  add_all_contacts(module);
  add_self_contact(module);
  using py::arg;
  const py::object none = py::none();
  module.def(
      "contacts", &contacts_of, arg("a"), arg("b"), py::kw_only(), arg("pose_a") = none, arg("pose_b") = none,
      arg("within") = none, arg("error") = none, arg("curves") = true, arg("max_splits") = none,
      arg("threads") = 0, arg("progress") = none, arg("rigid") = none,
      "Where do two limit surfaces touch, and along which curves do they intersect?\n\n"
      "pose_a, pose_b: one pose each, as collide() takes it. within: points this close are in contact. "
      "error: how far a curve\n"
      "may be from its polyline. Both are mesh units, or percent of the larger surface's size, by default "
      "0.1 %. curves:\n"
      "look for them. max_splits: most pairs of pieces compared.\n\n"
      "Guarantee: if `exhaustive`, points at most `within` apart lie on faces of a region, and common points "
      "in a box of a\n"
      "curve, an area, or an open box. Raises ValueError, PoseError, MeshError, OverflowError.");
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
