#include <snug/mesh/validate.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <snug/mesh/disjoint_sets.h>
#include <snug/mesh/half_edges.h>
#include <support/names.h>
#include <support/scaling.h>

namespace snug {
namespace {

constexpr auto defect_kind_names =
    std::to_array<Named<DefectKind>>({{"index-out-of-range", DefectKind::index_out_of_range},
                                      {"coordinate-not-finite", DefectKind::coordinate_not_finite},
                                      {"too-few-vertices", DefectKind::too_few_vertices},
                                      {"repeated-vertex", DefectKind::repeated_vertex},
                                      {"duplicate-face", DefectKind::duplicate_face},
                                      {"edge-of-many-faces", DefectKind::edge_of_many_faces},
                                      {"inconsistent-orientation", DefectKind::inconsistent_orientation},
                                      {"pinched-vertex", DefectKind::pinched_vertex},
                                      {"bad-tag", DefectKind::bad_tag},
                                      {"isolated-vertex", DefectKind::isolated_vertex},
                                      {"zero-area-face", DefectKind::zero_area_face}});

std::string number(std::size_t n) { return std::to_string(n); }

/// The texts of the first ten, and how many more there are.
template <class T, class TextOf>
std::string first_ten(std::span<const T> list, const std::string& comma, const char* conjunction,
                      const TextOf& text_of) {
  std::string text;
  for (std::size_t i = 0; i < list.size() && i < 10; ++i) text += (i ? comma : "") + text_of(list[i]);
  if (list.size() > 10) text += conjunction + number(list.size() - 10) + " more";
  return text;
}

class Inspector {
 public:
  explicit Inspector(const ControlMesh& mesh) : mesh_(mesh) {}

  // With the topology where that is manifold: neighbours need no look then.
  std::vector<Defect> run(const Topology* manifold) {
    const bool indices_good = check_faces();
    check_points();
    check_tags();
    if (manifold != nullptr && manifold->uniform_size() == 3) {
      check_twice_covered(*manifold);
    } else if (indices_good) {
      check_duplicates();
    }
    if (indices_good && manifold == nullptr) {
      check_edges_and_fans();
      check_areas();
    }
    std::stable_sort(found_.begin(), found_.end(),
                     [](const Defect& a, const Defect& b) { return a.kind < b.kind; });
    return std::move(found_);
  }

 private:
  void add(DefectKind kind, std::string text) { found_.push_back({kind, std::move(text)}); }

  bool check_faces() {
    bool good = true;
    used_.assign(mesh_.vertex_count(), false);
    regular_.assign(mesh_.face_count(), true);
    std::vector<VertexId> sorted;
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      const auto face = mesh_.face(FaceId(f));
      if (face.size() < 3) {
        add(DefectKind::too_few_vertices,
            "face " + number(f) + " has " + number(face.size()) + " vertices, a face needs 3");
        regular_[f] = false;
      }
      for (const VertexId v : face) {
        if (v.index() < mesh_.vertex_count()) {
          used_[v.index()] = true;
          continue;
        }
        add(DefectKind::index_out_of_range, "face " + number(f) + " uses vertex " + number(v.index()) +
                                                " of " + number(mesh_.vertex_count()));
        good = false;
      }
      if (face.size() == 3 && face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) continue;
      sorted.assign(face.begin(), face.end());
      std::sort(sorted.begin(), sorted.end());
      const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
      if (twice != sorted.end()) {
        add(DefectKind::repeated_vertex,
            "face " + number(f) + " names vertex " + number(twice->index()) + " twice");
        regular_[f] = false;
      }
    }
    return good;
  }

  void check_points() {
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
      if (!is_finite(mesh_.points[v])) {
        add(DefectKind::coordinate_not_finite,
            "vertex " + number(v) + " has a coordinate that is not finite");
      }
      if (!used_[v]) add(DefectKind::isolated_vertex, "vertex " + number(v) + " is used by no face");
    }
  }

