// Things made from a surface: bounds, boxes, triangles, hulls, measures, deviations, refined meshes.

#include <cmath>

#include <snug/bound.h>
#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/hull.h>
#include <snug/measure.h>
#include <snug/tessellate.h>

#include "answers.h"
#include "call.h"
#include "fields.h"
#include "surface.h"

namespace snug {

// Members to pickle of the structs that own memory; looked up beside them.
using python::Either;

auto members_of(Either<PatchEnclosure> auto& t) {
  return std::tie(t.patch, t.piece, t.level, t.corners, t.offset, t.interval, t.normals);
}
auto members_of(Either<Tessellation> auto& t) {
  return std::tie(t.positions, t.normals, t.parameters, t.position_error, t.triangles, t.owners, t.corners,
                  t.error_bound, t.outcome);
}
auto members_of(Either<Hull> auto& t) { return std::tie(t.positions, t.triangles, t.owners, t.gap); }
auto members_of(Either<Envelope> auto& t) {
  return std::tie(t.positions, t.triangles, t.error, t.clearance, t.bridges, t.bridge_distance, t.volume,
                  t.outcome, t.problems);
}
auto members_of(Either<Hulls> auto& t) { return std::tie(t.inner, t.outer, t.outcome, t.problems, t.closed); }

}  // namespace snug

namespace snug::python {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Bounds.

struct Enclosures {
  std::vector<PatchEnclosure> pieces;
  std::vector<NormalCone> cones;  // of each piece: NaN where none is proved
  BoundSummary summary;
};
auto members_of(Either<Enclosures> auto& t) { return std::tie(t.pieces, t.cones, t.summary); }

Enclosures bounded(const PySurface& self, const py::object& error, unsigned level, bool normals,
                   const py::object& max_splits, const py::object& threads, const py::object& progress) {
  const Surface surface = self.surface();
  BoundOptions options;
  options.error = length_of(error, surface.size(), "error");
  options.level = level;
  options.normals = normals;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) {
    Enclosures result;
    result.summary = bound(
        surface, options,
        [&](const PatchEnclosure& piece) {
          result.pieces.push_back(piece);
          result.cones.push_back(piece.normals.value_or(NormalCone{{nan, nan, nan}, nan}));
        },
        run);
    return result;
  });
}

// Boxes of owners; visit(add) calls add(owner, box) for each box that one has.
template <class Visit>
py::array boxes_by_owner(const Surface& surface, const Visit& visit) {
  const bool dual = surface.scheme() == Scheme::doo_sabin || surface.scheme() == Scheme::midedge;
  std::vector<Box3> boxes(dual ? surface.mesh().vertex_count() : surface.mesh().face_count());
  visit([&](std::uint32_t owner, const Box3& box) {
    if (owner >= boxes.size()) boxes.resize(owner + 1);
    boxes[owner].add(box);
  });
  py::array_t<double> result({static_cast<py::ssize_t>(boxes.size()), py::ssize_t{2}, py::ssize_t{3}});
  double* out = result.mutable_data();
  for (const Box3& box : boxes) {
    for (const Point3& p : {box.lower, box.upper}) {
      for (std::size_t k = 0; k < 3; ++k) *out++ = box.empty() ? nan : p[k];
    }
  }
  return result;
}

// The box of an interval triangle is exact: its corners are those of boxes.
py::array boxes_of(const PySurface& self, unsigned level, const py::object& threads) {
  const PySurface taken = self;  // which an update() meanwhile does not reach
  const Enclosures enclosures = bounded(taken, py::none(), level, false, py::none(), threads, py::none());
  return boxes_by_owner(taken.surface(), [&](const auto& add) {
    for (const PatchEnclosure& piece : enclosures.pieces) {
      for (const Box3& corner : piece.interval.corner) add(piece.patch.owner, corner);
    }
  });
}

py::array boxes_until(const PySurface& self, const py::object& end, unsigned level,
                      const py::object& threads) {
  if (level != 0) throw py::value_error("boxes: with end, level is 0");
  const Surface surface = self.surface();
  const Points points(end, "end");
  Call call(py::none(), run_of(threads));
  std::vector<PatchPlace> patches;
  std::vector<Box3> boxes;
  call.run([&](const Run& run) {
    PatchBounds bounds(surface, run);
    patches.assign(bounds.patches().begin(), bounds.patches().end());
    boxes.resize(patches.size());
    bounds.update(surface.mesh().points, points.all(), boxes, run);
  });
  return boxes_by_owner(surface, [&](const auto& add) {
    for (std::size_t i = 0; i < patches.size(); ++i) add(patches[i].owner, boxes[i]);
  });
}

