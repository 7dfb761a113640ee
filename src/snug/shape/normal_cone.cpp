#include <snug/shape/normal_cone.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include <snug/geometry/angles.h>
#include <snug/geometry/bernstein.h>
#include <snug/geometry/interval.h>
#include <snug/geometry/rounding.h>
#include <snug/patch/evaluate.h>
#include <snug/shape/corner_asymptotics.h>
#include <support/direction.h>

namespace snug {
namespace {

// Times that a polynomial is split where its coefficients have no cone; levels until sharpness has decayed, and
// rings around a corner that are bounded one by one.
constexpr unsigned max_splits = 2, transient_levels = 6, net_levels = 2, max_cone_rings = 50;
// Of a net that stands for all further rings: its error against its size, and the angle that this adds.
constexpr double max_net_error = 1.0 / 512, max_widening = 1.0 / 32;
// Angles between the axis of a first trial and vectors of the second one have larger cosines.
constexpr double min_cosine = 1.0 / 64;
constexpr int axis_steps = 24;

// Contains a vector. All normals are sums of such vectors, weighted by numbers that are not negative.
struct Ball {
  Vector3 centre;
  double radius;
};

// Differences along two edges of the parameters' triangle, as polynomials by axis, scaled to about 1.
template <std::size_t degree>
struct EdgeDerivatives {
  using Polynomial = Bernstein<Domain::triangle, degree - 1>;
  std::array<Polynomial, 3> u, v;
  double longest = 0;  // of all coefficients' vectors
  double error = 0;    // of each coefficient
};

// Moves a corner about to the origin: normals do not see it, and what shrinks from ring to ring is rounded less.
void centre_at(std::size_t corner, Patch& patch) {
  const Vector3 place = limit_corners(patch)[corner];
  patch.largest = 0;
  for (Vector3& p : patch.points) {
    p = p - place;
    patch.largest = std::max(patch.largest, max_abs(p));
  }
  patch.error = enlarged(patch.error + unit_roundoff * patch.largest);
}

// Collects such vectors of a patch, at first all, then with a given axis those near it: polynomials whose vectors
// are not are split.
class NormalBalls {
 public:
  // False where no set of vectors is found.
  [[nodiscard]] bool add(const Patch& patch) { return add(patch, transient_levels); }
  [[nodiscard]] bool add_near(Vector3 axis, const Patch& patch) {
    axis_ = axis;
    balls_.clear();
    next_tip_ = 0;
    return add(patch, transient_levels);
  }
  [[nodiscard]] std::span<const Ball> balls() const { return balls_; }
  // Do they hold all vectors? Those that may be zero are left out at first.
  [[nodiscard]] bool complete() const { return complete_; }

 private:
  bool add(const Patch& patch, unsigned levels) {
    if (patch.kind->polynomial()) return add_polynomial(patch, nullptr, max_splits);
    if (levels == 0) return false;
    if (const auto* tip = asymptotics_of(*patch.kind).characteristic_map())
      return add_tip(*tip, patch, levels - 1);
    for (unsigned child = 0; child < 4; ++child) {
      if (!add(split(patch, child), levels - 1)) return false;
    }
    return true;
  }

  // Ring after ring, until a net stands for all that are left.
  bool add_tip(const CharacteristicMap& tip, Patch patch, unsigned levels) {
    patch.path = {};
    const auto corner = static_cast<unsigned>((tip.corner() + patch.first) % 3);
    if (!axis_) last_rings_.push_back(0);
    const std::size_t place = axis_ ? next_tip_++ : last_rings_.size() - 1;
    for (unsigned ring = 0; ring < max_cone_rings; ++ring) {
      centre_at(corner, patch);
      if (ring >= last_rings_[place]) {
        const double far = add_limit(tip, patch, corner);
        if (far <= 1) return true;
        if (axis_) return false;
        // The part left out shrinks by half a level at best.
        last_rings_[place] = ring + 1 + static_cast<unsigned>(std::min(8.0, std::log2(far)));
      }
      for (unsigned child = 0; child < 4; ++child) {
        if (child != corner && !add(split(patch, child), levels)) return false;
      }
      patch = split(patch, corner);
    }
    return false;
  }

  // Adds the vectors of all rings from this patch on, if what is left out is small enough. Returns how many times
  // too large it is.
  double add_limit(const CharacteristicMap& tip, const Patch& patch, unsigned corner) {
    const CharacteristicMap::LimitNets limit = tip.limit_nets(patch);
    const double error = limit.net.error / (max_net_error * limit.net.largest);
    if (!(error <= 1)) return std::isfinite(error) ? error : 0x1p8;
    const std::size_t before = balls_.size();
    const bool was_complete = complete_;
    bool added = true;
    complete_ = true;
    for (unsigned child = 0; added && child < 4; ++child) {
      if (child != corner)
        added = add_nets(split(limit.net, child), split(limit.dominant, child), net_levels);
    }
    const double wide = added && complete_ ? widening(before) / max_widening : 2;
    complete_ = was_complete;
    if (wide > 1 && !axis_) balls_.resize(before);
    // With an axis nets are what they were without, or pieces of these.
    return axis_ ? (added ? 1 : 2) : wide;
  }

