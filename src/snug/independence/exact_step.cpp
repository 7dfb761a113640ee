#include <snug/independence/exact_step.h>

#include <array>
#include <map>
#include <numeric>

#include <snug/scheme/rules.h>

namespace snug {
std::uint32_t order_of_masks(const RuledMesh& mesh, std::uint32_t order, std::uint32_t most) {
  const Topology& topology = mesh.topology;
  const Scheme scheme = mesh.options.scheme;
  std::uint64_t all = order;
  const auto include = [&](std::size_t n) {
    if (n <= 4 || n == 6 || all == 0) return;  // cosines are rational
    all = std::lcm(all, std::uint64_t{n});
    if (all > most) all = 0;
  };
  for (std::size_t v = 0; v < topology.vertex_count(); ++v) {
    const bool counts =
        scheme == Scheme::doo_sabin || (scheme == Scheme::loop && topology.is_manifold(VertexId(v)));
    if (counts && !topology.isolated(VertexId(v)) && !topology.on_boundary(VertexId(v))) {
      include(topology.face_valence(VertexId(v)));
    }
  }
  for (std::size_t f = 0; scheme == Scheme::doo_sabin && f < topology.face_count(); ++f) {
    include(topology.face(FaceId(f)).size());
  }
  return static_cast<std::uint32_t>(all);
}

// Weights by vertex, in the making.
class ExactStep::Sum {
 public:
  void add(VertexId v, const mpq_class& weight) { rational_[v.value()] += weight; }
  void add(VertexId v, const Weight& weight, const mpq_class& share) {
    add(v, weight.rational * share);
    for (const auto& [index, factor] : weight.cosines) cosines_[{v.value(), index}] += factor * share;
  }
  [[nodiscard]] WeightRow take() const {
    std::map<std::uint32_t, Weight> row;
    for (const auto& [v, weight] : rational_) {
      if (weight != 0) row[v].rational = weight;
    }
    for (const auto& [key, factor] : cosines_) {
      if (factor != 0) row[key.first].cosines.emplace_back(key.second, factor);
    }
    return {row.begin(), row.end()};
  }

