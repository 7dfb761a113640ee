// What is made from a surface: meshes to draw, enclosures, hulls, measures.

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <picture/polyhedron.h>

#include "fields.h"
#include "part.h"

namespace snug::web {
namespace {

bool has_triangles(Scheme scheme) { return scheme == Scheme::loop || scheme == Scheme::flat; }

val cage_of(const ControlMesh& mesh) {
  std::vector<std::uint32_t> corners;
  for (const VertexId v : mesh.face_vertices) corners.push_back(v.value());
  val result = val::object();
  result.set("points", copied(flat_points(mesh.points)));
  result.set("offsets", copied(mesh.face_offsets));
  result.set("corners", copied(corners));
  return result;
}

val cage_of_part(const Part& part) {
  return guarded([&] { return cage_of(part.surface().mesh()); });
}

val subdivided_of(const Part& part, unsigned level, bool limit) {
  return guarded([&] {
    const Surface& surface = part.surface();
    return cage_of(subdivided(surface.mesh(), level, limit,
                              {.scheme = surface.scheme(), .boundary = surface.boundary()}, {.threads = 1}));
  });
}

void require_count(double count, double most, const char* what) {
  if (count <= most) return;
  throw InputError(InputProblem::refused, std::string(what) + ": this level makes more than " +
                                              std::to_string(static_cast<long>(most)) +
                                              "; choose a lower level");
}

// Limit points and normals on a lattice of 2^level steps a patch; each patch has its own, so that creases stay sharp.
val sampled(const Part& part, unsigned level) {
  return guarded([&] {
    const Surface& surface = part.surface();
    const bool triangular = has_triangles(surface.scheme());
    const PatchBounds bounds(surface, {.threads = 1});
    const auto patches = bounds.patches();
    require_count(std::ldexp(static_cast<double>(patches.size()), static_cast<int>(2 * level)), 4e6,
                  "triangles");
    const std::uint32_t steps = 1u << level, points = (steps + 1) * (steps + 2) / 2;
    std::vector<Place> at;
    std::vector<std::uint32_t> triangles;
    for (std::size_t p = 0; p < patches.size(); ++p) {
      const auto first = static_cast<std::uint32_t>(p) * points;
      std::uint32_t next = first;
      for (std::uint32_t j = 0; j <= steps; ++j) {
        for (std::uint32_t i = 0; i + j <= steps; ++i, ++next) {
          const double s = std::ldexp(i, -static_cast<int>(level)),
                       t = std::ldexp(j, -static_cast<int>(level));
          Place place{patches[p].owner, patches[p].part / 2, s, t};
          // c0 c1 c2 of the quad, or c2 c3 c0.
          if (!triangular && patches[p].part % 2 == 0) place.u = s + t;
          if (!triangular && patches[p].part % 2 == 1) {
            place.u = 1 - s - t;
            place.v = 1 - t;
          }
          at.push_back(place);
          const std::uint32_t row = steps + 1 - j;
          if (i + j == steps) continue;
          triangles.insert(triangles.end(), {next, next + 1, next + row});
          if (i + j + 1 < steps) triangles.insert(triangles.end(), {next + 1, next + row + 1, next + row});
        }
      }
    }
    std::vector<float> positions(3 * at.size()), normals(3 * at.size());
    const double error = evaluate(surface, at, FloatPoints{positions, normals}, {.threads = 1});
    val result = val::object();
    result.set("positions", copied(positions));
    result.set("normals", copied(normals));
    result.set("triangles", copied(triangles));
    result.set("error", error);
    return result;
  });
}

val tessellated(const Part& part, const val& options) {
  return guarded([&] {
    TessellateOptions how;
    how.error = option<double>(options, "error");
    how.max_edge = option<double>(options, "maxEdge");
    how.max_angle = option<double>(options, "maxAngle");
    if (const auto most = option<double>(options, "maxTriangles")) {
      how.max_triangles = static_cast<std::uint64_t>(*most);
    }
    how.max_thickness = option<double>(options, "maxThickness");
    if (given(options, "view")) {
      how.view = Viewpoint{point_of(options["view"]["eye"], "eye"),
                           option<double>(options["view"], "angle").value_or(0)};
    }
    return object_of(tessellate(part.surface(), how, run_of(options, 4'000'000)));
  });
}

BoundOptions bound_options(const val& options) {
  BoundOptions how;
  how.error = option<double>(options, "error");
  how.level = static_cast<unsigned>(option<double>(options, "level").value_or(0));
  how.normals = option<bool>(options, "normals").value_or(false);
  return how;
}

val enclosures(const Part& part, const val& options) {
  return guarded([&] {
    std::vector<std::uint32_t> owners, parts, levels;
    std::vector<double> base, radius, lower, upper, axes, angles;
    val pieces = val::array();
    const auto add = [](std::vector<double>& to, const Point3& p) { to.insert(to.end(), {p.x, p.y, p.z}); };
    const BoundSummary summary = bound(
        part.surface(), bound_options(options),
        [&](const PatchEnclosure& piece) {
          owners.push_back(piece.patch.owner);
          parts.push_back(piece.patch.part);
          levels.push_back(piece.level);
          pieces.call<void>("push", piece.piece);
          for (const Point3& p : piece.offset.base) add(base, p);
          radius.push_back(piece.offset.radius);
          for (const Box3& box : piece.interval.corner) {
            add(lower, box.lower);
            add(upper, box.upper);
          }
          const NormalCone cone = piece.normals.value_or(NormalCone{{NAN, NAN, NAN}, NAN});
          add(axes, {cone.axis.x, cone.axis.y, cone.axis.z});
          angles.push_back(cone.angle);
        },
        run_of(options));
    val result = object_of(summary);
    result.set("owners", copied(owners));
    result.set("parts", copied(parts));
    result.set("levels", copied(levels));
    result.set("pieces", pieces);
    result.set("base", copied(base));
    result.set("radius", copied(radius));
    result.set("lower", copied(lower));
    result.set("upper", copied(upper));
    if (option<bool>(options, "normals").value_or(false)) {
      result.set("axes", copied(axes));
      result.set("angles", copied(angles));
    }
    return result;
  });
}

// Enclosures as solids to draw: the hulls of interval triangles as triangles and edges, in single precision.
val enclosure_shapes(const Part& part, const val& options) {
  return guarded([&] {
    const BoundOptions how = bound_options(options);
    const PatchBounds bounds(part.surface(), {.threads = 1});
    if (!how.error) {
      require_count(std::ldexp(static_cast<double>(bounds.patches().size()), static_cast<int>(2 * how.level)),
                    40'000, "enclosures");
    }
    std::vector<float> positions, edges;
    double count = 0;
    const auto add = [](std::vector<float>& to, const Point3& p) {
      to.insert(to.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    };
    const BoundSummary summary = bound(
        part.surface(), how,
        [&](const PatchEnclosure& piece) {
          const Polyhedron hull = hull_of_boxes(piece.interval);
          for (const auto& facet : hull.facets) {
            for (std::size_t i = 0; i < facet.size(); ++i) {
              const std::size_t next = (i + 1) % facet.size();
              if (facet[i] < facet[next]) {
                add(edges, hull.points[facet[i]]);
                add(edges, hull.points[facet[next]]);
              }
              if (i == 0 || next == 0) continue;
              for (const std::size_t corner : {std::size_t{0}, i, next})
                add(positions, hull.points[facet[corner]]);
            }
          }
          ++count;
        },
        run_of(options));
    val result = val::object();
    result.set("count", count);
    result.set("maxRadius", summary.max_radius);
    result.set("positions", copied(positions));
    result.set("edges", copied(edges));
    return result;
  });
}

val hulls_of(const Part& part, const val& options) {
  return guarded([&] {
    HullOptions how;
    how.error = option<double>(options, "error");
    how.inner = option<bool>(options, "inner").value_or(true);
    how.outer = option<bool>(options, "outer").value_or(true);
    return object_of(hull(part.surface(), how, run_of(options)));
  });
}

// A closed mesh around a surface of any sort.
val enveloped(const Part& part, const val& options) {
  return guarded([&] {
    EnvelopeOptions how;
    how.error = option<double>(options, "error");
    how.clearance = option<double>(options, "clearance");
    how.gap = option<double>(options, "gap");
    return object_of(envelope(part.surface(), how, run_of(options)));
  });
}

// Of a surface and another one, or {positions, triangles}.
val deviation_of(const Part& part, const val& candidate, const val& options) {
  return guarded([&] {
    DeviationOptions how;
    how.absolute = option<double>(options, "absolute");
    how.threshold = option<double>(options, "threshold");
    how.solid = option<bool>(options, "solid").value_or(false);
    if (given(candidate, "scheme")) {
      const Surface other = candidate.as<std::shared_ptr<Part>>()->surface();
      return object_of(deviation(part.surface(), other, how, run_of(options)));
    }
    if (!given(candidate, "positions") || !given(candidate, "triangles"))
      throw InputError(InputProblem::value, "deviation: give a Surface, or positions and triangles");
    const std::vector<double> numbers = list_of(candidate["positions"]);
    const auto corners = list_of(candidate["triangles"]);
    std::vector<Point3> points;
    for (const double v : corners) {
      if (!(v >= 0 && v < static_cast<double>(numbers.size() / 3))) {
        throw InputError(InputProblem::value, "triangles: an index without a position");
      }
      const double* const p = numbers.data() + 3 * static_cast<std::size_t>(v);
      points.push_back({p[0], p[1], p[2]});
    }
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i + 2 < points.size(); i += 3)
      triangles.push_back({points[i], points[i + 1], points[i + 2]});
    return object_of(deviation(part.surface(), triangles, how, run_of(options)));
  });
}

val limit_to_faces_of(const Part& part) {
  return guarded([&] {
    const std::optional<double> apart = limit_to_faces(part.surface(), {.threads = 1});
    return apart ? val(*apart) : val::null();
  });
}

val measured(const Part& part, const val& options) {
  return guarded([&] {
    MeasureOptions how;
    how.relative = option<double>(options, "relative");
    return object_of(measure(part.surface(), how, run_of(options)));
  });
}

// A STEP file of B-spline faces.
val step_of(const Part& part, const val& options) {
  return guarded([&] {
    constexpr std::array units{"mm", "cm", "m", "inch", "foot", "micron"};
    constexpr std::array protocols{"ap242", "ap214"};
    StepOptions file;
    file.name = option<std::string>(options, "name").value_or("part");
    const auto one_of = [&](const char* name, std::span<const char* const> words) {
      const std::string word = option<std::string>(options, name).value_or(words[0]);
      const auto at = std::find(words.begin(), words.end(), word);
      if (at == words.end())
        throw InputError(InputProblem::value, std::string(name) + ": there is no '" + word + "'");
      return static_cast<std::uint8_t>(at - words.begin());
    };
    file.unit = static_cast<LengthUnit>(one_of("units", units));
    file.ap214 = one_of("protocol", protocols) > 0;
    const Brep brep =
        to_brep(part.surface(),
                {.error = option<double>(options, "error"), .max_angle = option<double>(options, "maxAngle")},
                run_of(options));
    val result = object_of(brep);
    result.set("text", format_step(brep, file));
    return result;
  });
}

}  // namespace
}  // namespace snug::web

EMSCRIPTEN_BINDINGS(shapes) {
  using namespace snug::web;  // NOLINT
  emscripten::function("step", &step_of);
  emscripten::function("cage", &cage_of_part);
  emscripten::function("subdivided", &subdivided_of);
  emscripten::function("sampled", &sampled);
  emscripten::function("tessellate", &tessellated);
  emscripten::function("enclosures", &enclosures);
  emscripten::function("enclosureShapes", &enclosure_shapes);
  emscripten::function("hull", &hulls_of);
  emscripten::function("envelope", &enveloped);
  emscripten::function("deviation", &deviation_of);
  emscripten::function("limitToFaces", &limit_to_faces_of);
  emscripten::function("measure", &measured);
}
