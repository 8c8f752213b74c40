// Directional lights reach every pixel, but for shadows: they are in no grid, and every technique adds them
// the same way.
//   DIRECTIONAL_SHADOWS: some of them casts a shadow
#include "shared/shadow_bits.h"
#include "shared/light_table.h"

// two texels each: direction to the light; illuminance
uniform samplerBuffer directional_lights;

vec3 directional_light_sum(ShadingPoint p) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < int(view.directional_count); ++i) {
#ifdef MET_BY_EFFECTS
    if (!effects_meet(int(view.light_count) + i, p.surface)) continue;
#endif
    vec3 back = reflected(p, texelFetch(directional_lights, 2 * i).xyz);
#ifdef DIRECTIONAL_SHADOWS
    back *= seen_share(int(view.light_count) + i, uvec2(gl_FragCoord.xy));
#endif
#ifdef REACHED_BY_EFFECTS
    back *= effects_reach(int(view.light_count) + i, p.position, texelFetch(directional_lights, 2 * i).xyz,
                          VALUES_AT(p));
#endif
#ifdef TINTED_BY_EFFECTS
    back *= effects_tint(int(view.light_count) + i, p.position, texelFetch(directional_lights, 2 * i).xyz,
                         VALUES_AT(p));
#endif
    sum += back * texelFetch(directional_lights, 2 * i + 1).rgb;
  }
  return sum;
}
