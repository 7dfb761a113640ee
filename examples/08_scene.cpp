// A row of parts: which of them touch, and how near are the others?
//
//   08_scene MESH

#include <cstdio>
#include <exception>

#include <snug/snug.h>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: 08_scene MESH\n");
    return 2;
  }
  try {
    const snug::Surface part = snug::load(argv[1]);  // one surface, in many places
    snug::Scene scene;
    for (int i = 0; i < 12; ++i) {
      const snug::Motion turned = snug::Motion::rotation_degrees({0, 0, 1}, 30 * i);
      scene.parts.push_back(part.at(turned.with_offset({0.6 * part.size() * i, 0, 0})));
    }
    const auto touch = [](const snug::PairCollision& pair) {
      std::printf("parts %u and %u: %s\n", pair.parts.a, pair.parts.b, snug::name_of(pair.answer.verdict));
    };
    const snug::SceneCounts found = snug::collide(scene, {}, touch);
    std::printf("%llu pairs, %llu of them apart by their boxes alone\n",
                static_cast<unsigned long long>(found.pairs),
                static_cast<unsigned long long>(found.separated_by_boxes));
    const auto near = [](const snug::PairDistance& pair) {
      std::printf("parts %u and %u: at least %g apart\n", pair.parts.a, pair.parts.b,
                  pair.answer.distance.lower);
    };
    static_cast<void>(snug::distance(scene, 0.3 * part.size(), {.relative = 0.01}, near));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
