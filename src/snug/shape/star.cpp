#include <snug/shape/star.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <snug/geometry/bernstein.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/shape/corner_rings.h>
#include <snug/shape/corner_side.h>
#include <snug/shape/flat_patch.h>
#include <snug/shape/left_turn.h>
#include <support/direction.h>

namespace snug {
namespace {

// Levels that an edge is split to bound its coefficients.
constexpr unsigned border_levels = 3;

// Does a closed curve turn left around a point, all along, and only once? It is added edge by edge.
class TurnAround {
 public:
  // The edge of a patch from a corner to the next one, whose points are moved by `shift`, so that the point is the origin; the exact
  // ones are this near, beside the patch's own error.
  [[nodiscard]] bool add(const Patch& patch, unsigned edge, Point2 shift, double error) {
    shift_ = shift;
    error_ = error;
    return add(patch, edge, corner_levels);
  }
  // visit(from, to) of each pair of Bezier points next to each other along an edge, but near an extraordinary corner.
  template <class Visit>
  static void each_step(const Patch& patch, unsigned edge, const Visit& visit, unsigned levels = 2) {
    const auto steps = [&](const FlatCurve& curve) {
      for (std::size_t t = 0; t < curve.degree; ++t) visit(curve.points[t], curve.points[t + 1]);
      return true;
    };
    if (patch.kind->polynomial()) {
      each_curve(patch, edge, steps);
      return;
    }
    const RingDecay* const tip = decay_of(*patch.kind);
    const std::optional<FlatCurve> whole =
        tip != nullptr ? curve_at_end_of_fan(patch, corner_of(*tip, patch), edge) : std::nullopt;
    if (whole) {
      steps(*whole);
    } else if (levels > 0) {
      each_step(split(patch, edge), edge, visit, levels - 1);
      each_step(split(patch, (edge + 1) % 3), edge, visit, levels - 1);
    }
  }
  // Of a closed curve the angle is a multiple of 2 pi.
  [[nodiscard]] bool once() const { return angle_ < 3 * std::numbers::pi; }

 private:
  bool add(const Patch& patch, unsigned edge, unsigned levels) {
    if (patch.kind->polynomial()) return add_polynomial(patch, edge, border_levels);
    if (levels == 0) return false;
    if (const RingDecay* tip = decay_of(*patch.kind)) {
      const unsigned corner = corner_of(*tip, patch);
      if (corner == edge || corner == (edge + 1) % 3) {
        if (ends_fan(patch, corner, edge)) {
          const std::optional<FlatCurve> curve = curve_at_end_of_fan(patch, corner, edge);
          return curve && add_split(moved(*curve), border_levels);
        }
        return add_rings(*tip, patch, corner, edge, levels - 1);
      }
    }
    return add(split(patch, edge), edge, levels - 1) && add(split(patch, (edge + 1) % 3), edge, levels - 1);
  }

  bool add_polynomial(const Patch& patch, unsigned edge, unsigned levels) {
    const double angle = angle_;
    if (each_curve(patch, edge, [&](const FlatCurve& curve) { return add_curve(moved(curve)); })) return true;
    angle_ = angle;
    if (levels == 0) return false;
    return add_polynomial(split(patch, edge), edge, levels - 1) &&
           add_polynomial(split(patch, (edge + 1) % 3), edge, levels - 1);
  }

  [[nodiscard]] FlatCurve moved(FlatCurve curve) const {
    double largest = 0;
    for (std::size_t t = 0; t <= curve.degree; ++t) {
      curve.points[t] = curve.points[t] + shift_;
      largest = std::max(largest, largest_of(curve.points[t]));
    }
    curve.error = enlarged(curve.error + error_ + unit_roundoff * largest);
    return curve;
  }

