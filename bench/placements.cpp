#include "placements.h"

#include <malloc.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>

#include <snug/mesh.h>

namespace snug::bench {
namespace {

// A box as the three half edges from its middle.
struct TurnedBox {
  Point3 middle;
  std::array<Vector3, 3> half;
};

TurnedBox turned(const Box3& box, const Motion& pose) {
  const Vector3 half = 0.5 * (box.upper - box.lower);
  const std::array<Vector3, 3> edges{Vector3{half.x, 0, 0}, Vector3{0, half.y, 0}, Vector3{0, 0, half.z}};
  TurnedBox result;
  result.middle = pose.apply(box.lower + half);
  for (std::size_t k = 0; k < 3; ++k) result.half[k] = pose.rotate(edges[k]);
  return result;
}

// Separating axes, without a proof: the edges of both, and their products.
bool overlap(const TurnedBox& a, const TurnedBox& b) {
  const auto apart = [&](const Vector3& axis) {
    double reach = 0;
    for (const TurnedBox* box : {&a, &b}) {
      for (const Vector3& half : box->half) reach += std::fabs(dot(axis, half));
    }
    return std::fabs(dot(axis, b.middle - a.middle)) > reach;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    if (apart(a.half[i]) || apart(b.half[i])) return false;
    for (std::size_t j = 0; j < 3; ++j) {
      if (apart(cross(a.half[i], b.half[j]))) return false;
    }
  }
  return true;
}

Nearness sorted(Queries& queries, const PosePair& at, bool boxes_overlap) {
  const auto separated = [&](double tolerance, double margin) {
    return queries.collide(at, tolerance, margin).verdict == Verdict::separated;
  };
  if (separated(1e-5, 0.1)) return boxes_overlap ? Nearness::near : Nearness::far;
  if (separated(1e-5, 0.02)) return Nearness::near;
  return separated(1e-7, 0) ? Nearness::grazing : Nearness::colliding;
}

void print_bar(const std::string& what, double value, const char* side, double limit, bool good) {
  std::printf("bar  %s: %.3g, %s %.3g: %s\n", what.c_str(), value, side, limit, good ? "ok" : "missed");
  std::fflush(stdout);
}

}  // namespace

std::vector<Model> read_models(const std::vector<std::string>& files) {
  std::vector<Model> models;
  for (const std::string& file : files) {
    models.push_back({std::filesystem::path(file).stem().string(), unit_model(read_mesh(file))});
  }
  return models;
}

Scheme usual_scheme(const ControlMesh& mesh) {
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face(FaceId(f)).size() != 3) return Scheme::catmark;
  }
  return Scheme::loop;
}

const Model& named(const std::vector<Model>& models, const std::string& name) {
  for (const Model& model : models) {
    if (model.name == name) return model;
  }
  throw std::runtime_error("no file of a model called " + name);
}

const char* name_of(Nearness nearness) {
  switch (nearness) {
    case Nearness::colliding:
      return "colliding";
    case Nearness::grazing:
      return "grazing";
    case Nearness::near:
      return "near";
    case Nearness::far:
      return "far";
  }
  return "";
}

std::vector<Placed> sorted_placements(const Model& a, const Model& b, double side, std::size_t count,
                                      std::uint64_t seed) {
  const auto library = std::make_shared<BoundsCache>();
  const LimitSurface surface_a(a.mesh, loop_rules(), library), surface_b(b.mesh, loop_rules(), library);
  Queries queries(surface_a, surface_b);
  const Box3 box_a = used_box(a.mesh), box_b = used_box(b.mesh);
  std::mt19937_64 random(seed);
  std::vector<Placed> result(count);
  for (Placed& placed : result) {
    placed.at = place_in_room(side, random);
    placed.nearness =
        sorted(queries, placed.at, overlap(turned(box_a, placed.at.a), turned(box_b, placed.at.b)));
  }
  return result;
}

std::vector<PosePair> of(const std::vector<Placed>& all, Nearness nearness) {
  std::vector<PosePair> result;
  for (const Placed& placed : all) {
    if (placed.nearness == nearness) result.push_back(placed.at);
  }
  return result;
}

std::vector<PosePair> of(const std::vector<Placed>& all) {
  std::vector<PosePair> result;
  for (const Placed& placed : all) result.push_back(placed.at);
  return result;
}

std::vector<PosePair> contact_placements(const Model& a, const Model& b, double side, double reach,
                                         std::size_t count, std::uint64_t seed) {
  const auto library = std::make_shared<BoundsCache>();
  const LimitSurface surface_a(a.mesh, loop_rules(), library), surface_b(b.mesh, loop_rules(), library);
  Queries queries(surface_a, surface_b);
  std::mt19937_64 random(seed);
  std::vector<PosePair> result;
  while (result.size() < count) {
    PosePair pair = place_in_room(side, random);
    const Vector3 between = pair.b.offset() - pair.a.offset();
    if (!(length(between) > 0)) continue;
    const Vector3 direction = (1 / length(between)) * between;
    const auto move_to = [&](double t) { pair.b = pair.b.with_offset(pair.a.offset() + t * direction); };
    // First contact seen from outside: steps by margins that are proved to be kept do not pass it.
    double t = 2;
    for (double margin = 0.5; margin > 0.01 * reach && t > -2;) {
      move_to(t);
      if (queries.collide(pair, 0.1 * margin, margin).verdict == Verdict::separated) {
        t -= margin;
      } else {
        margin /= 2;
      }
    }
    move_to(t + reach * (static_cast<double>(random() >> 11) * 0x1p-52 - 1));
    result.push_back(pair);
  }
  return result;
}

void at_least(const std::string& what, double value, double limit) {
  print_bar(what, value, "at least", limit, value >= limit);
}
void at_most(const std::string& what, double value, double limit) {
  print_bar(what, value, "at most", limit, value <= limit);
}

std::size_t heap_bytes() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace snug::bench
