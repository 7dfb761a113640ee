#include "surface.h"

#include <algorithm>
#include <cmath>

#include <snug/evaluate.h>
#include <snug/inspect.h>
#include <snug/mesh.h>

#include "answers.h"
#include "call.h"
#include "fields.h"
#include "poses.h"

namespace snug::python {

PySurface::PySurface(ControlMesh mesh, const SurfaceOptions& options, const Run& run)
    : surface_(std::move(mesh), options, run), options_(options) {
  options_.notes = {};
}

PySurface::PySurface(const PySurface& other)
    : surface_(other.surface_),
      options_(other.options_),
      caster_(other.caster_),
      caster_error_(other.caster_error_) {}

void PySurface::update(std::span<const Point3> points) {
  const std::size_t count = surface().mesh().points.size();
  if (points.size() != count) {
    throw InputError(InputProblem::value, "update: " + std::to_string(points.size()) +
                                              " vertices; the surface has " + std::to_string(count));
  }
  if (!moving_) moving_ = std::make_shared<Moving>(surface_);
  const std::shared_ptr<Moving> moving = moving_;
  const Surface next = [&] {
    const py::gil_scoped_release released;
    const std::lock_guard lock(moving->mutex);
    return moving->frames.move(points);
  }();
  surface_ = next;
  caster_.reset();
}

std::shared_ptr<const RayCaster> PySurface::caster(double error, int threads) {
  if (!caster_ || caster_error_ != error) {
    const Surface surface = this->surface();
    Call call(py::none(), {.threads = threads});
    auto made =
        call.run([&](const Run& run) { return std::make_shared<const RayCaster>(surface, error, run); });
    if (surface.data() != surface_.data()) return made;  // an update() came between
    caster_ = std::move(made);
    caster_error_ = error;
  }
  return caster_;
}

namespace {

// The words for values of options, in Python and in the command.
constexpr std::array<Scheme, 6> schemes{Scheme::loop,    Scheme::catmark,  Scheme::doo_sabin,
                                        Scheme::midedge, Scheme::bilinear, Scheme::flat};
const char* name_of_value(Scheme scheme) { return name_of(scheme); }
constexpr std::array<BoundaryRule, 3> boundaries{BoundaryRule::none, BoundaryRule::edge_only,
                                                 BoundaryRule::edge_and_corner};
const char* name_of_value(BoundaryRule rule) {
  constexpr std::array<const char*, 3> names{"none", "edge-only", "edge-and-corner"};
  return names[static_cast<std::size_t>(rule)];
}
constexpr std::array<CreaseMethod, 2> crease_methods{CreaseMethod::uniform, CreaseMethod::chaikin};
const char* name_of_value(CreaseMethod method) {
  return method == CreaseMethod::uniform ? "uniform" : "chaikin";
}
constexpr std::array<SmoothTriangles, 2> triangle_rules{SmoothTriangles::catmark, SmoothTriangles::smooth};
const char* name_of_value(SmoothTriangles rule) {
  return rule == SmoothTriangles::catmark ? "catmark" : "smooth";
}
constexpr std::array<BoundMethod, 2> bound_methods{BoundMethod::rows, BoundMethod::table};
const char* name_of_value(BoundMethod method) { return method == BoundMethod::rows ? "rows" : "table"; }

template <class Enum, std::size_t N>
Enum named(const py::object& given, const std::array<Enum, N>& values, const char* what) {
  std::string known;
  for (const Enum value : values) {
    if (py::isinstance<py::str>(given) && given.cast<std::string>() == name_of_value(value)) return value;
    known += (known.empty() ? "'" : ", '") + std::string(name_of_value(value)) + "'";
  }
  throw InputError(InputProblem::value,
                   std::string(what) + ": " + py::repr(given).cast<std::string>() + " is none of " + known);
}

bool is_word(const py::object& given, const char* word) {
  return py::isinstance<py::str>(given) && given.cast<std::string>() == word;
}

// Keywords of Surface and read() alike.
SurfaceOptions options_of(const py::object& scheme, const py::object& boundary, const py::object& bounds,
                          bool tight) {
  SurfaceOptions options;
  if (!scheme.is_none() && !is_word(scheme, "auto")) options.scheme = named(scheme, schemes, "scheme");
  if (!boundary.is_none()) options.boundary = named(boundary, boundaries, "boundary");
  options.bounds = named(bounds, bound_methods, "bounds");
  options.tight = tight;
  return options;
}

std::optional<double> weld_distance(const py::object& weld) {
  if (weld.is_none() || weld.is(py::bool_(false))) return {};
  if (weld.is(py::bool_(true))) return 0.0;
  return number_of(weld, "weld");
}

std::optional<double> sharp_angle(const py::object& sharp, const SurfaceOptions& options) {
  if (sharp.is_none()) return {};
  if (options.scheme == Scheme::doo_sabin || options.scheme == Scheme::midedge) {
    throw InputError(InputProblem::value, std::string("sharp: ") + name_of(*options.scheme) +
                                              " has no creases; choose loop or catmark");
  }
  return is_word(sharp, "auto") ? default_sharp_angle : number_of(sharp, "sharp");
}

// A whole number in a column of indices.
template <class Id>
Id id_of(double index, const char* what, std::size_t row) {
  if (!(index >= 0 && index < UINT32_MAX && index == std::floor(index))) {
    throw InputError(InputProblem::value, std::string(what) + " " + std::to_string(row) + " names " +
                                              text_of(index, 17) + ", which is not an index from 0");
  }
  return Id(static_cast<std::size_t>(index));
}

Doubles table_of(const py::object& given, std::size_t columns, const char* what) {
  Doubles numbers(given, what);
  if (numbers.dimensions() == 2 && numbers.last(0) == columns) return numbers;
  if (numbers.dimensions() == 1 && numbers.last(0) == 0) return numbers;  // an empty list
  throw InputError(InputProblem::value, std::string(what) + " has the shape " + numbers.shape_text() +
                                            "; give (n, " + std::to_string(columns) + ")");
}

double sharpness_of(double given) { return given == HUGE_VAL ? infinite_sharpness : given; }

void add_tags(MeshTags& tags, const py::object& creases, const py::object& corners, const py::object& holes,
              const py::object& crease_method, const py::object& smooth_triangles) {
  if (!creases.is_none()) {
    const Doubles rows = table_of(creases, 3, "creases");
    for (std::size_t i = 0; i < rows.extent(0); ++i) {
      const double* const row = rows.data() + 3 * i;
      tags.creases.push_back(
          {id_of<VertexId>(row[0], "crease", i), id_of<VertexId>(row[1], "crease", i), sharpness_of(row[2])});
    }
  }
  if (!corners.is_none()) {
    const Doubles rows = table_of(corners, 2, "corners");
    for (std::size_t i = 0; i < rows.extent(0); ++i) {
      const double* const row = rows.data() + 2 * i;
      tags.corners.push_back({id_of<VertexId>(row[0], "corner", i), sharpness_of(row[1])});
    }
  }
  if (!holes.is_none()) {
    const Doubles faces(holes, "holes");
    if (faces.dimensions() != 1)
      throw InputError(InputProblem::value, "holes has the shape " + faces.shape_text() + "; give (n,)");
    for (std::size_t i = 0; i < faces.extent(0); ++i)
      tags.holes.push_back(id_of<FaceId>(faces.data()[i], "hole", i));
  }
  if (!crease_method.is_none()) tags.crease_method = named(crease_method, crease_methods, "crease_method");
  if (!smooth_triangles.is_none())
    tags.smooth_triangles = named(smooth_triangles, triangle_rules, "smooth_triangles");
}

std::vector<std::uint32_t> indices_of(const py::object& array) {
  const auto numbers = array.cast<py::array_t<std::uint32_t, py::array::c_style | py::array::forcecast>>();
  return {numbers.data(), numbers.data() + numbers.size()};
}

ControlMesh mesh_of(const Points& points, std::vector<std::uint32_t> offsets,
                    const std::vector<std::uint32_t>& corners) {
  ControlMesh mesh;
  mesh.points.assign(points.all().begin(), points.all().end());
  mesh.face_offsets = std::move(offsets);
  mesh.face_vertices.reserve(corners.size());
  for (const std::uint32_t v : corners) mesh.face_vertices.emplace_back(v);
  return mesh;
}

// The mesh of a surface, with the scheme that it was made with.
ControlMesh tagged_mesh(const Surface& surface) {
  ControlMesh mesh = surface.mesh();
  mesh.tags.scheme = surface.scheme();
  return mesh;
}

// From Python's vertices and faces, or from one object that has both. `as_facets`: a mesh of another library whose faces
// are all triangles means these.
ControlMesh mesh_of(const py::object& vertices, const py::object& faces, bool as_facets) {
  if (faces.is_none() && py::isinstance<PySurface>(vertices))
    return tagged_mesh(vertices.cast<const PySurface&>().surface());
  if (faces.is_none() && py::isinstance<PyMesh>(vertices)) return vertices.cast<const PyMesh&>().whole();
  const py::tuple arrays = convert("mesh")(vertices, faces);
  const Points points(arrays[0], "vertices");
  ControlMesh mesh = mesh_of(points, indices_of(arrays[1]), indices_of(arrays[2]));
  if (as_facets && faces.is_none() && arrays[3].cast<bool>()) mesh.tags.scheme = Scheme::flat;
  return mesh;
}

// A line of the library about options, in Python's words.
std::string in_words_of_python(std::string line) {
  for (const Scheme scheme : {Scheme::flat, Scheme::loop}) {
    const std::string words = std::string("scheme ") + name_of(scheme);
    const std::size_t at = line.find(words + ' ');
    if (at != std::string::npos)
      line.replace(at, words.size(), std::string("scheme=\"") + name_of(scheme) + '"');
  }
  return line;
}

// For logging, at the level DEBUG.
void log(const std::string& name, const PySurface& made) {
  const Surface surface = made.surface();
  py::module_::import("logging").attr("getLogger")("snug").attr("debug")(
      "%s: %d faces, %s",
      py::reinterpret_steal<py::object>(
          PyUnicode_DecodeFSDefaultAndSize(name.data(), static_cast<Py_ssize_t>(name.size()))),
      surface.mesh().face_count(), name_of(surface.scheme()));
}

// `name`: of the file, if there is one.
std::unique_ptr<PySurface> made(ControlMesh mesh, SurfaceOptions options, std::optional<double> distance,
                                std::optional<double> angle, const Run& how, const py::object& progress,
                                std::vector<std::string>& notes, const std::string& name = {}) {
  if (options.boundary) mesh.tags.boundary = options.boundary;  // so that write() keeps it
  const std::size_t before = notes.size();
  Call call(progress, how);
  std::unique_ptr<PySurface> surface = call.run([&](const Run& run) {
    notes.resize(before);
    options.notes = [&](const std::string& line) {
      notes.push_back((name.empty() ? "" : name + ": ") + in_words_of_python(line));
    };
    ControlMesh taken = mesh;  // kept for the case that work begins again
    if (distance) static_cast<void>(weld(taken, *distance));
    if (angle) static_cast<void>(sharpen(taken, *angle));
    if (options.scheme) taken.tags.scheme = options.scheme;
    return std::make_unique<PySurface>(std::move(taken), options, run);
  });
  log(name.empty() ? "arrays" : name, *surface);
  return surface;
}

std::unique_ptr<PySurface> surface_of(const py::object& vertices, const py::object& faces,
                                      const py::object& scheme, const py::object& creases,
                                      const py::object& corners, const py::object& holes,
                                      const py::object& boundary, const py::object& crease_method,
                                      const py::object& smooth_triangles, const py::object& sharp,
                                      const py::object& weld, const py::object& bounds, bool tight,
                                      const py::object& threads, const py::object& progress) {
  const SurfaceOptions options = options_of(scheme, boundary, bounds, tight);
  const Run how = run_of(threads);
  // Who gives rules of subdivision means a control mesh.
  const bool has_rules = !creases.is_none() || !corners.is_none() || !holes.is_none() ||
                         !boundary.is_none() || !crease_method.is_none() || !smooth_triangles.is_none();
  ControlMesh mesh = mesh_of(vertices, faces, !has_rules);
  add_tags(mesh.tags, creases, corners, holes, crease_method, smooth_triangles);
  std::vector<std::string> notes;
  auto surface =
      made(std::move(mesh), options, weld_distance(weld), sharp_angle(sharp, options), how, progress, notes);
  warn(notes);
  return surface;
}

}  // namespace

std::string path_of(const py::object& path) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(path.ptr(), &bytes) == 0) throw py::error_already_set();
  const auto held = py::reinterpret_steal<py::bytes>(bytes);
  std::string name = held;
  return name == "-" ? "./-" : name;
}

