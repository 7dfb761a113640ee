#include <snug/io/usda_prims.h>

#include <algorithm>

#include <snug/io/usda_text.h>
#include <snug/mesh.h>
#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

using TokenKind = UsdaToken::Kind;

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::find(words, word) != words.end();
}

/// Metadata by which a prim gets content from elsewhere.
bool is_arc(std::string_view name) {
  return is_one_of(name, {"references", "payload", "inherits", "specializes", "variantSets", "subLayers"});
}
bool is_list_operation(std::string_view word) {
  return is_one_of(word, {"prepend", "append", "add", "delete", "reorder"});
}

class PrimReader {
 public:
  PrimReader(std::string_view text, const std::string& name) : text_(text, name) {}

  UsdaStage read() {
    if (text_.take_if('(')) read_metadata(UsdaPrim::no_parent);
    while (text_.peek().kind != TokenKind::end) read_statement();
    if (prim_ != UsdaPrim::no_parent) {
      const UsdaPrim& open = stage_.prims[prim_];
      text_.fail("the file ends within the prim " + in_quotes(open.name) + " of line " +
                 std::to_string(open.line) + ": it is truncated, or a bracket is missing");
    }
    return std::move(stage_);
  }

 private:
  /// One statement of the prim that is open, or of the file; or the end of the prim.
  void read_statement() {
    if (text_.take_if(';')) return;
    const bool in_prim = prim_ != UsdaPrim::no_parent;
    if (in_prim && text_.take_if('}')) {
      prim_ = stage_.prims[prim_].parent;
      --depth_;
      return;
    }
    const UsdaToken& token = text_.peek();
    if (token.kind != TokenKind::word) fail_at_statement();
    if (is_one_of(token.text, {"def", "over", "class"})) return open_prim();
    if (token.is("reorder")) return skip_reordering();
    if (!in_prim) fail_at_statement();
    if (token.is("variantSet")) return skip_variants();
    read_property();
  }

  [[noreturn]] void fail_at_statement() const {
    text_.fail(named(text_.peek()) + " found where a prim begins, as in def Mesh \"name\"" +
               (prim_ == UsdaPrim::no_parent ? "" : ", or an attribute, or } for the end of the prim"));
  }

  void open_prim() {
    constexpr std::size_t max_levels = 1000;
    if (++depth_ > max_levels) text_.fail("prims are nested deeper than " + std::to_string(max_levels));
    UsdaPrim prim;
    prim.line = text_.line();
    const UsdaToken specifier = text_.take();
    prim.specifier = specifier.is("def")    ? UsdaSpecifier::def
                     : specifier.is("over") ? UsdaSpecifier::over
                                            : UsdaSpecifier::abstract;
    if (text_.peek().kind == TokenKind::word) prim.type = text_.take().text;
    if (text_.peek().kind != TokenKind::text) {
      text_.fail(named(text_.peek()) + " found where the name of a prim is expected, in quotes");
    }
    prim.name = text_.take().text;
    prim.parent = prim_;
    if (prim.type == "Mesh") prim.mesh = std::make_unique<UsdaMesh>();
    prim_ = stage_.prims.size();
    stage_.prims.push_back(std::move(prim));
    if (text_.take_if('(')) read_metadata(prim_);
    text_.expect('{', "at the begin of the prim");
  }

  void skip_reordering() {
    text_.take();
    while (text_.peek().kind == TokenKind::word) text_.take();
    text_.expect('=', "in a reordering");
    text_.skip_value();
  }

  void skip_variants() {
    note_arc(text_.take().text, text_.line());
    text_.skip_value();  // the name
    text_.expect('=', "behind the name of a variantSet");
    text_.skip_value();
  }

  void note_arc(std::string_view name, std::size_t line) {
    UsdaPlace& arc = stage_.prims[prim_].arc;
    if (arc.line == 0) arc = {name, line};
  }

  // --- metadata

