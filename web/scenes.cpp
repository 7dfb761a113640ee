// Many parts: files that place several meshes, scenes, robots.

#include <snug/robot.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fields.h"
#include "part.h"
#include "poses.h"

namespace snug::web {
namespace {

// {parts: [{name, surface: an index, pose}], surfaces}.
val read_parts(const std::string& bytes, const std::string& name, const val& options) {
  return guarded([&] {
    std::vector<std::string> notes;
    const MeshAssembly assembly = parse_assembly(bytes, name, reading_of(options, notes));
    val surfaces = val::array(), parts = val::array();
    for (std::size_t m = 0; m < assembly.meshes.size(); ++m)
      surfaces.set(m, std::make_shared<Part>(assembly.meshes[m], name, options, notes));
    for (const MeshAssembly::Part& each : assembly.parts) {
      val part = val::object();
      part.set("name", each.name);
      part.set("surface", each.mesh);
      part.set("pose", array_of(each.pose));
      parts.call<void>("push", part);
    }
    val result = val::object();
    result.set("surfaces", surfaces);
    result.set("parts", parts);
    return result;
  });
}

// [{part, pose}], and in options `pairs` and `margins`: flat lists of indices, and of indices and lengths.
Scene scene_of(const val& parts, const val& options) {
  Scene scene;
  const auto count = parts["length"].as<std::size_t>();
  for (std::size_t i = 0; i < count; ++i) {
    const val part = parts[i];
    scene.parts.emplace_back(part["part"].as<std::shared_ptr<Part>>()->surface(), motion_of(part["pose"]));
  }
  const auto index = [](double number) { return index_of(number, "pairs"); };
  if (given(options, "pairs")) {
    scene.pairs.emplace();
    const std::vector<double> pairs = numbers_of(options, "pairs", 2);
    for (std::size_t i = 0; i < pairs.size(); i += 2)
      scene.pairs->push_back({index(pairs[i]), index(pairs[i + 1])});
  }
  const std::vector<double> margins = numbers_of(options, "margins", 3);
  for (std::size_t i = 0; i < margins.size(); i += 3)
    scene.margins.push_back({{index(margins[i]), index(margins[i + 1])}, margins[i + 2]});
  return scene;
}

// `ask` passes {parts, answer} to what it is given, and returns the counts.
template <class Ask>
val scene_answers(const val& parts, const val& options, const Ask& ask) {
  return guarded([&] {
    const Scene scene = scene_of(parts, options);
    val results = val::array();
    val result = object_of(ask(scene, [&](const auto& pair) {
      val each = object_of(pair.answer, std::array{scene.parts[pair.parts.a], scene.parts[pair.parts.b]});
      each.set("a", pair.parts.a);
      each.set("b", pair.parts.b);
      results.call<void>("push", each);
    }));
    result.set("results", results);
    return result;
  });
}
val collide_scene(const val& parts, const val& options) {
  return scene_answers(parts, options, [&](const Scene& scene, const auto& take) {
    return collide(scene, collide_options(options), take, run_of(options));
  });
}
val distance_scene(const val& parts, double limit, const val& options) {
  return scene_answers(parts, options, [&](const Scene& scene, const auto& take) {
    return distance(scene, limit, distance_options(options), take, run_of(options));
  });
}

// Links in a tree of joints, and a surface for each mesh.
class PageRobot {
 public:
  PageRobot(Robot robot, const val& options) : robot_(std::move(robot)) {
    for (std::size_t m = 0; m < robot_.meshes.size(); ++m)
      surfaces_.push_back(Part(robot_.meshes[m], robot_.mesh_names[m], options).surface());
  }
  [[nodiscard]] std::string name() const { return robot_.name; }
  [[nodiscard]] val links() const {
    val names = val::array();
    for (const Robot::Link& link : robot_.links) names.call<void>("push", link.name);
    return names;
  }
  [[nodiscard]] val joints() const {
    val limits = val::object();
    for (const Robot::Joint& joint : robot_.joints) {
      if (!joint.fixed && !joint.mimic) limits.set(joint.name, array_of(Interval{joint.lower, joint.upper}));
    }
    return limits;
  }
  [[nodiscard]] double outward() const {
    return robot_.outward.empty() ? 0 : *std::max_element(robot_.outward.begin(), robot_.outward.end());
  }
  [[nodiscard]] val poses(const val& positions) const {
    return guarded([&] {
      const std::vector<Motion> found = link_poses(robot_, positions_of(positions));
      val result = val::object();
      for (std::size_t l = 0; l < found.size(); ++l) result.set(robot_.links[l].name, array_of(found[l]));
      return result;
    });
  }
  [[nodiscard]] val first_contacts(const val& path, const val& options) const {
    return guarded([&] {
      std::vector<std::vector<double>> positions;
      const auto count = path["length"].as<std::size_t>();
      for (std::size_t i = 0; i < count; ++i) positions.push_back(positions_of(path[i]));
      const auto length = [&](const char* name) -> std::function<double(double)> {
        const auto given = option<double>(options, name);
        if (!given) return {};
        return [=](double) { return *given; };
      };
      const LinkContactsOptions how{.tolerance = length("tolerance"),
                                    .margin = length("margin"),
                                    .joined = option<bool>(options, "joined").value_or(false),
                                    .group = option<std::string>(options, "group").value_or("")};
      val results = val::array();
      for (const LinkContact& each :
           snug::first_contacts(robot_, surfaces_, positions, how, run_of(options))) {
        val result = object_of(each.answer, each.placed);
        result.set("a", each.a);
        result.set("b", each.b);
        result.set("frame", each.frame);
        results.call<void>("push", result);
      }
      return results;
    });
  }

