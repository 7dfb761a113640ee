#include "half_quad.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "rejected.h"

namespace checker {
namespace {

using Weights = Shape::Weights;

// A new point in the making, by weights that are certainly not negative.
class Sum {
 public:
  void add(const Real& weight, std::size_t vertex) {
    if (!weight.certainly_at_least(0)) throw Rejected("a mask with a negative weight");
    weights_[vertex] += weight;
  }
  void add(const Real& weight, const std::vector<std::size_t>& vertices) {
    for (const std::size_t v : vertices) add(weight, v);
  }
  [[nodiscard]] Weights take() { return std::move(weights_); }

 private:
  Weights weights_;
};

Weights unit(std::size_t vertex) { return {{vertex, Real(1)}}; }

Real ratio(double p, double q) { return Real(p) / Real(q); }

// Each new point of a face's corner, from the face's vertices: from itself, then around.
std::vector<Real> dual_mask(Scheme scheme, std::size_t n) {
  std::vector<Real> mask(n);
  const auto size = static_cast<double>(n);
  if (scheme == Scheme::midedge) {  // [PetersReif97]: the middle of two edges' middles, twice
    mask[0] = 0.5;
    mask[1] += Real(0.25);
    mask[n - 1] += Real(0.25);
    return mask;
  }
  mask[0] = Real(0.25) + ratio(5, 4 * size);  // [DooSabin78]
  for (std::size_t i = 1; i < n; ++i) {
    const Real c = Real::cos_of_turn(static_cast<unsigned>(n), static_cast<unsigned>(i));
    mask[i] = (Real(3) + Real(2) * c) / Real(4 * size);
  }
  return mask;
}

std::size_t place_of(const Shape::Face& face, std::size_t v) {
  const auto it = std::find(face.begin(), face.end(), v);
  if (it == face.end()) throw Rejected("a face without a vertex that it has");
  return static_cast<std::size_t>(it - face.begin());
}

void require_sensible(Scheme scheme, const Key& key) {
  for (std::size_t i = 0; i < 4; ++i) {
    const Fan &here = key[i], &there = key[(i + 1) % 4];
    if (here.closed && (here.before != 0 || here.faces() < 3)) throw Rejected("a closed fan that cannot be");
    if (here.faces() > 64) throw Rejected("a corner with more than 64 faces");  // rows are dense
    if (scheme != Scheme::catmark) {
      if (!here.closed || here.sharp) throw Rejected("a face that is open or sharp");
      continue;
    }
    if (here.sharp && (here.closed || here.faces() != 1))
      throw Rejected("a sharp corner that has more than one face");
    if ((!here.closed && here.before == 0) != (!there.closed && there.after == 0))
      throw Rejected("corners that do not agree whether their edge is a boundary");
  }
}

Row dense(const Weights& weights, std::size_t count) {
  Row row(count);
  for (const auto& [v, weight] : weights) row[v] = weight;
  return row;
}

// The same weights of points that are themselves weights.
Weights product(const Weights& weights, const std::vector<Weights>& of) {
  Weights result;
  for (const auto& [v, weight] : weights) {
    for (const auto& [c, inner] : of[v]) result[c].add_product(weight, inner);
  }
  return result;
}

void add_product(const Real& weight, const Row& row, Row& sum) {
  for (std::size_t c = 0; c < row.size(); ++c) {
    if (!row[c].is_exactly_zero()) sum[c].add_product(weight, row[c]);
  }
}

// Corners of the quad (0,0) to (1,1).
constexpr std::array<std::array<unsigned, 2>, 4> square{{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};

}  // namespace

Fan Shape::Ring::fan(bool sharp) const {
  return {static_cast<std::uint16_t>(own), static_cast<std::uint16_t>(faces.size() - 1 - own), closed, sharp};
}

void Shape::Net::add(Face face) {
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!face_of.emplace(std::pair{face[i], face[(i + 1) % face.size()]}, faces.size()).second)
      throw Rejected("a net in which an edge has two faces on one side");
  }
  faces.push_back(std::move(face));
}

