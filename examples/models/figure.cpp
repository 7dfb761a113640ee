#include <vector>

#include "cage.h"
#include "models.h"

namespace models {

namespace {

struct Level {
  double y, middle, outer;   ///< height; x of the second and of the outermost column
  double front, back, edge;  ///< z at the middle plane, front and back; half depth of the outer column
};

/// Faces of the torso that limbs grow from.
struct Torso {
  std::size_t neck = 0, shoulder = 0, hip = 0, arm = 0;
};

Torso grow_torso(Cage& cage) {
  const std::vector<Level> levels = {
      {1.72, 0.10, 0.50, 0.24, -0.24, 0.20}, {1.95, 0.18, 0.52, 0.30, -0.28, 0.22},
      {2.00, 0.20, 0.58, 0.36, -0.34, 0.27}, {2.14, 0.20, 0.56, 0.36, -0.34, 0.27},
      {2.19, 0.18, 0.46, 0.29, -0.27, 0.21}, {2.48, 0.22, 0.55, 0.36, -0.28, 0.24},
      {2.66, 0.24, 0.60, 0.36, -0.30, 0.24}, {3.02, 0.20, 0.56, 0.20, -0.24, 0.17},
  };
  std::vector<std::array<Index, 6>> rows;
  for (const Level& l : levels) {
    const std::array<Vec3, 6> row = {{{0, l.y, l.front},
                                      {l.middle, l.y, 0.94 * l.front},
                                      {l.outer, l.y, l.edge},
                                      {l.outer, l.y, -l.edge},
                                      {l.middle, l.y, 0.94 * l.back},
                                      {0, l.y, l.back}}};
    rows.emplace_back();
    for (std::size_t k = 0; k < 6; ++k) rows.back()[k] = cage.add_point(row[k]);
  }
  Torso torso;
  for (std::size_t r = 0; r + 1 < rows.size(); ++r) {
    for (std::size_t k = 0; k < 5; ++k) {
      const std::size_t face =
          cage.add_quad({rows[r][k], rows[r][k + 1], rows[r + 1][k + 1], rows[r + 1][k]});
      if (k == 2) torso.arm = face;  // the topmost outer face stays
    }
  }
  const auto& low = rows.front();
  const auto& high = rows.back();
  torso.neck = cage.add_quad({high[0], high[1], high[4], high[5]});
  torso.shoulder = cage.add_quad({high[1], high[2], high[3], high[4]});
  cage.add_quad({low[0], low[5], low[4], low[1]});
  torso.hip = cage.add_quad({low[1], low[4], low[3], low[2]});
  return torso;
}

void grow_arm(Cage& cage, std::size_t face) {
  struct Joint {
    double x, y, z, radius;
  };
  const std::vector<Joint> joints = {
      {0.80, 2.80, -0.02, 0.20}, {1.02, 2.52, -0.03, 0.17}, {1.17, 2.32, -0.03, 0.15},
      {1.34, 2.09, 0.01, 0.25},  {1.41, 1.99, 0.02, 0.24},  {1.46, 1.91, 0.03, 0.13},
      {1.56, 1.77, 0.05, 0.19},  {1.68, 1.60, 0.08, 0.17},  {1.76, 1.48, 0.10, 0.12}};
  std::array<std::size_t, 4> hand{};
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Joint& at = joints[j];
    const auto sides =
        cage.extrude(face, {at.x, at.y, at.z}, {0.78 * at.radius, 0.62 * at.radius, 0}, {0, 0, at.radius});
    if (j == 6) hand = sides;
  }
  const std::size_t thumb = cage.towards(hand, {0, 0, 1});
  cage.extrude(thumb, {1.46, 1.80, 0.34}, {0.05, -0.06, 0}, {0.06, 0.05, 0});
  cage.extrude(thumb, {1.50, 1.71, 0.48}, {0.04, -0.05, 0}, {0.05, 0.04, 0});
}

void grow_leg(Cage& cage, std::size_t face) {
  struct Joint {
    double x, y, z, half_x, half_z;
  };
  const std::vector<Joint> joints = {{0.31, 1.45, 0.00, 0.20, 0.23},  {0.33, 1.20, 0.01, 0.19, 0.20},
                                     {0.34, 0.95, 0.03, 0.17, 0.18},  {0.34, 0.73, -0.01, 0.26, 0.27},
                                     {0.34, 0.60, -0.02, 0.25, 0.26}, {0.35, 0.28, -0.03, 0.17, 0.19},
                                     {0.36, 0.00, -0.03, 0.20, 0.24}};
  std::array<std::size_t, 4> ankle{};
  for (const Joint& at : joints)
    ankle = cage.extrude(face, {at.x, at.y, at.z}, {at.half_x, 0, 0}, {0, 0, at.half_z});
  const std::size_t toe = cage.towards(ankle, {0, 0, 1});
  cage.extrude(toe, {0.39, 0.15, 0.40}, {0.22, 0, 0}, {0, 0.15, 0});
  cage.extrude(toe, {0.42, 0.14, 0.62}, {0.21, 0, 0}, {0, 0.14, 0});
}

void grow_head(Cage& cage, std::size_t face) {
  const auto lift = [&](double width, double y, double z, double half_z) {
    return cage.extrude(face, {width / 2, y, z}, {width / 2, 0, 0}, {0, 0, -half_z});
  };
  lift(0.19, 3.12, 0.00, 0.19);
  lift(0.34, 3.22, 0.06, 0.33);
  lift(0.44, 3.42, 0.06, 0.43);
  const auto cheeks = lift(0.48, 3.68, 0.04, 0.46);
  lift(0.46, 3.88, 0.02, 0.45);
  lift(0.86, 3.84, 0.02, 0.88);  // the brim of the hat
  lift(0.86, 3.92, 0.02, 0.88);
  lift(0.46, 3.96, 0.00, 0.46);
  lift(0.40, 4.22, -0.03, 0.40);
  lift(0.28, 4.58, -0.10, 0.29);
  lift(0.16, 4.95, -0.26, 0.17);
  lift(0.08, 5.12, -0.42, 0.11);
  const std::size_t nose = cage.towards(cheeks, {0, 0, 1});
  cage.extrude(nose, {0.08, 3.56, 0.50}, {0.08, 0, 0}, {0, 0.09, 0});
  cage.extrude(nose, {0.09, 3.52, 0.72}, {0.09, 0, 0}, {0, 0.09, 0});
  const std::size_t ear = cage.towards(cheeks, {1, 0, 0});
  cage.extrude(ear, {0.54, 3.55, -0.02}, {0, 0, -0.12}, {0, 0.08, 0});
  cage.extrude(ear, {0.70, 3.64, -0.10}, {0, 0, -0.16}, {0, 0.15, 0});
  cage.extrude(ear, {0.90, 3.74, -0.18}, {0, 0, -0.04}, {0, 0.05, 0});
}

}  // namespace

// A gnome with a pointed hat, gauntlets and boots, extruded limb by limb from a torso of eight levels.
TriangleMesh make_figure() {
  Cage cage;
  const Torso torso = grow_torso(cage);
  grow_arm(cage, torso.arm);
  grow_leg(cage, torso.hip);
  grow_head(cage, torso.neck);
  TriangleMesh mesh = mirrored(cage.triangles());
  orient_outward(mesh);
  scatter_flips(mesh, 11, 9);
  return mesh;
}

}  // namespace models
