#include <snug/io/obj_tags.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <snug/mesh/tag_names.h>
#include <snug/scheme/rules.h>
#include <support/number.h>

namespace snug {
namespace {

// As the tag interpolateboundary counts them.
constexpr std::array numbered_rules{BoundaryRule::none, BoundaryRule::edge_and_corner,
                                    BoundaryRule::edge_only};

std::optional<std::array<std::size_t, 3>> parse_counts(std::string_view word) {
  std::array<std::size_t, 3> counts{};
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

/// Values of a tag, which first states how many integers, numbers and strings follow.
struct Values {
  std::vector<std::uint64_t> ids;
  std::vector<double> sharpness;
  std::string text;
};

Values read_values(TextCursor& at, const std::string& tag) {
  const std::string_view counts_word = at.word();
  const auto counts = parse_counts(counts_word);
  if (!counts) {
    at.fail(tag + in_quotes(counts_word) + " does not count integers/floats/strings, as in 2/1/0");
  }
  const auto next = [&] {
    const std::string_view word = at.word();
    if (word.empty()) {
      at.fail(tag + "the line ends before the values that " + in_quotes(counts_word) + " announces");
    }
    return word;
  };
  Values values;
  for (std::size_t i = 0; i < (*counts)[0]; ++i) values.ids.push_back(read_id(at, next()));
  for (std::size_t i = 0; i < (*counts)[1]; ++i) values.sharpness.push_back(read_sharpness(at, next()));
  for (std::size_t i = 0; i < (*counts)[2]; ++i) values.text = next();
  if (const std::string_view extra = at.word(); !extra.empty()) {
    at.fail(tag + in_quotes(extra) + " is more than " + in_quotes(counts_word) + " announces");
  }
  return values;
}

/// Each of `count` items has a sharpness of its own, or all share one.
void spread_sharpness(const TextCursor& at, const std::string& tag, std::vector<double>& sharpness,
                      std::size_t count, const char* item) {
  if (sharpness.size() != 1 && sharpness.size() != count) {
    at.fail(tag + "give one sharpness, or one for each " + item);
  }
  sharpness.resize(count, sharpness[0]);
}

std::string names_of_schemes() {
  std::string names;
  for (const SchemeRules* rules : all_rules())
    names += (names.empty() ? "" : ", ") + std::string(rules->name);
  return names;
}

void append_tag(std::string& text, std::string_view head, std::initializer_list<std::uint32_t> ids,
                std::optional<double> sharpness = {}) {
  text += head;
  for (const std::uint32_t id : ids) {
    text += ' ';
    append_integer(text, id);
  }
  if (sharpness) {
    text += ' ';
    append_real(text, *sharpness);
  }
  text += '\n';
}

}  // namespace

void ObjTagReader::read(TextCursor& at) {
  const std::string_view name = at.word();
  constexpr std::array<std::string_view, 7> known{
      "crease", "corner", "interpolateboundary", "hole", "creasemethod", "smoothtriangles", "scheme"};
  if (std::find(known.begin(), known.end(), name) == known.end()) return ignore(at, name);

  const std::string tag = "tag " + std::string(name) + ": ";
  Values values = read_values(at, tag);
  const auto refuse_choice = [&](const std::string& choices) {
    const std::string given = values.ids.empty() ? in_quotes(values.text) : std::to_string(values.ids[0]);
    at.fail(tag + given + " is not one of " + choices);
  };
  const std::size_t count = values.ids.size();
  if (name == "crease") {
    if (count < 2) at.fail(tag + "a crease needs two vertices");
    spread_sharpness(at, tag, values.sharpness, count - 1, "edge");
    for (std::size_t i = 0; i + 1 < count; ++i) {
      const VertexId a = VertexId(reference(at, values.ids[i], vertices_)),
                     b = VertexId(reference(at, values.ids[i + 1], vertices_));
      tags_.creases.push_back({a, b, values.sharpness[i]});
    }
  } else if (name == "corner") {
    if (count < 1) at.fail(tag + "a corner needs a vertex");
    spread_sharpness(at, tag, values.sharpness, count, "vertex");
    for (std::size_t i = 0; i < count; ++i) {
      tags_.corners.push_back({VertexId(reference(at, values.ids[i], vertices_)), values.sharpness[i]});
    }
  } else if (name == "hole") {
    for (const std::uint64_t id : values.ids) tags_.holes.emplace_back(reference(at, id, faces_));
  } else if (name == "interpolateboundary") {
    if (values.ids.empty() || values.ids[0] >= numbered_rules.size()) refuse_choice("0, 1 and 2");
    tags_.boundary = numbered_rules[values.ids[0]];
  } else if (name == "scheme") {
    const SchemeRules* const rules = rules_named(values.text);
    if (!rules) refuse_choice(names_of_schemes());
    tags_.scheme = rules->scheme;
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

std::size_t ObjTagReader::reference(const TextCursor& at, std::uint64_t id, Largest& largest) {
  if (id >= max_elements) {
    at.fail(std::string("tag: ") + largest.kind + ' ' + std::to_string(id) + " does not exist");
  }
  if (largest.line == 0 || id > largest.id) {
    largest.id = id;
    largest.line = at.line();
  }
  return id;
}

MeshTags ObjTagReader::finish(const TextCursor& at, std::size_t vertex_count, std::size_t face_count) {
  const auto check = [&](const Largest& largest, std::size_t count) {
    if (largest.line == 0 || largest.id < count) return;
    at.fail_at(largest.line, std::string("tag: ") + largest.kind + ' ' + std::to_string(largest.id) +
                                 " does not exist: tags count from 0 to " + std::to_string(count - 1) +
                                 " here");
  };
  check(vertices_, vertex_count);
  check(faces_, face_count);
  return std::move(tags_);
}

void append_obj_tags(std::string& text, const MeshTags& tags) {
  if (tags.scheme) text += std::string("t scheme 0/0/1 ") + name_of(*tags.scheme) + '\n';
  if (tags.boundary) {
    const auto number = std::find(numbered_rules.begin(), numbered_rules.end(), *tags.boundary);
    append_tag(text, "t interpolateboundary 1/0/0",
               {static_cast<std::uint32_t>(number - numbered_rules.begin())});
  }
  if (tags.crease_method != MeshTags{}.crease_method) {
    text += std::string("t creasemethod 0/0/1 ") + name_in(crease_method_names, tags.crease_method) + '\n';
  }
  if (tags.smooth_triangles != MeshTags{}.smooth_triangles) {
    text += std::string("t smoothtriangles 0/0/1 ") + name_in(smooth_triangles_names, tags.smooth_triangles) +
            '\n';
  }
  for (const CreaseTag& crease : tags.creases) {
    append_tag(text, "t crease 2/1/0", {crease.a.value(), crease.b.value()}, crease.sharpness);
  }
  for (const CornerTag& corner : tags.corners) {
    append_tag(text, "t corner 1/1/0", {corner.vertex.value()}, corner.sharpness);
  }
  for (const FaceId hole : tags.holes) append_tag(text, "t hole 1/0/0", {hole.value()});
}

}  // namespace snug