void add_enclosures(py::module_& module) {
  py::class_<Enclosures> cls(module, "Enclosures",
                             "Sets that contain the pieces of a surface, n in all, in mesh units.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  const auto view = [&](const char* name, const auto& member, const char* doc) {
    cls.def_property_readonly(
        name,
        [member](const py::object& self) {
          return column(std::span<const PatchEnclosure>(self.cast<const Enclosures&>().pieces), member, self);
        },
        doc);
  };
  view(
      "face", [](const PatchEnclosure& t) -> const std::uint32_t& { return t.patch.owner; },
      "The piece's face (of dual schemes vertex), (n,) uint32.");
  view(
      "part", [](const PatchEnclosure& t) -> const std::uint32_t& { return t.patch.part; },
      "Which patch of the face, (n,) uint32.");
  view(
      "level", [](const PatchEnclosure& t) -> const unsigned& { return t.level; },
      "Number of splits, (n,) uint32.");
  view(
      "base", [](const PatchEnclosure& t) -> const Triangle& { return t.offset.base; },
      "Triangles: the piece is within `radius` of its own, (n, 3, 3).");
  view(
      "radius", [](const PatchEnclosure& t) -> const double& { return t.offset.radius; }, "(n,)");
  view(
      "corners", [](const PatchEnclosure& t) -> const Triangle& { return t.corners; },
      "Limit corners in double precision, for pictures, (n, 3, 3).");
  // The boxes of an interval triangle: (lower, upper) each.
  const auto box_view = [&](const char* name, std::size_t upper, const char* doc) {
    cls.def_property_readonly(
        name,
        [upper](const py::object& object) {
          const std::vector<PatchEnclosure>& pieces = object.cast<const Enclosures&>().pieces;
          static_assert(sizeof(Box3) == 6 * sizeof(double));
          static constexpr double none = 0;
          const double* const data =
              pieces.empty() ? &none : &pieces[0].interval.corner[0].lower.x + 3 * upper;
          return read_only<double>({static_cast<py::ssize_t>(pieces.size()), 3, 3},
                                   {sizeof(PatchEnclosure), sizeof(Box3), sizeof(double)}, data, object);
        },
        doc);
  };
  box_view("lower", 0, "Lower corners of three boxes whose convex hull contains the piece, (n, 3, 3).");
  box_view("upper", 1, "Upper corners of these boxes, (n, 3, 3).");
  const auto cone_view = [&](const char* name, const auto& member, const char* doc) {
    cls.def_property_readonly(
        name,
        [member](const py::object& self) {
          return column(std::span<const NormalCone>(self.cast<const Enclosures&>().cones), member, self);
        },
        doc);
  };
  cone_view(
      "axis", [](const NormalCone& cone) -> const Vector3& { return cone.axis; },
      "With normals=True: the surface has a normal at every point of the piece, at most `angle` from this "
      "axis, (n, 3); NaN where that\n"
      "is not proved.");
  cone_view(
      "angle", [](const NormalCone& cone) -> const double& { return cone.angle; },
      "In radians, (n,); NaN likewise.");
  cls.def_property_readonly(
         "pieces",
         [](const Enclosures& self) {
           py::list names;
           for (const PatchEnclosure& piece : self.pieces) names.append(piece.piece);
           return names;
         },
         "Which piece of its patch: a list of words with a digit for each split.")
      .def_property_readonly(
          "outcome", [](const Enclosures& self) { return name_of(self.summary.outcome); },
          "'complete', 'budget-spent', or 'at-rounding' where 60 levels or rounding ended splitting.")
      .def_property_readonly(
          "max_radius", [](const Enclosures& self) { return self.summary.max_radius; }, "The largest radius.")
      .def_property_readonly(
          "splits", [](const Enclosures& self) { return self.summary.splits; }, "Splits in all.")
      .def("__len__", [](const Enclosures& self) { return self.pieces.size(); })
      .def("__repr__", [](const Enclosures& self) {
        return "<snug.Enclosures of " + std::to_string(self.pieces.size()) + " pieces, radius at most " +
               text_at_most(self.summary.max_radius) + ">";
      });
}

// Triangles.

// Under the names of other libraries, too.
template <class T>
void add_triangles(py::class_<T>& cls) {
  add_fields(cls);
  cls.def_property_readonly(
         "vertices", [](const py::object& self) { return column(self.cast<const T&>().positions, self); },
         "The same as `positions`: corners, (n, 3) float64, mesh units.")
      .def_property_readonly(
          "faces", [](const py::object& self) { return column(self.cast<const T&>().triangles, self); },
          "The same as `triangles`, (m, 3) uint32.");
}

