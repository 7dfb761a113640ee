#include <snug/shape/star_distortion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/scheme/bezier.h>
#include <snug/shape/corner_asymptotics.h>
#include <snug/shape/point2.h>
#include <support/direction.h>

namespace snug {
namespace {

// Layouts have integers of so many bits: differences of them and products of two differences are exact.
constexpr double layout_size = 0x1p20;
// How much a layout is bent to be convex where the surface's ring has straight angles: points far from the
// centre come nearer, the centre of an open star goes outwards.
constexpr double bend = 0.05;
// Points at reflex angles are pushed outwards, at most this far.
constexpr double max_push = 1.6;
// Least sine of an angle, and least length of two sides, of a piece in the layout.
constexpr double min_sine = 0.02, min_side = 0x1p10;
// Rounding and the layout's own error, against products of sizes: see derivations/self_contact.md.
constexpr double layout_slack = 0x1p-20;
constexpr unsigned max_net_rings = 40, plain_levels = 2;
// Largest factor by which a net that stands for all further rings may widen the bounds of those before: its error
// shrinks from ring to ring.
constexpr double widening = 1.3;
// Eigenvalues are known this well, and equal ones are equal up to this.
constexpr double eigenvalue_error = 1e-10, same_eigenvalue = 1e-9;

double size_of(Point2 a) { return std::hypot(a.x, a.y); }

using Places = std::array<Point2, 3>;

// Sides of triangles at a corner are cut here: in halves, or by the eigenvalue of a corner.
struct Cut {
  std::optional<std::size_t> tip;
  double eigenvalue = 0.5;
  [[nodiscard]] Point2 between(const Places& p, std::size_t i, std::size_t k) const {
    if (tip == i) return p[i] + eigenvalue * (p[k] - p[i]);
    if (tip == k) return p[k] + eigenvalue * (p[i] - p[k]);
    return 0.5 * (p[i] + p[k]);
  }
  // Where a child lies (PiecePath).
  [[nodiscard]] Places child(const Places& p, std::size_t which) const {
    if (which == 3) return {between(p, 1, 2), between(p, 0, 2), between(p, 0, 1)};
    Places places;
    for (std::size_t k = 0; k < 3; ++k) places[k] = k == which ? p[k] : between(p, which, k);
    return places;
  }
};

// Bounds of the derivatives of a star after its layout: seen along the layout's plane they lead at least `least`
// onwards in each direction, and they are at most `most` long.
struct Derivatives {
  double least = INFINITY, most = 0;
  void add(const Derivatives& other) {
    least = std::min(least, other.least);
    most = std::max(most, other.most);
  }
};
constexpr Derivatives unknown{-INFINITY, INFINITY};

// Those of one coefficient, given by its columns, up to an error of the matrix.
Derivatives derivatives_of(const Vector3& x, const Vector3& y, double error) {
  const double mean = 0.5 * (x.x + y.y), skew = std::hypot(0.5 * (x.x - y.y), 0.5 * (x.y + y.x));
  const double xx = dot(x, x), yy = dot(y, y), xy = dot(x, y);
  const double longest = std::sqrt(0.5 * (xx + yy) + std::hypot(0.5 * (xx - yy), xy));
  return {mean - skew - error, enlarged(longest + error)};
}

class StretchCheck {
 public:
  StretchCheck(std::span<const StarSector> sectors, bool closed) : sectors_(sectors), closed_(closed) {}

  [[nodiscard]] double stretch() {
    if (sectors_.empty() || (closed_ && sectors_.size() < 3)) return INFINITY;
    if (!find_cuts() || !make_frame() || !lay_out()) return INFINITY;
    Derivatives all;
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      all.add(of_sector(s));
      if (!(all.least > 0)) return INFINITY;
    }
    // The axes are orthonormal up to some roundings.
    const double stretch = (1 + layout_slack) * all.most / all.least;
    return std::isfinite(stretch) ? stretch : INFINITY;
  }

 private:
  // Where sectors' sides are cut, the same way in both sectors beside a spoke.
  bool find_cuts() {
    for (const StarSector& sector : sectors_) {
      const Patch& patch = *sector.patch;
      Cut cut;
      if (!patch.kind->polynomial()) {
        // Half a quad whose fourth corner alone is extraordinary has no tip: a few splits make it polynomial.
        const CharacteristicMap* const tip = asymptotics_of(*patch.kind).characteristic_map();
        if (tip == nullptr) {
          cuts_.push_back(cut);
          continue;
        }
        if (!tip->conformal()) return false;
        const Interval value = tip->eigenvalue();
        if (!(value.upper - value.lower < eigenvalue_error)) return false;
        cut.tip = (tip->corner() + patch.first) % 3;
        cut.eigenvalue = middle(value);
      }
      cuts_.push_back(cut);
    }
    const std::size_t n = sectors_.size();
    const auto at = [&](std::size_t s, std::size_t corner) {
      return cuts_[s].tip == (sectors_[s].centre + corner) % 3 ? cuts_[s].eigenvalue : 0.5;
    };
    for (std::size_t s = 0; s < n; ++s) {
      const std::size_t next = (s + 1) % n;
      if (std::fabs(at(s, 0) - at(next, 0)) > same_eigenvalue) return false;
      if (next == 0 && !closed_) continue;
      if (std::fabs(at(s, 2) - at(next, 1)) > same_eigenvalue) return false;
    }
    return true;
  }

