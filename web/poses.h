#pragma once

#include "values.h"

namespace snug::web {

// Twelve numbers, or nothing for the identity.
Motion motion_of(const val& numbers);

// Options of collide() and distance(), of a pair or a scene.
CollideOptions collide_options(const val& options);
DistanceOptions distance_options(const val& options);

}  // namespace snug::web