  void check_tags() {
    const auto expect = [&](bool good, const char* kind, std::size_t i, const std::string& text) {
      if (!good) add(DefectKind::bad_tag, kind + (" tag " + number(i)) + text);
    };
    const auto good_sharpness = [](double s) { return std::isfinite(s) && s >= 0; };
    const auto there = [&](VertexId v) { return v.index() < mesh_.vertex_count(); };
    const auto& [creases, corners, holes, boundary, crease_method, smooth_triangles, scheme] = mesh_.tags;
    for (std::size_t i = 0; i < creases.size(); ++i) {
      const auto [a, b, sharpness] = creases[i];
      expect(there(a) && there(b) && good_sharpness(sharpness), "crease", i,
             " needs two vertices of the mesh and a sharpness >= 0");
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      expect(there(corners[i].vertex) && good_sharpness(corners[i].sharpness), "corner", i,
             " needs a vertex of the mesh and a sharpness >= 0");
    }
    for (std::size_t i = 0; i < holes.size(); ++i) {
      expect(holes[i].index() < mesh_.face_count(), "hole", i,
             " names face " + number(holes[i].index()) + " of " + number(mesh_.face_count()));
    }
  }

  void add_duplicate(std::size_t later, std::size_t first) {
    add(DefectKind::duplicate_face,
        "face " + number(later) + " has the same vertices as face " + number(first));
  }

  // Triangles with the same vertices share their edges, which have no others.
  void check_twice_covered(const Topology& topology) {
    for (HalfEdge h = 0; h < topology.half_edge_count(); h += 3) {
      const HalfEdge a = topology.twin(h), b = topology.twin(h + 1), c = topology.twin(h + 2);
      if (a == no_half_edge || b == no_half_edge || c == no_half_edge) continue;
      if (a / 3 == b / 3 && b / 3 == c / 3 && a < h) add_duplicate(h / 3, a / 3);
    }
  }

  void check_duplicates() {
    // Faces by their lowest vertex, then by a hash of all, in whatever order: candidates follow each other.
    struct Entry {
      std::uint64_t hash;
      std::uint32_t face, lowest;
    };
    std::vector<Entry> entries;
    entries.reserve(mesh_.face_count());
    std::vector<std::uint32_t> ends(mesh_.vertex_count() + 1, 0);
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      if (!regular_[f]) continue;
      std::uint64_t hash = 0;
      std::uint32_t lowest = UINT32_MAX;
      for (const VertexId v : mesh_.face(FaceId(f))) {
        std::uint64_t mixed = (v.value() + 1) * 0x9e3779b97f4a7c15u;
        mixed ^= mixed >> 29;
        hash += mixed * 0xbf58476d1ce4e5b9u;
        lowest = std::min(lowest, v.value());
      }
      entries.push_back({hash, static_cast<std::uint32_t>(f), lowest});
      ++ends[lowest + 1];
    }
    std::partial_sum(ends.begin(), ends.end(), ends.begin());
    std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash(entries.size());
    for (const Entry& entry : entries) by_hash[ends[entry.lowest]++] = {entry.hash, entry.face};
    for (std::size_t v = 0, begin = 0; v < mesh_.vertex_count(); begin = ends[v++]) {
      std::sort(by_hash.begin() + static_cast<std::ptrdiff_t>(begin), by_hash.begin() + ends[v]);
    }
    const auto sorted_face = [&](std::uint32_t f) {
      const auto face = mesh_.face(FaceId(f));
      std::vector<VertexId> sorted(face.begin(), face.end());
      std::sort(sorted.begin(), sorted.end());
      return sorted;
    };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // later face, first face like it
    for (std::size_t begin = 0, end = 0; begin < by_hash.size(); begin = end) {
      while (end < by_hash.size() && by_hash[end].first == by_hash[begin].first) ++end;
      for (std::size_t i = begin + 1; i < end; ++i) {
        for (std::size_t k = begin; k < i; ++k) {
          if (sorted_face(by_hash[i].second) != sorted_face(by_hash[k].second)) continue;
          pairs.emplace_back(by_hash[i].second, by_hash[k].second);
          break;
        }
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [later, first] : pairs) add_duplicate(later, first);
  }

