#include <oracle/contact_time_twin.h>

#include <oracle/exact_vector.h>
#include <oracle/mpfi_interval.h>

#include <algorithm>
#include <cmath>

namespace oracle {
namespace {

using namespace exact_vectors;
using ExactTriangle = std::array<Vector, 3>;

struct Times {
  mpq_class from{0}, to{1};
};

// Cuts `times` to those at which the shadows on an axis meet. False if none are left.
bool cut(const ExactTriangle& still, const ExactTriangle& moving, const Vector& by, const Vector& axis,
         Times& times) {
  const auto shadow = [&](const ExactTriangle& t) {
    std::array<mpq_class, 2> ends{dot(axis, t[0]), dot(axis, t[0])};
    for (const Vector& p : t) {
      const mpq_class h = dot(axis, p);
      ends[0] = std::min(ends[0], h);
      ends[1] = std::max(ends[1], h);
    }
    return ends;
  };
  const auto s = shadow(still), m = shadow(moving);
  // m[0] + t speed <= s[1] and m[1] + t speed >= s[0].
  const mpq_class speed = dot(axis, by), low = s[0] - m[1], high = s[1] - m[0];
  if (speed == 0) return low <= 0 && high >= 0;
  const mpq_class a = low / speed, b = high / speed;
  times.from = std::max(times.from, speed > 0 ? a : b);
  times.to = std::min(times.to, speed > 0 ? b : a);
  return times.from <= times.to;
}

std::optional<mpq_class> first_contact(const ExactTriangle& still, const ExactTriangle& moving,
                                       const Vector& by) {
  std::array<Vector, 3> edges_s, edges_m;
  for (std::size_t k = 0; k < 3; ++k) {
    edges_s[k] = still[(k + 1) % 3] - still[k];
    edges_m[k] = moving[(k + 1) % 3] - moving[k];
  }
  const Vector n_s = cross(edges_s[0], edges_s[1]), n_m = cross(edges_m[0], edges_m[1]);
  std::vector<Vector> axes{n_s, n_m};
  for (const Vector& e : edges_s) {
    axes.push_back(cross(n_s, e));
    for (const Vector& f : edges_m) axes.push_back(cross(e, f));
  }
  for (const Vector& f : edges_m) axes.push_back(cross(n_m, f));
  Times times;
  for (const Vector& axis : axes) {
    if (!cut(still, moving, by, axis, times)) return std::nullopt;
  }
  return times.from;
}

using Real = detail::Interval;
using Reals = std::array<Real, 3>;

Reals reals(const Point& p) { return {Real(p[0]), Real(p[1]), Real(p[2])}; }
Real unary(int (*function)(mpfi_ptr, mpfi_srcptr), const Real& x) {
  Real result;
  function(result.get(), x.get());
  return result;
}

// The twelve numbers of the motion without its end, by Rodrigues' matrix entry by entry.
std::array<Real, 12> screwed(const TwinScrew& screw, double s) {
  const Reals raw = reals(screw.axis);
  const Real size = unary(mpfi_sqrt, raw[0] * raw[0] + raw[1] * raw[1] + raw[2] * raw[2]);
  const Reals n{raw[0] / size, raw[1] / size, raw[2] / size};
  const Real angle = Real(s) * Real(screw.radians), sine = unary(mpfi_sin, angle),
             cosine = unary(mpfi_cos, angle), half = unary(mpfi_sin, angle / Real(2.0)),
             rest = Real(2.0) * half * half;
  std::array<Reals, 3> q;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      q[i][j] = rest * n[i] * n[j];
      if (i == j) q[i][j] += cosine;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    q[k][j] += sine * n[i];
    q[j][k] = q[j][k] - sine * n[i];
  }
  const auto number = [&](std::size_t i, std::size_t j) { return Real(screw.from[4 * i + j]); };
  const Reals about = reals(screw.about), a = reals(screw.turning), v = reals(screw.velocity);
  // Integrals of the cosine and of the sine of tau radians over tau from 0 to s.
  const Real by_sine = screw.radians == 0 ? Real(s) : sine / Real(screw.radians),
             by_rest = screw.radians == 0 ? Real(0.0) : rest / Real(screw.radians);
  std::array<Real, 12> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result[4 * i + j] = q[i][0] * number(0, j) + q[i][1] * number(1, j) + q[i][2] * number(2, j);
    }
    Real t = about[i] + Real(s) * v[i] + by_sine * a[i];
    for (std::size_t k = 0; k < 3; ++k) t += q[i][k] * (number(k, 3) - about[k]);
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    t += by_rest * (n[j] * a[k] - n[k] * a[j]);
    result[4 * i + 3] = t;
  }
  return result;
}

// Of 4x4 matrices without their last row.
template <class Number>
std::array<Number, 12> product(const std::array<Number, 12>& a, const std::array<Number, 12>& b) {
  std::array<Number, 12> result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      Number sum = a[4 * i] * b[j];
      sum += a[4 * i + 1] * b[4 + j];
      sum += a[4 * i + 2] * b[8 + j];
      if (j == 3) sum += a[4 * i + 3];
      result[4 * i + j] = sum;
    }
  }
  return result;
}

template <class Number>
std::array<Number, 12> matrix_of(const Placement& placement) {
  std::array<Number, 12> result;
  for (std::size_t k = 0; k < 12; ++k) result[k] = Number(placement[k]);
  return result;
}

