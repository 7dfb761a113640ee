#include <oracle/loop_net.h>
#include <oracle/loop_twin.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace oracle {

namespace {

using detail::Interval;
using detail::Kind;
using detail::Net;
using detail::WeightTable;

constexpr std::int64_t kOne = std::int64_t{1} << kDeepest;
using Parameter = std::array<std::int64_t, 2>;  // (u, v) in units of 2^-60
using Corners = std::array<Parameter, 3>;
constexpr Corners kWholeFace{Parameter{0, 0}, {kOne, 0}, {0, kOne}};

Parameter halfway(const Parameter& a, const Parameter& b) { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2}; }

void require(bool condition) {
  if (!condition) throw std::invalid_argument("oracle: an argument is out of range");
}

double largest_coordinate(const TwinMesh& mesh) {
  double largest = 0;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t)
      for (const double x : mesh.points[v]) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Turns exact-ish points into samples; knows the error that `levels` refinements leave.
template <class Real>
class Rounding;

template <>
class Rounding<Quad> {
 public:
  Rounding(double largest, std::size_t valence)
      : per_level_(static_cast<Quad>(largest) * static_cast<Quad>(valence + 8) *
                   static_cast<Quad>(0x1p-112)) {}

  void round(const std::array<Quad, 3>& exact, int levels, LimitSample& sample) const {
    Quad worst = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      sample.position[x] = static_cast<double>(exact[x]);
      const Quad off = exact[x] - static_cast<Quad>(sample.position[x]);
      worst = std::max(worst, off < 0 ? -off : off);
    }
    worst += per_level_ * static_cast<Quad>(levels + 1);
    sample.error = static_cast<double>(worst);
    if (static_cast<Quad>(sample.error) < worst)
      sample.error = std::nextafter(sample.error, std::numeric_limits<double>::infinity());
  }

 private:
  Quad per_level_;
};

template <>
class Rounding<Interval> {
 public:
  Rounding(double, std::size_t) {}

  void round(const std::array<Interval, 3>& exact, int, LimitSample& sample) const {
    sample.error = 0;
    for (std::size_t x = 0; x < 3; ++x) {
      sample.position[x] = mpfi_get_d(exact[x].get());
      Interval off = exact[x] - Interval(sample.position[x]);
      mpfi_abs(off.get(), off.get());
      mpfr_t most;
      mpfr_init2(most, Interval::kBits);
      mpfi_get_right(most, off.get());
      sample.error = std::max(sample.error, mpfr_get_d(most, MPFR_RNDU));
      mpfr_clear(most);
    }
  }
};

/// Sets the parameters; false if doubles do not hold them.
bool set_parameter(const Parameter& p, LimitSample& sample) {
  sample.u = std::ldexp(static_cast<double>(p[0]), -kDeepest);
  sample.v = std::ldexp(static_cast<double>(p[1]), -kDeepest);
  return static_cast<std::int64_t>(static_cast<double>(p[0])) == p[0] &&
         static_cast<std::int64_t>(static_cast<double>(p[1])) == p[1];
}

std::size_t largest_valence(const std::vector<Triangle>& triangles, std::size_t points) {
  std::vector<std::size_t> faces(points, 0);
  std::size_t largest = 6;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) largest = std::max(largest, ++faces[v]);
  return largest;
}

template <class Real>
std::vector<LimitSample> uniform(const TwinMesh& mesh, int levels) {
  Net<Real> net = detail::whole_net<Real>(mesh);
  const Rounding<Real> rounding(largest_coordinate(mesh),
                                largest_valence(mesh.triangles, mesh.points.size()));
  std::vector<char> alive(mesh.triangles.size());
  for (std::size_t f = 0; f < alive.size(); ++f) alive[f] = detail::has_surface(net, f);
  WeightTable<Real> weights;
  for (int level = 0; level < levels; ++level) net = detail::refine(net, weights);
  const auto limit = detail::limit_points(net, weights);

  // The descendants of a face follow each other; (i, j) says which vertex is where on its lattice.
  const std::size_t side = std::size_t{1} << levels, descendants = side * side;
  const int shift = kDeepest - levels;
  std::vector<Corners> corners{kWholeFace};
  for (int level = 0; level < levels; ++level) {
    std::vector<Corners> fine;
    fine.reserve(4 * corners.size());
    for (const Corners& c : corners)
      for (std::size_t k = 0; k < 4; ++k) fine.push_back(detail::child_corners(c, k, halfway));
    corners = std::move(fine);
  }
  std::vector<std::uint32_t> lattice((side + 1) * (side + 1));
  std::vector<LimitSample> samples;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!alive[f]) continue;
    for (std::size_t d = 0; d < descendants; ++d)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<std::size_t>(corners[d][k][0] >> shift);
        const auto j = static_cast<std::size_t>(corners[d][k][1] >> shift);
        lattice[j * (side + 1) + i] = net.triangles[f * descendants + d][k];
      }
    for (std::size_t j = 0; j <= side; ++j)
      for (std::size_t i = 0; i + j <= side; ++i) {
        LimitSample sample{};
        sample.face = f;
        sample.u = std::ldexp(static_cast<double>(i), -levels);
        sample.v = std::ldexp(static_cast<double>(j), -levels);
        rounding.round(limit[lattice[j * (side + 1) + i]], levels, sample);
        samples.push_back(sample);
      }
  }
  return samples;
}

/// Barycentric coordinates of the target in the current triangle, in units of 2^-60; their sum is one.
using Target = std::array<std::int64_t, 3>;

