#pragma once

#include <snug/brep.h>

namespace snug {

/// Finds out which closed shells are hollows of others, and turns solids outward, in double precision.
void find_voids(Brep& brep);

}  // namespace snug