  // Along the mean normal; the ring as it is seen from there.
  bool make_frame() {
    Vector3 normal;
    std::vector<Vector3> spokes;
    for (const StarSector& sector : sectors_) {
      const std::array<Vector3, 3> limits = limit_corners(*sector.patch);
      const Vector3 c = limits[sector.centre], a = limits[(sector.centre + 1) % 3] - c,
                    b = limits[(sector.centre + 2) % 3] - c;
      if (spokes.empty()) spokes.push_back(a);
      spokes.push_back(b);
      normal = normal + cross(a, b);
    }
    if (closed_) spokes.pop_back();
    normal = normalized(normal);
    if (normal == Vector3{}) return false;
    const Vector3 other = std::fabs(normal.x) < 0.6 ? Vector3{1, 0, 0} : Vector3{0, 1, 0};
    axes_[0] = normalized(cross(other, normal));
    axes_[1] = cross(normal, axes_[0]);
    axes_[2] = normal;
    for (const Vector3& spoke : spokes) ring_.push_back({dot(axes_[0], spoke), dot(axes_[1], spoke)});
    return true;
  }

  // The ring and the centre as integers. False unless they make a convex polygon, cut into a fan.
  bool lay_out() {
    double largest = 0;
    Point2 mean;
    for (const Point2& p : ring_) {
      largest = std::max(largest, size_of(p));
      mean = mean + (1 / static_cast<double>(ring_.size())) * p;
    }
    if (!(largest > 1e-100) || !(largest < 1e100)) return false;
    const auto whole = [](Point2 p) { return Point2{std::round(p.x), std::round(p.y)}; };
    for (Point2& p : ring_) {
      const double far = size_of(p) / largest;
      p = whole(layout_size / largest / (1 + bend * far * far) * p);
    }
    if (!closed_) centre_ = whole(-bend * layout_size / largest * mean);
    for (int pass = 0; pass < 3; ++pass) {
      for (std::size_t i = closed_ ? 0 : 1; i + (closed_ ? 0 : 1) < ring_.size(); ++i) {
        Point2& p = ring_[i];
        const Point2 before = ring_[(i + ring_.size() - 1) % ring_.size()];
        const Point2 chord = ring_[(i + 1) % ring_.size()] - before;
        // Where its ray leaves the triangle with its neighbours; 1.02: with a margin.
        const double far = cross(before - centre_, chord) / cross(p - centre_, chord);
        if (far > 0.99 && far < max_push) p = whole(centre_ + 1.02 * far * (p - centre_));
      }
    }
    std::vector<Point2> border = ring_;
    if (!closed_) border.push_back(centre_);
    for (std::size_t s = 0; s < sectors_.size(); ++s) {
      if (!(cross(ring_[s] - centre_, ring_[(s + 1) % ring_.size()] - centre_) > 0)) return false;
    }
    return is_convex(border);
  }

  // Does it turn left at each of its corners, and once around in all? Then its heights rise once.
  static bool is_convex(const std::vector<Point2>& border) {
    const std::size_t n = border.size();
    std::size_t turns = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Point2 a = border[(i + 1) % n] - border[i], b = border[(i + 2) % n] - border[(i + 1) % n];
      if (!(cross(a, b) > 0)) return false;
      if (goes_up(a) != goes_up(b)) ++turns;
    }
    return turns == 2;
  }
  static bool goes_up(Point2 d) { return d.y > 0 || (d.y == 0 && d.x < 0); }

  // Control points along the axes.
  [[nodiscard]] Patch seen(const Patch& patch) const {
    Patch result;
    result.kind = patch.kind;
    result.first = patch.first;
    for (const Vector3& p : patch.points) {
      result.points.push_back({dot(axes_[0], p), dot(axes_[1], p), dot(axes_[2], p)});
      result.largest = std::max(result.largest, max_abs(result.points.back()));
    }
    result.error = enlarged(1.8 * (patch.error + gamma_bound(4) * patch.largest)) + 4 * underflow_error;
    return result;
  }

