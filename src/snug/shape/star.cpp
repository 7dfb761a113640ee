#include <snug/shape/star.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/scheme/bezier.h>
#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/corner_rings.h>
#include <snug/shape/point2.h>
#include <support/direction.h>

namespace snug {
namespace {

// Directions of the layout that are tried, and how many of the most promising are tried in full.
constexpr int directions = 12, tried_layouts = 4;
// Edges of the border that are less steep, and lead to its top or bottom, are laid out level there.
constexpr std::array<double, 3> level_slopes{0, 0.35, 0.6};
// Levels that a piece is split to bound its coefficients.
constexpr unsigned polynomial_levels = 2, decay_levels = 6;
// Of a net that stands for all further rings, against its size: more would hardly do.
constexpr double max_net_share = 0.02;
// Layouts have so many bits: differences of their numbers, halves and products of two differences are exact.
constexpr double layout_grain = 0x1p-20;

// A sector as it is seen along two vectors: control values (f1, f2, 0), its triangle in the layout, and which
// of its edges lie on the border of the star: bit k the one from corner k to k + 1.
struct FlatSector {
  Patch patch;
  std::array<Point2, 3> place;
  unsigned border = 0;
};

// Differences along one edge of the parameters' triangle, by Bezier points.
struct FlatDerivatives {
  std::size_t count = 0;
  std::array<Point2, bezier_count(max_degree - 1)> u, v;
  double largest = 0;
  double error = 0;  // of each number
};

using BezierPoints = std::array<Point2, bezier_count(max_degree)>;

FlatDerivatives derivatives_of(const BezierPoints& points, std::size_t degree, double error) {
  FlatDerivatives result;
  for (std::size_t j = 0; j < degree; ++j) {
    for (std::size_t i = 0; i + j < degree; ++i) {
      const Point2 at = points[bezier_index(degree, i, j)];
      const Point2 u = points[bezier_index(degree, i + 1, j)] - at,
                   v = points[bezier_index(degree, i, j + 1)] - at;
      result.u[result.count] = u;
      result.v[result.count++] = v;
      result.largest =
          std::max({result.largest, std::fabs(u.x), std::fabs(u.y), std::fabs(v.x), std::fabs(v.y)});
    }
  }
  result.error = enlarged(2 * error + unit_roundoff * result.largest);
  return result;
}

// Condition (ii): the determinant's coefficients, each the sum of those of two orders.
bool turns_left(const FlatDerivatives& d) {
  const double limit = enlarged(4 * (2 * d.error * d.largest + d.error * d.error) +
                                gamma_bound(6) * 4 * d.largest * d.largest);
  for (std::size_t k = 0; k < d.count; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      if (!(cross(d.u[k], d.v[l]) + cross(d.u[l], d.v[k]) > limit)) return false;
    }
  }
  return true;
}

// Axes of the layout, turned: f1 along `along`, f2 a quarter turn on.
struct Turn {
  double c = 1, s = 0;
  [[nodiscard]] double first(Point2 p) const { return c * p.x + s * p.y; }
  [[nodiscard]] double second(Point2 p) const { return c * p.y - s * p.x; }
};

// Conditions (i) and (iii) of a polynomial on a triangle with these sides from its corner 0, in the layout.
bool grows(const FlatDerivatives& d, const Turn& turn, Point2 a, Point2 b) {
  // |c| + |s| < 1.5.
  const double error = enlarged(1.5 * d.error + gamma_bound(4) * 1.5 * d.largest), largest = 1.5 * d.largest;
  const double reach = std::fabs(a.y) + std::fabs(b.y);
  const double limit = enlarged(reach * error + gamma_bound(4) * reach * (largest + error));
  for (std::size_t k = 0; k < d.count; ++k) {
    if (!(b.y * turn.first(d.u[k]) - a.y * turn.first(d.v[k]) > limit)) return false;
  }
  return true;
}

bool rises(const BezierPoints& points, std::size_t degree, std::size_t edge, double error, const Turn& turn,
           double sign) {
  const auto at = [&](std::size_t t) {
    return points[edge == 0   ? bezier_index(degree, t, 0)
                  : edge == 1 ? bezier_index(degree, degree - t, t)
                              : bezier_index(degree, 0, degree - t)];
  };
  for (std::size_t t = 0; t < degree; ++t) {
    const Point2 step = at(t + 1) - at(t);
    const double size = std::max(std::fabs(step.x), std::fabs(step.y));
    const double limit = enlarged(1.5 * (2 * error + unit_roundoff * size) + gamma_bound(4) * 1.5 * size);
    if (!(sign * turn.second(step) > limit)) return false;
  }
  return true;
}

// A condition on all pieces of a sector: (ii), or (i) and (iii) for one turn.
struct Condition {
  const Turn* turn = nullptr;  // none: (ii)
};

const CharacteristicMap* map_of(const Kind& kind) {
  return kind.polynomial() ? nullptr : asymptotics_of(kind).characteristic_map();
}

class SectorCheck {
 public:
  SectorCheck(const Condition& condition, const std::array<Point2, 3>& place)
      : condition_(condition), place_(place) {}