Tessellation tessellated(const PySurface& self, const py::object& error, const py::object& max_edge,
                         const py::object& max_angle, const py::object& view, const py::object& max_thickness,
                         const py::object& max_triangles, bool single_precision, bool normals, bool corners,
                         const py::object& max_splits, const py::object& threads,
                         const py::object& progress) {
  const Surface surface = self.surface();
  TessellateOptions options;
  options.error = length_of(error, surface.size(), "error");
  options.max_edge = length_of(max_edge, surface.size(), "max_edge");
  options.max_angle = number_of(max_angle, "max_angle");
  if (!view.is_none()) {
    if (!PyTuple_Check(view.ptr()) || PyTuple_GET_SIZE(view.ptr()) != 2) {
      throw InputError(InputProblem::value, "view: give a tuple (eye, degrees)");
    }
    const Points eye(py::handle(PyTuple_GET_ITEM(view.ptr(), 0)), "view");
    if (!eye.single()) throw InputError(InputProblem::value, "view: the eye is one point (3,)");
    options.view = Viewpoint{
        eye.all()[0],
        number_of(py::reinterpret_borrow<py::object>(PyTuple_GET_ITEM(view.ptr(), 1)), "view").value_or(0)};
  }
  options.max_thickness = length_of(max_thickness, surface.size(), "max_thickness");
  if (!max_triangles.is_none()) options.max_triangles = count_of(max_triangles, 0, "max_triangles");
  options.single_precision = single_precision;
  options.normals = normals;
  options.corners = corners;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return tessellate(surface, options, run); });
}

const Place& itself(const Place& at) { return at; }

void add_tessellation(py::module_& module) {
  py::class_<Tessellation> cls(module, "Tessellation", "Triangles near a surface, without cracks.");
  add_triangles(cls);
  add_columns<Place>(Field{"parameters", &itself, ""}, [&](const char* name, const auto& member,
                                                           const std::string& doc) {
    cls.def_property_readonly(
        name,
        [member](const py::object& self) {
          return column(std::span<const Place>(self.cast<const Tessellation&>().parameters), member, self);
        },
        doc.c_str());
  });
  cls.def_property_readonly(
         "corner_parameters",
         [](const py::object& object) {
           const auto& corners = object.cast<const Tessellation&>().corners;
           static constexpr double none = 0;
           const double* const data = corners.empty() ? &none : &corners[0][0].u;
           static_assert(offsetof(Place, v) == offsetof(Place, u) + sizeof(double));
           return read_only<double>({static_cast<py::ssize_t>(corners.size()), 3, 2},
                                    {3 * sizeof(Place), sizeof(Place), sizeof(double)}, data, object);
         },
         "u, v of each triangle's corners on its own face, (m, 3, 2); empty without corners=True.")
      .def_property_readonly(
          "corner_corners",
          [](const py::object& object) {
            return column(
                std::span<const std::array<Place, 3>>(object.cast<const Tessellation&>().corners),
                [](const std::array<Place, 3>& t) -> const std::uint32_t& { return t[0].corner; }, object);
          },
          "The `corner` that these belong to, (m,) uint32; empty without corners=True.")
      .def("__repr__", [](const Tessellation& self) {
        return "<snug.Tessellation of " + std::to_string(self.triangles.size()) +
               " triangles, error at most " + text_at_most(self.error_bound) + ">";
      });
}

// Hulls.

Hulls hulls_of(const PySurface& self, const py::object& error, bool inner, bool outer,
               const py::object& max_splits, bool single_precision, const py::object& threads,
               const py::object& progress) {
  const Surface surface = self.surface();
  HullOptions options;
  options.error = length_of(error, surface.size(), "error");
  options.inner = inner;
  options.outer = outer;
  options.single_precision = single_precision;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return hull(surface, options, run); });
}

Envelope envelope_of(const PySurface& self, const py::object& error, const py::object& clearance,
                     const py::object& gap, const py::object& max_splits, bool single_precision,
                     const py::object& threads, const py::object& progress) {
  const Surface surface = self.surface();
  EnvelopeOptions options;
  options.error = length_of(error, surface.size(), "error");
  options.clearance = length_of(clearance, surface.size(), "clearance");
  options.gap = length_of(gap, surface.size(), "gap");
  options.single_precision = single_precision;
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return envelope(surface, options, run); });
}

void add_envelope(py::module_& module) {
  py::class_<Envelope> cls(module, "Envelope", "A closed mesh around a surface.");
  add_triangles(cls);
  cls.def("__repr__", [](const Envelope& self) {
    return "<snug.Envelope of " + std::to_string(self.triangles.size()) + " triangles, from " +
           text_at_least(self.clearance) + " to " + text_at_most(self.error) + ">";
  });
}

