#include <snug/inspect.h>

#include <cmath>

#include <snug/evaluate.h>
#include <snug/scheme/scheme.h>
#include <support/error.h>
#include <support/number.h>

namespace snug {
namespace {

// Infinite where no double holds it.
double away_from_faces(const Surface& surface, const Run& run) {
  try {
    return limit_to_faces(surface, run).value_or(INFINITY);
  } catch (const InputError&) {
    return INFINITY;
  }
}

}  // namespace

std::string smoothing_note(const Surface& surface, std::string_view option, std::optional<double> apart,
                           const Run& run) {
  if (surface.scheme() != Scheme::loop || !smooths_untagged(surface.mesh())) return {};
  if (!apart && surface.mesh().face_count() <= max_measured_faces) apart = away_from_faces(surface, run);
  if (apart == 0) return {};
  const std::string far = apart ? ", up to " + text_of_length(*apart, surface.size()) + " away from them"
                                : " (how far from them is not measured above 200,000 faces)";
  const std::string given(option);
  return "triangles taken as the control mesh of a Loop surface" + far + "; " + given +
         " flat takes the facets, " + given + " loop says that this is meant";
}

}  // namespace snug
