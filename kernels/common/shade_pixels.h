// The light pass in OpenCL: LANES pixels of one cell and the lights of its list.
//
// -DINDEX_32  indices are 32 bits, not 16
// -DOWN_LIGHT the image holds ambient light and more already; else ambient light is added here
// -DSPOTS     some light has a cone
// -DBLINN     the specular lobe is Blinn-Phong, not GGX
#pragma once

#include "kernels/common/gbuffer.h"
#include "shared/pixel_position.h"
#include "shared/punctual_light.h"

#ifdef INDEX_32
typedef uint index_t;
#else
typedef ushort index_t;
#endif

// Point and spot lights by index, as the shaders read them.
typedef struct Lights {
  global const float4 *places, *colors, *cones;
} Lights;

static inline PunctualLight light_at(const Lights* lights, uint index) {
  PunctualLight light;
  light.place = lights->places[index];
  light.color = lights->colors[index];
#ifdef SPOTS
  light.cone = lights->cones[index];
#endif
  return light;
}

// In the order of the list: the sum of the GL loop. A light that reaches none of the pixels would add exact zeros.
static inline Real3 light_sum(const ShadingPoint* p, global const index_t* list, uint count, const Lights* lights,
                              constant ViewParams* view) {
#ifdef OWN_LIGHT
  Real3 sum = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#else
  Real3 sum = reflected_ambient(*p, REAL(view->ambient_r), REAL(view->ambient_g), REAL(view->ambient_b));
#endif
  for (uint i = 0; i < count; ++i) {
    const PunctualLight light = light_at(lights, list[i]);
    const Arrival arrival = arrival_at(p->position, light);
    if (any_lane(arrival.attenuation > REAL(0.0f))) sum = add3(sum, radiance_of(*p, arrival, light));
  }
  return sum;
}