  // Halves of quads whose fourth corner is extraordinary are split before they are polynomial.
  bool add_nets(const Patch& net, const Patch& dominant, unsigned levels) {
    if (net.kind->polynomial()) return add_polynomial(net, &dominant, max_splits);
    if (levels == 0 || asymptotics_of(*net.kind).characteristic_map() != nullptr) return false;
    for (unsigned child = 0; child < 4; ++child) {
      if (!add_nets(split(net, child), split(dominant, child), levels - 1)) return false;
    }
    return true;
  }

  // Tangent of the largest angle that balls from this one on take.
  double widening(std::size_t begin) const {
    double widest = 0;
    for (std::size_t i = begin; i < balls_.size(); ++i) {
      widest = std::max(widest, balls_[i].radius / length(balls_[i].centre));
    }
    return widest;
  }

  // With `dominant`: what errors are multiplied by may be differences of either net.
  bool add_polynomial(const Patch& patch, const Patch* dominant, unsigned splits) {
    const std::size_t before = balls_.size();
    if (add_by_degree(patch, dominant) || !axis_) return true;
    if (splits == 0) return false;
    balls_.resize(before);
    for (unsigned child = 0; child < 4; ++child) {
      const Patch piece = split(patch, child);
      const std::optional<Patch> other =
          dominant != nullptr ? std::optional(split(*dominant, child)) : std::nullopt;
      if (!add_polynomial(piece, other ? &*other : nullptr, splits - 1)) return false;
    }
    return true;
  }

  // Are all vectors there, and near the axis if there is one?
  bool add_by_degree(const Patch& patch, const Patch* dominant) {
    switch (patch.kind->form().degree) {
      case 1:
        return add_coefficients<1>(patch, dominant);
      case 2:
        return add_coefficients<2>(patch, dominant);
      case 4:
        return add_coefficients<4>(patch, dominant);
      case 6:
        return add_coefficients<6>(patch, dominant);
      default:
        return complete_ = false;
    }
  }

  template <std::size_t degree>
  bool add_coefficients(const Patch& patch, const Patch* dominant) {
    for (std::size_t part = 0; part < patch.kind->form().parts; ++part) {
      EdgeDerivatives<degree> d;
      const PowerOfTwo scale = differences(patch, part, nullptr, d);
      if (!(d.longest > 0)) return complete_ = false;
      if (dominant != nullptr) {
        EdgeDerivatives<degree> other;
        static_cast<void>(differences(*dominant, part, &scale, other));
        d.longest = std::max(d.longest, other.longest);
      }
      if (!add_products(d)) return false;
    }
    return true;
  }

  // Scaled by this power of two, or by one of their own.
  template <std::size_t degree>
  static PowerOfTwo differences(const Patch& patch, std::size_t part, const PowerOfTwo* given,
                                EdgeDerivatives<degree>& d) {
    using Polynomial = typename EdgeDerivatives<degree>::Polynomial;
    const BezierRows& form = patch.kind->form();
    std::array<Vector3, bezier_count(degree)> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i] = form.rows.apply<Vector3>(part * points.size() + i, patch.points);
    }
    const auto each = [&](const auto& visit) {
      Polynomial::for_each([&](std::size_t i, std::size_t j) {
        const Vector3 at = points[bezier_index(degree, i, j)];
        visit(Polynomial::place(i, j), points[bezier_index(degree, i + 1, j)] - at,
              points[bezier_index(degree, i, j + 1)] - at);
      });
    };
    double largest = 0;
    each([&](std::size_t, Vector3 u, Vector3 v) { largest = std::max({largest, max_abs(u), max_abs(v)}); });
    const PowerOfTwo scale = given != nullptr ? *given : PowerOfTwo::normalising(largest);
    d.error = enlarged(2 * form.rows.result_error(patch.largest, patch.error) + unit_roundoff * largest);
    d.error = enlarged(scale.apply(d.error));
    each([&](std::size_t place, Vector3 u, Vector3 v) {
      u = scale.apply(u);
      v = scale.apply(v);
      d.longest = std::max({d.longest, length(u), length(v)});
      for (std::size_t a = 0; a < 3; ++a) {
        d.u[a].scaled[place] = u[a] * binomials<Polynomial>[place];
        d.v[a].scaled[place] = v[a] * binomials<Polynomial>[place];
      }
    });
    d.longest = enlarged(d.longest);
    return scale;
  }

