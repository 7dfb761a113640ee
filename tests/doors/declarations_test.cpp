// What is written about answers says what <snug/fields.h> says: the types of the Python module and of the JavaScript package, which
// this test writes with SNUG_WRITE_DOORS=1, and the tables of the command's JSON.

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <snug/fields.h>

namespace snug::testing::declarations_test {
namespace {

template <class V>
inline constexpr bool is_optional = false;
template <class V>
inline constexpr bool is_optional<std::optional<V>> = true;
template <class V>
inline constexpr bool is_vector = false;
template <class V>
inline constexpr bool is_vector<std::vector<V>> = true;
template <class V>
inline constexpr bool is_array = false;
template <class V, std::size_t N>
inline constexpr bool is_array<std::array<V, N>> = true;
template <class V, class... All>
inline constexpr bool is_one_of = (std::is_same_v<V, All> || ...);
template <class V>
inline constexpr bool is_witness = is_one_of<V, WitnessPoints, std::optional<WitnessPoints>>;

// What a struct is called where it is not alone.
template <class V>
inline constexpr const char* name_in_types = "";
#define SNUG_NAMED(Type, name) \
  template <>                  \
  inline constexpr const char* name_in_types<Type> = name
SNUG_NAMED(Verdict, "Verdict");
SNUG_NAMED(SelfVerdict, "SelfVerdict");
SNUG_NAMED(DeviationVerdict, "DeviationVerdict");
SNUG_NAMED(Outcome, "Outcome");
SNUG_NAMED(HullFault, "HullFault");
SNUG_NAMED(Point3, "Point");
SNUG_NAMED(Vector3, "Point");
SNUG_NAMED(Interval, "Interval");
SNUG_NAMED(Place, "Place");
SNUG_NAMED(PatchPlace, "PatchPlace");
SNUG_NAMED(SearchStats, "SearchStats");
SNUG_NAMED(fields::SelfContactStats, "SelfContactStats");
SNUG_NAMED(fields::MeasureStats, "MeasureStats");
SNUG_NAMED(ClearanceSpan, "ClearanceSpan");
SNUG_NAMED(PatchContact, "PatchContact");
SNUG_NAMED(ContactRegion, "ContactRegion");
SNUG_NAMED(CurveBox, "CurveBox");
SNUG_NAMED(IntersectionCurve, "IntersectionCurve");
SNUG_NAMED(ContactArea, "ContactArea");
SNUG_NAMED(OpenBox, "OpenBox");
SNUG_NAMED(SelfContactPair, "SelfContactPair");
SNUG_NAMED(RayHit, "RayHit");
SNUG_NAMED(HullProblem, "HullProblem");
SNUG_NAMED(Hull, "Hull");
SNUG_NAMED(OneSidedDistance, "OneSidedDistance");
#undef SNUG_NAMED

// The types of JavaScript: web/fields.h.

template <class V>
std::string script_type() {
  if constexpr (std::is_same_v<V, std::optional<std::size_t>>) {
    return "0 | 1 | null";
  } else if constexpr (is_optional<V>) {
    return script_type<typename V::value_type>() + " | null";
  } else if constexpr (std::is_same_v<V, Box3>) {
    return "[Point, Point]";
  } else if constexpr (is_one_of<V, std::vector<Point3>, std::vector<Vector3>>) {
    return "Float64Array";
  } else if constexpr (is_one_of<V, std::vector<std::uint32_t>, std::vector<std::array<std::uint32_t, 3>>>) {
    return "Uint32Array";
  } else if constexpr (is_vector<V>) {
    return script_type<typename V::value_type>() + "[]";
  } else if constexpr (is_array<V>) {
    std::string list;
    for (std::size_t i = 0; i < std::tuple_size_v<V>; ++i)
      list += (i == 0 ? "[" : ", ") + script_type<typename V::value_type>();
    return list + "]";
  } else if constexpr (std::is_same_v<V, bool>) {
    return "boolean";
  } else if constexpr (std::is_arithmetic_v<V>) {
    return "number";
  } else {
    static_assert(*name_in_types<V> != 0);
    return name_in_types<V>;
  }
}

std::string spelled(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    text += name[i] == '_' ? static_cast<char>(std::toupper(name[++i])) : name[i];
  }
  return text;
}

template <class Answer>
std::string interface_of(const std::string& name) {
  std::string text = "export interface " + name + " {\n";
  for_each_field<Answer>([&]<class Of>(const Field<Of>& field) {
    using V = FieldValue<Answer, Of>;
    const std::string key = spelled(field.name);
    const auto add = [&](const std::string& said, const std::string& member, const std::string& type) {
      text += "  /** " + said + " */ " + member + ": " + type + ";\n";
    };
    if constexpr (is_witness<V>) {
      const std::string none = is_optional<V> ? " | null" : "";
      add(field.text, key, "[Point, Point]" + none);
      add("Upper bound, per coordinate, of how far they are from the limit points that they stand for.",
          key + "Error", "number" + none);
      add("Null for a witness that was located on the other surface only.", key + "At",
          "[WitnessPlace | null, WitnessPlace | null]" + none);
    } else {
      add(field.text, key, key == "side" ? "-1 | 0 | 1" : script_type<V>());
    }
  });
  return text + "}\n";
}

std::string script_part() {
  return interface_of<SearchStats>("SearchStats") + interface_of<Collision>("Collision") +
         interface_of<Distance>("Distance") + interface_of<Penetration>("Penetration") +
         interface_of<SceneCounts>("SceneCounts") + interface_of<TimeOfContact>("TimeOfContact") +
         interface_of<ClearanceSpan>("ClearanceSpan") + interface_of<Clearance>("Clearance") +
         interface_of<PatchContact>("PatchContact") + interface_of<ContactRegion>("ContactRegion") +
         interface_of<CurveBox>("CurveBox") + interface_of<IntersectionCurve>("IntersectionCurve") +
         interface_of<ContactArea>("ContactArea") + interface_of<OpenBox>("OpenBox") +
         interface_of<Contacts>("Contacts") + interface_of<fields::SelfContactStats>("SelfContactStats") +
         interface_of<SelfContactPair>("SelfContactPair") + interface_of<SelfContact>("SelfContact") +
         interface_of<ClosestPoint>("ClosestPoint") + interface_of<RayHit>("RayHit") +
         interface_of<RayHits>("RayHits") + interface_of<SurfacePoint>("SurfacePoint") +
         interface_of<BoundSummary>("BoundSummary") + interface_of<Tessellation>("Tessellation") +
         interface_of<Brep>("Brep") + interface_of<Hull>("Hull") + interface_of<HullProblem>("HullProblem") +
         interface_of<Hulls>("Hulls") + interface_of<Envelope>("Envelope") +
         interface_of<fields::MeasureStats>("MeasureStats") + interface_of<Measures>("Measures") +
         interface_of<OneSidedDistance>("OneSidedDistance") + interface_of<Deviation>("Deviation");
}

// The types of Python: python/src/fields.h.

using Lines = std::vector<std::pair<std::string, std::string>>;  // name and type

// Of one answer.
template <class V>
std::string python_type() {
  if constexpr (is_one_of<V, Interval>) {
    return "Tuple[float, float]";
  } else if constexpr (std::is_enum_v<V>) {
    return "str";
  } else if constexpr (std::is_same_v<V, OneSidedDistance>) {
    return "OneSidedDistance";
  } else if constexpr (std::is_same_v<V, Hull>) {
    return "Hull";
  } else if constexpr (is_one_of<V, std::array<Interval, 3>, std::array<Interval, 6>, std::vector<Point3>,
                                 std::vector<Vector3>, std::vector<CurveBox>, std::vector<OpenBox>>) {
    return "Floats";
  } else if constexpr (is_one_of<V, std::vector<std::uint32_t>, std::vector<std::array<std::uint32_t, 3>>>) {
    return "Ids";
  } else if constexpr (std::is_same_v<V, std::vector<ContactRegion>>) {
    return "ContactRegions";
  } else if constexpr (std::is_same_v<V, std::vector<ClearanceSpan>>) {
    return "ClearanceSpans";
  } else if constexpr (std::is_same_v<V, std::vector<SelfContactPair>>) {
    return "SelfContactPairs";
  } else if constexpr (is_one_of<V, std::vector<IntersectionCurve>, std::vector<ContactArea>>) {
    return std::string("List[") + name_in_types<typename V::value_type> + "]";
  } else if constexpr (is_vector<V>) {
    return "List[Dict[str, Any]]";
  } else if constexpr (is_optional<V>) {
    return "Optional[" + python_type<typename V::value_type>() + "]";
  } else if constexpr (is_array<V>) {
    const std::string each = python_type<typename V::value_type>();
    return "Tuple[" + each + ", " + each + "]";
  } else if constexpr (has_fields<V>) {
    return "Dict[str, int]";
  } else if constexpr (std::is_same_v<V, bool>) {
    return "bool";
  } else if constexpr (std::is_integral_v<V>) {
    return "int";
  } else {
    static_assert(std::is_same_v<V, double>);
    return "float";
  }
}

// Of one or many answers. Members that are more than one stand in a class before, which is named here.
template <class V>
std::string many_type(std::string* base) {
  if constexpr (std::is_same_v<V, Interval>) {
    *base = "_Interval";
    return "Floats";
  } else if constexpr (std::is_same_v<V, Place>) {
    *base = "_Place";
    return "";
  } else if constexpr (is_witness<V>) {
    *base = "_Witness";
    return "Floats";
  } else if constexpr (is_one_of<V, std::optional<Place>, std::optional<std::size_t>>) {
    return "Union[int, Places]";
  } else if constexpr (is_one_of<V, double, std::optional<double>>) {
    return "Number";
  } else if constexpr (std::is_same_v<V, bool>) {
    return "Flag";
  } else if constexpr (std::is_same_v<V, int>) {
    return "Union[int, npt.NDArray[np.int32]]";
  } else if constexpr (is_one_of<V, Point3, Vector3, std::array<Vector3, 2>, std::optional<Vector3>, Box3>) {
    return "Floats";
  } else if constexpr (std::is_enum_v<V>) {
    return "Words";
  } else {
    return "Union[" + python_type<V>() + ", List[" + python_type<V>() + "]]";
  }
}

std::string class_of(const std::string& name, const std::vector<std::string>& bases, const Lines& lines) {
  std::string text = "class " + name;
  for (std::size_t i = 0; i < bases.size(); ++i) text += (i == 0 ? "(" : ", ") + bases[i];
  text += bases.empty() ? ":\n" : "):\n";
  for (const auto& [key, type] : lines)
    text += "    @property\n    def " + key + "(self) -> " + type + ": ...\n";
  return text;
}

template <class Answer>
std::string many(const std::string& name, std::vector<std::string> bases = {}) {
  Lines lines;
  for_each_field<Answer>([&]<class Of>(const Field<Of>& field) {
    using V = FieldValue<Answer, Of>;
    std::string base;
    const std::string type = many_type<V>(&base);
    if (!base.empty() && std::find(bases.begin(), bases.end(), base) == bases.end()) bases.push_back(base);
    if (!type.empty())
      lines.emplace_back(std::is_same_v<V, std::optional<Place>> ? "face" : field.name, type);
  });
  return class_of(name, bases, lines) +
         "    def __len__(self) -> int: ...\n    def __getitem__(self, i: Union[int, slice]) -> " + name +
         ": ...\n\n";
}

template <class Answer>
std::string one(const std::string& name, const std::vector<std::string>& bases = {}) {
  Lines lines;
  for_each_field<Answer>([&]<class Of>(const Field<Of>& field) {
    lines.emplace_back(field.name, python_type<FieldValue<Answer, Of>>());
  });
  return class_of(name, bases, lines) + "\n";
}

std::string python_part() {
  return "\n" + many<Collision>("Collision", {"_Verdicts"}) + many<Distance>("Distance") +
         many<Penetration>("Penetration") + many<TimeOfContact>("TimeOfContact", {"_Truth"}) +
         many<ClearanceSpan>("ClearanceSpans") + many<Clearance>("Clearance") +
         many<ContactRegion>("ContactRegions") + one<IntersectionCurve>("IntersectionCurve", {"_Curve"}) +
         one<ContactArea>("ContactArea") + one<Contacts>("Contacts", {"_Truth"}) +
         many<SelfContactPair>("SelfContactPairs") + one<SelfContact>("SelfContact", {"_Truth"}) +
         many<ClosestPoint>("ClosestPoint") + many<SignedDistance>("SignedDistance") +
         many<QuickHit>("QuickHit", {"_Hit"}) + many<SurfacePoint>("SurfacePoint") +
         one<Tessellation>("Tessellation", {"_Tessellation"}) + one<Hull>("Hull", {"_Triangles"}) +
         one<Hulls>("Hulls", {"_Hulls"}) + one<Envelope>("Envelope", {"_Triangles"}) +
         one<Measures>("Measures") + many<OneSidedDistance>("OneSidedDistance") + one<Deviation>("Deviation");
}

// Files.

std::string text_of(const std::string& name) {
  std::ifstream file(std::string(SNUG_ROOT "/") + name);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The part of a file from the line with `begin` to the line with `end` is `wanted`.
void expect_part(const std::string& name, const std::string& begin, const std::string& end,
                 const std::string& wanted) {
  const std::string text = text_of(name);
  const std::size_t first = text.find(begin), last = text.find(end);
  ASSERT_TRUE(first != std::string::npos && last != std::string::npos && first < last)
      << name << ": no part between '" << begin << "' and '" << end << "'";
  const std::size_t from = text.find('\n', first) + 1;
  if (std::getenv("SNUG_WRITE_DOORS") != nullptr) {
    std::ofstream(std::string(SNUG_ROOT "/") + name) << text.substr(0, from) + wanted + text.substr(last);
    return;
  }
  std::istringstream is(text.substr(from, last - from)), ought(wanted);
  std::string line, other;
  for (std::size_t number = 1; std::getline(ought, other); ++number) {
    ASSERT_TRUE(std::getline(is, line)) << name << ": lacks '" << other << "'";
    ASSERT_EQ(line, other)
        << name << ", line " << number
        << " of the answers: edit include/snug/fields.h, then SNUG_WRITE_DOORS=1 doors_test";
  }
  EXPECT_FALSE(std::getline(is, line)) << name << ": '" << line << "' is in no answer";
}

// Doors that follow one list agree in what is wrong there, too.
TEST(fields, point_at_members_of_their_names) {
  const std::string text = text_of("include/snug/fields.h");
  const std::regex field("Field\\{\"(\\w+)\",\\s*&(\\w+)::(\\w+)");
  std::size_t count = 0;
  for (std::sregex_iterator i(text.begin(), text.end(), field), none; i != none; ++i, ++count) {
    const std::string name = (*i)[1], owner = (*i)[2], member = (*i)[3], full = owner + "::" + member;
    if (owner == "fields" || full == "SelfContactPair::points" || full == "OneSidedDistance::to") continue;
    EXPECT_EQ(name, member) << full;
  }
  EXPECT_GT(count, 100u);
}

TEST(declarations, of_python_are_those_of_the_fields) {
  expect_part("python/snug/_snug.pyi", "# Answers, as include/snug/fields.h has them",
              "# End of these answers", python_part());
}

TEST(declarations, of_javascript_are_those_of_the_fields) {
  expect_part("web/package/snug.d.ts", "// Answers, as include/snug/fields.h has them",
              "// End of these answers", script_part());
}

// Tables of the command's JSON: apps/snug/answer_writer.h.

template <class Answer>
std::vector<std::string> json_names(const std::string& without = "") {
  std::vector<std::string> names;
  for_each_field<Answer>([&]<class Of>(const Field<Of>& field) {
    using V = FieldValue<Answer, Of>;
    const std::string name = field.name;
    if (name == without) return;
    if constexpr (std::is_same_v<V, Place>) {
      names.insert(names.end(), {"face", "corner", "u", "v", "normal", "normal_error"});
    } else if constexpr (std::is_same_v<V, std::array<PatchPlace, 2>>) {
      names.insert(names.end(), {"a", "part_a", "b", "part_b"});
    } else {
      names.push_back(name);
      if constexpr (is_witness<V>) names.insert(names.end(), {name + "_error", name + "_at"});
    }
  });
  return names;
}

std::vector<std::string> words_in(const std::string& text) {
  std::vector<std::string> words;
  const std::regex word("`([a-z_]+)(\\[\\])?`");
  for (std::sregex_iterator i(text.begin(), text.end(), word), none; i != none; ++i) words.push_back((*i)[1]);
  return words;
}

// A page of a command: what its answers hold is told after a mark, in order.
class Page {
 public:
  explicit Page(const std::string& name) : name_("docs/command/" + name), text_(text_of(name_)) {}

  template <class Answer>
  Page& tells(const std::string& mark, const std::string& without = "") {
    const std::size_t begin = text_.find(mark);
    EXPECT_NE(begin, std::string::npos) << name_ << ": no " << mark;
    const std::vector<std::string> words = words_in(text_.substr(std::min(begin, text_.size()))),
                                   names = json_names<Answer>(without);
    auto at = words.begin();
    for (const std::string& name : names) {
      at = std::find(at, words.end(), name);
      if (at == words.end()) {
        ADD_FAILURE() << name_ << ", after '" << mark << "': lacks `" << name
                      << "`, or has it in another order";
        break;
      }
      ++at;
    }
    known_.insert(known_.end(), names.begin(), names.end());
    return *this;
  }

  // Names of its tables are those, or the command's own.
  void and_of_its_own(const std::vector<std::string>& own) {
    known_.insert(known_.end(), own.begin(), own.end());
    std::istringstream lines(text_);
    bool in_table = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.find("| type |") != std::string::npos) in_table = true;
      if (line.empty()) in_table = false;
      if (!in_table) continue;
      for (const std::string& word : words_in(line.substr(0, line.find('|', 1)))) {
        EXPECT_NE(std::find(known_.begin(), known_.end(), word), known_.end())
            << name_ << ": no answer has `" << word << "`";
      }
    }
  }

