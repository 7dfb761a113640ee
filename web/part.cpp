// Surfaces of files and of arrays.

#include "part.h"
#include "fields.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace snug::web {

std::uint32_t index_of(double number, const char* what) {
  if (!(number >= 0 && number < 0x1p32 - 1 && number == std::floor(number))) {
    throw InputError(InputProblem::value, std::string(what) + ": give whole numbers from 0 to 2^32 - 2");
  }
  return static_cast<std::uint32_t>(number);
}

std::vector<double> numbers_of(const val& object, const char* name, std::size_t each) {
  std::vector<double> numbers;
  if (given(object, name)) numbers = emscripten::convertJSArrayToNumberVector<double>(object[name]);
  if (numbers.size() % each != 0) {
    throw InputError(InputProblem::value, std::string(name) + ": give " + std::to_string(each) +
                                              " numbers each; " + std::to_string(numbers.size()) +
                                              " are not a multiple");
  }
  return numbers;
}

ReadOptions reading_of(const val& options, std::vector<std::string>& notes) {
  const auto file = [files = given(options, "files") ? options["files"]
                                                     : val::undefined()](const std::string& path) {
    const val bytes = files.isUndefined() ? files : files(path);
    if (bytes.isUndefined())
      throw InputError(InputProblem::unreadable, path + ": this file is not among the option `files`");
    return bytes.as<std::string>();
  };
  return {.notes = [&](const std::string& line) { notes.push_back(line); }, .other_file = file};
}

namespace {

const char* name_of_boundary(BoundaryRule rule) {
  constexpr std::array<const char*, 3> names{"none", "edge-only", "edge-and-corner"};
  return names[static_cast<std::size_t>(rule)];
}

bool has_creases(Scheme scheme) { return scheme != Scheme::doo_sabin && scheme != Scheme::midedge; }

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

// {points, triangles} or {points, offsets, corners}, {creases, sharpCorners, holes}: all flat.
ControlMesh mesh_of(const val& arrays) {
  ControlMesh mesh;
  const std::vector<double> points = numbers_of(arrays, "points", 3);
  for (std::size_t i = 0; i < points.size(); i += 3)
    mesh.points.push_back({points[i], points[i + 1], points[i + 2]});
  const bool triangular = given(arrays, "triangles");
  if (triangular == given(arrays, "offsets") || given(arrays, "offsets") != given(arrays, "corners")) {
    throw InputError(InputProblem::value, "give either triangles, or offsets and corners");
  }
  const char* const name = triangular ? "triangles" : "corners";
  for (const double v : numbers_of(arrays, name, triangular ? 3 : 1))
    mesh.face_vertices.emplace_back(index_of(v, name));
  if (triangular) {
    for (std::size_t end = 3; end <= mesh.face_vertices.size(); end += 3)
      mesh.face_offsets.push_back(static_cast<std::uint32_t>(end));
  } else {
    mesh.face_offsets.clear();
    for (const double v : numbers_of(arrays, "offsets", 1))
      mesh.face_offsets.push_back(index_of(v, "offsets"));
    if (mesh.face_offsets.empty() || mesh.face_offsets.front() != 0 ||
        !std::is_sorted(mesh.face_offsets.begin(), mesh.face_offsets.end()) ||
        mesh.face_offsets.back() != mesh.face_vertices.size()) {
      throw InputError(InputProblem::value,
                       "offsets: give one a face, the first 0, none below the one before, and at the end the "
                       "number of corners");
    }
  }
  const std::vector<double> creases = numbers_of(arrays, "creases", 3);
  for (std::size_t i = 0; i < creases.size(); i += 3) {
    mesh.tags.creases.push_back({VertexId(index_of(creases[i], "creases")),
                                 VertexId(index_of(creases[i + 1], "creases")), creases[i + 2]});
  }
  const std::vector<double> corners = numbers_of(arrays, "sharpCorners", 2);
  for (std::size_t i = 0; i < corners.size(); i += 2)
    mesh.tags.corners.push_back({VertexId(index_of(corners[i], "sharpCorners")), corners[i + 1]});
  for (const double f : numbers_of(arrays, "holes", 1)) mesh.tags.holes.emplace_back(index_of(f, "holes"));
  return mesh;
}

std::optional<Scheme> scheme_of(const val& options) {
  const auto word = option<std::string>(options, "scheme");
  if (!word || *word == "auto") return {};
  return named<Scheme>(*word, scheme_count, "scheme", [](Scheme s) { return name_of(s); });
}

val handed(std::shared_ptr<Part> part) {
  val result = val::object();
  result.set("part", std::move(part));
  return result;
}

val read_part(const std::string& bytes, const std::string& name, const val& options) {
  return guarded([&] {
    std::vector<std::string> notes;
    ControlMesh mesh = parse_mesh(bytes, name, reading_of(options, notes));
    return handed(std::make_shared<Part>(std::move(mesh), name, options, std::move(notes)));
  });
}

val part_of_arrays(const val& arrays, const val& options) {
  return guarded([&] { return handed(std::make_shared<Part>(mesh_of(arrays), "arrays", options)); });
}

// What is in a mesh, broken ones too, and what is wrong with it.
val inspected(const val& arrays, const val& options) {
  return guarded([&] {
    const ControlMesh mesh = mesh_of(arrays);
    const std::optional<Scheme> scheme = scheme_of(options);
    const Scheme taken = scheme ? *scheme : natural_scheme(mesh);
    val result = object_of(count_elements(mesh, taken));
    val list = val::array();
    for (const Defect& defect : defects(mesh)) {
      val each = object_of(defect);
      each.set("legal", scheme_answers(taken, defect.kind));
      list.call<void>("push", each);
    }
    result.set("scheme", word(name_of(taken)));
    result.set("defects", list);
    result.set("coincidences", object_of(coincidences(mesh)));
    return result;
  });
}

// The bytes of a file of this name.
val written(const Part& part, const std::string& name) {
  return guarded([&] {
    ControlMesh mesh = part.surface().mesh();
    mesh.tags.scheme = part.surface().scheme();
    const std::string bytes = format_mesh(mesh, name);
    return copied(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));  // NOLINT
  });
}

}  // namespace