std::size_t Shape::Net::after(std::size_t face, std::size_t v) const {
  const Face& f = faces[face];
  return f[(place_of(f, v) + 1) % f.size()];
}

std::size_t Shape::Net::before(std::size_t face, std::size_t v) const {
  const Face& f = faces[face];
  return f[(place_of(f, v) + f.size() - 1) % f.size()];
}

Shape::Ring Shape::Net::ring(std::size_t v, std::size_t start) const {
  Ring ring;
  ring.spokes.push_back(start);
  for (auto it = face_of.find({v, start}); it != face_of.end(); it = face_of.find({v, ring.spokes.back()})) {
    ring.faces.push_back(it->second);
    const std::size_t next = before(it->second, v);
    if (next == start) {
      ring.closed = true;
      return ring;
    }
    ring.spokes.push_back(next);
  }
  std::size_t w = start;
  for (auto it = face_of.find({w, v}); it != face_of.end(); it = face_of.find({w, v})) {
    ring.faces.insert(ring.faces.begin(), it->second);
    ring.spokes.insert(ring.spokes.begin(), w = after(it->second, v));
    ++ring.own;
  }
  return ring;
}

Shape::Shape(Shapes& all, Scheme scheme, const Key& key) : all_(all), scheme_(scheme), key_(key) {
  require_sensible(scheme, key);
  if (primal()) {
    make_quads();
  } else {
    make_dual();
  }
}

void Shape::make_quads() {
  const auto three = [&](std::size_t i) { return key_[i].closed && key_[i].faces() == 3; };
  net_.add({0, 1, 2, 3});
  count_ = 4;
  std::array<std::size_t, 4> near{}, far{};  // across edge i, beside corner i and beside corner i + 1
  for (std::size_t i = 0; i < 4; ++i) {
    if (!key_[i].closed && key_[i].before == 0) continue;
    near[i] = i > 0 && three(i) ? far[i - 1] : count_++;
    far[i] = i == 3 && three(0) ? near[0] : count_++;
    net_.add({(i + 1) % 4, i, near[i], far[i]});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const Fan& fan = key_[i];
    const std::size_t last_edge = (i + 3) % 4;
    std::size_t spoke = far[last_edge];
    for (unsigned k = 1; k < fan.after; ++k) {
      if (fan.closed && k + 1 == fan.after) break;  // the one across edge i
      const std::size_t diagonal = count_++;
      const std::size_t next = fan.closed && k + 2 == fan.after ? near[i] : count_++;
      net_.add({i, spoke, diagonal, next});
      spoke = next;
    }
    spoke = near[i];
    for (unsigned k = 1; k < fan.before; ++k) {
      const std::size_t diagonal = count_++, next = count_++;
      net_.add({i, next, diagonal, spoke});
      spoke = next;
    }
  }
  for (std::size_t i = 0; i < 4; ++i) {
    if (net_.ring(i, (i + 1) % 4).fan(key_[i].sharp) != key_[i]) throw Rejected("a key that gives no net");
  }
}

void Shape::make_dual() {
  count_ = 5;
  for (std::size_t k = 0; k < 4; ++k) {
    Face face{0, 1 + k};
    for (unsigned i = 3; i < key_[k].faces(); ++i) face.push_back(count_++);
    face.push_back(1 + (k + 1) % 4);
    net_.add(std::move(face));
  }
}

bool Shape::polynomial() const {
  return std::all_of(key_.begin(), key_.end(), [&](const Fan& fan) { return fan.regular(scheme_); });
}

// [CatmullClark78]: (Q + 2 R + (n - 3) S) / n; boundaries as in [DeRose98].
Weights Shape::new_vertex(std::size_t k) const {
  if (key_[k].sharp) return unit(k);
  const Ring ring = net_.ring(k, (k + 1) % 4);
  Sum sum;
  if (!ring.closed) {
    sum.add(0.75, k);
    sum.add(0.125, ring.spokes.front());
    sum.add(0.125, ring.spokes.back());
    return sum.take();
  }
  const auto n = static_cast<double>(ring.faces.size());
  for (const std::size_t f : ring.faces) sum.add(ratio(1, 4 * n * n), net_.faces[f]);  // Q: face points
  sum.add(ratio(1, n), k);                                                             // 2 R: edges' middles
  sum.add(ratio(1, n * n), ring.spokes);
  sum.add(ratio(n - 3, n), k);
  return sum.take();
}