  [[nodiscard]] bool holds(const Patch& patch, unsigned border) {
    // The star's axes suit corners of its own pieces alone.
    const CharacteristicMap* const tip = map_of(*patch.kind);
    if (tip != nullptr) return tip_holds(*tip, patch, border, 1, decay_levels);
    return holds(patch, border, 1, patch.kind->polynomial() ? 1 : decay_levels);
  }

 private:
  // `side`: 1, or -1 for a piece that lies in the layout half a turn around.
  bool holds(const Patch& patch, unsigned border, double side, unsigned levels) {
    if (patch.kind->polynomial()) return polynomial_holds(patch, border, side, levels);
    if (levels == 0) return false;
    if (const CharacteristicMap* tip = map_of(*patch.kind)) {
      return tip->conformal() && tip_holds(*tip, patch, border, side, levels - 1);
    }
    for (unsigned child = 0; child < 4; ++child) {
      if (!child_holds(patch, child, border, side, levels - 1)) return false;
    }
    return true;
  }

  bool child_holds(const Patch& patch, unsigned child, unsigned border, double side, unsigned levels) {
    const Patch piece = split(patch, child);
    // The edge across a corner lies inside.
    const unsigned own = child == 3 ? 0u : border & ~(1u << ((child + 1) % 3));
    if (piece.kind->polynomial()) levels = std::min(levels, polynomial_levels);
    return holds(piece, own, child == 3 ? -side : side, levels);
  }

  bool tip_holds(const CharacteristicMap& tip, const Patch& patch, unsigned border, double side,
                 unsigned levels) {
    const auto corner = static_cast<unsigned>((tip.corner() + patch.first) % 3);
    const auto ring_holds = [&](const Patch& net) {
      for (unsigned child = 0; child < 4; ++child) {
        if (child != corner && !child_holds(net, child, border, side, levels)) return false;
      }
      return true;
    };
    const CornerRings rings(tip, patch);
    for (std::size_t ring = 0; ring < rings.count(); ++ring) {
      const Patch further = rings.all_further(ring);
      if (further.error < max_net_share * further.largest && ring_holds(further)) return true;
      if (!ring_holds(rings.net(ring))) return false;
      border &= ~(1u << ((corner + 1) % 3));
    }
    return false;
  }

  bool polynomial_holds(const Patch& patch, unsigned border, double side, unsigned levels) {
    if (coefficients_hold(patch, border, side)) return true;
    if (levels == 0) return false;
    for (unsigned child = 0; child < 4; ++child) {
      if (!child_holds(patch, child, border, side, levels - 1)) return false;
    }
    return true;
  }