  template <std::size_t degree>
  bool add_products(const EdgeDerivatives<degree>& d) {
    using Polynomial = typename EdgeDerivatives<degree>::Polynomial;
    using Product = ProductOf<Polynomial, Polynomial>;
    std::array<Product, 3> normal{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      add_product(d.u[b], d.v[c], 1, normal[a]);
      add_product(d.u[c], d.v[b], -1, normal[a]);
    }
    const double off = spatial_error(d.error);
    const double radius =
        enlarged(off * (2 * d.longest + off) + spatial_error(gamma_bound(64) * 2 * d.longest * d.longest));
    bool near = true;
    for (std::size_t k = 0; k < Product::count; ++k) {
      const double by = 1 / binomials<Product>[k];
      const Vector3 centre = by * Vector3{normal[0].scaled[k], normal[1].scaled[k], normal[2].scaled[k]};
      const double size = length(centre);
      // Nor where this is not a number.
      if (!(size > radius)) {
        near = complete_ = false;
        continue;
      }
      if (axis_ && !(dot(*axis_, centre) > min_cosine * size + radius)) return false;
      balls_.push_back({centre, radius});
    }
    return near;
  }

  std::optional<Vector3> axis_;
  bool complete_ = true;
  std::vector<Ball> balls_;
  // Of each corner in turn the first ring of which a net is taken for all others.
  std::vector<unsigned> last_rings_;
  std::size_t next_tip_ = 0;
};

// Near the one whose largest angle with the balls' centres is least: to the centre of the ball around their
// directions, by steps to the farthest one [Badoiu03].
Vector3 axis_of(std::span<const Ball> balls) {
  std::vector<Vector3> directions;
  directions.reserve(balls.size());
  Vector3 sum;
  for (const Ball& ball : balls) {
    directions.push_back(normalized(ball.centre));
    sum = sum + directions.back();
  }
  const auto farthest = [&](const Vector3& axis) {
    const Vector3* far = &directions.front();
    double least = INFINITY;
    for (const Vector3& d : directions) {
      const double cosine = dot(axis, d);
      if (cosine < least) far = &d;
      least = std::min(least, cosine);
    }
    return *far;
  };
  // Between two that are far apart; those within half their angle hardly matter.
  const Vector3 one = farthest(normalized(sum)), other = farthest(one);
  Vector3 centre = 0.5 * (one + other), best = normalized(centre);
  if (best == Vector3{}) return normalized(sum);
  double most = dot(best, farthest(best));
  const double near = std::sqrt(0.5 * (1 + std::max(-1.0, most)));
  std::erase_if(directions, [&](const Vector3& d) { return dot(best, d) > near; });
  for (int step = 0; step < axis_steps && !directions.empty(); ++step) {
    const Vector3 axis = normalized(centre), far = farthest(axis);
    const double least = dot(axis, far);
    if (least > most) {
      most = least;
      best = axis;
    }
    centre = centre + (1.0 / (step + 4)) * (far - centre);
  }
  return best;
}

// Upper bound of the tangent of the angle between an axis of length 1 and any vector of a ball; infinite unless
// the angle is less than a quarter turn.
double tangent_from(Vector3 axis, const Ball& ball) {
  const double size = length(ball.centre), rounding = gamma_bound(16) * size;
  const double across = length(cross(axis, ball.centre)) + rounding,
               along = dot(axis, ball.centre) - rounding;
  const double least = size * (1 - gamma_bound(8));
  if (!(along > 0) || !(least > ball.radius)) return INFINITY;
  const double centre = enlarged(across / along);
  const double more = enlarged(ball.radius / std::sqrt((least - ball.radius) * (least + ball.radius)));
  const double rest = 1 - enlarged(centre * more);
  return rest > 0 ? enlarged((centre + more) / rest) : INFINITY;
}

std::optional<NormalCone> cone_around(Vector3 axis, std::span<const Ball> balls) {
  double tangent = 0;
  for (const Ball& ball : balls) tangent = std::max(tangent, tangent_from(axis, ball));
  if (!(tangent < 0x1p100)) return std::nullopt;
  // More than roundings of both.
  const double angle = angle_of(tangent, 1) + 0x1p-44;
  const SineCosine exact = sine_cosine(Interval(angle));
  if (!(exact.cosine.lower > 0) || !(exact.sine.lower >= rounded_up(tangent * exact.cosine.upper))) {
    return std::nullopt;
  }
  return NormalCone{axis, angle};
}

}  // namespace

std::optional<NormalCone> normal_cone(const Patch& piece) {
  Patch patch = piece;
  patch.path = {};  // room for its pieces
  NormalBalls normals;
  if (!normals.add(patch) || normals.balls().empty()) return std::nullopt;
  const Vector3 axis = axis_of(normals.balls());
  if (normals.complete()) {
    if (const auto cone = cone_around(axis, normals.balls())) return cone;
  }
  if (!normals.add_near(axis, patch)) return std::nullopt;
  return cone_around(axis_of(normals.balls()), normals.balls());
}

}  // namespace snug