Weights Shape::new_edge_point(std::size_t a, std::size_t b) const {
  const auto left = net_.face_of.find({a, b}), right = net_.face_of.find({b, a});
  const bool boundary = left == net_.face_of.end() || right == net_.face_of.end();
  Sum sum;
  sum.add(boundary ? 0.5 : 0.25, {a, b});
  if (!boundary) {
    sum.add(0.0625, net_.faces[left->second]);
    sum.add(0.0625, net_.faces[right->second]);
  }
  return sum.take();
}

// Only the faces at the patch's own corners: no quarter has others around it.
Shape::Refined Shape::refine_quads() const {
  Refined out;
  std::map<std::vector<std::size_t>, std::size_t> names;  // by the vertices of what a new point belongs to
  const auto name = [&](std::vector<std::size_t> of, const auto& make) {
    const auto [it, fresh] = names.emplace(std::move(of), out.points.size());
    if (fresh) out.points.push_back(make());
    return it->second;
  };
  const auto vertex = [&](std::size_t v) { return name({v}, [&] { return new_vertex(v); }); };
  const auto edge = [&](std::size_t a, std::size_t b) {
    return name({std::min(a, b), std::max(a, b)}, [&] { return new_edge_point(a, b); });
  };
  const auto face = [&](std::size_t f) {
    return name(net_.faces[f], [&] {
      Sum sum;
      sum.add(0.25, net_.faces[f]);
      return sum.take();
    });
  };
  for (std::size_t f = 0; f < net_.faces.size(); ++f) {
    const Face& around = net_.faces[f];
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t v = around[i];
      if (v < 4)
        out.net.add({vertex(v), edge(v, around[(i + 1) % 4]), face(f), edge(around[(i + 3) % 4], v)});
    }
  }
  for (std::size_t q = 0; q < 4; ++q) {
    out.corners[q][q] = vertex(q);
    out.corners[q][(q + 1) % 4] = edge(q, (q + 1) % 4);
    out.corners[q][(q + 2) % 4] = face(0);
    out.corners[q][(q + 3) % 4] = edge((q + 3) % 4, q);
  }
  return out;
}

// A face each for the patch's vertex, its faces and its edges.
Shape::Refined Shape::refine_dual() const {
  Refined out;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> names;
  for (std::size_t f = 0; f < 4; ++f) {
    const Face& face = net_.faces[f];
    const std::vector<Real> mask = dual_mask(scheme_, face.size());
    Face inner;
    for (std::size_t i = 0; i < face.size(); ++i) {
      Sum sum;
      for (std::size_t k = 0; k < face.size(); ++k) sum.add(mask[k], face[(i + k) % face.size()]);
      names[{f, face[i]}] = out.points.size();
      inner.push_back(out.points.size());
      out.points.push_back(sum.take());
    }
    out.net.add(std::move(inner));
    out.middles[f] = names.at({f, 0});
  }
  for (std::size_t f = 0; f < 4; ++f) {  // the edge between faces f and f + 1
    const std::size_t next = (f + 1) % 4, end = 1 + next;
    out.net.add({names.at({f, 0}), names.at({f, end}), names.at({next, end}), names.at({next, 0})});
  }
  out.net.add({out.middles[0], out.middles[1], out.middles[2], out.middles[3]});
  for (std::size_t q = 0; q < 4; ++q) {
    out.corners[q][q] = q;
    out.corners[q][(q + 1) % 4] = 4 + q;
    out.corners[q][(q + 2) % 4] = 8;
    out.corners[q][(q + 3) % 4] = 4 + (q + 3) % 4;
  }
  return out;
}

