#include <oracle/dual_twin.h>
#include <oracle/polygon_net.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

namespace oracle {

namespace detail {

namespace {

/// cos(2 pi i / n), to one roundoff.
Quad cosine(std::size_t i, std::size_t n) {
  mpfr_t x;
  mpfr_init2(x, 256);
  mpfr_const_pi(x, MPFR_RNDN);
  mpfr_mul_ui(x, x, 2 * i, MPFR_RNDN);
  mpfr_div_ui(x, x, n, MPFR_RNDN);
  mpfr_cos(x, x, MPFR_RNDN);
  double part[3];  // together 159 bits
  for (double& p : part) {
    p = mpfr_get_d(x, MPFR_RNDN);
    mpfr_sub_d(x, x, p, MPFR_RNDN);
  }
  mpfr_clear(x);
  return static_cast<Quad>(part[0]) + (static_cast<Quad>(part[1]) + static_cast<Quad>(part[2]));
}

}  // namespace

std::vector<Quad> dual_mask(DualScheme scheme, std::size_t n) {
  std::vector<Quad> weights(n, 0);
  const Quad size = static_cast<Quad>(n);
  if (scheme == DualScheme::midedge) {
    weights[0] += Quad(0.5);
    weights[1 % n] += Quad(0.25);
    weights[n - 1] += Quad(0.25);
  } else {
    for (std::size_t i = 1; i < n; ++i) weights[i] = (3 + 2 * cosine(i, n)) / (4 * size);
    weights[0] = Quad(0.25) + 5 / (4 * size);
  }
  return weights;
}

}  // namespace detail

namespace {

using detail::dual_mask;
using detail::QuadPoint;
using Id = std::uint32_t;

void require(bool condition, const char* what) {
  if (!condition) throw std::invalid_argument(std::string("oracle: ") + what);
}

struct Net {
  std::vector<QuadPoint> points;
  std::vector<Id> owners;  // control vertices
  std::vector<std::vector<Id>> faces;
};

/// Corner `k` of face `f`, which becomes a vertex.
struct Corner {
  Id face, k;
};

class Step {
 public:
  Step(const Net& net, DualScheme scheme) : net_(net), at_vertex_(net.points.size()) {
    std::map<std::size_t, std::vector<Quad>> masks;
    for (Id f = 0; f < net.faces.size(); ++f) {
      const auto& face = net.faces[f];
      const Id n = static_cast<Id>(face.size());
      first_.push_back(static_cast<Id>(fine_.points.size()));
      auto& weights = masks[n];
      if (weights.empty()) weights = dual_mask(scheme, n);
      std::vector<Id> child;
      for (Id k = 0; k < n; ++k) {
        QuadPoint p{};
        for (Id i = 0; i < n; ++i)
          for (std::size_t x = 0; x < 3; ++x) p[x] += weights[i] * net.points[face[(k + i) % n]][x];
        child.push_back(static_cast<Id>(fine_.points.size()));
        fine_.points.push_back(p);
        fine_.owners.push_back(net.owners[face[k]]);
        at_vertex_[face[k]].push_back({f, k});
        sides_[std::minmax(face[k], face[(k + 1) % n])].push_back({f, k});
      }
      fine_.faces.push_back(std::move(child));
    }
  }

  /// The corners around `v` in turn, or none if they are no closed fan of three or more.
  [[nodiscard]] std::vector<Id> fan(Id v) const {
    const auto& corners = at_vertex_[v];
    if (corners.size() < 3) return {};
    std::vector<Id> ring;
    Corner at = corners[0];
    Id from = before(at);  // a neighbouring vertex
    do {
      ring.push_back(vertex(at));
      const Id to = from == before(at) ? after(at) : before(at);
      const auto side = sides_.find(std::minmax(v, to));
      if (to == v || side == sides_.end() || side->second.size() != 2) return {};
      const auto& uses = side->second;
      const Corner& other = uses[0].face == at.face ? uses[1] : uses[0];
      if (other.face == at.face) return {};
      at = corner_at(other, v);
      from = to;
    } while (vertex(at) != ring[0] && ring.size() <= corners.size());
    return ring.size() == corners.size() && from == before(corners[0]) ? ring : std::vector<Id>{};
  }

