#include "face.h"

namespace models {

double human_head(const Vec3& p) {
  const Vec3 q = {std::abs(p.x), p.y, p.z};
  double f = ellipsoid(q, {0, 0.32, -0.12}, {0.70, 0.72, 0.88});
  f = join(f, ellipsoid(q, {0, -0.28, 0.22}, {0.54, 0.68, 0.56}), 0.20);          // face and jaw
  f = join(f, bar(q, {0, -0.80, 0.62}, 0.16, {0.16, -0.77, 0.52}, 0.15), 0.22);   // chin
  f = join(f, ball(q, {0.34, -0.16, 0.52}, 0.19), 0.18);                          // cheekbones
  f = join(f, bar(q, {0, -0.50, -0.22}, 0.40, {0, -1.9, -0.34}, 0.40), 0.18);     // neck
  f = carve(f, ellipsoid(q, {0.29, 0.03, 0.84}, {0.18, 0.14, 0.18}), 0.12);       // eye sockets
  f = join(f, bar(q, {0.10, 0.20, 0.78}, 0.06, {0.46, 0.17, 0.58}, 0.05), 0.10);  // brows
  f = join(f, ball(q, {0.27, 0.03, 0.58}, 0.165), 0.03);                          // eyes
  f = join(f, bar(q, {0, 0.18, 0.74}, 0.06, {0, -0.20, 0.93}, 0.10), 0.10);       // nose
  f = join(f, bar(q, {0, -0.20, 0.80}, 0.13, {0, -0.42, 0.72}, 0.16), 0.14);      // below the nose
  f = join(f, ball(q, {0.10, -0.23, 0.83}, 0.075), 0.07);                         // nostrils
  f = join(f, ellipsoid(q, {0, -0.53, 0.70}, {0.28, 0.20, 0.14}), 0.12);          // mouth
  f = join(f, bar(q, {0.00, -0.45, 0.845}, 0.055, {0.21, -0.51, 0.71}, 0.03), 0.05);
  f = join(f, bar(q, {0.00, -0.60, 0.83}, 0.07, {0.19, -0.56, 0.71}, 0.03), 0.05);
  f = carve(f, bar(q, {0, -0.525, 0.91}, 0.03, {0.22, -0.53, 0.79}, 0.03), 0.04);
  const Vec3 e = pitched(q, {0.68, -0.02, -0.12}, 1.0, 0.2);
  double ear = ellipsoid(e, {0.72, 0.00, -0.14}, {0.10, 0.26, 0.17});
  ear = carve(ear, ellipsoid(e, {0.84, 0.03, -0.10}, {0.09, 0.16, 0.09}), 0.05);
  return join(f, ear, 0.06);
}

double face_importance(const Vec3& p) {
  const Vec3 q = {std::abs(p.x), p.y, p.z};
  double weight = 1;
  if (q.z > 0.4 && q.y > -0.75 && q.y < 0.35 && q.x < 0.55) weight = 4;
  if (length(q - Vec3{0.27, 0.03, 0.68}) < 0.22) weight = 10;
  if (length(q - Vec3{0, -0.50, 0.80}) < 0.24) weight = 10;
  if (length(q - Vec3{0.04, -0.20, 0.92}) < 0.2) weight = 8;
  if (q.x > 0.62 && std::abs(q.y) < 0.32 && q.z < 0.1 && q.z > -0.4) weight = 3;
  return weight;
}

}  // namespace models
