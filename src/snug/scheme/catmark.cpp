#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <snug/scheme/creased.h>

// Catmull-Clark: faces of any size, quads after a step, bicubic B-splines. [CatmullClark78]
namespace snug {
namespace {

// p / q, exactly where q is a power of two.
Interval ratio(std::size_t p, std::size_t q) {
  const auto a = static_cast<double>(p), b = static_cast<double>(q);
  return (q & (q - 1)) == 0 ? Interval(a / b) : Interval(a) / Interval(b);
}

// Weights of a vertex, of each vertex at the far end of one of its edges, and of each diagonally across one
// of its quads, or of each face's centre. They sum to 1.
struct StarMask {
  Interval centre, edge, face;
};

// New position of an interior vertex of valence n among quads.
StarMask vertex_mask(std::size_t n) {
  return {ratio(4 * n - 7, 4 * n), ratio(3, 2 * n * n), ratio(1, 4 * n * n)};
}

// The same by face centres, for faces of any size.
StarMask vertex_centre_mask(std::size_t n) { return {ratio(n - 2, n), ratio(1, n * n), ratio(1, n * n)}; }

// Limit position of an interior vertex among quads. [HalsteadKassDeRose93]
StarMask limit_mask(std::size_t n) { return {ratio(n, n + 5), ratio(4, n * (n + 5)), ratio(1, n * (n + 5))}; }

// Subdominant eigenvalue at an interior vertex.
double subdominant(std::size_t n) {
  const double c = middle(cos_of_turn(1, static_cast<unsigned>(n)));
  const double h = middle(cos_of_turn(1, static_cast<unsigned>(2 * n)));
  return (5 + c + h * std::sqrt(2 * (9 + c))) / 16;
}

bool is_quad(const Topology& topology, HalfEdge h) { return topology.face(topology.face_of(h)).size() == 4; }

bool among_quads(const Topology& topology, const Star& star) {
  return std::all_of(star.faces.begin(), star.faces.end(), [&](HalfEdge h) { return is_quad(topology, h); });
}

// Is each vertex around in one place only? In a small mesh two faces may have a second vertex in common.
bool has_distinct_places(const Topology& topology, const Star& star) {
  std::vector<VertexId> places;
  for (const HalfEdge first : star.faces) {
    for (HalfEdge h = topology.next(first); topology.to(h) != topology.from(first); h = topology.next(h)) {
      places.push_back(topology.from(h));
    }
  }
  std::sort(places.begin(), places.end());
  return std::adjacent_find(places.begin(), places.end()) == places.end();
}

// Of a spoke's weight, against diagonals' c_i + c_{i+1}. derivations/catmark_limits.md
double spoke_weight(double eigenvalue) { return 16 * eigenvalue - 4; }

// The corners of a quad, counter-clockwise, lie at (1, 1) to (1, 2) of sixteen places. What is missing beyond
// a boundary mirrors what is inside: 2 p - q.
Lattice bicubic_lattice(const Topology& topology, std::span<const CornerFan> fans) {
  const std::size_t count = topology.vertex_count();
  Lattice lattice(16);
  const auto at = [&](int x, int y) -> Combination& { return lattice[static_cast<std::size_t>(x + 4 * y)]; };
  constexpr std::array<std::array<int, 2>, 4> corner{{{1, 1}, {2, 1}, {2, 2}, {1, 2}}};
  constexpr std::array<std::array<int, 2>, 4> ahead{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto [x, y] = corner[i];
    const auto [dx, dy] = ahead[i];            // to the next corner
    const auto [ex, ey] = ahead[(i + 1) % 4];  // to the one before
    const auto set = [&](int px, int py, VertexId v) { at(px, py) = unit_combination(v.index(), count); };
    at(x, y) = unit_combination(i, count);
    const auto h = static_cast<HalfEdge>(i);
    const HalfEdge across = topology.twin(h);
    if (across != no_half_edge) {
      set(x - ex, y - ey, topology.to(topology.next(across)));
      const auto [nx, ny] = corner[(i + 1) % 4];
      set(nx - ex, ny - ey, topology.from(topology.prev(across)));
    }
    if (fans[i].closed) {
      const HalfEdge beyond = topology.ccw(topology.ccw(h));
      set(x - dx - ex, y - dy - ey, topology.to(topology.next(beyond)));
    }
  }
  const auto mirror = [&](Combination& ghost, const Combination& p, const Combination& q) {
    if (!ghost.empty() || p.empty() || q.empty()) return;
    ghost.resize(count);
    for (std::size_t c = 0; c < count; ++c) ghost[c] = 2 * p[c] - q[c];
  };
  for (int y = 0; y < 4; ++y) {
    mirror(at(0, y), at(1, y), at(2, y));
    mirror(at(3, y), at(2, y), at(1, y));
  }
  for (int x = 0; x < 4; ++x) {
    mirror(at(x, 0), at(x, 1), at(x, 2));
    mirror(at(x, 3), at(x, 2), at(x, 1));
  }
  return lattice;
}

constexpr std::array catmark_names{"catmull-clark", "cc", "scheme-catmark"};

class CatmarkRules : public CreasedRules {
 public:
  CatmarkRules()
      : CreasedRules({.scheme = Scheme::catmark,
                      .name = "catmark",
                      .other_names = catmark_names,
                      .min_valence = 2,
                      .kernel = RegularKernel::bicubic,
                      .basis = RegularBasis::bicubic}) {}

