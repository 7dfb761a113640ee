#include <snug/robot.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

#include <snug/geometry/motion.h>
#include <snug/io/other_file.h>
#include <snug/io/xml.h>
#include <snug/mesh/primitives.h>
#include <snug/scheme/scheme.h>
#include <support/error.h>
#include <support/number.h>
#include <support/read_file.h>
#include <support/run.h>
#include <support/system_files.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

namespace fs = std::filesystem;

/// Names in a joint before all links are known.
struct JointNames {
  std::string parent, child, mimic;
  std::size_t line;
};

// For messages: other bytes than printable ASCII as \xNN.
std::string printable(const std::string& path) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const char c : path) {
    if (c >= ' ' && c <= '~') {
      text += c;
    } else {
      text +=
          {'\\', 'x', digits[static_cast<unsigned char>(c) >> 4], digits[static_cast<unsigned char>(c) & 15]};
    }
  }
  return text;
}

class RobotReader {
 public:
  RobotReader(std::string_view text, const std::string& name, const std::string& path,
              const RobotOptions& options)
      : name_(name),
        xml_(text, name),
        options_(options),
        folder_(system_files::path_of(path == "-" ? "" : path).parent_path()) {}

  Robot read() {
    if (xml_.next() != XmlReader::Event::begin || xml_.element() != "robot")
      xml_.fail("URDF: 'robot' is missing: this is no robot");
    robot_.name = xml_.text("name").value_or("robot");
    xml_.each_child([&] {
      if (xml_.prefix() == "xacro")
        xml_.fail("URDF: macros are not expanded: xacro robot.xacro > robot.urdf");
      if (xml_.element() == "link" && xml_.prefix().empty()) {
        read_link();
      } else if (xml_.element() == "joint" && xml_.prefix().empty()) {
        read_joint();
      } else {
        xml_.skip();
      }
    });
    static_cast<void>(xml_.next());
    if (robot_.links.empty()) fail_in_file(name_, "URDF: the robot has no links");
    join();
    sort();
    write_notes();
    return std::move(robot_);
  }

 private:
  // --- parts of the text

  [[nodiscard]] Vector3 vector(std::string_view attribute, const Vector3& otherwise) const {
    const std::optional<std::string> text = xml_.text(attribute);
    if (!text) return otherwise;
    const std::vector<double> n = numbers_of(xml_, attribute, *text, 3);
    return {n[0], n[1], n[2]};
  }