  // The coefficients of det(f, f'), and that the angle is less than pi.
  bool add_curve(const FlatCurve& f) {
    const std::size_t d = f.degree;
    double largest = 0, widest = 0;
    for (std::size_t i = 0; i <= d; ++i) {
      largest = std::max(largest, largest_of(f.points[i]));
      if (i > 0) widest = std::max(widest, largest_of(f.points[i] - f.points[i - 1]));
    }
    const double step_error = 2 * f.error + unit_roundoff * widest;
    const double off = enlarged(2 * (f.error * widest + largest * step_error + f.error * step_error) +
                                gamma_bound(4 * max_degree) * 2 * largest * widest);
    for (std::size_t k = 0; k < 2 * d; ++k) {
      double sum = 0, weights = 0;
      for (std::size_t i = k < d ? 0 : k + 1 - d; i <= std::min(k, d); ++i) {
        const double weight = binomial(d, i) * binomial(d - 1, k - i);
        sum += weight * cross(f.points[i], f.points[k - i + 1] - f.points[k - i]);
        weights += weight;
      }
      if (!(sum > weights * off)) return false;
    }
    return add_angle(f.points[0], f.points[d], std::span(f.points).first(d + 1), f.error);
  }

  // All points on one side of a line through the origin: the angle is that between the ends.
  bool add_angle(Point2 from, Point2 to, std::span<const Point2> all, double error) {
    const Point2 middle = from + to;
    const double reach = std::fabs(middle.x) + std::fabs(middle.y);
    for (const Point2& p : all) {
      if (!(dot(middle, p) > reach * (error + gamma_bound(4) * largest_of(p)))) return false;
    }
    const double least = std::min(std::sqrt(dot(from, from)), std::sqrt(dot(to, to)));
    if (!(least > 0x1p10 * error)) return false;
    angle_ += std::atan2(cross(from, to), dot(from, to)) + 4 * error / least + 0x1p-40;
    return true;
  }

  bool add_split(const FlatCurve& curve, unsigned levels) {
    const double angle = angle_;
    if (add_curve(curve)) return true;
    angle_ = angle;
    if (levels == 0) return false;
    FlatCurve first = curve, second = curve;
    const std::size_t d = curve.degree;
    for (std::size_t k = 1; k <= d; ++k) {
      for (std::size_t t = 0; t + k <= d; ++t)
        second.points[t] = 0.5 * (second.points[t] + second.points[t + 1]);
      first.points[k] = second.points[0];
    }
    double largest = 0;
    for (std::size_t t = 0; t <= d; ++t) largest = std::max(largest, largest_of(curve.points[t]));
    first.error = second.error = enlarged(curve.error + gamma_bound(2 * max_degree) * largest);
    return add_split(first, levels - 1) && add_split(second, levels - 1);
  }

  // Ring by ring, until one net stands for the directions of all that are left, and the hull of control points for where they are.
  bool add_rings(const RingDecay& tip, Patch at, unsigned corner, unsigned edge, unsigned levels) {
    const CornerRings rings(tip, at);
    const unsigned far = corner == edge ? (edge + 1) % 3 : edge;
    for (std::size_t ring = 0; ring < std::min(rings.count(), max_single_rings); ++ring) {
      std::vector<Patch> nets;
      for (const Patch& net : rings.all_further(ring)) nets.push_back(split(net, far));
      if (add_further(at, nets, edge, rings.axes(ring), rings.axis_off())) return true;
      if (!add(split(at, far), edge, levels)) return false;
      at = split(at, corner);
      at.path = {};
    }
    return false;
  }

