// Moves one part towards another and asks at each step whether their limit surfaces touch.
//
//   02_collide_two_parts A B

#include <algorithm>
#include <cstdio>
#include <exception>

#include <snug/snug.h>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 02_collide_two_parts A B\n");
    return 2;
  }
  try {
    const snug::Surface a = snug::load(argv[1]), b = snug::load(argv[2]);
    const double size = std::max(a.size(), b.size());
    for (int step = 4; step >= 0; --step) {
      const double x = 0.5 * step * size;
      const snug::Motion pose = snug::Motion::translation({x, 0, 0});
      const snug::Collision answer = snug::collide(a, b.at(pose));
      std::printf("moved by %g: %s, distance at least %g\n", x, snug::name_of(answer.verdict),
                  answer.distance.lower);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
