#include <snug/mesh/weld.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include <snug/mesh/disjoint_sets.h>
#include <support/error.h>

namespace snug {
namespace {

using Key = std::array<std::int64_t, 3>;

std::size_t hash_of(const Point3& point) {
  std::uint64_t mixed = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    mixed ^= std::bit_cast<std::uint64_t>(point[axis] + 0.0);  // -0 and 0 are one place
    mixed *= 0x9e3779b97f4a7c15u;
    mixed ^= mixed >> 32;
  }
  return mixed;
}

std::vector<std::uint32_t> first_of_equal(std::span<const Point3> points) {
  constexpr std::uint32_t no_point = UINT32_MAX;
  std::vector<std::uint32_t> slots(std::bit_ceil(2 * points.size() + 1), no_point);
  std::vector<std::uint32_t> first(points.size());
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    std::size_t slot = hash_of(points[p]) & (slots.size() - 1);
    while (slots[slot] != no_point && points[slots[slot]] != points[p])
      slot = (slot + 1) & (slots.size() - 1);
    if (slots[slot] == no_point) slots[slot] = p;
    first[p] = slots[slot];
  }
  return first;
}

double distance_between(const Point3& a, const Point3& b) {
  const Vector3 between = a - b;
  return std::hypot(between.x, between.y, between.z);
}

/// Points in cells whose diagonal is shorter than the distance, so that those of one cell weld unseen.
class Grid {
 public:
  /// `first` of each point is the first one equal to it.
  Grid(std::span<const Point3> points, std::span<const std::uint32_t> first, double distance)
      : points_(points), distance_(distance), sets_(points.size()) {
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      if (sets_.join(i, first[i])) continue;
      placed_.emplace_back(key_of(points[i]), i);
    }
    std::sort(placed_.begin(), placed_.end());
    for (std::size_t k = 0; k < placed_.size(); ++k) {
      if (cells_.empty() || cells_.back().key != placed_[k].first) cells_.push_back({placed_[k].first, k, k});
      cells_.back().end = k + 1;
      sets_.join(placed_[cells_.back().begin].second, placed_[k].second);
    }
  }

  DisjointSets weld() {
    // Half of the offsets (i, j): each pair of cells is met once. Cells that weld are at most two apart,
    // since the distance is 1.96 cells.
    for (std::int64_t i = 0; i <= 2; ++i) {
      for (std::int64_t j = i == 0 ? 0 : -2; j <= 2; ++j) weld_across(i, j);
    }
    return std::move(sets_);
  }

 private:
  struct Cell {
    Key key;
    std::size_t begin, end;  // in placed_
  };

  [[nodiscard]] Key key_of(const Point3& point) const {
    Key key{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      key[axis] = static_cast<std::int64_t>(std::floor(point[axis] / (0.51 * distance_)));
    }
    return key;
  }

  /// Cells are sorted, so the cells at a fixed offset from one another are found by walking along once.
  void weld_across(std::int64_t i, std::int64_t j) {
    const bool own_row = i == 0 && j == 0;
    std::size_t first = 0;
    for (const Cell& cell : cells_) {
      const Key low{cell.key[0] + i, cell.key[1] + j, cell.key[2] + (own_row ? 1 : -2)};
      const Key high{cell.key[0] + i, cell.key[1] + j, cell.key[2] + 2};
      while (first < cells_.size() && cells_[first].key < low) ++first;
      for (std::size_t other = first; other < cells_.size() && cells_[other].key <= high; ++other) {
        weld_cells(cell, cells_[other]);
      }
    }
  }

  void weld_cells(const Cell& a, const Cell& b) {
    if (sets_.least(placed_[a.begin].second) == sets_.least(placed_[b.begin].second)) return;
    for (std::size_t p = a.begin; p < a.end; ++p) {
      for (std::size_t q = b.begin; q < b.end; ++q) {
        const std::uint32_t i = placed_[p].second, k = placed_[q].second;
        if (distance_between(points_[i], points_[k]) > distance_) continue;
        sets_.join(i, k);
        return;
      }
    }
  }

  std::span<const Point3> points_;
  double distance_;
  DisjointSets sets_;
  std::vector<std::pair<Key, std::uint32_t>> placed_;  // one point a place, in rising order
  std::vector<Cell> cells_;
};

/// Gives a mesh the vertices that stay after welding.
class Welder {
 public:
  Welder(ControlMesh& mesh, std::span<const std::uint32_t> first) : mesh_(mesh), becomes_(first.size()) {
    std::size_t kept = 0;
    for (std::size_t v = 0; v < first.size(); ++v) {
      if (first[v] == v) {
        becomes_[v] = VertexId(kept++);
        continue;
      }
      becomes_[v] = becomes_[first[v]];
      ++result_.vertices;
      result_.farthest = std::max(result_.farthest, distance_between(mesh.points[v], mesh.points[first[v]]));
    }
  }

  WeldReport weld() {
    move_points();
    move_faces();
    for (VertexId& v : mesh_.polyline_vertices) v = moved(v);
    move_tags();
    return result_;
  }

 private:
  // Ids that name nothing stay as they are.
  [[nodiscard]] VertexId moved(VertexId v) const {
    return v.index() < becomes_.size() ? becomes_[v.index()] : v;
  }

  void move_points() {
    std::size_t kept = 0;
    for (std::size_t v = 0; v < becomes_.size(); ++v) {
      if (becomes_[v].index() == kept) mesh_.points[kept++] = mesh_.points[v];
    }
    mesh_.points.resize(kept);
  }