namespace {

// Exceptions of work() about the file get its name.
template <class Work>
auto naming(const std::string& path, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    const bool unreadable = error.problem() == InputProblem::unreadable;
    std::string message = error.what();
    if (!unreadable && !message.starts_with(path)) message = path + ": " + message;
    if (!unreadable && error.problem() != InputProblem::refused) throw InputError(error.problem(), message);
    const py::object type = py::module_::import("snug._errors").attr(unreadable ? "FileError" : "MeshError");
    const py::object fault = type(file_text(message), file_text(path));
    PyErr_SetObject(type.ptr(), fault.ptr());
    throw py::error_already_set();
  }
}

// What a file is made into: keywords of read() and read_assembly() alike.
struct Reading {
  SurfaceOptions options;
  Run how;
  std::optional<double> distance, angle;
  std::string path;
  std::vector<std::string> notes{};

  // Of read_mesh() or read_assembly(); `make` is given it, and makes surfaces with surface().
  template <class Read, class Make>
  auto run(const py::object& progress, const Read& read, const Make& make) {
    auto result = naming(path, [&] {
      Call call(progress);
      return make(call.run([&](const Run& run) {
        notes.clear();
        ReadOptions reading{.weld = {}, .notes = [&](const std::string& line) { notes.push_back(line); }};
        if (distance) reading.weld = [d = *distance](double) { return d; };
        return read(path, reading, run);
      }));
    });
    warn(notes);
    return result;
  }
  std::unique_ptr<PySurface> surface(ControlMesh mesh) {
    return made(std::move(mesh), options, {}, angle, how, py::none(), notes, path);
  }
};
Reading reading_of(const py::object& file, const py::object& scheme, const py::object& boundary,
                   const py::object& sharp, const py::object& weld, const py::object& bounds, bool tight,
                   const py::object& threads) {
  const SurfaceOptions options = options_of(scheme, boundary, bounds, tight);
  return {options, run_of(threads), weld_distance(weld), sharp_angle(sharp, options), path_of(file)};
}

