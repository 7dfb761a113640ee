#include <snug/robot.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <set>

#include <support/error.h>
#include <support/number.h>
#include <support/parallel.h>
#include <support/run.h>

namespace snug {

std::string Robot::Link::name_of(std::size_t shape) const {
  return shapes.size() == 1 ? name : name + '#' + std::to_string(shape + 1);
}
namespace {

void require_positions(const Robot& robot, std::span<const double> positions) {
  require_value(positions.size() == robot.joints.size(),
                "robot: give a position for each joint, as joint_positions() does");
}

/// The link that all links hang on which do not move against this one.
std::vector<std::uint32_t> rigid_groups(const Robot& robot) {
  std::vector<std::uint32_t> group(robot.links.size());
  for (std::uint32_t l = 0; l < robot.links.size(); ++l) {
    const auto& joint = robot.links[l].joint;
    group[l] = joint && robot.joints[*joint].fixed ? group[robot.joints[*joint].parent] : l;
  }
  return group;
}

std::uint32_t above(const Robot& robot, std::uint32_t link) {
  return robot.joints[*robot.links[link].joint].parent;
}

/// Joints from a link that is above another one down to that.
std::vector<std::uint32_t> joints_between(const Robot& robot, std::uint32_t from, std::uint32_t to) {
  std::vector<std::uint32_t> joints;
  for (; to != from; to = above(robot, to)) joints.push_back(*robot.links[to].joint);
  std::reverse(joints.begin(), joints.end());
  return joints;
}

void require(bool holds, const std::string& message) {
  if (!holds) throw InputError(InputProblem::value, message);
}

}  // namespace

std::vector<double> joint_positions(const Robot& robot,
                                    std::span<const std::pair<std::string, double>> given) {
  std::vector<double> positions(robot.joints.size(), 0);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const Robot::Joint& joint = robot.joints[j];
    if (!joint.fixed) positions[j] = std::clamp(0.0, joint.lower, joint.upper);
  }
  std::set<std::string> met;
  for (const auto& [name, position] : given) {
    const auto found = std::ranges::find(robot.joints, name, &Robot::Joint::name);
    require(found != robot.joints.end(), "robot: no joint is called '" + name + "'");
    const std::string which = "robot: joint '" + name + "' ";
    require(met.insert(name).second, which + "has two positions");
    require(!found->fixed, which + "is fixed");
    require(!found->mimic, which + "follows another joint: give the position of that one");
    require(std::isfinite(position), which + "has a position that is not finite");
    if (!(position >= found->lower && position <= found->upper)) {
      std::string text = which + "is at ";
      append_real(text, position);
      text += ", beyond its limits ";
      append_real(text, found->lower);
      text += " to ";
      append_real(text, found->upper);
      throw InputError(InputProblem::value, text);
    }
    positions[static_cast<std::size_t>(found - robot.joints.begin())] = position;
  }
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    if (const auto& mimic = robot.joints[j].mimic)
      positions[j] = mimic->factor * positions[mimic->joint] + mimic->offset;
  }
  return positions;
}

std::vector<Motion> link_poses(const Robot& robot, std::span<const double> positions) {
  require_positions(robot, positions);
  std::vector<Motion> poses(robot.links.size());
  for (std::size_t l = 0; l < robot.links.size(); ++l) {
    if (!robot.links[l].joint) continue;
    const std::size_t j = *robot.links[l].joint;
    const Robot::Joint& joint = robot.joints[j];
    const std::vector<std::vector<double>> at{{joint.fixed ? 0 : positions[j]}};
    poses[l] = poses[joint.parent] * Trajectory::joints(std::span(&joint.axis, 1), {}, at).start();
  }
  return poses;
}

