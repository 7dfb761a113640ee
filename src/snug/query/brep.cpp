#include <snug/brep.h>
#include <snug/query/brep_maker.h>
#include <snug/search/surface_data.h>

#include <support/error.h>

namespace snug {

Brep to_brep(const Surface& surface, const BrepOptions& options, const Run& run) {
  const LimitSurface& limit = surface.data()->limit();
  if (is_tensor(limit.rules().basis)) return brep_of_quads(limit, options, run);
  if (limit.rules().triangular()) return brep_of_triangles(limit, options, run);
  throw InputError(
      InputProblem::refused,
      std::string("B-spline faces of the scheme ") + name_of(surface.scheme()) +
          " are not supported: tessellate() makes triangles of it, which the scheme flat has as planes");
}

}  // namespace snug
