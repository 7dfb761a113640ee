#pragma once

#include <snug/brep.h>
#include <snug/run.h>

namespace snug {

/// Finds which closed shells are voids, and orients solids outward, in double precision.
void find_voids(Brep& brep, const WorkMonitor& monitor = {});

}  // namespace snug