std::unique_ptr<PySurface> read(const py::object& file, const py::object& scheme, const py::object& boundary,
                                const py::object& sharp, const py::object& weld, const py::object& bounds,
                                bool tight, const py::object& threads, const py::object& progress) {
  Reading reading = reading_of(file, scheme, boundary, sharp, weld, bounds, tight, threads);
  return reading.run(progress, read_mesh, [&](ControlMesh mesh) { return reading.surface(std::move(mesh)); });
}

py::list read_parts(const py::object& file, const py::object& scheme, const py::object& boundary,
                    const py::object& sharp, const py::object& weld, const py::object& bounds, bool tight,
                    const py::object& threads, const py::object& progress) {
  Reading reading = reading_of(file, scheme, boundary, sharp, weld, bounds, tight, threads);
  return reading.run(progress, read_assembly, [&](const MeshAssembly& assembly) {
    std::vector<py::object> surfaces;
    for (const ControlMesh& mesh : assembly.meshes) surfaces.push_back(py::cast(reading.surface(mesh)));
    py::list parts;
    for (const MeshAssembly::Part& part : assembly.parts)
      parts.append(py::make_tuple(part.name, surfaces[part.mesh], matrix_of(part.pose)));
    return parts;
  });
}

void write(const ControlMesh& mesh, const py::object& file) {
  const std::string path = path_of(file);
  std::vector<std::string> notes;
  naming(path, [&] {
    Call call;
    return call.run([&](const Run& run) {
      notes.clear();
      write_mesh(mesh, path, {.notes = [&](const std::string& line) { notes.push_back(line); }}, run);
      return true;
    });
  });
  warn(notes);
}

