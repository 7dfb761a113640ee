#include "places.h"

#include <algorithm>

#include <support/read_file.h>

#include "answer_writer.h"
#include "progress_bar.h"
#include "words.h"

namespace snug::command {

std::string place_words(const SchemeTraits& traits) {
  return std::string(traits.owner()) + (traits.triangular ? " u v" : " u v [corner]");
}

Place read_place(std::string_view line, const Surface& surface, const std::string& where,
                 const std::string& expected) {
  const SchemeTraits& traits = surface.traits();
  const std::string owner = traits.owner();
  const auto unreadable = [&](const std::string& why) {
    return InputError(InputProblem::unreadable, where + why);
  };
  Place at{};
  bool good =
      parse(next_word(line), at.owner) && parse(next_word(line), at.u) && parse(next_word(line), at.v);
  if (const std::string_view corner = next_word(line); good && !corner.empty()) {
    good = !traits.triangular && parse(corner, at.corner) && next_word(line).empty();
  }
  if (!good) throw unreadable("a line is '" + expected + "'");
  if (at.owner >= surface.owner_count()) {
    throw unreadable(owner + " " + std::to_string(at.owner) + " of " + std::to_string(surface.owner_count()) +
                     " (they count from 0)");
  }
  if (traits.triangular ? !(at.u >= 0 && at.v >= 0 && at.u + at.v <= 1)
                        : !(at.u >= 0 && at.v >= 0 && at.u <= 1 && at.v <= 1)) {
    throw unreadable(traits.triangular ? "u and v must be >= 0, and u + v <= 1"
                                       : "u and v must be from 0 to 1");
  }
  const std::size_t corners = std::max<std::size_t>(1, surface.corner_count(at.owner));
  if (at.corner >= corners) {
    throw unreadable("corner " + std::to_string(at.corner) + " of " + owner + " " + std::to_string(at.owner) +
                     ", which counts from 0 to " + std::to_string(corners - 1));
  }
  if (!surface.has(at)) {
    throw InputError(InputProblem::refused,
                     where + owner + " " + std::to_string(at.owner) +
                         " has no limit surface: it lies at the boundary, or is a hole");
  }
  return at;
}

std::vector<Place> read_places(const std::string& path, const Surface& surface) {
  const std::string text = read_file(path, stopped_by_interrupts());
  const std::string expected = place_words(surface.traits());
  std::vector<Place> places;
  for_each_line(text, [&](std::string_view line, std::size_t number) {
    places.push_back(read_place(line, surface, path + ":" + std::to_string(number) + ": ", expected));
  });
  return places;
}

void write_place(JsonWriter& json, const Surface& surface, const Place& at, const SurfacePoint& point) {
  const SchemeTraits& traits = surface.traits();
  json.field(traits.owner(), at.owner).field("u", at.u).field("v", at.v);
  if (!traits.triangular) json.field("corner", at.corner);
  write_fields(json, point);
}

Option& add_place_options(OptionList& list, unsigned& samples, std::string& at) {
  list.add(Group::own, "--samples N", &samples,
           "Evaluate a grid with N steps, 1 to 1000, along each edge of every face or polyline")
      .between(1, 1000);
  return list
      .add(Group::own, "--at FILE", &at,
           "File with lines 'face u v' (triangles: (1-u-v) c0 + u c1 + v c2; quads: u from c0 towards c1), "
           "'face u v corner' for faces that are not quads")
      .excludes("--samples");
}

}  // namespace snug::command
