#include <snug/caster/caster_tree.h>
#include <snug/caster/open_nodes.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <snug/geometry/rounding.h>
#include <snug/patch/piece_path.h>
#include <snug/search/feet.h>
#include <snug/search/ray_scale.h>
#include <snug/surface/evaluate.h>
#include <support/direction.h>

namespace snug {
namespace {

using kernels::caster_width;

constexpr unsigned max_digits = 14, bits_of_level = 4;

// How close a ray must come to a quadratic, as a share of its error: neighbours are rarely off by all of it in opposite
// directions. A hit is as far from the surface as both together.
constexpr double widening = 0.7;
// Widest group of rays that is searched as one, as a share of the surface.
constexpr double widest_beam = 0.1;
// Where single precision alone, of coordinates up to about 2, moves a triangle.
constexpr double single_error = 0x1p-21;

// Around the Bezier points of its quarters, which are closer to it than its own.
Box3 box_of(const QuadraticTriangle& q) {
  Box3 box;
  const auto between = [](const Point3& a, const Point3& b) { return a + 0.5 * (b - a); };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3, last = (k + 2) % 3;
    const Point3 &middle = q.middles[k], before = between(q.corners[k], middle),
                 behind = between(middle, q.corners[next]);
    for (const Point3& p : {q.corners[k], before, behind, between(before, behind),
                            between(before, between(q.middles[last], q.middles[next]))}) {
      box.add(p);
    }
  }
  return box;
}

Box3 merged(const Box3& a, const Box3& b) {
  Box3 box = a;
  box.add(b);
  return box;
}

}  // namespace

CasterTree::Places::Places(const PieceSet& pieces) {
  std::uint32_t last = 0;
  unsigned deepest = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    last = std::max(last, pieces.name(i).patch.value());
    deepest = std::max(deepest, pieces.name(i).path.level());
  }
  root_bits_ = static_cast<unsigned>(std::bit_width(last));
  wide_ = root_bits_ + bits_of_level + 2 * std::min(deepest, max_digits) > 32;
}

void CasterTree::Places::add(const PieceName& piece) {
  const unsigned level = std::min(piece.path.level(), max_digits);
  std::uint64_t place = 0;
  for (unsigned d = level; d-- > 0;) place = place << 2 | piece.path.digit(d);
  place = (place << bits_of_level | level) << root_bits_ | piece.patch.value();
  words_.push_back(static_cast<std::uint32_t>(place));
  if (wide_) words_.push_back(static_cast<std::uint32_t>(place >> 32));
}

PieceName CasterTree::Places::operator[](std::size_t i) const {
  std::uint64_t place = wide_ ? words_[2 * i] | std::uint64_t{words_[2 * i + 1]} << 32 : words_[i];
  PieceName result{PatchId(place & ((std::uint64_t{1} << root_bits_) - 1)), {}};
  place >>= root_bits_;
  const unsigned level = place & ((1u << bits_of_level) - 1);
  for (place >>= bits_of_level; result.path.level() < level; place >>= 2) {
    result.path = result.path.child(place & 3u);
  }
  return result;
}

// A tree by medians: eight ranges a node, whole blocks each, cut across the longest side of their centres.
struct CasterTree::Builder {
  CasterTree& tree;
  const PieceSet& pieces;
  std::vector<Box3> boxes;
  std::vector<std::uint32_t> order;

  // Sorts a range so that its first `count` come before the others.
  void cut(std::size_t begin, std::size_t count, std::size_t end) {
    Box3 centres;
    for (std::size_t i = begin; i < end; ++i) centres.add(centre(order[i]));
    const Vector3 sides = centres.upper - centres.lower;
    const std::size_t axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    const auto first = order.begin();
    std::nth_element(first + static_cast<std::ptrdiff_t>(begin),
                     first + static_cast<std::ptrdiff_t>(begin + count),
                     first + static_cast<std::ptrdiff_t>(end), [&](std::uint32_t a, std::uint32_t b) {
                       const double x = centre(a)[axis], y = centre(b)[axis];
                       return x != y ? x < y : a < b;
                     });
  }
  [[nodiscard]] Point3 centre(std::uint32_t piece) const {
    const Box3& box = boxes[piece];
    return box.lower + 0.5 * (box.upper - box.lower);
  }

  // Appends the ends of up to `parts` ranges that [begin, end) is cut into, whole blocks each.
  void divide(std::size_t begin, std::size_t end, std::size_t parts, std::size_t unit,
              std::vector<std::size_t>& ends) {
    const std::size_t units = (end - begin + unit - 1) / unit;
    if (parts == 1 || units <= 1) {
      ends.push_back(end);
      return;
    }
    const std::size_t count = std::min(end - begin - 1, (units + 1) / 2 * unit);
    cut(begin, count, end);
    divide(begin, begin + count, parts / 2, unit, ends);
    divide(begin + count, end, parts / 2, unit, ends);
  }