 private:
  std::map<std::uint32_t, mpq_class> rational_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, mpq_class> cosines_;
};

WeightRow ExactStep::row(VertexId v) const {
  const Topology& topology = mesh_.topology;
  const std::size_t i = v.index(), vertices = topology.vertex_count(), edges = topology.edge_count();
  Sum sum;
  if (!rules_of(mesh_.options.scheme).primal) {
    add_dual(static_cast<HalfEdge>(i), sum);
  } else if (i < vertices) {
    add_vertex(v, sum);
  } else if (i < vertices + edges) {
    add_edge(EdgeId(i - vertices), sum);
  } else {
    add_mean(FaceId(i - vertices - edges), 1, sum);
  }
  return sum.take();
}

void ExactStep::add_vertex(VertexId v, Sum& sum) const {
  Star star;
  gather_star(mesh_, v, star);
  const VertexRule now = vertex_rule(star);
  std::vector<Spoke> next = star.spokes;
  mpq_class ended = 0;  // sharpnesses that end, and their number
  long ending = 0;
  const auto left = [&](double sharpness, double then) {
    if (sharpness > 0 && then == 0) ended += mpq_class(sharpness), ++ending;
    return then;
  };
  for (Spoke& spoke : next) {
    spoke.sharpness = left(spoke.sharpness, decayed(star, spoke, mesh_.options.creases));
  }
  const VertexRule then = vertex_rule(left(star.sharpness, decayed(star.sharpness)), next);
  mpq_class share = 1;
  if (then != now && ending > 0 && ended < ending) share = ended / ending;
  add_by_rule(v, star, star.spokes, now, share, sum);
  if (share != 1) add_by_rule(v, star, next, then, 1 - share, sum);
}

void ExactStep::add_by_rule(VertexId v, const Star& star, std::span<const Spoke> spokes, VertexRule rule,
                            const mpq_class& share, Sum& sum) const {
  if (rule == VertexRule::smooth) return add_smooth_vertex(v, star, share, sum);
  if (rule == VertexRule::corner) return sum.add(v, share);
  sum.add(v, share * fraction(3, 4));
  for (const Spoke& spoke : spokes) {
    if (spoke.sharpness > 0) sum.add(spoke.end, share * fraction(1, 8));
  }
}

// Loop: (1 - a) v + a (mean of the ring), a = 5/8 - (3 + c)^2/64 with c = 2 cos(2 pi/n), and c^2 = 2 + 2 cos(4 pi/n).
// Catmull-Clark: (n - 2)/n v + 1/n (mean of the ring) + 1/n (mean of the faces' centres).
void ExactStep::add_smooth_vertex(VertexId v, const Star& star, const mpq_class& share, Sum& sum) const {
  if (mesh_.options.scheme == Scheme::loop) {
    const std::size_t n = star.spokes.size();
    const auto around = static_cast<std::uint32_t>(n);
    sum.add(v, share);
    const auto add = [&](VertexId at, const mpq_class& part) {  // `part` of a
      sum.add(at, part * fraction(29, 64));
      sum.add(at, twice_cosine(1, around, order_), part * -fraction(6, 64));
      sum.add(at, twice_cosine(2, around, order_), part * -fraction(1, 64));
    };
    add(v, -share);
    for (const Spoke& spoke : star.spokes) add(spoke.end, share * fraction(1, n));
    return;
  }
  const std::size_t n = star.faces.size();
  sum.add(v, share * fraction(n - 2, n));
  for (const Spoke& spoke : star.spokes) sum.add(spoke.end, share * fraction(1, n * n));
  for (const HalfEdge h : star.faces) add_mean(mesh_.topology.face_of(h), share * fraction(1, n * n), sum);
}

void ExactStep::add_edge(EdgeId e, Sum& sum) const {
  const Topology& topology = mesh_.topology;
  const HalfEdge h = topology.half_of(e);
  const double s = edge_sharpness(topology, mesh_.sharpness, e);
  const bool crease = s >= 1 || (s > 0 && stays_sharp(e));
  const mpq_class share = crease ? mpq_class(1) : mpq_class(s);
  for (const VertexId end : {topology.from(h), topology.to(h)}) sum.add(end, share / 2);
  if (!crease) add_smooth_edge(h, 1 - share, sum);
}

void ExactStep::add_smooth_edge(HalfEdge h, const mpq_class& share, Sum& sum) const {
  const Topology& topology = mesh_.topology;
  const std::array halves{h, topology.twin(h)};
  mpq_class end = fraction(3, 8);
  if (mesh_.options.scheme == Scheme::loop) {
    for (const HalfEdge g : halves) sum.add(topology.from(topology.prev(g)), share * fraction(1, 8));
  } else {
    mpq_class face = 0;  // the weight of either centre
    for (const HalfEdge g : halves) {
      const bool smooth = mesh_.options.triangles == SmoothTriangles::smooth &&
                          topology.face(topology.face_of(g)).size() == 3;
      face += (smooth ? fraction(47, 100) : fraction(1, 4)) / 2;
    }
    for (const HalfEdge g : halves) add_mean(topology.face_of(g), share * face, sum);
    end = (1 - 2 * face) / 2;
  }
  for (const VertexId v : {topology.from(h), topology.to(h)}) sum.add(v, share * end);
}

bool ExactStep::stays_sharp(EdgeId e) const {
  if (mesh_.options.creases == CreaseMethod::uniform) return false;
  const HalfEdge h = mesh_.topology.half_of(e);
  Star star;
  for (const VertexId v : {mesh_.topology.from(h), mesh_.topology.to(h)}) {
    gather_star(mesh_, v, star);
    for (const Spoke& spoke : star.spokes) {
      if (spoke.edge == e && decayed(star, spoke, mesh_.options.creases) == 0) return false;
    }
  }
  return true;
}

// Doo-Sabin: (3 + 2 cos(2 pi i/n))/(4 n) of the i-th corner on, and 1/4 more of its own. Midedge: 1/4, 1/2, 1/4.
void ExactStep::add_dual(HalfEdge h, Sum& sum) const {
  const Topology& topology = mesh_.topology;
  const std::size_t n = topology.face(topology.face_of(h)).size();
  if (mesh_.options.scheme == Scheme::midedge) {
    sum.add(topology.from(h), fraction(1, 2));
    sum.add(topology.to(h), fraction(1, 4));
    sum.add(topology.from(topology.prev(h)), fraction(1, 4));
    return;
  }
  sum.add(topology.from(h), fraction(1, 4));
  for (std::size_t i = 0; i < n; ++i, h = topology.next(h)) {
    sum.add(topology.from(h), fraction(3, 4 * n));
    sum.add(topology.from(h),
            twice_cosine(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(n), order_),
            fraction(1, 4 * n));
  }
}

void ExactStep::add_mean(FaceId f, const mpq_class& share, Sum& sum) const {
  const auto face = mesh_.topology.face(f);
  for (const VertexId v : face) sum.add(v, share * fraction(1, face.size()));
}

}  // namespace snug
