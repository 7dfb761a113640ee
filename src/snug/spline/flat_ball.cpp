#include <snug/spline/flat_ball.h>

namespace snug {

// p becomes p - g(p) n with g(p) = (1 - w(q)) z, where z = n . (p - c) is the height over the tangent plane, q = |p - c|^2, and w rises
// from 0 to 1 between the radii, as a quintic of q with two vanishing derivatives at both ends. Derivatives by those of g.
void FlatBall::apply(CornerJet& jet) const {
  const Vector3 d = jet.point - center, n = normal;
  const double q = length_sq(d), outer_sq = radius * radius, inner_sq = inner * inner * outer_sq;
  if (q >= outer_sq) return;
  double w = 0, w1 = 0, w2 = 0;
  if (q > inner_sq) {
    const double size = outer_sq - inner_sq, t = (q - inner_sq) / size, s = 1 - t;
    w = t * t * t * (10 - 15 * t + 6 * t * t);
    w1 = 30 * t * t * s * s / size;
    w2 = 60 * t * s * (1 - 2 * t) / (size * size);
  }
  const double z = dot(n, d);
  const auto along = [&](const Vector3& x) { return (1 - w) * dot(n, x) - 2 * w1 * z * dot(d, x); };
  const Vector3 a = jet.along_u, b = jet.along_v;
  const double mixed = -4 * w2 * z * dot(d, a) * dot(d, b) - 2 * w1 * z * dot(a, b) -
                       2 * w1 * (dot(d, a) * dot(n, b) + dot(n, a) * dot(d, b));
  jet.point = jet.point - ((1 - w) * z) * n;
  jet.along_u = a - along(a) * n;
  jet.along_v = b - along(b) * n;
  jet.twist = jet.twist - (along(jet.twist) + mixed) * n;
}

}  // namespace snug