  Box3 fill(std::size_t begin, std::size_t end, std::uint32_t& name) {
    if (end - begin <= caster_width) return fill_block(begin, end, name);
    std::size_t unit = caster_width;
    while (unit * caster_width < end - begin) unit *= caster_width;
    std::vector<std::size_t> ends;
    divide(begin, end, caster_width, unit, ends);
    name = static_cast<std::uint32_t>(tree.nodes_.size());
    tree.nodes_.emplace_back();
    kernels::CasterNode node = kernels::CasterNode::empty();
    Box3 all;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const Box3 box = fill(i == 0 ? begin : ends[i - 1], ends[i], node.children[i]);
      all = merged(all, box);
      for (std::size_t k = 0; k < 3; ++k) {
        node.boxes.lower[k][i] = static_cast<float>(box.lower[k]);
        node.boxes.upper[k][i] = static_cast<float>(box.upper[k]);
      }
    }
    tree.nodes_[name] = node;
    return all;
  }

  Box3 fill_block(std::size_t begin, std::size_t end, std::uint32_t& name) {
    name = static_cast<std::uint32_t>(tree.blocks_.size()) | kernels::caster_leaf_bit;
    kernels::CasterBlock block{};
    Box3 all, points;
    double error = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const QuadraticTriangle& quadratic = pieces[order[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        points.add(quadratic.corners[k]);
        points.add(quadratic.middles[k]);
      }
      error = std::max(error, quadratic.error);
      all.add(boxes[order[i]]);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      block.origin[k] = static_cast<float>(points.lower[k] + (points.upper[k] - points.lower[k]) / 2);
    }
    block.step = static_cast<float>(longest_side(points) / 2 / 32766 + 1e-9);
    block.inverse_step = 1 / block.step;
    block.error = static_cast<float>(widening * error + static_cast<double>(block.step) + single_error);
    block.taken = (1u << (end - begin)) - 1;
    for (std::size_t l = 0; l < caster_width; ++l) {
      const std::uint32_t piece = order[std::min(begin + l, end - 1)];
      const std::array<Point3, 6> net = points_of(pieces[piece]);
      for (std::size_t k = 0; k < 6; ++k) {
        const Point3& p = net[k];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double from = p[axis] - static_cast<double>(block.origin[axis]);
          block.net[k][axis][l] = static_cast<std::int16_t>(
              std::clamp(std::nearbyint(from / static_cast<double>(block.step)), -32767.0, 32767.0));
        }
      }
      tree.places_.add(pieces.name(piece));
    }
    tree.blocks_.push_back(block);
    const double by = static_cast<double>(block.error + tree.rounding_) + single_error;
    const Vector3 grown{by, by, by};
    return {all.lower - grown, all.upper + grown};
  }
};

CasterTree::CasterTree(const LimitSurface& surface, double tolerance, int threads, const WorkMonitor& monitor)
    : surface_(&surface) {
  const PieceSet pieces(surface, tolerance / (1 + widening), threads, monitor);
  places_ = Places(pieces);
  Builder builder{*this, pieces, {}, {}};
  builder.boxes.reserve(pieces.size());
  Box3 all;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    builder.boxes.push_back(box_of(pieces[i]));
    builder.order.push_back(static_cast<std::uint32_t>(builder.order.size()));
    all.add(builder.boxes.back());
  }
  centre_ = all.lower + 0.5 * (all.upper - all.lower);
  radius_ = length(all.upper - centre_) + tolerance;
  rounding_ = static_cast<float>(single_error * (1 + radius_));
  std::uint32_t name = 0;
  // A root of one block is a node with one child.
  if (pieces.size() <= caster_width) {
    nodes_.emplace_back();
    kernels::CasterNode node = kernels::CasterNode::empty();
    const Box3 box = builder.fill_block(0, pieces.size(), name);
    for (std::size_t k = 0; k < 3; ++k) {
      node.boxes.lower[k][0] = static_cast<float>(box.lower[k]);
      node.boxes.upper[k][0] = static_cast<float>(box.upper[k]);
    }
    node.children[0] = name;
    nodes_[0] = node;
  } else {
    static_cast<void>(builder.fill(0, pieces.size(), name));
  }
  const std::uint32_t nothing = static_cast<std::uint32_t>(blocks_.size()) | kernels::caster_leaf_bit;
  blocks_.emplace_back();
  for (kernels::CasterNode& node : nodes_)
    std::replace(node.children.begin(), node.children.end(), kernels::CasterNode::no_child, nothing);
  nodes_.shrink_to_fit();
  blocks_.shrink_to_fit();
  places_.shrink_to_fit();
}

