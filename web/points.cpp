// Questions about points, rays and places.

#include "part.h"

namespace snug::web {
namespace {

val closest_to(const Part& part, const val& point, const val& options) {
  return guarded([&] {
    const Vector3 to = vector_of(point, "point");
    Precision how;
    how.absolute = option<double>(options, "absolute");
    how.relative = option<double>(options, "relative");
    const auto write = [](const ClosestPoint& answer) {
      val result = val::object();
      result.set("distance", array_of(answer.distance));
      result.set("outcome", std::string(name_of(answer.outcome)));
      result.set("point", array_of(answer.point));
      result.set("error", answer.error);
      result.set("at", object_of(*answer.at));
      return result;
    };
    if (!option<bool>(options, "signed").value_or(false)) {
      return write(closest_point(part.surface(), {to.x, to.y, to.z}, how, run_of(options)));
    }
    const SignedDistance answer = signed_distance(part.surface(), {to.x, to.y, to.z}, how, run_of(options));
    val result = write(answer.nearest);
    result.set("distance", array_of(answer.distance));
    result.set("outcome", std::string(name_of(answer.outcome)));
    return result;
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
    const RayHits answer = ray(part.surface(), line, how, run_of(options));
    val result = val::object();
    val hits = val::array();
    for (const RayHit& each : answer.hits) {
      val hit = val::object();
      hit.set("t", array_of(each.t));
      hit.set("certified", each.certified);
      hit.set("side", each.side);
      hit.set("point", array_of(each.point));
      hit.set("error", each.error);
      hit.set("normal", each.normal ? array_of(*each.normal) : val::null());
      hit.set("at", each.at ? object_of(*each.at) : val::null());
      hits.call<void>("push", hit);
    }
    result.set("hits", hits);
    result.set("outcome", word(name_of(answer.outcome)));
    result.set("certainHit", answer.certain_hit());
    result.set("certainMiss", answer.certain_miss());
    return result;
  });
}

val point_at(const Part& part, const val& at) {
  return guarded([&] {
    const auto number = [&](const char* name) { return option<double>(at, name).value_or(0); };
    const Place place{static_cast<std::uint32_t>(number("owner")),
                      static_cast<std::uint32_t>(number("corner")), number("u"), number("v")};
    const SurfacePoint answer = evaluate(part.surface(), place);
    val result = val::object();
    result.set("point", array_of(answer.point));
    result.set("error", answer.error);
    val tangents = val::array();
    for (int t = 0; t < 2; ++t) tangents.set(t, array_of(answer.tangents[static_cast<std::size_t>(t)]));
    result.set("tangents", tangents);
    result.set("differentiable", answer.differentiable);
    result.set("normal", answer.normal ? array_of(*answer.normal) : val::null());
    result.set("normalError", answer.normal_error ? val(*answer.normal_error) : val::null());
    return result;
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
