#pragma once

#include <functional>
#include <string_view>

#include <picture/scene.h>
#include <snug/run.h>

#include "scene_builder.h"

namespace snug::command {

/// Colours of a surface that show a number over it: by its place in the number's range light or dark, blue to yellow,
/// or a colour for each kind of patch.
///
///   level      how often a patch was split, as the picture needs it
///   kind       grey where the patch is a polynomial, else a colour for each kind
///   thickness  of a patch's interval triangle, its logarithm: from a thousandth of the thickest to that
///   curvature  mean curvature: from -k to k, where k is exceeded by a twentieth of the surface
///   distance   to the other surface: from the least to the largest that is met
///
/// Requires:  one of these names; the surfaces outlive the result.
/// Cost:      curvature 45 evaluations a patch, distance 45 queries a patch; a number is kept for each of 15 and 45 places.
[[nodiscard]] std::function<Colour(const QuickHit&)> colours_by(std::string_view name,
                                                                const PlacedSurface& surface,
                                                                const PlacedSurface& other, int threads,
                                                                const WorkMonitor& monitor);

}  // namespace snug::command