  // The corners of a face after welding, equal neighbours as one; none if fewer than three are left.
  std::vector<VertexId> moved_face(std::span<const VertexId> face) const {
    std::vector<VertexId> corners;
    for (const VertexId v : face) {
      if (corners.empty() || corners.back() != moved(v)) corners.push_back(moved(v));
    }
    while (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
    const bool two_alternate =
        corners.size() < 3 || std::all_of(corners.begin() + 2, corners.end(),
                                          [&](VertexId v) { return v == corners[0] || v == corners[1]; });
    if (face.size() >= 3 && two_alternate) corners.clear();
    return corners;
  }

  void move_faces() {
    ControlMesh moved;
    moved.face_vertices.reserve(mesh_.face_vertices.size());
    new_face_.assign(mesh_.face_count(), FaceId());
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      const auto face = mesh_.face(FaceId(f));
      const std::vector<VertexId> corners = moved_face(face);
      if (corners.empty() && !face.empty()) {
        ++result_.dropped;
        continue;
      }
      result_.shortened += corners.size() != face.size();
      new_face_[f] = FaceId(moved.face_count());
      moved.add_face(corners);
    }
    mesh_.face_offsets = std::move(moved.face_offsets);
    mesh_.face_vertices = std::move(moved.face_vertices);
  }

  // Of the tags of one element the last counts; of elements that become one the sharpest, where the first
  // stood.
  template <class Tag, class KeyOf, class Move>
  static void move_each(std::vector<Tag>& tags, const KeyOf& key_of, const Move& move) {
    std::map<decltype(key_of(tags[0])), Tag> last, merged;
    for (const Tag& tag : tags) last.insert_or_assign(key_of(tag), tag);
    for (auto [key, tag] : last) {
      move(tag);
      const auto [it, added] = merged.emplace(key_of(tag), tag);
      if (!added) it->second.sharpness = std::max(it->second.sharpness, tag.sharpness);
    }
    std::vector<Tag> kept;
    for (Tag& tag : tags) {
      move(tag);
      if (const auto found = merged.extract(key_of(tag))) kept.push_back(found.mapped());
    }
    tags = std::move(kept);
  }

  void move_tags() {
    MeshTags& tags = mesh_.tags;
    move_each(
        tags.creases,
        [](const CreaseTag& tag) {
          return std::pair(std::minmax({tag.a, tag.b}));
        },
        [&](CreaseTag& tag) {
          std::tie(tag.a, tag.b) = std::minmax({moved(tag.a), moved(tag.b)});
        });
    std::erase_if(tags.creases, [](const CreaseTag& tag) { return tag.a == tag.b; });
    move_each(
        tags.corners, [](const CornerTag& tag) { return tag.vertex; },
        [&](CornerTag& tag) { tag.vertex = moved(tag.vertex); });
    const auto is_there = [&](FaceId f) { return f.index() < new_face_.size(); };
    std::erase_if(tags.holes, [&](FaceId f) { return is_there(f) && !new_face_[f.index()].valid(); });
    for (FaceId& f : tags.holes) f = is_there(f) ? new_face_[f.index()] : f;
  }

  ControlMesh& mesh_;
  std::vector<VertexId> becomes_;
  std::vector<FaceId> new_face_;
  WeldReport result_;
};

}  // namespace

std::vector<std::uint32_t> first_of_welded(std::span<const Point3> points, double distance) {
  require_length(distance, "the welding distance");
  if (points.size() >= UINT32_MAX) {
    throw InputError(InputProblem::refused, "at most 2^32 - 1 points can be welded: split the mesh");
  }
  double largest = 0;
  for (const Point3& point : points) {
    if (!is_finite(point))
      throw InputError(InputProblem::refused, "a coordinate is not finite: it cannot be welded");
    largest = std::max(largest, max_abs(point - Point3{}));
  }
  std::vector<std::uint32_t> first = first_of_equal(points);
  if (distance == 0) return first;
  // So that cells have whole numbers that are exact, and neighbours of them.
  if (!(distance >= std::ldexp(largest, -40)) || 0.51 * distance < std::ldexp(1.0, -1000)) {
    throw InputError(InputProblem::refused,
                     "the welding distance is too small for these coordinates: give a larger one");
  }
  DisjointSets welded = Grid(points, first, distance).weld();
  for (std::uint32_t p = 0; p < first.size(); ++p) first[p] = welded.least(p);
  return first;
}

WeldReport weld(ControlMesh& mesh, double distance) {
  return Welder(mesh, first_of_welded(mesh.points, distance)).weld();
}

ControlMesh mesh_of_triangles(std::span<const Point3> corners) {
  const std::vector<std::uint32_t> first = first_of_welded(corners);
  ControlMesh mesh;
  std::vector<std::uint32_t> number(corners.size());
  mesh.face_vertices.reserve(corners.size());
  mesh.face_offsets.reserve(corners.size() / 3 + 1);
  for (std::uint32_t corner = 0; corner < corners.size(); ++corner) {
    if (first[corner] == corner) {
      number[corner] = static_cast<std::uint32_t>(mesh.points.size());
      mesh.points.push_back(corners[corner]);
    }
    mesh.face_vertices.emplace_back(number[first[corner]]);
    if (corner % 3 == 2) mesh.face_offsets.push_back(corner + 1);
  }
  return mesh;
}

}  // namespace snug