// What is in a mesh, which may be broken.
py::dict inspected(const py::object& vertices, const py::object& faces, const py::object& scheme) {
  const ControlMesh mesh = mesh_of(vertices, faces, true);
  const bool natural = scheme.is_none() || is_word(scheme, "auto");
  const Scheme taken = natural ? natural_scheme(mesh) : named(scheme, schemes, "scheme");
  Call call;
  const auto [counts, found, together] = call.run(
      [&](const Run&) { return std::tuple(count_elements(mesh, taken), defects(mesh), coincidences(mesh)); });
  py::dict result = dict_of(counts, {});
  result["scheme"] = name_of(taken);
  py::list legal_too;
  for (const Defect& defect : found) {
    py::dict each = dict_of(defect, {});
    each["legal"] = scheme_answers(taken, defect.kind);
    legal_too.append(each);
  }
  result["defects"] = legal_too;
  result["coincidences"] = dict_of(together, {});
  return result;
}

// Views of a mesh, which keep their surface's memory when update() takes another.

py::capsule keeping(const Surface& surface) {
  return py::capsule(new Surface(surface), [](void* held) { delete static_cast<Surface*>(held); });  // NOLINT
}

py::object faces_of(const ControlMesh& mesh, py::handle owner) {
  static_assert(sizeof(VertexId) == sizeof(std::uint32_t));
  const auto* const corners = reinterpret_cast<const std::uint32_t*>(mesh.face_vertices.data());  // NOLINT
  static constexpr std::uint32_t none = 0;
  const std::size_t n = mesh.face_count(), first = n > 0 ? mesh.face(FaceId(std::size_t{0})).size() : 3;
  bool uniform = true;
  for (std::size_t f = 0; f < n && uniform; ++f) uniform = mesh.face(FaceId(f)).size() == first;
  const auto view = [&](std::vector<py::ssize_t> shape, std::size_t at) {
    std::vector<py::ssize_t> strides(shape.size(), sizeof(std::uint32_t));
    if (shape.size() == 2) strides[0] *= shape[1];
    return read_only<std::uint32_t>(std::move(shape), std::move(strides),
                                    mesh.face_vertices.empty() ? &none : corners + at, owner);
  };
  if (uniform) return view({static_cast<py::ssize_t>(n), static_cast<py::ssize_t>(first)}, 0);
  py::list list;
  for (std::size_t f = 0; f < n; ++f) {
    list.append(view({static_cast<py::ssize_t>(mesh.face(FaceId(f)).size())}, mesh.face_offsets[f]));
  }
  return list;
}