void add_hulls(py::module_& module) {
  py::class_<Hull> hull(module, "Hull", "Triangles on one side of a surface.");
  add_triangles(hull);
  hull.def("__repr__", [](const Hull& self) {
    return "<snug.Hull of " + std::to_string(self.triangles.size()) + " triangles, gap " +
           text_at_most(self.gap) + ">";
  });
  py::class_<Hulls> cls(module, "Hulls", "The inner and the outer hull of a surface: inner, outer = hulls.");
  add_fields(cls);
  cls.def("__iter__",
          [](const py::object& self) {
            return py::iter(py::make_tuple(self.attr("inner"), self.attr("outer")));
          })
      .def("__repr__",
           [](const Hulls& self) { return std::string("<snug.Hulls ") + name_of(self.outcome) + ">"; });
}

// Measures.

Measures measured(const PySurface& self, const py::object& relative, const py::object& max_splits,
                  const py::object& threads, const py::object& progress) {
  const Surface surface = self.surface();
  MeasureOptions options;
  options.relative = number_of(relative, "relative");
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return measure(surface, options, run); });
}

void add_measures(py::module_& module) {
  py::class_<Measures> cls(module, "Measures", "Intervals (lower, upper) that contain the exact values.");
  add_fields(cls);
  cls.def("__repr__", [](const Measures& self) {
    return "<snug.Measures area " + text_of(self.area) +
           (self.volume ? ", volume " + text_of(*self.volume) : "") + ">";
  });
}

// Deviations.

Deviation deviation_of(const PySurface& self, const py::object& candidate, const py::object& absolute,
                       const py::object& threshold, bool solid, const py::object& max_splits,
                       const py::object& threads, const py::object& progress) {
  const Surface surface = self.surface();
  DeviationOptions options;
  options.absolute = length_of(absolute, surface.size(), "absolute");
  options.threshold = length_of(threshold, surface.size(), "threshold");
  options.solid = solid;
  if (py::isinstance<PySurface>(candidate)) {
    const Surface other = candidate.cast<const PySurface&>().surface();
    Call call(progress, run_of(threads, max_splits));
    return call.run([&](const Run& run) { return deviation(surface, other, options, run); });
  }
  const Doubles corners(convert("triangles")(candidate), "mesh");
  static_assert(sizeof(Triangle) == 9 * sizeof(double));
  const std::span<const Triangle> triangles(reinterpret_cast<const Triangle*>(corners.data()),
                                            corners.extent(0));  // NOLINT
  Call call(progress, run_of(threads, max_splits));
  return call.run([&](const Run& run) { return deviation(surface, triangles, options, run); });
}

void add_deviation(py::module_& module) {
  AnswerClass<OneSidedDistance> one(module, "OneSidedDistance",
                                    "The greatest distance of a point of one set from the other set.");
  one.fields().repr([](const OneSidedDistance& t) { return text_of(t.distance); });
  py::class_<Deviation> cls(module, "Deviation",
                            "How far a surface and a candidate that is to stand for it deviate.");
  add_fields(cls);
  cls.def("__repr__", [](const Deviation& self) {
    return "<snug.Deviation from surface " + text_of(self.from_surface.distance) + ", from candidate " +
           text_of(self.from_candidate.distance) + ">";
  });
}

PyMesh refined(const PySurface& self, const py::object& level, bool limit, const py::object& progress) {
  const Surface surface = self.surface();
  const std::uint64_t steps = std::min<std::uint64_t>(count_of(level, 0, "level"), 64);
  Call call(progress);
  return call.run([&](const Run& run) {
    PyMesh result{subdivided(surface.mesh(), static_cast<unsigned>(steps), limit,
                             {.scheme = surface.scheme(), .boundary = surface.boundary()}, run)};
    // At limit positions it is a control mesh no longer.
    result.mesh.tags.scheme = limit ? std::nullopt : std::optional(surface.scheme());
    return result;
  });
}

}  // namespace

