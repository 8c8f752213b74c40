// One point or spot light's contribution at a point (KHR_lights_punctual). Exactly zero at and past its range.
//   SPOTS: some light has a cone.
#pragma once

#include "shared/brdf.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

SHARED_STRUCT(PunctualLight) {
  Float4 place;  // view space, and 1 / radius^2 (0: no range)
  Float4 color;  // radiant intensity
#ifdef SPOTS
  Float4 cone;   // axis times scale, and offset: 1 inside, 0 outside
#endif
};

SHARED_FUNCTION Real3 radiance_from(ShadingPoint p, PunctualLight light) {
  Real3 to_light = real3(light.place.x - p.position.x, light.place.y - p.position.y, light.place.z - p.position.z);
  real distance_squared = dot3(to_light, to_light);
  real ratio = distance_squared * light.place.w;
  real inverse_distance = inverse_sqrt_real(max_real(distance_squared, REAL(1e-12f)));
  to_light = scale3(to_light, inverse_distance);
  // No branch on the range: what is past it is multiplied by an exact zero.
  real attenuation = max_real(1.0f - ratio * ratio, REAL(0.0f)) * min_real(inverse_distance * inverse_distance, REAL(1e4f));
#ifdef SPOTS
  real along = light.cone.x * to_light.x + light.cone.y * to_light.y + light.cone.z * to_light.z;
  real angular = min_real(max_real(light.cone.w - along, REAL(0.0f)), REAL(1.0f));
  attenuation = attenuation * (angular * angular);
#endif
  Real3 back = reflected(p, to_light);
  return real3(back.x * (light.color.x * attenuation), back.y * (light.color.y * attenuation),
               back.z * (light.color.z * attenuation));
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
