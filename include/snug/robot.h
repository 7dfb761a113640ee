#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <snug/mesh.h>
#include <snug/scene.h>
#include <snug/time_of_contact.h>

namespace snug {

/// A robot: links in a tree of joints, in metres and radians.
struct Robot {
  struct Shape {
    std::uint32_t mesh;  ///< in `meshes`
    Motion pose{};       ///< in the frame of its link
  };
  struct Link {
    std::string name;
    std::vector<Shape> shapes{};
    std::optional<std::uint32_t> joint{};  ///< that moves it; none for the root
    [[nodiscard]] SNUG_API std::string name_of(std::size_t shape) const;  ///< "link#2" where it has several
  };
  struct Mimic {
    std::uint32_t joint;  ///< whose position, times `factor` and plus `offset`, is the position
    double factor = 1, offset = 0;
  };
  struct Joint {
    std::string name;
    std::uint32_t parent, child;  ///< links
    ChainJoint axis{};            ///< its frame is in that of the parent
    bool fixed = false;
    double lower = -std::numeric_limits<double>::infinity(), upper = std::numeric_limits<double>::infinity();
    std::optional<Mimic> mimic{};
  };

  std::string name;
  std::vector<Link> links;  ///< parents before children
  std::vector<Joint> joints;
  std::vector<ControlMesh> meshes;
  std::vector<std::string> mesh_names;                       ///< files, or "box" and so on
  std::vector<PartPair> allowed;                             ///< links that may touch, of SRDF
  std::map<std::string, std::vector<std::uint32_t>> groups;  ///< of links, of SRDF
  std::vector<double>
      outward;  ///< of each mesh, how far it may go beyond its shape: 0 but for cylinders and spheres
};

struct RobotOptions {
  bool visual = false;  ///< take what is seen instead of what collides
  /// Folders of packages by their names, for package://name/...; the name "" is a folder that holds packages.
  std::map<std::string, std::string> packages{};
  /// A folder that no other path leaves. Default: that of the robot's file.
  std::string root{};
  /// > 0: how far meshes of spheres and cylinders may go beyond them, as a share of the radius.
  double primitive_error = 2e-3;
  Notes notes{};
  /// The bytes of a mesh, by its path. Default: of the file.
  std::function<std::string(const std::string& path)> file{};
};

/// The robot that a file in URDF describes.
///
/// Guarantee: a mesh is what its file says; OBJ, OFF and PLY without a scheme are their faces as they are. Boxes are exact;
///            cylinders and spheres are inside of polyhedra, see Robot::outward. Origins are rounded to doubles.
/// Notes:     those of meshes; one line for polyhedra.
/// Errors:    InputError (unreadable) naming the line, or the mesh's file: what is not well-formed, entities, links or joints
///            that are not there or appear twice, links that are not one tree (cycles are named), joints of the types
///            floating and planar, missing meshes, meshes outside of the folders.
/// Source:    urdfdom's XML format: https://wiki.ros.org/urdf/XML.
[[nodiscard]] SNUG_API Robot read_robot(const std::string& path, const RobotOptions& options = {},
                                        const Run& run = {});
/// The same for the bytes of such a file.
[[nodiscard]] SNUG_API Robot parse_robot(std::string_view bytes, const std::string& path,
                                         const RobotOptions& options = {});
/// Adds what a file in SRDF says: pairs of links that may touch (disable_collisions; disable_default_collisions without what
/// enable_collisions has), and groups by links, joints, whose children they mean, chains and other groups.
/// Errors:    InputError (unreadable): likewise, and for links, joints and groups that are not there, chains that do not lead down,
///            groups that contain themselves.
SNUG_API void allow_pairs(Robot& robot, std::string_view bytes, const std::string& path);

/// Positions of all joints, where some are given by name; others are at 0, or where their limits are nearest to it.
/// Errors:    InputError (value) naming the joint: unknown, fixed or following another one, given twice, not finite or beyond
///            its limits.
[[nodiscard]] SNUG_API std::vector<double> joint_positions(
    const Robot& robot, std::span<const std::pair<std::string, double>> given);

/// Poses of all links in the frame of the root, up to roundings.
/// Errors:    InputError (value) unless there is a position for each joint.
[[nodiscard]] SNUG_API std::vector<Motion> link_poses(const Robot& robot, std::span<const double> positions);

/// Pairs of links with shapes that can move against each other and are not allowed to touch. Links that a joint joins, also
/// by way of fixed joints, are left out unless `joined`. With a group only pairs with a link of it.
/// Errors:    InputError (value) for a group that the robot does not have.
[[nodiscard]] SNUG_API std::vector<PartPair> pairs_to_check(const Robot& robot, bool joined = false,
                                                            const std::string& group = {});

/// The last link that moves both, itself included.
/// Errors:    InputError (value) for a number that no link has.
[[nodiscard]] SNUG_API std::uint32_t common_link(const Robot& robot, std::uint32_t a, std::uint32_t b);

/// How two shapes move in the frame of the last link that moves both, from each list of positions of all joints to the next.
/// Errors:    InputError (value): those of Trajectory::joints() and of common_link(); lists without a position for each joint.
[[nodiscard]] SNUG_API std::pair<Trajectory, Trajectory> link_motions(
    const Robot& robot, const std::pair<std::uint32_t, Motion>& a, const std::pair<std::uint32_t, Motion>& b,
    std::span<const std::vector<double>> positions);

struct LinkContactsOptions {
  /// Shapes this close may be reported as within; `size`: the larger one of two meshes. Default: 0.1 % of it.
  std::function<double(double size)> tolerance{};
  std::function<double(double size)> margin{};  ///< distance to be kept; `size` as above. Default: 0
  bool joined = false;                          ///< also pairs of links that a joint joins
  std::string group{};                          ///< only pairs with a link of this group
};
/// When two shapes of two links first meet.
struct LinkContact {
  std::string a, b;                     ///< Link::name_of() the shapes
  std::string frame;                    ///< the link in whose frame the witness is
  std::array<PlacedSurface, 2> placed;  ///< at the upper end of the time, or at 0 if that is infinite
  TimeOfContact answer;
};

/// Which links meet along a path of the joints: first contacts of all pairs_to_check(), shape by shape. `surfaces`: one a mesh.
///
/// Guarantee: that of time_of_contact() with link_motions(), between the positions too. Meshes that go beyond their shapes are
///            never "intersecting": that is nearness.
/// Errors:    those of link_motions() and time_of_contact(); InputError (value) unless there is a surface for each mesh.
/// Budget:    of each pair, as time_of_contact() has it.
[[nodiscard]] SNUG_API std::vector<LinkContact> first_contacts(const Robot& robot,
                                                               std::span<const Surface> surfaces,
                                                               std::span<const std::vector<double>> positions,
                                                               const LinkContactsOptions& options = {},
                                                               const Run& run = {});

}  // namespace snug