  bool coefficients_hold(const Patch& patch, unsigned border, double side) const {
    const BezierRows& form = patch.kind->form();
    const std::size_t count = bezier_count(form.degree);
    const double error = form.rows.result_error(patch.largest, patch.error);
    std::array<Point2, 3> corners;  // in the kind's order
    for (std::size_t k = 0; k < 3; ++k) corners[patch.to_kind(k)] = place_[k];
    for (std::size_t part = 0; part < form.parts; ++part) {
      BezierPoints points;
      for (std::size_t i = 0; i < count; ++i) {
        const Vector3 p = form.rows.apply<Vector3>(part * count + i, patch.points);
        points[i] = {p.x, p.y};
      }
      const FlatDerivatives d = derivatives_of(points, form.degree, error);
      if (condition_.turn == nullptr) {
        if (!turns_left(d)) return false;
        continue;
      }
      const std::array<Point2, 3> own = part_corners(corners, form.parts, part);
      const Point2 a = own[1] - own[0], b = own[2] - own[0];
      if (!grows(d, *condition_.turn, {0, side * a.y}, {0, side * b.y})) return false;
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if ((border >> ((edge + patch.first) % 3) & 1u) == 0) continue;
        if (form.parts == 2 && ((edge == 0 && part == 1) || (edge == 1 && part == 0))) continue;
        const double dy = side * (corners[(edge + 1) % 3].y - corners[edge].y);
        if (dy != 0 && !rises(points, form.degree, edge, error, *condition_.turn, dy > 0 ? 1.0 : -1.0))
          return false;
      }
    }
    return true;
  }

  // Two parts are 0, 1, m and m, 1, 2; m is the middle of the edge 02.
  static std::array<Point2, 3> part_corners(const std::array<Point2, 3>& c, std::size_t parts,
                                            std::size_t part) {
    if (parts == 1) return c;
    const Point2 m{0.5 * c[0].x + 0.5 * c[2].x, 0.5 * c[0].y + 0.5 * c[2].y};
    return part == 0 ? std::array{c[0], c[1], m} : std::array{m, c[1], c[2]};
  }

  const Condition& condition_;
  const std::array<Point2, 3>& place_;
};

// The vectors that a star is seen along, and by how much the exact ones that are meant may differ.
struct Frame {
  std::array<Vector3, 2> axes;
  double error = 0;  // largest length of what one of them is off
};

// Control values along two vectors.
Patch seen(const Patch& patch, const Frame& frame) {
  Patch flat;
  flat.kind = patch.kind;
  flat.first = patch.first;
  flat.points.reserve(patch.points.size());
  double weight = 0;
  for (const Vector3& axis : frame.axes) {
    weight = std::max(weight, std::fabs(axis.x) + std::fabs(axis.y) + std::fabs(axis.z));
  }
  for (const Vector3& p : patch.points) {
    const Vector3 value{dot(frame.axes[0], p), dot(frame.axes[1], p), 0};
    flat.largest = std::max(flat.largest, max_abs(value));
    flat.points.push_back(value);
  }
  flat.error = enlarged(weight * (patch.error + gamma_bound(4) * patch.largest) +
                        spatial_error(patch.largest + patch.error) * frame.error) +
               4 * underflow_error;
  return flat;
}

// Limit corners of a sector from its centre.
std::array<Vector3, 2> spokes_of(const StarSector& sector) {
  const std::array<Vector3, 3> limits = limit_corners(*sector.patch);
  const Vector3 c = limits[sector.centre];
  return {limits[(sector.centre + 1) % 3] - c, limits[(sector.centre + 2) % 3] - c};
}

class StarCheck {
 public:
  StarCheck(std::span<const StarSector> sectors, bool closed) : sectors_(sectors), closed_(closed) {}

  [[nodiscard]] bool certainly_injective() {
    if (sectors_.empty() || (closed_ && sectors_.size() < 3)) return false;
    if (!make_frame()) return false;
    for (const StarSector& sector : sectors_) flat_.push_back({seen(*sector.patch, frame_), {}, 0});
    const Condition determinant;
    for (FlatSector& sector : flat_) {
      if (!SectorCheck(determinant, sector.place).holds(sector.patch, 0)) return false;
    }
    return monotone();
  }

