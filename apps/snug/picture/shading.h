#pragma once

#include <picture/colour.h>
#include <picture/scene.h>
#include <support/point.h>

namespace snug {

/// A Material made ready for shading.
struct Finish {
  Radiance albedo;
  double gloss = 0, exponent = 1;
  bool lit = true;
};

[[nodiscard]] Finish finish_of(const Material& material);

/// Shares of the light from all around and of the key light that reach a place, in [0, 1].
struct Reached {
  double ambient = 1, key = 1;
  bool traced = false;  ///< found by rays, as is where a surface turns away from the light
};
/// Where the key light is, in camera coordinates, of length 1.
[[nodiscard]] Vector3 key_direction();

/// Light that a lit surface sends to the eye under the studio's lights, which move with the camera: a large
/// warm key light from the upper left, a cool fill from the right, a rim light from behind, and light from
/// all around that is brighter from above. Shadows are the caller's: `reached`.
///
/// Guarantee: each share lies in [0, 1] and varies continuously with the normal.
/// Requires:  unit vectors in camera coordinates (x right, y up, z into the picture), dot(normal,
///            to_eye) >= 0.
/// Source:    diffuse light wrapped around the terminator; highlights [Blinn77].
[[nodiscard]] Radiance shade(const Finish& finish, Vector3 normal, Vector3 to_eye,
                             const Reached& reached = {});

}  // namespace snug