  /// Turned by roll, pitch and yaw about x, y and z, which stay; then moved.
  [[nodiscard]] Motion origin() const {
    const Vector3 rpy = vector("rpy", {}), xyz = vector("xyz", {});
    Motion motion;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Vector3 about;
      about[axis] = 1;
      if (rpy[axis] == 0) continue;
      if (!(std::fabs(rpy[axis]) < 0x1p30)) xml_.fail("rpy: an angle is more than 1e8 turns");
      motion = Motion::rotation(about, rpy[axis]) * motion;
    }
    return motion.with_offset(xyz);
  }

  double positive(std::string_view attribute) const {
    const double size = xml_.number(attribute);
    if (!(size > 0 && size < 1e150)) xml_.fail(std::string(attribute) + " is not a positive length");
    return size;
  }

  // --- links

  void read_link() {
    Robot::Link link{xml_.required_text("name"), {}, {}};
    if (!links_.emplace(link.name, robot_.links.size()).second)
      xml_.fail("URDF: the link " + in_quotes(link.name) + " appears twice");
    const std::string_view wanted = options_.visual ? "visual" : "collision";
    xml_.each_child([&] {
      if (xml_.element() == wanted) {
        read_shape(link);
      } else {
        xml_.skip();
      }
    });
    robot_.links.push_back(std::move(link));
  }

  void read_shape(Robot::Link& link) {
    Motion pose;
    std::optional<std::uint32_t> mesh;
    xml_.each_child([&] {
      if (xml_.element() == "origin") {
        pose = origin();
        xml_.skip();
      } else if (xml_.element() == "geometry") {
        xml_.each_child([&] {
          if (mesh) xml_.fail("URDF: two shapes in one geometry");
          mesh = read_geometry();
          xml_.skip();
        });
      } else {
        xml_.skip();
      }
    });
    if (!mesh) xml_.fail("URDF: the link " + in_quotes(link.name) + " has a shape without geometry");
    link.shapes.push_back({*mesh, pose});
  }

  std::uint32_t read_geometry() {
    const std::string_view kind = xml_.element();
    if (kind == "mesh") return read_mesh_element();
    if (kind == "box") {
      const Vector3 sides = vector("size", {});
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(sides[axis] > 0 && sides[axis] < 1e150)) xml_.fail("size is not three positive lengths");
      }
      return add_mesh(box_mesh(sides), "box");
    }
    if (kind == "sphere")
      return add_outer(sphere_mesh(positive("radius"), options_.primitive_error), "sphere");
    if (kind == "cylinder") {
      return add_outer(cylinder_mesh(positive("radius"), positive("length"), options_.primitive_error),
                       "cylinder");
    }
    xml_.fail("URDF: " + in_quotes(kind) + " is not one of mesh, box, cylinder and sphere");
  }

  std::uint32_t add_mesh(ControlMesh mesh, const std::string& name, double outward = 0) {
    robot_.outward.push_back(outward);
    mesh.metres_per_unit = 1;
    robot_.meshes.push_back(std::move(mesh));
    robot_.mesh_names.push_back(name);
    return static_cast<std::uint32_t>(robot_.meshes.size() - 1);
  }
  std::uint32_t add_outer(OuterMesh outer, const std::string& name) {
    ++outer_;
    return add_mesh(std::move(outer.mesh), name, outer.outward);
  }

  // --- meshes

  /// Where a mesh is; within the folders.
  [[nodiscard]] std::string place_of(const std::string& filename) const {
    const std::string what = "URDF: line " + std::to_string(xml_.line());
    constexpr std::string_view package = "package://", file = "file://";
    if (filename.starts_with(package)) {
      const std::string path = path_inside(std::string_view(filename).substr(package.size()), name_, what);
      const std::string own = path.substr(0, path.find('/'));
      const std::string rest = own.size() < path.size() ? path.substr(own.size() + 1) : std::string();
      const auto fail = [&](const std::string& why) {
        fail_in_file(name_, what + ": " + in_quotes(filename) + why);
      };
      if (const auto known = options_.packages.find(own); known != options_.packages.end())
        return system_files::name_of(system_files::path_of(known->second) /
                                     system_files::path_of(path_inside(rest, name_, what)));
      const auto all = options_.packages.find("");
      if (all == options_.packages.end())
        fail(" is in a package whose folder is not known: give --package " + one_word(own) +
             "=FOLDER, or in Python packages={'" + one_word(own) + "': FOLDER}");
      return system_files::name_of(system_files::path_of(all->second) / system_files::path_of(path));
    }
    std::string path = filename;
    if (filename.starts_with(file)) path = filename.substr(file.size());
    if (path.find("://") != std::string::npos || path.empty() || path.find('\0') != std::string::npos)
      static_cast<void>(path_inside(path, name_, what));  // says why not
    const auto plain = [](const fs::path& of) {
      return (of.empty() ? fs::path(".") : of).lexically_normal();
    };
    fs::path root = plain(options_.root.empty() ? folder_ : system_files::path_of(options_.root)),
             place = plain(folder_ / system_files::path_of(path));
    // A page has no current folder, and names tell enough but here.
    if (root.root_path() != place.root_path() || *root.begin() == "..") {
      root = fs::absolute(root).lexically_normal();
      place = fs::absolute(place).lexically_normal();
    }
    const fs::path inside = place.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..") {
      fail_in_file(name_,
                   what + ": " + in_quotes(filename) +
                       " leads out of the folder of the robot: give the folder that holds all by --root");
    }
    return system_files::name_of(folder_ / system_files::path_of(path));
  }
  static std::string one_word(const std::string& name) {
    const std::string quoted = in_quotes(name);
    return quoted.substr(1, quoted.size() - 2);
  }

  std::uint32_t read_mesh_element() {
    const std::string filename = xml_.required_text("filename");
    const Vector3 scale = vector("scale", {1, 1, 1});
    const auto key = std::tuple(filename, scale.x, scale.y, scale.z);
    if (const auto known = meshes_.find(key); known != meshes_.end()) return known->second;
    const std::string place = place_of(filename), shown = printable(place);
    const fs::path folder = system_files::path_of(place).parent_path();
    const auto bytes_of = [&](const std::string& path) {
      return options_.file ? options_.file(path) : read_file(path);
    };
    ControlMesh mesh;
    try {
      const ReadOptions reading{
          .notes = options_.notes, .other_file = [&](const std::string& other) {
            return bytes_of(system_files::name_of(folder / system_files::path_of(other)));
          }};
      mesh = parse_mesh(bytes_of(place), shown, reading);
    } catch (const InputError& error) {
      fail_in_file(name_ + ':' + std::to_string(xml_.line()), error.what());
    }
    as_it_is(mesh, shown);
    scale_points(mesh, scale, shown);
    const std::uint32_t number = add_mesh(std::move(mesh), filename);
    meshes_.emplace(key, number);
    return number;
  }

  /// Without a scheme of its own a mesh is what is seen of it, not a control mesh.
  void as_it_is(ControlMesh& mesh, const std::string& place) const {
    if (mesh.tags.scheme) return;
    mesh.tags.scheme = scheme_of_faces(mesh) == Scheme::loop ? Scheme::flat : Scheme::bilinear;
    if (mesh.tags.scheme == Scheme::bilinear && options_.notes)
      options_.notes(place + ": faces with more than three corners are taken as bilinear");
  }

  void scale_points(ControlMesh& mesh, const Vector3& scale, const std::string& place) const {
    if (scale == Vector3{1, 1, 1}) return;
    for (Point3& p : mesh.points) {
      p = {p.x * scale.x, p.y * scale.y, p.z * scale.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(p[axis])) fail_in_file(name_, place + ": scaled beyond the range of doubles");
      }
    }
    if ((scale.x < 0) + (scale.y < 0) + (scale.z < 0) == 1 ||
        (scale.x < 0) + (scale.y < 0) + (scale.z < 0) == 3) {
      for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::reverse(mesh.face_vertices.begin() + mesh.face_offsets[f] + 1,
                     mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
      }
    }
  }

  // --- joints

  void read_joint() {
    Robot::Joint joint{.name = xml_.required_text("name"), .parent = 0, .child = 0};
    JointNames names{.parent = {}, .child = {}, .mimic = {}, .line = xml_.line()};
    const std::string type = xml_.required_text("type");
    constexpr std::array<std::string_view, 4> known{"fixed", "revolute", "continuous", "prismatic"};
    if (std::ranges::find(known, type) == known.end()) {
      xml_.fail("URDF: joint " + in_quotes(joint.name) + ": the type " + in_quotes(type) +
                " is not one of fixed, revolute, continuous and prismatic");
    }
    joint.fixed = type == "fixed";
    joint.axis.slides = type == "prismatic";
    joint.axis.axis = {1, 0, 0};
    if (!joints_.emplace(joint.name, robot_.joints.size()).second)
      xml_.fail("URDF: the joint " + in_quotes(joint.name) + " appears twice");
    xml_.each_child([&] {
      const std::string_view element = xml_.element();
      if (element == "parent") names.parent = xml_.required_text("link");
      if (element == "child") names.child = xml_.required_text("link");
      if (element == "origin") joint.axis.frame = origin();
      if (element == "axis") joint.axis.axis = vector("xyz", {1, 0, 0});
      if (element == "limit" && type != "continuous" && !joint.fixed) {
        joint.lower = xml_.raw("lower").empty() ? 0 : xml_.number("lower");
        joint.upper = xml_.raw("upper").empty() ? 0 : xml_.number("upper");
        if (joint.lower > joint.upper)
          xml_.fail("URDF: joint " + in_quotes(joint.name) + ": its limits are reversed");
      }
      if (element == "mimic") {
        names.mimic = xml_.required_text("joint");
        joint.mimic = Robot::Mimic{0, xml_.raw("multiplier").empty() ? 1 : xml_.number("multiplier"),
                                   xml_.raw("offset").empty() ? 0 : xml_.number("offset")};
      }
      xml_.skip();
    });
    if (joint.axis.axis == Vector3{} && !joint.fixed)
      xml_.fail("URDF: joint " + in_quotes(joint.name) + ": its axis has no length");
    if (joint.fixed) joint.axis.axis = {0, 0, 1};
    robot_.joints.push_back(std::move(joint));
    names_.push_back(std::move(names));
  }

  [[noreturn]] void fail_at(std::size_t line, const std::string& message) const {
    fail_in_file(name_ + ':' + std::to_string(line), message);
  }

  void join() {
    const auto link = [&](const std::string& name, std::size_t joint, const char* what) {
      const std::string which = "URDF: joint " + in_quotes(robot_.joints[joint].name);
      if (name.empty()) fail_at(names_[joint].line, which + " has no " + what);
      const auto found = links_.find(name);
      if (found == links_.end())
        fail_at(names_[joint].line, which + ": its " + what + ' ' + in_quotes(name) + " is no link");
      return static_cast<std::uint32_t>(found->second);
    };
    for (std::uint32_t j = 0; j < robot_.joints.size(); ++j) {
      Robot::Joint& joint = robot_.joints[j];
      joint.parent = link(names_[j].parent, j, "parent");
      joint.child = link(names_[j].child, j, "child");
      std::optional<std::uint32_t>& above = robot_.links[joint.child].joint;
      if (above) {
        fail_at(names_[j].line, "URDF: the link " + in_quotes(robot_.links[joint.child].name) +
                                    " hangs on two joints, " + in_quotes(robot_.joints[*above].name) +
                                    " and " + in_quotes(joint.name) + ": cut one of them");
      }
      above = j;
      if (!joint.mimic) continue;
      const auto found = joints_.find(names_[j].mimic);
      if (found == joints_.end())
        fail_at(names_[j].line, "URDF: joint " + in_quotes(joint.name) + " follows " +
                                    in_quotes(names_[j].mimic) + ", which is no joint");
      joint.mimic->joint = static_cast<std::uint32_t>(found->second);
    }
    for (std::uint32_t j = 0; j < robot_.joints.size(); ++j) {
      const std::optional<Robot::Mimic>& mimic = robot_.joints[j].mimic;
      if (mimic &&
          (robot_.joints[mimic->joint].mimic || mimic->joint == j || robot_.joints[mimic->joint].fixed)) {
        fail_at(names_[j].line, "URDF: joint " + in_quotes(robot_.joints[j].name) +
                                    " follows a joint that is fixed or follows another one itself");
      }
    }
  }

  /// Parents before children, else in the order of the file.
  void sort() {
    const std::size_t count = robot_.links.size();
    std::vector<std::uint32_t> order, roots;
    std::vector<std::vector<std::uint32_t>> children(count);
    for (const Robot::Joint& joint : robot_.joints) children[joint.parent].push_back(joint.child);
    for (std::uint32_t l = 0; l < count; ++l) {
      if (!robot_.links[l].joint) roots.push_back(l);
    }
    if (roots.size() > 1) {
      fail_in_file(name_, "URDF: the links " + in_quotes(robot_.links[roots[0]].name) + " and " +
                              in_quotes(robot_.links[roots[1]].name) +
                              " both hang on no joint: a robot has one root");
    }
    order = roots;
    for (std::size_t i = 0; i < order.size(); ++i)
      order.insert(order.end(), children[order[i]].begin(), children[order[i]].end());
    if (order.size() < count) refuse_cycle(order);
    std::vector<std::uint32_t> place(count);
    std::vector<Robot::Link> links;
    for (std::uint32_t i = 0; i < count; ++i) {
      place[order[i]] = i;
      links.push_back(std::move(robot_.links[order[i]]));
    }
    robot_.links = std::move(links);
    for (Robot::Joint& joint : robot_.joints) {
      joint.parent = place[joint.parent];
      joint.child = place[joint.child];
    }
  }

  [[noreturn]] void refuse_cycle(const std::vector<std::uint32_t>& reached) const {
    std::vector<bool> met(robot_.links.size(), false);
    for (const std::uint32_t l : reached) met[l] = true;
    std::uint32_t at = static_cast<std::uint32_t>(std::ranges::find(met, false) - met.begin());
    while (!met[at]) {  // upwards, until a link comes again
      met[at] = true;
      at = robot_.joints[*robot_.links[at].joint].parent;
    }
    std::string names = in_quotes(robot_.links[at].name);
    std::size_t count = 1;
    for (std::uint32_t l = robot_.joints[*robot_.links[at].joint].parent; l != at && count < 8; ++count) {
      names += ", " + in_quotes(robot_.links[l].name);
      l = robot_.joints[*robot_.links[l].joint].parent;
    }
    fail_in_file(name_, "URDF: links hang on each other in a cycle: " + names + ": cut a joint of it");
  }

  void write_notes() const {
    if (!options_.notes || outer_ == 0) return;
    options_.notes(name_ + ": " + "cylinders and spheres (" + std::to_string(outer_) +
                   ") are inside polyhedra that go beyond them by at most " +
                   text_at_most(*std::max_element(robot_.outward.begin(), robot_.outward.end()), true) +
                   " m");
  }

  const std::string& name_;
  XmlReader xml_;
  const RobotOptions& options_;
  fs::path folder_;
  Robot robot_;
  std::unordered_map<std::string, std::size_t> links_, joints_;
  std::vector<JointNames> names_;
  std::map<std::tuple<std::string, double, double, double>, std::uint32_t> meshes_;
  std::size_t outer_ = 0;
};

}  // namespace

