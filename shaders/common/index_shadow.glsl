// The share of a light that is hidden from a receiver, found by lidr itself
// (passes/light_index/index_shadows.h). After receiver.glsl.
//   SHADOW_VOLUMES: by the stencil; else by its shadow map
//   LIDR_SHARE_BITS: of a share beside an index
// shadow_lights: two texels each: position, range; 1 if it has a shadow, first face, number of faces.
uniform usamplerBuffer shadow_lights;
#ifdef SHADOW_VOLUMES
uniform usampler2D shadow_stencil;  // 0: out of every shadow volume of the light
#else
#include "shaders/common/shadow_map.glsl"
#endif

float hidden_share(uint light, Receiver r, ivec2 pixel) {
  uvec4 has = texelFetch(shadow_lights, int(light) * 2 + 1);
  if (has.x == 0u || !r.covered) return 0.0;
  uvec4 place = texelFetch(shadow_lights, int(light) * 2);
  vec3 position = uintBitsToFloat(place.xyz), to = r.at - position;
  float range = uintBitsToFloat(place.w);
  if (dot(to, to) > range * range * 1.0001) return 0.0;  // unlit
  if (turned_away(r, position)) return 1.0;
#ifdef SHADOW_VOLUMES
  return texelFetch(shadow_stencil, pixel, 0).r != 0u ? 1.0 : 0.0;
#else
  return hidden_by_map(has.yz, position, r);
#endif
}

#ifdef LIDR_SHARE_BITS
const float share_steps = float((1u << LIDR_SHARE_BITS) - 1u);
uint steps_of_share(float share) { return uint(share * share_steps + 0.5); }
#endif
