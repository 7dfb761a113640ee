#pragma once

#include <snug/ray.h>

namespace snug {

/// Throws InputError (value) unless these are a ray.
void require_ray(const Ray& ray);

}  // namespace snug
