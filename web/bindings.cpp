// The library for JavaScript, as snug.js wraps it: plain values, arrays and typed arrays go in and out. What the library
// refuses comes back as {problem, message}; snug.js throws it.

#include <emscripten/bind.h>
#include <emscripten/val.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <picture/polyhedron.h>
#include <snug/snug.h>

namespace snug::web {
namespace {

using emscripten::val;

// Numbers, copied out of the module's memory.
template <class T>
val copied(std::span<const T> numbers) {
  return val(emscripten::typed_memory_view(numbers.size(), numbers.data())).template call<val>("slice");
}
template <class T>
val copied(const std::vector<T>& numbers) {
  return copied(std::span<const T>(numbers));
}

val array_of(const Point3& p) {
  val array = val::array();
  for (int k = 0; k < 3; ++k) array.set(k, p[static_cast<std::size_t>(k)]);
  return array;
}
val array_of(const Vector3& v) { return array_of(Point3{v.x, v.y, v.z}); }
val array_of(const Interval& interval) {
  val array = val::array();
  array.set(0, interval.lower);
  array.set(1, interval.upper);
  return array;
}

bool given(const val& options, const char* name) {
  return !options.isUndefined() && !options.isNull() && !options[name].isUndefined() &&
         !options[name].isNull();
}
template <class T>
std::optional<T> option(const val& options, const char* name) {
  if (!given(options, name)) return {};
  return options[name].as<T>();
}
Run run_of(const val& options, std::optional<std::uint64_t> usual = {}) {
  Run run{.threads = 1, .max_splits = usual};
  const std::optional<double> splits = option<double>(options, "maxSplits");
  if (!splits) return run;
  if (!(*splits >= 0 && *splits <= 0x1p53)) {
    throw InputError(InputProblem::value, "maxSplits: give a whole number that is not negative");
  }
  run.max_splits = static_cast<std::uint64_t>(*splits);
  return run;
}

const char* name_of_problem(InputProblem problem) {
  switch (problem) {
    case InputProblem::unreadable:
      return "unreadable";
    case InputProblem::refused:
      return "refused";
    case InputProblem::pose:
      return "pose";
    case InputProblem::value:
      return "value";
    case InputProblem::unrepresentable:
      break;
  }
  return "unrepresentable";
}

val fault(const char* problem, const std::string& message) {
  val result = val::object();
  result.set("problem", std::string(problem));
  result.set("message", message);
  return result;
}

// The result of work(), or its exception.
template <class Work>
val guarded(const Work& work) {
  constexpr const char* out_of_memory = "out of memory: the mesh or the answer is too large for a page";
  try {
    return work();
  } catch (const InputError& error) {
    return fault(name_of_problem(error.problem()), error.what());
  } catch (const std::bad_alloc&) {
    return fault("memory", out_of_memory);
  } catch (const std::length_error&) {
    return fault("memory", out_of_memory);
  }
}

// The enumerator among `count` of this name.
template <class Enum, class Name>
Enum named(const std::string& word, std::size_t count, const char* what, const Name& name) {
  std::string known;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string each = name(static_cast<Enum>(i));
    if (each == word) return static_cast<Enum>(i);
    known += (i == 0 ? "" : i + 1 < count ? ", " : " or ") + each;
  }
  throw InputError(InputProblem::value, std::string(what) + ": '" + word + "' is not " + known);
}

const char* name_of_boundary(BoundaryRule rule) {
  constexpr std::array<const char*, 3> names{"none", "edge-only", "edge-and-corner"};
  return names[static_cast<std::size_t>(rule)];
}

constexpr std::size_t scheme_count = static_cast<std::size_t>(Scheme::flat) + 1;

bool has_creases(Scheme scheme) { return scheme != Scheme::doo_sabin && scheme != Scheme::midedge; }
bool has_triangles(Scheme scheme) { return scheme == Scheme::loop || scheme == Scheme::flat; }

// A surface that was read, and what is told of it.
class Part {
 public:
  Part(const std::string& bytes, const std::string& name, const val& options)
      : surface_(made(bytes, name, options)) {}

  [[nodiscard]] const Surface& surface() const { return surface_; }
  [[nodiscard]] double size() const { return surface_.size(); }
  [[nodiscard]] std::string scheme() const { return name_of(surface_.scheme()); }
  [[nodiscard]] std::string boundary() const { return name_of_boundary(surface_.boundary()); }
  [[nodiscard]] val notes() const {
    val list = val::array();
    for (const std::string& line : notes_) list.call<void>("push", line);
    return list;
  }