Part::Part(ControlMesh mesh, const std::string& name, const val& options, std::vector<std::string> notes)
    : notes_(std::move(notes)), surface_(made(std::move(mesh), name, options)) {}

std::string Part::boundary() const { return name_of_boundary(surface_.boundary()); }

val Part::notes() const {
  val list = val::array();
  for (const std::string& line : notes_) list.call<void>("push", line);
  return list;
}

Surface Part::made(ControlMesh mesh, const std::string& name, const val& options) {
  SurfaceOptions how;
  how.tight = option<bool>(options, "tight").value_or(false);
  how.scheme = scheme_of(options);
  if (const auto word = option<std::string>(options, "boundary")) {
    how.boundary = named<BoundaryRule>(*word, 3, "boundary", name_of_boundary);
  }
  const std::optional<double> sharp = option<double>(options, "sharp");
  if (sharp && how.scheme && !has_creases(*how.scheme)) {
    throw InputError(InputProblem::value, std::string("sharp: ") + name_of(*how.scheme) +
                                              " has no creases; choose loop or catmark");
  }
  how.notes = [&](const std::string& line) { notes_.push_back(name + ": " + line); };
  try {
    if (const auto distance = option<double>(options, "weld")) weld(mesh, *distance);
    if (sharp) sharpen(mesh, *sharp);
    return Surface(std::move(mesh), how, {.threads = 1});
  } catch (const InputError& error) {
    throw InputError(error.problem(), name + ": " + error.what());
  }
}

}  // namespace snug::web

EMSCRIPTEN_BINDINGS(part) {
  using namespace snug::web;  // NOLINT
  emscripten::class_<Part>("Part")
      .smart_ptr<std::shared_ptr<Part>>("PartPointer")
      .property("size", &Part::size)
      .property("scheme", &Part::scheme)
      .property("boundary", &Part::boundary)
      .property("notes", &Part::notes);
  emscripten::function("read", &read_part);
  emscripten::function("fromArrays", &part_of_arrays);
  emscripten::function("inspect", &inspected);
  emscripten::function("write", &written);
}
