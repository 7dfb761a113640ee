#include "models.h"
#include "sculpt.h"

namespace models {

namespace {

double demon(const Vec3& p) {
  const Vec3 q = {std::abs(p.x), p.y, p.z};
  double f = ellipsoid(q, {0, 0.25, -0.08}, {0.66, 0.66, 0.76});
  f = join(f, ellipsoid(q, {0, -0.30, 0.22}, {0.46, 0.62, 0.50}), 0.20);
  f = join(f, ball(q, {0.40, -0.06, 0.44}, 0.20), 0.15);                        // cheekbones
  f = join(f, bar(q, {0, -0.80, 0.52}, 0.16, {0, -1.35, 0.82}, 0.05), 0.14);    // beard
  f = join(f, bar(q, {0, -0.40, -0.20}, 0.36, {0, -1.40, -0.30}, 0.50), 0.18);  // neck
  f = carve(f, common(p.y + 1.2, p.z - 0.45, 0.1), 0.06);                    // a flat neck, but a long beard
  f = carve(f, ellipsoid(q, {0.26, 0.06, 0.80}, {0.21, 0.12, 0.20}), 0.08);  // eye sockets
  f = join(f, ball(q, {0.25, 0.05, 0.54}, 0.14), 0.03);
  f = join(f, bar(q, {0.06, 0.16, 0.76}, 0.09, {0.52, 0.40, 0.48}, 0.07), 0.08);  // angry brows
  f = join(f, bar(q, {0, 0.16, 0.72}, 0.07, {0, -0.18, 0.90}, 0.12), 0.10);       // nose
  f = join(f, ball(q, {0.13, -0.20, 0.78}, 0.09), 0.06);
  f = join(f, bar(q, {0, -0.26, 0.66}, 0.16, {0, -0.50, 0.58}, 0.18), 0.16);
  f = carve(f, bar(q, {0, -0.56, 0.84}, 0.09, {0.36, -0.40, 0.60}, 0.06), 0.08);    // grin
  f = join(f, bar(q, {0.19, -0.66, 0.62}, 0.09, {0.22, -0.42, 0.80}, 0.03), 0.05);  // tusks
  const Vec3 flat = unit({0.35, 0.1, 0.9});
  f = join(f, blade(q, {0.58, 0.00, -0.05}, 0.22, {1.25, 0.36, -0.35}, 0.04, flat, 2.0), 0.08);  // ears
  f = join(f, bar(q, {0.34, 0.70, 0.22}, 0.25, {0.68, 1.10, 0.26}, 0.20), 0.08);                 // horns
  f = join(f, bar(q, {0.68, 1.10, 0.26}, 0.20, {0.84, 1.55, 0.05}, 0.15), 0.06);
  f = join(f, bar(q, {0.84, 1.55, 0.05}, 0.15, {0.74, 1.98, -0.08}, 0.10), 0.06);
  return join(f, bar(q, {0.74, 1.98, -0.08}, 0.10, {0.50, 2.30, 0.05}, 0.04), 0.06);
}

double demon_importance(const Vec3& p) {
  const Vec3 q = {std::abs(p.x), p.y, p.z};
  if (q.y > 0.85) return 4;
  if (q.x > 0.75) return 4;
  if (length(q - Vec3{0.26, 0.08, 0.66}) < 0.26) return 8;
  if (length(q - Vec3{0.14, -0.52, 0.74}) < 0.26) return 8;
  return q.z > 0.4 && q.y < 0.5 ? 4 : 1;
}

}  // namespace

TriangleMesh make_demon() {
  SculptOptions options;
  options.low = {0, -1.75, -1.05};
  options.high = {1.5, 2.5, 1.2};
  options.cell = 1.0 / 24;
  options.faces = 680;
  options.importance = demon_importance;
  return sculpt(demon, options);
}

}  // namespace models