 private:
  Surface made(const std::string& bytes, const std::string& name, const val& options) {
    SurfaceOptions how;
    how.tight = option<bool>(options, "tight").value_or(false);
    if (const auto word = option<std::string>(options, "scheme"); word && *word != "auto") {
      how.scheme = named<Scheme>(*word, scheme_count, "scheme", [](Scheme s) { return name_of(s); });
    }
    if (const auto word = option<std::string>(options, "boundary")) {
      how.boundary = named<BoundaryRule>(*word, 3, "boundary", name_of_boundary);
    }
    const std::optional<double> sharp = option<double>(options, "sharp");
    if (sharp && how.scheme && !has_creases(*how.scheme)) {
      throw InputError(InputProblem::value, std::string("sharp: ") + name_of(*how.scheme) +
                                                " has no creases; choose loop or catmark");
    }
    how.notes = [&](const std::string& line) { notes_.push_back(name + ": " + line); };
    ControlMesh mesh =
        parse_mesh(bytes, name, {.notes = [this](const std::string& line) { notes_.push_back(line); }});
    try {
      if (const auto distance = option<double>(options, "weld")) weld(mesh, *distance);
      if (sharp) sharpen(mesh, *sharp);
      return Surface(std::move(mesh), how, {.threads = 1});
    } catch (const InputError& error) {
      throw InputError(error.problem(), name + ": " + error.what());
    }
  }

  std::vector<std::string> notes_;
  Surface surface_;
};

val read_part(const std::string& bytes, const std::string& name, const val& options) {
  return guarded([&] {
    val result = val::object();
    result.set("part", std::make_shared<Part>(bytes, name, options));
    return result;
  });
}

// Poses: twelve numbers, or nothing for the identity.

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
Motion motion_of(const val& numbers) {
  return numbers.isUndefined() || numbers.isNull() ? Motion() : Motion::from_3x4(twelve(numbers));
}
Vector3 vector_of(const val& numbers, const char* what) {
  const std::vector<double> read = emscripten::convertJSArrayToNumberVector<double>(numbers);
  if (read.size() != 3) throw InputError(InputProblem::value, std::string(what) + ": give three numbers");
  return {read[0], read[1], read[2]};
}
val array_of(const Motion& motion) {
  val array = val::array();
  for (std::size_t i = 0; i < 12; ++i) array.set(i, motion.numbers()[i]);
  return array;
}

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

// Answers.

val places_of(const std::array<const PlacedSurface*, 2>& sides, const WitnessPoints& points) {
  val list = val::array();
  for (std::size_t s = 0; s < 2; ++s) {
    if (!points[s].at) {
      list.set(s, val::null());
      continue;
    }
    const Place& at = *points[s].at;
    val place = val::object();
    place.set("owner", at.owner);
    place.set("corner", at.corner);
    place.set("u", at.u);
    place.set("v", at.v);
    const std::optional<SurfaceNormal> normal = normal_at(*sides[s], at);
    place.set("normal", normal ? array_of(normal->direction) : val::null());
    place.set("normalError", normal && normal->error ? val(*normal->error) : val::null());
    list.set(s, place);
  }
  return list;
}

// The fields of witnesses; null where there are none.
void add_witness(val& result, const std::array<const PlacedSurface*, 2>& sides, const WitnessPoints* points) {
  val list = val::array();
  for (std::size_t s = 0; points != nullptr && s < 2; ++s) list.set(s, array_of((*points)[s].point));
  result.set("witness", points ? list : val::null());
  result.set("witnessError", points ? val(std::max((*points)[0].error, (*points)[1].error)) : val::null());
  result.set("witnessAt", points ? places_of(sides, *points) : val::null());
}

void add_stats(val& result, const SearchStats& stats) {
  val list = val::object();
  list.set("boxTests", static_cast<double>(stats.box_tests));
  list.set("triangleTests", static_cast<double>(stats.triangle_tests));
  list.set("evaluations", static_cast<double>(stats.evaluations));
  list.set("splits", static_cast<double>(stats.splits));
  result.set("stats", list);
}

val contained_of(const std::optional<std::size_t>& side) {
  return side ? val(static_cast<unsigned>(*side)) : val::null();
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
    CollideOptions how;
    how.tolerance = option<double>(options, "tolerance");
    how.margin = option<double>(options, "margin").value_or(0);
    how.solid = option<bool>(options, "solid").value_or(false);
    how.measure = option<bool>(options, "measure").value_or(false);
    how.prove_contact = option<bool>(options, "proveContact").value_or(false);
    Proof proof(options);
    const Collision answer = collide(a, b, how, proof.with(run_of(options)));
    val result = val::object();
    result.set("verdict", std::string(name_of(answer.verdict)));
    result.set("outcome", std::string(name_of(answer.outcome)));
    result.set("distance", array_of(answer.distance));
    add_witness(result, {&a, &b}, answer.witness ? &*answer.witness : nullptr);
    result.set("contained", contained_of(answer.contained));
    add_stats(result, answer.stats);
    proof.add_to(result);
    return result;
  });
}