  void add_smooth_vertex(const Topology& topology, VertexId v, const Star& star, const Interval& share,
                         RowBuilder& row) const override {
    const std::size_t n = star.faces.size();
    if (among_quads(topology, star)) {
      const StarMask mask = vertex_mask(n);
      row.add(v.value(), times(share, mask.centre));
      for (const Spoke& spoke : star.spokes) row.add(spoke.end.value(), times(share, mask.edge));
      for (const HalfEdge h : star.faces) {
        row.add(topology.to(topology.next(h)).value(), times(share, mask.face));
      }
      return;
    }
    const StarMask mask = vertex_centre_mask(n);
    row.add(v.value(), share * mask.centre);
    for (const Spoke& spoke : star.spokes) row.add(spoke.end.value(), share * mask.edge);
    for (const HalfEdge h : star.faces) {
      add_mean(topology.face(topology.face_of(h)), share * mask.face, row);
    }
  }

  // Between quads 3/8 of its ends, 1/16 of the four vertices beyond; else by the centres of its faces, a
  // quarter each, or 0.470 of a triangle's where these are to be smooth.
  void add_smooth_edge(const Topology& topology, SmoothTriangles triangles, HalfEdge h, const Interval& share,
                       RowBuilder& row) const override {
    const HalfEdge twin = topology.twin(h);
    const std::array ends{topology.from(h), topology.to(h)};
    if (is_quad(topology, h) && is_quad(topology, twin)) {
      for (const VertexId end : ends) row.add(end.value(), times(share, 0.375));
      for (const HalfEdge g : {h, twin}) {
        row.add(topology.from(topology.prev(g)).value(), times(share, 0.0625));
        row.add(topology.to(topology.next(g)).value(), times(share, 0.0625));
      }
      return;
    }
    Interval face = 0.25;  // both faces' weight
    if (triangles == SmoothTriangles::smooth) {
      const auto weight = [&](HalfEdge g) {
        return topology.face(topology.face_of(g)).size() == 3 ? Interval(47) / Interval(100) : Interval(0.25);
      };
      face = Interval(0.5) * (weight(h) + weight(twin));
    }
    const Interval each = Interval(0.5) * (Interval(1) - Interval(2) * face);
    for (const VertexId end : ends) row.add(end.value(), share * each);
    for (const HalfEdge g : {h, twin}) add_mean(topology.face(topology.face_of(g)), share * face, row);
  }

  [[nodiscard]] bool has_limit_in_star(const Topology& topology, const Star& star, bool dart) const override {
    return among_quads(topology, star) && (!dart || has_distinct_places(topology, star));
  }
  void add_smooth_limit(const Topology& topology, VertexId v, const Star& star,
                        Stencils& out) const override {
    const StarMask mask = limit_mask(star.faces.size());
    out.add(v.value(), mask.centre);
    for (const Spoke& spoke : star.spokes) out.add(spoke.end.value(), mask.edge);
    for (const HalfEdge h : star.faces) out.add(topology.to(topology.next(h)).value(), mask.face);
  }
  // The diagonal after spoke i lies between spokes i and i + 1.
  void add_smooth_tangents(const Topology& topology, const Star& star, Stencils& out) const override {
    const std::size_t n = star.spokes.size();
    const auto add = [&](unsigned i, const auto& wave) {
      if (n == 2) return;  // the row of the cosine vanishes: no plane
      const Interval c = wave(i);
      out.add(star.spokes[i].end.value(), Interval(spoke_weight(subdominant(n))) * c);
      out.add(topology.to(topology.next(star.faces[i])).value(), c + wave(i + 1));
    };
    add_first_modes(n, add, out);
  }
  [[nodiscard]] AcrossCrease across_crease(std::size_t faces) const override {
    const auto sine = [step = std::numbers::pi / static_cast<double>(faces)](std::size_t i) {
      return std::sin(static_cast<double>(i) * step);
    };
    const double eigenvalue = subdominant(2 * faces), spoke = spoke_weight(eigenvalue);
    AcrossCrease across;
    double sum = 0;
    for (std::size_t i = 0; i < faces; ++i) sum += across.diagonals.emplace_back(sine(i) + sine(i + 1));
    for (std::size_t i = 1; i < faces; ++i) sum += across.inner.emplace_back(spoke * sine(i));
    across.end = (spoke * sine(1) / 16 + sine(1) / 4 - sum / 8) / (eigenvalue - 0.25);
    return across;
  }

  [[nodiscard]] bool regular(const CornerFan& fan) const override { return regular_among_quads(fan); }
  [[nodiscard]] BezierRows bezier(const Topology& ring, std::span<const CornerFan> fans) const override {
    return tensor_bezier(3, lattice(ring, fans));
  }
  [[nodiscard]] Lattice lattice(const Topology& ring, std::span<const CornerFan> fans) const override {
    return bicubic_lattice(ring, fans);
  }
  [[nodiscard]] double shrink_factor(const CornerFan& fan) const override {
    return subdominant(fan.closed ? fan.faces() : 2 * fan.faces());
  }
};

}  // namespace

const SchemeRules& catmark_rules() { return only<CatmarkRules>(); }

}  // namespace snug