Robot parse_robot(std::string_view bytes, const std::string& path, const RobotOptions& options) {
  const std::string name = input_name(path);
  require_value(options.primitive_error >= 1e-5 && options.primitive_error < 1,
                "robot: the error of cylinders and spheres is not from 1e-5 to below 1, of the radius");
  const std::string_view text = plain_text(bytes, name);
  if (const auto first = text.find_first_not_of(" \t\r\n"); first != text.npos && text[first] != '<')
    fail_in_file(
        name,
        "not a robot in URDF, which is XML; of parts in a scene file ask collide or distance, with --scene");
  return RobotReader(text, name, path, options).read();
}

Robot read_robot(const std::string& path, const RobotOptions& options, const Run& run) {
  return parse_robot(read_file(path, monitor_of(run)), path, options);
}

namespace {

class SrdfReader {
 public:
  SrdfReader(Robot& robot, std::string_view text, const std::string& name)
      : robot_(robot), xml_(text, name) {}

  void read() {
    if (xml_.next() != XmlReader::Event::begin || xml_.element() != "robot")
      xml_.fail("SRDF: 'robot' is missing: this does not describe a robot");
    xml_.each_child([&] {
      const std::string_view kind = xml_.prefix().empty() ? xml_.element() : std::string_view();
      if (kind == "group") {
        read_group();
        return;
      }
      if (kind == "disable_collisions") robot_.allowed.push_back({link("link1"), link("link2")});
      if (kind == "disable_default_collisions") alone_.insert(link("link"));
      if (kind == "enable_collisions") enabled_.insert(std::minmax(link("link1"), link("link2")));
      xml_.skip();
    });
    static_cast<void>(xml_.next());
    for (const std::uint32_t own : alone_) {
      for (std::uint32_t other = 0; other < robot_.links.size(); ++other) {
        if (other != own && !enabled_.contains(std::minmax(own, other)))
          robot_.allowed.push_back({own, other});
      }
    }
    for (const auto& [name, parts] : groups_) {
      std::set<std::string> open, done;
      std::set<std::uint32_t> links;
      collect(name, open, done, links);
      robot_.groups[name].assign(links.begin(), links.end());
    }
  }