// Rodrigues' matrix, or a translation along the axis.
template <class Number, class Sine, class Cosine, class Root>
std::array<Number, 12> joint_matrix(const TwinChain::Joint& joint, const Number& at, const Sine& sine_of,
                                    const Cosine& cosine_of, const Root& root_of) {
  std::array<Number, 3> n{Number(joint.axis[0]), Number(joint.axis[1]), Number(joint.axis[2])};
  const Number size = root_of(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (Number& x : n) x = x / size;
  const Number zero(0.0), one(1.0);
  std::array<Number, 12> m{one, zero, zero, zero, zero, one, zero, zero, zero, zero, one, zero};
  if (joint.slides) {
    for (std::size_t i = 0; i < 3; ++i) m[4 * i + 3] = at * n[i];
    return m;
  }
  const Number sine = sine_of(at), cosine = cosine_of(at), rest = one - cosine;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    m[4 * i + i] = cosine + rest * n[i] * n[i];
    m[4 * k + j] = rest * n[j] * n[k] + sine * n[i];
    m[4 * j + k] = rest * n[j] * n[k] - sine * n[i];
  }
  return m;
}

template <class Number, class Sine, class Cosine, class Root>
std::array<Number, 12> chained(const TwinChain& chain, const Number& s, const Sine& sine_of,
                               const Cosine& cosine_of, const Root& root_of) {
  const Number one(1.0), zero(0.0);
  std::array<Number, 12> result{one, zero, zero, zero, zero, one, zero, zero, zero, zero, one, zero};
  for (const TwinChain::Joint& joint : chain.joints) {
    const Number at = (one - s) * Number(joint.from) + s * Number(joint.to);
    result = product(product(result, matrix_of<Number>(joint.frame)),
                     joint_matrix(joint, at, sine_of, cosine_of, root_of));
  }
  return product(result, matrix_of<Number>(chain.tip));
}

std::array<Real, 12> chained(const TwinChain& chain, double s) {
  return chained(
      chain, Real(s), [](const Real& x) { return unary(mpfi_sin, x); },
      [](const Real& x) { return unary(mpfi_cos, x); }, [](const Real& x) { return unary(mpfi_sqrt, x); });
}

using Long = long double;
using LongVector = std::array<Long, 3>;

LongVector column(const Placement& p, std::size_t j) { return {p[j], p[4 + j], p[8 + j]}; }
Long product(const LongVector& a, const LongVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

std::optional<mpq_class> first_contact(const TriangleSoup& still, const TriangleSoup& moving,
                                       const Point& by) {
  const auto exactly = [](const std::array<Point, 3>& t) {
    return ExactTriangle{exact(t[0]), exact(t[1]), exact(t[2])};
  };
  std::vector<ExactTriangle> of_moving;
  for (const auto& t : moving) of_moving.push_back(exactly(t));
  std::optional<mpq_class> first;
  for (const auto& s : still) {
    for (const ExactTriangle& m : of_moving) {
      const std::optional<mpq_class> t = first_contact(exactly(s), m, exact(by));
      if (t && (!first || *t < *first)) first = t;
    }
  }
  return first;
}

std::array<double, 12> placement_errors(const TwinScrew& screw, double s, const Placement& placement) {
  std::array<Real, 12> exact = screwed(screw, s);
  if (screw.to) {
    const std::array<Real, 12> end = screwed(screw, 1);
    for (std::size_t k = 0; k < 12; ++k) exact[k] += Real(s) * (Real((*screw.to)[k]) - end[k]);
  }
  std::array<double, 12> errors{};
  for (std::size_t k = 0; k < 12; ++k) {
    const Real off = unary(mpfi_abs, exact[k] - Real(placement[k]));
    errors[k] = mpfr_get_d(&off.get()->right, MPFR_RNDU);
  }
  return errors;
}

std::array<double, 12> placement_errors(const TwinChain& chain, double s, const Placement& placement) {
  const std::array<Real, 12> exact = chained(chain, s), first = chained(chain, 0), last = chained(chain, 1);
  std::array<double, 12> errors{};
  for (std::size_t k = 0; k < 12; ++k) {
    const Real moved = exact[k] + (Real(1.0) - Real(s)) * (Real(chain.from[k]) - first[k]) +
                       Real(s) * (Real(chain.to[k]) - last[k]);
    const Real off = unary(mpfi_abs, moved - Real(placement[k]));
    errors[k] = mpfr_get_d(&off.get()->right, MPFR_RNDU);
  }
  return errors;
}

std::array<long double, 12> placement_of(const TwinChain& chain, long double s) {
  return chained(
      chain, s, [](Long x) { return std::sin(x); }, [](Long x) { return std::cos(x); },
      [](Long x) { return std::sqrt(x); });
}

long double separation(const Point& half_a, const Placement& a, const Point& half_b, const Placement& b) {
  std::vector<LongVector> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes.push_back(column(a, i));
    axes.push_back(column(b, i));
    for (std::size_t j = 0; j < 3; ++j) {
      const LongVector e = column(a, i), f = column(b, j);
      const LongVector c{e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
      const Long size = std::sqrt(product(c, c));
      if (size > 1e-6L) axes.push_back({c[0] / size, c[1] / size, c[2] / size});
    }
  }
  const LongVector ta = column(a, 3), tb = column(b, 3), between{tb[0] - ta[0], tb[1] - ta[1], tb[2] - ta[2]};
  Long widest = -INFINITY;
  for (const LongVector& axis : axes) {
    Long gap = std::fabs(product(axis, between));
    for (std::size_t k = 0; k < 3; ++k) {
      gap -= half_a[k] * std::fabs(product(axis, column(a, k)));
      gap -= half_b[k] * std::fabs(product(axis, column(b, k)));
    }
    widest = std::max(widest, gap);
  }
  return widest;
}

}  // namespace oracle