  /// Of a prim or the file; the bracket has been taken.
  void read_metadata(std::size_t prim) {
    while (!text_.take_if(')')) {
      if (text_.take_if(';')) continue;
      if (text_.peek().kind == TokenKind::text) {  // a comment
        text_.take();
        continue;
      }
      const std::size_t line = text_.line();
      UsdaToken name = text_.take();
      const bool lists = name.kind == TokenKind::word && is_list_operation(name.text) &&
                         text_.peek().kind == TokenKind::word;
      const bool removes = lists && is_one_of(name.text, {"delete", "reorder"});
      if (lists) name = text_.take();
      if (name.kind != TokenKind::word) {
        text_.fail_at(line, named(name) + " found where metadata begins, as in key = value");
      }
      if (text_.take_if('=')) read_metadatum(prim, name.text, line, removes);
    }
  }

  void read_metadatum(std::size_t prim, std::string_view name, std::size_t line, bool removes) {
    const bool of_file = prim == UsdaPrim::no_parent;
    if (is_arc(name) && !removes) {
      const bool is_list = text_.peek().is('[');
      bool empty = text_.peek().is("None");
      if (is_list) {
        text_.take();
        empty = text_.peek().is(']');
        text_.skip_group('[');
      } else {
        text_.skip_value();
      }
      if (!empty && of_file) {
        text_.fail_at(line, "sublayers are not read: flatten the file, usdcat --flatten -o flat.usda");
      }
      if (!empty) note_arc(name, line);
    } else if (!of_file && name == "active") {
      const UsdaToken value = text_.take();
      stage_.prims[prim].active = !(value.is("false") || value.is("0") || value.is("False"));
    } else if (of_file && name == "metersPerUnit") {
      stage_.metres_per_unit = text_.real(name);
    } else if (of_file && name == "upAxis" && text_.peek().kind == TokenKind::text) {
      stage_.up_axis = text_.take().text;
    } else {
      text_.skip_value();
    }
    if (text_.take_if('(')) text_.skip_group('(');  // the offset of a layer
  }

  // --- attributes

  void read_property() {
    UsdaToken word = take_word("an attribute");
    while (is_list_operation(word.text) || is_one_of(word.text, {"custom", "uniform", "varying", "config"})) {
      word = take_word("an attribute");
    }
    const bool is_relation = word.is("rel");
    const bool is_array = text_.take_if('[');
    if (is_array) text_.expect(']', "behind the type of an attribute");
    const std::size_t line = text_.line();
    const std::string_view name = take_word("the name of an attribute").text;
    if (text_.take_if('=')) {
      const std::size_t dot = is_relation ? std::string_view::npos : name.rfind('.');
      const std::string_view suffix = dot == std::string_view::npos ? "" : name.substr(dot + 1);
      read_value(is_relation ? "" : name.substr(0, dot), suffix, line, is_array);
    }
    if (text_.take_if('(')) text_.skip_group('(');
  }

  UsdaToken take_word(const char* what) {
    if (text_.peek().kind != TokenKind::word) {
      text_.fail(named(text_.peek()) + " found where " + what + " is expected");
    }
    return text_.take();
  }

  /// Of the attribute of this name; the suffix follows a dot.
  void read_value(std::string_view name, std::string_view suffix, std::size_t line, bool is_array) {
    UsdaPrim& prim = stage_.prims[prim_];
    const auto known = std::ranges::find(usda_attribute_names, name);
    const bool of_mesh = prim.mesh && known != usda_attribute_names.end();
    const bool of_any =
        name == "xformOpOrder" || name.starts_with("xformOp:") || name == "visibility" || name == "purpose";
    if (suffix == "timeSamples" || suffix == "spline") {
      if (of_mesh || of_any) prim.samples.push_back({name, line});
      return text_.skip_value();
    }
    if ((!of_mesh && !of_any) || (!suffix.empty() && suffix != "default")) return text_.skip_value();
    if (text_.take_if("None")) return;
    if (of_mesh) {
      const auto number = static_cast<std::size_t>(known - usda_attribute_names.begin());
      read_mesh_value(*prim.mesh, static_cast<UsdaAttribute>(number), line, is_array);
    } else if (name == "visibility") {
      prim.invisible = take_text(name) == "invisible";
    } else if (name == "purpose") {
      prim.purpose = take_text(name);
    } else {
      read_operation(prim, name, line);
    }
  }

