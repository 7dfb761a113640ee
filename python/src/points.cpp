// One surface and points, rays, parameters: closest_point, signed_distance, contains, ray, evaluate.

#include <algorithm>
#include <cmath>

#include <snug/distance.h>
#include <snug/evaluate.h>
#include <snug/ray.h>

#include "answers.h"
#include "call.h"
#include "certificate.h"
#include "fields.h"
#include "state.h"
#include "surface.h"

namespace snug::python {
namespace {

// One answer, or one for each point.
template <class T, class One, class Many>
Answers<T> for_points(const PySurface& self, const py::object& given, const py::object& progress,
                      const Run& run, const One& one, const Many& many) {
  const Surface surface = self.surface();
  const Points points(given, "points");
  Call call(progress, run);
  return call.run([&](const Run& each) {
    if (points.single()) return Answers<T>(one(surface, points.all()[0], each));
    return Answers<T>(many(surface, points.all(), each));
  });
}

// work(begin, count) on [0, n), block by block, for what the library does not stop in between.
template <class Work>
void in_blocks(std::size_t n, const Run& run, const Work& work) {
  constexpr std::size_t most = std::size_t{1} << 18;  // a quarter of a second at most
  for (std::size_t begin = 0; begin < n; begin += most) {
    run.monitor->report(static_cast<double>(begin) / static_cast<double>(n));
    work(begin, std::min(most, n - begin));
  }
}

Precision precision_of(const PySurface& self, const py::object& relative, const py::object& absolute) {
  Precision options;
  options.relative = number_of(relative, "relative");
  options.absolute = length_of(absolute, self.surface().size(), "absolute");
  return options;
}

Answers<ClosestPoint> closest(const PySurface& self, const py::object& points, const py::object& relative,
                              const py::object& absolute, const py::object& witness,
                              const py::object& max_splits, const py::object& threads,
                              const py::object& progress, const py::object& certificate) {
  CertificateFile file(certificate);
  Precision options = precision_of(self, relative, absolute);
  options.witness = witness_kind(witness);
  return file.written(for_points<ClosestPoint>(
      self, points, progress, file.with(run_of(threads, max_splits)),
      [&](const Surface& surface, const Point3& p, const Run& run) {
        return closest_point(surface, p, options, run);
      },
      [&](const Surface& surface, std::span<const Point3> all, const Run& run) {
        return closest_point(surface, all, options, run);
      }));
}

Answers<SignedDistance> signed_of(const PySurface& self, const py::object& points, const py::object& relative,
                                  const py::object& absolute, const py::object& max_splits,
                                  const py::object& threads, const py::object& progress,
                                  const py::object& certificate) {
  CertificateFile file(certificate);
  const Precision options = precision_of(self, relative, absolute);
  return file.written(for_points<SignedDistance>(
      self, points, progress, file.with(run_of(threads, max_splits)),
      [&](const Surface& surface, const Point3& p, const Run& run) {
        return signed_distance(surface, p, options, run);
      },
      [&](const Surface& surface, std::span<const Point3> all, const Run& run) {
        return signed_distance(surface, all, options, run);
      }));
}

/// Is a point inside? 1, 0, or -1 where that cannot be told.
struct Side {
  std::int8_t inside;
};

Side side_of(const std::optional<bool>& inside) { return {static_cast<std::int8_t>(inside ? *inside : -1)}; }

Answers<Side> contained(const PySurface& self, const py::object& points, const py::object& threads,
                        const py::object& progress, const py::object& certificate) {
  CertificateFile file(certificate);
  return file.written(for_points<Side>(
      self, points, progress, file.with(run_of(threads)),
      [](const Surface& surface, const Point3& p, const Run& run) {
        return side_of(contains(surface, p, run));
      },
      [&](const Surface& surface, std::span<const Point3> all, const Run& run) {
        const std::vector<std::optional<bool>> inside = contains(surface, all, run);
        std::vector<Side> sides(inside.size());
        std::ranges::transform(inside, sides.begin(), side_of);
        return sides;
      }));
}

void add_closest(py::module_& module) {
  AnswerClass<ClosestPoint> answers(module, "ClosestPoint",
                                    "The closest point of a surface: of one point, or of each of n.");
  answers.fields().repr([](const ClosestPoint& t) {
    return "distance " + text_of(t.distance) + ", face " + std::to_string(t.at->owner);
  });
  AnswerClass<SignedDistance> signed_answers(
      module, "SignedDistance",
      "How far one point, or each of n, is from a closed surface: negative inside.");
  signed_answers.fields().repr([](const SignedDistance& t) { return text_of(t.distance); });
}

void add_containment(py::module_& module) {
  AnswerClass<Side> answers(
      module, "Containment",
      "Is one point, or each of n, inside of a closed surface? bool() of one raises UndecidedError where it\n"
      "cannot be told: on the surface and within rounding of it.");
  const auto mask = [&](const char* name, std::int8_t value, const char* doc) {
    answers.array<bool>(
        name, {}, [value](const Side& t, bool* out) { *out = t.inside == value; }, doc);
  };
  mask("inside", 1, "Proved to be inside, (n,) bool.");
  mask("outside", 0, "Proved to be outside, (n,) bool.");
  mask("undecided", -1, "On the surface or within rounding of it, (n,) bool.");
  answers.python().def("__bool__", [](const Answers<Side>& self) {
    if (!self.single()) {
      throw py::value_error(
          "The truth value of an array with more than one element is ambiguous. Use .inside or .outside");
    }
    if (self.one().inside < 0)
      refuse_undecided("undecided: the point is on the surface, or within rounding of it");
    return self.one().inside == 1;
  });
  answers.repr([](const Side& t) {
    return std::string(t.inside < 0 ? "undecided" : t.inside == 1 ? "inside" : "outside");
  });
}

// Rays.

/// The hits of all rays, by ray and t.
struct Hits {
  bool single = false;
  std::vector<RayHit> hits;
  std::vector<Vector3> normals;  // NaN where there is none
  std::vector<std::int64_t> ray;
  std::vector<std::uint8_t> outcome, certain_hit, certain_miss;
};

auto members_of(Either<Hits> auto& t) {
  return std::tie(t.single, t.hits, t.normals, t.ray, t.outcome, t.certain_hit, t.certain_miss);
}

struct RayInput {
  RayInput(const py::object& origins, const py::object& directions)
      : from(origins, "origins"), along(directions, "directions") {
    if (!from.single() && !along.single() && from.all().size() != along.all().size()) {
      throw InputError(InputProblem::value,
                       "origins has " + std::to_string(from.all().size()) + " points and directions has " +
                           std::to_string(along.all().size()) + "; give as many, or one of either");
    }
  }
  [[nodiscard]] bool single() const { return from.single() && along.single(); }
  [[nodiscard]] std::size_t count() const { return from.single() ? along.all().size() : from.all().size(); }
  [[nodiscard]] std::vector<Ray> rays(std::size_t begin, std::size_t n, const WorkMonitor& monitor) const {
    const std::span<const Point3> o = from.all(), d = along.all();
    std::vector<Ray> result;
    result.reserve(n);
    for (std::size_t i = begin; i < begin + n; ++i) {
      if (i % 65536 == 0) monitor.checkpoint();
      const Point3& direction = d[along.single() ? 0 : i];
      result.push_back(
          {.origin = o[from.single() ? 0 : i], .direction = {direction.x, direction.y, direction.z}});
    }
    return result;
  }