// Reads the key of a quarter off its fans, and finds its control points by walking both nets together.
Shape::Quarter Shape::quarter(const Refined& refined, std::size_t corner, std::size_t turn) const {
  std::array<std::size_t, 4> own{};  // corners in the quarter's own order
  for (std::size_t j = 0; j < 4; ++j) own[j] = refined.corners[corner][(j + turn) % 4];
  Key key;
  for (std::size_t j = 0; j < 4; ++j) {
    const bool old = (j + turn) % 4 == corner;
    if (primal()) {
      key[j] = refined.net.ring(own[j], own[(j + 1) % 4]).fan(old && key_[corner].sharp);
    } else {
      key[j] = {0, static_cast<std::uint16_t>(refined.net.faces[own[j]].size() - 1), true, false};
    }
    if (old && key[j] != key_[corner]) throw Rejected("a corner whose fan changed");
    if (!old && !key[j].regular(scheme_)) throw Rejected("a new corner that is not regular");
  }
  Quarter result{&all_.find(scheme_, key), {}};
  const Shape& shape = *result.shape;
  std::vector<std::optional<std::size_t>> image(shape.count_);
  if (primal()) {
    for (std::size_t j = 0; j < 4; ++j) image[j] = own[j];
  } else {
    const std::size_t middle = refined.middles[corner];
    const std::size_t start = refined.net.after(own[0], middle);
    const Ring ring = refined.net.ring(middle, start);
    if (!ring.closed || !std::equal(own.begin(), own.end(), ring.faces.begin(), ring.faces.end()))
      throw Rejected("a vertex with other faces around it");
    image[0] = middle;
    image[1] = start;
  }
  std::vector<bool> done(shape.net_.faces.size(), false);
  for (std::size_t left = done.size(), before = left + 1; left > 0;) {
    if (left == before) throw Rejected("a net in several parts");
    before = left;
    for (std::size_t f = 0; f < done.size(); ++f) {
      const Face& face = shape.net_.faces[f];
      for (std::size_t i = 0; i < face.size() && !done[f]; ++i) {
        const auto a = image[face[i]], b = image[face[(i + 1) % face.size()]];
        if (!a || !b) continue;
        const auto there = refined.net.face_of.find({*a, *b});
        if (there == refined.net.face_of.end()) throw Rejected("a quarter with other faces around it");
        const Face& other = refined.net.faces[there->second];
        if (other.size() != face.size()) throw Rejected("a quarter with larger or smaller faces around it");
        const std::size_t first = place_of(other, *a);
        for (std::size_t k = 0; k < face.size(); ++k) {
          auto& seen = image[face[(i + k) % face.size()]];
          const std::size_t v = other[(first + k) % face.size()];
          if (seen.value_or(v) != v) throw Rejected("a quarter whose faces hang together in another way");
          seen = v;
        }
        done[f] = true;
        --left;
      }
    }
  }
  for (const auto& v : image) result.net.push_back(refined.points[v.value()]);
  return result;
}

const std::vector<Shape::Quarter>& Shape::quarters() const {
  if (quarters_.empty()) {
    const Refined refined = primal() ? refine_quads() : refine_dual();
    for (std::size_t q = 0; q < 4; ++q) quarters_.push_back(quarter(refined, q, 0));
    quarters_.push_back(quarter(refined, 1, 2));
  }
  return quarters_;
}

// [HalsteadKassDeRose93]; cubic B-splines at boundaries. Dual schemes: a step keeps the mean of a face.
Weights Shape::limit(std::size_t k) const {
  Sum sum;
  if (!primal()) {
    const Face& face = net_.faces[k];
    sum.add(ratio(1, static_cast<double>(face.size())), face);
    return sum.take();
  }
  if (key_[k].sharp) return unit(k);
  const Ring ring = net_.ring(k, (k + 1) % 4);
  if (!ring.closed) {
    sum.add(ratio(2, 3), k);
    sum.add(ratio(1, 6), ring.spokes.front());
    sum.add(ratio(1, 6), ring.spokes.back());
    return sum.take();
  }
  const auto n = static_cast<double>(ring.faces.size());
  const double all = n * (n + 5);
  sum.add(ratio(n * n, all), k);
  sum.add(ratio(4, all), ring.spokes);
  for (const std::size_t f : ring.faces) sum.add(ratio(1, all), net_.after(f, net_.after(f, k)));
  return sum.take();
}