val distance_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    const PlacedSurface a(part_a.surface(), motion_of(options["poseA"]));
    const PlacedSurface b(part_b.surface(), motion_of(options["poseB"]));
    DistanceOptions how;
    how.absolute = option<double>(options, "absolute");
    how.relative = option<double>(options, "relative");
    how.solid = option<bool>(options, "solid").value_or(false);
    Proof proof(options);
    const Distance answer = distance(a, b, how, proof.with(run_of(options)));
    val result = val::object();
    result.set("outcome", std::string(name_of(answer.outcome)));
    result.set("distance", array_of(answer.distance));
    add_witness(result, {&a, &b}, &answer.witness);
    result.set("contained", contained_of(answer.contained));
    add_stats(result, answer.stats);
    proof.add_to(result);
    return result;
  });
}

val penetration_of_parts(const Part& part_a, const Part& part_b, const val& options) {
  return guarded([&] {
    PenetrationOptions how;
    how.relative = option<double>(options, "relative").value_or(how.relative);
    const Penetration answer =
        penetration({part_a.surface(), motion_of(options["poseA"])},
                    {part_b.surface(), motion_of(options["poseB"])}, how, run_of(options));
    val result = val::object();
    result.set("depth", array_of(answer.depth));
    result.set("translation", array_of(answer.translation));
    result.set("outcome", std::string(name_of(answer.outcome)));
    return result;
  });
}

val closest_to(const Part& part, const val& point, const val& options) {
  return guarded([&] {
    const Vector3 to = vector_of(point, "point");
    Precision how;
    how.absolute = option<double>(options, "absolute");
    how.relative = option<double>(options, "relative");
    const auto write = [](const ClosestPoint& answer) {
      val result = val::object();
      result.set("distance", array_of(answer.distance));
      result.set("outcome", std::string(name_of(answer.outcome)));
      result.set("point", array_of(answer.point));
      result.set("error", answer.error);
      val place = val::object();
      place.set("owner", answer.at->owner);
      place.set("corner", answer.at->corner);
      place.set("u", answer.at->u);
      place.set("v", answer.at->v);
      result.set("at", place);
      return result;
    };
    if (!option<bool>(options, "signed").value_or(false)) {
      return write(closest_point(part.surface(), {to.x, to.y, to.z}, how, run_of(options)));
    }
    const SignedDistance answer = signed_distance(part.surface(), {to.x, to.y, to.z}, how, run_of(options));
    val result = write(answer.nearest);
    result.set("distance", array_of(answer.distance));
    result.set("outcome", std::string(name_of(answer.outcome)));
    return result;
  });
}

// Shapes.

