#include <snug/robot.h>

#include <filesystem>

#include "claims.h"

using namespace snug;

namespace {

void check(const Robot& robot) {
  fuzz::claim(!robot.links.empty() && robot.joints.size() + 1 == robot.links.size(), "links are a tree");
  for (const Robot::Joint& joint : robot.joints) {
    fuzz::claim(joint.parent < joint.child && joint.child < robot.links.size(),
                "parents come before children");
    fuzz::claim(!joint.mimic || joint.mimic->joint < robot.joints.size(), "followers name joints");
  }
  for (const Robot::Link& link : robot.links) {
    for (const Robot::Shape& shape : link.shapes)
      fuzz::claim(shape.mesh < robot.meshes.size(), "shapes have meshes");
  }
  for (const ControlMesh& mesh : robot.meshes) fuzz::claim_well_formed(mesh);
  const std::vector<double> positions = joint_positions(robot, {});
  fuzz::claim(positions.size() == robot.joints.size(), "joints have positions");
  try {
    fuzz::claim(link_poses(robot, positions).size() == robot.links.size(), "links have poses");
  } catch (const InputError&) {
    // Beyond the range of doubles.
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  RobotOptions options;
  options.primitive_error = 0.1;
  options.packages[""] = "packages";
  options.file = [](const std::string& path) {
    const std::string place = std::filesystem::path(path).lexically_normal().string();
    fuzz::claim(place != ".." && !place.starts_with("../") && !place.starts_with('/'),
                "paths stay in their folders");
    return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  };
  try {
    Robot robot = parse_robot(bytes, "input.urdf", options);
    check(robot);
    allow_pairs(robot, bytes, "input.srdf");
    for (const auto& [name, links] : robot.groups) {
      for (const std::uint32_t link : links) fuzz::claim(link < robot.links.size(), "groups have links");
      static_cast<void>(pairs_to_check(robot, true, name));
    }
  } catch (const InputError& error) {
    fuzz::claim_one_line(error);
  }
  return 0;
}
