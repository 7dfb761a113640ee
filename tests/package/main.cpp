// What an outside project does with the installed library: bound a surface, ask whether two touch.

#include <cstdio>
#include <memory>

#include <snug/io/obj.h>
#include <snug/query/bound.h>
#include <snug/query/collide.h>

// An adapter is there whether or not the library is that it adapts, and compiles wherever that is.
#if !__has_include(<snug/adapters/opensubdiv.h>)
#error "snug/adapters/opensubdiv.h is not installed"
#elif __has_include(<opensubdiv/far/topologyRefiner.h>)
#include <snug/adapters/opensubdiv.h>
#endif

int main() {
  const char* octahedron =
      "v 1 0 0\nv -1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 -1\n"
      "f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6\n";
  const auto library = std::make_shared<snug::BoundsCache>();
  const snug::LimitSurface surface(snug::parse_obj(octahedron, "octahedron"), snug::SchemeOptions{}, library);
  const snug::BoundSummary summary = snug::bound(surface, {}, [](const snug::PieceEnclosure&) {});

  const snug::SurfaceBvh model(surface);
  snug::SurfaceWorkspace scratch(model), other(model);
  const snug::Motion aside = snug::Motion::from_translation({2, 0, 0});
  const snug::Collision answer =
      snug::collide({model, scratch, {}}, {model, other, aside}, {.tolerance = 0.01});
  std::printf("consumer: %llu enclosures, %s\n", static_cast<unsigned long long>(summary.count),
              name_of(answer.verdict));
  return summary.count == 8 && answer.verdict == snug::Verdict::separated ? 0 : 1;
}
