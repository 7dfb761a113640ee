#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <snug/evaluate.h>

#include "json_writer.h"
#include "options.h"

namespace snug::command {

/// The words that name a place on this surface: "face u v", "vertex u v [corner]" and the like.
[[nodiscard]] std::string place_words(const SchemeTraits& traits);

/// The place that the rest of a line names. `where` begins messages, `expected` is what a line is.
/// Errors:    InputError: (unreadable) for another form and what is out of range; (refused) where there is no
///            surface.
[[nodiscard]] Place read_place(std::string_view line, const Surface& surface, const std::string& where,
                               const std::string& expected);
/// The places of all lines of a file; blank lines and those that begin with # are skipped. Errors as above.
[[nodiscard]] std::vector<Place> read_places(const std::string& path, const Surface& surface);

/// Calls visit(place) for those places of a lattice of `steps` on a face, or on each quad of its first split, where
/// there is a surface.
template <class Visit>
void for_each_place(const Surface& surface, std::uint32_t owner, unsigned steps, Visit&& visit) {
  const auto visit_surface = [&](const Place& at) {
    if (surface.has(at)) visit(at);
  };
  if (surface.traits().triangular) {
    for (unsigned j = 0; j <= steps; ++j) {
      for (unsigned i = 0; i + j <= steps; ++i) {
        // The far edge is met exactly: u + v rounds to at most 1.
        const double v = static_cast<double>(j) / steps, u = std::fmin(static_cast<double>(i) / steps, 1 - v);
        visit_surface(Place{owner, 0, u, v});
      }
    }
    return;
  }
  for (std::uint32_t corner = 0; corner < surface.corner_count(owner); ++corner) {
    for (unsigned j = 0; j <= steps; ++j) {
      for (unsigned i = 0; i <= steps; ++i) {
        visit_surface(Place{owner, corner, static_cast<double>(i) / steps, static_cast<double>(j) / steps});
      }
    }
  }
}

/// The options --samples and --at of commands that answer for places: a lattice, or a file. Returns the last.
Option& add_place_options(OptionList& list, unsigned& samples, std::string& at);

/// The fields of a place and of the limit point there, in an object that has begun.
void write_place(JsonWriter& json, const Surface& surface, const Place& at, const SurfacePoint& point);

}  // namespace snug::command