 private:
  struct Group {
    std::vector<std::uint32_t> links;
    std::vector<std::string> groups;
  };
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  static constexpr std::size_t most_groups = 1000;  // whatever contains whatever, little time is spent

  std::uint32_t link(std::string_view attribute) {
    return named(robot_.links, &Robot::Link::name, attribute, "link ");
  }
  template <class List, class Name>
  std::uint32_t named(const List& list, Name name, std::string_view attribute, const char* what) {
    const std::string own = xml_.required_text(attribute);
    const auto found = std::ranges::find(list, own, name);
    if (found == list.end()) xml_.fail(std::string("SRDF: the robot has no ") + what + in_quotes(own));
    return static_cast<std::uint32_t>(found - list.begin());
  }

  void read_group() {
    Group& group = groups_[xml_.required_text("name")];
    if (groups_.size() > most_groups) xml_.fail("SRDF: more than " + std::to_string(most_groups) + " groups");
    xml_.each_child([&] {
      const std::string_view kind = xml_.element();
      if (kind == "link") group.links.push_back(link("name"));
      if (kind == "joint")
        group.links.push_back(
            robot_.joints[named(robot_.joints, &Robot::Joint::name, "name", "joint ")].child);
      if (kind == "group") group.groups.push_back(xml_.required_text("name"));
      if (kind == "chain") add_chain(group);
      xml_.skip();
    });
  }

