#include <snug/io/placed_meshes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <unordered_set>
#include <utility>

#include <support/error.h>
#include <support/number.h>
#include <support/text_cursor.h>

namespace snug {
namespace {

using Part = PlacedMeshes::Part;

class Placer {
 public:
  Placer(const PlacedMeshes& placed, const std::string& name) : placed_(placed), name_(name) {
    std::size_t elements = 0;
    for (const Part& part : placed.parts) {
      const ControlMesh& mesh = placed.meshes[part.mesh];
      elements += mesh.face_vertices.size() + mesh.points.size();
      if (elements <= placed.max_elements) continue;
      fail_in_file(name,
                   part.what + ": more than " + std::to_string(placed.max_elements) +
                       " vertices and corners, with all instances: write fewer of them, or split the file");
    }
  }

  [[nodiscard]] ControlMesh moved(const Part& part) {
    ControlMesh mesh = placed_.meshes[part.mesh];
    if (part.map == AffineEnclosure()) return mesh;
    moves_ = true;
    for (Point3& point : mesh.points) {
      const std::array<Interval, 3> image = part.map(point);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = middle(image[axis]);
        add_rounding(radius(image[axis]), point[axis], part);
      }
    }
    if (part.map.handedness() < 0) {
      for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        std::reverse(mesh.face_vertices.begin() + mesh.face_offsets[f] + 1,
                     mesh.face_vertices.begin() + mesh.face_offsets[f + 1]);
      }
    }
    return mesh;
  }

  /// The motion that the map is, if it is one up to rounding.
  [[nodiscard]] std::optional<Motion> motion_of(const Part& part) {
    if (part.map == AffineEnclosure()) return Motion();
    std::array<double, 12> numbers;
    std::array<double, 3> error{};
    double reach = 0;
    for (const Point3& p : placed_.meshes[part.mesh].points)
      reach = std::fmax(reach, std::fmax(std::fabs(p.x), std::fmax(std::fabs(p.y), std::fabs(p.z))));
    for (std::size_t i = 0; i < 3; ++i) {
      double turned = 0;
      for (std::size_t j = 0; j < 3; ++j) {
        numbers[4 * i + j] = middle(part.map.matrix[i][j]);
        turned += radius(part.map.matrix[i][j]);
      }
      numbers[4 * i + 3] = middle(part.map.shift[i]);
      error[i] = turned * reach + radius(part.map.shift[i]);
    }
    std::optional<Motion> motion;
    try {
      motion = Motion::from_3x4(numbers);
    } catch (const InputError&) {
      return {};
    }
    moves_ = true;
    for (std::size_t i = 0; i < 3; ++i) add_rounding(error[i], numbers[4 * i + 3], part);
    return motion;
  }

  void write_notes(const Notes& notes) const {
    if (!notes || !moves_) return;
    std::string text = name_ + ": points are moved by the transforms of the file";
    if (farthest_ > 0) {
      text += "; rounding moves a coordinate by at most ";
      append_real(text, farthest_);
    }
    notes(text);
  }

 private:
  void add_rounding(double by, double coordinate, const Part& part) {
    if (!std::isfinite(coordinate) || !std::isfinite(by))
      fail_in_file(name_, part.what + " moves a vertex beyond the range of doubles");
    farthest_ = std::fmax(farthest_, by);
  }

  const PlacedMeshes& placed_;
  const std::string& name_;
  bool moves_ = false;
  double farthest_ = 0;
};

void append(ControlMesh& all, const ControlMesh& mesh) {
  const std::size_t first = all.vertex_count();
  all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
  const auto corners = static_cast<std::uint32_t>(all.face_vertices.size());
  for (const VertexId v : mesh.face_vertices) all.face_vertices.emplace_back(first + v.index());
  for (std::size_t f = 1; f < mesh.face_offsets.size(); ++f)
    all.face_offsets.push_back(corners + mesh.face_offsets[f]);
}

/// "bolt", "bolt#2", "bolt#3"; the number of a part without a name.
std::string fresh_name(const std::string& own, std::size_t number, std::unordered_set<std::string>& taken) {
  const std::string base = own.empty() ? std::to_string(number) : own;
  std::string name = base;
  for (std::size_t k = 2; !taken.insert(name).second; ++k) name = base + '#' + std::to_string(k);
  return name;
}

}  // namespace

ControlMesh joined(const PlacedMeshes& placed, const std::string& name, const Notes& notes) {
  Placer placer(placed, name);
  ControlMesh all;
  for (const Part& part : placed.parts) {
    const ControlMesh& own = placed.meshes[part.mesh];
    if (all.vertex_count() + own.vertex_count() > max_elements)
      fail_in_file(name, "more than " + std::to_string(max_elements) + " vertices: split the file");
    append(all, placer.moved(part));
    all.tags.scheme = own.tags.scheme;
    all.metres_per_unit = own.metres_per_unit;
  }
  placer.write_notes(notes);
  return all;
}

MeshAssembly assembled(PlacedMeshes placed, const std::string& name, const Notes& notes) {
  Placer placer(placed, name);
  MeshAssembly result;
  std::vector<std::optional<std::uint32_t>> kept(placed.meshes.size());  // meshes that have a motion
  std::unordered_set<std::string> names;
  const auto add_mesh = [&](ControlMesh mesh) {
    result.meshes.push_back(std::move(mesh));
    return static_cast<std::uint32_t>(result.meshes.size() - 1);
  };
  for (const Part& part : placed.parts) {
    MeshAssembly::Part own{fresh_name(part.name, result.parts.size(), names), 0, {}};
    if (const std::optional<Motion> motion = placer.motion_of(part)) {
      std::optional<std::uint32_t>& mesh = kept[part.mesh];
      if (!mesh) mesh = add_mesh(placed.meshes[part.mesh]);
      own.mesh = *mesh;
      own.pose = *motion;
    } else {
      own.mesh = add_mesh(placer.moved(part));
    }
    result.parts.push_back(std::move(own));
  }
  placer.write_notes(notes);
  return result;
}

}  // namespace snug