  // The nets along these axes.
  bool add_further(const Patch& at, std::span<const Patch> nets, unsigned edge,
                   const std::array<Point2, 2>& axes, double axis_off) {
    if (!nets[0].kind->polynomial()) return false;
    std::vector<Point2> hull, moved;
    double largest = 0, size = 0, weight = 0;
    for (const Point2& axis : axes) weight = std::max(weight, std::fabs(axis.x) + std::fabs(axis.y));
    for (const Vector3& p : at.points) {
      hull.push_back({p.x + shift_.x, p.y + shift_.y});
      moved.push_back({dot(axes[0], hull.back()), dot(axes[1], hull.back())});
      size = std::max(size, largest_of(hull.back()));
      largest = std::max(largest, largest_of(moved.back()));
    }
    const double hull_error = enlarged(at.error + error_ + unit_roundoff * size);
    const double error =
        enlarged(weight * (1 + 2 * axis_off) * (hull_error + (2 * axis_off + gamma_bound(3)) * size));
    const auto turns = [&](const FlatCurve& curve) {
      for (std::size_t t = 0; t < curve.degree; ++t) {
        const Point2 step = curve.points[t + 1] - curve.points[t];
        const double step_error = 2 * curve.error + unit_roundoff * largest_of(step);
        const double off = enlarged(2 * (largest * step_error + error * (largest_of(step) + step_error)) +
                                    gamma_bound(3) * 2 * largest * largest_of(step));
        for (const Point2& p : moved) {
          if (!(cross(p, step) > off)) return false;
        }
      }
      return true;
    };
    for (const Patch& net : nets) {
      if (!each_curve(net, edge, turns)) return false;
    }
    const std::array<Vector3, 3> ends = limit_corners(at);
    const auto end = [&](unsigned k) { return Point2{ends[k].x, ends[k].y} + shift_; };
    return add_angle(end(edge), end((edge + 1) % 3), hull,
                     enlarged(hull_error + at.kind->corner_limits().result_error(at.largest, at.error)));
  }

