// Robots: links in a tree of joints, and which of them meet along a path.

#include <snug/robot.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "answers.h"
#include "call.h"
#include "poses.h"
#include "surface.h"

namespace snug::python {
namespace {

struct Loaded {
  Robot robot;
  std::vector<Surface> surfaces;  // one a mesh
};

// An object that __new__ alone made has none.
struct PyRobot {
  std::shared_ptr<const Loaded> loaded;
  [[nodiscard]] const Loaded& made() const {
    if (!loaded) throw py::type_error("this Robot was not made: urdf() makes robots");
    return *loaded;
  }
};

std::string name_of_key(py::handle name, const char* what) {
  if (!py::isinstance<py::str>(name))
    throw py::type_error(std::string(what) + ": names are strings, not " +
                         py::repr(name).cast<std::string>());
  return name.cast<std::string>();
}

std::string text_path(const py::object& path) {
  return py::module_::import("os").attr("fspath")(path).cast<std::string>();
}

PyRobot urdf(const py::object& file, bool visual, const py::object& packages, const py::object& root,
             const py::object& srdf, double primitive_error) {
  RobotOptions options{.visual = visual, .primitive_error = primitive_error};
  if (py::isinstance<py::dict>(packages)) {
    for (const auto& [name, folder] : packages.cast<py::dict>())
      options.packages[name_of_key(name, "packages")] = text_path(py::reinterpret_borrow<py::object>(folder));
  } else if (!packages.is_none()) {
    options.packages[""] = text_path(packages);
  }
  if (!root.is_none()) options.root = text_path(root);
  const std::string path = text_path(file), pairs = srdf.is_none() ? std::string() : text_path(srdf);
  std::string bytes;
  if (!srdf.is_none())
    bytes = py::module_::import("pathlib").attr("Path")(srdf).attr("read_bytes")().cast<std::string>();
  Call call;
  return call.run([&](const Run& run) {
    auto loaded = std::make_shared<Loaded>();
    loaded->robot = read_robot(path, options, run);
    if (!pairs.empty()) allow_pairs(loaded->robot, bytes, pairs);
    for (const ControlMesh& mesh : loaded->robot.meshes) loaded->surfaces.emplace_back(mesh);
    return PyRobot{std::move(loaded)};
  });
}

std::vector<double> positions_of(const Robot& robot, const py::object& given) {
  std::vector<std::pair<std::string, double>> positions;
  if (!given.is_none()) {
    for (const auto& [name, position] : py::dict(given)) {
      const std::string joint = name_of_key(name, "positions");
      const std::optional<double> number =
          number_of(py::reinterpret_borrow<py::object>(position), joint.c_str());
      if (!number) throw py::type_error(joint + ": give a number, not None");
      positions.emplace_back(joint, *number);
    }
  }
  return joint_positions(robot, positions);
}

py::dict poses(const PyRobot& self, const py::object& positions) {
  const Robot& robot = self.made().robot;
  const std::vector<Motion> found = link_poses(robot, positions_of(robot, positions));
  py::dict result;
  for (std::size_t l = 0; l < found.size(); ++l) result[py::str(robot.links[l].name)] = matrix_of(found[l]);
  return result;
}

// A length that may be percent of the size.
std::function<double(double)> length_by_size(const py::object& given, const char* what) {
  const std::optional<double> one = length_of(given, 1, what), two = length_of(given, 2, what);
  if (!one) return {};
  return [=](double size) { return *one == *two ? *one : *one * size; };
}

std::vector<std::vector<double>> positions_along(const Robot& robot, const py::list& path) {
  std::vector<std::vector<double>> positions;
  for (const auto& each : path)
    positions.push_back(positions_of(robot, py::reinterpret_borrow<py::object>(each)));
  return positions;
}

// The shape that first_contacts() names so.
std::pair<std::uint32_t, Robot::Shape> shape_named(const Robot& robot, const std::string& name) {
  for (std::uint32_t l = 0; l < robot.links.size(); ++l) {
    const Robot::Link& link = robot.links[l];
    for (std::size_t shape = 0; shape < link.shapes.size(); ++shape)
      if (name == link.name_of(shape)) return {l, link.shapes[shape]};
    if (name != link.name) continue;
    if (link.shapes.empty()) throw py::value_error("robot: link '" + name + "' has no shape");
    throw py::value_error("robot: link '" + name + "' has several shapes: give '" + link.name_of(0) +
                          "' to '" + link.name_of(link.shapes.size() - 1) + "'");
  }
  throw py::value_error("robot: no link is called '" + name + "'");
}

py::tuple link_motions(const PyRobot& self, const std::string& a, const std::string& b,
                       const py::list& path) {
  const Robot& robot = self.made().robot;
  const std::pair<std::uint32_t, Robot::Shape> of_a = shape_named(robot, a), of_b = shape_named(robot, b);
  const std::vector<std::vector<double>> positions = positions_along(robot, path);
  auto [motion_a, motion_b] =
      snug::link_motions(robot, {of_a.first, of_a.second.pose}, {of_b.first, of_b.second.pose}, positions);
  const auto surface = [&](const Robot::Shape& shape) {
    return std::make_unique<PySurface>(robot.meshes[shape.mesh], SurfaceOptions{});
  };
  return py::make_tuple(surface(of_a.second), std::move(motion_a), surface(of_b.second), std::move(motion_b));
}

py::list first_contacts(const PyRobot& self, const py::list& path, const py::object& tolerance,
                        const py::object& margin, bool joined, const std::string& group,
                        const py::object& max_splits, const py::object& threads, const py::object& progress) {
  const Loaded& loaded = self.made();
  const std::vector<std::vector<double>> positions = positions_along(loaded.robot, path);
  const LinkContactsOptions options{.tolerance = length_by_size(tolerance, "tolerance"),
                                    .margin = length_by_size(margin, "margin"),
                                    .joined = joined,
                                    .group = group};
  Call call(progress, run_of(threads, max_splits));
  std::vector<LinkContact> found = call.run([&](const Run& run) {
    return snug::first_contacts(loaded.robot, loaded.surfaces, positions, options, run);
  });
  py::list result;
  for (LinkContact& each : found)
    result.append(py::make_tuple(each.a, each.b, Answers<TimeOfContact>(std::move(each.answer))));
  return result;
}

}  // namespace

void add_robots(py::module_& module) {
  py::class_<PyRobot> cls(
      module, "Robot",
      "Links in a tree of joints, in metres and radians: urdf() reads one. It never changes.");
  cls.attr("__module__") = "snug";
  using py::arg;
  const py::object none = py::none();
  cls.def(py::init([](const py::args&, const py::kwargs&) -> PyRobot {
    throw py::type_error("Robot() makes none: give snug.urdf(file)");
  }));
  cls.def_property_readonly(
         "name", [](const PyRobot& self) { return self.made().robot.name; }, "As the file has it.")
      .def_property_readonly(
          "links",
          [](const PyRobot& self) {
            py::list names;
            for (const Robot::Link& link : self.made().robot.links) names.append(link.name);
            return names;
          },
          "Names of the links, parents first.")
      .def_property_readonly(
          "joints",
          [](const PyRobot& self) {
            py::dict limits;
            for (const Robot::Joint& joint : self.made().robot.joints) {
              if (!joint.fixed && !joint.mimic)
                limits[py::str(joint.name)] = py::make_tuple(joint.lower, joint.upper);
            }
            return limits;
          },
          "Joints that have a position of their own, and their limits: {name: (lower, upper)}.")
      .def_property_readonly(
          "outward",
          [](const PyRobot& self) {
            double most = 0;
            for (const double own : self.made().robot.outward) most = std::max(most, own);
            return most;
          },
          "How far meshes of cylinders and spheres go beyond them, at most.")
      .def("poses", poses, arg("positions") = none,
           "The pose of each link in the frame of the root, {name: (4, 4)}, for positions {joint: radians or "
           "metres}; joints\n"
           "that are not named are at 0, or at the limit nearest to it. Raises ValueError.")
      .def("first_contacts", first_contacts, arg("path"), py::kw_only(), arg("tolerance") = "0.1%",
           arg("margin") = 0, arg("joined") = false, arg("group") = "", arg("max_splits") = none,
           arg("threads") = 0, arg("progress") = none,
           "Which links meet along a path of the joints? A list of (link, link, TimeOfContact), one for each "
           "two "
           "shapes that\n"
           "can move against each other; `link#2` where a link has several.\n\n"
           "path: positions as poses() takes them, one unit of time from each to the next, at constant "
           "speeds.\n"
           "tolerance, margin: metres, or percent of the larger one of two meshes; with a margin contact is "
           "being at most\n"
           "so far apart. joined: also pairs of links that a joint joins.\n"
           "group: only pairs with a link of this group of the SRDF file.\n\n"
           "Guarantee: no contact before `lower`, between the given positions too. Witnesses are in the "
           "frame of "
           "the last link\n"
           "that carries both. Raises ValueError, OverflowError.")
      .def("link_motions", link_motions, arg("a"), arg("b"), arg("path"),
           "Shapes of two links, and how they move along a path, in the frame of the last link that moves "
           "both: surface,\n"
           "Trajectory, surface, Trajectory, as clearance() and time_of_contact() take them.\n\n"
           "a, b: links; `link#2` where one has several shapes. path: as for first_contacts().\n\n"
           "Surfaces of cylinders and spheres go beyond these by at most `outward`. Raises ValueError.")
      .def("__repr__", [](const PyRobot& self) {
        const Robot& robot = self.made().robot;
        return "<snug.Robot " + robot.name + ": " + std::to_string(robot.links.size()) + " links>";
      });
  const auto itself = [](const py::object& self, const py::args&) { return self; };
  cls.def("__copy__", itself);
  cls.def("__deepcopy__", itself);
  module.def(
      "urdf", urdf, arg("file"), py::kw_only(), arg("visual") = false, arg("packages") = none,
      arg("root") = none, arg("srdf") = none, arg("primitive_error") = 2e-3,
      "The robot that a file in URDF describes.\n\n"
      "visual: the visual shapes instead of the collision shapes. packages: {name: folder} for "
      "package://name/, or the\n"
      "folder that holds all packages. root: a folder that other paths may not leave, by default that of "
      "the file.\n"
      "srdf: a file with pairs that may touch, and with groups. primitive_error: how far meshes of "
      "cylinders and\n"
      "spheres may go beyond them, as a share of the radius.\n\n"
      "Raises FileError (broken files, cycles of joints, missing meshes, paths outside), ValueError.");
}

}  // namespace snug::python
