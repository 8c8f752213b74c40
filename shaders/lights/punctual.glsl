// The point and spot lights by index.
//   NO_CONES: point lights alone are read, whatever the scene has
#if defined(NO_CONES) && defined(SPOTS)
#undef SPOTS
#endif
#include "shared/punctual_light.h"

#ifdef LIGHTS_IN_BLOCK
layout(std140) uniform LightsBlock { LIGHT_TABLE(LIGHT_INPUT) };
#else
LIGHT_TABLE(LIGHT_INPUT)
#endif

PunctualLight light_at(int index) {
  PunctualLight light;
  LIGHT_TABLE(LIGHT_TEXEL)
#ifdef HAS_LIGHT_INDEX
  light.index = index;
#endif
  return light;
}

vec3 punctual_light(ShadingPoint p, int index) {
#ifdef MET_BY_EFFECTS
  if (!effects_meet(index, p.surface)) return vec3(0.0);
#endif
  return radiance_from(p, light_at(index));
}