void add_shapes(py::class_<PySurface>& surface, py::module_& module) {
  add_enclosures(module);
  add_tessellation(module);
  add_hulls(module);
  add_envelope(module);
  add_measures(module);
  add_deviation(module);
  using py::arg;
  const py::object none = py::none();
  surface
      .def(
          "bound",
          [](const PySurface& self, const py::object& error, const py::object& level, bool normals,
             const py::object& max_splits, const py::object& threads, const py::object& progress) {
            const auto splits =
                static_cast<unsigned>(std::min<std::uint64_t>(count_of(level, 0, "level"), 1000));
            return bounded(self, error, splits, normals, max_splits, threads, progress);
          },
          py::kw_only(), arg("error") = none, arg("level") = 0, arg("normals") = false,
          arg("max_splits") = none, arg("threads") = 0, arg("progress") = none,
          "Sets that contain the whole surface, piece by piece.\n\n"
          "error: split until each radius is at most half of it; mesh units or percent of the size. "
          "Without one every\n"
          "patch is split `level` times. normals: cones of normals, too. max_splits: most splits in all.\n\n"
          "Guarantee: every limit point of a patch lies in the union of its pieces' sets. Raises ValueError, "
          "OverflowError.")
      .def(
          "boxes",
          [](const PySurface& self, const py::object& given, const py::object& end,
             const py::object& threads) {
            const auto level =
                static_cast<unsigned>(std::min<std::uint64_t>(count_of(given, 0, "level"), 1000));
            return end.is_none() ? boxes_of(self, level, threads) : boxes_until(self, end, level, threads);
          },
          arg("level") = 0, py::kw_only(), arg("end") = none, arg("threads") = 0,
          "A box around the surface of each face (of dual schemes vertex), (n, 2, 3): lower and upper "
          "corners; NaN where it\n"
          "has no surface. level: split so often first, for tighter boxes. end: vertices (n, 3) to which the "
          "control points move along\n"
          "lines; the boxes hold the surface all the time. Proved.")
      .def("tessellate", &tessellated, arg("error") = none, py::kw_only(), arg("max_edge") = none,
           arg("max_angle") = none, arg("view") = none, arg("max_thickness") = none,
           arg("max_triangles") = none, arg("single_precision") = false, arg("normals") = true,
           arg("corners") = false, arg("max_splits") = none, arg("threads") = 0, arg("progress") = none,
           "Triangles near the surface, without cracks.\n\n"
           "error: largest distance between the two, either way. max_edge: longest edge. max_angle: "
           "degrees between normals.\n"
           "view: (eye, degrees), from where no error is seen under a larger angle. max_thickness: of "
           "pieces. max_triangles: the\n"
           "smallest error for so many. Lengths are mesh units, or percent of the size.\n\n"
           "Raises ValueError, OverflowError.")
      .def("hull", &hulls_of, arg("error") = none, py::kw_only(), arg("inner") = true, arg("outer") = true,
           arg("max_splits") = none, arg("single_precision") = false, arg("threads") = 0,
           arg("progress") = none,
           "Two meshes that sandwich the surface, at most `error` from it (1 % of the size): inner, outer = "
           "surface.hull(\"0.5%\").\n"
           "What is guaranteed holds if .outcome is 'complete'. Raises ValueError, MeshError, OverflowError.")
      .def("envelope", &envelope_of, arg("error") = none, py::kw_only(), arg("clearance") = none,
           arg("gap") = none, arg("max_splits") = none, arg("single_precision") = false, arg("threads") = 0,
           arg("progress") = none,
           "A closed mesh around the surface, whatever it is: at most `error` (1 % of the size) and at least "
           "`clearance` (a "
           "quarter of that) from it. gap: what no ball of this diameter gets into from outside is filled.\n"
           "What is guaranteed holds if .outcome is 'complete'. Raises ValueError, MeshError, OverflowError.")
      .def("measure", &measured, py::kw_only(), arg("relative") = none, arg("max_splits") = none,
           arg("threads") = 0, arg("progress") = none,
           "Area, and of a closed surface volume, centroid and inertia, as intervals.\n"
           "relative: how narrow (0.0001). Raises ValueError, MeshError, OverflowError.")
      .def(
          "subdivided", &refined, arg("level") = 1, arg("limit") = false, py::kw_only(),
          arg("progress") = none,
          "The control mesh after `level` steps of subdivision, a Mesh; with limit=True at limit positions.\n"
          "Raises ValueError, MeshError, OverflowError.");
  module.def("deviation", &deviation_of, arg("surface"), arg("candidate"), py::kw_only(),
             arg("absolute") = none, arg("threshold") = none, arg("solid") = false, arg("max_splits") = none,
             arg("threads") = 0, arg("progress") = none,
             "How far a surface and a candidate deviate: a Surface, or triangles as for Surface(mesh) or (n, "
             "3, 3) corners.\n\n"
             "absolute: how narrow the intervals become; by default 0.01 % of the size. threshold: only "
             "decide which distances exceed\n"
             "it. solid: also how far the candidate lies inside and outside.\n\n"
             "Raises ValueError, MeshError, OverflowError.");
}

}  // namespace snug::python