  Points from, along;
};

Hits traced(const PySurface& self, const RayInput& input, const RayOptions& options, const Run& how,
            const py::object& progress) {
  const Surface surface = self.surface();
  Call call(progress, how);
  return call.run([&](const Run& run) {
    const std::vector<RayHits> all = ray(surface, input.rays(0, input.count(), *run.monitor), options, run);
    Hits result;
    result.single = input.single();
    for (std::size_t i = 0; i < all.size(); ++i) {
      result.outcome.push_back(static_cast<std::uint8_t>(all[i].outcome));
      result.certain_hit.push_back(all[i].certain_hit());
      result.certain_miss.push_back(all[i].certain_miss());
      for (const RayHit& hit : all[i].hits) {
        result.hits.push_back(hit);
        result.normals.push_back(hit.normal.value_or(Vector3{nan, nan, nan}));
        result.ray.push_back(static_cast<std::int64_t>(i));
      }
    }
    return result;
  });
}

py::object find_hits(PySurface& self, const py::object& origins, const py::object& directions,
                     const py::object& query, bool certified, const py::object& absolute,
                     const py::object& error, const py::object& max_splits, const py::object& threads,
                     const py::object& progress, const py::object& certificate) {
  CertificateFile file(certificate);
  const RayInput input(origins, directions);
  RayOptions options;
  const std::string word = py::isinstance<py::str>(query) ? query.cast<std::string>() : "";
  if (word == "any") options.query = RayQuery::any;
  if (word == "all") options.query = RayQuery::all;
  if (word != "nearest" && word != "any" && word != "all") {
    throw InputError(InputProblem::value,
                     "query: " + py::repr(query).cast<std::string>() + " is none of 'nearest', 'any', 'all'");
  }
  const int all_threads = threads_of(threads);
  if (certified) {
    options.absolute = length_of(absolute, self.surface().size(), "absolute");
    return py::cast(
        file.written(traced(self, input, options, file.with(run_of(threads, max_splits)), progress)));
  }
  if (!certificate.is_none())
    throw InputError(InputProblem::value, "certificate: hits without proof (certified=False) have none");
  if (word != "nearest")
    throw InputError(InputProblem::value,
                     "query: without proof (certified=False) only 'nearest' can be asked");
  const auto caster = self.caster(length_of(error, self.surface().size(), "error").value_or(0), all_threads);
  Call call(progress);
  std::vector<QuickHit> hits = call.run([&](const Run& run) {
    std::vector<QuickHit> all(input.count());
    in_blocks(all.size(), run, [&](std::size_t begin, std::size_t count) {
      caster->cast(input.rays(begin, count, *run.monitor), std::span(all).subspan(begin, count),
                   {.threads = all_threads});
    });
    return all;
  });
  if (input.single()) return py::cast(Answers<QuickHit>(hits[0]));
  return py::cast(Answers<QuickHit>(std::move(hits)));
}

void add_rays(py::module_& module) {
  py::class_<Hits> cls(module, "RayHits",
                       "Where rays meet a surface: every hit lies in one of the intervals, and each "
                       "certified one holds a hit.\n"
                       "Hits of all rays follow one another, m in all, in the order of rays and of t.");
  cls.attr("__module__") = "snug";
  add_state(cls);
  const auto number_view = [&](const char* name, auto Hits::*numbers, const char* doc) {
    cls.def_property_readonly(
        name, [numbers](const py::object& self) { return column(self.cast<const Hits&>().*numbers, self); },
        doc);
  };
  const auto mask = [&](const char* name, std::vector<std::uint8_t> Hits::*flags, const char* doc) {
    cls.def_property_readonly(
        name,
        [flags](const py::object& object) -> py::object {
          const Hits& self = object.cast<const Hits&>();
          if (self.single) return py::bool_((self.*flags).at(0) != 0);
          return column(self.*flags, object).attr("view")("bool");
        },
        doc);
  };
  for_each_field<RayHit>([&]<class Of>(const Field<Of>& field) {
    if constexpr (has_columns<RayHit, Of>) {
      add_columns<RayHit>(field, [&](const char* name, const auto& member, std::string doc) {
        doc.replace(doc.find("(n"), 2, "(m");
        cls.def_property_readonly(
            name,
            [member](const py::object& self) {
              return column(std::span<const RayHit>(self.cast<const Hits&>().hits), member, self);
            },
            doc.c_str());
      });
    } else {
      number_view(field.name, &Hits::normals,
                  (std::string(field.text) + " (m, 3); NaN where there is none").c_str());
    }
  });
  number_view("ray", &Hits::ray, "The ray of each hit, (m,) int64.");
  cls.def_property_readonly(
      "outcome",
      [](const Hits& self) -> py::object {
        const auto word = [](std::uint8_t outcome) {
          return py::str(name_of(static_cast<Outcome>(outcome)));
        };
        if (self.single) return word(self.outcome.at(0));
        py::list words;
        for (const std::uint8_t outcome : self.outcome) words.append(word(outcome));
        return words;
      },
      "Of each ray: 'complete'; 'budget-spent': there may be other hits; 'at-rounding': an interval stays "
      "wider "
      "than requested. For many rays a list.");
  mask("certain_hit", &Hits::certain_hit, "Of each ray: is it proved that there is a hit? (n,) bool.");
  mask("certain_miss", &Hits::certain_miss, "Of each ray: is it proved that there is none? (n,) bool.");
  cls.def("__len__", [](const Hits& self) { return self.hits.size(); });
  cls.def("__repr__", [](const Hits& self) {
    return "<snug.RayHits " + std::to_string(self.hits.size()) + " of " +
           std::to_string(self.outcome.size()) + (self.outcome.size() == 1 ? " ray>" : " rays>");
  });

  AnswerClass<QuickHit> quick(module, "QuickHit",
                              "What a ray, or each of n, meets first, for pictures: nothing is proved.");
  quick.fields()
      .array<bool>(
          "hit", {}, [](const QuickHit& t, bool* out) { *out = std::isfinite(t.t); },
          "Was anything met? (n,) bool.")
      .repr([](const QuickHit& t) {
        return std::isfinite(t.t) ? "t " + text_of(t.t) : std::string("nothing");
      });
}

// The parameter that plain numbers of Python give, without numpy's help.
std::optional<Place> plain_parameter(const py::object& face, const py::object& u, const py::object& v,
                                     const py::object& corner) {
  const auto index = [](const py::object& given) -> std::optional<std::uint32_t> {
    if (Py_TYPE(given.ptr()) != &PyLong_Type) return {};
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(given.ptr(), &overflow);
    if (overflow != 0 || number < 0 || number >= UINT32_MAX) return {};
    return static_cast<std::uint32_t>(number);
  };
  const std::optional<std::uint32_t> owner = index(face), at_corner = index(corner);
  const std::optional<double> s = plain_number(u.ptr()), t = plain_number(v.ptr());
  if (!owner || !at_corner || !s || !t) return {};
  return Place{*owner, *at_corner, *s, *t};
}

Answers<SurfacePoint> evaluated(const PySurface& self, const py::object& face, const py::object& u,
                                const py::object& v, const py::object& corner, const py::object& threads,
                                const py::object& progress) {
  const Surface surface = self.surface();
  if (const auto at = plain_parameter(face, u, v, corner)) {
    static_cast<void>(threads_of(threads));
    Call call(progress);
    return call.run([&](const Run&) { return Answers<SurfacePoint>(evaluate(surface, *at)); });
  }
  const py::tuple arrays = convert("parameters")(face, u, v, corner);
  const auto owners = arrays[0].cast<py::array_t<std::uint32_t>>(),
             corners = arrays[3].cast<py::array_t<std::uint32_t>>();
  const Doubles us(arrays[1], "u"), vs(arrays[2], "v");
  std::vector<Place> at(static_cast<std::size_t>(owners.size()));
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = {owners.data()[i], corners.data()[i], us.data()[i], vs.data()[i]};
  }
  const bool single = arrays[4].cast<bool>();
  const int all_threads = threads_of(threads);
  Call call(progress);
  return call.run([&](const Run& run) {
    if (single) return Answers<SurfacePoint>(evaluate(surface, at[0]));
    std::vector<SurfacePoint> all;
    all.reserve(at.size());
    in_blocks(at.size(), run, [&](std::size_t begin, std::size_t count) {
      const std::vector<SurfacePoint> block =
          evaluate(surface, std::span(at).subspan(begin, count), {.threads = all_threads});
      all.insert(all.end(), block.begin(), block.end());
    });
    return Answers<SurfacePoint>(std::move(all));
  });
}

void add_evaluated(py::module_& module) {
  AnswerClass<SurfacePoint> answers(module, "SurfacePoint",
                                    "A limit point, or n of them, with tangents and normals.");
  answers.fields().repr([](const SurfacePoint& t) {
    return text_of(t.point.x) + " " + text_of(t.point.y) + " " + text_of(t.point.z);
  });
}

}  // namespace