std::vector<PartPair> pairs_to_check(const Robot& robot, bool joined, const std::string& group_name) {
  const std::vector<std::uint32_t> group = rigid_groups(robot);
  std::vector<bool> wanted(robot.links.size(), group_name.empty());
  if (!group_name.empty()) {
    const auto found = robot.groups.find(group_name);
    if (found == robot.groups.end())
      throw InputError(InputProblem::value, "robot: there is no group '" + group_name + "'");
    for (const std::uint32_t link : found->second) wanted[link] = true;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> left_out;
  for (const PartPair& pair : robot.allowed) left_out.insert(std::minmax(pair.a, pair.b));
  std::set<std::pair<std::uint32_t, std::uint32_t>> neighbours;
  for (const Robot::Joint& joint : robot.joints)
    neighbours.insert(std::minmax(group[joint.parent], group[joint.child]));
  std::vector<PartPair> pairs;
  for (std::uint32_t a = 0; a < robot.links.size(); ++a) {
    for (std::uint32_t b = a + 1; b < robot.links.size(); ++b) {
      if (robot.links[a].shapes.empty() || robot.links[b].shapes.empty() || group[a] == group[b]) continue;
      if (!joined && neighbours.contains(std::minmax(group[a], group[b]))) continue;
      if ((wanted[a] || wanted[b]) && !left_out.contains({a, b})) pairs.push_back({a, b});
    }
  }
  return pairs;
}

// Parents come first: the larger index is not above the smaller one.
std::uint32_t common_link(const Robot& robot, std::uint32_t a, std::uint32_t b) {
  require_value(std::max(a, b) < robot.links.size(), "robot: no link has this number");
  while (a != b) (a > b ? a : b) = above(robot, std::max(a, b));
  return a;
}

std::pair<Trajectory, Trajectory> link_motions(const Robot& robot, const std::pair<std::uint32_t, Motion>& a,
                                               const std::pair<std::uint32_t, Motion>& b,
                                               std::span<const std::vector<double>> positions) {
  for (const std::vector<double>& list : positions) require_positions(robot, list);
  const std::uint32_t common = common_link(robot, a.first, b.first);
  const auto motion = [&](const std::pair<std::uint32_t, Motion>& shape) -> Trajectory {
    std::vector<ChainJoint> chain;
    std::vector<std::vector<double>> path(positions.size());
    Motion before;  // of fixed joints
    bool moves = false;
    for (const std::uint32_t j : joints_between(robot, common, shape.first)) {
      const Robot::Joint& joint = robot.joints[j];
      if (joint.fixed) {
        before = before * joint.axis.frame;
        continue;
      }
      chain.push_back(joint.axis);
      chain.back().frame = before * joint.axis.frame;
      before = {};
      for (std::size_t i = 0; i < positions.size(); ++i) {
        path[i].push_back(positions[i][j]);
        moves = moves || path[i].back() != path[0].back();
      }
    }
    const Trajectory result = Trajectory::joints(chain, before * shape.second, path);
    return moves ? result : Trajectory(result.start());
  };
  return {motion(a), motion(b)};
}

namespace {

struct ShapePair {
  PartPair links;
  std::array<std::size_t, 2> shapes;
};

std::vector<ShapePair> shape_pairs(const Robot& robot, const LinkContactsOptions& options) {
  std::vector<ShapePair> pairs;
  for (const PartPair& links : pairs_to_check(robot, options.joined, options.group)) {
    for (std::size_t a = 0; a < robot.links[links.a].shapes.size(); ++a) {
      for (std::size_t b = 0; b < robot.links[links.b].shapes.size(); ++b) pairs.push_back({links, {a, b}});
    }
  }
  return pairs;
}

LinkContact first_contact(const Robot& robot, const ShapePair& pair, std::span<const Surface> surfaces,
                          std::span<const std::vector<double>> positions, const LinkContactsOptions& options,
                          const Run& run) {
  const Robot::Link &link_a = robot.links[pair.links.a], &link_b = robot.links[pair.links.b];
  const Robot::Shape &shape_a = link_a.shapes[pair.shapes[0]], &shape_b = link_b.shapes[pair.shapes[1]];
  const auto [motion_a, motion_b] =
      link_motions(robot, {pair.links.a, shape_a.pose}, {pair.links.b, shape_b.pose}, positions);
  const Surface &a = surfaces[shape_a.mesh], &b = surfaces[shape_b.mesh];
  TimeOfContactOptions how;
  const double size = std::max(a.size(), b.size());
  if (options.tolerance) how.tolerance = options.tolerance(size);
  if (options.margin) how.margin = options.margin(size);
  TimeOfContact answer = time_of_contact(a, motion_a, b, motion_b, how, run);
  // Links that rest to each other have motions of no duration.
  if (answer.verdict == Verdict::separated) answer.time.lower = static_cast<double>(positions.size() - 1);
  // A mesh that goes beyond its shape meets others before the shape does.
  const bool goes_beyond = robot.outward[shape_a.mesh] > 0 || robot.outward[shape_b.mesh] > 0;
  if (answer.verdict == Verdict::intersecting && goes_beyond) answer.verdict = Verdict::within;
  const double time = std::isfinite(answer.time.upper) ? answer.time.upper : 0;
  return {link_a.name_of(pair.shapes[0]),
          link_b.name_of(pair.shapes[1]),
          robot.links[common_link(robot, pair.links.a, pair.links.b)].name,
          {a.at(motion_a.at(time)), b.at(motion_b.at(time))},
          std::move(answer)};
}

}  // namespace

std::vector<LinkContact> first_contacts(const Robot& robot, std::span<const Surface> surfaces,
                                        std::span<const std::vector<double>> positions,
                                        const LinkContactsOptions& options, const Run& run) {
  require_value(surfaces.size() == robot.meshes.size(), "robot: give a surface for each mesh");
  require_value(!positions.empty(), "robot: give positions of the joints, once or more often");
  const WorkMonitor& monitor = monitor_of(run);
  const WorkMonitor quiet = stop_only(run);
  for (const Surface& surface : surfaces) surface.prepare({.threads = run.threads, .monitor = &quiet});
  const std::vector<ShapePair> pairs = shape_pairs(robot, options);
  std::vector<std::optional<LinkContact>> found(pairs.size());
  std::atomic<std::size_t> done{0};
  parallel_for(pairs.size(), run.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      found[i] = first_contact(robot, pairs[i], surfaces, positions, options,
                               {.threads = 1, .monitor = &quiet, .max_splits = run.max_splits});
      monitor.report(static_cast<double>(++done) / static_cast<double>(pairs.size()));
    }
  });
  std::vector<LinkContact> contacts;
  contacts.reserve(found.size());
  for (std::optional<LinkContact>& each : found) contacts.push_back(*std::move(each));
  return contacts;
}

}  // namespace snug