  void read_mesh_value(UsdaMesh& mesh, UsdaAttribute attribute, std::size_t line, bool is_array) {
    const auto number = static_cast<std::size_t>(attribute);
    const std::string_view name = usda_attribute_names[number];
    if (mesh.lines[number] != 0) {
      text_.fail_at(line, in_quotes(name) + " is given in line " + std::to_string(mesh.lines[number]) +
                              " already: take one of the two out");
    }
    mesh.lines[number] = line;
    const auto tokens = [&](std::string_view& value) { value = take_text(name); };
    const auto integers = [&](std::vector<std::int64_t>& values) {
      require_array(name, is_array);
      text_.list(name, [&] { values.push_back(take_integer(name)); });
    };
    const auto reals = [&](std::vector<double>& values) {
      require_array(name, is_array);
      text_.list(name, [&] { values.push_back(take_sharpness(name)); });
    };
    switch (attribute) {
      case UsdaAttribute::points:
        require_array(name, is_array);
        return text_.list(name, [&] { mesh.points.push_back(take_point(mesh.points.size())); });
      case UsdaAttribute::face_counts:
        return integers(mesh.face_counts);
      case UsdaAttribute::face_indices:
        return integers(mesh.face_indices);
      case UsdaAttribute::scheme:
        return tokens(mesh.scheme);
      case UsdaAttribute::boundary:
        return tokens(mesh.boundary);
      case UsdaAttribute::triangle_rule:
        return tokens(mesh.triangle_rule);
      case UsdaAttribute::orientation:
        return tokens(mesh.orientation);
      case UsdaAttribute::crease_indices:
        return integers(mesh.crease_indices);
      case UsdaAttribute::crease_lengths:
        return integers(mesh.crease_lengths);
      case UsdaAttribute::crease_sharpness:
        return reals(mesh.crease_sharpness);
      case UsdaAttribute::corner_indices:
        return integers(mesh.corner_indices);
      case UsdaAttribute::corner_sharpness:
        return reals(mesh.corner_sharpness);
      case UsdaAttribute::holes:
        return integers(mesh.holes);
    }
  }

  void require_array(std::string_view name, bool is_array) const {
    if (!is_array) text_.fail(in_quotes(name) + " is not declared as an array: its type must end in []");
  }

  std::string_view take_text(std::string_view name) {
    if (text_.peek().kind != TokenKind::text) {
      text_.fail(std::string(name) + ": " + named(text_.peek()) + " is not a word in quotes");
    }
    return text_.take().text;
  }

  std::int64_t take_integer(std::string_view name) {
    const UsdaToken& token = text_.peek();
    const auto value = token.kind == TokenKind::word ? parse_integer(token.text) : std::nullopt;
    if (!value) text_.fail(std::string(name) + ": " + named(token) + " is not a whole number");
    text_.take();
    return *value;
  }

  /// `inf` is infinite_sharpness.
  double take_sharpness(std::string_view name) {
    const double value = text_.take_if("inf") ? infinite_sharpness : text_.real(name);
    if (value < 0) text_.fail(std::string(name) + ": a sharpness is negative");
    return value;
  }

  Point3 take_point(std::size_t vertex) {
    const std::string what = "vertex " + std::to_string(vertex);
    Point3 point;
    text_.expect('(', "before the coordinates of " + what);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (axis > 0) text_.expect(',', "between the coordinates of " + what);
      point[axis] = text_.real(what);
    }
    text_.take_if(',');
    text_.expect(')', "behind the coordinates of " + what);
    return point;
  }

  void read_operation(UsdaPrim& prim, std::string_view name, std::size_t line) {
    if (!prim.operations) prim.operations = std::make_unique<UsdaOperations>();
    UsdaOperations& operations = *prim.operations;
    if (name == "xformOpOrder") {
      if (operations.order_line != 0) text_.fail_at(line, "xformOpOrder is given twice: take one out");
      operations.order_line = line;
      text_.list(name, [&] { operations.order.push_back(take_text(name)); });
      return;
    }
    constexpr std::size_t max_numbers = 16;
    const bool is_new =
        operations.given.insert({name, {text_.reals(in_quotes(name), max_numbers), line}}).second;
    if (!is_new) text_.fail_at(line, in_quotes(name) + " is given twice: take one out");
  }

  UsdaText text_;
  UsdaStage stage_;
  std::size_t prim_ = UsdaPrim::no_parent;  // that is open
  std::size_t depth_ = 0;
};

}  // namespace

UsdaStage read_usda_prims(std::string_view text, const std::string& name) {
  return PrimReader(text, name).read();
}

}  // namespace snug
