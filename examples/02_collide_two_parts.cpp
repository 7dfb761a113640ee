// Moves one part toward another and asks at each step whether their limit surfaces touch.
//
//   02_collide_two_parts A B

#include <cstdio>
#include <exception>
#include <memory>

#include <snug/io/mesh_file.h>
#include <snug/query/collide.h>

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: 02_collide_two_parts A B\n");
    return 2;
  }
  try {
    const auto library = std::make_shared<snug::BoundsCache>();
    const snug::LimitSurface a(snug::read_mesh(argv[1]), snug::SchemeOptions{}, library);
    const snug::LimitSurface b(snug::read_mesh(argv[2]), snug::SchemeOptions{}, library);

    // Trees are made once; the scratch memory is made once a thread and used again by every query.
    const snug::SurfaceBvh model_a(a), model_b(b);
    snug::SurfaceWorkspace scratch_a(model_a), scratch_b(model_b);
    const double size = a.size() > b.size() ? a.size() : b.size();
    for (int step = 4; step >= 0; --step) {
      const snug::Motion pose_b = snug::Motion::from_translation({0.5 * step * size, 0, 0});
      const snug::Collision answer =
          snug::collide({model_a, scratch_a, {}}, {model_b, scratch_b, pose_b}, {.tolerance = 0.001 * size});
      std::printf("moved by %g: %s, distance at least %g\n", pose_b.translation().x,
                  snug::name_of(answer.verdict), answer.lower);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
