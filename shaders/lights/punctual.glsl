// The point and spot lights by index.
#include "shared/punctual_light.h"

uniform samplerBuffer light_positions;
uniform samplerBuffer light_colors;
#ifdef SPOTS
uniform samplerBuffer light_cones;
#endif

PunctualLight light_at(int index) {
  PunctualLight light;
  light.position = texelFetch(light_positions, index);
  light.color = texelFetch(light_colors, index);
#ifdef SPOTS
  light.cone = texelFetch(light_cones, index);
#endif
  return light;
}

vec3 punctual_light(ShadingPoint p, int index) { return radiance_from(p, light_at(index)); }