  void add_chain(Group& group) {
    const std::uint32_t base = link("base_link"), tip = link("tip_link");
    for (std::uint32_t own = tip; own != base;) {
      group.links.push_back(own);
      const auto joint = robot_.links[own].joint;
      if (!joint)
        xml_.fail("SRDF: no chain leads from " + in_quotes(robot_.links[base].name) + " down to " +
                  in_quotes(robot_.links[tip].name));
      own = robot_.joints[*joint].parent;
    }
  }

  void collect(const std::string& name, std::set<std::string>& open, std::set<std::string>& done,
               std::set<std::uint32_t>& links) {
    const auto found = groups_.find(name);
    if (found == groups_.end()) xml_.fail("SRDF: there is no group " + in_quotes(name));
    if (done.contains(name)) return;
    if (!open.insert(name).second) xml_.fail("SRDF: the group " + in_quotes(name) + " contains itself");
    links.insert(found->second.links.begin(), found->second.links.end());
    for (const std::string& other : found->second.groups) collect(other, open, done, links);
    open.erase(name);
    done.insert(name);
  }

  Robot& robot_;
  XmlReader xml_;
  std::set<std::uint32_t> alone_;
  std::set<Pair> enabled_;
  std::map<std::string, Group> groups_;
};

}  // namespace

void allow_pairs(Robot& robot, std::string_view bytes, const std::string& path) {
  const std::string name = input_name(path);
  SrdfReader(robot, plain_text(bytes, name), name).read();
}

}  // namespace snug
