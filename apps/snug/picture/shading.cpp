#include <picture/shading.h>

#include <support/direction.h>

namespace snug {
namespace {

// Where the lights are and how strong.
constexpr Vector3 key = (1.0 / 9) * Vector3{-4, 7, -4}, fill = (1.0 / 9) * Vector3{8, 1, -4},
                  rim = (1.0 / 9) * Vector3{4, 4, 7};
constexpr Radiance key_light{0.72, 0.69, 0.65}, fill_light{0.13, 0.15, 0.18}, rim_light{0.30, 0.31, 0.33};
constexpr Radiance sky{0.36, 0.38, 0.41}, ground{0.15, 0.14, 0.135}, glint{1.0, 0.98, 0.95};

// A large light still reaches normals that face slightly away from it: zero from cosine = -wrap on, with zero
// slope.
double wrapped(double cosine) {
  constexpr double wrap = 0.35;
  const double x = std::max(0.0, (cosine + wrap) / (1 + wrap));
  return x * (0.4 * x + 0.6);
}

// The identity up to the knee, then bends towards 1 with continuous slope, so that highlights do not clip.
double shoulder(double light) {
  constexpr double knee = 0.75, rest = 1 - knee;
  return light <= knee ? light : 1 - rest * std::exp((knee - light) / rest);
}

}  // namespace

Finish finish_of(const Material& material) {
  return {light_of(material.colour), material.gloss, std::exp2(3.5 + 5.5 * material.gloss), material.lit};
}

Vector3 key_direction() { return key; }

Radiance shade(const Finish& finish, Vector3 normal, Vector3 to_eye, const Reached& reached) {
  if (!finish.lit) return finish.albedo;
  const double above = 0.5 + 0.5 * normal.y;
  const double facing = dot(normal, to_eye);
  const double grazing = (1 - facing) * (1 - facing) * (1 - facing);
  const Radiance around = above * sky + (1 - above) * ground + wrapped(dot(normal, fill)) * fill_light;
  const double towards_key = dot(normal, key);
  const double lit = reached.traced ? reached.key * std::max(0.0, towards_key) : wrapped(towards_key);
  const Radiance diffuse = reached.ambient * around + lit * key_light;
  const double behind = grazing * std::max(0.0, dot(normal, rim));
  Radiance light = finish.albedo * diffuse + behind * rim_light;
  if (finish.gloss > 0) {
    const Vector3 halfway = normalized(key + to_eye);
    const double towards = std::max(0.0, dot(normal, halfway));
    const double mirrored =
        0.6 * finish.gloss * std::pow(towards, finish.exponent) + 0.15 * finish.gloss * grazing;
    light = light + (reached.key * mirrored) * glint;
  }
  return {shoulder(light.red), shoulder(light.green), shoulder(light.blue)};
}

}  // namespace snug
