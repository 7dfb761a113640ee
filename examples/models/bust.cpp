#include "face.h"
#include "models.h"
#include "sculpt.h"

namespace models {

namespace {

double bust(const Vec3& p) {
  const Vec3 q = {std::abs(p.x), p.y, p.z};
  double f = human_head(p);
  double hair = ellipsoid(q, {0, 0.34, -0.20}, {0.80, 0.80, 0.92});
  hair = carve(hair, ellipsoid(q, {0, -0.28, 0.85}, {0.62, 0.95, 0.80}), 0.10);  // hairline over the forehead
  hair = carve(hair, ellipsoid(q, {0.95, -0.12, 0.00}, {0.45, 0.36, 0.42}), 0.08);  // and around the ears
  hair = join(hair, ellipsoid(q, {0, 0.50, -1.12}, {0.38, 0.36, 0.34}), 0.06);      // bun
  f = join(f, hair, 0.04);
  double body = ellipsoid(q, {0, -2.45, -0.32}, {1.05, 0.95, 0.58});
  body = join(body, bar(q, {0, -1.62, -0.38}, 0.30, {1.10, -1.95, -0.38}, 0.34), 0.25);    // shoulders
  body = join(body, ellipsoid(q, {0.42, -2.55, 0.10}, {0.42, 0.40, 0.36}), 0.20);          // chest
  body = join(body, bar(q, {0.10, -1.72, 0.06}, 0.06, {0.95, -1.62, -0.22}, 0.07), 0.12);  // collar bones
  body = carve(body, ball(q, {0, -1.66, 0.26}, 0.12), 0.15);
  const double below = 0.35 * q.x * q.x - 2.75 - p.y;  // a cut that rises towards the arms
  body = common(body, below, 0.12);
  body = common(body, q.x - 1.22, 0.15);
  f = join(f, body, 0.15);
  f = join(f, bar(q, {0, -2.6, -0.25}, 0.40, {0, -3.0, -0.25}, 0.26), 0.15);  // socle
  const double disc = length(Vec3{p.x, 0, p.z + 0.25}) - 0.62;
  const double slab = common(disc, std::abs(p.y + 3.22) - 0.14, 0.08);
  return join(f, slab, 0.10);
}

double bust_importance(const Vec3& p) {
  if (p.y > -1.0 && p.z > 0.3) return 1.5 * face_importance(p);
  if (p.y < -2.8) return 10.0;
  return p.y > -1.0 ? 1.5 : 1.0;
}

}  // namespace

TriangleMesh make_bust() {
  SculptOptions options;
  options.low = {0, -3.6, -1.7};
  options.high = {1.75, 1.4, 1.3};
  options.cell = 1.0 / 24;
  options.faces = 1396;
  options.max_valence = 10;
  options.importance = bust_importance;
  TriangleMesh mesh = sculpt(bust, options);
  for (const std::size_t face : {400u, 1098u}) split_face(mesh, face, 0.05);
  return mesh;
}

}  // namespace models
