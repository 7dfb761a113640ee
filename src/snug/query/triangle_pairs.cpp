#include <snug/query/triangle_pairs.h>

#include <algorithm>
#include <cmath>

#include <snug/scheme/creases.h>

namespace snug {
namespace {

// Largest angle of a corner of a pair on the diagonal, in the control mesh.
constexpr double most_corner_angle = 2.75;
// How many triangles a path of exchanged pairs may look at.
constexpr std::size_t most_path = 400;

class Pairing {
 public:
  explicit Pairing(const LimitSurface& surface)
      : surface_(surface),
        topology_(surface.topology()),
        sharpness_(sharpness_of(surface.mesh(), surface.topology())),
        mates_(surface.face_count(), no_half_edge),
        seen_(surface.face_count()) {}

  std::vector<PairedTriangles> run() {
    for (std::size_t f = 0; f < mates_.size(); ++f) grow_from(FaceId(f));
    for (std::size_t f = 0; f < mates_.size(); ++f) {
      if (is_free(FaceId(f))) exchange_from(FaceId(f));
    }
    std::vector<PairedTriangles> pairs;
    for (std::size_t f = 0; f < mates_.size(); ++f) {
      if (!surface_.has_patch(PatchId(f))) continue;
      const HalfEdge h = mates_[f];
      if (h == no_half_edge) {
        pairs.push_back({PatchId(f), turn_of_single(FaceId(f))});
        continue;
      }
      // The diagonal runs from corner 2 of the lower half to its corner 0, and from 0 to 1 of the upper one.
      const HalfEdge twin = topology_.twin(h);
      const FaceId other = topology_.face_of(twin);
      if (f < other.index())
        pairs.push_back({PatchId(f), static_cast<std::uint8_t>((h % 3 + 1) % 3), PatchId(other.index()),
                         static_cast<std::uint8_t>(twin % 3)});
    }
    return pairs;
  }

 private:
  [[nodiscard]] bool is_free(FaceId f) const {
    return mates_[f.index()] == no_half_edge && surface_.has_patch(PatchId(f.index()));
  }

  // Its diagonal is the side that is least semi-sharp: knots crowd at such sides, and cannot at the diagonal.
  [[nodiscard]] std::uint8_t turn_of_single(FaceId f) const {
    const auto semi_sharp = [&](unsigned k) {
      const double s = edge_sharpness(topology_, sharpness_, topology_.edge_of(topology_.first_of(f) + k));
      return is_semi_sharp(s) ? s : 0.0;
    };
    unsigned diagonal = 2;
    for (const unsigned k : {0u, 1u}) {
      if (semi_sharp(k) < semi_sharp(diagonal)) diagonal = k;
    }
    return static_cast<std::uint8_t>((diagonal + 1) % 3);
  }

  // Are a corner of the triangle before a half-edge's start, and that of its twin's, together less than half a turn?
  [[nodiscard]] bool narrow(HalfEdge h) const {
    const std::size_t f = topology_.face_of(h).index();
    const Kind& kind = surface_.kind(PatchId(f));
    const CornerFan& fan = kind.corner((h % 3 + 3 - surface_.first(PatchId(f))) % 3);
    if (!fan.sharp && fan.faces() < (fan.closed ? 5u : 3u)) return false;
    const auto angle = [&](HalfEdge g) {  // at its start
      const Point3 p = surface_.scaled_point(topology_.from(g));
      const Vector3 a = surface_.scaled_point(topology_.to(g)) - p,
                    b = surface_.scaled_point(topology_.from(topology_.prev(g))) - p;
      return std::atan2(length(cross(a, b)), dot(a, b));
    };
    return angle(h) + angle(topology_.next(topology_.twin(h))) < most_corner_angle;
  }
  [[nodiscard]] VertexId apex(HalfEdge h) const { return topology_.from(topology_.prev(h)); }