py::list creases_of(const MeshTags& tags) {
  py::list list;
  for (const CreaseTag& tag : tags.creases)
    list.append(py::make_tuple(tag.a.value(), tag.b.value(), tag.sharpness));
  return list;
}
py::list corners_of(const MeshTags& tags) {
  py::list list;
  for (const CornerTag& tag : tags.corners) list.append(py::make_tuple(tag.vertex.value(), tag.sharpness));
  return list;
}
py::list holes_of(const MeshTags& tags) {
  py::list list;
  for (const FaceId face : tags.holes) list.append(face.value());
  return list;
}

// Do along every edge as many faces run one way as the other, and has every face a surface?
bool is_closed(const ControlMesh& mesh) {
  if (!mesh.tags.holes.empty() || mesh.face_count() == 0) return false;
  std::vector<std::uint64_t> edges, reversed;
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(FaceId(f));
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint64_t a = face[k].value(), b = face[(k + 1) % face.size()].value();
      edges.push_back(a << 32 | b);
      reversed.push_back(b << 32 | a);
    }
  }
  std::sort(edges.begin(), edges.end());
  std::sort(reversed.begin(), reversed.end());
  return edges == reversed;
}

// A mesh and the options of its surface as plain Python values, and back.

py::tuple state_of(const ControlMesh& mesh) {
  const std::array<py::ssize_t, 2> shape{static_cast<py::ssize_t>(mesh.points.size()), 3};
  return py::make_tuple(
      py::array_t<double>(shape, reinterpret_cast<const double*>(mesh.points.data())),  // NOLINT
      py::array_t<std::uint32_t>(static_cast<py::ssize_t>(mesh.face_offsets.size()),
                                 mesh.face_offsets.data()),
      py::array_t<std::uint32_t>(
          static_cast<py::ssize_t>(mesh.face_vertices.size()),
          reinterpret_cast<const std::uint32_t*>(mesh.face_vertices.data())),  // NOLINT
      creases_of(mesh.tags), corners_of(mesh.tags), holes_of(mesh.tags),
      mesh.tags.boundary ? py::object(py::str(name_of_value(*mesh.tags.boundary))) : py::object(py::none()),
      name_of_value(mesh.tags.crease_method), name_of_value(mesh.tags.smooth_triangles),
      mesh.tags.scheme ? py::object(py::str(name_of(*mesh.tags.scheme))) : py::object(py::none()));
}