  Point2 shift_;
  double error_ = 0, angle_ = 0;
};

Point2 mirrored(Point2 p) { return {-p.x, p.y}; }

// The vectors that a star is seen along.
using Frame = std::array<Vector3, 2>;

double weight_of(const Frame& frame) {
  double weight = 0;
  for (const Vector3& axis : frame)
    weight = std::max(weight, std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
  return weight;
}

// Control values along two vectors, each of which the exact one is this near to.
Patch seen(const Patch& patch, const Frame& frame, double off) {
  Patch flat;
  flat.kind = patch.kind;
  flat.first = patch.first;
  flat.points.reserve(patch.points.size());
  for (const Vector3& p : patch.points) {
    const Vector3 value{dot(frame[0], p), dot(frame[1], p), 0};
    flat.largest = std::max(flat.largest, max_abs(value));
    flat.points.push_back(value);
  }
  flat.error = enlarged(weight_of(frame) * (patch.error + gamma_bound(4) * patch.largest) +
                        2 * off * (patch.largest + patch.error)) +
               4 * underflow_error;
  return flat;
}

// Limit corners of a sector from its centre.
std::array<Vector3, 2> spokes_of(const StarSector& sector) {
  const std::array<Vector3, 3> limits = limit_corners(*sector.patch);
  const Vector3 c = limits[sector.centre];
  std::array spokes{limits[(sector.centre + 1) % 3] - c, limits[(sector.centre + 2) % 3] - c};
  if (sector.mirrored) std::swap(spokes[0], spokes[1]);
  return spokes;
}

// A sector from where its nets come again at the centre; none where they do not.
template <class Decay>
std::optional<Patch> at_tip(const StarSector& sector, const Decay& decay) {
  const auto centre = static_cast<unsigned>(sector.centre);
  Patch patch = *sector.patch;
  patch.path = {};
  for (unsigned levels = corner_levels; levels > 0 && !patch.kind->polynomial(); --levels) {
    if (const RingDecay* const tip = decay(*patch.kind)) {
      if (corner_of(*tip, patch) != centre) return std::nullopt;
      return patch;
    }
    patch = split(patch, centre);
  }
  return std::nullopt;
}

// The same where the centre is a spike that is seen along.
std::optional<Patch> at_spike(const StarSector& sector) {
  const auto centre = static_cast<unsigned>(sector.centre);
  if (!sector.patch->kind->corner(sector.patch->to_kind(centre)).sharp) return std::nullopt;
  return at_tip(sector, decay_across_spike);
}

bool grows_along_one_direction(const RingDecay& decay) { return decay.larger || decay.links > 0; }

// Some vectors of a sector's pieces at its centre, near it and farther off. Where nets grow along one direction more than along others,
// what these tend to is among them. make(patch) of a piece, which is moved and scaled: as many each time, of so many lengths each, 0
// where they are little more than rounding.
template <class Make>
void add_of_rings(const StarSector& sector, int lengths, const Make& make, std::vector<Vector3>& vectors) {
  constexpr unsigned few = 4, many = 64;
  constexpr double growth = 1e-9;
  const std::optional<Patch> tip = at_tip(sector, decay_of);
  const RingDecay* const decay = tip ? decay_of(*tip->kind) : nullptr;
  const bool grows = decay != nullptr && grows_along_one_direction(*decay);
  Patch patch = *sector.patch;
  std::vector<Vector3> last;
  double scale = 1;  // over powers of the least eigenvalue
  for (unsigned level = 0; level <= (grows ? many : few); ++level) {
    const Vector3 centre = limit_corners(patch)[sector.centre];
    patch.largest = 0;
    for (Vector3& p : patch.points) {
      p = p - centre;
      patch.largest = std::max(patch.largest, max_abs(p));
    }
    if (!(patch.largest > 0)) return;
    for (Vector3& p : patch.points) p = (1 / patch.largest) * p;
    scale *= patch.largest;
    patch.largest = 1;
    patch.path = {};
    if ((level & (level - 1)) == 0) {
      std::vector<Vector3> now = make(patch);
      std::copy_if(now.begin(), now.end(), std::back_inserter(vectors),
                   [](const Vector3& v) { return !(v == Vector3{}); });
      for (Vector3& v : now) v = std::pow(scale, lengths) * v;
      if (level == many) {
        for (std::size_t i = 0; i < now.size(); ++i) {
          if (!(now[i] == Vector3{}) && length(now[i] - last[i]) > growth * length(now[i]))
            vectors.push_back(now[i] - last[i]);
        }
      }
      last = std::move(now);
    }
    patch = split(patch, static_cast<unsigned>(sector.centre));
    if (grows) scale /= middle(decay->least);
  }
}

// A direction that is on the side of each of some others, if the first one is hardly: towards the one that is farthest off, again and
// again.
Vector3 seen_by_all(const Vector3& first, const std::vector<Vector3>& normals) {
  constexpr double enough = 0.3;
  constexpr int steps = 400;
  std::vector<Vector3> units;
  for (const Vector3& normal : normals) units.push_back(normalized(normal));
  Vector3 at = first;
  for (int i = 0; i < steps; ++i) {
    double least = INFINITY;
    Vector3 farthest;
    for (const Vector3& unit : units) {
      const double along = dot(at, unit);
      if (along < least) {
        least = along;
        farthest = unit;
      }
    }
    if (i == 0 && least > enough * length(at)) return first;
    at = at + (1.0 / (i + 2)) * (farthest - at);
  }
  return normalized(at);
}

void add_further_normals(const StarSector& sector, std::vector<Vector3>& normals) {
  constexpr double certain = 1e-6;
  add_of_rings(
      sector, 2,
      [&](const Patch& patch) {
        const auto [a, b] = spokes_of({&patch, sector.centre, sector.mirrored});
        const Vector3 normal = cross(a, b);
        return std::vector{length(normal) > certain * length(a) * length(b) ? normal : Vector3{}};
      },
      normals);
}

class StarCheck {
 public:
  // Seen along a direction that suits this level, or all further ones, too.
  StarCheck(std::span<const StarSector> sectors, bool closed, bool further, bool balanced)
      : sectors_(sectors), closed_(closed), further_(further), balanced_(balanced) {}

  [[nodiscard]] bool certainly_injective() {
    if (sectors_.empty() || (closed_ && sectors_.size() < 3)) return false;
    if (!make_frame() || (further_ && spike_)) return false;
    for (const StarSector& sector : sectors_) {
      flat_.push_back(
          seen(*sector.patch, sector.mirrored ? Frame{-frame_[0], frame_[1]} : frame_, frame_off_));
    }
    // The cheapest first.
    return sectors_turn(true) && border_turns_once() && sectors_turn(false);
  }

 private:
  [[nodiscard]] bool sectors_turn(bool polynomial) const {
    for (std::size_t s = 0; s < flat_.size(); ++s) {
      if (flat_[s].kind->polynomial() != polynomial) continue;
      const auto centre = static_cast<unsigned>(sectors_[s].centre);
      if (!(spike_ ? turns_left_around_spike(flat_[s], centre) : turns_left_everywhere(flat_[s])))
        return false;
    }
    return true;
  }

  // Where the centre is a spike: what the row of the largest eigenvalue sees. Its direction is that of all sectors: its row is one of the
  // ring around the vertex, and simple. Each number of it is off by `error` at most.
  struct Spike {
    Vector3 along;
    double error;
  };
  [[nodiscard]] std::optional<Spike> spike() const {
    if (!closed_) return std::nullopt;
    std::optional<Patch> first;
    std::set<std::size_t> places;  // in a fan from one edge around to itself
    for (const StarSector& sector : sectors_) {
      std::optional<Patch> patch = at_spike(sector);
      if (!patch || sector.mirrored) return std::nullopt;
      const CornerFan& fan = patch->kind->corner(patch->to_kind(sector.centre));
      if (!first) first = std::move(patch);
      const CornerFan& of_first = first->kind->corner(first->to_kind(sectors_[0].centre));
      if (fan.odd != of_first.odd || fan.faces() != of_first.faces()) return std::nullopt;
      places.insert(fan.before);
    }
    const CornerFan& fan = first->kind->corner(first->to_kind(sectors_[0].centre));
    if (fan.odd && places.size() != fan.faces()) return std::nullopt;
    const RingDecay& tip = *decay_across_spike(*first->kind);
    Spike spike{{}, 0};
    double sum = 0;
    for (std::size_t i = 0; i < first->points.size(); ++i) {
      spike.along = spike.along + tip.spike_row[i] * first->points[i];
      sum += std::fabs(tip.spike_row[i]);
    }
    spike.error =
        enlarged((sum + tip.row_error) * first->error +
                 2 * (tip.row_error + gamma_bound(first->points.size() + 4) * sum) * first->largest);
    return spike;
  }

  // Along the mean normal; scaled so that the ring is about as long as wide.
  bool make_frame() {
    Vector3 normal;
    std::vector<Vector3> normals;
    for (const StarSector& sector : sectors_) {
      const auto [a, b] = spokes_of(sector);
      if (spokes_.empty()) spokes_.push_back(a);
      spokes_.push_back(b);
      normals.push_back(cross(a, b));
      normal = normal + normals.back();
      if (further_) add_further_normals(sector, normals);
    }
    if (closed_) spokes_.pop_back();
    std::optional<Spike> tip = spike();
    spike_ = tip.has_value();
    // Exact nets have nothing of the spike, whatever they are seen along.
    if (balanced_) tip.reset();
    normal = tip ? normalized(dot(normal, tip->along) < 0 ? -tip->along : tip->along)
                 : seen_by_all(normalized(normal), normals);
    if (normal == Vector3{}) return false;
    const Vector3 other = std::fabs(normal.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    const Vector3 x = normalized(cross(other, normal)), y = cross(normal, x);
    double xx = 0, xy = 0, yy = 0;
    for (const Vector3& spoke : spokes_) {
      const double u = dot(x, spoke), v = dot(y, spoke);
      xx += u * u;
      xy += u * v;
      yy += v * v;
    }
    if (!(xx > 0) || !(yy > 0)) return false;
    // Rows of the inverse of Cholesky's factor.
    const double rest = yy - xy * xy / xx;
    if (!(rest > 1e-6 * yy)) return false;
    const double first = 1 / std::sqrt(xx), second = 1 / std::sqrt(rest);
    frame_ = {first * x, second * (y - (xy / xx) * x)};
    if (tip) {
      // The exact vectors are across the spike, exactly: what they have along it is taken off.
      const double least = rounded_down(length(tip->along) * (1 - gamma_bound(8)) - 2 * tip->error);
      if (!(least > 0)) return false;
      for (const Vector3& axis : frame_) {
        const double seen =
            std::fabs(dot(axis, tip->along)) + gamma_bound(8) * length(axis) * length(tip->along);
        frame_off_ = std::max(frame_off_, enlarged((seen + 2 * tip->error * length(axis)) / least));
      }
    }
    return is_finite(frame_[0]) && is_finite(frame_[1]);
  }

  // Around the centre, unless that is on the border, or around a point that sees all of it.
  bool border_turns_once() const {
    return (closed_ && turns_once_around({})) || turns_once_around(seeing_point());
  }

  // A point to the left of all lines along the border, if there is one: away from that which is nearest, again and again.
  Point2 seeing_point() const {
    std::vector<std::array<Point2, 2>> lines;  // a point, and the direction to the left
    const auto add = [&](Point2 from, Point2 to) {
      const Point2 d = to - from;
      const double size = std::sqrt(dot(d, d));
      if (size > 0) lines.push_back({from, (1 / size) * Point2{-d.y, d.x}});
    };
    each_border_edge([&](std::size_t s, unsigned edge) {
      const std::array<Vector3, 3> ends = limit_corners(flat_[s]);
      const Vector3 c = ends[sectors_[s].centre];
      const auto add_step = [&](Point2 from, Point2 to) {
        const Point2 middle{c.x, c.y};
        if (sectors_[s].mirrored) {
          add(mirrored(to - middle), mirrored(from - middle));
        } else {
          add(from - middle, to - middle);
        }
      };
      const auto flat = [](const Vector3& p) { return Point2{p.x, p.y}; };
      add_step(flat(ends[edge]), flat(ends[(edge + 1) % 3]));
      TurnAround::each_step(flat_[s], edge, add_step);
      return true;
    });
    Point2 mean, point;
    for (const auto& line : lines) mean = mean + (1 / static_cast<double>(lines.size())) * line[0];
    double most = -INFINITY, step = 0.3;
    Point2 at = mean;
    for (int i = 0; i < 300; ++i, step *= 0.975) {
      double least = INFINITY;
      Point2 away;
      for (const auto& [on, left] : lines) {
        const double distance = dot(left, at - on);
        if (distance < least) {
          least = distance;
          away = left;
        }
      }
      if (least > most) {
        most = least;
        point = at;
      }
      at = at + step * away;
    }
    return point;
  }

  // visit(sector, edge) of each, counter-clockwise, but that a mirrored sector's edge is run along clockwise; the centre of an open star
  // is a point of its border, too.
  template <class Visit>
  bool each_border_edge(const Visit& visit) const {
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      const auto c = static_cast<unsigned>(sectors_[s].centre);
      const unsigned first = sectors_[s].mirrored ? (c + 2) % 3 : c, last = first == c ? (c + 2) % 3 : c;
      if (!closed_ && s == 0 && !visit(s, first)) return false;
      if (!visit(s, (c + 1) % 3)) return false;
      if (!closed_ && s + 1 == sectors_.size() && !visit(s, last)) return false;
    }
    return true;
  }

  // By the offset of a point from the centre.
  bool turns_once_around(Point2 point) const {
    TurnAround turn;
    const Patch& first = *sectors_.front().patch;
    const Vector3 centre = limit_corners(first)[sectors_.front().centre];
    const bool turns = each_border_edge([&](std::size_t s, unsigned edge) {
      const Vector3 offset = sectors_[s].patch->origin - first.origin;
      const Vector3 moved = offset - centre;
      const Point2 shift = Point2{dot(frame_[0], moved), dot(frame_[1], moved)} - point;
      const double error = enlarged((weight_of(frame_) * gamma_bound(8) + 2 * frame_off_) *
                                        (max_abs(offset) + max_abs(centre)) +
                                    gamma_bound(2) * (largest_of(shift) + largest_of(point)));
      // Seen in a mirror a clockwise curve is a counter-clockwise one.
      return turn.add(flat_[s], edge, sectors_[s].mirrored ? mirrored(shift) : shift, error);
    });
    return turns && turn.once();
  }

  std::span<const StarSector> sectors_;
  bool closed_, further_, balanced_;
  std::vector<Vector3> spokes_;  // closed: one a sector; open: one more
  bool spike_ = false;
  Frame frame_;
  double frame_off_ = 0;  // how far the exact vectors are from these
  std::vector<Patch> flat_;
};

// The control point that alone is a sector's vertex.
std::optional<std::size_t> point_in_place(const StarSector& sector) {
  const Patch& patch = *sector.patch;
  const Stencils::Row row = patch.kind->corner_limits().row(patch.to_kind(sector.centre));
  if (row.sources.size() != 1 || row.weights[0] != 1) return std::nullopt;
  return row.sources[0];
}

// Directions from the vertex to control points, or to corners of pieces nearer and nearer to it.
void add_directions(const StarSector& sector, double sign, bool by_rings, std::vector<Vector3>& directions) {
  if (!by_rings) {
    const std::vector<Vector3>& points = sector.patch->points;
    const std::size_t vertex = *point_in_place(sector);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (i != vertex) directions.push_back(sign * (points[i] - points[vertex]));
    }
    return;
  }
  add_of_rings(
      sector, 1,
      [&](const Patch& patch) {
        std::vector<Vector3> all;
        const Vector3 vertex = limit_corners(patch)[sector.centre];
        for (unsigned child = 0; child < 4; ++child) {
          if (child == sector.centre) continue;
          for (const Vector3& p : limit_corners(split(patch, child))) all.push_back(sign * (p - vertex));
        }
        return all;
      },
      directions);
}

// Is a sector, but for its vertex, on this side of a plane through that? Points are means of control points.
bool is_on_side(const StarSector& sector, const Vector3& across, bool by_rings) {
  const Patch& patch = *sector.patch;
  const std::size_t vertex = *point_in_place(sector);
  const double size = std::fabs(across.x) + std::fabs(across.y) + std::fabs(across.z);
  Patch values;
  values.kind = patch.kind;
  values.first = patch.first;
  double far = 0, least = INFINITY;
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const Vector3 d = patch.points[i] - patch.points[vertex];
    values.points.push_back({dot(across, d), 0, 0});
    values.largest = std::max(values.largest, std::fabs(values.points.back().x));
    far = std::max(far, max_abs(d));
    if (i != vertex) least = std::min(least, values.points.back().x);
  }
  values.error =
      enlarged(size * (2 * patch.error + (unit_roundoff + gamma_bound(4)) * far)) + underflow_error;
  return by_rings ? certainly_positive_but_at_corner(values, static_cast<unsigned>(sector.centre))
                  : least > values.error;
}

}  // namespace