 private:
  std::string name_, text_;
  std::vector<std::string> known_;
};

TEST(declarations, of_the_command_are_those_of_the_fields) {
  const std::string table = "| field | type | |";
  Page("collide.md")
      .tells<Collision>(table)
      .tells<Penetration>("| `penetration` |")
      .tells<SearchStats>("| `stats` |")
      .tells<Contacts>("| `exhaustive` |", "outcome")
      .tells<ContactRegion>("| `regions` |")
      .tells<PatchContact>("`contacts`")
      .tells<IntersectionCurve>("| `curves` |")
      .tells<CurveBox>("`boxes` between")
      .tells<ContactArea>("| `areas` |")
      .tells<OpenBox>("| `open` |")
      .and_of_its_own({"tolerance", "margin", "place_a", "place_b", "penetration", "certificate"});
  Page("distance.md")
      .tells<Distance>(table)
      .and_of_its_own({"absolute", "relative", "place_a", "place_b", "certificate"});
  Page("time-of-contact.md")
      .tells<TimeOfContact>(table)
      .and_of_its_own({"tolerance", "margin", "duration", "place_a", "place_b"});
  Page("clearance.md")
      .tells<Clearance>(table)
      .tells<ClearanceSpan>("| `spans` |")
      .and_of_its_own({"absolute", "relative", "duration", "place_a", "place_b"});
  Page("self-contact.md")
      .tells<SelfContact>(table)
      .tells<SelfContactPair>("| `pairs` |")
      .tells<fields::SelfContactStats>("| `stats` |")
      .and_of_its_own({"within"});
  Page("closest.md").tells<ClosestPoint>("JSON:");
  Page("ray.md")
      .tells<RayHits>("| `results[]` |")
      .tells<RayHit>("| of a hit |", "normal")
      .and_of_its_own({"absolute", "results", "certificate"});
  Page("eval.md")
      .tells<SurfacePoint>("| of a point |")
      .and_of_its_own({"points", "count", "face", "u", "v", "corner"});
  Page("bound.md")
      .tells<BoundSummary>(table)
      .and_of_its_own({"enclosures", "face", "part", "piece", "level", "lower", "upper", "base", "radius",
                       "corners", "normals"});
  Page("convert.md").tells<Brep>("JSON:");
  Page("measure.md")
      .tells<Measures>(table)
      .tells<fields::MeasureStats>("| `stats` |")
      .and_of_its_own({"relative"});
}

}  // namespace
}  // namespace snug::testing::declarations_test