val cage_of(const Part& part) {
  return guarded([&] {
    const ControlMesh& mesh = part.surface().mesh();
    std::vector<double> points;
    for (const Point3& p : mesh.points) points.insert(points.end(), {p.x, p.y, p.z});
    std::vector<std::uint32_t> corners;
    for (const VertexId v : mesh.face_vertices) corners.push_back(v.value());
    val result = val::object();
    result.set("points", copied(points));
    result.set("offsets", copied(mesh.face_offsets));
    result.set("corners", copied(corners));
    return result;
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

template <class Index>
std::vector<std::uint32_t> flat(const std::vector<std::array<Index, 3>>& triangles) {
  std::vector<std::uint32_t> numbers;
  for (const auto& each : triangles) numbers.insert(numbers.end(), each.begin(), each.end());
  return numbers;
}
template <class Triple>
std::vector<double> flat_points(const std::vector<Triple>& points) {
  std::vector<double> numbers;
  for (const Triple& p : points) numbers.insert(numbers.end(), {p.x, p.y, p.z});
  return numbers;
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
    const Tessellation made = tessellate(part.surface(), how, run_of(options, 4'000'000));
    val result = val::object();
    result.set("positions", copied(flat_points(made.positions)));
    result.set("normals", copied(flat_points(made.normals)));
    result.set("triangles", copied(flat(made.triangles)));
    result.set("owners", copied(made.owners));
    result.set("errorBound", made.error_bound);
    result.set("outcome", std::string(name_of(made.outcome)));
    return result;
  });
}

BoundOptions bound_options(const val& options) {
  BoundOptions how;
  how.error = option<double>(options, "error");
  how.level = static_cast<unsigned>(option<double>(options, "level").value_or(0));
  return how;
}

val enclosures(const Part& part, const val& options) {
  return guarded([&] {
    std::vector<std::uint32_t> owners, parts, levels;
    std::vector<double> base, radius, lower, upper;
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
        },
        run_of(options));
    val result = val::object();
    result.set("count", static_cast<double>(summary.count));
    result.set("maxRadius", summary.max_radius);
    result.set("outcome", std::string(name_of(summary.outcome)));
    result.set("owners", copied(owners));
    result.set("parts", copied(parts));
    result.set("levels", copied(levels));
    result.set("pieces", pieces);
    result.set("base", copied(base));
    result.set("radius", copied(radius));
    result.set("lower", copied(lower));
    result.set("upper", copied(upper));
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

val one_hull(const std::optional<Hull>& hull) {
  if (!hull) return val::null();
  val result = val::object();
  result.set("positions", copied(flat_points(hull->positions)));
  result.set("triangles", copied(flat(hull->triangles)));
  result.set("owners", copied(hull->owners));
  result.set("gap", hull->gap);
  return result;
}

val hulls_of(const Part& part, const val& options) {
  return guarded([&] {
    HullOptions how;
    how.error = option<double>(options, "error");
    how.inner = option<bool>(options, "inner").value_or(true);
    how.outer = option<bool>(options, "outer").value_or(true);
    const Hulls made = hull(part.surface(), how, run_of(options));
    val result = val::object();
    result.set("inner", one_hull(made.inner));
    result.set("outer", one_hull(made.outer));
    result.set("outcome", std::string(name_of(made.outcome)));
    result.set("closed", made.closed);
    val problems = val::array();
    for (const HullProblem& each : made.problems) {
      val problem = val::object();
      problem.set("fault", std::string(name_of(each.fault)));
      problem.set("inner", each.inner);
      problem.set("place", array_of(each.place));
      problem.set("owner", each.owner ? val(*each.owner) : val::null());
      problems.call<void>("push", problem);
    }
    result.set("problems", problems);
    return result;
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
    const Measures measures = measure(part.surface(), how, run_of(options));
    val result = val::object();
    result.set("area", array_of(measures.area));
    result.set("volume", measures.volume ? array_of(*measures.volume) : val::null());
    result.set("outcome", std::string(name_of(measures.outcome)));
    return result;
  });
}

// About six digits of a proved bound, rounded to the safe side, as the command prints them.
std::string text_at_most(double x, bool at_least) {
  std::array<char, 40> text{};
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*g", digits, x);
    const double read = std::strtod(text.data(), nullptr);
    if (at_least ? read >= x : read <= x) break;
  }
  return text.data();
}

}  // namespace
}  // namespace snug::web

EMSCRIPTEN_BINDINGS(snug) {
  using namespace snug::web;
  emscripten::class_<Part>("Part")
      .smart_ptr<std::shared_ptr<Part>>("PartPointer")
      .property("size", &Part::size)
      .property("scheme", &Part::scheme)
      .property("boundary", &Part::boundary)
      .property("notes", &Part::notes);
  emscripten::function("read", &read_part);
  emscripten::function("pose", &make_pose);
  emscripten::function("collide", &collide_parts);
  emscripten::function("distance", &distance_of_parts);
  emscripten::function("penetration", &penetration_of_parts);
  emscripten::function("closest", &closest_to);
  emscripten::function("cage", &cage_of);
  emscripten::function("sampled", &sampled);
  emscripten::function("tessellate", &tessellated);
  emscripten::function("enclosures", &enclosures);
  emscripten::function("enclosureShapes", &enclosure_shapes);
  emscripten::function("hull", &hulls_of);
  emscripten::function("limitToFaces", &limit_to_faces_of);
  emscripten::function("measure", &measured);
  emscripten::function("textAtMost", &text_at_most);
}
