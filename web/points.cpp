// Questions about points, rays and places.

#include "fields.h"
#include "part.h"

namespace snug::web {
namespace {

val closest_to(const Part& part, const val& point, const val& options) {
  return guarded([&] {
    const Vector3 to = vector_of(point, "point");
    Precision how;
    how.absolute = option<double>(options, "absolute");
    how.relative = option<double>(options, "relative");
    if (option<bool>(options, "signed").value_or(false)) {
      return object_of(signed_distance(part.surface(), {to.x, to.y, to.z}, how, run_of(options)));
    }
    return object_of(closest_point(part.surface(), {to.x, to.y, to.z}, how, run_of(options)));
  });
}

val contained_in(const Part& part, const val& point) {
  return guarded([&] {
    const std::optional<bool> inside = contains(part.surface(), point_of(point, "point"), {.threads = 1});
    return inside ? val(*inside) : val::null();
  });
}

RayQuery query_of(const val& options) {
  const std::string name = option<std::string>(options, "query").value_or("nearest");
  if (name == "nearest") return RayQuery::nearest;
  if (name == "any") return RayQuery::any;
  if (name == "all") return RayQuery::all;
  throw InputError(InputProblem::value, "query: '" + name + "' is not nearest, any or all");
}

val hits_of(const Part& part, const val& origin, const val& direction, const val& options) {
  return guarded([&] {
    Ray line{point_of(origin, "origin"), vector_of(direction, "direction")};
    line.from = option<double>(options, "from").value_or(line.from);
    line.to = option<double>(options, "to").value_or(line.to);
    RayOptions how{.query = query_of(options), .absolute = option<double>(options, "absolute")};
    return object_of(ray(part.surface(), line, how, run_of(options)));
  });
}

val point_at(const Part& part, const val& at) {
  return guarded([&] {
    const auto number = [&](const char* name) { return option<double>(at, name).value_or(0); };
    const Place place{static_cast<std::uint32_t>(number("owner")),
                      static_cast<std::uint32_t>(number("corner")), number("u"), number("v")};
    return object_of(evaluate(part.surface(), place));
  });
}

// About six digits of a proved bound, rounded to the safe side, as the command prints them.
std::string text_at_most(double x, bool at_least) {
  std::array<char, 40> text{};
  for (int digits = 6; digits <= 17; ++digits) {
    std::snprintf(text.data(), text.size(), "%.*g", digits, x);
    const double read = std::strtod(text.data(), nullptr);
    if (at_least ? read >= x : read <= x) break;
  }
  return text.data();
}

}  // namespace
}  // namespace snug::web

EMSCRIPTEN_BINDINGS(points) {
  using namespace snug::web;  // NOLINT
  emscripten::function("closest", &closest_to);
  emscripten::function("contains", &contained_in);
  emscripten::function("ray", &hits_of);
  emscripten::function("evaluate", &point_at);
  emscripten::function("textAtMost", &text_at_most);
}