bool stays_in_place(const StarSector& sector) { return point_in_place(sector).has_value(); }

// A plane through the vertex with the one on its one side, and the other on the other: by all their control points, or ring by ring.
bool certainly_meet_only_at_vertex(const StarSector& a, const StarSector& b) {
  if (!stays_in_place(a) || !stays_in_place(b)) return false;
  for (const bool by_rings : {false, true}) {
    std::vector<Vector3> directions;
    add_directions(a, 1, by_rings, directions);
    add_directions(b, -1, by_rings, directions);
    Vector3 sum;
    for (const Vector3& d : directions) sum = sum + normalized(d);
    const Vector3 across = seen_by_all(sum, directions);
    if (is_on_side(a, across, by_rings) && is_on_side(b, -across, by_rings)) return true;
  }
  return false;
}

bool certainly_injective(std::span<const StarSector> sectors, bool closed, bool balanced) {
  const auto grows = [](const StarSector& sector) {
    const std::optional<Patch> tip = at_tip(sector, decay_of);
    return tip && grows_along_one_direction(*decay_of(*tip->kind));
  };
  return StarCheck(sectors, closed, false, balanced).certainly_injective() ||
         (std::any_of(sectors.begin(), sectors.end(), grows) &&
          StarCheck(sectors, closed, true, balanced).certainly_injective());
}

}  // namespace snug