  Derivatives of_sector(std::size_t s) {
    const StarSector& sector = sectors_[s];
    Places places;
    places[sector.centre] = centre_;
    places[(sector.centre + 1) % 3] = ring_[s];
    places[(sector.centre + 2) % 3] = ring_[(s + 1) % ring_.size()];
    const Patch patch = seen(*sector.patch);
    return cuts_[s].tip ? of_tip(patch, places, cuts_[s]) : of_plain(patch, places, 1, plain_levels);
  }

  // Rings of pieces around a corner, each laid out smaller by its eigenvalue than the one before.
  Derivatives of_tip(Patch patch, const Places& places, const Cut& cut) {
    const CharacteristicMap& tip = *asymptotics_of(*patch.kind).characteristic_map();
    Derivatives all;
    double scale = 1;
    for (unsigned ring = 0; ring < max_net_rings; ++ring, scale /= cut.eigenvalue) {
      all.add(of_ring(patch, places, cut, scale));
      if (!(all.least > 0)) return unknown;
      const Derivatives others = of_ring(tip.limit_nets(patch).net, places, cut, scale);
      if (others.least * widening >= all.least && others.most <= widening * all.most) {
        all.add(others);
        return all;
      }
      patch = split(patch, static_cast<unsigned>(*cut.tip));
    }
    return unknown;
  }

  Derivatives of_ring(const Patch& patch, const Places& places, const Cut& cut, double scale) const {
    Derivatives all;
    for (unsigned child = 0; child < 4; ++child) {
      if (child == cut.tip) continue;
      const Patch piece = split(patch, child);
      all.add(of_plain(piece, cut.child(places, child), scale, plain_levels));
    }
    return all;
  }

  // Of what some splits make polynomial; its layout is the same affine one all over.
  static Derivatives of_plain(const Patch& patch, const Places& places, double scale, unsigned levels) {
    if (patch.kind->polynomial()) return of_polynomial(patch, places, scale);
    if (levels == 0) return unknown;
    Derivatives all;
    for (unsigned child = 0; child < 4; ++child) {
      all.add(of_plain(split(patch, child), Cut{}.child(places, child), scale, levels - 1));
      if (!(all.least > 0)) return unknown;
    }
    return all;
  }

  static Derivatives of_polynomial(const Patch& patch, const Places& places, double scale) {
    const BezierRows& form = patch.kind->form();
    const std::size_t count = bezier_count(form.degree);
    const double error = form.rows.result_error(patch.largest, patch.error);
    Places corners;  // in the kind's order
    for (std::size_t k = 0; k < 3; ++k) corners[patch.to_kind(k)] = places[k];
    Derivatives all;
    for (std::size_t part = 0; part < form.parts; ++part) {
      std::array<Vector3, bezier_count(max_degree)> points;
      for (std::size_t i = 0; i < count; ++i) {
        points[i] = form.rows.apply<Vector3>(part * count + i, patch.points);
      }
      Places own = corners;  // of two parts: 0, 1, m and m, 1, 2, m the middle of the edge 02
      if (form.parts == 2) own[part == 0 ? 2 : 0] = 0.5 * (corners[0] + corners[2]);
      all.add(of_bezier(points, form.degree, error, own, scale));
    }
    return all;
  }

  static Derivatives of_bezier(const std::array<Vector3, bezier_count(max_degree)>& points,
                               std::size_t degree, double error, const Places& places, double scale) {
    const Point2 a = places[1] - places[0], b = places[2] - places[0];
    const double area = cross(a, b), along_a = size_of(a), along_b = size_of(b), across = size_of(b - a);
    const double reach = along_a + along_b;
    const double products = std::max({along_a * along_b, along_a * across, along_b * across});
    if (!(area > min_sine * products) || !(std::min(along_a, along_b) > min_side)) return unknown;
    const double factor = scale * static_cast<double>(degree) / area;
    Derivatives all;
    for (std::size_t j = 0; j < degree; ++j) {
      for (std::size_t i = 0; i + j < degree; ++i) {
        const Vector3& at = points[bezier_index(degree, i, j)];
        const Vector3 u = points[bezier_index(degree, i + 1, j)] - at,
                      v = points[bezier_index(degree, i, j + 1)] - at;
        const Vector3 x = factor * (b.y * u - a.y * v), y = factor * (a.x * v - b.x * u);
        const double off =
            enlarged(factor * reach * (5 * error + layout_slack * (length(u) + length(v) + 4 * error)));
        all.add(derivatives_of(x, y, off));
      }
    }
    return all;
  }

  std::span<const StarSector> sectors_;
  bool closed_;
  std::vector<Cut> cuts_;
  Rows3 axes_;
  std::vector<Point2> ring_;  // closed: one a sector; open: one more
  Point2 centre_;
};

}  // namespace

double star_distortion(std::span<const StarSector> sectors, bool closed) {
  return StretchCheck(sectors, closed).stretch();
}

}  // namespace snug