// Limits at the corners of the sixteenths, by their places in the quad (0,0) to (4,4).
std::map<std::array<unsigned, 2>, Row> Shape::limits_on_grid() const {
  std::map<std::array<unsigned, 2>, Row> limits;
  for (std::size_t q = 0; q < 4; ++q) {
    const Quarter& quarter = quarters()[q];
    for (std::size_t s = 0; s < 4; ++s) {
      const Quarter& sixteenth = quarter.shape->quarters()[s];
      for (std::size_t k = 0; k < 4; ++k) {
        Row row = dense(product(product(sixteenth.shape->limit(k), sixteenth.net), quarter.net), count_);
        const std::array<unsigned, 2> place{2 * square[q][0] + square[s][0] + square[k][0],
                                            2 * square[q][1] + square[s][1] + square[k][1]};
        const auto [it, fresh] = limits.emplace(place, row);
        for (std::size_t c = 0; c < count_; ++c) {
          if (!(it->second[c] - row[c]).may_be(0)) throw Rejected("two limits at one place");
        }
      }
    }
  }
  return limits;
}

const std::vector<Shape::Part>& Shape::parts() const {
  if (!parts_.empty()) return parts_;
  const auto limits = limits_on_grid();
  std::vector<Part> parts;
  std::vector<unsigned> nodes;  // of a tensor product; none for Midedge
  if (scheme_ == Scheme::midedge) {
    parts = {{{{{0, 0}, {4, 0}, {2, 2}}}, 2, {}}, {{{{2, 2}, {4, 0}, {4, 4}}}, 2, {}}};
  } else {
    nodes = scheme_ == Scheme::catmark ? std::vector<unsigned>{0, 1, 3, 4} : std::vector<unsigned>{0, 2, 4};
    parts = {{{{{0, 0}, {4, 0}, {4, 4}}}, static_cast<unsigned>(2 * nodes.size() - 2), {}}};
  }
  // Lagrange's polynomial of a node.
  const auto lagrange = [&](unsigned node, const Real& x) {
    Real value = 1;
    for (const unsigned other : nodes) {
      if (other != node) value = value * (x - Real(other)) / (Real(node) - Real(other));
    }
    return value;
  };
  const auto value_at = [&](const Part& part, const Exponents& e) {
    std::array<unsigned, 2> sum{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t a = 0; a < 2; ++a) sum[a] += e[k] * part.corners[k][a];
    }
    if (nodes.empty()) return limits.at({sum[0] / part.degree, sum[1] / part.degree});
    const Real x = ratio(sum[0], part.degree), y = ratio(sum[1], part.degree);
    Row row(count_);
    for (const unsigned i : nodes) {
      for (const unsigned j : nodes) add_product(lagrange(i, x) * lagrange(j, y), limits.at({i, j}), row);
    }
    return row;
  };
  for (Part& part : parts) {
    const std::vector<Exponents>& lattice = exponents(part.degree);
    const std::vector<Row>& to_points = bezier_from_values(part.degree);
    std::vector<Row> values;
    for (const Exponents& e : lattice) values.push_back(value_at(part, e));
    part.points.assign(lattice.size(), Row(count_));
    for (std::size_t p = 0; p < lattice.size(); ++p) {
      for (std::size_t q = 0; q < lattice.size(); ++q)
        add_product(to_points[p][q], values[q], part.points[p]);
    }
    // All limits that were found in the triangle, those that were not used among them.
    const auto area = [&](std::size_t k, double x, double y) {  // twice that of (x, y) and the edge facing k
      const auto &a = part.corners[(k + 1) % 3], &b = part.corners[(k + 2) % 3];
      return (a[0] - x) * (b[1] - y) - (a[1] - y) * (b[0] - x);
    };
    for (const auto& [place, row] : limits) {
      std::array<Real, 3> weights;
      bool inside = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const double part_of_area = area(k, place[0], place[1]);
        inside = inside && part_of_area >= 0;
        weights[k] = ratio(part_of_area, area(k, part.corners[k][0], part.corners[k][1]));
      }
      if (!inside) continue;
      Row sum(count_);
      for (std::size_t p = 0; p < lattice.size(); ++p)
        add_product(bernstein(lattice[p], weights), part.points[p], sum);
      for (std::size_t c = 0; c < count_; ++c) {
        if (!(sum[c] - row[c]).may_be(0)) throw Rejected("a regular patch that is not polynomial");
      }
    }
  }
  parts_ = std::move(parts);
  return parts_;
}