 private:
  // Along the mean normal; scaled so that the ring is about as long as wide.
  bool make_frame() {
    Vector3 normal;
    for (const StarSector& sector : sectors_) {
      const auto [a, b] = spokes_of(sector);
      if (spokes_.empty() || !closed_) {
        if (spokes_.empty()) spokes_.push_back(a);
      }
      spokes_.push_back(b);
      normal = normal + cross(a, b);
    }
    if (closed_) spokes_.pop_back();
    normal = normalized(normal);
    if (normal == Vector3{}) return false;
    const Vector3 other = std::fabs(normal.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    Vector3 x = normalized(cross(other, normal)), y = cross(normal, x);
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
    frame_.axes = {first * x, second * (y - (xy / xx) * x)};
    return is_finite(frame_.axes[0]) && is_finite(frame_.axes[1]) && suit_tips();
  }

  // A corner whose two tangents shrink at different rates wants axes of its own: the second one exactly across
  // the tangent along the border or crease, where that shrinks less; the first one exactly across the tangent
  // across these, where that one does.
  bool suit_tips() {
    struct Tip {
      const Patch* patch;
      std::size_t corner, dominant;  // the corner as the kind counts
      std::array<Vector3, 2> tangents;
      std::array<double, 2> errors;  // spatial
    };
    std::vector<Tip> found;
    std::optional<std::size_t> at;
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      const Patch& patch = *sectors_[s].patch;
      const CharacteristicMap* limit = map_of(*patch.kind);
      if (limit == nullptr || limit->conformal()) continue;
      const std::size_t corner = (limit->corner() + patch.first) % 3;
      const std::size_t after = (corner + 3 - sectors_[s].centre) % 3;
      const std::size_t vertex = after == 0 ? SIZE_MAX : (s + after - 1) % spokes_.size();
      if (at && *at != vertex) return false;
      at = vertex;
      Tip tip{&patch, limit->corner(), limit->dominant(), {}, {}};
      const Stencils& rows = patch.kind->corner_tangents();
      for (std::size_t t = 0; t < 2; ++t) {
        const Stencils::Row row = rows.row(2 * tip.corner + t);
        const double row_error =
            CharacteristicMap::row_error(row) + gamma_bound(row.sources.size() + 2) * row.abs_sum;
        tip.tangents[t] = rows.apply<Vector3>(2 * tip.corner + t, patch.points);
        tip.errors[t] =
            spatial_error(enlarged(row_error * patch.largest + (row.abs_sum + row_error) * patch.error));
        if (!(length(tip.tangents[t]) > 0x1p20 * tip.errors[t])) return false;
      }
      found.push_back(tip);
    }
    if (found.empty()) return true;
    // All sectors around one vertex have the same tangent along its border or crease, but for its length; the
    // same one across it only on one side of a crease. Around the vertex a side ends once.
    std::vector<const Tip*> across;
    for (const Tip& tip : found) {
      if (tip.dominant == 1) across.push_back(&tip);
    }
    std::size_t ends = 0;
    for (std::size_t i = 0; i < across.size(); ++i) {
      const CornerFan& fan = across[i]->patch->kind->corner(across[i]->corner);
      const Tip& next = *across[(i + 1) % across.size()];
      if (fan.faces() < 3) return false;
      if (!beside(fan, next.patch->kind->corner(next.corner))) ++ends;
    }
    if (ends > 1) return false;
    // Dual to the tangents.
    const std::array<Vector3, 2>& tangents = (across.empty() ? &found.front() : across.front())->tangents;
    const Vector3 normal = cross(tangents[0], tangents[1]);
    const Vector3 x = normalized(cross(tangents[1], normal)), y = normalized(cross(normal, tangents[0]));
    if (x == Vector3{} || y == Vector3{}) return false;
    double xx = 0, yy = 0;
    for (const Vector3& spoke : spokes_) {
      xx += dot(x, spoke) * dot(x, spoke);
      yy += dot(y, spoke) * dot(y, spoke);
    }
    if (!(xx > 0) || !(yy > 0)) return false;
    frame_.axes = {(1 / std::sqrt(xx)) * x, (1 / std::sqrt(yy)) * y};
    if (dot(cross(frame_.axes[0], frame_.axes[1]), cross_of_spokes()) < 0) frame_.axes[0] = -frame_.axes[0];
    turned_ = false;
    // |n . t| / |t| of the exact tangent t: the exact axis that is meant is this far from n.
    for (const Tip& tip : found) {
      const Vector3& axis = frame_.axes[1 - tip.dominant];
      const Vector3& tangent = tip.tangents[tip.dominant];
      const double off = tip.errors[tip.dominant] / length(tangent);
      frame_.error = std::max(frame_.error, enlarged(std::fabs(dot(axis, normalized(tangent))) +
                                                     length(axis) * (2 * off + gamma_bound(32))));
    }
    return true;
  }