void add_point_queries(py::class_<PySurface>& surface, py::module_& module) {
  add_closest(module);
  add_containment(module);
  add_rays(module);
  add_evaluated(module);
  using py::arg;
  const py::object none = py::none();
  constexpr const char* narrow =
      "The work ends once upper - lower <= max(absolute, relative * upper); absolute is in mesh units, or "
      "percent of the size as\n"
      "in \"0.1%\"; by default 0.01 %. max_splits: most splits for each point. threads: for many points; 0 "
      "takes "
      "all cores.\n";
  surface
      .def(
          "closest_point", &closest, arg("points"), py::kw_only(), arg("relative") = none,
          arg("absolute") = none, arg("witness") = "exact", arg("max_splits") = none, arg("threads") = 0,
          arg("progress") = none, arg("certificate") = none,
          (std::string(
               "The point of the surface closest to a point (3,), or to each of (n, 3), in mesh units.\n\n") +
           narrow +
           "witness: 'exact', or 'approximate' for points near the surface, as their errors say: quicker.\n"
           "certificate: a file for a proof of the distances, which snug-check verifies.\n"
           "\nGuarantee: [lower, upper] contains the distance. Raises ValueError, MeshError, OverflowError.")
              .c_str())
      .def("signed_distance", &signed_of, arg("points"), py::kw_only(), arg("relative") = none,
           arg("absolute") = none, arg("max_splits") = none, arg("threads") = 0, arg("progress") = none,
           arg("certificate") = none,
           (std::string("The distance of a point (3,), or of each of (n, 3), negative inside of the closed "
                        "surface.\n\n") +
            narrow +
            "certificate: a file for a proof of the distances and their signs, which snug-check verifies.\n"
            "\nRaises as closest_point(); MeshError for a surface that is not closed.")
               .c_str())
      .def("contains", &contained, arg("points"), py::kw_only(), arg("threads") = 0, arg("progress") = none,
           arg("certificate") = none,
           "Is a point (3,), or each of (n, 3), inside of the closed surface? Proved, or undecided.\n\n"
           "threads: for many points; 0 takes all cores. certificate: a file for a proof, which snug-check "
           "verifies.\n"
           "Raises ValueError; MeshError for a surface that is not closed.")
      .def("ray", &find_hits, arg("origins"), arg("directions"), py::kw_only(), arg("query") = "nearest",
           arg("certified") = true, arg("absolute") = none, arg("error") = "0.01%", arg("max_splits") = none,
           arg("threads") = 0, arg("progress") = none, arg("certificate") = none,
           "Where rays meet the surface: origins and directions (3,) or (n, 3), one of either beside n of "
           "the other.\n\n"
           "query: 'nearest', 'any', 'all'. absolute: length of a hit's interval, mesh units or percent. "
           "max_splits: most splits for "
           "each ray.\n"
           "certified=False: a QuickHit for pictures, within `error`; nothing is proved.\n"
           "certificate: a file for a proof of hits and misses, which snug-check verifies.\n\n"
           "Raises ValueError, MeshError, OverflowError.")
      .def("evaluate", &evaluated, arg("face"), arg("u"), arg("v"), arg("corner") = 0, py::kw_only(),
           arg("threads") = 0, arg("progress") = none,
           "Limit points at parameters: numbers, or arrays that are broadcast against each other.\n\n"
           "Loop: (1 - u - v) c0 + u c1 + v c2 on a face. Other schemes: u, v in [0, 1] on a quad; on other "
           "faces on the quad at\n"
           "`corner`. In a dual scheme `face` is a vertex. Raises ValueError, OverflowError.");
}

}  // namespace snug::python