ControlMesh mesh_of_state(const py::tuple& state) {
  if (state.size() != 10) throw py::value_error("not a pickled mesh of snug");
  const Points points(state[0], "vertices");
  const std::vector<std::uint32_t> offsets = indices_of(state[1]), corners = indices_of(state[2]);
  if (offsets.empty() || offsets.front() != 0 || offsets.back() != corners.size() ||
      !std::is_sorted(offsets.begin(), offsets.end())) {
    throw py::value_error("not a pickled mesh of snug");
  }
  ControlMesh mesh = mesh_of(points, offsets, corners);
  add_tags(mesh.tags, state[3], state[4], state[5], state[7], state[8]);
  if (!state[6].is_none()) mesh.tags.boundary = named(state[6], boundaries, "boundary");
  if (!state[9].is_none()) mesh.tags.scheme = named(state[9], schemes, "scheme");
  return mesh;
}

std::string counted_faces(const ControlMesh& mesh) {
  return std::to_string(mesh.face_count()) + (mesh.face_count() == 1 ? " face" : " faces");
}

template <class Class, class MeshOf, class Keep>
void add_mesh_properties(Class& cls, const MeshOf& mesh, const Keep& keep) {
  cls.def_property_readonly(
         "vertices",
         [=](const py::object& self) {
           const py::object owner = keep(self);
           return column(
               std::span<const Point3>(mesh(self).points), [](const Point3& p) -> const Point3& { return p; },
               owner);
         },
         "Control points, (n, 3) float64, a read-only view.")
      .def_property_readonly(
          "faces", [=](const py::object& self) { return faces_of(mesh(self), keep(self)); },
          "Vertices of each face, counter-clockwise: (m, k) uint32 if all faces have k, else a list of\n"
          "arrays. Read-only views.")
      .def_property_readonly(
          "creases", [=](const py::object& self) { return creases_of(mesh(self).tags); },
          "Sharp edges: a list of (vertex, vertex, sharpness); 10 or more is infinite.")
      .def_property_readonly(
          "corners", [=](const py::object& self) { return corners_of(mesh(self).tags); },
          "Sharp vertices: a list of (vertex, sharpness).")
      .def_property_readonly(
          "holes", [=](const py::object& self) { return holes_of(mesh(self).tags); },
          "Faces without a surface: a list.")
      .def(
          "write", [=](const py::object& self, const py::object& path) { write(mesh(self), path); },
          py::arg("path"),
          "Writes the control mesh, completely or not at all: .obj, .off, .ply, .stl, .usda or .glb. What "
          "the format cannot\n"
          "hold becomes a MeshWarning. Raises FileError, MeshError.");
}