  // Are sectors next to each other on the same side of all creases, or halves of the same quad? With three
  // faces and more on a side no last face of one side looks like the neighbour of the first one of the other.
  static bool beside(const CornerFan& a, const CornerFan& b) {
    return a == b || (a.before + 1 == b.before && a.after == b.after + 1) ||
           (b.before + 1 == a.before && b.after == a.after + 1);
  }

  Vector3 cross_of_spokes() const {
    Vector3 normal;
    for (const StarSector& sector : sectors_) {
      const auto [a, b] = spokes_of(sector);
      normal = normal + cross(a, b);
    }
    return normal;
  }

  // Places of the spokes' ends, turned; edges near the top and the bottom less steep than `slope` are level.
  // False for no layout: the border's heights must rise once and fall once.
  bool lay_out(const Turn& turn, double slope, std::vector<Point2>& ring) const {
    double largest = 0;
    ring.clear();
    for (const Vector3& spoke : spokes_) {
      const Point2 p{dot(frame_.axes[0], spoke), dot(frame_.axes[1], spoke)};
      ring.push_back({turn.first(p), turn.second(p)});
      largest = std::max({largest, std::fabs(ring.back().x), std::fabs(ring.back().y)});
    }
    if (!(largest > 1e-100) || !(largest < 1e100)) return false;
    const double grain = std::exp2(std::ceil(std::log2(largest))) * layout_grain;
    for (Point2& p : ring) p = {grain * std::round(p.x / grain), grain * std::round(p.y / grain)};
    // The centre of an open star is a point of its border, too.
    if (!closed_) ring.push_back({});
    if (slope > 0) {
      make_level(slope, 1, ring);
      make_level(slope, -1, ring);
    }
    const bool shaped = rises_once(ring);
    if (!closed_) ring.pop_back();
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      if (!(cross(ring[s], ring[(s + 1) % ring.size()]) > 0)) return false;
    }
    return shaped;
  }

  // Raises (for side 1) what the top is reached from by edges that are less steep. The centre stays.
  void make_level(double slope, double side, std::vector<Point2>& border) const {
    const std::size_t n = border.size();
    std::size_t top = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (side * border[i].y > side * border[top].y) top = i;
    }
    double height = border[top].y;
    std::vector<std::size_t> raised;
    for (const std::size_t step : {std::size_t{1}, n - 1}) {
      for (std::size_t k = 0, at = top; k + 2 < n; ++k) {
        const std::size_t next = (at + step) % n;
        const double dx = border[next].x - border[at].x, dy = border[next].y - border[at].y;
        if (std::fabs(dy) >= slope * std::hypot(dx, dy)) break;
        raised.push_back(next);
        at = next;
      }
    }
    if (!closed_ && (top == n - 1 || std::find(raised.begin(), raised.end(), n - 1) != raised.end()))
      height = 0;
    border[top].y = height;
    for (const std::size_t i : raised) border[i].y = height;
  }

  // Once around, do the heights go up once and down once, with level edges at the top and the bottom alone?
  static bool rises_once(const std::vector<Point2>& border) {
    const std::size_t n = border.size();
    double least = INFINITY, most = -INFINITY;
    for (const Point2& p : border) {
      least = std::min(least, p.y);
      most = std::max(most, p.y);
    }
    std::size_t turns = 0;
    double before = 0;  // the last direction but level; of the first edge it is found going around
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const double from = border[i % n].y, to = border[(i + 1) % n].y;
      if (from == to) {
        if (from != least && from != most) return false;
        continue;
      }
      const double now = to > from ? 1 : -1;
      if (i >= n && now != before) ++turns;
      before = now;
    }
    return turns == 2;
  }

  // The least slope of an edge of the border that is not level.
  double steepness(const std::vector<Point2>& ring) const {
    double least = 1;
    const auto add = [&](Point2 a, Point2 b) {
      if (a.y != b.y) least = std::min(least, std::fabs(b.y - a.y) / std::hypot(b.x - a.x, b.y - a.y));
    };
    for (std::size_t s = 0; s < sectors_.size(); ++s) add(ring[s], ring[(s + 1) % ring.size()]);
    if (!closed_) {
      add({}, ring.front());
      add({}, ring.back());
    }
    return least;
  }

  // By so many parts of a half turn; exactly, by quarters.
  static Turn turn_of(int parts) {
    constexpr std::array<Turn, 4> quarters{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    if (parts % (directions / 2) == 0) return quarters[static_cast<std::size_t>(2 * parts / directions)];
    const double angle = std::numbers::pi * parts / directions;
    return {std::cos(angle), std::sin(angle)};
  }

  bool monotone() {
    struct Trial {
      double steepness;
      Turn turn;
      double slope;
    };
    std::vector<Trial> trials;
    std::vector<Point2> ring;
    for (const double slope : level_slopes) {
      for (int d = 0; d < 2 * directions; ++d) {
        if (!turned_ && d % (directions / 2) != 0) continue;
        const Turn turn = turn_of(d);
        // Level edges are not where they are seen: a larger slope counts against the layout.
        if (lay_out(turn, slope, ring)) trials.push_back({steepness(ring) - 0.5 * slope, turn, slope});
      }
    }
    std::stable_sort(trials.begin(), trials.end(),
                     [](const Trial& a, const Trial& b) { return a.steepness > b.steepness; });
    if (trials.size() > tried_layouts) trials.resize(tried_layouts);
    return std::any_of(trials.begin(), trials.end(), [&](const Trial& trial) {
      static_cast<void>(lay_out(trial.turn, trial.slope, ring));
      return monotone(trial.turn, ring);
    });
  }

  bool monotone(const Turn& turn, const std::vector<Point2>& ring) {
    const std::size_t n = sectors_.size();
    for (std::size_t s = 0; s < n; ++s) {
      const std::size_t c = sectors_[s].centre;
      flat_[s].place[c] = {};
      flat_[s].place[(c + 1) % 3] = ring[s];
      flat_[s].place[(c + 2) % 3] = ring[(s + 1) % ring.size()];
      flat_[s].border = 1u << ((c + 1) % 3);
      if (!closed_ && s == 0) flat_[s].border |= 1u << c;
      if (!closed_ && s + 1 == n) flat_[s].border |= 1u << ((c + 2) % 3);
    }
    const Condition condition{&turn};
    return std::all_of(flat_.begin(), flat_.end(), [&](const FlatSector& sector) {
      return SectorCheck(condition, sector.place).holds(sector.patch, sector.border);
    });
  }

  std::span<const StarSector> sectors_;
  bool closed_, turned_ = true;
  std::vector<Vector3> spokes_;  // closed: one a sector; open: one more
  Frame frame_;
  std::vector<FlatSector> flat_;
};

}  // namespace

bool certainly_injective(std::span<const StarSector> sectors, bool closed) {
  return StarCheck(sectors, closed).certainly_injective();
}

}  // namespace snug
