// Where surfaces touch, and where one meets itself.

#include <snug/contacts.h>
#include <snug/evaluate.h>

#include <algorithm>

#include "answers.h"
#include "call.h"
#include "poses.h"
#include "state.h"
#include "surface.h"
#include "witness.h"

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

// (n, 2, 3): lower and upper corners, as boxes() has them.
template <class T>
py::array boxes_of(const std::vector<T>& rows, const py::object& owner) {
  static_assert(sizeof(Box3) == 6 * sizeof(double));
  static constexpr double none = 0;
  const double* const data = rows.empty() ? &none : &rows[0].box.lower.x;
  return read_only<double>({static_cast<py::ssize_t>(rows.size()), 2, 3},
                           {sizeof(T), 3 * sizeof(double), sizeof(double)}, data, owner);
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

void add_regions(py::module_& module) {
  AnswerClass<ContactRegion> regions(module, "ContactRegions", "Connected parts of a contact, n in all.");
  regions
      .list(
          "verdict", [](const ContactRegion& t) { return py::str(name_of(t.verdict)); },
          "'intersecting': proved. 'within': the points are at most `within` apart. 'undecided': there may "
          "be no "
          "contact\n"
          "here.")
      .interval([](const ContactRegion& t) -> const Interval& { return t.distance; },
                "Lower end of an interval that contains the least distance in the region, (n,).",
                "Upper end of it, (n,).")
      .array<double>(
          "box", {2, 3},
          [](const ContactRegion& t, double* out) {
            for (const Point3& p : {t.box.lower, t.box.upper}) {
              for (std::size_t k = 0; k < 3; ++k) *out++ = p[k];
            }
          },
          "Lower and upper corners of a box around all points in contact, (n, 2, 3).")
      .list(
          "owners",
          [](const ContactRegion& t) {
            py::tuple both(2);
            for (std::size_t s = 0; s < 2; ++s)
              both[s] = py::array_t<std::uint32_t>(static_cast<py::ssize_t>(t.owners[s].size()),
                                                   t.owners[s].data());
            return both;
          },
          "Faces of A and of B (of dual schemes vertices), a pair of uint32 arrays; of n regions a list.");
  add_witness(regions, "The two closest points found, on A and on B, (n, 2, 3), world coordinates.");
  regions.repr([](const ContactRegion& t) {
    return std::string(name_of(t.verdict)) + ", distance " + text_of(t.distance);
  });
}

void add_curve(py::module_& module) {
  py::class_<IntersectionCurve> cls(
      module, "IntersectionCurve",
      "A curve in which two surfaces intersect: points, and boxes between them.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  cls.def_property_readonly(
         "points",
         [](const py::object& self) { return column(self.cast<const IntersectionCurve&>().points, self); },
         "(n, 3); the first point of a closed curve is not repeated.")
      .def_property_readonly(
          "boxes",
          [](const py::object& self) { return boxes_of(self.cast<const IntersectionCurve&>().boxes, self); },
          "Box i contains the curve between points i and i + 1, of a closed curve the last one leads back, "
          "(n, 2, "
          "3).")
      .def_property_readonly(
          "one_arc",
          [](const py::object& self) {
            return column(
                std::span<const CurveBox>(self.cast<const IntersectionCurve&>().boxes),
                [](const CurveBox& box) -> const bool& { return box.one_arc; }, self);
          },
          "Is it proved of each box that the surfaces cross in one arc there, from one point to the other? "
          "(n,) bool.")
      .def_property_readonly(
          "closed", [](const IntersectionCurve& self) { return self.closed; }, "Does it end where it begins?")
      .def_property_readonly(
          "proved", [](const IntersectionCurve& self) { return self.proved; },
          "Does each box contain one arc, and do consecutive arcs meet?")
      .def_property_readonly(
          "at_border",
          [](const IntersectionCurve& self) { return py::make_tuple(self.at_border[0], self.at_border[1]); },
          "Of an open curve: do its first and last point certainly lie on a border?")
      .def_property_readonly(
          "error", [](const IntersectionCurve& self) { return self.error; },
          "Upper bound of the distance between curve and polyline, either way.")
      .def_property_readonly(
          "region", [](const IntersectionCurve& self) { return self.region; }, "Which region it is in.")
      .def("__repr__", [](const IntersectionCurve& self) {
        return "<snug.IntersectionCurve of " + std::to_string(self.points.size()) + " points" +
               (self.closed ? ", closed" : "") + (self.proved ? ", proved>" : ">");
      });
}

void add_area(py::module_& module) {
  py::class_<ContactArea> cls(module, "ContactArea",
                              "What a plane face of A and one of B that touch have in common.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  cls.def_property_readonly(
         "points",
         [](const py::object& self) { return column(self.cast<const ContactArea&>().points, self); },
         "Corners of a convex polygon, ends of a segment, or a point, (n, 3).")
      .def_property_readonly(
          "error", [](const ContactArea& self) { return self.error; },
          "Upper bound, per coordinate, of how far they are from the exact ones.")
      .def_property_readonly(
          "faces", [](const ContactArea& self) { return py::make_tuple(self.faces[0], self.faces[1]); },
          "Of A and of B.")
      .def_property_readonly(
          "region", [](const ContactArea& self) { return self.region; }, "Which region it is in.")
      .def("__repr__", [](const ContactArea& self) {
        return "<snug.ContactArea of " + std::to_string(self.points.size()) + " points>";
      });
}

void add_all_contacts(py::module_& module) {
  add_regions(module);
  add_curve(module);
  add_area(module);
  py::class_<Contacts> cls(module, "Contacts",
                           "All contacts of two surfaces. bool() is True if one is proved, False if there is "
                           "none, and raises\nUndecidedError else.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  cls.def_property_readonly(
         "exhaustive", [](const Contacts& self) { return self.exhaustive; },
         "Do the lists hold all contacts? Not where the budget ended first.")
      .def_property_readonly(
          "outcome", [](const Contacts& self) { return name_of(self.outcome); },
          "'complete', or 'budget-spent' or 'at-rounding' where pieces stayed coarser than requested.")
      .def_property_readonly(
          "regions", [](const Contacts& self) { return Answers<ContactRegion>(self.regions); },
          "ContactRegions.")
      .def_property_readonly(
          "curves", [](const Contacts& self) { return list_of(self.curves); }, "A list of IntersectionCurve.")
      .def_property_readonly(
          "areas", [](const Contacts& self) { return list_of(self.areas); }, "A list of ContactArea.")
      .def_property_readonly(
          "open", [](const py::object& self) { return boxes_of(self.cast<const Contacts&>().open, self); },
          "Boxes in which the surfaces may meet in an unresolved way, (n, 2, 3).")
      .def("__bool__", touches)
      .def("__repr__", [](const Contacts& self) {
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

void add_pairs(py::module_& module) {
  AnswerClass<SelfContactPair> pairs(
      module, "SelfContactPairs",
      "Two places each of a surface that meet, are near each other, or could not be proved apart.");
  pairs
      .list(
          "verdict", [](const SelfContactPair& t) { return py::str(name_of(t.verdict)); },
          "'intersecting', 'near' or 'undecided'; of n pairs a list.")
      .interval([](const SelfContactPair& t) -> const Interval& { return t.distance; },
                "Lower end of an interval that contains the distance of the two pieces, (n,).",
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
               (self.pairs.empty() ? "" : ", " + number_of(self.pairs.size(), "place")) + ">";
      });
}

}  // namespace

void add_contacts(py::class_<PySurface>& surface, py::module_& module) {
  add_all_contacts(module);
  add_pairs(module);
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