  // The corners of faces around a vertex, linked where two faces share an edge at it, are one chain or cycle.
  void check_edges_and_fans() {
    const HalfEdgeGroups groups(mesh_.face_offsets, mesh_.face_vertices, mesh_.vertex_count());
    std::vector<std::size_t> fans(mesh_.vertex_count(), 0);
    for (const VertexId v : mesh_.face_vertices) ++fans[v.index()];
    DisjointSets linked(mesh_.face_vertices.size());
    for (std::size_t e = 0; e < groups.edge_count(); ++e) {
      const auto members = groups.of_edge(EdgeId(e));
      check_edge(groups, members);
      HalfEdge at_start = no_half_edge, at_end = no_half_edge;
      for (const HalfEdge h : members) {
        for (const HalfEdge corner : {h, next(groups, h)}) {
          const VertexId v = mesh_.face_vertices[corner];
          HalfEdge& first = v == mesh_.face_vertices[members[0]] ? at_start : at_end;
          if (first == no_half_edge) first = corner;
          fans[v.index()] -= linked.join(first, corner);
        }
      }
    }
    for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
      if (fans[v] < 2) continue;
      add(DefectKind::pinched_vertex,
          "the faces around vertex " + number(v) + " form " + number(fans[v]) + " fans");
    }
  }

  [[nodiscard]] HalfEdge next(const HalfEdgeGroups& groups, HalfEdge h) const {
    return next_in_face(mesh_.face_offsets, groups.face(h), h);
  }

  void check_edge(const HalfEdgeGroups& groups, std::span<const HalfEdge> members) {
    const VertexId a = mesh_.face_vertices[members[0]], b = mesh_.face_vertices[next(groups, members[0])];
    const bool many = members.size() > 2;
    const bool same_direction = members.size() == 2 && groups.face(members[0]) != groups.face(members[1]) &&
                                a == mesh_.face_vertices[members[1]];
    if (!many && !same_direction) return;
    const std::string edge =
        "edge (" + number(std::min(a, b).index()) + ", " + number(std::max(a, b).index()) + ")";
    const std::string faces =
        first_ten(members, ", ", " and ", [&](HalfEdge h) { return number(groups.face(h).index()); });
    if (many) {
      add(DefectKind::edge_of_many_faces, edge + " has " + number(members.size()) + " faces: " + faces);
    } else {
      add(DefectKind::inconsistent_orientation, edge + " has the same direction in faces " + faces);
    }
  }

  void check_areas() {
    const Box3 box = used_box(mesh_);
    const double largest =
        box.empty() ? 0.0 : std::max(max_abs(box.lower - Point3{}), max_abs(box.upper - Point3{}));
    if (!std::isfinite(largest)) return;
    const PowerOfTwo scale = PowerOfTwo::normalising(largest);
    for (std::size_t f = 0; f < mesh_.face_count(); ++f) {
      const auto face = mesh_.face(FaceId(f));
      if (!regular_[f]) continue;
      Vector3 area;
      bool finite = true;
      const Point3 origin = mesh_.points[face[0].index()];
      for (std::size_t k = 1; k + 1 < face.size(); ++k) {
        const Vector3 a = scale.apply(mesh_.points[face[k].index()]) - scale.apply(origin);
        const Vector3 b = scale.apply(mesh_.points[face[k + 1].index()]) - scale.apply(origin);
        finite = finite && is_finite(a) && is_finite(b);
        // Edges are brought to about 1 each, so that a tiny face is not taken for a flat one.
        const double size = std::max(max_abs(a), max_abs(b));
        if (size > 0) area = area + cross((1 / size) * a, (1 / size) * b);
      }
      if (finite && area == Vector3{}) add(DefectKind::zero_area_face, "face " + number(f) + " has no area");
    }
  }

  const ControlMesh& mesh_;
  std::vector<bool> used_, regular_;
  std::vector<Defect> found_;
};

}  // namespace

const char* name_of(DefectKind kind) { return name_in(defect_kind_names, kind); }

std::vector<Defect> defects(const ControlMesh& mesh) { return Inspector(mesh).run(nullptr); }

std::vector<Defect> defects_of_elements(const ControlMesh& mesh, const Topology& manifold) {
  return Inspector(mesh).run(&manifold);
}

std::string summary(const std::vector<Defect>& list) {
  return first_ten(std::span(list), "; ", "; and ", [](const Defect& defect) { return defect.text; });
}

}  // namespace snug
