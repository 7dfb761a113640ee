#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <snug/inspect.h>
#include <snug/surface/limit_surface.h>

namespace snug {

/// "triangles taken as the control mesh of a Loop surface, up to 0.031 (...) away from them; scheme flat takes
/// ..." for a surface of natural_scheme(); empty unless smooths_untagged() its mesh and moves it. `option` is
/// how the caller gives a scheme, `apart` the distance from the faces if it is known.
/// Cost:      that of limit_to_faces() up to max_measured_faces; above, the note is without the distance.
[[nodiscard]] std::string smoothing_note(const LimitSurface& surface, std::string_view option,
                                         std::optional<double> apart = {}, int threads = 0);

}  // namespace snug
