#include <snug/io/obj_tags.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <snug/io/number.h>
#include <snug/mesh/tag_names.h>

namespace snug {
namespace {

// As the tag interpolateboundary counts them.
constexpr std::array numbered_rules{BoundaryRule::none, BoundaryRule::edge_and_corner,
                                    BoundaryRule::edge_only};

/// How many integers, numbers and strings a tag announces.
using Counts = std::array<std::size_t, 3>;

std::optional<Counts> parse_counts(std::string_view word) {
  Counts counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t slash = i < 2 ? word.find('/') : word.size();
    if (slash == std::string_view::npos) return std::nullopt;
    const auto count = parse_integer(word.substr(0, slash));
    if (!count || *count < 0) return std::nullopt;
    counts[i] = static_cast<std::size_t>(*count);
    word.remove_prefix(std::min(slash + 1, word.size()));
  }
  return counts;
}

std::uint64_t read_id(const TextCursor& at, std::string_view word) {
  const auto id = parse_integer(word);
  if (!id) at.fail("tag: " + in_quotes(word) + " is not a whole number");
  if (*id < 0) at.fail("tag: index " + std::to_string(*id) + " is negative: tags count from 0");
  return static_cast<std::uint64_t>(*id);
}

double read_sharpness(const TextCursor& at, std::string_view word) {
  const ParsedReal real = parse_real(word);
  if (!real.fault.empty()) {
    at.fail("tag: sharpness " + in_quotes(word) + ' ' + std::string(real.fault));
  }
  if (real.value < 0) at.fail("tag: sharpness " + in_quotes(word) + " is negative");
  return real.value;
}

/// The sharpness of item i of a tag with `count` items: each has its own, or all share one.
double sharpness_of(const std::vector<double>& sharpness, std::size_t i) {
  return sharpness.size() == 1 ? sharpness[0] : sharpness[i];
}

void append_tag(std::string& text, std::string_view head, std::initializer_list<std::uint32_t> ids) {
  text += "t ";
  text += head;
  for (const std::uint32_t id : ids) {
    text += ' ';
    append_integer(text, id);
  }
}

}  // namespace

void ObjTagReader::read(TextCursor& at) {
  const std::string_view name = at.word();
  constexpr std::array<std::string_view, 6> known{"crease", "corner",       "interpolateboundary",
                                                  "hole",   "creasemethod", "smoothtriangles"};
  if (std::find(known.begin(), known.end(), name) == known.end()) return ignore(at, name);

  const Values values = read_values(at, name);
  const auto refuse_choice = [&](const std::string& choices) {
    const std::string given = values.ids.empty() ? in_quotes(values.text) : std::to_string(values.ids[0]);
    at.fail("tag " + std::string(name) + ": " + given + " is not one of " + choices);
  };
  if (name == "crease") {
    read_crease(at, values);
  } else if (name == "corner") {
    read_corner(at, values);
  } else if (name == "hole") {
    for (const std::uint64_t id : values.ids) tags_.holes.push_back(face(at, id));
  } else if (name == "interpolateboundary") {
    if (values.ids.empty() || values.ids[0] >= numbered_rules.size()) refuse_choice("0, 1 and 2");
    tags_.boundary = numbered_rules[values.ids[0]];
  } else {
    const auto choose = [&](const auto& names, auto& choice) {
      const auto chosen = value_in(names, values.text);
      if (!chosen) refuse_choice(listed(all_names(names), "and"));
      choice = *chosen;
    };
    name == "creasemethod" ? choose(crease_method_names, tags_.crease_method)
                           : choose(smooth_triangles_names, tags_.smooth_triangles);
  }
}

void ObjTagReader::ignore(const TextCursor& at, std::string_view name) {
  if (!notes_ || name == "facevaryinginterpolateboundary") return;
  if (!ignored_.emplace(name).second) return;
  notes_(at.located("tag " + in_quotes(name) + " is ignored: the surface is the one without it"));
}