  // May the triangles at an edge become a pair?
  [[nodiscard]] bool fits(HalfEdge h) const {
    const HalfEdge twin = topology_.twin(h);
    if (twin == no_half_edge || surface_.rules().local) return false;
    const FaceId a = topology_.face_of(h), b = topology_.face_of(twin);
    return a != b && surface_.has_patch(PatchId(a.index())) && surface_.has_patch(PatchId(b.index())) &&
           apex(h) != apex(twin) && edge_sharpness(topology_, sharpness_, topology_.edge_of(h)) == 0 &&
           narrow(h) && narrow(twin);
  }

  bool pair_up(HalfEdge h) {
    if (h == no_half_edge || !fits(h)) return false;
    const HalfEdge twin = topology_.twin(h);
    if (!is_free(topology_.face_of(h)) || !is_free(topology_.face_of(twin))) return false;
    mates_[topology_.face_of(h).index()] = h;
    mates_[topology_.face_of(twin).index()] = twin;
    return true;
  }

  // From a pair across each of its sides to the one whose diagonal is parallel, if triangles are regular: it begins at the end of
  // the side that is not on this pair's diagonal.
  void grow_from(FaceId seed) {
    if (!is_free(seed)) return;
    const HalfEdge first = topology_.first_of(seed);
    std::vector<HalfEdge> diagonals;
    for (HalfEdge h = first; h < first + 3 && diagonals.empty(); ++h) {
      if (pair_up(h)) diagonals.push_back(h);
    }
    for (std::size_t k = 0; k < diagonals.size(); ++k) {
      for (const HalfEdge d : {diagonals[k], topology_.twin(diagonals[k])}) {
        // The sides of a half: to its apex, and from there.
        const HalfEdge to = topology_.twin(topology_.next(d)), from = topology_.twin(topology_.prev(d));
        // The twin of the first one leaves the apex, that of the second one ends there.
        if (to != no_half_edge && pair_up(topology_.prev(to))) diagonals.push_back(topology_.prev(to));
        if (from != no_half_edge && pair_up(topology_.next(from))) diagonals.push_back(topology_.next(from));
      }
    }
  }

  // A path from a free triangle to another one on which every second edge is a diagonal: these and the others are exchanged.
  void exchange_from(FaceId start) {
    std::vector<FaceId> outer{start};
    std::vector<HalfEdge> came;  // by which half-edge of an earlier one the mate of outer[k + 1] was reached
    std::vector<std::size_t> parent;  // of outer[k + 1]
    std::vector<FaceId> touched{start};
    seen_[start.index()] = true;
    bool found = false;
    for (std::size_t k = 0; k < outer.size() && outer.size() < most_path && !found; ++k) {
      const HalfEdge first = topology_.first_of(outer[k]);
      for (HalfEdge h = first; h < first + 3; ++h) {
        if (!fits(h)) continue;
        const FaceId next = topology_.face_of(topology_.twin(h));
        if (seen_[next.index()]) continue;
        if (is_free(next)) {
          turn_path(h, k, came, parent);
          found = true;
          break;
        }
        const FaceId mate = topology_.face_of(topology_.twin(mates_[next.index()]));
        if (seen_[mate.index()]) continue;
        seen_[next.index()] = seen_[mate.index()] = true;
        touched.push_back(next);
        touched.push_back(mate);
        outer.push_back(mate);
        came.push_back(h);
        parent.push_back(k);
      }
    }
    for (const FaceId f : touched) seen_[f.index()] = false;
  }
  void turn_path(HalfEdge h, std::size_t k, const std::vector<HalfEdge>& came,
                 const std::vector<std::size_t>& parent) {
    for (;;) {
      const HalfEdge twin = topology_.twin(h);
      mates_[topology_.face_of(h).index()] = h;
      mates_[topology_.face_of(twin).index()] = twin;
      if (k == 0) return;
      h = came[k - 1];
      k = parent[k - 1];
    }
  }

  const LimitSurface& surface_;
  const Topology& topology_;
  Sharpness sharpness_;
  std::vector<HalfEdge> mates_;  // of each face its half-edge on the diagonal
  std::vector<bool> seen_;
};

}  // namespace

std::vector<PairedTriangles> paired(const LimitSurface& surface) { return Pairing(surface).run(); }

}  // namespace snug