std::size_t CasterTree::bytes() const {
  return nodes_.capacity() * sizeof(kernels::CasterNode) + blocks_.capacity() * sizeof(kernels::CasterBlock) +
         places_.bytes();
}

// A ray from where it comes near, so that single precision will do.
struct CasterTree::Approach {
  // Does the ray's line pass by the ball around everything? Most rays of a picture do, which need no root then.
  static bool passes_ball(const CasterTree& tree, const Ray& ray) {
    const Vector3 ahead = tree.centre_ - tree.surface_->scale().apply(ray.origin);
    const double along = dot(ray.direction, ahead), square = length_sq(ray.direction);
    // Squares of shorter ones lose digits, and those of lengths from afar what the ball is large.
    if (!(square > 0x1p-900)) return false;
    return (length_sq(ahead) * (1 - 0x1p-44) - 1.001 * tree.radius_ * tree.radius_) * square > along * along;
  }
  Approach(const CasterTree& tree, const Ray& ray)
      : lengths(ray.direction, tree.surface_->scale()), direction(lengths.unit(ray.direction)) {
    const Point3 origin = tree.surface_->scale().apply(ray.origin);
    const Vector3 ahead = tree.centre_ - origin;
    const double middle = dot(direction, ahead);
    // Forwards or backwards.
    skipped = std::max(lengths.to_scaled(ray.from), middle - tree.radius_);
    start = origin + skipped * direction;
    from = static_cast<float>(std::max(lengths.to_scaled(ray.from) - skipped, -tree.radius_));
    to = static_cast<float>(std::min(lengths.to_scaled(ray.to) - skipped, 2.01 * tree.radius_));
    passes = !(to >= from);
  }
  RayScale lengths;
  Vector3 direction;
  double skipped;
  Point3 start;
  float from, to;
  bool passes;  // before it or behind it
};

kernels::CasterRay CasterTree::seen(const Approach& approach) const {
  kernels::CasterRay ray{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto d = static_cast<float>(approach.direction[k]);
    ray.origin[k] = static_cast<float>(approach.start[k]);
    ray.direction[k] = d;
    ray.inverse[k] = 1 / (std::fabs(d) > 1e-20F ? d : std::copysign(1e-20F, d));
  }
  ray.rounding = rounding_;
  const std::array<float, 3>& d = ray.direction;
  const float x = std::fabs(d[0]), y = std::fabs(d[1]), z = std::fabs(d[2]);
  ray.axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  return ray;
}

// Calls visit(block) for the blocks whose boxes, grown on each side, the ray meets before `last`, the nearest
// first; the call returns what `last` has become.
template <class Visit>
void CasterTree::walk(const kernels::CasterRay& ray, float grown, float first, float last,
                      const Visit& visit) const {
  kernels::OpenNodes open;
  open.add(0, first);
  while (!open.empty()) {
    const kernels::OpenNodes::Item top = open.take();
    if (top.enter > last) continue;
    if ((top.name & kernels::caster_leaf_bit) != 0) {
      last = visit(top.name & ~kernels::caster_leaf_bit);
      continue;
    }
    const kernels::CasterNode& node = nodes_[top.name];
    std::array<float, caster_width> enter;
    const std::uint32_t met = kernels::enter_boxes(node.boxes, ray, grown, first, last, enter.data());
    open.add(node.children, met, enter);
  }
}

// Up to eight rays that lie close together, searched as one thick ray.
struct CasterTree::Beam {
  Beam(const CasterTree& in, std::span<const Approach> group, double apart, double spreading)
      : tree(in), middle(in.seen(group[group.size() / 2])), count(group.size()) {
    for (std::size_t i = 0; i < caster_width; ++i) {
      const Approach& ray = group[std::min(i, count - 1)];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t axis = (middle.axis + 1 + k) % 3;
        rays.origin[k][i] = static_cast<float>(ray.start[axis]);
        rays.direction[k][i] = static_cast<float>(ray.direction[axis]);
      }
      rays.inverse[i] = 1 / rays.direction[2][i];
      from[i] = ray.from;
      to[i] = ray.to;
    }
    rays.axis = middle.axis;
    first = *std::min_element(from.begin(), from.end());
    grown = static_cast<float>(apart + 2 * tree.radius_ * spreading) + tree.rounding_;
  }

  void search() {
    tree.walk(middle, grown, first, last(), [&](std::uint32_t block) {
      const kernels::CasterBlock& triangles = tree.blocks_[block];
      std::uint32_t near = kernels::near_ray(triangles, middle, grown);
      for (; near != 0; near &= near - 1) {
        const auto place = static_cast<std::uint32_t>(std::countr_zero(near));
        std::uint32_t met = kernels::hit_piece(triangles, place, rays, tree.rounding_, from.data(), to.data(),
                                               u.data(), v.data());
        for (; met != 0; met &= met - 1) {
          const auto i = static_cast<std::size_t>(std::countr_zero(met));
          hits[i] = {block, place, to[i], u[i], v[i]};
        }
      }
      return last();
    });
  }
  [[nodiscard]] float last() const { return *std::max_element(to.begin(), to.end()); }

  const CasterTree& tree;
  kernels::CasterRay middle;
  std::size_t count;
  kernels::CasterRays rays{};
  float first, grown;
  alignas(32) std::array<float, caster_width> from, to, u{}, v{};
  std::array<kernels::CasterHit, caster_width> hits;
};