/// The child that contains the target, which becomes the target in that child.
std::size_t step_down(Target& target) {
  for (std::size_t k = 0; k < 3; ++k)
    if (target[k] >= kOne / 2) {
      for (std::size_t i = 0; i < 3; ++i) target[i] = 2 * target[i] - (i == k ? kOne : 0);
      return k;
    }
  for (std::int64_t& t : target) t = kOne - 2 * t;
  return 3;
}

/// Walks from a face towards a target, with the net around the current triangle.
template <class Real>
class Descent {
 public:
  Descent(const TwinMesh& mesh, std::uint32_t face, const Target& target)
      : face_(face),
        target_(target),
        net_(detail::face_net<Real>(mesh, face)),
        rounding_(largest(), valence()) {}

  [[nodiscard]] bool has_surface() const { return detail::has_surface(net_, 0); }
  [[nodiscard]] const Target& target() const { return target_; }

  /// Corner `k` of the current triangle.
  void add_corner(std::size_t k, std::vector<LimitSample>& samples) {
    add(detail::limit_points(net_, weights_)[k], corners_[k], samples);
  }
  /// To the next level; adds the three edge points of the triangle left behind if `samples` is given.
  void step(std::vector<LimitSample>* samples) {
    const Net<Real> fine = detail::refine(net_, weights_);
    ++level_;
    if (samples != nullptr) {
      const auto limit = detail::limit_points(fine, weights_);
      const Corners centre = detail::child_corners(corners_, 3, halfway);
      for (std::size_t k = 0; k < 3; ++k) add(limit[fine.triangles[3][k]], centre[k], *samples);
    }
    const std::size_t child = step_down(target_);
    corners_ = detail::child_corners(corners_, child, halfway);
    net_ = detail::neighbourhood(fine, child);
  }

 private:
  void add(const std::array<Real, 3>& exact, const Parameter& parameter,
           std::vector<LimitSample>& samples) const {
    LimitSample sample{};
    sample.face = face_;
    if (!set_parameter(parameter, sample)) return;
    rounding_.round(exact, level_, sample);
    samples.push_back(sample);
  }
  [[nodiscard]] double largest() const {
    double largest = 0;
    for (const auto& p : net_.points)
      for (const Real& x : p) largest = std::max(largest, magnitude(x));
    return largest;
  }
  static double magnitude(const Quad& x) { return std::abs(static_cast<double>(x)); }
  static double magnitude(const Interval& x) { return std::abs(mpfi_get_d(x.get())); }
  [[nodiscard]] std::size_t valence() const { return largest_valence(net_.triangles, net_.points.size()); }

  std::uint32_t face_;
  Target target_;
  Net<Real> net_;
  Rounding<Real> rounding_;
  WeightTable<Real> weights_;
  Corners corners_ = kWholeFace;
  int level_ = 0;
};

template <class Real>
std::vector<LimitSample> near(const TwinMesh& mesh, std::uint32_t face, const Target& target, int depth) {
  Descent<Real> descent(mesh, face, target);
  std::vector<LimitSample> samples;
  if (!descent.has_surface()) return samples;
  for (std::size_t k = 0; k < 3; ++k) descent.add_corner(k, samples);
  for (int level = 0; level < depth; ++level) descent.step(&samples);
  return samples;
}

template <class Real>
std::vector<LimitSample> at(const TwinMesh& mesh, std::uint32_t face, const Target& target) {
  Descent<Real> descent(mesh, face, target);
  std::vector<LimitSample> samples;
  if (!descent.has_surface()) return samples;
  while (true) {
    const Target& left = descent.target();
    const auto corner = std::find(left.begin(), left.end(), kOne);
    if (corner != left.end()) {
      descent.add_corner(static_cast<std::size_t>(corner - left.begin()), samples);
      return samples;
    }
    descent.step(nullptr);
  }
}

Target target_of(double u, double v) {
  require(u >= 0 && v >= 0 && u <= 1 && v <= 1);
  const auto iu = static_cast<std::int64_t>(std::ldexp(u, kDeepest));
  const auto iv = static_cast<std::int64_t>(std::ldexp(v, kDeepest));
  require(iu + iv <= kOne);
  return {kOne - iu - iv, iu, iv};
}

}  // namespace

std::vector<LimitSample> sample_uniform(const TwinMesh& mesh, int levels, Arithmetic arithmetic) {
  require(levels >= 0 && levels <= 12);
  return arithmetic == Arithmetic::quad ? uniform<Quad>(mesh, levels) : uniform<Interval>(mesh, levels);
}

std::vector<LimitSample> sample_near_corner(const TwinMesh& mesh, std::uint32_t face, std::uint32_t corner,
                                            int depth, Arithmetic arithmetic) {
  require(corner < 3 && depth >= 0 && depth <= kDeepest);
  Target target{0, 0, 0};
  target[corner] = kOne;
  return arithmetic == Arithmetic::quad ? near<Quad>(mesh, face, target, depth)
                                        : near<Interval>(mesh, face, target, depth);
}

std::vector<LimitSample> sample_near_point(const TwinMesh& mesh, std::uint32_t face, double u, double v,
                                           int depth, Arithmetic arithmetic) {
  require(depth >= 0 && depth <= kDeepest);
  const Target target = target_of(u, v);
  return arithmetic == Arithmetic::quad ? near<Quad>(mesh, face, target, depth)
                                        : near<Interval>(mesh, face, target, depth);
}

std::vector<LimitSample> sample_at(const TwinMesh& mesh, std::uint32_t face, double u, double v,
                                   Arithmetic arithmetic) {
  const Target target = target_of(u, v);
  require(std::ldexp(static_cast<double>(target[1]), -kDeepest) == u &&
          std::ldexp(static_cast<double>(target[2]), -kDeepest) == v);
  return arithmetic == Arithmetic::quad ? at<Quad>(mesh, face, target) : at<Interval>(mesh, face, target);
}

}  // namespace oracle
