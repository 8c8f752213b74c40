// One point or spot light's contribution at a point (KHR_lights_punctual). Exactly zero at and past its
// range. Never NaN: attenuation and BRDF are finite, and their product with the intensity may overflow to
// infinity. WINDOW_SMOOTH, WINDOW_NONE: how lights fade towards their
// range (scene/light_ranges.h), if not as in KHR_lights_punctual. LEAST_FALLOFF: inside its range a light
// counts as if it were no farther than where 1 / distance^2 is color.w.
#pragma once

#include "shared/brdf.h"
#include "shared/light_table.h"

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
namespace lightgrid {
#endif

// Limit of 1 / distance^2, reached 3e-16 m from the light. That is shorter than any distance for which lights
// are listed (docs/hard_cases.md). Larger values could make the product with the BRDF infinite: GGX reaches
// 2e7 at the roughness floor, and infinity times a colour or cosine of 0 is NaN.
#define LARGEST_ATTENUATION 1e31f

// The part of a light that arrives at a point.
SHARED_STRUCT(Arrival) {
  Real3 to_light;  // unit
  real attenuation;
#ifdef TINTED_BY_EFFECTS
  Real3 tint;  // set by TINT
#endif
};

SHARED_FUNCTION Real3 offset_to_light(Real3 position, PunctualLight light) {
  return real3(light.position.x - position.x, light.position.y - position.y, light.position.z - position.z);
}

SHARED_FUNCTION Arrival arrival_at(Real3 position, PunctualLight light) {
  Real3 to_light = offset_to_light(position, light);
  real distance_squared = dot3(to_light, to_light);
  real ratio = distance_squared * light.position.w;
  // At the light's own position there is no direction, and nothing is reflected.
  real inverse_distance = inverse_sqrt_real(max_real(distance_squared, REAL(1.2e-38f)));
  Arrival arrival;
  arrival.to_light = scale3(to_light, inverse_distance);
  // No branch on the range: beyond it, the result is multiplied by an exact zero. All factors are finite, so
  // it stays 0.
#ifdef WINDOW_NONE
  real window = ratio < REAL(1.0f) ? REAL(1.0f) : REAL(0.0f);
#else
  real window = max_real(mad_real(-ratio, ratio, 1.0f), REAL(0.0f));
#endif
#ifdef WINDOW_SMOOTH
  window = window * window;
#endif
  real falloff = inverse_distance * inverse_distance;
#ifdef VIRTUAL_LIGHTS
  falloff = min_real(falloff, REAL(light.max_falloff > 0.0f ? light.max_falloff : LARGEST_ATTENUATION));
#endif
#ifdef LEAST_FALLOFF
  falloff = max_real(falloff, REAL(light.color.w));
#endif
  arrival.attenuation = window * min_real(falloff, REAL(LARGEST_ATTENUATION));
#ifdef SPOTS
  real along = light.cone.x * arrival.to_light.x + light.cone.y * arrival.to_light.y +
               light.cone.z * arrival.to_light.z;
  real angular = min_real(max_real(light.cone.w - along, REAL(0.0f)), REAL(1.0f));
#ifdef VIRTUAL_LIGHTS
  arrival.attenuation = arrival.attenuation * (light.max_falloff > 0.0f ? angular : angular * angular);
#else
  arrival.attenuation = arrival.attenuation * (angular * angular);
#endif
#endif
  return arrival;
}

// The part of a light that its window takes away: all of it past its range (shared/effects/far_light.h).
SHARED_FUNCTION Arrival arrival_beyond(Real3 position, PunctualLight light) {
  PunctualLight endless = light;
  endless.position.w = 0.0f;
  Arrival arrival = arrival_at(position, endless);
  Real3 to_light = offset_to_light(position, light);
  real ratio = min_real(dot3(to_light, to_light) * light.position.w, REAL(1.0f));
  // 1 - window. 1 less the window would cancel near the light.
#ifdef WINDOW_NONE
  real beyond = ratio < REAL(1.0f) ? REAL(0.0f) : REAL(1.0f);
#else
  real beyond = ratio * ratio;
#endif
#ifdef WINDOW_SMOOTH
  beyond = beyond * (2.0f - beyond);
#endif
  arrival.attenuation = arrival.attenuation * beyond;
  return arrival;
}

#ifdef LIT_BY_EFFECTS
// Attenuation without 1 / distance^2.
SHARED_FUNCTION real part_besides_distance(Arrival arrival, Real3 to_light) {
  return arrival.attenuation * min_real(dot3(to_light, to_light), REAL(1e30f));
}
#endif

SHARED_FUNCTION Real3 radiance_of(ShadingPoint p, Arrival arrival, PunctualLight light) {
#ifdef LIT_BY_EFFECTS
  Real3 back;
  if (effects_light(OF_LIGHT(light), false)) {
    Real3 to_light = offset_to_light(p.position, light);
    back = scale3(effects_radiance(OF_LIGHT(light), p, to_light), part_besides_distance(arrival, to_light));
  } else {
    back = scale3(reflected(p, arrival.to_light), arrival.attenuation);
  }
#else
  Real3 back = scale3(reflected(p, arrival.to_light), arrival.attenuation);
#endif
  return real3(back.x * light.color.x TINTED(arrival, x), back.y * light.color.y TINTED(arrival, y),
               back.z * light.color.z TINTED(arrival, z));
}

SHARED_FUNCTION Real3 radiance_from(ShadingPoint p, PunctualLight light) {
  Arrival arrival = arrival_at(p.position, light);
  arrival.attenuation =
      arrival.attenuation * light_reaches(light, p.position, arrival.to_light, VALUES_AT(p));
  TINT(arrival, light, p.position, VALUES_AT(p))
  return radiance_of(p, arrival, light);
}

#if !defined(__OPENCL_VERSION__) && !defined(LIGHTGRID_GLSL)
}  // namespace lightgrid
#endif