const Shape& Shapes::find(Scheme scheme, const Key& key) {
  std::unique_ptr<Shape>& shape = shapes_[{scheme, key}];
  if (!shape) shape = std::make_unique<Shape>(*this, scheme, key);
  return *shape;
}

HalfQuad root_half(Shapes& shapes, Scheme scheme, const Key& key) {
  HalfQuad root;
  root.shape = &shapes.find(scheme, key);
  constexpr std::int64_t one = std::int64_t{1} << place_bits;
  root.places = {Place{0, 0}, Place{one, 0}, Place{0, one}};
  const std::size_t count = root.shape->control_count();
  for (std::size_t v = 0; v < count; ++v)
    root.rows.push_back(std::make_shared<const Row>(dense(unit(v), count)));
  return root;
}

std::array<HalfQuad, 4> split(const HalfQuad& piece) {
  if (piece.depth >= place_bits - 2) throw Rejected("too many levels");
  std::array<Place, 3> middles;  // by the corner that the edge faces
  for (std::size_t k = 0; k < 3; ++k) {
    const Place &a = piece.places[(k + 1) % 3], &b = piece.places[(k + 2) % 3];
    middles[k] = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
  }
  std::array<HalfQuad, 4> children;
  for (std::size_t c = 0; c < 4; ++c) {
    HalfQuad& child = children[c];
    const Shape::Quarter& quarter = piece.shape->quarters()[c < 3 ? c : 4];
    child.shape = quarter.shape;
    child.depth = piece.depth + 1;
    for (std::size_t k = 0; k < 3; ++k)
      child.places[k] = c == k ? piece.places[k] : middles[c == 3 ? k : 3 - c - k];
    for (const Weights& weights : quarter.net) {
      Row row(piece.rows[0]->size());
      for (const auto& [v, weight] : weights) add_product(weight, *piece.rows[v], row);
      child.rows.push_back(std::make_shared<const Row>(std::move(row)));
    }
  }
  return children;
}

std::vector<const Row*> net_of(const HalfQuad& piece, const Key& key, std::size_t first) {
  if (first != 0 || piece.shape->key() != key) return {};
  std::vector<const Row*> rows;
  for (const auto& row : piece.rows) rows.push_back(row.get());
  return rows;
}

std::vector<BezierTriangle> bezier_triangles(const HalfQuad& piece) {
  std::vector<BezierTriangle> triangles;
  for (const Shape::Part& part : piece.shape->parts()) {
    BezierTriangle triangle;
    triangle.degree = part.degree;
    for (std::size_t k = 0; k < 3; ++k) {  // (x, y) is (4 - x), (x - y), y of corners 0, 1, 2
      const auto x = static_cast<std::int64_t>(part.corners[k][0]);
      const auto y = static_cast<std::int64_t>(part.corners[k][1]);
      for (std::size_t a = 0; a < 2; ++a) {
        triangle.places[k][a] = (4 - x) * (piece.places[0][a] / 4) + (x - y) * (piece.places[1][a] / 4) +
                                y * (piece.places[2][a] / 4);
      }
    }
    for (const Row& point : part.points) {
      Row row(piece.rows[0]->size());
      for (std::size_t v = 0; v < point.size(); ++v) add_product(point[v], *piece.rows[v], row);
      triangle.points.push_back(std::move(row));
    }
    triangles.push_back(std::move(triangle));
  }
  return triangles;
}

}  // namespace checker