 private:
  // {joint: radians or metres}.
  [[nodiscard]] std::vector<double> positions_of(const val& positions) const {
    std::vector<std::pair<std::string, double>> given;
    const val names = val::global("Object").call<val>("keys", positions);
    for (std::size_t i = 0; i < names["length"].as<std::size_t>(); ++i)
      given.emplace_back(names[i].as<std::string>(), positions[names[i]].as<double>());
    return joint_positions(robot_, given);
  }

  Robot robot_;
  std::vector<Surface> surfaces_;
};

val read_urdf(const std::string& bytes, const std::string& name, const val& options) {
  return guarded([&] {
    std::vector<std::string> notes;
    const ReadOptions reading = reading_of(options, notes);
    RobotOptions how;
    how.visual = option<bool>(options, "visual").value_or(false);
    how.primitive_error = option<double>(options, "primitiveError").value_or(how.primitive_error);
    how.root = option<std::string>(options, "root").value_or("");
    how.packages[""] = "";
    how.file = reading.other_file;
    Robot robot = parse_robot(bytes, name, how);
    if (given(options, "srdf")) allow_pairs(robot, options["srdf"].as<std::string>(), "srdf");
    val result = val::object();
    result.set("robot", std::make_shared<PageRobot>(std::move(robot), options));
    return result;
  });
}

}  // namespace
}  // namespace snug::web

EMSCRIPTEN_BINDINGS(scenes) {
  using namespace snug::web;  // NOLINT
  emscripten::function("readAssembly", &read_parts);
  emscripten::function("collideScene", &collide_scene);
  emscripten::function("distanceScene", &distance_scene);
  emscripten::function("urdf", &read_urdf);
  emscripten::class_<PageRobot>("Robot")
      .smart_ptr<std::shared_ptr<PageRobot>>("RobotPointer")
      .property("name", &PageRobot::name)
      .property("links", &PageRobot::links)
      .property("joints", &PageRobot::joints)
      .property("outward", &PageRobot::outward)
      .function("poses", &PageRobot::poses)
      .function("firstContacts", &PageRobot::first_contacts);
}
