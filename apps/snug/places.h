#pragma once

#include <string>
#include <string_view>

#include <snug/surface/limit_surface.h>

namespace snug::command {

/// The words that name a place on this surface: "face u v", "vertex u v [corner]" and the like.
[[nodiscard]] std::string place_words(const SchemeRules& rules);

/// The place that the rest of a line names. `where` begins messages, `expected` is what a line is.
/// Errors:    InputError: (unreadable) for another form and what is out of range; (refused) where there is no
///            surface.
[[nodiscard]] SurfaceParameter read_place(std::string_view line, const LimitSurface& surface,
                                          const std::string& where, const std::string& expected);

}  // namespace snug::command