ObjTagReader::Values ObjTagReader::read_values(TextCursor& at, std::string_view name) {
  const std::string_view counts_word = at.word();
  const auto counts = parse_counts(counts_word);
  if (!counts) {
    at.fail("tag " + std::string(name) + ": " + in_quotes(counts_word) +
            " does not count integers/floats/strings, as in 2/1/0");
  }
  const auto next = [&] {
    const std::string_view word = at.word();
    if (word.empty()) {
      at.fail("tag " + std::string(name) + ": the line ends before the values that " +
              in_quotes(counts_word) + " announces");
    }
    return word;
  };
  Values values;
  for (std::size_t i = 0; i < (*counts)[0]; ++i) values.ids.push_back(read_id(at, next()));
  for (std::size_t i = 0; i < (*counts)[1]; ++i) values.sharpness.push_back(read_sharpness(at, next()));
  for (std::size_t i = 0; i < (*counts)[2]; ++i) values.text = next();
  if (const std::string_view extra = at.word(); !extra.empty()) {
    at.fail("tag " + std::string(name) + ": " + in_quotes(extra) + " is more than " + in_quotes(counts_word) +
            " announces");
  }
  return values;
}

void ObjTagReader::read_crease(const TextCursor& at, const Values& values) {
  const std::size_t vertices = values.ids.size();
  if (vertices < 2) at.fail("tag crease: a crease needs two vertices");
  if (values.sharpness.size() != 1 && values.sharpness.size() != vertices - 1) {
    at.fail("tag crease: give one sharpness, or one for each edge");
  }
  for (std::size_t i = 0; i + 1 < vertices; ++i) {
    const VertexId a = vertex(at, values.ids[i]), b = vertex(at, values.ids[i + 1]);
    tags_.creases.push_back({a, b, sharpness_of(values.sharpness, i)});
  }
}

void ObjTagReader::read_corner(const TextCursor& at, const Values& values) {
  const std::size_t vertices = values.ids.size();
  if (vertices < 1) at.fail("tag corner: a corner needs a vertex");
  if (values.sharpness.size() != 1 && values.sharpness.size() != vertices) {
    at.fail("tag corner: give one sharpness, or one for each vertex");
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    tags_.corners.push_back({vertex(at, values.ids[i]), sharpness_of(values.sharpness, i)});
  }
}

VertexId ObjTagReader::vertex(const TextCursor& at, std::uint64_t id) {
  if (id >= most_elements) at.fail("tag: vertex " + std::to_string(id) + " does not exist");
  if (largest_vertex_.line == 0 || id > largest_vertex_.id) largest_vertex_ = {id, at.line()};
  return VertexId(id);
}

FaceId ObjTagReader::face(const TextCursor& at, std::uint64_t id) {
  if (id >= most_elements) at.fail("tag: face " + std::to_string(id) + " does not exist");
  if (largest_face_.line == 0 || id > largest_face_.id) largest_face_ = {id, at.line()};
  return FaceId(id);
}

MeshTags ObjTagReader::finish(const TextCursor& at, std::size_t vertex_count, std::size_t face_count) {
  const auto check = [&](const Reference& largest, std::size_t count, const std::string& what) {
    if (largest.line == 0 || largest.id < count) return;
    at.fail_at(largest.line, "tag: " + what + ' ' + std::to_string(largest.id) +
                                 " does not exist: tags count from 0 to " + std::to_string(count - 1) +
                                 " here");
  };
  check(largest_vertex_, vertex_count, "vertex");
  check(largest_face_, face_count, "face");
  return std::move(tags_);
}

void append_obj_tags(std::string& text, const MeshTags& tags) {
  if (tags.boundary) {
    const auto number = std::find(numbered_rules.begin(), numbered_rules.end(), *tags.boundary);
    append_tag(text, "interpolateboundary 1/0/0",
               {static_cast<std::uint32_t>(number - numbered_rules.begin())});
    text += '\n';
  }
  const auto append_choice = [&](const char* head, const char* name) {
    append_tag(text, head, {});
    text += std::string(" ") + name + '\n';
  };
  if (tags.crease_method != MeshTags{}.crease_method) {
    append_choice("creasemethod 0/0/1", name_in(crease_method_names, tags.crease_method));
  }
  if (tags.smooth_triangles != MeshTags{}.smooth_triangles) {
    append_choice("smoothtriangles 0/0/1", name_in(smooth_triangles_names, tags.smooth_triangles));
  }
  for (const CreaseTag& crease : tags.creases) {
    append_tag(text, "crease 2/1/0", {crease.a.value(), crease.b.value()});
    text += ' ';
    append_real(text, crease.sharpness);
    text += '\n';
  }
  for (const CornerTag& corner : tags.corners) {
    append_tag(text, "corner 1/1/0", {corner.vertex.value()});
    text += ' ';
    append_real(text, corner.sharpness);
    text += '\n';
  }
  for (const FaceId hole : tags.holes) {
    append_tag(text, "hole 1/0/0", {hole.value()});
    text += '\n';
  }
}

}  // namespace snug