QuickHit CasterTree::cast(const Ray& ray) const {
  if (Approach::passes_ball(*this, ray)) return {};
  const Approach approach(*this, ray);
  return approach.passes ? QuickHit{} : nearest(approach);
}

QuickHit CasterTree::nearest(const Approach& approach) const {
  const kernels::CasterHit hit = kernels::cast(nodes_.data(), blocks_.data(), seen(approach), approach.from,
                                               approach.to, kernels::CasterQuery::nearest);
  return hit.place == caster_width ? QuickHit{} : finished(approach, hit);
}

bool CasterTree::blocked(const Ray& ray) const {
  const Approach approach(*this, ray);
  if (approach.passes) return false;
  return kernels::cast(nodes_.data(), blocks_.data(), seen(approach), approach.from, approach.to,
                       kernels::CasterQuery::any)
             .place != caster_width;
}

void CasterTree::cast(std::span<const Ray> rays, std::span<QuickHit> out) const {
  std::vector<Approach> group;
  std::array<std::size_t, caster_width> which{};
  for (std::size_t begin = 0; begin < rays.size(); begin += caster_width) {
    group.clear();
    for (std::size_t i = begin; i < std::min(begin + caster_width, rays.size()); ++i) {
      out[i] = {};
      if (Approach::passes_ball(*this, rays[i])) continue;
      const Approach approach(*this, rays[i]);
      if (approach.passes) continue;
      which[group.size()] = i;
      group.push_back(approach);
    }
    if (group.empty()) continue;
    // How far rays may be from the middle one, at the start and by what they gain a unit.
    const Approach& middle = group[group.size() / 2];
    double apart = 0, spreading = 0;
    for (const Approach& approach : group) {
      apart = std::max(apart, length(approach.start - middle.start));
      spreading = std::max(spreading, length(approach.direction - middle.direction));
    }
    if (group.size() < 3 || apart + 2 * radius_ * spreading > widest_beam * radius_) {
      for (std::size_t i = 0; i < group.size(); ++i) out[which[i]] = nearest(group[i]);
      continue;
    }
    Beam beam(*this, group, apart, spreading);
    beam.search();
    for (std::size_t i = 0; i < group.size(); ++i) {
      if (beam.hits[i].place != caster_width) {
        out[which[i]] = finished(group[i], beam.hits[i]);
      }
    }
  }
}

QuickHit CasterTree::finished(const Approach& approach, const kernels::CasterHit& hit) const {
  const PieceName place = places_[hit.block * caster_width + hit.place];
  const TriangleParameter at{static_cast<double>(hit.u), static_cast<double>(hit.v)};
  QuickHit answer;
  answer.t = approach.lengths.to_parameter(static_cast<double>(hit.t) + approach.skipped);
  answer.at = place_of(*surface_, place, at);
  answer.patch = surface_->place(place.patch);
  answer.level = place.path.level();
  // Of the quadratic.
  const auto& net = blocks_[hit.block].net;
  const auto difference = [&](std::size_t from, std::size_t to) {
    const auto coordinate = [&](std::size_t axis) {
      return static_cast<double>(net[to][axis][hit.place] - net[from][axis][hit.place]);
    };
    return Vector3{coordinate(0), coordinate(1), coordinate(2)};
  };
  const double rest = 1 - at.u - at.v;
  const Vector3 du = rest * difference(0, 3) + at.u * difference(3, 1) + at.v * difference(5, 4);
  const Vector3 dv = rest * difference(0, 5) + at.u * difference(3, 4) + at.v * difference(5, 2);
  answer.normal = normalized(cross(du, dv));
  return answer;
}

}  // namespace snug