  [[nodiscard]] Net result() {
    for (const auto& [ends, uses] : sides_)
      if (uses.size() == 2 && ends.first != ends.second && uses[0].face != uses[1].face) {
        const auto& [a, b] = ends;
        fine_.faces.push_back({vertex(corner_at(uses[0], a)), vertex(corner_at(uses[0], b)),
                               vertex(corner_at(uses[1], b)), vertex(corner_at(uses[1], a))});
      }
    for (Id v = 0; v < net_.points.size(); ++v) {
      std::vector<Id> ring = fan(v);
      if (!ring.empty()) fine_.faces.push_back(std::move(ring));
    }
    return std::move(fine_);
  }

 private:
  [[nodiscard]] Id vertex(const Corner& c) const { return first_[c.face] + c.k; }
  [[nodiscard]] Id after(const Corner& c) const {
    const auto& face = net_.faces[c.face];
    return face[(c.k + 1) % face.size()];
  }
  [[nodiscard]] Id before(const Corner& c) const {
    const auto& face = net_.faces[c.face];
    return face[(c.k + face.size() - 1) % face.size()];
  }
  /// The end at `v` of the side that starts at `side`.
  [[nodiscard]] Corner corner_at(const Corner& side, Id v) const {
    const auto& face = net_.faces[side.face];
    return face[side.k] == v ? side : Corner{side.face, static_cast<Id>((side.k + 1) % face.size())};
  }

  const Net& net_;
  std::vector<std::vector<Corner>> at_vertex_;
  std::map<std::pair<Id, Id>, std::vector<Corner>> sides_;
  std::vector<Id> first_;
  Net fine_;
};

Net control_net(const TaggedMesh& mesh) {
  Net net;
  for (const Point& p : mesh.points) {
    for (const double x : p) require(std::isfinite(x), "a coordinate is not finite");
    net.points.push_back({Quad(p[0]), Quad(p[1]), Quad(p[2])});
    net.owners.push_back(static_cast<Id>(net.owners.size()));
  }
  for (const auto& polygon : mesh.polygons) {
    require(polygon.size() >= 2, "a face has less than two corners");
    for (const Id v : polygon) require(v < mesh.points.size(), "a corner is out of range");
  }
  net.faces = mesh.polygons;
  return net;
}

Quad magnitude(const Quad& x) { return x < 0 ? -x : x; }

}  // namespace

std::vector<DualSample> sample_dual(const TaggedMesh& mesh, DualScheme scheme, int levels) {
  require(levels >= 0 && levels <= 8, "an argument is out of range");
  Net net = control_net(mesh);
  std::vector<char> has_patch;
  Quad largest = 0;
  std::size_t star = 4;
  {
    const Step first(net, scheme);
    for (Id v = 0; v < net.points.size(); ++v) {
      const std::size_t corners = first.fan(v).size();
      has_patch.push_back(corners > 0 ? 1 : 0);
      star = std::max(star, corners);
      for (const Quad& x : net.points[v]) largest = std::max(largest, magnitude(x));
    }
    for (const auto& face : net.faces) star = std::max(star, face.size());
  }
  for (int level = 0; level < levels; ++level) net = Step(net, scheme).result();

  const Quad off =
      static_cast<Quad>((levels + 1) * static_cast<int>(star + 12)) * largest * static_cast<Quad>(0x1p-112);
  std::vector<DualSample> samples;
  for (const auto& face : net.faces) {
    DualSample sample{};
    QuadPoint centre{};
    for (const Id v : face) {
      if (has_patch[net.owners[v]]) sample.owners.push_back(net.owners[v]);
      for (std::size_t x = 0; x < 3; ++x) centre[x] += net.points[v][x];
    }
    if (sample.owners.empty()) continue;
    std::sort(sample.owners.begin(), sample.owners.end());
    sample.owners.erase(std::unique(sample.owners.begin(), sample.owners.end()), sample.owners.end());
    Quad worst = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      centre[x] /= static_cast<Quad>(face.size());
      sample.position[x] = static_cast<double>(centre[x]);
      worst = std::max(worst, magnitude(centre[x] - static_cast<Quad>(sample.position[x])));
    }
    sample.error = std::nextafter(static_cast<double>(worst + off), std::numeric_limits<double>::infinity());
    samples.push_back(std::move(sample));
  }
  return samples;
}

TaggedMesh refine_dual(const TaggedMesh& mesh, DualScheme scheme, int levels) {
  require(levels >= 0 && levels <= 8, "an argument is out of range");
  Net net = control_net(mesh);
  for (int level = 0; level < levels; ++level) net = Step(net, scheme).result();
  TaggedMesh fine;
  for (const QuadPoint& p : net.points)
    fine.points.push_back({static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])});
  fine.polygons = net.faces;
  return fine;
}

}  // namespace oracle
