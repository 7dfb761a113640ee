// Questions of every kind in C++ have the digits that the command prints: tests/doors/ask.py asks the command SNUG_QUESTIONS (12) of
// each kind, or has left them in the file SNUG_ANSWERS.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <snug/snug.h>

#include "answer_writer.h"

namespace snug::testing::digits_test {
namespace {

using nlohmann::json;

// An answer as the command writes it.
template <class Answer>
json document_of(const Answer& answer, command::On on) {
  std::string text;
  command::JsonWriter writer([&](std::string_view piece) { text += piece; });
  writer.begin_object();
  command::write_fields(writer, answer, on);
  writer.end_object().finish();
  return json::parse(text);
}

// Numbers of nested lists, one after the other, as doubles; anything else as it is. What reads JSON here takes -0 for 0.
json flat(const json& value) {
  if (value.is_number()) return value.get<double>();
  if (!value.is_array()) return value;
  json numbers = json::array();
  for (const json& each : value) {
    const json inner = flat(each);
    if (!each.is_array()) {
      numbers.push_back(inner);
    } else {
      numbers.insert(numbers.end(), inner.begin(), inner.end());
    }
  }
  return numbers;
}

// Members that both have; how many?
int expect_same(const json& own, const json& document) {
  int compared = 0;
  for (const auto& [name, ought] : document.items()) {
    if (!own.contains(name)) continue;
    if (own[name].is_object() && ought.is_object()) {
      compared += expect_same(own[name], ought);
      continue;
    }
    EXPECT_EQ(flat(own[name]), flat(ought)) << name;
    ++compared;
  }
  return compared;
}

Motion pose_of(const json& numbers) { return Motion::from_3x4(numbers.get<std::array<double, 12>>()); }
Point3 point_of(const json& p) { return {p[0], p[1], p[2]}; }
Trajectory path_of(const json& poses) {
  std::vector<Motion> all;
  for (const json& each : poses) all.push_back(pose_of(each));
  return Trajectory::through(all);
}
std::optional<double> option(const json& line, const char* name) {
  const json& options = line["options"];
  return options.contains(name) ? std::optional(options[name].get<double>()) : std::nullopt;
}

std::vector<Triangle> triangles_of(const json& candidate) {
  const std::vector<double> p = candidate["positions"];
  const std::vector<std::size_t> corners = candidate["triangles"];
  const auto point = [&](std::size_t i) { return Point3{p[3 * i], p[3 * i + 1], p[3 * i + 2]}; };
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    triangles.push_back({point(corners[i]), point(corners[i + 1]), point(corners[i + 2])});
  }
  return triangles;
}

json of_pair(const json& line, const Surface& one, const Surface& other) {
  const std::string ask = line["ask"];
  const PlacedSurface a(one),
      b = line.contains("pose") ? other.at(pose_of(line["pose"])) : PlacedSurface(other);
  const std::array on{a, b};
  if (ask == "collide") {
    const CollideOptions how{.tolerance = option(line, "tolerance"), .prove_contact = true, .measure = true};
    return document_of(collide(a, b, how), on);
  }
  if (ask == "distance") return document_of(distance(a, b, {.absolute = option(line, "absolute")}), on);
  if (ask == "contacts") return document_of(contacts(a, b), on);
  if (ask == "penetration") return document_of(penetration(a, b), on);
  const Trajectory still = Motion(), path = path_of(line["path"]);
  const auto placed = [&](double time) {
    return std::array{a, other.at(path.at(time < INFINITY ? time : 0))};
  };
  if (ask == "time_of_contact") {
    TimeOfContactOptions how{.tolerance = option(line, "tolerance")};
    how.margin = option(line, "margin").value_or(0);
    const TimeOfContact found = time_of_contact(one, still, other, path, how);
    return document_of(found, placed(found.time.upper));
  }
  const ClearanceOptions how{.absolute = option(line, "absolute"), .relative = option(line, "relative")};
  const Clearance found = clearance(one, still, other, path, how);
  return document_of(found, placed(found.time));
}

json of_point(const json& line, const Surface& surface) {
  const std::string ask = line["ask"];
  const json& args = line["args"];
  const std::array on{PlacedSurface(surface)};
  if (ask == "evaluate") {
    return document_of(evaluate(surface, {args[0], args[3], args[1], args[2]}), on);
  }
  const Point3 p = point_of(args[0]);
  if (ask == "ray") {
    const Point3 d = point_of(args[1]);
    return document_of(ray(surface, {p, {d.x, d.y, d.z}}, {.query = RayQuery::all}), on);
  }
  if (ask == "signed_distance") return document_of(signed_distance(surface, p), on);
  if (ask == "closest_point") return document_of(closest_point(surface, p), on);
  const std::optional<bool> inside = contains(surface, p);
  return {{"inside", inside ? json(*inside) : json(nullptr)}};
}

json numbers_of(const Point3& p) { return json::array({p.x, p.y, p.z}); }
json document_of(const OneSidedDistance& side) {
  return {{"distance", json::array({side.distance.lower, side.distance.upper})},
          {"point", numbers_of(side.from.point)},
          {"error", side.from.error},
          {"nearest", numbers_of(side.to)}};
}

json of_solid(const json& line, const Surface& surface) {
  const std::string ask = line["ask"];
  const std::array on{PlacedSurface(surface)};
  const std::optional<double> error = option(line, "error");
  if (ask == "measure") return document_of(measure(surface, {.relative = option(line, "relative")}), on);
  if (ask == "self_contact") return document_of(self_contact(surface), on);
  if (ask == "tessellate") return document_of(tessellate(surface, {.error = error}), on);
  if (ask == "hull") return document_of(hull(surface, {.error = error}), on);
  if (ask == "envelope") return document_of(envelope(surface, {.error = error}), on);
  if (ask == "deviation") {
    const Deviation apart =
        deviation(surface, triangles_of(line["candidate"]),
                  {.absolute = option(line, "absolute"), .threshold = option(line, "threshold")});
    return {{"from_surface", document_of(apart.from_surface)},
            {"from_candidate", document_of(apart.from_candidate)},
            {"verdict", apart.verdict ? json(name_of(*apart.verdict)) : json(nullptr)},
            {"outcome", name_of(apart.outcome)}};
  }
  if (ask == "limit_to_faces") {
    const std::optional<double> apart = limit_to_faces(surface);
    return {{"limit_to_faces", apart ? json(*apart) : json(nullptr)}};
  }
  if (ask == "step") {
    const Brep brep = to_brep(surface, {.error = error});
    const std::string file = line["files"][0],
                      text = format_step(brep, {.name = std::filesystem::path(file).stem().string()});
    json document = document_of(brep, on);
    document["text"] = text.substr(text.find("DATA;"));
    return document;
  }
  const auto level = static_cast<unsigned>(*option(line, "level"));
  if (ask == "subdivided") {
    json positions = json::array();
    for (const Point3& p : subdivided(surface.mesh(), level, false, {.scheme = surface.scheme()}).points) {
      positions.push_back(numbers_of(p));
    }
    return {{"positions", positions}};
  }
  json enclosures = json::array();
  const auto sink = [&](const PatchEnclosure& piece) {
    json lower = json::array(), upper = json::array(), base = json::array();
    for (std::size_t k = 0; k < 3; ++k) {
      lower.push_back(numbers_of(piece.interval.corner[k].lower));
      upper.push_back(numbers_of(piece.interval.corner[k].upper));
      base.push_back(numbers_of(piece.offset.base[k]));
    }
    enclosures.push_back({{"radius", piece.offset.radius},
                          {"level", piece.level},
                          {"piece", piece.piece},
                          {"lower", lower},
                          {"upper", upper},
                          {"base", base}});
  };
  json document = document_of(bound(surface, {.level = level}, sink), on);
  const json& ought = line["document"]["enclosures"];
  EXPECT_EQ(enclosures.size(), ought.size());
  for (std::size_t i = 0; i < enclosures.size(); ++i) EXPECT_EQ(expect_same(enclosures[i], ought[i]), 6);
  return document;
}

TEST(digits, of_every_kind_of_question_are_those_of_the_command) {
  const char *left = std::getenv("SNUG_ANSWERS"), *count = std::getenv("SNUG_QUESTIONS");
  const std::string folder = ::testing::TempDir() + "digits_test";
  if (left == nullptr) {
    const std::string ask = std::string("python3 " SNUG_ROOT "/tests/doors/ask.py " SNUG_COMMAND " ") +
                            (count != nullptr ? count : "12") + " '" + folder + "'";
    ASSERT_EQ(std::system(ask.c_str()), 0) << ask;
  }
  std::ifstream file(left != nullptr ? left : folder + "/answers.jsonl");
  std::map<std::string, int> asked;
  std::map<std::string, Surface> read;
  for (std::string text; std::getline(file, text);) {
    const json line = json::parse(text);
    SCOPED_TRACE(text.substr(0, 500));
    std::vector<Surface> surfaces;
    for (const std::string path : line["files"]) {
      const std::string scheme = line["scheme"], key = path + " " + scheme;
      if (read.size() > 16) read.clear();
      if (!read.contains(key)) {
        read.emplace(key, load(path, {.scheme = scheme == "auto" ? std::nullopt : scheme_named(scheme)}));
      }
      surfaces.push_back(read.at(key));
    }
    const json own = surfaces.size() == 2    ? of_pair(line, surfaces[0], surfaces[1])
                     : line.contains("args") ? of_point(line, surfaces[0])
                                             : of_solid(line, surfaces[0]);
    ASSERT_GE(expect_same(own, line["document"]), 1);
    ASSERT_FALSE(::testing::Test::HasFailure());
    ++asked[line["ask"]];
  }
  EXPECT_EQ(asked.size(), 21U);
  for (const auto& [kind, times] : asked) EXPECT_GE(times, 10) << kind;
}

}  // namespace
}  // namespace snug::testing::digits_test