const PySurface& native(const py::object& self) { return self.cast<const PySurface&>(); }

}  // namespace

void add_surface(py::module_& module) {
  using py::arg;
  const py::object none = py::none();

  py::class_<PyMesh> mesh(module, "Mesh", "A control mesh with its tags, such as one that was subdivided.");
  mesh.attr("__module__") = "snug";
  add_mesh_properties(
      mesh, [](const py::object& self) -> const ControlMesh& { return self.cast<const PyMesh&>().whole(); },
      [](const py::object& self) { return self; });
  mesh.def("__repr__", [](const PyMesh& self) {
    return "<snug.Mesh " + counted_faces(self.whole()) + ", " + std::to_string(self.mesh.vertex_count()) +
           " vertices>";
  });
  mesh.def(py::pickle([](const PyMesh& self) { return state_of(self.whole()); },
                      [](const py::tuple& state) { return PyMesh{mesh_of_state(state)}; }));

  py::class_<PySurface> surface(
      module, "Surface", "The limit surface of a control mesh. Any number of threads may query it at once.");
  surface.attr("__module__") = "snug";
  surface.def(
      py::init(&surface_of), arg("vertices"), arg("faces") = none, py::kw_only(), arg("scheme") = "auto",
      arg("creases") = none, arg("corners") = none, arg("holes") = none, arg("boundary") = none,
      arg("crease_method") = none, arg("smooth_triangles") = none, arg("sharp") = none, arg("weld") = none,
      arg("bounds") = "rows", arg("tight") = false, arg("threads") = 0, arg("progress") = none,
      "vertices: (n, 3) numbers. faces: (m, k) whole numbers, or a sequence of sequences; "
      "counter-clockwise.\n"
      "Or one object that has them: .vertices with .faces or .triangles (trimesh, Open3D, "
      "snug.Tessellation),\n"
      ".points with .cells (meshio), another Surface or a snug.Mesh, whose scheme and tags are taken.\n\n"
      "scheme: 'loop', 'catmark', 'doo-sabin', 'midedge', 'bilinear', 'flat' or 'auto': that of the surface "
      "or mesh; flat for\n"
      "a mesh of another library whose faces are all triangles, unless creases, sharp and the like say "
      "otherwise; for arrays\n"
      "loop if all faces are triangles, with a MeshWarning, else catmark.\n"
      "creases: (vertex, vertex, sharpness) each. corners: (vertex, sharpness). holes: faces.\n"
      "boundary: 'none', 'edge-only', 'edge-and-corner'. crease_method: 'uniform', 'chaikin'. "
      "smooth_triangles:\n"
      "'catmark', 'smooth'. sharp: degrees, or 'auto' for 30: edges of greater angles become creases.\n"
      "weld: True merges equal vertices, a number those at most so far apart. bounds: 'rows', 'table'.\n"
      "tight: bound every patch at the first query. threads: 0 takes all cores.\n\n"
      "Raises MeshError, whose .elements name what is wrong; ValueError, TypeError for arrays that are no "
      "mesh.");
  add_mesh_properties(
      surface, [](const py::object& self) -> const ControlMesh& { return native(self).surface().mesh(); },
      [](const py::object& self) { return keeping(native(self).surface()); });
  surface
      .def_property_readonly(
          "scheme", [](const PySurface& self) { return name_of(self.surface().scheme()); }, "Its name.")
      .def_property_readonly(
          "boundary", [](const PySurface& self) { return name_of_value(self.surface().boundary()); },
          "How the boundary is subdivided: 'none', 'edge-only' or 'edge-and-corner'.")
      .def_property_readonly(
          "size", [](const PySurface& self) { return self.surface().size(); },
          "Longest side of the bounding box of the vertices that faces use.")
      .def_property_readonly(
          "is_closed", [](const PySurface& self) { return is_closed(self.surface().mesh()); },
          "Do along every edge as many faces run one way as the other, and has every face a surface?")
      .def_property_readonly(
          "nbytes", [](const PySurface& self) { return self.surface().bytes(); },
          "Memory of the surface and its BVH, without the mesh.")
      .def(
          "update",
          [](PySurface& self, const py::object& vertices) {
            const Points points(vertices, "vertices");
            self.update(points.all());
          },
          arg("vertices"),
          "Moves the control points to vertices (n, 3); faces, tags and options stay. Later queries are "
          "about the new surface,\n"
          "whose tree is refitted; arrays that were handed out keep the old one's memory.\n"
          "Raises ValueError, MeshError, and then nothing has changed.")
      .def("__repr__",
           [](const PySurface& self) {
             const Surface& s = self.surface();
             return std::string("<snug.Surface ") + name_of(s.scheme()) + ", " + counted_faces(s.mesh()) +
                    ", size " + text_of(s.size()) + ">";
           })
      .def("__copy__", [](const PySurface& self) { return PySurface(self); })
      .def("__deepcopy__", [](const PySurface& self, const py::object&) { return PySurface(self); })
      .def(py::pickle(
          [](const PySurface& self) {
            const Surface& made = self.surface();
            return py::make_tuple(state_of(made.mesh()), name_of(made.scheme()),
                                  name_of_value(made.boundary()), name_of_value(self.options().bounds),
                                  self.options().tight);
          },
          [](const py::tuple& state) {
            if (state.size() != 5) throw py::value_error("not a pickled surface of snug");
            const SurfaceOptions options = options_of(state[1], state[2], state[3], state[4].cast<bool>());
            return PySurface(mesh_of_state(state[0]), options);
          }));
  module.def(
      "read", &read, arg("path"), py::kw_only(), arg("scheme") = "auto", arg("boundary") = none,
      arg("sharp") = none, arg("weld") = none, arg("bounds") = "rows", arg("tight") = false,
      arg("threads") = 0, arg("progress") = none,
      "The limit surface of a mesh file: OBJ, OFF, PLY, STL, USD (.usda), glTF or 3MF. Keywords are "
      "those of Surface\n"
      "and come before the file's own rules. STL, glTF and 3MF are flat unless scheme or sharp is given. "
      "Notes of the reader, and\n"
      "that triangles of another file are smoothed, become MeshWarnings.\n\n"
      "Raises FileError (.filename, .line), MeshError, ValueError.");
  module.def(
      "read_assembly", &read_parts, arg("path"), py::kw_only(), arg("scheme") = "auto",
      arg("boundary") = none, arg("sharp") = none, arg("weld") = none, arg("bounds") = "rows",
      arg("tight") = false, arg("threads") = 0, arg("progress") = none,
      "The meshes of a file apart, and where it places them (glTF, 3MF, USD): a list of (name, Surface, "
      "pose); instances\n"
      "share their Surface. Of other formats the one mesh. Keywords and errors are those of read().");
  module.def("inspect", &inspected, arg("vertices"), arg("faces") = none, py::kw_only(),
             arg("scheme") = "auto",
             "What is in a mesh, broken ones too, and what is wrong with it, as a dict: counts of its "
             "elements, `defects` (dicts "
             "with kind,\n"
             "text, and legal: does the scheme answer all the same?), and `coincidences`, what stands "
             "together and is not joined.\n\n"
             "vertices, faces, scheme: as Surface takes them. Raises ValueError, TypeError for arrays that "
             "are no mesh.");
  surface.def(
      "topology_of",
      [](const PySurface& self, std::uint32_t face, std::uint32_t part) {
        return value_of(topology_of(self.surface(), {face, part}), {});
      },
      arg("face"), arg("part") = 0,
      "Number of a patch's topology: patches with the same number share their bounds. None if it is a "
      "polynomial. Numbers may "
      "differ\n"
      "from run to run. Raises ValueError for a patch that is not there.");
  add_point_queries(surface, module);
  add_shapes(surface, module);
  add_brep(surface);
  add_contacts(surface, module);
}

}  // namespace snug::python
