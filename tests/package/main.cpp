#include <snug/snug.h>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const snug::Surface a = snug::load(argv[1]), b = snug::load(argv[2]);
  const auto at = snug::Motion::translation({4, 0, 0});
  const snug::Collision hit = snug::collide(a, b.at(at), {.tolerance = 1e-3});
  const snug::Distance gap = snug::distance(a, b.at(at), {.relative = 1e-3});
  const snug::ClosestPoint near = snug::closest_point(a, {1, 2, 3});
  std::printf("%s, distance in [%g, %g], (%g %g %g) is closest\n", snug::name_of(hit.verdict),
              gap.distance.lower, gap.distance.upper, near.point.x, near.point.y, near.point.z);
}
