#pragma once
// The face that the head and the bust share.

#include "implicit.h"

namespace models {

/// Head of a person, about 1.9 high, looking along +z, eyes near y = 0.05; the neck runs down to y = -1.7.
double human_head(const Vec3& p);

/// Larger in the eyes, the nose, the mouth and the ears.
double face_importance(const Vec3& p);

}  // namespace models
